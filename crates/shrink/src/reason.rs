//! The reason why a program is wrong on a scene, and whether it is wrong for the same reason on another.
use crate::clear::clear_decisions;
use fosssim_ended::RunEnd;
use fosssim_findings::{
    FindingDetail, FindingKind, Stop, explanation::Explanation, fair::FairVerdict, located::FailureKind,
};
use fosssim_judge::replay::{Options, judge};
use fosssim_mistakes::diagnose::{self, is_named_in, reproduces, shows};
use fosssim_model::{scene::Scene, sim::PairKind};
use fosssim_student::find;

/// A difference is plain if it is at least this part of the value: more than the round-off of any program.
const PLAIN: f64 = 1e-6;

/// The trace and the end of a program's run on a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Observation {
    /// The trace, up to the place at which it ends.
    pub trace: Vec<u8>,
    /// The way the program ended.
    pub ended: RunEnd,
}

impl Observation {
    /// Returns the observation of a program that ended well.
    #[must_use]
    pub const fn from_trace(trace: Vec<u8>) -> Self {
        Self { trace, ended: RunEnd::Exited(0) }
    }
}

/// The reason why a program is wrong.
#[derive(Debug, Clone, PartialEq)]
pub enum WrongReason {
    /// The program does not end well: by this signal, with this exit code, or at this limit.
    Ended(RunEnd),
    /// The trace can't be read to its end.
    BrokenTrace,
    /// From some step on there are values that are no numbers.
    NotFinite,
    /// A likely mistake.
    Mistake(Box<Explanation>),
    /// A finding that nothing explains: its kind, and the kind of its pair.
    Finding(FindingKind, Option<PairKind>),
}

impl WrongReason {
    /// Returns the reason why a program is wrong on a scene; `None` if it is right, or if only round-off decides that.
    #[must_use]
    pub fn first(scene: &Scene, seen: &Observation) -> Option<Self> {
        if FailureKind::from_end(&seen.ended).is_some() {
            return Some(Self::Ended(seen.ended.clone()));
        }
        let (finding, is_plain) = match findings(scene, &seen.trace)? {
            TraceFault::Broken => return Some(Self::BrokenTrace),
            TraceFault::Wrong(first) => (Self::Finding(first.kind, first.pair), first.is_plain),
        };
        let explanations = diagnose::explain(scene, &seen.trace);
        if explanations.iter().any(Explanation::is_not_finite) {
            return Some(Self::NotFinite);
        }
        let is_told = |one: &&Explanation| one.is_vote() && (one.is_complete() || one.is_of_stage());
        let told = explanations.iter().find(is_told).map(|one| Self::Mistake(Box::new(one.clone())));
        told.or_else(|| is_plain.then_some(finding))
    }

    /// Returns whether a program is wrong on a scene for this reason, and plainly: not by round-off, unless that is the
    /// named mistake, and not by a decision that round-off may flip.
    #[must_use]
    pub fn holds(&self, scene: &Scene, seen: &Observation) -> bool {
        match (self, FailureKind::from_end(&seen.ended)) {
            (Self::Ended(RunEnd::Signalled(signal)), _) => seen.ended == RunEnd::Signalled(*signal),
            (Self::Ended(ended), failing) => failing.is_some() && FailureKind::from_end(ended) == failing,
            (_, Some(_)) => false,
            (reason, None) => match (reason, findings(scene, &seen.trace)) {
                (Self::BrokenTrace, fault) => fault == Some(TraceFault::Broken),
                (_, None | Some(TraceFault::Broken)) => false,
                (Self::Mistake(mistake), Some(TraceFault::Wrong(first))) => {
                    first.is_ordinary && is_named_in(mistake, &diagnose::explain(scene, &seen.trace))
                }
                (Self::Finding(kind, pair), Some(TraceFault::Wrong(first))) => {
                    first.is_plain && (first.kind, first.pair) == (*kind, *pair)
                }
                (_, Some(_)) => diagnose::explain(scene, &seen.trace).iter().any(Explanation::is_not_finite),
            },
        }
    }

    /// Returns whether it holds, and is the first thing that the scene alone shows: other mistakes would not have the
    /// same effect there.
    #[must_use]
    pub fn leads(&self, scene: &Scene, seen: &Observation) -> bool {
        let Self::Mistake(mistake) = self else { return self.holds(scene, seen) };
        let keys = known_keys(mistake);
        FailureKind::from_end(&seen.ended).is_none()
            // Most attempts end here, long before every mistake of the catalogue was tried.
            && (keys.is_empty() || reproduces(scene, &seen.trace, &keys))
            && matches!(findings(scene, &seen.trace), Some(TraceFault::Wrong(first)) if first.is_ordinary)
            && diagnose::explain(scene, &seen.trace).first().map(Explanation::statement) == Some(mistake.statement())
    }

    /// Returns whether it is a fault that no row of the catalogue makes: each attempt tries them all.
    #[must_use]
    pub fn is_unnamed(&self) -> bool {
        matches!(self, Self::Mistake(mistake) if known_keys(mistake).is_empty())
    }

    /// Returns whether the reference with the named mistake is plainly wrong on a scene; `None` if no mistake of the
    /// catalogue is named.
    pub(crate) fn shows(&self, scene: &Scene) -> Option<bool> {
        let Self::Mistake(mistake) = self else { return None };
        let keys = known_keys(mistake);
        let most = if mistake.is_unfinished() { 2 } else { 1 };
        (!keys.is_empty()).then(|| keys.iter().take(most).any(|key| shows(scene, key)))
    }
}

/// Returns the rows of the catalogue that a mistake names, its own first; none where it is no row itself, nor a stage
/// that is not written yet.
fn known_keys(mistake: &Explanation) -> Vec<&str> {
    let keys = std::iter::once(&mistake.key).chain(&mistake.same_as);
    let is_asked = |key: &&str| find(key).is_some();
    let is_named = mistake.is_unfinished() || find(&mistake.key).is_some();
    keys.map(String::as_str).filter(|_| is_named).filter(is_asked).collect()
}

/// A fault of a trace by the fair rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TraceFault {
    Broken,
    Wrong(FirstFinding),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct FirstFinding {
    kind: FindingKind,
    pair: Option<PairKind>,
    /// Whether it is about more than round-off.
    is_plain: bool,
    /// Whether it is about more than the size of a state, or of all bodies in one place.
    is_ordinary: bool,
}

/// Returns the faults of a trace, unless round-off may decide them.
fn findings(scene: &Scene, trace: &[u8]) -> Option<TraceFault> {
    let options = Options { threads: 1, fair: true, ..Options::default() };
    let outcome = judge(scene, trace, &options, &mut ());
    let fair = outcome.fair.as_ref()?;
    // A judgement that takes too much work stops as well, and is no fault of the trace.
    let is_unreadable = matches!(outcome.stop, Some(Stop::Trace { .. }));
    if is_unreadable || outcome.damage.is_some() || outcome.trailing_bytes {
        return Some(TraceFault::Broken);
    }
    let first = fair.findings.first_divergence.filter(|_| fair.verdict == FairVerdict::Rejected)?;
    let pair = first.detail.pair().map(|pair| pair.kind);
    let is_ordinary = !matches!(first.detail, FindingDetail::BeyondReach { .. });
    let first = FirstFinding { kind: first.kind(), pair, is_plain: is_plain(&first.detail), is_ordinary };
    // Behind a plain fault, decisions about the program's own positions may be borderline where the reference's are
    // not.
    let has_margin = || fair.borderline == 0 || (first.is_plain && clear_decisions(scene).is_some());
    has_margin().then_some(TraceFault::Wrong(first))
}

/// Returns whether a finding is about more than round-off.
fn is_plain(detail: &FindingDetail) -> bool {
    let is_large = |residual: f64, of: &[f64]| {
        // A NaN is plain, too.
        let bound = PLAIN * of.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        !(residual <= bound)
    };
    match detail {
        FindingDetail::Position { residual, expected, .. } | FindingDetail::Velocity { residual, expected, .. } => {
            is_large(*residual, expected)
        }
        FindingDetail::Coefficient { residual, expected_polynomial, .. } => {
            is_large(*residual, expected_polynomial.coefficients())
        }
        FindingDetail::WrongNormal { residual, expected, .. } => is_large(*residual, expected.normal.as_slice()),
        _ => true,
    }
}
