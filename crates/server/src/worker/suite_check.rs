//! Checks that a suite is usable, before any submission is graded with it.
use super::{
    child::{Child, End, set_limits},
    program::isolate,
};
use crate::health::strip_paths;
use std::{fs, path::Path, process::Command, time::Duration};

/// The maximum wall time and processor time of the grader's check, in seconds.
const MAX_SECONDS: u64 = 60;

/// The maximum memory of the grader's check, in bytes.
const MAX_MEMORY: u64 = 2 << 30;

/// The maximum length of the grader's output in the message.
const MAX_MESSAGE_LENGTH: usize = 2000;

/// Checks the suite in a folder with the grader. If the grader has no command `suite check`, the suite is accepted.
///
/// # Errors
///
/// Fails if the grader rejects the suite. The error contains the grader's output, without paths of this machine.
pub async fn check_suite(grader: &Path, folder: &Path) -> Result<(), String> {
    let messages = tempfile::NamedTempFile::new_in(folder).map_err(|error| error.to_string())?;
    let mut command = Command::new(grader);
    command.args(["suite", "check", "suite.toml"]);
    isolate(&mut command, folder);
    command.stderr(messages.reopen().map_err(|error| error.to_string())?);
    set_limits(&mut command, MAX_MEMORY, MAX_SECONDS);
    let child = Child::start(command).map_err(|error| format!("cannot start the grader: {error}"))?;
    let Ok(end) = tokio::time::timeout(Duration::from_secs(MAX_SECONDS), child.wait()).await else {
        child.kill();
        child.wait().await;
        return Err(format!("the grader did not finish checking the suite within {MAX_SECONDS} seconds"));
    };
    let output = fs::read(messages.path()).unwrap_or_default();
    let output = String::from_utf8_lossy(&output[..output.len().min(MAX_MESSAGE_LENGTH)]).into_owned();
    tracing::info!(?end, output, "the grader checked a suite");
    match (end, output.trim().strip_prefix("error:")) {
        (End::Code(0), _) => Ok(()),
        (End::Code(_), Some(said)) if !said.contains("unrecognized subcommand") => Err(strip_paths(
            &said
                .lines()
                .map(str::trim)
                .filter(|line| !line.is_empty())
                .collect::<Vec<_>>()
                .join(";\n")
                .replace(":;\n", ": "),
        )),
        (End::Code(_), _) => Ok(()),
        (End::Signal(_), _) => {
            Err("the grader failed while checking the suite, perhaps because of its size".to_owned())
        }
    }
}
