//! `fosssim-sample`: stands for a student's submission.
//!
//! It speaks the course's protocol (`fosssim-sample -s scene.xml -d 0 -o trace.bin`), simulates with code of its own,
//! and can make one documented mistake. What it takes from the library is what the course supplies: the scene loader,
//! the vectors, the linear solver and the root finder. It never uses the library's simulator.

#![expect(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "the walls are those of the library; a student's program opens files and calls what it likes"
)]

mod arguments;
mod catalogue;
mod continuous_time;
mod detection;
mod failsafe;
mod forces;
mod hessians;
mod hostile;
mod hybrid;
mod impulses;
mod integrators;
mod listing;
mod penalty;
mod response;
mod run;
mod simple;
mod trace;
mod world;
mod zones;

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
