//! Counts the polynomials that differ only because their input positions are wrong.
use fosssim_judge::{Finding, FindingKind, Outcome, fair::FairVerdict};

/// The kinds of findings that are faults of a formula, and not of its input positions.
const FORMULA_KINDS: [FindingKind; 6] = [
    FindingKind::PolynomialDegree,
    FindingKind::VanishingPolynomial,
    FindingKind::Coefficient,
    FindingKind::ImpossibleLog,
    FindingKind::TrimmedDecision,
    FindingKind::MixedForms,
];

/// Returns whether a finding of this kind may be a fault of a formula.
pub(crate) fn is_formula_fault(kind: FindingKind) -> bool {
    FORMULA_KINDS.contains(&kind)
}

/// Returns whether the finding is about a formula in a pass whose input positions were computed by earlier passes of
/// the same step.
pub(super) fn is_in_later_pass(finding: &Finding) -> bool {
    is_formula_fault(finding.kind()) && finding.detail.pass().is_some_and(|pass| pass.index > 0)
}

/// Counts the polynomials that are wrong by the original's rules only because positions are wrong. The count is 0
/// unless the fair rules, which start from the trace's own positions, reject the trace without finding a wrong formula.
/// They must also find wrong positions between the passes of a step, or wrong states. If they find only wrong states,
/// the first wrong formulas by the original's rules must all be in later passes.
pub(crate) fn count_consequences(outcome: &Outcome) -> u64 {
    let Some(fair) = outcome.fair.as_ref().filter(|fair| fair.verdict == FairVerdict::Rejected) else { return 0 };
    let charged = |kind: FindingKind| fair.findings.counts.get(kind);
    let examples = outcome.parity.findings.examples.iter().filter(|example| is_formula_fault(example.kind()));
    let has_states = charged(FindingKind::Position) + charged(FindingKind::Velocity) > 0;
    let follow = charged(FindingKind::PassPositions) > 0 || has_states && { examples }.all(is_in_later_pass);
    if !follow || FORMULA_KINDS.into_iter().any(|kind| charged(kind) > 0) {
        return 0;
    }
    FORMULA_KINDS.into_iter().map(|kind| outcome.parity.findings.counts.get(kind)).sum()
}
