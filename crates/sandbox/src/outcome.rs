//! The way a run ended, as the kernel saw it.

use std::{sync::Arc, time::Duration};

pub use fosssim_ended::{RunEnd, StartProblem};

use super::layers::LayerReport;

/// The output of a program to one stream.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CapturedOutput {
    /// The first bytes, up to the limit. They are the program's words: escape them before they are shown.
    pub bytes: Vec<u8>,
    /// Whether there was more.
    pub truncated: bool,
}

/// The outcome of one run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunOutcome {
    /// The way it ended.
    pub ended: RunEnd,
    /// Processor time, user and system, of the whole tree.
    pub cpu: Duration,
    /// Time on the clock.
    pub wall: Duration,
    /// Peak of the resident memory in bytes.
    pub peak_memory: u64,
    /// Standard output.
    pub stdout: CapturedOutput,
    /// Standard error.
    pub stderr: CapturedOutput,
    /// The layers that were active; a report states those that were not.
    pub layers: Arc<[LayerReport]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_reads_as_a_sentence_about_the_program() {
        assert_eq!(
            RunEnd::Signalled(libc::SIGSEGV).to_string(),
            "ended by signal 11 (SIGSEGV: it used memory that is not its own)"
        );
        assert_eq!(RunEnd::TraceLimit.to_string(), "wrote more than allowed to the trace");
        assert_eq!(
            RunEnd::CouldNotStart(StartProblem::NotExecutable).to_string(),
            "could not start: the file is not executable; if it is the program, run chmod +x on it"
        );
    }
}
