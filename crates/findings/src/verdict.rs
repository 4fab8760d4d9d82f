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

    /// Returns the short code and the words.
    const fn texts(self) -> (&'static str, &'static str) {
        match self {
            Self::Accepted => ("AC", "accepted"),
            Self::NotRun => ("--", "not run"),
            Self::Unwritten => ("NW", "nothing written"),
            Self::WrongAnswer => ("WA", "wrong answer"),
            Self::BadTrace => ("BT", "bad trace"),
            Self::NoOutput => ("NO", "no output"),
            Self::OutputLimit => ("OLE", "output limit"),
            Self::MemoryLimit => ("MLE", "memory limit"),
            Self::TimeLimit => ("TLE", "time limit"),
            Self::RuntimeError => ("RTE", "run-time error"),
            Self::Unusable => ("US", "unusable submission"),
            Self::CompileError => ("CE", "compile error"),
            Self::Violation => ("SV", "sandbox violation"),
            Self::JudgeError => ("JE", "judge error"),
        }
    }

    /// Returns the short code, for tables and spreadsheets.
    #[must_use]
    pub const fn code(self) -> &'static str {
        self.texts().0
    }

    /// Returns the verdict of a code.
    #[must_use]
    pub fn from_code(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| verdict.code() == code)
    }

    /// Returns the words, as reports and JSON write them.
    #[must_use]
    pub const fn text(self) -> &'static str {
        self.texts().1
    }

    /// Returns whether it says of the trace, and not of how the program ended, that it is wrong.
    #[must_use]
    pub const fn is_wrong_trace(self) -> bool {
        matches!(self, Self::Unwritten | Self::WrongAnswer | Self::BadTrace)
    }

    /// Returns whether the scene's points are due in full.
    #[must_use]
    pub const fn is_accepted(self) -> bool {
        matches!(self, Self::Accepted)
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.pad(self.text())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_the_list_is_the_order_of_severity() {
        assert!(Verdict::ALL.is_sorted());
        assert_eq!(Verdict::Accepted.max(Verdict::TimeLimit), Verdict::TimeLimit);
        let words: std::collections::BTreeSet<&str> = Verdict::ALL.map(Verdict::text).into();
        assert_eq!(words.len(), Verdict::ALL.len());
    }
}
