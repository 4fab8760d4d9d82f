//! Finds the step from which a trace contains values that are not finite, and the stage of the step that first computes
//! one from finite values.
//!
//! NaN spreads: every result that is computed from it is NaN, and comparisons with it are false. Only the first stage
//! with finite input and an output that is not finite proves a mistake.
use super::{
    Explanation,
    fault::{NanStage, NonFiniteValue},
    sampling::{Capture, Reference, Source, StepFrames, StepReader, pair_particles},
    topic::ExplanationTopic,
};
use fosssim_judge::kept_trace::KeptTrace;
use fosssim_model::{
    scene::{Collision, Integrator, Scene},
    sim::{Pair, State, pairs},
    trace::{LenientFrame, LoggedImpulse, PolynomialLog},
};

/// Returns the explanation of the first value of a kept trace that is not finite, and no other explanation. The list is
/// empty if all values are finite, or if the reference's values are not finite either.
pub fn explain_non_finite_value(scene: &Scene, trace: &KeptTrace) -> Vec<Explanation> {
    explain_source(scene, trace.into())
}

/// Returns the explanation of the first value that is not finite, like [`explain_non_finite_value`], with records from
/// any source.
pub(super) fn explain_source(scene: &Scene, source: Source<'_>) -> Vec<Explanation> {
    let (mut steps, mut reference, mut first) =
        (StepReader::new(scene, source), Reference::new(scene), NonFiniteSearch::default());
    first.check_first_record(&steps.frames);
    while let Some(step) = steps.next() {
        first.examine_step(&mut reference, scene, step, &steps.frames);
    }
    first.explain().into_iter().collect()
}

/// A search for the first value that is not finite, step by step.
#[derive(Default)]
pub(super) struct NonFiniteSearch {
    is_found: bool,
    /// The explanation of the first such value, or `None` if it is not found yet or the reference's value is not finite
    /// either.
    explanation: Option<NonFiniteValue>,
}

impl NonFiniteSearch {
    /// Checks the first record of a trace.
    pub(super) fn check_first_record(&mut self, frames: &StepFrames) {
        if let Some(wild) = find_non_finite_value(&frames.before.state) {
            let value =
                NonFiniteValue { step: Some(0), stage: NanStage::FirstRecord, is_nan: wild.is_nan(), recovers: false };
            *self = Self { is_found: true, explanation: Some(value) };
        }
    }

    /// Examines a step. It may be the first one with a value that is not finite, or its values may be finite again.
    pub(super) fn examine_step(
        &mut self,
        reference: &mut Reference<'_>,
        scene: &Scene,
        step: u32,
        frames: &StepFrames,
    ) {
        if self.is_found {
            let is_finite = || ![&frames.before, &frames.mid, &frames.end].into_iter().any(has_non_finite_value);
            if let Some(value) = &mut self.explanation
                && !value.recovers
            {
                value.recovers = is_finite();
            }
            return;
        }
        let is_first = find_non_finite_value(&frames.before.state).is_none()
            && (has_non_finite_value(&frames.mid) || has_non_finite_value(&frames.end));
        if is_first {
            *self = Self { is_found: true, explanation: find_in_step(reference, scene, step, frames) };
        }
    }

    /// Returns the explanation of the found value, or `None` if all values are finite.
    pub(super) fn explain(self) -> Option<Explanation> {
        self.explanation
            .map(|found| Explanation::with_topic(Explanation::NOT_FINITE, ExplanationTopic::NotFinite(found)))
    }
}

/// Returns the first value that is not finite, or `None` if all are finite.
fn find_non_finite_value(state: &State) -> Option<f64> {
    state.positions.iter().chain(&state.velocities).copied().find(|value| !value.is_finite())
}

fn find_non_finite_impulse(impulse: &LoggedImpulse) -> Option<f64> {
    [impulse.normal.x, impulse.normal.y, impulse.time].into_iter().find(|value| !value.is_finite())
}

fn find_non_finite_polynomial(polynomials: &PolynomialLog) -> Option<(usize, f64)> {
    let first = polynomials.coefficients.iter().position(|value| !value.is_finite())?;
    Some((polynomials.coefficient_ends.partition_point(|&end| end <= first), polynomials.coefficients[first]))
}

fn has_non_finite_value(frame: &LenientFrame) -> bool {
    find_non_finite_value(&frame.state).is_some()
        || frame.impulses.iter().any(|impulse| find_non_finite_impulse(impulse).is_some())
        || frame.polynomials.coefficients.iter().any(|value| !value.is_finite())
}

/// Returns the stage of a step that computes a value that is not finite from a finite state. Returns `None` if the
/// reference does so as well or has no result.
fn find_in_step(
    reference: &mut Reference<'_>,
    scene: &Scene,
    step: u32,
    frames: &StepFrames,
) -> Option<NonFiniteValue> {
    let mut capture = Capture::new(&scene.collision);
    let has_result = reference.step(step, &frames.before.state, &mut capture).is_some();
    let (stage, value) = find_stage(scene, frames)?;
    let is_implicit = matches!(scene.integrator, Integrator::ImplicitEuler | Integrator::LinearizedImplicitEuler);
    let stage = if is_implicit && stage == NanStage::Motion { NanStage::ImplicitMotion } else { stage };
    let found = NonFiniteValue { step: Some(step), stage, is_nan: value.is_nan(), recovers: false };
    (has_result && capture.records.is_finite()).then_some(found)
}

/// Returns the first stage with results that are not finite, with the first such value. Returns `None` if all results
/// are finite.
fn find_stage(scene: &Scene, frames: &StepFrames) -> Option<(NanStage, f64)> {
    let StepFrames { mid, end, .. } = frames;
    let polynomial = find_non_finite_polynomial(&end.polynomials);
    let state = find_non_finite_value(&end.state);
    let state_stage = if end.impulses.is_empty() { NanStage::Motion } else { NanStage::Responses };
    match scene.collision {
        Collision::None | Collision::Penalty { .. } => Some((NanStage::Motion, state?)),
        Collision::Simple { .. } => {
            let contact =
                end.impulses.iter().find_map(find_non_finite_impulse).map(|value| (NanStage::ContactVectors, value));
            contact.or_else(|| Some((state_stage, state?)))
        }
        Collision::ContinuousTime { .. } => find_stage_in_single_pass(scene, end, polynomial)
            .or_else(|| Some((state_stage, find_non_finite_value(&mid.state).or(state)?))),
        Collision::Hybrid { .. } => {
            let pass: usize = pairs(scene).counts().iter().map(|(kind, count)| count * kind.polynomial_count()).sum();
            let mid_count = mid.polynomials.len();
            let kind = |index: usize| locate_pair(scene, index % pass.max(1)).map(|(_, pair)| pair.kind);
            match polynomial {
                Some((index, value)) if index < mid_count.min(pass) => Some((NanStage::Detection(kind(index)), value)),
                Some((index, value)) if index < mid_count => Some((NanStage::ImpulseRounds, value)),
                _ if find_non_finite_value(&mid.state).is_some() => {
                    Some((NanStage::ImpulseRounds, find_non_finite_value(&mid.state)?))
                }
                Some((index, value)) if index < mid_count + pass => {
                    Some((NanStage::Detection(kind(index - mid_count)), value))
                }
                other => Some((NanStage::Zones, other.map(|(_, value)| value).or(state)?)),
            }
        }
    }
}

/// Returns the first stage with results that are not finite in the single pass of `continuous-time`, where each contact
/// is resolved before the next pair is checked. Returns `None` if all polynomials and contacts are finite.
fn find_stage_in_single_pass(
    scene: &Scene,
    end: &LenientFrame,
    polynomial: Option<(usize, f64)>,
) -> Option<(NanStage, f64)> {
    let all = pairs(scene);
    let pair_index =
        |contact: &LoggedImpulse| contact.pair().and_then(|pair| all.iter().position(|candidate| candidate == pair));
    let contact =
        end.impulses.iter().find_map(|contact| Some((pair_index(contact), find_non_finite_impulse(contact)?)));
    let Some((index, value)) = polynomial else { return contact.map(|(_, value)| (NanStage::ContactVectors, value)) };
    let Some((at, pair)) = locate_pair(scene, index) else { return Some((NanStage::Detection(None), value)) };
    if let Some((Some(pair_index), value)) = contact
        && pair_index < at
    {
        return Some((NanStage::ContactVectors, value));
    }
    // If an earlier contact in the pass has moved one of the bodies, its response has computed the values.
    let own = pair_particles(scene, pair);
    let has_moved = |contact: &LoggedImpulse| {
        pair_index(contact).is_some_and(|pair_index| pair_index < at)
            && contact.pair().is_some_and(|other| pair_particles(scene, other).iter().any(|body| own.contains(body)))
    };
    let is_moved = end.impulses.iter().any(has_moved);
    Some((if is_moved { NanStage::Responses } else { NanStage::Detection(Some(pair.kind)) }, value))
}

/// Returns the pair to which polynomial `index` of a pass belongs, after the pair's index in the pass. Returns `None`
/// if the pass has fewer polynomials.
fn locate_pair(scene: &Scene, index: usize) -> Option<(usize, Pair)> {
    let mut first = 0;
    pairs(scene).iter().enumerate().find(|(_, pair)| {
        first += pair.kind.polynomial_count();
        index < first
    })
}
