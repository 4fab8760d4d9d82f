//! Runs the originals with limits of time and memory: some input makes them run forever or use all memory.
use fosssim_oracle::assignments::Assignment;
use fosssim_testing::{Need, skip};
use std::{
    ffi::OsStr,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use crate::workspace::{Run, finish};

/// The time limit of a run, in seconds.
const SECONDS: &str = "20";

/// The memory limit of a run, in KiB.
const MEMORY: &str = "4000000";

/// The folder of the originals: `FOSSSIM_ORIGINALS`, or else `../shared/originals` next to the checkout.
#[derive(Debug)]
pub struct Originals(PathBuf);

impl Originals {
    /// Returns the folder, or prints that the calling test is skipped.
    pub fn find() -> Option<Self> {
        let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/originals");
        let folder = std::env::var_os("FOSSSIM_ORIGINALS").map_or(beside, PathBuf::from);
        if folder.join("oracle").is_file() {
            return Some(Self(folder.canonicalize().expect("a folder")));
        }
        skip(Need::Originals, format_args!("there are none at {}", folder.display()));
        None
    }

    /// Returns the folder of the programs, which is next to that of the originals.
    pub fn programs(&self) -> PathBuf {
        self.0.with_file_name("programs")
    }

    /// Returns the command that runs a milestone's original in a folder.
    pub fn command(&self, milestone: Assignment, folder: &Path) -> Command {
        let mut command = Command::new("sh");
        let limits = format!("ulimit -v {MEMORY}; exec timeout {SECONDS} \"$@\"");
        command.args(["-c", &limits, "sh"]).arg(self.0.join("oracle")).arg(milestone.key());
        command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Runs a milestone's original in a folder.
    pub fn run<S: AsRef<OsStr>>(
        &self,
        milestone: Assignment,
        folder: &Path,
        arguments: impl IntoIterator<Item = S>,
    ) -> Run {
        finish(self.command(milestone, folder).args(arguments))
    }
}
