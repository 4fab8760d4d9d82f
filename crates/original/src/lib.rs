//! The drop-in for the original program: its flags, its output, its files and its exit codes (oracle-behavior.md).
//!
//! Where the original crashes, hangs or runs out of memory, or needs a window, a clear message goes to standard error
//! and the exit code is 1. Files are written through, as the original does: a course's script may watch them, link
//! them or read them while they grow.
//!
//! The original's words about an assignment's things (its version, its name for a collision type or the second object
//! of a pair) are in `assignments`; the rest is the same for all assignments, and is here.
//!
//! A grader starts this once for every trace, and most scenes are small: then the time is that of loading the program's
//! pages. This is therefore a crate of its own, compiled at the full level, and uses nothing that few runs need: its
//! caller supplies the drawing of pictures and the words of messages ([`Services`]).
//!
//! A program becomes the drop-in by its name or its first word:
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
//!     fosssim_original::run_if_meant(&Plain).unwrap_or_else(|_words| ExitCode::from(2))
//! }
//! ```
#![forbid(unsafe_code)]

mod arguments;
mod collisions;
mod flags;
mod run;
mod transcript;
mod usage;
mod verdict;
mod words;

pub use words::NO_PICTURE_FOLDER;

use fosssim_model::scene::Scene;
use std::{
    env,
    ffi::OsString,
    io::{self, Write},
    os::unix::ffi::OsStrExt,
    path::Path,
    process::ExitCode,
};

/// Names of the program that make it behave as the original, whatever follows in the name.
const NAME: &[u8] = b"FOSSSimOracle";

/// Returns the name that messages show, and the words for the drop-in, if it is meant: by the program's name
/// `FOSSSimOracle...`, or by the first word, `original`.
fn meant(words: &[OsString]) -> Option<(Vec<u8>, &[OsString])> {
    let (program, rest) = words.split_first()?;
    let program = program.as_bytes();
    let file = program.rsplit(|&byte| byte == b'/').next().unwrap_or_default();
    if file.starts_with(NAME) {
        return Some((program.to_vec(), rest));
    }
    let (first, rest) = rest.split_first()?;
    (first == "original").then(|| ([program, b" original"].concat(), rest))
}

/// Runs the drop-in, if the words of the command line mean it.
///
/// # Errors
/// Other words, for other commands; the program's own name first.
pub fn run_if_meant(outside: &dyn Services) -> Result<ExitCode, Vec<OsString>> {
    let words: Vec<OsString> = env::args_os().collect();
    match meant(&words) {
        Some((program, words)) => {
            outside.prepare();
            Ok(main(&program, words, outside))
        }
        None => Err(words),
    }
}

/// The services that the drop-in needs from the program around it.
pub trait Services {
    /// Prepares the run, before anything else is done.
    fn prepare(&self);

    /// Returns a drawer of pictures: of `-g 1` as PNG, of `-m DIR` as SVG in that folder.
    ///
    /// # Errors
    /// The text to print, when a folder is missing.
    fn pictures(&self, png: bool, svg: Option<&Path>, scene: &Scene) -> Result<Box<dyn Pictures>, String>;
}

/// Draws after each step.
pub trait Pictures {
    /// Draws the state after a step, from 1; positions as in [`State`](fosssim_model::sim::State).
    ///
    /// # Errors
    /// The text to print, when a picture can't be written.
    fn step(&mut self, step: u32, positions: &[f64]) -> Result<(), String>;
}

/// Runs the drop-in; `program` is the name that its messages show, `words` are the arguments.
#[must_use]
pub fn main(program: &[u8], words: &[OsString], outside: &dyn Services) -> ExitCode {
    let words: Vec<Vec<u8>> = words.iter().map(|word| word.as_bytes().to_vec()).collect();
    let code = match arguments::parse(program, &words) {
        Ok(arguments) => run::run(&arguments, &words, outside),
        Err(ending) => {
            // Nobody listening, or a full disk, does not change the exit code; the original does not notice either.
            let mut stdout = io::stdout().lock();
            drop(stdout.write_all(&ending.stdout).and_then(|()| stdout.flush()));
            complain(&ending.stderr);
            ending.exit_code
        }
    };
    ExitCode::from(code)
}

/// Prints to standard error; there is nowhere left to report a failure.
fn complain(text: &[u8]) {
    drop(io::stderr().lock().write_all(text));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_decides_by_its_beginning_and_not_by_its_folder() {
        let meant = |words: &[&str]| {
            let words: Vec<OsString> = words.iter().map(OsString::from).collect();
            meant(&words).map(|(name, rest)| (String::from_utf8(name).unwrap(), rest.len()))
        };
        assert_eq!(meant(&["FOSSSimOracle"]), Some(("FOSSSimOracle".to_owned(), 0)));
        assert_eq!(meant(&["../bin/FOSSSimOracleT2M2", "-h"]), Some(("../bin/FOSSSimOracleT2M2".to_owned(), 1)));
        assert_eq!(meant(&["x/fosssim-oracle", "original", "-h"]), Some(("x/fosssim-oracle original".to_owned(), 1)));
        assert_eq!(meant(&["/opt/FOSSSimOracle/fosssim-oracle"]), None);
        assert_eq!(meant(&["fosssim-oracle", "grade", "original"]), None);
        assert_eq!(meant(&[""]), None);
        assert_eq!(meant(&[]), None);
    }
}
