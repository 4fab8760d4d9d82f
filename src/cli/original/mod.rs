//! The drop-in for the original program: its flags, its output, its files and its exit codes (oracle-behaviour.md).
//!
//! Where the original crashes, hangs or runs out of memory, or needs a window, a clear message goes to standard error
//! and the exit code is 1. Files are written through, as the original does: a course's script may watch them, link
//! them or read them while they grow.

mod arguments;
mod flags;
mod pictures;
mod run;
mod usage;

use std::{
    ffi::{OsStr, OsString},
    os::unix::ffi::OsStrExt,
    process::ExitCode,
};

/// Names of the program that make it behave as the original, whatever follows in the name.
const NAME: &[u8] = b"FOSSSimOracle";

/// Whether the program was called under the original's name.
pub(super) fn is_called(program: &OsStr) -> bool {
    let file = program.as_bytes().rsplit(|&byte| byte == b'/').next().unwrap_or_default();
    file.starts_with(NAME)
}

/// Runs the drop-in; `program` is the name that its messages show.
pub(super) fn main(program: &[u8], words: &[OsString]) -> ExitCode {
    let words: Vec<Vec<u8>> = words.iter().map(|word| word.as_bytes().to_vec()).collect();
    let code = match arguments::parse(program, &words) {
        Ok(arguments) => run::run(&arguments, &words),
        Err(ending) => {
            // Nobody listening, or a full disk, does not change the exit code; the original does not notice either.
            drop(super::console::print(&ending.stdout));
            super::console::complain(&ending.stderr);
            ending.exit_code
        }
    };
    ExitCode::from(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_decides_by_its_beginning_and_not_by_its_folder() {
        assert!(is_called("FOSSSimOracle".as_ref()));
        assert!(is_called("../bin/FOSSSimOracleT2M2".as_ref()));
        assert!(!is_called("/opt/FOSSSimOracle/fosssim-oracle".as_ref()));
        assert!(!is_called("".as_ref()));
    }
}
