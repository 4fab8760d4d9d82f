//! The fair rules' part of the check report, for programs.
use super::super::view::FindingView;
use fosssim_findings::{
    BookFindings, Cause, Finding,
    fair::{Borderline, FairRefusal, FairVerdict, Form, Judgement, Shares},
};
use serde::Serialize;

/// The fair rules' judgement.
#[derive(Debug, Serialize)]
pub(super) struct FairView<'a> {
    verdict: FairVerdict,
    refusal: Option<FairRefusal>,
    wrong_steps: u64,
    first_divergence: Option<FindingView>,
    findings: Vec<CountedView>,
    #[serde(with = "fosssim_num::written")]
    factor: Option<[f64; 2]>,
    approach_form: Form,
    borderline: BorderlineView<'a>,
    used_tolerance: &'a Shares,
}

/// All findings of one kind: how many, and the first.
#[derive(Debug, Serialize)]
pub(super) struct CountedView {
    pub(super) count: u64,
    #[serde(flatten)]
    pub(super) first: FindingView,
}

impl CountedView {
    /// The findings of a book.
    pub(super) fn all(found: &BookFindings, view: impl Fn(&Finding) -> FindingView) -> Vec<Self> {
        found.examples.iter().map(|first| Self { count: found.counts.get(first.kind()), first: view(first) }).collect()
    }
}

#[derive(Debug, Serialize)]
struct BorderlineView<'a> {
    count: u64,
    examples: &'a [Borderline],
}

/// The reason why the two rule books differ.
#[derive(Debug, Serialize)]
pub(crate) struct CauseView {
    key: Cause,
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
            first_divergence: fair.findings.first_divergence.as_ref().map(FindingView::fair),
            findings: CountedView::all(&fair.findings, FindingView::fair),
            factor: fair.factor,
            approach_form: fair.form,
            borderline: BorderlineView { count: fair.borderline, examples: &fair.borderline_examples },
            used_tolerance: &fair.shares,
        }
    }
}
