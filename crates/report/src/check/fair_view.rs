//! The fair rules' part of the check report, for programs.
use super::super::view::{FindingView, view};
use fosssim_findings::{
    Book, Cause, Finding, FindingKind,
    fair::{Borderline, FairRefusal, FairVerdict, Form, Judgement, Shares},
};
use serde::Serialize;

view! {
    /// The fair rules' judgement.
    #[derive(Debug)]
    #[schemars(deny_unknown_fields)]
    pub(super) struct FairView<'a> from fair: Judgement {
        /// The verdict; none if judging stopped early and had found no fault.
        verdict: FairVerdict = fair.verdict,
        /// The reason why the whole trace is rejected.
        refusal: Option<FairRefusal> = fair.refusal,
        /// The number of steps with at least one finding; the first record is not a step.
        wrong_steps: u64 = fair.findings.wrong_steps,
        /// The first finding; null if there is none.
        first_divergence: Option<FindingView> =
            fair.findings.first_divergence.as_ref().map(|first| FindingView::from_finding(Book::Fair, first)),
        /// The first finding of each kind, and the number of each kind. The tolerance is null, because it depends on
        /// the values.
        findings: Vec<CountedView> =
            CountedView::count(Book::Fair, &fair.findings.examples, |kind| fair.findings.counts.get(kind)),
        /// The smallest and the largest factor of the polynomials; null if it is 1.
        #[serde(with = "fosssim_num::written")]
        #[schemars(with = "Option<[crate::view::Number; 2]>")]
        factor: Option<[f64; 2]> = fair.factor,
        /// The accepted form of the particle-edge approach polynomial that the trace uses.
        approach_form: Form = fair.form,
        /// The decisions that differ from the reference's, but may do so because of round-off. They are not findings.
        borderline: BorderlineView<'a> =
            BorderlineView { count: fair.borderline, examples: &fair.borderline_examples },
        /// The largest shares of the tolerances that right values use, 0 to 1.
        used_tolerance: &'a Shares = &fair.shares,
    }
}

/// The number of findings of one kind, and the first of them.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(super) struct CountedView {
    /// The number of findings.
    #[schemars(range(min = 1))]
    count: u64,
    #[serde(flatten)]
    first: FindingView,
}

impl CountedView {
    /// Returns the first findings of each kind by a book, each with the number of findings.
    pub(super) fn count(book: Book, firsts: &[Finding], count: impl Fn(FindingKind) -> u64) -> Vec<Self> {
        firsts
            .iter()
            .map(|first| Self { count: count(first.kind()), first: FindingView::from_finding(book, first) })
            .collect()
    }
}

/// Borderline decisions.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BorderlineView<'a> {
    /// The number of borderline decisions.
    count: u64,
    /// The first borderline decisions.
    examples: &'a [Borderline],
}

view! {
    /// The reason why the two rule books differ.
    #[derive(Debug)]
    #[schemars(deny_unknown_fields)]
    pub(crate) struct CauseView from cause: Cause {
        /// The rule of the original that causes the difference.
        key: Cause = *cause,
        /// The rule as a sentence.
        text: String = cause.to_string(),
    }
}
