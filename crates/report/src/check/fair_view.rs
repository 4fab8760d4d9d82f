//! The fair rules' part of the check report, for programs.
use super::super::view::FindingView;
use fosssim_findings::{
    Book, Cause, Finding, FindingKind,
    fair::{Borderline, FairRefusal, FairVerdict, Form, Judgement, Shares},
};
use serde::Serialize;
use serde_json::{Value, json};

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

#[derive(Debug, Serialize)]
struct BorderlineView<'a> {
    count: u64,
    examples: &'a [Borderline],
}

/// The reason why the two rule books differ.
pub(crate) fn cause_view(cause: Cause) -> Value {
    json!({ "key": cause, "text": cause.to_string() })
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
