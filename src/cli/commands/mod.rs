//! The commands: each reads its inputs, lets the rooms below do the work, and prints what a renderer makes of it.

mod check;
mod record;
mod shell;
mod simulate;
mod trace;

use super::arguments::{Command, Trace};
use anyhow::Result;

/// Runs a command and returns its exit code.
///
/// # Errors
/// What keeps it from running: wrong usage, bad input, or our own fault.
pub(super) fn run(command: &Command) -> Result<u8> {
    match command {
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Trace(Trace::Info(arguments)) => trace::info(arguments),
        Command::Trace(Trace::Show(arguments)) => trace::show(arguments),
        Command::Trace(Trace::Diff(arguments)) => trace::diff(arguments),
        Command::Record(arguments) => record::run(arguments),
        Command::Completions(arguments) => shell::completions(arguments),
        Command::Man(_) => shell::manual(),
        // Its words never get here: they are not read by this parser.
        Command::Original(_) => Ok(super::exit::FAULT),
    }
}
