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
        /// The verdict; none if judging was cut short, without a fault so far.
        verdict: FairVerdict = fair.verdict,
        /// The reason why the trace is rejected as a whole.
        refusal: Option<FairRefusal> = fair.refusal,
        /// Steps with at least one finding; the first record is not a step.
        wrong_steps: u64 = fair.findings.wrong_steps,
        /// The first finding; null when there is none.
        first_divergence: Option<FindingView> =
            fair.findings.first_divergence.as_ref().map(|first| FindingView::from_finding(Book::Fair, first)),
        /// As at the top. Tolerances depend on the values, so they are null.
        findings: Vec<CountedView> =
            CountedView::all(Book::Fair, &fair.findings.examples, |kind| fair.findings.counts.get(kind)),
        /// Least and greatest factor of the polynomials; null if it is 1.
        #[serde(with = "fosssim_num::written")]
        #[schemars(with = "Option<[crate::view::Number; 2]>")]
        factor: Option<[f64; 2]> = fair.factor,
        /// Which accepted form the approach polynomial of a particle and an edge has.
        approach_form: Form = fair.form,
        /// Decisions that round-off may flip and that differ in the trace; they are not counted.
        borderline: BorderlineView<'a> =
            BorderlineView { count: fair.borderline, examples: &fair.borderline_examples },
        /// The largest share of its tolerances that something right uses, 0 to 1.
        used_tolerance: &'a Shares = &fair.shares,
    }
}

/// All findings of one kind: how many, and the first.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(super) struct CountedView {
    /// The number of all.
    #[schemars(range(min = 1))]
    count: u64,
    #[serde(flatten)]
    first: FindingView,
}

impl CountedView {
    /// Returns the first findings of each kind by a book, each with the number of them all.
    pub(super) fn all(book: Book, firsts: &[Finding], count: impl Fn(FindingKind) -> u64) -> Vec<Self> {
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
    /// The number of all.
    count: u64,
    /// The first of these decisions.
    examples: &'a [Borderline],
}

view! {
    /// The reason why the two rule books differ.
    #[derive(Debug)]
    #[schemars(deny_unknown_fields)]
    pub(crate) struct CauseView from cause: Cause {
        /// The rule of the original that is the cause.
        key: Cause = *cause,
        /// In words.
        text: String = cause.to_string(),
    }
}
