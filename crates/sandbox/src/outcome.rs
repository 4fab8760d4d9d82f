//! The outcome of a run, as the kernel reports it.

use std::{sync::Arc, time::Duration};

pub use fosssim_ended::{RunEnd, StartProblem};

use super::layers::LayerReport;

/// The bytes that a program wrote to standard output or standard error.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CapturedOutput {
    /// The first bytes, up to the limit. They are not trusted, and must be escaped before they are displayed.
    pub bytes: Vec<u8>,
    /// Whether the output was longer than the limit.
    pub truncated: bool,
}

/// The outcome of a run of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunOutcome {
    /// The result of the run.
    pub ended: RunEnd,
    /// The processor time of all processes of the run, in user mode and in the kernel.
    pub cpu: Duration,
    /// The wall time of the run.
    pub wall: Duration,
    /// The largest amount of resident memory, in bytes.
    pub peak_memory: u64,
    /// The bytes that the program wrote to standard output.
    pub stdout: CapturedOutput,
    /// The bytes that the program wrote to standard error.
    pub stderr: CapturedOutput,
    /// Reports on all layers, as they were during the run.
    pub layers: Arc<[LayerReport]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_reads_as_a_sentence_about_the_program() {
        assert_eq!(
            RunEnd::Signaled(libc::SIGSEGV).to_string(),
            "was killed by signal 11 (SIGSEGV: it accessed memory that does not belong to it)"
        );
        assert_eq!(RunEnd::TraceLimit.to_string(), "wrote more than allowed to the trace");
        assert_eq!(
            RunEnd::CouldNotStart(StartProblem::NotExecutable).to_string(),
            "could not start: the file is not executable; if it is the program, run chmod +x on it"
        );
    }
}
