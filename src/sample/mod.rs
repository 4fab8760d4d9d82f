//! The sample, which acts as a student's submission.
//!
//! It implements the course's protocol (`-s scene.xml -d 0 -o trace.bin`) and can make documented mistakes. It
//! simulates with the second simulator, `student`, and not with `sim`, which judges. `fosssim-oracle sample` runs it,
//! and so does every copy of the program with a [pinned](pinned_mistake) mistake.
#![expect(
    clippy::disallowed_methods,
    reason = "the rules are for libraries; a student's program may open files and call any function"
)]

mod arguments;
mod listing;
pub mod pinned_mistake;
mod run;

use arguments::Options;
use clap::Parser;
use std::{ffi::OsString, process::ExitCode};

/// Runs the sample. `arguments` is the command line, which begins with the program's name, and `pinned` is the mistake
/// that is pinned to this program.
pub fn main(arguments: impl Iterator<Item = OsString>, pinned: Option<&str>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.collect();
    // If the command line is wrong, this ends the program with the status 2.
    let options = Options::parse_from(&arguments);
    let outcome = match options.choose_student(pinned, arguments.first()) {
        _ if options.list => listing::print(options.json),
        Ok(student) => run::run(&options, student),
        Err(message) => {
            eprintln!("error: {message}");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
