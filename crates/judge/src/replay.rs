//! Reads the trace step by step, judges the steps in batches, and combines the results in order.
//!
//! Judging a step needs only its frames, because the reference starts from the submission's own state
//! (oracle-behavior.md 4.2). The next batch is read while one is judged on all threads. The reports and their order do
//! not depend on the number of threads.
mod contest;
mod workers;

pub use super::{
    options::Options,
    progress::{ObserverPair, Progress, Remark, StepFindings, WrongStep},
};

use super::{
    budget::Budget,
    fair::{self, Context, ExtraordinarySteps, JudgmentBuilder, Records, StepJudgment},
    finding::FindingDetail,
    outcome::{Damage, Outcome, Stop},
    rules::Book,
    tally::{self, StepResult},
};
use contest::ContestOrder;
use fosssim_model::{
    assignments::ImpulseList,
    scene::Scene,
    sim::{RootSearch, Simulation, State, StepError, SweepOrder},
    trace::{
        Layout, LenientFrame, LenientReader, LoggedImpulse, ReadFailure, TraceError, TraceFormatError, record_memory,
    },
};
use std::{io::Read, sync::Mutex};
use workers::Workers;

/// The size of the frames, in bytes, at which a batch is full.
const BATCH_BYTES: usize = 1 << 18;
/// The size of a batch, in bytes, above which no second batch is read at the same time, so that only one large record
/// is in memory.
const LARGE_BATCH_BYTES: usize = 1 << 24;
/// The number of steps at which a batch is full.
const BATCH_STEPS: usize = 256;
/// The number of steps at which a batch is full if nothing is read while it is judged. The slots of larger batches
/// would take more time than the steps.
const SEQUENTIAL_BATCH_STEPS: usize = 16;

/// One step as read, and the result of judging it.
#[derive(Debug, Default)]
struct StepSlot {
    /// The step's number, from 1.
    step: u32,
    /// The offset of the step's end record.
    last_record: u64,
    before: State,
    /// The order of bodies with which the reference begins the step, in a contest.
    order: SweepOrder,
    /// The mid record. Its lists are left out unless the fair rules need them.
    mid: LenientFrame,
    end: LenientFrame,
    damage: Option<Damage>,
    result: StepResult,
    fair_judgment: StepJudgment,
    /// Whether the fair rules need the reference's own run.
    is_extraordinary: bool,
    /// Whether the reference's own run must be known before the step is judged.
    is_deferred: bool,
    error: Option<StepError>,
    /// Whether more polynomials must be compared than were kept.
    is_beyond_limit: bool,
    /// Whether the original's rules have judged the step completely.
    is_judged: bool,
    /// The work of judging the step by the original's rules, in detection calls.
    work: u64,
    /// Whether the fair rules have judged the step completely.
    is_fairly_judged: bool,
    /// The work of judging the step by the fair rules.
    fair_work: u64,
    /// The number of bytes read for the step.
    bytes: usize,
}

/// A batch of consecutive steps. Its slots are reused.
#[derive(Default)]
struct Batch {
    slots: Vec<Mutex<StepSlot>>,
    filled: usize,
    bytes: usize,
}

/// Judges a trace by both rule books, in lock step with the reference like the original. Each step starts from the
/// trace's own state, uses its mid record, and is compared with its end record (oracle-behavior.md 4 to 6). Memory does
/// not depend on the trace's length. After the last record, one byte is read to find out whether more follow.
pub fn judge<R: Read + Send>(scene: &Scene, mut trace: R, options: &Options, progress: &mut dyn Progress) -> Outcome {
    judge_with_memory(record_memory(scene), None, scene, &mut trace, options, progress)
}

/// Judges like [`judge`], with `memory` bytes for the lists of a record. If `floor` is given, it is the work that is
/// allowed for every trace.
///
/// This function is compiled only here, for every source of traces. Generic code would be compiled in the calling
/// crate, at that crate's optimization level.
pub(super) fn judge_with_memory(
    memory: usize,
    floor: Option<u64>,
    scene: &Scene,
    trace: &mut (dyn Read + Send),
    options: &Options,
    progress: &mut dyn Progress,
) -> Outcome {
    let reader = LenientReader::new(trace, Layout::for_scene(scene)).with_limit(memory);
    let mut replay = Replay::new(scene, reader, options.uses_fair_rules);
    if let Some(floor) = floor {
        replay.budgets = replay.budgets.map(|budget| budget.with_floor(floor));
    }
    if let (true, Some(context)) = (options.judges_individually, &mut replay.step_rules.fair) {
        context.computes_all_bounds = true;
    }
    replay.judge(options, progress)
}

/// The data that determine which parts of a step are compared.
#[derive(Debug, Clone, Copy)]
struct StepRules<'a> {
    layout: Layout,
    logs_impulses: bool,
    /// The data for the fair rules, as long as they judge.
    fair: Option<Context<'a>>,
}

/// The state of a replay that its steps change one after another: the reader, the end state of the step that was read
/// last, and the outcome so far.
struct Replay<'a, R> {
    scene: &'a Scene,
    reader: LenientReader<R>,
    step_rules: StepRules<'a>,
    /// The end state of the step that was read last.
    state: State,
    steps_read: u32,
    /// The check for states that have no meaningful continuation, if the fair rules judge.
    reach: Option<ExtraordinarySteps<'a>>,
    /// The remaining work of each rule book. The original's rules always judge. The work of one rule book is not
    /// subtracted from the other's.
    budgets: [Budget<'a>; 2],
    order: ContestOrder,
    /// The damage of the step that could not be read, if there is such a step.
    damage: Option<Damage>,
    /// Whether the first record, or a record of the delivered steps, is damaged.
    has_damage: bool,
    /// The judgment of the fair rules so far, if they judge.
    judging: Option<Box<JudgmentBuilder>>,
    outcome: Outcome,
}

impl<'a, R: Read + Send> Replay<'a, R> {
    /// Judges the trace from its beginning.
    fn judge(mut self, options: &Options, progress: &mut dyn Progress) -> Outcome {
        if let Err(stop) = self.read_initial() {
            self.outcome.stop = Some(stop);
            return self.conclude();
        }
        progress.observe_begin();
        let (mut current, mut next) = (Batch::default(), Batch::default());
        let mut workers = Workers::new(self.scene, options);
        let mut stop = self.read_batch(&mut current, SEQUENTIAL_BATCH_STEPS);
        loop {
            // A short trace is judged without other threads, unless they were requested.
            let is_last = stop.is_some() || self.is_complete();
            let is_short = is_last || workers.began_shortly_ago();
            let mut stop_after = None;
            let reads_meanwhile =
                !is_short && current.has_waiting_step() && current.bytes <= LARGE_BATCH_BYTES && workers.start_pool();
            if reads_meanwhile {
                let (shape, rest) = (self.step_rules, self.remaining_work());
                workers.judge_while(&current, &shape, rest, || stop_after = self.read_batch(&mut next, BATCH_STEPS));
            } else if current.has_waiting_step() {
                workers.judge(&current, &self.step_rules, self.remaining_work(), is_short);
            }
            let mut has_more = false;
            for (budget, work) in self.budgets.iter_mut().zip(current.work()) {
                has_more |= work > budget.remaining() && budget.extend();
            }
            if has_more && current.has_waiting_step() {
                workers.judge(&current, &self.step_rules, self.remaining_work(), is_short);
            }
            if self.deliver(&mut current, progress, options) {
                break;
            }
            if let Some(stop) = stop {
                if let Stop::Trace { step, .. } = stop {
                    progress.observe_step_begin(step);
                    self.compute_unreadable_step(step);
                }
                self.outcome.damage = self.outcome.damage.take().or(self.damage.take());
                self.outcome.stop = Some(stop);
                break;
            }
            if self.outcome.steps_judged == self.outcome.steps {
                self.outcome.trailing_bytes = self.reader.has_more();
                break;
            }
            if reads_meanwhile {
                stop = stop_after;
                std::mem::swap(&mut current, &mut next);
            } else {
                stop = self.read_batch(&mut current, SEQUENTIAL_BATCH_STEPS);
            }
        }
        self.conclude()
    }

    /// Computes a step with unreadable records. The original computes the step before it reads them, and may never
    /// finish.
    fn compute_unreadable_step(&mut self, step: u32) {
        let mut simulation = Simulation::new(self.scene, RootSearch::OnDemand);
        simulation.state_mut().clone_from(&self.state);
        simulation.set_steps_done(step - 1);
        let error = self.budgets[0].step(&mut simulation, &mut ()).err();
        self.outcome.parity.endless_step = self.outcome.parity.endless_step.or(error);
    }

    /// Returns the outcome with its verdicts.
    fn conclude(mut self) -> Outcome {
        self.outcome.fair = self.judging.take().map(|judging| Box::new(judging.conclude(&self.outcome)));
        self.outcome.conclude();
        self.outcome
    }

    fn new(scene: &'a Scene, reader: LenientReader<R>, fair: bool) -> Self {
        let layout = Layout::for_scene(scene);
        let logs_impulses = scene.collision.handling().records.impulses == ImpulseList::Responses;
        Self {
            scene,
            reader,
            step_rules: StepRules { layout, logs_impulses, fair: fair.then(|| Context::new(scene)) },
            state: State::default(),
            steps_read: 0,
            reach: fair.then(|| ExtraordinarySteps::new(scene)),
            budgets: [false, true].map(|fair| Budget::new(scene, fair)),
            order: ContestOrder::new(scene),
            damage: None,
            has_damage: false,
            judging: fair.then(Box::default),
            outcome: Outcome { collisions: scene.collision.kind(), ..Outcome::empty(layout.steps) },
        }
    }

    /// Returns the remaining work of each rule book.
    fn remaining_work(&self) -> [u64; 2] {
        [self.budgets[0].remaining(), self.budgets[1].remaining()]
    }

    fn is_complete(&self) -> bool {
        self.steps_read == self.outcome.steps
    }

    fn read_initial(&mut self) -> Result<(), Stop> {
        let mut frame = LenientFrame::default();
        let mut damage = None;
        self.read_frame(&mut frame, &mut damage)?;
        self.has_damage = damage.is_some();
        self.outcome.damage = damage;
        if let (false, Some(context), Some(judgment)) = (self.has_damage, self.step_rules.fair, &mut self.judging) {
            judgment.add_initial(&fair::judge_initial_record(&context, &frame));
        }
        self.state = frame.state;
        Ok(())
    }

    /// Reads one record, and keeps the first damage of a step.
    fn read_frame(&mut self, frame: &mut LenientFrame, damage: &mut Option<Damage>) -> Result<(), Stop> {
        match self.reader.next(frame) {
            Ok(()) => {
                *damage = damage.take().or(frame.note.take());
                Ok(())
            }
            Err(stop) => {
                let TraceError { frame, step, offset, what } = stop.error;
                Err(Stop::Trace { frame, step, cause: stop.cause, offset, what })
            }
        }
    }

    /// Fills a batch with at most `steps` steps. If a step is unreadable, returns the reason to stop; the batch
    /// contains the steps before it.
    fn read_batch(&mut self, batch: &mut Batch, steps: usize) -> Option<Stop> {
        (batch.filled, batch.bytes) = (0, 0);
        while !self.is_complete() && batch.filled < steps && batch.bytes < BATCH_BYTES {
            if batch.filled == batch.slots.len() {
                batch.slots.push(Mutex::default());
            }
            let slot = lock(&mut batch.slots[batch.filled]);
            if let Err(stop) = self.read_step(slot) {
                self.damage = slot.damage.take();
                return Some(stop);
            }
            batch.bytes += slot.bytes;
            batch.filled += 1;
        }
        None
    }

    fn read_step(&mut self, slot: &mut StepSlot) -> Result<(), Stop> {
        slot.step = self.steps_read + 1;
        slot.damage = None;
        slot.error = None;
        slot.is_beyond_limit = false;
        (slot.is_judged, slot.work) = (false, 0);
        (slot.is_fairly_judged, slot.fair_work) = (self.step_rules.fair.is_none(), 0);
        slot.before.clone_from(&self.state);
        slot.order.clone_from(self.order.follow(slot.step, &self.state, self.budgets[0].remaining()));
        let mut damage = None;
        let mut read = Ok(());
        if self.step_rules.layout.has_polynomials {
            if self.step_rules.fair.is_some() {
                read = self.read_frame(&mut slot.mid, &mut damage);
            } else {
                // Parity never compares the mid record's lists, so they are read into the end record's buffer.
                read = self.read_frame(&mut slot.end, &mut damage);
                if read.is_ok() {
                    slot.mid.state.clone_from(&slot.end.state);
                }
            }
        }
        if read.is_ok() {
            read = self.read_frame(&mut slot.end, &mut damage);
        }
        slot.damage = damage;
        read?;
        self.state.clone_from(&slot.end.state);
        slot.last_record = self.reader.record_offset();
        slot.bytes = frame_memory(&slot.end).max(frame_memory(&slot.mid)) + self.step_rules.layout.state_bytes();
        self.steps_read += 1;
        Ok(())
    }

    /// Delivers the batch's results in the order of the steps, and returns whether judging is over.
    fn deliver(&mut self, batch: &mut Batch, progress: &mut dyn Progress, options: &Options) -> bool {
        for slot in &mut batch.slots[..batch.filled] {
            let slot = lock(slot);
            progress.observe_step_begin(slot.step);
            if !self.budgets[0].spend(slot.work) {
                self.outcome.stop = Some(Stop::Step(StepError::Work { step: slot.step }));
                return true;
            }
            if slot.is_beyond_limit {
                self.outcome.stop = Some(stop_beyond_limit(slot, self.step_rules.layout));
                return true;
            }
            self.has_damage |= slot.damage.is_some();
            if self.outcome.damage.is_none() {
                self.outcome.damage = slot.damage.take();
            }
            let parity = &mut self.outcome.parity;
            parity.endless_step = parity.endless_step.or(slot.error);
            if parity.endless_step.is_some() {
                slot.result.clear();
            }
            tally::add_residuals(&mut parity.residuals, &slot.result.residuals);
            parity.findings.counts += slot.result.counts;
            // The rest of a damaged record counts for the original, but its numbers prove no mistake.
            if !self.has_damage {
                slot.result.first_findings.iter().for_each(|first| parity.findings.keep_first(first));
                self.deliver_fair(slot);
            }
            if self.outcome.parity.endless_step.is_some() && self.step_rules.fair.is_none() {
                return true;
            }
            let outcome = &mut self.outcome;
            outcome.steps_judged += 1;
            outcome.damaged_steps += u32::from(self.has_damage);
            progress.observe_step_end(slot.step, &slot.result.remarks);
            if slot.result.counts.total() > 0 && !self.has_damage {
                outcome.parity.findings.wrong_steps += 1;
            }
            let is_right = slot.result.first_findings.is_empty() && slot.fair_judgment.findings.is_empty();
            if !is_right && !self.has_damage {
                let parity = StepFindings {
                    first_findings: &slot.result.first_findings,
                    further_counts: slot.result.further_counts(),
                };
                let fair = StepFindings {
                    first_findings: &slot.fair_judgment.findings,
                    further_counts: slot.fair_judgment.further_counts,
                };
                progress.observe_wrong_step(&WrongStep { step: slot.step, parity, fair });
            }
            slot.mid.shrink();
            slot.end.shrink();
            let is_hopeless = match options.stopping_book {
                Book::Fair if self.judging.is_some() => !slot.fair_judgment.findings.is_empty(),
                Book::Parity | Book::Fair => slot.result.counts.total() > 0,
            };
            if is_hopeless && options.stop_at_first {
                return true;
            }
        }
        false
    }

    /// Adds the fair rules' findings about a step, until the fair rules stop.
    fn deliver_fair(&mut self, slot: &mut StepSlot) {
        let (Some(judging), Some(context), Some(reach)) = (&mut self.judging, &self.step_rules.fair, &mut self.reach)
        else {
            slot.fair_judgment = StepJudgment::default();
            return;
        };
        let step = slot.step;
        let budget = &mut self.budgets[1];
        let mut has_judged = budget.spend(slot.fair_work);
        let frame = self.step_rules.layout.end_record(step);
        let mid = self.step_rules.layout.has_polynomials.then_some(&slot.mid);
        let records = Records { step, frame, before: &slot.before, mid, end: &slot.end };
        if let Some(error) = slot.error {
            // If the reference's own run has no result either, the fair rules cannot judge the step.
            has_judged &= reach.advance_to(step);
            slot.fair_judgment = StepJudgment::default().with_finding(records, FindingDetail::NoResult { error });
        } else if has_judged && slot.is_extraordinary {
            let judgment = (!slot.is_deferred).then(|| std::mem::take(&mut slot.fair_judgment));
            let identical = slot.result.is_identical;
            let (mut step_judgment, mut work) = reach.judge(context, records, identical, judgment, budget.remaining());
            if work > budget.remaining() && budget.extend() {
                (step_judgment, work) = reach.judge(context, records, identical, None, budget.remaining());
            }
            has_judged = budget.spend(work);
            slot.fair_judgment = step_judgment;
        }
        if has_judged {
            judging.add(&slot.fair_judgment);
        } else {
            judging.stop_judging(step);
            self.step_rules.fair = None;
            slot.fair_judgment = StepJudgment::default();
        }
    }
}

/// Returns the reason to stop at an end record whose lists are as long as the reference's, but longer than the kept
/// part.
fn stop_beyond_limit(slot: &StepSlot, layout: Layout) -> Stop {
    let (logged, kept) = (slot.end.logged_polynomials, slot.end.polynomials.len());
    Stop::Trace {
        frame: layout.end_record(slot.step),
        step: slot.step,
        cause: ReadFailure::Limit,
        offset: slot.last_record,
        what: TraceFormatError::BeyondKept { logged, kept },
    }
}

impl Batch {
    /// Returns whether a step of the batch must still be judged.
    fn has_waiting_step(&mut self) -> bool {
        self.slots[..self.filled].iter_mut().map(lock).any(|slot| !slot.is_judged || !slot.is_fairly_judged)
    }

    /// Returns the work of judging the batch so far, by each rule book.
    fn work(&mut self) -> [u64; 2] {
        let slots = self.slots[..self.filled].iter_mut().map(lock);
        slots.fold([0, 0], |[parity, fair], slot| [parity + slot.work, fair + slot.fair_work])
    }
}

/// Returns the memory of a record's lists, in bytes.
fn frame_memory(frame: &LenientFrame) -> usize {
    let LenientFrame { impulses, polynomials, .. } = frame;
    8 * polynomials.coefficients.len()
        + 8 * polynomials.coefficient_ends.len()
        + size_of::<LoggedImpulse>() * impulses.len()
}

fn lock(slot: &mut Mutex<StepSlot>) -> &mut StepSlot {
    slot.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
