//! Verdicts on one scene or one submission.
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// The verdict on a scene, a group or a submission. They are ordered from best to worst; of several verdicts, the
    /// worst counts.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum Verdict {
        /// The trace meets all rules.
        Accepted = "accepted", "AC";
        /// The scene was not run, because the grading ended before it.
        NotRun = "not run", "--";
        /// The trace is complete, but its logs are empty: the student has not written the required code.
        Unwritten = "nothing written", "NW";
        /// The trace is complete, but wrong.
        WrongAnswer = "wrong answer", "WA";
        /// The trace can't be read to its end.
        BadTrace = "bad trace", "BT";
        /// No trace was written.
        NoOutput = "no output", "NO";
        /// The program wrote too much.
        OutputLimit = "output limit", "OLE";
        /// The program needed too much memory.
        MemoryLimit = "memory limit", "MLE";
        /// The program took too long.
        TimeLimit = "time limit", "TLE";
        /// The program crashed or ended with an error code.
        RuntimeError = "run-time error", "RTE";
        /// The submission cannot be run, because it has no program that this machine can start.
        Unusable = "unusable submission", "US";
        /// The program's sources could not be built.
        CompileError = "compile error", "CE";
        /// The program tried something that the sandbox forbids.
        Violation = "sandbox violation", "SV";
        /// The grader failed, which is never the student's fault and never costs points.
        JudgeError = "judge error", "JE";
    }
    /// Returns the code of the verdict, for tables and spreadsheets.
    code
}

impl Verdict {
    /// Returns the verdict with this code, or `None` if there is none.
    pub fn from_code(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| verdict.code() == code)
    }

    /// Returns whether the verdict is about the contents of a trace, and not about how the program ended.
    pub const fn is_wrong_trace(self) -> bool {
        matches!(self, Self::Unwritten | Self::WrongAnswer | Self::BadTrace)
    }

    /// Returns whether the scene gets its full points.
    pub const fn is_accepted(self) -> bool {
        matches!(self, Self::Accepted)
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_the_list_is_the_order_of_severity() {
        assert!(Verdict::ALL.is_sorted());
        assert_eq!(Verdict::Accepted.max(Verdict::TimeLimit), Verdict::TimeLimit);
        let words: std::collections::BTreeSet<&str> = Verdict::ALL.map(Verdict::name).into();
        assert_eq!(words.len(), Verdict::ALL.len());
    }
}
