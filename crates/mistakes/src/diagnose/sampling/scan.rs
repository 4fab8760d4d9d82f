//! Finds the wrong steps of a trace, and keeps a diverse selection of them.
use super::{
    capture::Capture,
    compare::{
        LoggedNumbers, ROUND_OFF, SINGLE_PRECISION_TOLERANCE, StepDifference, StepRecords, Tolerance,
        find_first_difference, polynomial_matches,
    },
    reference::Reference,
    source::{Outline, StepFrames},
};
use fosssim_model::{
    scene::Scene,
    sim::State,
    trace::{Layout, LenientFrame},
};
use fosssim_num::tolerances::KNOWN_STATE_ERROR;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of kept steps of each kind, wrong and right.
const MAX_WRONG: usize = 200;
const MAX_RIGHT: usize = 40;
/// The number of similar wrong steps that are all kept. One in [`SIMILAR_SAMPLING_RATE`] of the further ones is kept.
const MAX_SIMILAR_WRONG: u32 = 8;
const SIMILAR_SAMPLING_RATE: u32 = 16;
/// The number of similar right steps that are kept.
const MAX_SIMILAR_RIGHT: u32 = 3;
/// The number of wrong steps that are tried first.
const PROBE_STEPS: usize = 8;
/// The maximum memory of kept steps, in bytes.
const MAX_MEMORY_BYTES: usize = 24 << 20;

/// A kept step.
#[derive(Debug)]
pub struct KeptStep {
    /// The step's number, from 1.
    pub step: u32,
    /// The submission's own state before the step.
    pub before: State,
    /// The submission's records.
    pub records: StepRecords,
    /// The first difference from the reference, or `None` for right steps.
    pub difference: Option<StepDifference>,
    /// The facts that depend on the step and the previous one.
    pub context: StepContext,
    /// A number that similar steps share.
    pub signature: u64,
}

/// The facts that follow from the step and the previous one.
#[derive(Debug, Clone, Copy, Default)]
pub struct StepContext {
    /// Whether the record would be right if the polynomials of the previous step were removed from its front.
    pub keeps_polynomials: bool,
    /// Whether the record would be right if the impulses of the previous step were removed from its front.
    pub keeps_impulses: bool,
    /// Whether all positions or all velocities have single precision, and the step is right apart from this.
    pub has_single_precision: bool,
    /// Whether velocities change by the expected change plus their change in the previous step.
    pub keeps_forces: bool,
}

/// The parts of a trace on which the rows of the catalog are tried.
#[derive(Debug, Default)]
pub struct Scan {
    /// The wrong steps, in order.
    pub wrong_steps: Vec<KeptStep>,
    /// The right steps, in order.
    pub right_steps: Vec<KeptStep>,
    /// Facts about the trace in addition to its steps.
    pub outline: Outline,
}

impl Scan {
    /// Removes right steps above the maximum number.
    pub fn limit_right_steps(&mut self) {
        self.right_steps.truncate(MAX_RIGHT);
    }

    /// Returns the wrong steps to be tried first: one of each kind, the cheapest first. The first difference is always
    /// included, because it must be reproduced.
    pub fn probes(&self) -> Vec<&KeptStep> {
        let mut signatures = BTreeSet::new();
        let is_probe = |kept: &&KeptStep| signatures.insert(kept.signature);
        let mut probes: Vec<&KeptStep> = self.wrong_steps.iter().filter(is_probe).take(PROBE_STEPS).collect();
        probes.sort_by_key(|kept| kept.records.end.polynomials.len());
        probes
    }
}

/// An examination of a trace, one step after the other.
pub struct Scanner {
    has_mid: bool,
    round_off: Tolerance,
    capture: Capture,
    scan: Scan,
    signature_counts: BTreeMap<(bool, u64), u32>,
    memory: usize,
    /// The wrong steps with events that end in values that are not finite.
    non_finite_steps: Vec<KeptStep>,
    /// The number of the previous step, and the change of its velocities.
    last_velocity_changes: Option<(u32, Vec<f64>)>,
}

impl Scanner {
    /// Creates the scan for traces of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            has_mid: Layout::for_scene(scene).has_polynomials,
            round_off: Tolerance::for_scene(scene),
            capture: Capture::new(&scene.collision),
            scan: Scan::default(),
            signature_counts: BTreeMap::new(),
            memory: 0,
            non_finite_steps: Vec::new(),
            last_velocity_changes: None,
        }
    }

    /// Returns the kept steps, with the outline of their trace. Steps that end in values that are not finite count only
    /// if no other step is wrong, because several mistakes give the same NaN.
    pub fn into_scan(self, outline: Outline) -> Scan {
        let wrong = if self.scan.wrong_steps.is_empty() { self.non_finite_steps } else { self.scan.wrong_steps };
        Scan { outline, wrong_steps: wrong, ..self.scan }
    }

    /// Examines one step, and keeps it if it is useful.
    pub fn examine_step(&mut self, reference: &mut Reference<'_>, step: u32, frames: &StepFrames) {
        let StepFrames { before, mid, end } = frames;
        if !before.state.positions.iter().chain(&before.state.velocities).all(|value| value.is_finite())
            || reference.step(step, &before.state, &mut self.capture).is_none()
        {
            return;
        }
        let actual = StepRecords { mid: self.has_mid.then(|| mid.into()), end: end.into() };
        let difference = find_first_difference(&self.capture.records, &actual, &self.round_off);
        let signature = self.signature(difference, &actual);
        if !actual.is_finite() {
            if self.capture.event_bits != 0 && self.non_finite_steps.len() < PROBE_STEPS {
                let (before, context) = (before.state.clone(), StepContext::default());
                self.non_finite_steps.push(KeptStep { step, before, records: actual, difference, context, signature });
            }
            return;
        }
        let change = before.state.velocities.iter().zip(&actual.end.state.velocities).map(|(old, new)| new - old);
        let last =
            self.last_velocity_changes.replace((step, change.collect())).filter(|(number, _)| number + 1 == step);
        let count = self.signature_counts.entry((difference.is_some(), signature)).or_default();
        let number = *count;
        *count += 1;
        let is_kept = if difference.is_some() {
            self.scan.wrong_steps.len() < MAX_WRONG
                && (number < MAX_SIMILAR_WRONG || number.is_multiple_of(SIMILAR_SAMPLING_RATE))
        } else {
            self.scan.right_steps.len() < MAX_RIGHT && number < MAX_SIMILAR_RIGHT
        };
        // The first wrong step is always kept, so that there is something to explain.
        if !is_kept || (self.memory > MAX_MEMORY_BYTES && !self.scan.wrong_steps.is_empty()) {
            return;
        }
        let context = difference.map_or(StepContext::default(), |_| {
            self.step_context(before, &actual, last.as_ref().map(|(_, change)| change.as_slice()))
        });
        let kept_step =
            KeptStep { step, before: before.state.clone(), records: actual, difference, context, signature };
        self.memory += kept_step.memory_size();
        if difference.is_some() { self.scan.wrong_steps.push(kept_step) } else { self.scan.right_steps.push(kept_step) }
    }

    /// Returns a number that similar steps share: they have the same events, and the same first difference.
    fn signature(&self, difference: Option<StepDifference>, actual: &StepRecords) -> u64 {
        let first = match difference {
            None => 0,
            Some(StepDifference::Polynomial(index)) => match self.capture.locate_polynomial(index) {
                Some((pair, pass, number)) => {
                    8 + u64::from(pass.index.min(2)) * 32
                        + u64::from(pair.kind.code().unsigned_abs()) * 8
                        + number as u64
                }
                None => 1,
            },
            Some(StepDifference::PolynomialCount) => 2,
            Some(StepDifference::MidState(_)) => 3,
            Some(StepDifference::Impulses) => 4,
            Some(StepDifference::EndState(_)) => 5,
            Some(StepDifference::MidLists) => 6,
        };
        let logged = actual.end.impulses.iter().fold(0, |bits, impulse| bits | 1 << impulse.kind.clamp(0, 3));
        u64::from(self.capture.event_bits) | first << 32 | logged << 48
    }

    fn step_context(&self, before: &LenientFrame, actual: &StepRecords, last: Option<&[f64]>) -> StepContext {
        let expected = &self.capture.records;
        let (ours, theirs) = (&expected.end.state, &actual.end.state);
        let is_single = (are_single_precision(&theirs.positions) && !are_single_precision(&ours.positions))
            || (are_single_precision(&theirs.velocities) && !are_single_precision(&ours.velocities));
        StepContext {
            keeps_polynomials: self.is_right_without(before, actual, |records, previous| {
                let kept_count = previous.polynomials.len();
                let theirs = &mut records.polynomials;
                let has_prefix = theirs.len() >= kept_count
                    && previous
                        .polynomials
                        .iter()
                        .zip(theirs.iter())
                        .all(|(a, b)| polynomial_matches(a, b, &ROUND_OFF));
                if has_prefix && kept_count > 0 {
                    let start = theirs.coefficient_ends[kept_count - 1];
                    theirs.coefficients.drain(..start);
                    theirs.coefficient_ends.drain(..kept_count);
                    theirs.coefficient_ends.iter_mut().for_each(|end| *end -= start);
                }
                has_prefix
            }),
            keeps_impulses: self.is_right_without(before, actual, |records, previous| {
                let has_prefix = records.impulses.starts_with(&previous.impulses);
                if has_prefix {
                    records.impulses.drain(..previous.impulses.len());
                }
                has_prefix
            }),
            has_single_precision: is_single
                && find_first_difference(expected, actual, &SINGLE_PRECISION_TOLERANCE).is_none(),
            keeps_forces: last.is_some_and(|last| {
                let changes = before.state.velocities.iter().zip(&expected.end.state.velocities).zip(last);
                let mut kept = changes.zip(&actual.end.state.velocities);
                kept.all(|(((_, expected), last), end)| {
                    (expected + last - end).abs() <= KNOWN_STATE_ERROR * (1.0 + expected.abs() + last.abs())
                })
            }),
        }
    }

    /// Returns whether the step is right after `strip` has removed the previous step's lists from its records.
    fn is_right_without(
        &self,
        before: &LenientFrame,
        actual: &StepRecords,
        strip: impl Fn(&mut LoggedNumbers, &LenientFrame) -> bool,
    ) -> bool {
        let mut records = actual.clone();
        let stripped = records.mid.as_mut().is_none_or(|mid| strip(mid, before)) && strip(&mut records.end, before);
        stripped && find_first_difference(&self.capture.records, &records, &self.round_off).is_none()
    }
}

impl KeptStep {
    fn memory_size(&self) -> usize {
        let mid = self.records.mid.as_ref().map_or(0, LoggedNumbers::memory_size);
        16 * self.before.positions.len() + mid + self.records.end.memory_size()
    }
}

/// Returns whether all numbers have single precision.
fn are_single_precision(numbers: &[f64]) -> bool {
    #[expect(clippy::cast_possible_truncation, reason = "the test is whether the conversion loses anything")]
    let exact = |value: &f64| f64::from(*value as f32).to_bits() == value.to_bits();
    numbers.iter().all(exact)
}
