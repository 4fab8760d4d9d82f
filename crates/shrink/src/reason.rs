//! Finds the reason why a program is wrong on a scene, and checks whether it is wrong on a smaller scene for the same
//! reason.
use crate::size::is_clear;
use fosssim_ended::RunEnd;
use fosssim_findings::{
    FindingDetail, FindingKind, Stop, explanation::Explanation, fair::FairVerdict, located_failure::FailureKind,
};
use fosssim_judge::replay::{Options, judge};
use fosssim_mistakes::diagnose::{self, is_named_in, reproduces};
use fosssim_model::{scene::Scene, sim::PairKind};
use fosssim_student::find;

/// The minimum difference that counts as clear. It exceeds the round-off of any program.
const MIN_CLEAR_DIFFERENCE: f64 = 1e-6;

/// The trace and the end of a program's run on a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Observation {
    /// The trace, which may be incomplete.
    pub trace: Vec<u8>,
    /// The result of the run.
    pub ended: RunEnd,
}

/// The reason why a program is wrong.
#[derive(Debug, Clone, PartialEq)]
pub enum WrongReason {
    /// The program does not end normally. The values are its failure, and the signal of a crash.
    Ended(FailureKind, Option<i32>),
    /// The trace cannot be read to its end.
    BrokenTrace,
    /// A likely mistake is the reason, or the stage from which on values are not finite.
    Mistake(Box<Explanation>),
    /// A finding that nothing explains is the reason. The values are its kind, and the kind of its pair.
    Finding(FindingKind, Option<PairKind>),
}

impl WrongReason {
    /// Returns the reason of a program that does not end normally, or `None` if it ends normally.
    pub fn from_end(end: &RunEnd) -> Option<Self> {
        let signal = if let RunEnd::Signaled(signal) = end { Some(*signal) } else { None };
        FailureKind::from_end(end).map(|failure| Self::Ended(failure, signal))
    }

    /// Returns the reason why a program is wrong on a scene. Returns `None` if the program is right, or if only
    /// round-off makes it wrong.
    pub fn first_reason(scene: &Scene, observation: &Observation) -> Option<Self> {
        let (fault, detail) = find_reason(scene, observation)?;
        let Some(detail) = detail else { return Some(fault) };
        let is_likely = |explanation: &Explanation| {
            explanation.reports_non_finite_value()
                || (explanation.is_about_program() && (explanation.is_complete() || explanation.names_stage()))
        };
        let mut explanations = diagnose::explain(scene, &observation.trace).into_iter();
        let likely = explanations.find(is_likely).map(|explanation| Self::Mistake(Box::new(explanation)));
        likely.or_else(|| is_clear_finding(detail).then_some(fault))
    }

    /// Returns whether a program is clearly wrong on a scene for this reason. A finding without a likely mistake must
    /// exceed round-off, and decisions must not depend on round-off. With `is_only_reason`, the reason must be the
    /// first one that the scene shows, without other mistakes that have the same effect.
    pub fn is_reproduced(&self, scene: &Scene, observation: &Observation, is_only_reason: bool) -> bool {
        let Some((fault, detail)) = find_reason(scene, observation) else { return false };
        match (self, detail) {
            (Self::Mistake(mistake), Some(FindingDetail::BeyondReach { .. }))
                if !mistake.reports_non_finite_value() =>
            {
                false
            }
            (Self::Mistake(mistake), Some(_)) => is_shown(mistake, scene, observation, is_only_reason),
            (_, detail) => fault == *self && detail.is_none_or(is_clear_finding),
        }
    }
}

/// Returns whether the explanations of a wrong trace name a mistake, as the first one if that is requested.
fn is_shown(mistake: &Explanation, scene: &Scene, observation: &Observation, is_only_reason: bool) -> bool {
    // The rows of the catalog that the mistake names. There are none if it is neither a row nor a stage without code.
    let is_named = mistake.is_unfinished() || find(&mistake.key).is_some();
    let keys = std::iter::once(&mistake.key).chain(&mistake.same_as).map(String::as_str);
    let keys: Vec<&str> = keys.filter(|key| is_named && find(key).is_some()).collect();
    // Most attempts end here, long before every mistake of the catalog has been tried.
    if is_only_reason && !keys.is_empty() && !reproduces(scene, &observation.trace, &keys) {
        return false;
    }
    let explanations = diagnose::explain(scene, &observation.trace);
    if is_only_reason {
        explanations.first().is_some_and(|first| first.statement() == mistake.statement())
    } else {
        is_named_in(mistake, &explanations)
    }
}

/// Returns the reason that needs no explanation, and the first finding of a trace that can be read. Returns `None` if
/// nothing is wrong, or if round-off may be the cause.
fn find_reason(scene: &Scene, observation: &Observation) -> Option<(WrongReason, Option<FindingDetail>)> {
    if let Some(end) = WrongReason::from_end(&observation.ended) {
        return Some((end, None));
    }
    let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
    let outcome = judge(scene, &observation.trace[..], &options, &mut ());
    // A judgment that takes too much work stops as well, but this is not a fault of the trace.
    let is_unreadable = matches!(outcome.stop, Some(Stop::Trace { .. }));
    if is_unreadable || outcome.damage.is_some() || outcome.trailing_bytes {
        return Some((WrongReason::BrokenTrace, None));
    }
    let fair = outcome.fair.filter(|fair| fair.verdict == FairVerdict::Rejected)?;
    let first = fair.findings.first_divergence?;
    // After a clear fault, decisions about the program's own positions may be borderline, while the reference's
    // decisions are certain.
    let has_margin = fair.borderline == 0 || (is_clear_finding(first.detail) && is_clear(scene));
    let finding = WrongReason::Finding(first.kind(), first.detail.pair().map(|pair| pair.kind));
    has_margin.then_some((finding, Some(first.detail)))
}

/// Returns whether a finding is about more than round-off. This includes NaN.
const fn is_clear_finding(detail: FindingDetail) -> bool {
    use FindingDetail::{Coefficient, Position, Velocity, WrongNormal};
    match detail {
        Position { residual, .. }
        | Velocity { residual, .. }
        | Coefficient { residual, .. }
        | WrongNormal { residual, .. } => !(residual <= MIN_CLEAR_DIFFERENCE),
        _ => true,
    }
}
