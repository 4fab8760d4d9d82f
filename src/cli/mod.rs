//! The command line: arguments, files, the terminal. The only room with files; everything else takes and gives bytes.

mod arguments;
mod commands;
mod console;
pub mod exit;
mod grading;
mod input;
mod interrupt;
mod original;
mod output;
mod pictures;
mod scenes;
mod screen;
mod selection;
mod values;

use crate::report::foreign::plain;
use clap::Parser;
use std::{ffi::OsString, os::unix::ffi::OsStrExt, process::ExitCode};

/// Runs the command that the program's arguments ask for.
#[must_use]
pub fn main() -> ExitCode {
    // First of all, since this is called most often and is over soonest.
    crate::original::run_if_meant(&original::Program).unwrap_or_else(run)
}

/// Returns every other command.
fn run(words: Vec<OsString>) -> ExitCode {
    // Before anything else and before any thread: this process may be a sandbox's supervisor.
    if let Some(code) = crate::sandbox::supervisor_main(words.iter().cloned()) {
        return code;
    }
    // A half-written output is then removed like after any other failure.
    crate::sandbox::let_large_writes_fail();
    let program = words.first().cloned().unwrap_or_default();
    let arguments = match arguments::Arguments::try_parse_from(words) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version come this way, too. A closed pipe does not change the exit code.
            drop(error.print());
            return ExitCode::from(if error.use_stderr() { exit::FAULT } else { exit::ACCEPTED });
        }
    };
    console::choose_colour(arguments.color);
    // Options before the command kept it from being recognised above.
    if let arguments::Command::Original(original) = &arguments.command {
        let name = [program.as_bytes(), b" original"].concat();
        return crate::original::main(&name, &original.words, &original::Program);
    }
    let code = commands::run(&arguments.command).unwrap_or_else(|error| {
        // Names of files are a stranger's words, too.
        console::complain(plain(&format!("error: {error:#}\n")));
        exit::FAULT
    });
    ExitCode::from(code)
}
