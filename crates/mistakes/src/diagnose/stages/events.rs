//! The reference's work in a step from the submission's own state, event by event.
use crate::diagnose::sampling::{
    Capture, KeptStep, LoggedNumbers, ROUND_OFF, Reference, StepRecords, find_first_difference, find_state_difference,
    formula_matches, impulse_matches, polynomial_matches,
};
use fosssim_judge::fair::formulas::BoundedPairMotion;
use fosssim_model::{
    scene::Scene,
    sim::{
        Decision, Detection, ImpactTime, Observer, Pair, PairKind, Pass, Stage, State, SteeringObserver,
        StepController, Zone,
    },
    trace::PolynomialLog,
};
use fosssim_num::{bounded::BoundedValue, vector::Vec2};

/// A contact that the reference finds in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    pub(super) pair: Pair,
    pub(super) normal: Vec2,
    pub(super) time: f64,
    /// The pass that finds the contact, from 0.
    pub(super) pass: usize,
    /// The index of the detection among all detections of the step.
    pub(super) detection_index: usize,
}

/// A detection pass of the reference.
#[derive(Debug, Clone)]
pub(super) struct PassFacts {
    pub(super) stage: Stage,
    /// The index of the pass's first polynomial in the step.
    pub(super) first_polynomial: usize,
    /// The end positions of particles when the pass begins.
    pub(super) end_positions: Vec<f64>,
}

/// A zone that the reference moves.
#[derive(Debug, Clone)]
pub(super) struct ZoneFacts {
    pub(super) round: u32,
    pub(super) particles: Vec<usize>,
    pub(super) has_half_plane: bool,
}

/// Events that the reference reports in addition to its records.
#[derive(Debug, Default)]
struct Events {
    hits: Vec<Hit>,
    passes: Vec<PassFacts>,
    zones: Vec<ZoneFacts>,
    detections: Vec<(Pair, usize)>,
    polynomial_count: usize,
    /// The approach polynomials of edges in the other accepted form, each with its index.
    other_forms: Vec<(usize, Vec<f64>)>,
}

#[derive(Debug)]
struct StepEvents<'a> {
    scene: &'a Scene,
    events: Events,
}

impl StepEvents<'_> {
    /// Keeps the mathematically right approach polynomial of an edge, if it differs from the course's form.
    fn keep_other_form(&mut self, detection: &Detection<'_>) {
        let &Detection { pair, q_start, q_end, .. } = detection;
        if pair.kind != PairKind::ParticleEdge {
            return;
        }
        let expected = BoundedPairMotion::for_pair(self.scene, pair, q_start, q_end).polynomials();
        let values = |form: &[BoundedValue]| form.iter().map(|coefficient| coefficient.value).collect::<Vec<f64>>();
        if let Some(other) = expected.other_form(APPROACH_INDEX).map(values)
            && other != values(expected.polynomial(APPROACH_INDEX))
        {
            self.events.other_forms.push((self.events.polynomial_count + APPROACH_INDEX, other));
        }
    }
}

impl Observer for StepEvents<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        let first = self.events.polynomial_count;
        self.events.passes.push(PassFacts { stage: pass.stage, first_polynomial: first, end_positions: Vec::new() });
    }

    fn observe_positions(&mut self, _q_start: &[f64], q_end: &[f64]) {
        if let Some(pass) = self.events.passes.last_mut() {
            pass.end_positions = q_end.to_vec();
        }
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        self.keep_other_form(detection);
        let events = &mut self.events;
        if let Decision::Hit { time, normal } = detection.decision {
            let (pass, detection_index) = (events.passes.len().saturating_sub(1), events.detections.len());
            events.hits.push(Hit { pair: detection.pair, normal, time, pass, detection_index });
        }
        events.detections.push((detection.pair, events.polynomial_count));
        events.polynomial_count += detection.polynomials.len();
    }

    fn observe_failsafe(&mut self, round: u32, zone: &Zone<'_>) {
        let particles = zone.particles.iter().map(|&particle| particle as usize).collect();
        self.events.zones.push(ZoneFacts { round, particles, has_half_plane: zone.half_plane });
    }
}

/// The index of an edge's approach among its polynomials.
const APPROACH_INDEX: usize = 3;

/// A controller with which nothing collides in a step.
struct NoCollisions;

impl StepController for NoCollisions {
    fn adjust_decision(&mut self, _pair: Pair, _decision: Decision) -> Decision {
        Decision::Miss { time: ImpactTime::Found(f64::INFINITY) }
    }
}

/// A step of the submission, and the reference's step from the same state.
pub(super) struct StepFacts {
    /// Whether anything in the step differs.
    pub(super) is_wrong: bool,
    pub(super) before: State,
    /// The state after the integrator, without collisions.
    pub(super) prediction: State,
    pub(super) expected: StepRecords,
    pub(super) actual: StepRecords,
    /// The number of right polynomials before the first difference, or before the end of one of the lists.
    pub(super) right_polynomials: usize,
    pub(super) hits: Vec<Hit>,
    pub(super) passes: Vec<PassFacts>,
    pub(super) zones: Vec<ZoneFacts>,
    /// All pairs in the order of detection, each with the index of its first polynomial.
    pub(super) detections: Vec<(Pair, usize)>,
}

impl StepFacts {
    /// Returns the facts about a step, or `None` if the reference has no result.
    pub(super) fn for_step(reference: &mut Reference<'_>, scene: &Scene, kept_step: &KeptStep) -> Option<Self> {
        let prediction =
            reference.step(kept_step.step, &kept_step.before, &mut SteeringObserver(NoCollisions))?.clone();
        let mut observers = (Capture::new(&scene.collision), StepEvents { scene, events: Events::default() });
        reference.step(kept_step.step, &kept_step.before, &mut observers)?;
        let (capture, StepEvents { events, .. }) = observers;
        let (mut expected, actual) = (capture.records, kept_step.records.clone());
        accept_other_forms(&mut expected, &actual, &events.other_forms);
        let (ours, theirs) = (&expected.end.polynomials, &actual.end.polynomials);
        let is_right = |(ours, theirs): &(&[f64], &[f64])| polynomial_matches(ours, theirs, &ROUND_OFF);
        let right_polynomials = ours.iter().zip(theirs.iter()).take_while(is_right).count();
        let is_wrong = find_first_difference(&expected, &actual, &ROUND_OFF).is_some();
        let (before, Events { hits, passes, zones, detections, .. }) = (kept_step.before.clone(), events);
        Some(Self {
            is_wrong,
            before,
            prediction,
            expected,
            actual,
            right_polynomials,
            hits,
            passes,
            zones,
            detections,
        })
    }

    /// Returns whether contacts are resolved immediately, in the single pass of `continuous-time`.
    pub(super) fn is_continuous(&self) -> bool {
        self.passes.first().is_some_and(|pass| pass.stage == Stage::ContinuousTime)
    }

    /// Returns whether the impulse list is the expected one.
    pub(super) fn has_right_impulses(&self) -> bool {
        let (ours, theirs) = (&self.expected.end.impulses, &self.actual.end.impulses);
        ours.len() == theirs.len()
            && ours.iter().zip(theirs).all(|(one, other)| impulse_matches(one, other, &ROUND_OFF))
    }

    /// Returns the number of polynomials of a pass.
    pub(super) fn pass_size(&self) -> usize {
        self.passes.get(1).map_or(self.expected.end.polynomials.len(), |pass| pass.first_polynomial)
    }

    /// Returns the expected and the actual mid state, or `None` if one of them is missing.
    pub(super) fn mid_states(&self) -> Option<(&LoggedNumbers, &LoggedNumbers)> {
        Some((self.expected.mid.as_ref()?, self.actual.mid.as_ref()?))
    }

    /// Returns whether the middle of the step is right: the state, and the number of polynomials logged until then.
    pub(super) fn has_right_mid_state(&self) -> bool {
        self.mid_states().is_some_and(|(expected, actual)| {
            expected.polynomials.len() == actual.polynomials.len()
                && self.right_polynomials >= actual.polynomials.len()
                && find_state_difference(&expected.state, &actual.state, &ROUND_OFF).is_none()
        })
    }

    /// Returns the numbers of passes that the submission logged before and after the middle of the step, or `None` if
    /// the polynomials do not fill whole passes.
    pub(super) fn logged_passes(&self) -> Option<(usize, usize)> {
        let (size, (_, middle)) = (self.pass_size(), self.mid_states()?);
        let (first, total) = (middle.polynomials.len(), self.actual.end.polynomials.len());
        let is_whole = size > 0 && first <= total && first.is_multiple_of(size) && total.is_multiple_of(size);
        is_whole.then(|| (first / size, (total - first) / size))
    }

    /// Returns whether a logged pass (from 0) describes the motion from the start of the step to the positions `end`.
    /// Only the pairs that `selects` accepts are compared.
    pub(super) fn fits_motion(&self, scene: &Scene, pass: usize, end: &[f64], selects: impl Fn(Pair) -> bool) -> bool {
        let (logged, size) = (&self.actual.end.polynomials, self.pass_size());
        if (pass + 1) * size > logged.len() {
            return false;
        }
        let pass_detections = self.detections.iter().take_while(|(_, first)| *first < size);
        pass_detections.filter(|(pair, _)| selects(*pair)).all(|(pair, first)| {
            let expected = BoundedPairMotion::for_pair(scene, *pair, &self.before.positions, end).polynomials();
            (0..expected.count()).all(|number| {
                let forms = [Some(expected.polynomial(number)), expected.other_form(number)];
                let index = pass * size + first + number;
                forms.into_iter().flatten().any(|form| formula_matches(form, logged.get(index), &ROUND_OFF))
            })
        })
    }

    /// Returns whether a polynomial is wrong that depends only on the state before the step.
    pub(super) fn has_wrong_formula(&self) -> bool {
        let (ours, theirs) = (self.expected.end.polynomials.len(), self.actual.end.polynomials.len());
        self.right_polynomials < ours.min(theirs).min(self.count_certain_polynomials())
    }

    /// Returns the number of polynomials that depend only on the state before the step. These are the polynomials of
    /// the first pass, or in `continuous-time` those up to the first contact.
    pub(super) fn count_certain_polynomials(&self) -> usize {
        let contact = self.hits.first().filter(|_| self.is_continuous());
        let behind = contact.and_then(|hit| self.detections.get(hit.detection_index + 1));
        behind.map_or(self.pass_size(), |(_, first)| *first)
    }
}

/// Replaces the expected approach of an edge by its other form if the trace logged the other form, because both are
/// right.
fn accept_other_forms(expected: &mut StepRecords, actual: &StepRecords, others: &[(usize, Vec<f64>)]) {
    let theirs = &actual.end.polynomials;
    let is_right =
        |index: usize| polynomial_matches(expected.end.polynomials.get(index), theirs.get(index), &ROUND_OFF);
    let is_taken = |(index, other): &&(usize, Vec<f64>)| {
        let index = *index;
        index < theirs.len().min(expected.end.polynomials.len())
            && !is_right(index)
            && polynomial_matches(other, theirs.get(index), &ROUND_OFF)
            && (index - APPROACH_INDEX..index).all(is_right)
    };
    let accepted_indices: Vec<usize> = others.iter().filter(is_taken).map(|(index, _)| *index).collect();
    if accepted_indices.is_empty() {
        return;
    }
    let replaced = |ours: &PolynomialLog| {
        let mut log = PolynomialLog::default();
        for (index, list) in ours.iter().enumerate() {
            log.push(if accepted_indices.binary_search(&index).is_ok() { theirs.get(index) } else { list });
        }
        log
    };
    if let Some(mid) = &mut expected.mid {
        mid.polynomials = replaced(&mid.polynomials);
    }
    expected.end.polynomials = replaced(&expected.end.polynomials);
}
