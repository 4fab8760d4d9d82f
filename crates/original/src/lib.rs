//! The replacement for the original program, with its flags, output, files and exit codes (oracle-behavior.md).
//!
//! If the original would crash, hang, run out of memory or open a window, this program prints a message to standard
//! error and exits with 1. Files are written in place like the original's, because a course's script may watch, link or
//! read them while they grow.
//!
//! The original's texts that depend on an assignment (its version, its name for a collision type or for the second
//! object of a pair) are in `assignments`; the texts common to all assignments are here.
//!
//! A grader starts this program once per trace, and for small scenes most of the time is spent loading the program's
//! pages. It is therefore a separate crate, compiled with full optimization, and excludes features that few runs need.
//! Its caller provides pictures and messages ([`Services`]).
//!
//! A program becomes the replacement by its name or its first argument:
//!
//! ```no_run
//! use fosssim_original::{Pictures, Services};
//! use std::{path::Path, process::ExitCode};
//! # use fosssim_model::scene::Scene;
//!
//! /// A program that draws no pictures.
//! struct Plain;
//!
//! impl Services for Plain {
//!     fn prepare(&self) {}
//!
//!     fn pictures(&self, _png: bool, _svg: Option<&Path>, _scene: &Scene) -> Result<Box<dyn Pictures>, String> {
//!         Err("this program draws no pictures".to_owned())
//!     }
//! }
//!
//! fn main() -> ExitCode {
//!     fosssim_original::run_if_requested(&Plain).unwrap_or_else(|_arguments| ExitCode::from(2))
//! }
//! ```
#![forbid(unsafe_code)]

mod arguments;
mod collisions;
mod flags;
mod messages;
mod run;
mod transcript;
mod usage;
mod verdict;

pub use messages::NO_PICTURE_FOLDER;

use fosssim_model::scene::Scene;
use std::{
    env,
    ffi::OsString,
    io::{self, Write},
    os::unix::ffi::OsStrExt,
    path::Path,
    process::ExitCode,
};

/// The prefix of the program's names that make it behave like the original.
const PROGRAM_PREFIX: &[u8] = b"FOSSSimOracle";

/// Returns the name for messages and the arguments if the command line requests the replacement, otherwise `None`. It
/// does so by the program's name `FOSSSimOracle...`, or by the first argument `original`.
fn parse_call(arguments: &[OsString]) -> Option<(Vec<u8>, &[OsString])> {
    let (program, rest) = arguments.split_first()?;
    let program = program.as_bytes();
    let file = program.rsplit(|&byte| byte == b'/').next().unwrap_or_default();
    if file.starts_with(PROGRAM_PREFIX) {
        return Some((program.to_vec(), rest));
    }
    let (first, rest) = rest.split_first()?;
    (first == "original").then(|| ([program, b" original"].concat(), rest))
}

/// Runs the replacement, if the command line requests it.
///
/// # Errors
/// Fails with the arguments for other commands, beginning with the program's own name.
pub fn run_if_requested(outside: &dyn Services) -> Result<ExitCode, Vec<OsString>> {
    let arguments: Vec<OsString> = env::args_os().collect();
    match parse_call(&arguments) {
        Some((program, arguments)) => {
            outside.prepare();
            Ok(main(&program, arguments, outside))
        }
        None => Err(arguments),
    }
}

/// The services that the replacement needs from the surrounding program.
pub trait Services {
    /// Prepares the run, before any other work.
    fn prepare(&self);

    /// Returns a drawer of pictures: PNG for `-g 1`, SVG in the folder of `-m DIR`.
    ///
    /// # Errors
    /// Fails if a folder is missing, with the text to print.
    fn pictures(&self, png: bool, svg: Option<&Path>, scene: &Scene) -> Result<Box<dyn Pictures>, String>;
}

/// A drawer of pictures that show the state after each step.
pub trait Pictures {
    /// Draws the state after a step, counted from 1; positions are in the order of
    /// [`State`](fosssim_model::sim::State).
    ///
    /// # Errors
    /// Fails if a picture cannot be written, with the text to print.
    fn step(&mut self, step: u32, positions: &[f64]) -> Result<(), String>;
}

/// Runs the replacement. `program` is the name in its messages, and `arguments` are the arguments after it.
pub fn main(program: &[u8], arguments: &[OsString], outside: &dyn Services) -> ExitCode {
    let arguments: Vec<Vec<u8>> = arguments.iter().map(|argument| argument.as_bytes().to_vec()).collect();
    let code = match arguments::parse(program, &arguments) {
        Ok(parsed) => run::run(&parsed, &arguments, outside),
        Err(ending) => {
            // A closed output or a full disk does not change the exit code, because the original ignores both.
            let mut stdout = io::stdout().lock();
            drop(stdout.write_all(&ending.stdout).and_then(|()| stdout.flush()));
            print_error(&ending.stderr);
            ending.exit_code
        }
    };
    ExitCode::from(code)
}

/// Prints to standard error. A failure to do so cannot be reported.
fn print_error(text: &[u8]) {
    drop(io::stderr().lock().write_all(text));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_decides_by_its_beginning_and_not_by_its_folder() {
        let parse_call = |arguments: &[&str]| {
            let arguments: Vec<OsString> = arguments.iter().map(OsString::from).collect();
            parse_call(&arguments).map(|(name, rest)| (String::from_utf8(name).unwrap(), rest.len()))
        };
        assert_eq!(parse_call(&["FOSSSimOracle"]), Some(("FOSSSimOracle".to_owned(), 0)));
        assert_eq!(parse_call(&["../bin/FOSSSimOracleT2M2", "-h"]), Some(("../bin/FOSSSimOracleT2M2".to_owned(), 1)));
        assert_eq!(
            parse_call(&["x/fosssim-oracle", "original", "-h"]),
            Some(("x/fosssim-oracle original".to_owned(), 1))
        );
        assert_eq!(parse_call(&["/opt/FOSSSimOracle/fosssim-oracle"]), None);
        assert_eq!(parse_call(&["fosssim-oracle", "grade", "original"]), None);
        assert_eq!(parse_call(&[""]), None);
        assert_eq!(parse_call(&[]), None);
    }
}
