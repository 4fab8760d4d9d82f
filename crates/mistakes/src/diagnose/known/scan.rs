//! Reads a trace once, finds its wrong steps, and keeps some of them, as diverse as possible.
use super::{
    capture::Capture,
    compare::{Difference, Logged, ROUND_OFF, SINGLE_PRECISION, StepRecords, first_difference, same_polynomial},
    resimulate::{Correct, resimulate},
};
use crate::{
    diagnose::source::{Source, StepFrames},
    student::{StepLog, World},
};
use fosssim_judge::{budget::Budget, kept::LONGEST};
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation, State},
    trace::{Layout, Lenient, LenientFrame, Unreadable, record_memory},
};
use fosssim_num::tolerances::FIRST_RECORD;
use std::{collections::BTreeMap, io::Read};

/// Steps that are kept, wrong and right.
const MOST_WRONG: usize = 200;
const MOST_RIGHT: usize = 40;
/// Of the steps that look alike, the first ones are kept, and then one out of this number.
const FIRST_ALIKE: u32 = 8;
const ALIKE: u32 = 16;
/// Right steps that look alike.
const RIGHT_ALIKE: u32 = 3;
/// Memory that kept steps may take, in bytes.
const MEMORY: usize = 24 << 20;
/// Records at the beginning of the trace that are kept whatever they hold, and their memory.
const OPENING: usize = 25;
const OPENING_MEMORY: usize = 4 << 20;

/// A step that is kept.
#[derive(Debug)]
pub(in crate::diagnose) struct Sample {
    /// Its number, from 1.
    pub(in crate::diagnose) step: u32,
    /// The submission's own state before it.
    pub(in crate::diagnose) before: State,
    /// What the submission logged.
    pub(in crate::diagnose) records: StepRecords,
    /// Where it differs first from the reference; `None` for right steps.
    pub(super) difference: Option<Difference>,
    /// What can only be seen with the record before.
    pub(super) context: Context,
    /// Steps with the same one look alike.
    pub(super) signature: u64,
}

/// What the step tells together with the step before.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Context {
    /// Right, but behind the polynomials of the step before.
    pub(super) polynomials_kept: bool,
    /// Right, but behind the impulses of the step before.
    pub(super) impulses_kept: bool,
    /// Right, though NaN stands in its lists: contacts were found and resolved that NaN can't lead to.
    pub(super) logs_nan: bool,
    /// All numbers of its states are those of single precision, and apart from that it is right.
    pub(super) single_precision: bool,
}

/// What the trace has.
#[derive(Debug, Default)]
pub(in crate::diagnose) struct Scan {
    /// Wrong steps, in their order.
    pub(in crate::diagnose) wrong: Vec<Sample>,
    /// Right steps, in their order.
    pub(in crate::diagnose) right: Vec<Sample>,
    /// The first records.
    pub(super) opening: Vec<Logged>,
    /// Records whose polynomials have small leading coefficients, which the course's library drops.
    pub(super) padded: u64,
    /// How many records the trace has, when its end was reached.
    pub(super) records: Option<u64>,
    /// Whether the first record is that of another scene.
    pub(super) foreign: bool,
    /// Whether the trace goes on after the scene's last step.
    pub(super) longer: bool,
}

impl Scan {
    /// Sees the same steps as a program does whose particle-edge approach is mathematically right: many that were wrong
    /// are right then. False when all are, or when the scene has no edge.
    pub(super) fn take_right_approach(&mut self, scene: &Scene) -> bool {
        if scene.edges.is_empty() {
            return false;
        }
        let world = World::new(scene.clone(), Correct::RightApproach.with(None));
        let samples = std::mem::take(&mut self.wrong).into_iter().chain(std::mem::take(&mut self.right));
        for mut sample in samples {
            let logged = sample.records.end.polynomials.len();
            // A few more than were logged show that there are too few; no more are of interest.
            let guard = |index: usize, _: &[f64]| index < 2 * logged + SPARE;
            let expected = resimulate(&world, &sample.before, StepLog { guard: Some(&guard), ..StepLog::default() });
            let Some(expected) = expected else { continue };
            sample.difference = first_difference(&expected, &sample.records, &ROUND_OFF);
            if sample.difference.is_some() { self.wrong.push(sample) } else { self.right.push(sample) }
        }
        self.right.truncate(MOST_RIGHT);
        !self.wrong.is_empty()
    }
}

/// How many polynomials more than were logged a step may have before it is left.
const SPARE: usize = 10_000;

/// Reads the trace and re-simulates its steps without a mistake.
pub(super) fn scan(scene: &Scene, source: Source<'_>) -> Scan {
    let mut scanner = Scanner::new(scene, source.beginning);
    scanner.run();
    if !source.is_whole {
        scanner.scan.records = None;
    }
    for late in source.late {
        let Some(StepFrames { before, mid, end }) = StepFrames::of_late(scene, late) else { continue };
        scanner.previous = before;
        scanner.step(late.step, &mid, &end);
    }
    scanner.scan
}

struct Scanner<'a, R> {
    reader: Lenient<R>,
    layout: Layout,
    simulation: Simulation,
    budget: Budget<'a>,
    capture: Capture,
    previous: LenientFrame,
    actual: StepRecords,
    scan: Scan,
    seen: BTreeMap<(bool, u64), u32>,
    memory: usize,
    opening_memory: usize,
}

impl<'a, R: Read> Scanner<'a, R> {
    fn new(scene: &'a Scene, trace: R) -> Self {
        let layout = Layout::of(scene);
        Self {
            reader: Lenient::new(trace, layout).with_limit(record_memory(scene)),
            layout,
            simulation: Simulation::new(scene, RootSearch::WhereNeeded),
            budget: Budget::new(scene, false),
            capture: Capture::new(&scene.collision),
            previous: LenientFrame::default(),
            actual: StepRecords::default(),
            scan: Scan::default(),
            seen: BTreeMap::new(),
            memory: 0,
            opening_memory: 0,
        }
    }

    fn run(&mut self) {
        let mut frame = LenientFrame::default();
        if !self.read(&mut frame) {
            return;
        }
        self.scan.foreign = is_foreign(self.simulation.state(), &frame.state);
        std::mem::swap(&mut self.previous, &mut frame);
        let mut mid = LenientFrame::default();
        for step in 1..=self.layout.steps {
            if self.reader.offset() > LONGEST {
                return;
            }
            if self.layout.polynomials && !self.read(&mut mid) || !self.read(&mut frame) {
                return;
            }
            self.step(step, &mid, &frame);
            std::mem::swap(&mut self.previous, &mut frame);
        }
        self.scan.longer = self.reader.has_more();
        if !self.scan.longer {
            self.scan.records = Some(self.reader.records());
        }
    }

    /// Reads a record; false at the end of what is sound: nobody is to blame for what is left of a damaged record.
    fn read(&mut self, frame: &mut LenientFrame) -> bool {
        match self.reader.next(frame) {
            Ok(()) if frame.note.is_some() => false,
            Ok(()) => {
                self.scan.padded += u64::from(!frame.plain);
                if self.scan.opening.len() < OPENING && self.opening_memory < OPENING_MEMORY {
                    let logged = Logged::from(&*frame);
                    self.opening_memory += logged.bytes();
                    self.scan.opening.push(logged);
                }
                true
            }
            Err(stop) => {
                if stop.cause == Unreadable::State {
                    self.scan.records = Some(self.reader.records());
                }
                false
            }
        }
    }

    /// Looks at one step, and keeps it if it is of use.
    fn step(&mut self, step: u32, mid: &LenientFrame, end: &LenientFrame) {
        let before = &self.previous.state;
        if !before.positions.iter().chain(&before.velocities).all(|value| value.is_finite()) {
            return;
        }
        let state = self.simulation.state_mut();
        state.positions.copy_from_slice(&before.positions);
        state.velocities.copy_from_slice(&before.velocities);
        self.simulation.set_steps_done(step - 1);
        if self.budget.step(&mut self.simulation, &mut self.capture).is_err() {
            return;
        }
        self.actual.end.clone_from_frame(end);
        if self.layout.polynomials {
            self.actual.mid.get_or_insert_default().clone_from_frame(mid);
        }
        let logs_nan = !self.actual.is_finite();
        if logs_nan && !self.logs_nan() {
            // What follows from NaN speaks neither for a mistake nor against one.
            return;
        }
        let difference = first_difference(&self.capture.records, &self.actual, &ROUND_OFF);
        let signature = self.signature(difference);
        let count = self.seen.entry((difference.is_some(), signature)).or_default();
        let number = *count;
        *count += 1;
        let wanted = if difference.is_some() {
            self.scan.wrong.len() < MOST_WRONG && (number < FIRST_ALIKE || number.is_multiple_of(ALIKE))
        } else {
            self.scan.right.len() < MOST_RIGHT && number < RIGHT_ALIKE
        };
        // The first wrong step is kept whatever it takes: without one there is nothing to explain.
        if !wanted || (self.memory > MEMORY && !self.scan.wrong.is_empty()) {
            return;
        }
        let context = difference.map_or(Context::default(), |_| Context { logs_nan, ..self.context() });
        let sample = Sample {
            step,
            before: before_of(&self.previous),
            records: self.actual.clone(),
            difference,
            context,
            signature,
        };
        self.memory += sample.bytes();
        if difference.is_some() { self.scan.wrong.push(sample) } else { self.scan.right.push(sample) }
    }

    /// Steps with the same number look alike: the same events in the reference, the same first difference.
    fn signature(&self, difference: Option<Difference>) -> u64 {
        let first = match difference {
            None => 0,
            Some(Difference::Polynomial(index)) => match self.capture.place(index) {
                Some((pair, pass, number)) => {
                    8 + u64::from(pass.index.min(2)) * 32
                        + u64::from(pair.kind.code().unsigned_abs()) * 8
                        + number as u64
                }
                None => 1,
            },
            Some(Difference::PolynomialCount) => 2,
            Some(Difference::MidState(_)) => 3,
            Some(Difference::Impulses) => 4,
            Some(Difference::EndState(_)) => 5,
            Some(Difference::MidLists) => 6,
        };
        let logged = self.actual.end.impulses.iter().fold(0, |bits, impulse| bits | 1 << impulse.kind.clamp(0, 3));
        u64::from(self.capture.events()) | first << 32 | logged << 48
    }

    fn context(&self) -> Context {
        let (expected, actual) = (&self.capture.records, &self.actual);
        Context {
            polynomials_kept: self.right_without(|records, previous| {
                let kept = previous.polynomials.len();
                let theirs = &mut records.polynomials;
                let begins = theirs.len() >= kept
                    && previous.polynomials.iter().zip(theirs.iter()).all(|(a, b)| same_polynomial(a, b, &ROUND_OFF));
                if begins && kept > 0 {
                    let start = theirs.ends[kept - 1];
                    theirs.coefficients.drain(..start);
                    theirs.ends.drain(..kept);
                    theirs.ends.iter_mut().for_each(|end| *end -= start);
                }
                begins
            }),
            impulses_kept: self.right_without(|records, previous| {
                let begins = records.impulses.starts_with(&previous.impulses);
                if begins {
                    records.impulses.drain(..previous.impulses.len());
                }
                begins
            }),
            logs_nan: false,
            single_precision: single(&actual.end.state)
                && !single(&expected.end.state)
                && first_difference(expected, actual, &SINGLE_PRECISION).is_none(),
        }
    }

    /// Whether contacts were found and resolved rightly though only NaN is logged in their place, so that just the
    /// logging is wrong.
    fn logs_nan(&self) -> bool {
        let without_lists = |records: &StepRecords| {
            let bare = |logged: &Logged| Logged { state: logged.state.clone(), ..Logged::default() };
            StepRecords { mid: records.mid.as_ref().map(bare), end: bare(&records.end) }
        };
        let (expected, actual) = (&self.capture.records, &self.actual);
        let has_lengths = |ours: &Logged, theirs: &Logged| {
            (ours.polynomials.len(), ours.impulses.len()) == (theirs.polynomials.len(), theirs.impulses.len())
        };
        let end = &actual.end;
        let is_meant = end.polynomials.coefficients.iter().all(|value| value.is_nan())
            || end.impulses.iter().all(|contact| contact.normal.x.is_nan() && contact.normal.y.is_nan());
        is_meant
            && self.capture.events() != 0
            && has_lengths(&expected.end, &actual.end)
            && first_difference(&without_lists(expected), &without_lists(actual), &ROUND_OFF).is_none()
    }

    /// Whether the step is right once `strip` has taken the lists of the step before off its records.
    fn right_without(&self, strip: impl Fn(&mut Logged, &LenientFrame) -> bool) -> bool {
        let mut records = self.actual.clone();
        let stripped = records.mid.as_mut().is_none_or(|mid| strip(mid, &self.previous))
            && strip(&mut records.end, &self.previous);
        stripped && first_difference(&self.capture.records, &records, &ROUND_OFF).is_none()
    }
}

impl Logged {
    fn clone_from_frame(&mut self, frame: &LenientFrame) {
        self.state.positions.clone_from(&frame.state.positions);
        self.state.velocities.clone_from(&frame.state.velocities);
        self.impulses.clone_from(&frame.impulses);
        self.polynomials.coefficients.clone_from(&frame.polynomials.coefficients);
        self.polynomials.ends.clone_from(&frame.polynomials.ends);
    }
}

impl Sample {
    fn bytes(&self) -> usize {
        let mid = self.records.mid.as_ref().map_or(0, Logged::bytes);
        16 * self.before.positions.len() + mid + self.records.end.bytes()
    }
}

fn before_of(frame: &LenientFrame) -> State {
    frame.state.clone()
}

/// Whether a first record belongs to another scene than the one with this initial state. Programs do not compute it, so
/// it differs by no more than the rounding to single precision.
fn is_foreign(initial: &State, first: &State) -> bool {
    let differs = |ours: &[f64], theirs: &[f64]| {
        let largest = ours.iter().fold(1.0_f64, |largest, value| largest.max(value.abs()));
        // What is no number comes from no scene.
        ours.iter().zip(theirs).any(|(o, t)| t.is_finite() && (o - t).abs() > FIRST_RECORD * largest)
    };
    differs(&initial.positions, &first.positions) || differs(&initial.velocities, &first.velocities)
}

/// Whether all numbers of a state are those of single precision.
fn single(state: &State) -> bool {
    #[expect(clippy::cast_possible_truncation, reason = "whether it loses anything is the question")]
    let exact = |value: &f64| f64::from(*value as f32).to_bits() == value.to_bits();
    state.positions.iter().chain(&state.velocities).all(exact)
}
