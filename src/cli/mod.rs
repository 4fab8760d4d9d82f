//! The command line: arguments, files, the terminal. Only this module opens files; all others use bytes.

mod arguments;
mod commands;
mod console;
mod defaults;
pub mod exit;
mod input;
mod interrupt;
mod original;
mod output;
mod screen;
mod selection;

use crate::{report::foreign::strip_control_characters, sample};
use anyhow::Result;
use clap::{CommandFactory, FromArgMatches};
use std::{ffi::OsString, os::unix::ffi::OsStrExt, process::ExitCode};

/// Runs the command in the program's arguments.
#[must_use]
pub fn main() -> ExitCode {
    // A copy with a pinned mistake is only a submission.
    if let Some(mistake) = sample::pin::pinned_mistake() {
        return sample::main(std::env::args_os(), Some(mistake));
    }
    // This is checked before all other commands, because it is called most often and must start fast.
    crate::original::run_if_meant(&original::Program).unwrap_or_else(run)
}

/// Runs any other command.
fn run(words: Vec<OsString>) -> ExitCode {
    // This must come before everything else and before any thread: the process may be a sandbox's supervisor.
    if let Some(code) = crate::sandbox::supervisor_main(words.iter().cloned()) {
        return code;
    }
    commands::shell::complete_if_asked();
    if words.get(1).is_some_and(|word| word == "sample") {
        return sample::main(words.into_iter().skip(1), None);
    }
    // A failed write then removes the incomplete output, like any other error.
    crate::sandbox::let_large_writes_fail();
    let program = words.first().cloned().unwrap_or_default();
    let command = match parse_command(&words) {
        Ok(command) => command,
        Err(error) => return report_fault(&error),
    };
    let parsed = command.try_get_matches_from(words);
    let arguments = match parsed.and_then(|mut found| arguments::Arguments::from_arg_matches_mut(&mut found)) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are reported here, too. A closed pipe does not change the exit code.
            drop(error.print());
            return ExitCode::from(if error.use_stderr() { exit::FAULT } else { exit::ACCEPTED });
        }
    };
    console::choose_color(arguments.color);
    // With options before it, the command was not recognized above.
    if let arguments::Command::Original(original) = &arguments.command {
        let name = [program.as_bytes(), b" original"].concat();
        return crate::original::main(&name, &original.words, &original::Program);
    }
    commands::run(&arguments.command).map_or_else(|error| report_fault(&error), ExitCode::from)
}

/// Returns the command line, with the defaults in the working folder.
fn parse_command(words: &[OsString]) -> Result<clap::Command> {
    let command = arguments::Arguments::command();
    match std::env::current_dir() {
        Ok(working) if words.iter().any(|word| word == "grade") => defaults::add(command, &working),
        _ => Ok(command),
    }
}

/// Prints an error.
fn report_fault(error: &anyhow::Error) -> ExitCode {
    // File names in the message are untrusted text.
    console::print_error(strip_control_characters(&format!("error: {error:#}\n")));
    ExitCode::from(exit::FAULT)
}
