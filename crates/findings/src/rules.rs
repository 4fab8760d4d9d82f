//! The two rule books, the choice between them, and verdicts in words that both share.
//!
//! The original's rules are always applied, because everything else uses their replay of the trace. The fair rules are
//! applied only if they are requested.
use super::{
    book_findings::BookFindings,
    fair,
    outcome::{Outcome, Stop},
    parity::Overall,
};
use serde::{Deserialize, Serialize};

/// A set of rules by which traces are judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Book {
    /// The original's rules, as its program applies them (oracle-behavior.md 4 to 6).
    #[default]
    Parity,
    /// Rules whose verdicts do not depend on round-off, on the scale of the scene, or on the course's slip (numerics.md
    /// 2).
    Fair,
}

fosssim_num::closed_set! {
    /// The rule books that judge a trace.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "lowercase")]
    pub enum Rules {
        /// Only the original's rules.
        Parity = "parity",
        /// The fair rules in addition; they give the official verdict.
        Fair = "fair",
        /// Both rule books. The original's rules give the official verdict, and reports show where the fair rules
        /// differ.
        #[default]
        Both = "both",
    }
}

impl Rules {
    /// Returns the rule book whose verdict decides exit codes and points.
    pub const fn official(self) -> Book {
        match self {
            Self::Parity | Self::Both => Book::Parity,
            Self::Fair => Book::Fair,
        }
    }

    /// Returns whether the fair rules are requested.
    pub const fn includes_fair(self) -> bool {
        !matches!(self, Self::Parity)
    }
}

fosssim_num::closed_set! {
    /// The verdict by one rule book, in words that both books share.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Ruling {
        /// The trace meets all rules.
        Accepted = "accepted",
        /// No fault was found before judging stopped.
        Undecided = "undecided",
        /// The trace is wrong.
        WrongAnswer = "wrong answer",
        /// The trace cannot be read to its end. By the fair rules it may also be damaged, or have bytes after its end.
        BadTrace = "bad trace",
    }
}

impl Outcome {
    /// Returns the verdict by a rule book. If the fair rules were not applied, it is that by the original's rules.
    pub fn ruling(&self, book: Book) -> Ruling {
        match (book, &self.fair) {
            (Book::Fair, Some(fair)) => match (fair.verdict, fair.rejection) {
                (fair::FairVerdict::Accepted, _) => Ruling::Accepted,
                (fair::FairVerdict::Rejected, None | Some(fair::FairRejection::Undecided)) => Ruling::WrongAnswer,
                (fair::FairVerdict::Rejected, Some(_)) => Ruling::BadTrace,
                (fair::FairVerdict::None, _) => Ruling::Undecided,
            },
            _ => match self.parity.overall {
                Overall::Passed => Ruling::Accepted,
                Overall::Failed => Ruling::WrongAnswer,
                Overall::None if matches!(self.stop, Some(Stop::Trace { .. })) => Ruling::BadTrace,
                Overall::None if self.parity.endless_step.is_some() || self.parity.findings.counts.total() > 0 => {
                    Ruling::WrongAnswer
                }
                Overall::None => Ruling::Undecided,
            },
        }
    }

    /// Returns the number of steps that are right by a rule book. A fault outside the steps counts as one wrong step,
    /// for example a wrong first record, or small errors that add up. Therefore only accepted traces have all steps
    /// right.
    pub fn right_steps(&self, book: Book) -> u32 {
        let wrong = u32::try_from(self.findings_by(book).wrong_steps).unwrap_or(u32::MAX);
        let right = self.steps_judged_by(book).saturating_sub(wrong);
        if self.ruling(book) == Ruling::Accepted {
            return right;
        }
        right.saturating_sub(self.damaged_steps).min(self.steps.saturating_sub(1))
    }

    /// Returns the reason why judging by a rule book stopped early; `None` if it reached the end.
    pub fn stop_by(&self, book: Book) -> Option<Stop> {
        let is_parity = book == Book::Parity || self.fair.is_none();
        self.stop.clone().or(self.parity.endless_step.filter(|_| is_parity).map(Stop::Step))
    }

    /// Returns the number of steps that were judged by a rule book.
    pub fn steps_judged_by(&self, book: Book) -> u32 {
        let end = match (book, &self.fair) {
            (Book::Fair, Some(fair)) => fair.first_unjudged_step,
            _ => self.parity.endless_step.map(|error| error.step()),
        };
        end.map_or(self.steps_judged, |step| step - 1)
    }

    /// Returns the findings by a rule book. If the fair rules were not applied, they are those by the original's rules.
    pub fn findings_by(&self, book: Book) -> &BookFindings {
        match (book, &self.fair) {
            (Book::Fair, Some(fair)) => &fair.findings,
            _ => &self.parity.findings,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::de::value::{Error, StrDeserializer};

    #[test]
    fn names_lead_back_and_only_fair_makes_fair_official() {
        let read = |name: &str| Rules::deserialize(StrDeserializer::<Error>::new(name)).ok();
        for rules in [Rules::Parity, Rules::Fair, Rules::Both] {
            assert_eq!(read(rules.name()), Some(rules));
            assert_eq!(rules.official() == Book::Fair, rules == Rules::Fair);
        }
        assert_eq!(read("kind"), None);
        assert!(!Rules::Parity.includes_fair());
    }

    /// Points may depend on the steps: a trace that is not accepted never gets all of them.
    #[test]
    fn a_wrong_answer_has_a_wrong_step() {
        let mut outcome = Outcome::empty(3);
        outcome.steps_judged = 3;
        for (overall, right) in [(Overall::Failed, 2), (Overall::Passed, 3)] {
            outcome.parity.overall = overall;
            assert_eq!(outcome.right_steps(Book::Parity), right);
        }
        outcome.parity.findings.wrong_steps = 5;
        assert_eq!(outcome.right_steps(Book::Parity), 0);
    }

    #[test]
    fn without_a_fair_judgment_parity_speaks_for_both() {
        let mut outcome = Outcome::empty(3);
        outcome.parity.findings.wrong_steps = 2;
        outcome.parity.overall = Overall::Failed;
        assert_eq!(outcome.ruling(Book::Fair), Ruling::WrongAnswer);
        assert_eq!(outcome.findings_by(Book::Fair).wrong_steps, 2);
        let judgment = fair::Judgment { verdict: fair::FairVerdict::Accepted, ..Default::default() };
        outcome.fair = Some(Box::new(judgment));
        assert_eq!(outcome.ruling(Book::Fair), Ruling::Accepted);
        assert_eq!(outcome.findings_by(Book::Fair).wrong_steps, 0);
        assert_eq!(outcome.ruling(Book::Parity), Ruling::WrongAnswer);
    }
}
