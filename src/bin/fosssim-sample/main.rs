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

use arguments::Options;
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    // A fault of syntax ends the program with status 2.
    let options = Options::parse();
    let outcome = match options.student() {
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
