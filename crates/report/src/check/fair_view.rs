//! The section about the fair rules in the JSON document of the check report.
use super::super::view::{FindingView, view};
use fosssim_findings::{
    Book, Cause, Finding, FindingKind,
    fair::{Borderline, FairRejection, FairVerdict, Form, Judgment, Shares},
};
use serde::Serialize;

view! {
    /// The judgment by the fair rules.
    #[derive(Debug)]
    #[schemars(deny_unknown_fields)]
    pub(super) struct FairView<'a> from fair: Judgment {
        /// The verdict by the fair rules. It is `none` if judging stopped early before a fault was found.
        verdict: FairVerdict = fair.verdict,
        /// The reason why the whole trace is rejected; null if there is none.
        refusal: Option<FairRejection> = fair.rejection,
        /// The number of steps with at least one finding. The first record is not a step.
        wrong_steps: u64 = fair.findings.wrong_steps,
        /// The first finding; null if there is none.
        first_divergence: Option<FindingView> =
            fair.findings.first_divergence.as_ref().map(|first| FindingView::from_finding(Book::Fair, first)),
        /// For each kind of finding, the number of findings and the first one. The tolerance is null, because it
        /// depends on the values.
        findings: Vec<CountedView> =
            CountedView::count(Book::Fair, &fair.findings.examples, |kind| fair.findings.counts.get(kind)),
        /// The smallest and the largest factor by which the trace's polynomials differ from the reference's; null if
        /// all factors are 1.
        #[serde(with = "fosssim_num::number_serde")]
        #[schemars(with = "Option<[crate::view::WrittenNumber; 2]>")]
        factor: Option<[f64; 2]> = fair.factor,
        /// The accepted form of the particle-edge approach polynomial that the trace uses.
        approach_form: Form = fair.form,
        /// The decisions that differ from the reference's, which round-off may explain. They do not count as findings.
        borderline: BorderlineView<'a> =
            BorderlineView { count: fair.borderline, examples: &fair.borderline_examples },
        /// The largest shares of the tolerances that accepted values use, from 0 to 1.
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
    /// Returns the first finding of each kind, with the number of findings of that kind.
    pub(super) fn count(book: Book, first_findings: &[Finding], count: impl Fn(FindingKind) -> u64) -> Vec<Self> {
        first_findings
            .iter()
            .map(|first| Self { count: count(first.kind()), first: FindingView::from_finding(book, first) })
            .collect()
    }
}

/// Decisions that round-off may change.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BorderlineView<'a> {
    /// The number of borderline decisions.
    count: u64,
    /// The first borderline decisions in the trace.
    examples: &'a [Borderline],
}

view! {
    /// The reason why the two rule books reach different verdicts.
    #[derive(Debug)]
    #[schemars(deny_unknown_fields)]
    pub(crate) struct CauseView from cause: Cause {
        /// The rule of the original that causes the difference.
        key: Cause = *cause,
        /// The rule as a sentence.
        text: String = cause.to_string(),
    }
}
