//! Verdicts on one scene or one submission.
use serde::{Deserialize, Serialize};

/// The verdict words, from best to worst; of several, the worst counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Verdict {
    /// Everything is right.
    Accepted,
    /// The scene was not run, because the grading was cut short.
    NotRun,
    /// The trace is complete, and nothing is logged in it: what the assignment asks for is not written yet.
    Unwritten,
    /// The trace is complete and wrong.
    WrongAnswer,
    /// The trace can't be read to its end.
    BadTrace,
    /// No trace was written.
    NoOutput,
    /// The program wrote too much.
    OutputLimit,
    /// The program needed too much memory.
    MemoryLimit,
    /// The program took too long.
    TimeLimit,
    /// The program crashed or ended with an error code.
    RuntimeError,
    /// The submission itself can't be run: no program is in it, or none that this machine can start.
    Unusable,
    /// The program's sources do not build.
    CompileError,
    /// The program tried what the sandbox forbids.
    Violation,
    /// The grader failed. Never the student's fault, never the student's score.
    JudgeError,
}

impl Verdict {
    /// All verdicts, best first.
    pub const ALL: [Self; 14] = [
        Self::Accepted,
        Self::NotRun,
        Self::Unwritten,
        Self::WrongAnswer,
        Self::BadTrace,
        Self::NoOutput,
        Self::OutputLimit,
        Self::MemoryLimit,
        Self::TimeLimit,
        Self::RuntimeError,
        Self::Unusable,
        Self::CompileError,
        Self::Violation,
        Self::JudgeError,
    ];

    /// The short code, for tables and spreadsheets.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::Accepted => "AC",
            Self::NotRun => "--",
            Self::Unwritten => "NW",
            Self::WrongAnswer => "WA",
            Self::BadTrace => "BT",
            Self::NoOutput => "NO",
            Self::OutputLimit => "OLE",
            Self::MemoryLimit => "MLE",
            Self::TimeLimit => "TLE",
            Self::RuntimeError => "RTE",
            Self::Unusable => "US",
            Self::CompileError => "CE",
            Self::Violation => "SV",
            Self::JudgeError => "JE",
        }
    }

    /// The words, as reports and JSON write them.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::NotRun => "not run",
            Self::Unwritten => "nothing written",
            Self::WrongAnswer => "wrong answer",
            Self::BadTrace => "bad trace",
            Self::NoOutput => "no output",
            Self::OutputLimit => "output limit",
            Self::MemoryLimit => "memory limit",
            Self::TimeLimit => "time limit",
            Self::RuntimeError => "run-time error",
            Self::Unusable => "unusable submission",
            Self::CompileError => "compile error",
            Self::Violation => "sandbox violation",
            Self::JudgeError => "judge error",
        }
    }

    /// The verdict with these words.
    #[must_use]
    pub fn from_words(words: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| verdict.words() == words)
    }

    /// Whether it says of the trace, and not of how the program ended, that it is wrong.
    #[must_use]
    pub const fn is_wrong_trace(self) -> bool {
        matches!(self, Self::Unwritten | Self::WrongAnswer | Self::BadTrace)
    }

    /// Whether the scene's points are due in full.
    #[must_use]
    pub const fn is_accepted(self) -> bool {
        matches!(self, Self::Accepted)
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.pad(self.words())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_the_list_is_the_order_of_severity() {
        assert!(Verdict::ALL.is_sorted());
        assert_eq!(Verdict::Accepted.max(Verdict::TimeLimit), Verdict::TimeLimit);
        for verdict in Verdict::ALL {
            assert_eq!(Verdict::from_words(verdict.words()), Some(verdict));
        }
    }
}
