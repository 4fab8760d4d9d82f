//! Reads the trace step by step, has the steps judged in batches, and puts the results together in their order.
//!
//! Once a step's frames are in memory the step depends on nothing else: the reference starts from the submission's
//! own state (oracle-behaviour.md 4.2). So while one batch is judged, on all threads, the next one is read. What is
//! reported, and in which order, does not depend on the number of threads.
use super::{
    fair::{self, Context, Records, StepJudgement},
    outcome::{Damage, Outcome, Stop, Unreadable},
    parity::{Options, Progress},
    rules::Book,
    tally::{self, Buffers, StepResult, Tally},
};
use crate::{
    scene::{Collision, Scene},
    sim::{SearchCounts, Simulation, State, StepError},
    trace::{Cause, Layout, Lenient, LenientFrame, record_memory},
};
use std::{
    io::Read,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
};

/// A batch is full when its frames hold this many bytes ...
const BATCH_BYTES: usize = 1 << 18;
/// ... or this many steps.
const BATCH_STEPS: usize = 256;
/// More threads than this only cost memory: reading is sequential.
const MOST_THREADS: usize = 8;

/// One step as read, and what judging it yields.
#[derive(Debug, Default)]
struct Slot {
    step: u32,
    before: State,
    /// Byte offset of the record that `before` comes from.
    before_at: u64,
    /// The mid record; without its lists, unless the fair rules want them.
    mid: LenientFrame,
    end: LenientFrame,
    damage: Option<Damage>,
    result: StepResult,
    fair: StepJudgement,
    error: Option<StepError>,
}

/// What one thread needs to judge a step.
struct Worker {
    simulation: Simulation,
    buffers: Buffers,
}

/// Steps in a row; slots are reused from batch to batch.
#[derive(Default)]
struct Batch {
    slots: Vec<Mutex<Slot>>,
    filled: usize,
}

/// Judges a trace (the body of [`super::parity::judge`]).
pub(super) fn judge<R: Read + Send>(
    scene: &Scene,
    trace: R,
    options: &Options,
    progress: &mut dyn Progress,
) -> Outcome {
    let mut replay = Replay::new(scene, trace, options.fair);
    if let Err(stop) = replay.read_initial() {
        replay.outcome.damage = replay.damage.take();
        replay.outcome.stop = Some(stop);
        replay.outcome.conclude();
        return replay.outcome;
    }
    replay.outcome.damage = replay.damage.take();
    progress.begins();
    let (mut current, mut next) = (Batch::default(), Batch::default());
    let mut stop = replay.read_batch(&mut current);
    // A trace that fits into one batch is judged before threads have started, unless somebody asks for them.
    let is_short = stop.is_some() || replay.complete();
    let threads = match options.threads {
        0 if is_short => 1,
        0 => std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        given => given,
    }
    .min(MOST_THREADS);
    let mut workers: Vec<Worker> = (0..threads)
        .map(|_| Worker { simulation: Simulation::new(scene, options.root_search), buffers: Buffers::default() })
        .collect();
    let pool = (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()).flatten();
    loop {
        let mut stop_after = None;
        match &pool {
            None => judge_batch(&current, &mut workers[..1], &replay.shape),
            Some(pool) => {
                let shape = replay.shape;
                let read_on = stop.is_none() && !replay.complete();
                let reader = &mut replay;
                pool.install(|| {
                    rayon::join(
                        || judge_batch(&current, &mut workers, &shape),
                        || {
                            if read_on {
                                stop_after = reader.read_batch(&mut next);
                            }
                        },
                    );
                });
            }
        }
        if replay.deliver(&mut current, progress, options) {
            break;
        }
        if let Some(stop) = stop {
            if let Stop::Trace { step, .. } = stop {
                progress.step_begins(step);
            }
            replay.outcome.damage = replay.outcome.damage.take().or(replay.damage.take());
            replay.outcome.stop = Some(stop);
            break;
        }
        if replay.outcome.steps_judged == replay.outcome.steps {
            replay.outcome.trailing_bytes = replay.reader.has_more();
            break;
        }
        if pool.is_none() {
            stop_after = replay.read_batch(&mut next);
        }
        stop = stop_after;
        std::mem::swap(&mut current, &mut next);
    }
    replay.outcome.searches = sum_of_searches(&workers);
    replay.outcome.conclude();
    replay.outcome
}

/// Which parts of a step are compared.
#[derive(Debug, Clone, Copy)]
struct Shape<'a> {
    layout: Layout,
    logs_impulses: bool,
    /// Whether the fair rules are asked, too, and what they need.
    fair: Option<Context<'a>>,
}

/// The sequential side: the reader, the state that the next step starts from, and the outcome so far.
struct Replay<'a, R> {
    reader: Lenient<R>,
    shape: Shape<'a>,
    /// The end state of the last step that was read.
    state: State,
    /// Byte offset of its record.
    state_at: u64,
    steps_read: u32,
    /// Damage of the record that could not be read at last.
    damage: Option<Damage>,
    outcome: Outcome,
}

impl<'a, R: Read> Replay<'a, R> {
    fn new(scene: &'a Scene, trace: R, fair: bool) -> Self {
        let layout = Layout::of(scene);
        let logs_impulses = layout.impulses && !matches!(scene.collision, Collision::Hybrid { .. });
        Self {
            reader: Lenient::new(trace, layout).with_limit(record_memory(scene)),
            shape: Shape { layout, logs_impulses, fair: fair.then(|| Context::new(scene)) },
            state: State::default(),
            state_at: 0,
            steps_read: 0,
            damage: None,
            outcome: Outcome {
                fair: fair.then(Box::default),
                records_per_step: layout.records_per_step(),
                ..Outcome::empty(layout.steps)
            },
        }
    }

    fn complete(&self) -> bool {
        self.steps_read == self.outcome.steps
    }

    fn read_initial(&mut self) -> Result<(), Stop> {
        let mut frame = LenientFrame::default();
        let mut damage = None;
        let read = self.read_frame(&mut frame, 0, &mut damage);
        self.damage = damage;
        if let (Ok(()), Some(context), Some(judgement)) = (&read, self.shape.fair, &mut self.outcome.fair) {
            judgement.add_initial(&fair::judge_initial(&context, &frame));
        }
        self.state = frame.state;
        read
    }

    /// Reads one record; the first damage of a slot is kept.
    fn read_frame(&mut self, frame: &mut LenientFrame, step: u32, damage: &mut Option<Damage>) -> Result<(), Stop> {
        match self.reader.next(frame) {
            Ok(()) => {
                if let (None, Some(note)) = (&damage, frame.note.take()) {
                    let (offset, message) = (note.offset, note.what.to_string());
                    *damage = Some(Damage { frame: note.frame, step, offset, message });
                }
                Ok(())
            }
            Err(stop) => {
                let cause = match stop.cause {
                    Cause::State => Unreadable::State,
                    Cause::Impulses => Unreadable::Impulses,
                    Cause::Memory => Unreadable::Memory,
                    Cause::Io => Unreadable::Io,
                };
                let (offset, message) = (stop.at.offset, stop.at.what.to_string());
                Err(Stop::Trace { frame: stop.at.frame, step, cause, offset, message })
            }
        }
    }

    /// Fills a batch. A stop is that of the first step that could not be read; the batch holds the steps before it.
    fn read_batch(&mut self, batch: &mut Batch) -> Option<Stop> {
        batch.filled = 0;
        let mut bytes = 0;
        while !self.complete() && batch.filled < BATCH_STEPS && bytes < BATCH_BYTES {
            if batch.filled == batch.slots.len() {
                batch.slots.push(Mutex::default());
            }
            let slot = lock(&mut batch.slots[batch.filled]);
            if let Err(stop) = self.read_step(slot) {
                self.damage = slot.damage.take();
                return Some(stop);
            }
            bytes += 8 * slot.end.polynomials.coefficients.len() + self.shape.layout.state_bytes();
            batch.filled += 1;
        }
        None
    }

    fn read_step(&mut self, slot: &mut Slot) -> Result<(), Stop> {
        slot.step = self.steps_read + 1;
        slot.damage = None;
        slot.error = None;
        copy_state(&mut slot.before, &self.state);
        slot.before_at = self.state_at;
        let mut damage = None;
        let mut read = Ok(());
        if self.shape.layout.polynomials {
            if self.shape.fair.is_some() {
                read = self.read_frame(&mut slot.mid, slot.step, &mut damage);
            } else {
                // Parity never compares the mid record's lists; the end record's buffer serves for reading them.
                read = self.read_frame(&mut slot.end, slot.step, &mut damage);
                if read.is_ok() {
                    copy_state(&mut slot.mid.state, &slot.end.state);
                }
            }
        }
        if read.is_ok() {
            read = self.read_frame(&mut slot.end, slot.step, &mut damage);
        }
        slot.damage = damage;
        read?;
        copy_state(&mut self.state, &slot.end.state);
        self.state_at = self.reader.record_offset();
        self.steps_read += 1;
        Ok(())
    }

    /// Hands the batch's results on in the order of the steps. Whether judging is over.
    fn deliver(&mut self, batch: &mut Batch, progress: &mut dyn Progress, options: &Options) -> bool {
        for slot in &mut batch.slots[..batch.filled] {
            let slot = lock(slot);
            progress.step_begins(slot.step);
            let outcome = &mut self.outcome;
            if outcome.damage.is_none() && slot.error.is_some() {
                outcome.damage = not_finite(slot, self.shape.layout);
            }
            if outcome.damage.is_none() {
                outcome.damage = slot.damage.take();
            }
            if let Some(error) = slot.error {
                outcome.stop = Some(Stop::Step(error));
                return true;
            }
            tally::accumulate(&mut outcome.residuals, &slot.result.residuals);
            outcome.counts += slot.result.counts;
            for first in &slot.result.firsts {
                outcome.keep_first(first);
            }
            if let Some(judgement) = &mut outcome.fair {
                judgement.add(&slot.fair);
            }
            outcome.steps_judged += 1;
            progress.step_judged(slot.step, &slot.result.remarks);
            if slot.result.counts.total() > 0 {
                outcome.wrong_steps += 1;
            }
            let is_hopeless = match options.stop_by {
                Book::Fair if outcome.fair.is_some() => !slot.fair.findings.is_empty() || slot.fair.endless,
                Book::Parity | Book::Fair => slot.result.counts.total() > 0,
            };
            if is_hopeless && options.stop_at_first {
                return true;
            }
        }
        false
    }
}

/// The first number that is not finite in the state that a step starts from, with its place in the trace.
fn not_finite(slot: &Slot, layout: Layout) -> Option<Damage> {
    let State { positions, velocities } = &slot.before;
    let (index, value) = positions.iter().chain(velocities).enumerate().find(|(_, value)| !value.is_finite())?;
    let (prefix, place) = match index.checked_sub(positions.len()) {
        None => ("", index),
        Some(place) => ("velocity ", place),
    };
    let axis = if place.is_multiple_of(2) { 'x' } else { 'y' };
    let step = slot.step - 1;
    Some(Damage {
        frame: u64::from(step) * u64::from(layout.records_per_step()),
        step,
        offset: slot.before_at + 8 * index as u64,
        message: format!("{prefix}{axis} of particle {} is {value}", place / 2),
    })
}

/// Judges the steps of a batch, each by the next free worker.
fn judge_batch(batch: &Batch, workers: &mut [Worker], shape: &Shape<'_>) {
    let slots = &batch.slots[..batch.filled];
    let next = AtomicUsize::new(0);
    let run = |worker: &mut Worker| {
        while let Some(slot) = slots.get(next.fetch_add(1, Ordering::Relaxed)) {
            // Every index is handed out once, so the lock is always free.
            let mut slot = slot.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            judge_step(&mut slot, worker, shape);
        }
    };
    match workers {
        [worker] => run(worker),
        workers => rayon::scope(|scope| {
            let run = &run;
            for worker in workers {
                scope.spawn(move |_| run(worker));
            }
        }),
    }
}

fn judge_step(slot: &mut Slot, worker: &mut Worker, shape: &Shape<'_>) {
    let Slot { step, before, mid, end, result, fair: judged, error, .. } = slot;
    let Worker { simulation, buffers } = worker;
    copy_state(simulation.state_mut(), before);
    simulation.set_steps_done(*step - 1);
    let layout = shape.layout;
    let frame = u64::from(*step) * u64::from(layout.records_per_step());
    let mid = layout.polynomials.then_some(&*mid);
    let mut tally = Tally::new((*step, frame), end, mid.map(|mid| &mid.state), shape.logs_impulses, buffers, result);
    match simulation.step(&mut tally) {
        Ok(()) => tally.finish(simulation.state(), layout.impulses, layout.polynomials),
        Err(cause) => *error = Some(cause),
    }
    if let (Some(context), None) = (&shape.fair, &error) {
        let records = Records { step: *step, frame, before, mid, end };
        // Parity had a result; so it is what the trace logged that leads nowhere.
        *judged = fair::judge(context, simulation, records, result.identical).unwrap_or_else(|_| StepJudgement {
            step: *step,
            frame,
            endless: true,
            ..StepJudgement::default()
        });
    }
}

fn sum_of_searches(workers: &[Worker]) -> SearchCounts {
    let mut sum = SearchCounts::default();
    for counts in workers.iter().map(|worker| worker.simulation.search_counts()) {
        sum.calls += counts.calls;
        sum.searched += counts.searched;
        sum.excluded += counts.excluded;
        sum.disagreements += counts.disagreements;
    }
    sum
}

fn copy_state(target: &mut State, source: &State) {
    target.positions.clone_from(&source.positions);
    target.velocities.clone_from(&source.velocities);
}

fn lock(slot: &mut Mutex<Slot>) -> &mut Slot {
    slot.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner)
}
