//! Collects the data for explanations of polynomials: detections with certain inputs, and their logged polynomials.
//!
//! The inputs of a detection pass are the start and the end positions of the step. The trace contains the start. The
//! end is the reference integrator's result, before any response. The samples are therefore from the first pass of each
//! step. In hybrid scenes they are also from the first pass of the geometric part, which starts from the mid record. A
//! wrong polynomial that is right for the positions of the mid record shows another integrator, and is left out.
use super::{reference::Reference, source::StepFrames};
use fosssim_judge::fair::{compare::compare, formulas};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{
        Decision, Observer, Pair, PairKind, PairKindMap, PairMotion, Pass, ResumeState, Stage, State, StepController,
        pairs,
    },
    trace::{Layout, LenientFrame, PolynomialLog},
};
use fosssim_num::polynomial::Polynomial;

/// One detection of a submission: its inputs, and the polynomials that the submission passed to the root finder.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The step, from 1.
    pub step: u32,
    /// The detection pass within the step, from 0.
    pub pass: u32,
    /// The pair of the detection, of the same kind as `motion`.
    pub pair: Pair,
    /// The inputs of the detection, from the submission's own states.
    pub motion: PairMotion,
    /// The logged coefficients, with one list for each of the kind's 2 or 4 polynomials, in the trace's order. In each
    /// list the highest power is first, and the small leading coefficients that the course's library drops are missing.
    /// If there are fewer lists, the last polynomials are missing.
    pub polynomials: Vec<Vec<f64>>,
}

/// Returns the particles of a pair, in the order of the assignment, without the ends of a missing edge.
pub fn pair_particles(scene: &Scene, pair: Pair) -> Vec<usize> {
    let (first, second) = (pair.first as usize, pair.second as usize);
    match pair.kind {
        PairKind::ParticleParticle => vec![first, second],
        PairKind::ParticleEdge => {
            let ends = scene.edges.get(second).map(|edge| [edge.first, edge.second]);
            std::iter::once(first).chain(ends.into_iter().flatten()).collect()
        }
        PairKind::ParticleHalfPlane => vec![first],
    }
}

/// The maximum number of wrong detections, and of right ones, that are kept per kind of pair.
const MAX_WRONG: usize = 400;
const MAX_RIGHT: usize = 200;

/// The samples of a trace, collected step by step; scenes without polynomials have none.
pub struct Detections<'a> {
    scene: &'a Scene,
    samples_by_kind: PairKindMap<KindSamples>,
}

#[derive(Default)]
struct KindSamples {
    samples: Vec<Sample>,
    wrong_count: usize,
    right_count: usize,
}

impl<'a> Detections<'a> {
    /// Creates the collection for traces of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, samples_by_kind: PairKindMap::default() }
    }

    /// Collects the samples of a step. If a step has no result, the rest of the trace is not used, and the samples so
    /// far are kept.
    pub fn examine_step(&mut self, reference: &mut Reference<'_>, step: u32, frames: &StepFrames) {
        let is_full = self.samples_by_kind.values().all(|kind| kind.wrong_count >= MAX_WRONG);
        if is_full || !Layout::for_scene(self.scene).has_polynomials {
            return;
        }
        let (mid, log) = (&frames.mid, &frames.end.polynomials);
        let sizes = polynomial_counts(pairs(self.scene).counts(), mid.polynomials.len(), log.len());
        let (scene, kinds) = (self.scene, &mut self.samples_by_kind);
        reference.step(
            step,
            &frames.before.state,
            &mut SampleCollector {
                scene,
                step,
                mid,
                log,
                samples_by_kind: kinds,
                polynomial_counts: sizes,
                next_polynomial: None,
            },
        );
    }

    /// Returns the collected samples.
    pub fn into_samples(self) -> Vec<Sample> {
        self.samples_by_kind.into_values().flat_map(|kind| kind.samples).collect()
    }
}

/// The observer of one step.
struct SampleCollector<'a> {
    scene: &'a Scene,
    step: u32,
    mid: &'a LenientFrame,
    log: &'a PolynomialLog,
    samples_by_kind: &'a mut PairKindMap<KindSamples>,
    /// The number of polynomials that each detection logs. Usually all polynomials are logged.
    polynomial_counts: Option<PairKindMap<usize>>,
    /// The number of the pass, and the index of its next polynomial in the list, or `None` in passes that are not
    /// examined.
    next_polynomial: Option<(u32, usize)>,
}

impl SampleCollector<'_> {
    /// Returns whether the submission lists a contact of the pair. Collision types other than `continuous-time` list
    /// none.
    fn is_hit(&self, pair: Pair) -> bool {
        matches!(self.scene.collision, Collision::ContinuousTime { .. })
            && self.mid.impulses.iter().any(|impulse| impulse.pair() == Some(pair))
    }
}

/// Returns the number of polynomials that each detection logs, such that the list consists of whole passes: all
/// polynomials if possible, otherwise as many as possible. Returns `None` if no numbers fit. `pair_counts` is for one
/// pass.
fn polynomial_counts(
    pair_counts: PairKindMap<usize>,
    count_before: usize,
    total_count: usize,
) -> Option<PairKindMap<usize>> {
    let divides_counts = |sizes: &PairKindMap<usize>| {
        let pass: usize = pair_counts.iter().map(|(kind, count)| count * sizes[kind]).sum();
        pass > 0 && count_before.is_multiple_of(pass) && total_count.is_multiple_of(pass) && total_count > 0
    };
    let full = PairKindMap::from_fn(PairKind::polynomial_count);
    if divides_counts(&full) {
        return Some(full);
    }
    let present_kinds: Vec<PairKind> = PairKind::ALL.into_iter().filter(|kind| pair_counts[*kind] > 0).collect();
    // Kinds without pairs log nothing, so their number of polynomials is not varied.
    let mut choices = vec![full];
    for &kind in &present_kinds {
        let with = |sizes: PairKindMap<usize>, size| {
            PairKindMap::from_fn(|other| if other == kind { size } else { sizes[other] })
        };
        choices = choices.into_iter().flat_map(|sizes| (0..=full[kind]).map(move |size| with(sizes, size))).collect();
    }
    let changes =
        |sizes: &PairKindMap<usize>| present_kinds.iter().filter(|kind| sizes[**kind] != full[**kind]).count();
    let is_empty = |sizes: &PairKindMap<usize>| present_kinds.iter().any(|kind| sizes[*kind] == 0);
    // The fewest changes come first, because a student may forget a part of one detection, but rarely parts of two.
    choices.sort_by_key(|sizes| (changes(sizes), std::cmp::Reverse(sizes.values().sum::<usize>())));
    let mut fitting = choices.into_iter().filter(divides_counts);
    let first = fitting.next()?;
    // The numbers alone do not show which of two detections is empty, and a wrong guess would make everything look
    // wrong.
    let is_rival = |other: PairKindMap<usize>| changes(&other) == changes(&first) && is_empty(&other);
    let is_open = is_empty(&first) && fitting.any(is_rival);
    (!is_open).then_some(first)
}

impl Observer for SampleCollector<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.next_polynomial = match (pass.stage, pass.index) {
            (_, 0) => Some((0, 0)),
            (Stage::Geometric { round: 0 }, index) if matches!(self.scene.collision, Collision::Hybrid { .. }) => {
                Some((index, self.mid.polynomials.len()))
            }
            _ => None,
        };
    }

    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

impl StepController for SampleCollector<'_> {
    fn adjust_polynomials(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], _polynomials: &mut [Polynomial]) {
        let (Some((pass, index)), Some(sizes)) = (self.next_polynomial, self.polynomial_counts) else { return };
        let size = sizes[pair.kind];
        let lists = index..index + size;
        // After a contact of the submission, polynomials depend on a response that is not logged.
        self.next_polynomial = (!self.is_hit(pair)).then_some((pass, lists.end));
        if lists.end > self.log.len() {
            self.next_polynomial = None;
            return;
        }
        let polynomials: Vec<Vec<f64>> = lists.map(|index| self.log.get(index).to_vec()).collect();
        if polynomials.iter().flatten().any(|value| !value.is_finite()) {
            // A NaN or an infinity proves nothing about a formula.
            return;
        }
        let is_right_until = |q_end: &[f64]| {
            let expected = formulas::BoundedPairMotion::for_pair(self.scene, pair, q_start, q_end).polynomials();
            size == pair.kind.polynomial_count()
                && polynomials.iter().enumerate().all(|(number, logged)| {
                    let forms = [Some(expected.polynomial(number)), expected.other_form(number)];
                    forms.into_iter().flatten().any(|form| compare(form, logged, &[1.0]).is_ok())
                })
        };
        let is_right = is_right_until(q_end);
        if !is_right && pass == 0 && is_right_until(&self.mid.state.positions) {
            // The submission's integrator leads to other positions, but the formulas are right.
            return;
        }
        let kind = &self.samples_by_kind[pair.kind];
        if if is_right { kind.right_count >= MAX_RIGHT } else { kind.wrong_count >= MAX_WRONG } {
            return;
        }
        let motion = PairMotion::from_positions(self.scene, pair, q_start, q_end);
        let kind = &mut self.samples_by_kind[pair.kind];
        *(if is_right { &mut kind.right_count } else { &mut kind.wrong_count }) += 1;
        kind.samples.push(Sample { step: self.step, pass, pair, motion, polynomials });
    }

    fn adjust_decision(&mut self, _pair: Pair, decision: Decision) -> Decision {
        // Later pairs of a continuous-time pass use positions after the submission's responses, which are not logged.
        if matches!(self.scene.collision, Collision::ContinuousTime { .. }) && matches!(decision, Decision::Hit { .. })
        {
            self.next_polynomial = None;
        }
        decision
    }

    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        if self.mid.state.positions.iter().chain(&self.mid.state.velocities).all(|value| value.is_finite()) {
            state.clone_from(&self.mid.state);
        }
        ResumeState::Synchronized
    }
}
