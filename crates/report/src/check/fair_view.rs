//! The fair rules' part of the check report, for programs.
use super::super::view::FindingView;
use fosssim_findings::{
    Book, Cause, Finding, FindingKind,
    fair::{Borderline, FairRefusal, FairVerdict, Form, Judgement, Shares},
};
use serde::Serialize;

/// The fair rules' judgement.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(super) struct FairView<'a> {
    /// The verdict; none where judging was cut short, and nothing was wrong so far.
    verdict: FairVerdict,
    /// The reason why the trace is refused as a whole.
    refusal: Option<FairRefusal>,
    /// Steps with at least one finding; the first record is not a step.
    wrong_steps: u64,
    /// The first finding; null when there is none.
    first_divergence: Option<FindingView>,
    /// As at the top. Tolerances depend on the values, so they are null.
    findings: Vec<CountedView>,
    /// Least and greatest factor of the polynomials; null where it is 1.
    #[serde(with = "fosssim_num::written")]
    #[schemars(with = "Option<[crate::view::Number; 2]>")]
    factor: Option<[f64; 2]>,
    /// Which accepted form the approach polynomial of a particle and an edge has.
    approach_form: Form,
    /// Decisions that round-off may flip and that the trace has the other way; they are not charged.
    borderline: BorderlineView<'a>,
    /// The largest share of its tolerances that something right uses, 0 to 1.
    used_tolerance: &'a Shares,
}

/// All findings of one kind: how many, and the first.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(super) struct CountedView {
    /// Their number.
    #[schemars(range(min = 1))]
    count: u64,
    #[serde(flatten)]
    first: FindingView,
}

impl CountedView {
    /// The first findings of each kind by a book, each with the number of them all.
    pub(super) fn all(book: Book, firsts: &[Finding], count: impl Fn(FindingKind) -> u64) -> Vec<Self> {
        firsts.iter().map(|first| Self { count: count(first.kind()), first: FindingView::by(book, first) }).collect()
    }
}

/// Borderline decisions.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BorderlineView<'a> {
    /// Their number.
    count: u64,
    /// The first ones.
    examples: &'a [Borderline],
}

/// The reason why the two rule books differ.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(crate) struct CauseView {
    /// The rule of the original that is the cause.
    key: Cause,
    /// In words.
    text: String,
}

impl From<Cause> for CauseView {
    fn from(cause: Cause) -> Self {
        Self { key: cause, text: cause.to_string() }
    }
}

impl<'a> From<&'a Judgement> for FairView<'a> {
    fn from(fair: &'a Judgement) -> Self {
        Self {
            verdict: fair.verdict,
            refusal: fair.refusal,
            wrong_steps: fair.findings.wrong_steps,
            first_divergence: fair.findings.first_divergence.as_ref().map(|first| FindingView::by(Book::Fair, first)),
            findings: CountedView::all(Book::Fair, &fair.findings.examples, |kind| fair.findings.counts.get(kind)),
            factor: fair.factor,
            approach_form: fair.form,
            borderline: BorderlineView { count: fair.borderline, examples: &fair.borderline_examples },
            used_tolerance: &fair.shares,
        }
    }
}
