//! The fair rules' part of the check report, for programs.
use super::super::view::{FindingView, Number, PairView, PassView};
use fosssim_judge::{
    Outcome,
    fair::{Borderline, Cause, FairRefusal, FairVerdict, Form, Judgement, Shares, cause},
};
use serde::Serialize;

/// What the fair rules say.
#[derive(Debug, Serialize)]
pub(super) struct FairView {
    verdict: &'static str,
    refusal: Option<&'static str>,
    wrong_steps: u64,
    first_divergence: Option<FindingView>,
    findings: Vec<CountedView>,
    factor: Option<[Number; 2]>,
    approach_form: &'static str,
    borderline: BorderlineView,
    used_tolerance: SharesView,
}

/// All findings of one kind: how many, and the first.
#[derive(Debug, Serialize)]
pub(super) struct CountedView {
    pub(super) count: u64,
    #[serde(flatten)]
    pub(super) first: FindingView,
}

#[derive(Debug, Serialize)]
struct BorderlineView {
    count: u64,
    examples: Vec<DecisionView>,
}

/// A decision that round-off may flip.
#[derive(Debug, Serialize)]
struct DecisionView {
    step: u32,
    pass: PassView,
    pair: PairView,
    collides: bool,
}

#[derive(Debug, Serialize)]
struct SharesView {
    coefficients: Number,
    normals: Number,
    positions: Number,
    velocities: Number,
}

/// Why the two rule books differ.
#[derive(Debug, Serialize)]
pub(super) struct CauseView {
    key: &'static str,
    text: String,
}

impl CauseView {
    /// The cause, where the books differ.
    pub(super) fn of(outcome: &Outcome) -> Option<Self> {
        cause(outcome).map(Self::from)
    }
}

impl From<Cause> for CauseView {
    fn from(cause: Cause) -> Self {
        Self { key: cause.key(), text: cause.to_string() }
    }
}

impl From<&Judgement> for FairView {
    fn from(fair: &Judgement) -> Self {
        Self {
            verdict: match fair.verdict {
                FairVerdict::Accepted => "accepted",
                FairVerdict::Rejected => "rejected",
                FairVerdict::None => "none",
            },
            refusal: fair.refusal.map(|refusal| match refusal {
                FairRefusal::Stopped => "stopped",
                FairRefusal::Damaged => "damaged",
                FairRefusal::TrailingBytes => "trailing_bytes",
                FairRefusal::Undecided => "undecided",
            }),
            wrong_steps: fair.findings.wrong_steps,
            first_divergence: fair.findings.first_divergence.as_ref().map(FindingView::fair),
            findings: fair
                .findings
                .examples
                .iter()
                .map(|first| CountedView {
                    count: fair.findings.counts.get(first.kind()),
                    first: FindingView::fair(first),
                })
                .collect(),
            factor: fair.scale().map(|range| range.map(Number)),
            approach_form: match fair.form {
                Form::Either => "either",
                Form::Course => "course",
                Form::Right => "right",
            },
            borderline: BorderlineView {
                count: fair.borderline,
                examples: fair.borderline_examples.iter().map(DecisionView::from).collect(),
            },
            used_tolerance: SharesView::from(&fair.shares),
        }
    }
}

impl From<&Borderline> for DecisionView {
    fn from(decision: &Borderline) -> Self {
        let Borderline { step, pass, pair, collides } = *decision;
        Self { step, pass: pass.into(), pair: pair.into(), collides }
    }
}

impl From<&Shares> for SharesView {
    fn from(shares: &Shares) -> Self {
        let [coefficients, normals, positions, velocities] =
            [shares.coefficient, shares.normal, shares.position, shares.velocity].map(Number);
        Self { coefficients, normals, positions, velocities }
    }
}
