//! Reads the trace step by step, has the steps judged in batches, and puts the results together in their order.
//!
//! Once a step's frames are in memory the step depends on nothing else: the reference starts from the submission's
//! own state (oracle-behaviour.md 4.2). So while one batch is judged, on all threads, the next one is read. What is
//! reported, and in which order, does not depend on the number of threads.
use super::{
    budget::{Budget, FLOOR},
    fair::{self, Context, Reach, Records, StepJudgement},
    outcome::{Damage, Outcome, Stop, Unreadable},
    parity::{Options, Progress, StepFindings, WrongStep},
    rules::Book,
    tally::{self, Buffers, StepResult, Tally},
};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{SearchCounts, Simulation, State, StepError},
    trace::{Cause, Layout, Lenient, LenientFrame, LoggedImpulse, record_memory},
};
use std::{
    io::Read,
    sync::{
        Mutex,
        atomic::{AtomicU64, AtomicUsize, Ordering},
    },
};

/// A batch is full when its frames hold this many bytes ...
const BATCH_BYTES: usize = 1 << 18;
/// ... but beside one that holds more than this, no other is read: one record is enough to have in memory then.
const LARGE_BATCH_BYTES: usize = 1 << 24;
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
    /// Byte offset of the end record.
    end_at: u64,
    damage: Option<Damage>,
    result: StepResult,
    fair: StepJudgement,
    /// Whether the fair rules have to know the reference's own run.
    is_extraordinary: bool,
    /// Whether they have to know it before they look at the step.
    is_put_off: bool,
    error: Option<StepError>,
    /// Whether more polynomials would have to be compared than were kept.
    beyond_limit: bool,
    /// Whether it was judged to its end.
    is_done: bool,
    /// What judging it took, in detection calls.
    work: u64,
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
    bytes: usize,
}

/// Judges a trace (the body of [`super::parity::judge`]).
pub(super) fn judge<R: Read + Send>(
    scene: &Scene,
    trace: R,
    options: &Options,
    progress: &mut dyn Progress,
) -> Outcome {
    judge_within((record_memory(scene), FLOOR), scene, trace, options, progress)
}

/// As [`judge`], with so much memory for the lists of a record, in bytes, and so much work for every trace.
pub(super) fn judge_within<R: Read + Send>(
    (memory, work): (usize, u64),
    scene: &Scene,
    trace: R,
    options: &Options,
    progress: &mut dyn Progress,
) -> Outcome {
    let mut replay = Replay::new(scene, Lenient::new(trace, Layout::of(scene)).with_limit(memory), options.fair);
    replay.budget = replay.budget.with_floor(work);
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
        let at_once = pool.is_some() && current.bytes <= LARGE_BATCH_BYTES;
        match &pool {
            None => judge_batch(&current, &mut workers[..1], &replay.shape, replay.budget.rest()),
            Some(pool) => {
                let (shape, rest) = (replay.shape, replay.budget.rest());
                let read_on = at_once && stop.is_none() && !replay.complete();
                let reader = &mut replay;
                pool.install(|| {
                    rayon::join(
                        || judge_batch(&current, &mut workers, &shape, rest),
                        || {
                            if read_on {
                                stop_after = reader.read_batch(&mut next);
                            }
                        },
                    );
                });
            }
        }
        if current.work() > replay.budget.rest() && replay.budget.widen() {
            judge_batch(&current, &mut workers, &replay.shape, replay.budget.rest());
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
        if !at_once {
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
    /// What leads nowhere by the fair rules, if they are asked.
    reach: Option<Reach<'a>>,
    /// What work is left.
    budget: Budget<'a>,
    /// Damage of the record that could not be read at last.
    damage: Option<Damage>,
    /// Whether a record of the steps delivered so far, or the first one, is damaged.
    damaged: bool,
    outcome: Outcome,
}

impl<'a, R: Read> Replay<'a, R> {
    fn new(scene: &'a Scene, reader: Lenient<R>, fair: bool) -> Self {
        let layout = Layout::of(scene);
        let logs_impulses = layout.impulses && !matches!(scene.collision, Collision::Hybrid { .. });
        Self {
            reader,
            shape: Shape { layout, logs_impulses, fair: fair.then(|| Context::new(scene)) },
            state: State::default(),
            state_at: 0,
            steps_read: 0,
            reach: fair.then(|| Reach::new(scene)),
            budget: Budget::new(scene, fair),
            damage: None,
            damaged: false,
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
        self.damaged = damage.is_some();
        self.damage = damage;
        if let (Ok(()), false, Some(context), Some(judgement)) =
            (&read, self.damaged, self.shape.fair, &mut self.outcome.fair)
        {
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
                    Cause::Limit => Unreadable::Limit,
                    Cause::Io => Unreadable::Io,
                };
                let (offset, message) = (stop.at.offset, stop.at.what.to_string());
                Err(Stop::Trace { frame: stop.at.frame, step, cause, offset, message })
            }
        }
    }

    /// Fills a batch. A stop is that of the first step that could not be read; the batch holds the steps before it.
    fn read_batch(&mut self, batch: &mut Batch) -> Option<Stop> {
        (batch.filled, batch.bytes) = (0, 0);
        while !self.complete() && batch.filled < BATCH_STEPS && batch.bytes < BATCH_BYTES {
            if batch.filled == batch.slots.len() {
                batch.slots.push(Mutex::default());
            }
            let slot = lock(&mut batch.slots[batch.filled]);
            if let Err(stop) = self.read_step(slot) {
                self.damage = slot.damage.take();
                return Some(stop);
            }
            batch.bytes += memory(&slot.end).max(memory(&slot.mid)) + self.shape.layout.state_bytes();
            batch.filled += 1;
        }
        None
    }

    fn read_step(&mut self, slot: &mut Slot) -> Result<(), Stop> {
        slot.step = self.steps_read + 1;
        slot.damage = None;
        slot.error = None;
        slot.beyond_limit = false;
        (slot.is_done, slot.work) = (false, 0);
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
        slot.end_at = self.state_at;
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
            self.damaged |= slot.damage.is_some();
            if outcome.damage.is_none() {
                outcome.damage = slot.damage.take();
            }
            if !self.budget.spend(slot.work) {
                slot.error = Some(StepError::Work { step: slot.step });
            }
            if let Some(error) = slot.error {
                outcome.stop = Some(Stop::Step(error));
                return true;
            }
            if slot.beyond_limit {
                outcome.stop = Some(beyond_limit(slot, self.shape.layout));
                return true;
            }
            tally::accumulate(&mut outcome.residuals, &slot.result.residuals);
            outcome.counts += slot.result.counts;
            // What is left of a damaged record counts for the original, but nobody is to blame for its numbers.
            if !self.damaged {
                slot.result.firsts.iter().for_each(|first| outcome.keep_first(first));
                if let (Some(judgement), Some(context), Some(reach)) =
                    (&mut outcome.fair, &self.shape.fair, &mut self.reach)
                {
                    if slot.is_extraordinary {
                        let frame = u64::from(slot.step) * u64::from(self.shape.layout.records_per_step());
                        let mid = self.shape.layout.polynomials.then_some(&slot.mid);
                        let (step, before, end) = (slot.step, &slot.before, &slot.end);
                        let records = Records { step, frame, before, mid, end };
                        let known = (!slot.is_put_off).then(|| std::mem::take(&mut slot.fair));
                        let identical = slot.result.identical;
                        let (mut judged, mut work) =
                            reach.judge(context, records, identical, known, self.budget.rest());
                        if work > self.budget.rest() && self.budget.widen() {
                            (judged, work) = reach.judge(context, records, identical, None, self.budget.rest());
                        }
                        if !self.budget.spend(work) {
                            outcome.stop = Some(Stop::Step(StepError::Work { step: slot.step }));
                            return true;
                        }
                        slot.fair = judged;
                    }
                    judgement.add(&slot.fair);
                }
            }
            outcome.steps_judged += 1;
            outcome.damaged_steps += u32::from(self.damaged);
            progress.step_judged(slot.step, &slot.result.remarks);
            if slot.result.counts.total() > 0 && !self.damaged {
                outcome.wrong_steps += 1;
            }
            let is_right = slot.result.firsts.is_empty() && slot.fair.findings.is_empty();
            if !is_right && !self.damaged {
                let parity = StepFindings { firsts: &slot.result.firsts, more: slot.result.more() };
                let fair = StepFindings { firsts: &slot.fair.findings, more: slot.fair.more };
                progress.step_wrong(&WrongStep { step: slot.step, parity, fair });
            }
            slot.mid.shrink();
            slot.end.shrink();
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

/// The stop at an end record that is as long as the reference's, and longer than what was kept.
fn beyond_limit(slot: &Slot, layout: Layout) -> Stop {
    let (logged, kept) = (slot.end.logged, slot.end.polynomials.len());
    Stop::Trace {
        frame: u64::from(slot.step) * u64::from(layout.records_per_step()),
        step: slot.step,
        cause: Unreadable::Limit,
        offset: slot.end_at,
        message: format!(
            "the record has {logged} polynomials, as many as it should have, but this program compares the first \
             {kept} of a record of this scene only"
        ),
    }
}

impl Batch {
    /// What judging it took so far.
    fn work(&mut self) -> u64 {
        self.slots[..self.filled].iter_mut().map(|slot| lock(slot).work).sum()
    }
}

/// What a record's lists take, in bytes.
fn memory(frame: &LenientFrame) -> usize {
    let LenientFrame { impulses, polynomials, .. } = frame;
    8 * polynomials.coefficients.len() + 8 * polynomials.ends.len() + size_of::<LoggedImpulse>() * impulses.len()
}

/// Judges the steps of a batch that are not done, each by the next free worker, until they take more work than is left.
///
/// Steps are begun in their order, and a step that is begun is done, or has alone taken more than is left. So the first
/// step that the budget does not reach is always among those that were begun, whatever the number of threads.
fn judge_batch(batch: &Batch, workers: &mut [Worker], shape: &Shape<'_>, rest: u64) {
    let slots = &batch.slots[..batch.filled];
    let (next, work) = (AtomicUsize::new(0), AtomicU64::new(0));
    let run = |worker: &mut Worker| {
        while work.load(Ordering::Relaxed) <= rest {
            let Some(slot) = slots.get(next.fetch_add(1, Ordering::Relaxed)) else { return };
            // Every index is handed out once, so the lock is always free.
            let mut slot = slot.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            if !slot.is_done {
                let begin = worker.simulation.work();
                worker.simulation.limit_work(begin.saturating_add(rest));
                judge_step(&mut slot, worker, shape);
                slot.work = worker.simulation.work() - begin;
                slot.is_done = slot.work <= rest;
            }
            work.fetch_add(slot.work, Ordering::Relaxed);
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
    let Slot {
        step, before, mid, end, result, fair: judged, is_extraordinary, is_put_off, error, beyond_limit, ..
    } = slot;
    let Worker { simulation, buffers } = worker;
    copy_state(simulation.state_mut(), before);
    simulation.set_steps_done(*step - 1);
    let layout = shape.layout;
    let frame = u64::from(*step) * u64::from(layout.records_per_step());
    let mid = layout.polynomials.then_some(&*mid);
    (*error, *beyond_limit) = (None, false);
    let mut tally = Tally::new((*step, frame), end, mid.map(|mid| &mid.state), shape.logs_impulses, buffers, result);
    match simulation.step(&mut tally) {
        Ok(()) => {
            *beyond_limit = layout.polynomials && tally.needs_more();
            tally.finish(simulation.state(), layout.impulses, layout.polynomials);
        }
        Err(cause) => *error = Some(cause),
    }
    if let (Some(context), None, false) = (&shape.fair, &error, *beyond_limit) {
        let records = Records { step: *step, frame, before, mid, end };
        *is_extraordinary = !records.states().all(|state| context.ordinary.holds(state));
        *is_put_off = *is_extraordinary && !records.start_ordinarily(context);
        if !*is_put_off {
            *judged = fair::judge(context, simulation, records, result.identical);
        }
    }
}

fn sum_of_searches(workers: &[Worker]) -> SearchCounts {
    let mut sum = SearchCounts::default();
    for counts in workers.iter().map(|worker| worker.simulation.search_counts()) {
        sum.calls += counts.calls;
        sum.searched += counts.searched;
        sum.excluded += counts.excluded;
        sum.disagreements += counts.disagreements;
        sum.fruitless += counts.fruitless;
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

#[cfg(test)]
#[path = "replay_tests.rs"]
mod tests;
