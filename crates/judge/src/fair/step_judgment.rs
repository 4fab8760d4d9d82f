//! The result of judging one step.
use super::{
    context::{Context, Records},
    factors::FactorsByPolynomial,
    pending_polynomials::PendingPolynomials,
};
use fosssim_findings::{
    Finding, FindingCounts, FindingDetail, FindingKind, PolynomialPlace,
    fair::{Borderline, Shares},
};
use fosssim_model::sim::{Pair, PairKind, PairKindMap, Pass};

/// The findings, decisions and factors of one step.
#[derive(Debug, Clone, Default)]
pub(crate) struct StepJudgment {
    /// The step, from 1.
    pub step: u32,
    /// The number of the step's end record.
    pub frame: u64,
    /// The first finding of each kind, in the order in which they were made.
    pub findings: Vec<Finding>,
    /// The number of further findings of each kind.
    pub further_counts: FindingCounts,
    /// The number of decisions about pairs.
    pub decisions: u64,
    /// The borderline decisions that were followed.
    pub borderline: Vec<Borderline>,
    /// The factors of polynomials that differ from the reference's.
    pub factors: FactorsByPolynomial,
    /// The number of calls of each kind that logged polynomials identical to the reference's.
    pub identical_polynomials: PairKindMap<u64>,
    /// The number of calls with right polynomials in which small coefficients are present on one side and dropped on
    /// the other.
    pub lost_decisions: u64,
    /// The used shares of the tolerances.
    pub shares: Shares,
    /// The first polynomial that has the course's form and not the right form.
    pub course_form: Option<PolynomialPlace>,
    /// The first polynomial that has the right form and not the course's.
    pub right_form: Option<PolynomialPlace>,
    /// The polynomials that are right only with some factors. The whole trace shows whether the program uses such a
    /// factor.
    pub pending: Vec<PendingPolynomials>,
    /// Whether a finding is about polynomials at positions that have the round-off of a response or the failsafe.
    pub has_finding_after_response: bool,
}

impl StepJudgment {
    /// Creates the judgment of a step whose records are identical to the reference's, with `polynomials` polynomials
    /// in the end record.
    pub fn from_identical_records(context: &Context<'_>, step: u32, polynomials: usize) -> Self {
        let frame = u64::from(step) * u64::from(context.records_per_step);
        let passes = polynomials.checked_div(context.polynomials_per_pass).unwrap_or(0);
        let passes = passes as u64;
        let identical_counts = PairKindMap::from_fn(|kind| passes * context.calls_by_kind[kind]);
        Self {
            step,
            frame,
            decisions: passes * context.pair_count as u64,
            identical_polynomials: identical_counts,
            ..Self::default()
        }
    }

    /// Adds a finding to the judgment.
    pub(super) fn add_finding(&mut self, finding: Finding) {
        if self.findings.iter().any(|first| first.kind() == finding.kind()) {
            self.further_counts.add(finding.kind(), 1);
        } else {
            self.findings.push(finding);
        }
    }

    /// Returns the judgment with one more finding.
    pub fn with_finding(mut self, records: Records<'_>, detail: FindingDetail) -> Self {
        (self.step, self.frame) = (records.step, records.frame);
        self.add_finding(Finding { step: self.step, frame: self.frame, detail });
        self
    }

    /// Returns likely factors of a polynomial whose own factor is known only roughly: the factor of the same polynomial
    /// of another pair of this kind, and 1. Factors of other polynomials are no evidence.
    pub(super) fn likely_factors(&self, kind: PairKind, number: usize) -> [f64; 2] {
        [self.factors[kind][number].last(), 1.0]
    }

    /// Returns the number of polynomials that are right only with some factors, and are not decided yet.
    pub(super) fn pending_count(&self) -> u64 {
        self.pending.iter().map(|pending| pending.count).sum()
    }

    /// Adds a borderline decision.
    pub(super) fn add_borderline(&mut self, pass: Pass, pair: Pair, collides: bool) {
        self.borderline.push(Borderline { step: self.step, pass, pair, collides });
    }

    /// Returns the number of findings.
    pub(super) fn total(&self) -> u64 {
        self.findings.len() as u64 + self.further_counts.total()
    }

    /// Returns whether the step has findings that its sensitivity could excuse. Findings about polynomials at known
    /// positions depend only on the polynomials' own bounds.
    pub(super) fn may_be_round_off(&self) -> bool {
        self.has_finding_after_response
            || self.findings.iter().any(|finding| {
                !matches!(
                    finding.kind(),
                    FindingKind::Coefficient
                        | FindingKind::PolynomialDegree
                        | FindingKind::WrongNormal
                        | FindingKind::ContactTime
                        | FindingKind::RepeatedCollision
                        | FindingKind::RecordsDiffer
                        | FindingKind::ImpossibleLog
                )
            })
    }

    /// Returns whether the step has findings that a different decision could explain, because it moves bodies
    /// differently.
    pub(super) fn may_follow_decisions(&self) -> bool {
        self.has_finding_after_response
            || self.findings.iter().any(|finding| {
                matches!(
                    finding.kind(),
                    FindingKind::PolynomialCount
                        | FindingKind::PassPositions
                        | FindingKind::Position
                        | FindingKind::Velocity
                        | FindingKind::TrimmedDecision
                )
            })
    }
}
