//! What the reference does in a step from the submission's own state, event by event.
use super::{ROUND_OFF, Sample, first_difference, same_polynomial};
use crate::diagnose::known::{Capture, Logged, StepRecords, state_difference};
use fosssim_judge::budget::Budget;
use fosssim_model::{
    scene::Scene,
    sim::{Decision, Detection, Observer, Pair, Pass, RootSearch, Simulation, Stage, State, Time, Zone},
};
use fosssim_num::vector::Vec2;

/// A contact that the reference finds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    pub(super) pair: Pair,
    pub(super) normal: Vec2,
    pub(super) time: f64,
    /// The pass in which it is found, from 0.
    pub(super) pass: usize,
    /// Its place in the order of all detections of the step.
    pub(super) place: usize,
}

/// A detection pass of the reference.
#[derive(Debug, Clone, Copy)]
pub(super) struct PassFacts {
    pub(super) stage: Stage,
    /// The index of its first polynomial.
    pub(super) first: usize,
}

/// A zone that the reference moves.
#[derive(Debug, Clone)]
pub(super) struct ZoneFacts {
    pub(super) round: u32,
    pub(super) particles: Vec<usize>,
    pub(super) half_plane: bool,
}

/// What the reference tells besides its records.
#[derive(Debug, Default)]
struct StepEvents {
    hits: Vec<Hit>,
    passes: Vec<PassFacts>,
    zones: Vec<ZoneFacts>,
    detections: Vec<(Pair, usize)>,
    polynomials: usize,
}

impl Observer for StepEvents {
    fn begin_step(&mut self, _step: u32) {
        *self = Self::default();
    }

    fn begin_pass(&mut self, pass: Pass) {
        self.passes.push(PassFacts { stage: pass.stage, first: self.polynomials });
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        if let Decision::Hit { time, normal } = detection.decision {
            let (pass, place) = (self.passes.len().saturating_sub(1), self.detections.len());
            self.hits.push(Hit { pair: detection.pair, normal, time, pass, place });
        }
        self.detections.push((detection.pair, self.polynomials));
        self.polynomials += detection.polynomials.len();
    }

    fn failsafe(&mut self, round: u32, zone: &Zone<'_>) {
        let particles = zone.particles.iter().map(|&particle| particle as usize).collect();
        self.zones.push(ZoneFacts { round, particles, half_plane: zone.half_plane });
    }
}

/// The observer of a step in which nothing collides.
struct NoCollisions;

impl Observer for NoCollisions {
    fn decide(&mut self, _pair: Pair, _decision: Decision) -> Decision {
        Decision::Miss { time: Time::Found(f64::INFINITY) }
    }
}

/// A step of the submission beside the reference's.
pub(super) struct Facts {
    /// Whether anything differs.
    pub(super) is_wrong: bool,
    /// Whether a polynomial is wrong that depends on nothing but the state before the step.
    pub(super) has_wrong_formula: bool,
    pub(super) before: State,
    /// Where the integrator alone leads.
    pub(super) prediction: State,
    pub(super) expected: StepRecords,
    pub(super) actual: StepRecords,
    /// The first polynomial that differs, or where one of the lists ends.
    pub(super) right_polynomials: usize,
    pub(super) hits: Vec<Hit>,
    pub(super) passes: Vec<PassFacts>,
    pub(super) zones: Vec<ZoneFacts>,
    /// All pairs in the order of detection, each with the index of its first polynomial.
    pub(super) detections: Vec<(Pair, usize)>,
}

impl Facts {
    /// How many polynomials a pass logs.
    pub(super) fn pass_size(&self) -> usize {
        self.passes.get(1).map_or(self.expected.end.polynomials.len(), |pass| pass.first)
    }

    /// The expected and the actual state in the middle of the step.
    pub(super) fn middles(&self) -> Option<(&Logged, &Logged)> {
        Some((self.expected.mid.as_ref()?, self.actual.mid.as_ref()?))
    }

    /// Whether the middle of the step is right: the state, and how many polynomials were logged by then.
    pub(super) fn has_right_middle(&self) -> bool {
        self.middles().is_some_and(|(expected, actual)| {
            expected.polynomials.len() == actual.polynomials.len()
                && self.right_polynomials >= actual.polynomials.len()
                && state_difference(&expected.state, &actual.state, &ROUND_OFF).is_none()
        })
    }
}

/// Lets the reference run steps.
pub(super) struct Reference<'a> {
    budget: Budget<'a>,
    simulation: Simulation,
    observers: (Capture, StepEvents),
}

impl<'a> Reference<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let simulation = Simulation::new(scene, RootSearch::WhereNeeded);
        Self {
            budget: Budget::new(scene, false),
            simulation,
            observers: (Capture::new(&scene.collision), StepEvents::default()),
        }
    }

    fn set(&mut self, sample: &Sample) {
        self.simulation.state_mut().clone_from(&sample.before);
        self.simulation.set_steps_done(sample.step - 1);
    }

    /// The facts of a step; none where the reference has no result.
    pub(super) fn facts(&mut self, sample: &Sample) -> Option<Facts> {
        self.set(sample);
        self.budget.step(&mut self.simulation, &mut NoCollisions).ok()?;
        let prediction = self.simulation.state().clone();
        self.set(sample);
        self.budget.step(&mut self.simulation, &mut self.observers).ok()?;
        let (capture, events) = &mut self.observers;
        let events = std::mem::take(events);
        let (expected, actual) = (capture.records.clone(), sample.records.clone());
        let (ours, theirs) = (&expected.end.polynomials, &actual.end.polynomials);
        let differing =
            ours.iter().zip(theirs.iter()).position(|(ours, theirs)| !same_polynomial(ours, theirs, &ROUND_OFF));
        let right_polynomials = differing.unwrap_or(ours.len().min(theirs.len()));
        let is_wrong = first_difference(&expected, &actual, &ROUND_OFF).is_some();
        let mut facts = Facts {
            is_wrong,
            has_wrong_formula: false,
            before: sample.before.clone(),
            prediction,
            expected,
            actual,
            right_polynomials,
            hits: events.hits,
            passes: events.passes,
            zones: events.zones,
            detections: events.detections,
        };
        facts.has_wrong_formula = differing.is_some_and(|index| index < facts.certain_polynomials());
        Some(facts)
    }
}

impl Facts {
    /// How many polynomials depend on nothing but the state before the step: those of the first pass, in `continuous-time` up to
    /// the first contact's own.
    pub(super) fn certain_polynomials(&self) -> usize {
        let all = self.pass_size();
        match self.passes.first().map(|pass| pass.stage) {
            Some(Stage::ContinuousTime) => {
                self.hits.first().and_then(|hit| self.detections.get(hit.place + 1)).map_or(all, |(_, first)| *first)
            }
            _ => all,
        }
    }
}
