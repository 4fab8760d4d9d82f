//! Errors that are never caused by the program.

use std::{
    io::{self, Read},
    process::Child,
};

use super::wire;

/// An error of the grader or the host. The program is never the cause.
#[derive(Debug, thiserror::Error)]
pub enum SandboxError {
    /// The host lacks a required layer.
    #[error("this host cannot run programs safely:\n{missing}")]
    MissingLayers {
        /// One line for each missing layer, with its remedy.
        missing: String,
    },
    /// The supervisor could not be started.
    #[error("cannot start the sandbox's supervisor {program}: {source}")]
    Supervisor {
        /// The file that was to be started as the supervisor.
        program: String,
        /// The error that the system reported.
        source: io::Error,
    },
    /// The supervisor ended without a report.
    #[error("the sandbox's supervisor ended unexpectedly ({how}); its processes were killed")]
    Lost {
        /// A description of the supervisor's end, such as its exit status.
        how: String,
    },
    /// A step of the set-up failed.
    #[error("the sandbox could not {stage}: {source}")]
    SetUp {
        /// The step of the set-up that failed.
        stage: String,
        /// The error that the system reported.
        source: io::Error,
    },
    /// The working folder cannot be used.
    #[error("cannot use the working folder {folder}: {source}")]
    Folder {
        /// The path of the working folder.
        folder: String,
        /// The error that the system reported.
        source: io::Error,
    },
    /// A path that the program should be able to read does not exist.
    #[error("cannot read {path}, which the program needs: {source}")]
    ReadablePath {
        /// The path that does not exist.
        path: String,
        /// The error that the system reported.
        source: io::Error,
    },
    /// The program was changed after the grader had copied it.
    #[error("{program} was changed or removed during grading by another program")]
    ChangedProgram {
        /// The path of the program.
        program: String,
    },
    /// Some processes of the run could not be killed.
    #[error("{count} processes of the program could not be killed; check this host for processes in state D")]
    Survivors {
        /// The number of processes that could not be killed.
        count: u32,
    },
}

/// Converts a failure that the supervisor reported.
pub(super) fn from_setup_failure(failure: wire::Failure) -> SandboxError {
    let source = match failure.errno {
        0 => io::Error::other("no further reason"),
        errno => io::Error::from_raw_os_error(errno),
    };
    SandboxError::SetUp { stage: failure.stage, source }
}

/// Returns the error for a supervisor that ended without a report. The caller must have closed its channel, so that
/// even a supervisor that is stuck ends.
pub(super) fn loss_error(mut child: Child) -> SandboxError {
    let status = child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
    let mut text = String::new();
    if let Some(stderr) = child.stderr.take() {
        // The last lines of the supervisor's output help to find the cause. They may be missing.
        let _ = stderr.take(2000).read_to_string(&mut text);
    }
    let text = text.trim();
    SandboxError::Lost { how: if text.is_empty() { status } else { format!("{status}: {text}") } }
}
