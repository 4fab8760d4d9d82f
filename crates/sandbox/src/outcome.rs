//! The way a run ended, according to the kernel.

use std::{sync::Arc, time::Duration};

pub use fosssim_ended::{RunEnd, StartProblem};

use super::layers::LayerReport;

/// The output of a program to one stream.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CapturedOutput {
    /// The first bytes, up to the limit. They come from the program and must be escaped before they are displayed.
    pub bytes: Vec<u8>,
    /// Whether the output was longer than the limit.
    pub truncated: bool,
}

/// The outcome of one run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunOutcome {
    /// The way the run ended.
    pub ended: RunEnd,
    /// The processor time of the whole process tree, user and system.
    pub cpu: Duration,
    /// The wall time.
    pub wall: Duration,
    /// The peak of the resident memory in bytes.
    pub peak_memory: u64,
    /// The standard output.
    pub stdout: CapturedOutput,
    /// The standard error.
    pub stderr: CapturedOutput,
    /// The state of all layers during the run.
    pub layers: Arc<[LayerReport]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_reads_as_a_sentence_about_the_program() {
        assert_eq!(
            RunEnd::Signalled(libc::SIGSEGV).to_string(),
            "was killed by signal 11 (SIGSEGV: it accessed memory that does not belong to it)"
        );
        assert_eq!(RunEnd::TraceLimit.to_string(), "wrote more than allowed to the trace");
        assert_eq!(
            RunEnd::CouldNotStart(StartProblem::NotExecutable).to_string(),
            "could not start: the file is not executable; if it is the program, run chmod +x on it"
        );
    }
}
