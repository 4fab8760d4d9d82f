//! The command line, with its arguments, its files and the terminal. Only this module opens files; the other modules
//! use bytes.

mod arguments;
mod commands;
mod console;
mod defaults;
pub mod exit;
mod input;
mod interrupt;
mod original;
mod output;
mod progress_bars;
mod selection;

use crate::{report::untrusted_text::strip_control_characters, sample};
use anyhow::Result;
use clap::{CommandFactory, FromArgMatches};
use std::{ffi::OsString, os::unix::ffi::OsStrExt, process::ExitCode};

/// Runs the command that the program's arguments name.
pub fn main() -> ExitCode {
    // A copy of this program with a pinned mistake acts only as a submission.
    if let Some(mistake) = sample::pinned_mistake::pinned_mistake() {
        return sample::main(std::env::args_os(), Some(mistake));
    }
    // This is checked before the other commands, because it is called most often and must start quickly.
    crate::original::run_if_requested(&original::CliServices).unwrap_or_else(run)
}

/// Runs any command except for the drop-in for the original.
fn run(arguments: Vec<OsString>) -> ExitCode {
    // This must come first, before a thread is started, because the process may be a sandbox's supervisor.
    if let Some(code) = crate::sandbox::supervisor_main(arguments.iter().cloned()) {
        return code;
    }
    commands::shell::complete_if_requested();
    if arguments.get(1).is_some_and(|argument| argument == "sample") {
        return sample::main(arguments.into_iter().skip(1), None);
    }
    // If a write then fails, the incomplete output is removed, as after any other error.
    crate::sandbox::let_large_writes_fail();
    let program = arguments.first().cloned().unwrap_or_default();
    let command = match parse_command(&arguments) {
        Ok(command) => command,
        Err(error) => return report_fault(&error),
    };
    let parsed = command.try_get_matches_from(arguments);
    let arguments = match parsed.and_then(|mut found| arguments::Arguments::from_arg_matches_mut(&mut found)) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are printed here as well. A closed pipe does not change the exit code.
            drop(error.print());
            return ExitCode::from(if error.use_stderr() { exit::FAULT } else { exit::ACCEPTED });
        }
    };
    console::choose_color(arguments.color);
    // If options precede the command, it was not recognized above.
    if let arguments::Command::Original(original) = &arguments.command {
        let name = [program.as_bytes(), b" original"].concat();
        return crate::original::main(&name, &original.arguments, &original::CliServices);
    }
    commands::run(&arguments.command).map_or_else(|error| report_fault(&error), ExitCode::from)
}

/// Returns the command line, with the defaults of the working folder.
fn parse_command(arguments: &[OsString]) -> Result<clap::Command> {
    let command = arguments::Arguments::command();
    match std::env::current_dir() {
        Ok(working) if arguments.iter().any(|argument| argument == "grade") => {
            defaults::add_defaults(command, &working)
        }
        _ => Ok(command),
    }
}

/// Prints an error, and returns the exit code for it.
fn report_fault(error: &anyhow::Error) -> ExitCode {
    // The message may contain file names, which are untrusted text.
    console::print_error(strip_control_characters(&format!("error: {error:#}\n")));
    ExitCode::from(exit::FAULT)
}
