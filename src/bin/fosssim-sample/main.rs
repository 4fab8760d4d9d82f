//! `fosssim-sample`: stands for a student's submission.
//!
//! It speaks the course's protocol (`fosssim-sample -s scene.xml -d 0 -o trace.bin`) and can make documented
//! mistakes. Its physics is the library's second simulator, `student`; it never uses the one that judges, `sim`.
#![forbid(unsafe_code)]
#![expect(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "the walls are those of the library; a student's program opens files and calls what it likes"
)]

mod arguments;
mod hostile;
mod listing;
mod run;
mod trace;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match arguments::parse() {
        Ok(arguments) => arguments,
        Err(message) => {
            eprintln!("error: {message}");
            return ExitCode::from(2);
        }
    };
    let outcome = match arguments {
        arguments::Task::List { json } => listing::print(json),
        arguments::Task::Run(options) => run::run(&options),
    };
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
