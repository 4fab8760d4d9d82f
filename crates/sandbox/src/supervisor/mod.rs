//! The supervisor is a new process of this binary. It runs one program, and reports after all processes have ended.
//!
//! It never reads a scene, a trace or a verdict. It trusts the kernel's wait status, counters and announcements, but
//! not the program's output.

mod answers;
mod calls;
mod child;
mod file_rules;
mod file_view;
mod filter;
mod folder;
mod group;
mod hidden_usage;
mod keeper;
mod locks;
mod memory_folder;
mod modes;
mod namespaces;
pub(super) mod orphans;
mod prepared_run;
mod probe;
pub(super) mod processes;
mod run;
mod streams;
mod user_slot;

use std::{ffi::OsString, process::ExitCode};

pub(super) use self::{folder::open_closed_folders, group::memory_groups};
use super::wire::SUPERVISOR_ARGUMENT;

/// The mode in which the supervisor serves one run.
pub(super) const MODE_RUN: &str = "run";
/// The mode in which the supervisor serves all runs of one submission.
pub(super) const MODE_KEEP: &str = "keep";
/// The mode in which the supervisor tests the layers and reports the results.
pub(super) const MODE_PROBE: &str = "probe";

/// Turns this process into a supervisor, if it was started as one. Returns its exit code then, and otherwise `None`.
///
/// A program that uses the sandbox must call this first in its `main`, before it starts any thread, with its own
/// arguments (`std::env::args_os()`), and must return the code if there is one.
pub fn supervisor_main(arguments: impl IntoIterator<Item = OsString>) -> Option<ExitCode> {
    let mut arguments = arguments.into_iter().skip(1);
    if arguments.next()? != SUPERVISOR_ARGUMENT {
        return None;
    }
    let mode = arguments.next().unwrap_or_default();
    Some(match mode.to_str() {
        Some(MODE_RUN) => run::main(),
        Some(MODE_KEEP) => keeper::main(),
        Some(MODE_PROBE) => probe::main(),
        _ => ExitCode::from(2),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_arguments_are_not_the_supervisors() {
        let words = |list: &[&str]| list.iter().map(OsString::from).collect::<Vec<_>>();
        assert!(supervisor_main(words(&[])).is_none());
        assert!(supervisor_main(words(&["fosssim-oracle"])).is_none());
        assert!(supervisor_main(words(&["fosssim-oracle", "grade", SUPERVISOR_ARGUMENT])).is_none());
        assert!(supervisor_main(words(&["fosssim-oracle", SUPERVISOR_ARGUMENT, "nonsense"])).is_some());
    }
}
