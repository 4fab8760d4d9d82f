//! The threads that judge the batches. The results do not depend on their number.
use super::{Batch, StepRules, StepSlot};
use crate::{
    fair::{self, Records},
    options::Options,
    tally::{Tally, TallyBuffers},
};
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation},
};
use std::{
    sync::atomic::{AtomicU64, AtomicUsize, Ordering},
    time::{Duration, Instant},
};

/// The maximum number of threads. Reading is sequential, so more threads would only cost memory.
const MAX_THREADS: usize = 8;
/// The time for which a trace is judged without other threads. Starting and ending them takes a tenth of it.
const TIME_WITHOUT_THREADS: Duration = Duration::from_millis(20);

/// The data that one thread needs to judge a step.
struct Worker {
    simulation: Simulation,
    buffers: TallyBuffers,
}

/// The threads that judge steps, and their data. They are started on demand.
pub(super) struct Workers<'a> {
    /// The time at which judging began. Browsers have no clock here, and no threads.
    begin: Option<Instant>,
    scene: &'a Scene,
    root_search: RootSearch,
    judges_individually: bool,
    /// The number of requested threads. The value 0 chooses a number by the number of cores.
    threads: usize,
    list: Vec<Worker>,
    pool: Option<rayon::ThreadPool>,
}

impl<'a> Workers<'a> {
    #[expect(clippy::disallowed_methods, reason = "no result depends on the number of threads")]
    pub(super) fn new(scene: &'a Scene, options: &Options) -> Self {
        let Options { threads, root_search, judges_individually: one_by_one, .. } = *options;
        Self {
            begin: (!cfg!(target_family = "wasm")).then(Instant::now),
            scene,
            root_search,
            judges_individually: one_by_one,
            threads: threads.min(MAX_THREADS),
            list: Vec::new(),
            pool: None,
        }
    }

    /// Returns whether judging began so recently that threads would not pay off. The result is also `true` without a
    /// clock.
    pub(super) fn began_shortly_ago(&self) -> bool {
        self.begin.is_none_or(|begin| begin.elapsed() < TIME_WITHOUT_THREADS)
    }

    /// Starts all threads, and returns whether there is more than one.
    pub(super) fn start_pool(&mut self) -> bool {
        let threads = match self.threads {
            0 => std::thread::available_parallelism().map_or(1, std::num::NonZero::get).min(MAX_THREADS),
            given => given,
        };
        self.grow_to(threads);
        if threads > 1 && self.pool.is_none() {
            self.pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok();
        }
        self.pool.is_some()
    }

    fn grow_to(&mut self, workers: usize) {
        let worker = || {
            let mut simulation = Simulation::new(self.scene, self.root_search);
            if self.judges_individually {
                simulation.disable_lanes();
            }
            Worker { simulation, buffers: TallyBuffers::new(self.scene) }
        };
        self.list.resize_with(workers.max(self.list.len()), worker);
    }

    /// Judges a batch while nothing is read. A short trace uses one thread, unless more are requested.
    pub(super) fn judge(&mut self, batch: &Batch, shape: &StepRules<'_>, rest: [u64; 2], is_short: bool) {
        if is_short && self.threads == 0 && self.pool.is_none() || !self.start_pool() {
            self.grow_to(1);
            judge_batch(batch, &mut self.list[..1], shape, rest);
        } else {
            self.judge_while(batch, shape, rest, || ());
        }
    }

    /// Judges a batch on all threads, and runs `other` at the same time.
    pub(super) fn judge_while(
        &mut self,
        batch: &Batch,
        shape: &StepRules<'_>,
        rest: [u64; 2],
        other: impl FnOnce() + Send,
    ) {
        let Some(pool) = &self.pool else { return };
        let workers = &mut self.list[..];
        pool.install(|| rayon::join(|| judge_batch(batch, workers, shape, rest), other));
    }
}

/// Judges the remaining steps of a batch, each with the next free worker. Each rule book stops when its remaining work
/// is used up. If the original's rules stop, the fair rules stop as well.
///
/// Steps are started in order. A started step is completed, or needs more than the remaining work by itself.
/// Therefore, with any number of threads, the first step beyond a budget is always among the started steps.
fn judge_batch(batch: &Batch, workers: &mut [Worker], shape: &StepRules<'_>, [rest, fair_rest]: [u64; 2]) {
    let slots = &batch.slots[..batch.filled];
    let (next, work, fair_work) = (AtomicUsize::new(0), AtomicU64::new(0), AtomicU64::new(0));
    let run = |worker: &mut Worker| {
        while work.load(Ordering::Relaxed) <= rest {
            // The used work is read before the step is taken, so that only earlier steps are counted.
            let has_budget = fair_work.load(Ordering::Relaxed) <= fair_rest;
            let Some(slot) = slots.get(next.fetch_add(1, Ordering::Relaxed)) else { return };
            // Every index is used once, so the lock is always free.
            let mut slot = slot.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            if !slot.is_judged {
                let begin = worker.simulation.work();
                worker.simulation.limit_work(begin.saturating_add(rest));
                judge_step(&mut slot, worker, shape);
                slot.work = worker.simulation.work() - begin;
                slot.is_judged = slot.work <= rest;
            }
            if has_budget && slot.is_judged && !slot.is_fairly_judged {
                let begin = worker.simulation.work();
                worker.simulation.limit_work(begin.saturating_add(fair_rest));
                judge_fairly(&mut slot, worker, shape);
                slot.fair_work = worker.simulation.work() - begin;
                slot.is_fairly_judged = slot.fair_work <= fair_rest;
            }
            work.fetch_add(slot.work, Ordering::Relaxed);
            fair_work.fetch_add(slot.fair_work, Ordering::Relaxed);
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

/// Judges a step by the original's rules.
fn judge_step(slot: &mut StepSlot, worker: &mut Worker, shape: &StepRules<'_>) {
    let step = slot.step;
    let StepSlot { before, order, mid, end, result, error, is_beyond_limit: beyond_limit, .. } = slot;
    let Worker { simulation, buffers } = worker;
    simulation.state_mut().clone_from(before);
    if let Some(pairs) = simulation.penalty_pairs() {
        pairs.set_order(order);
    }
    simulation.set_steps_done(step - 1);
    let layout = shape.layout;
    let frame = layout.end_record(step);
    let mid = layout.has_polynomials.then_some(&*mid);
    (*error, *beyond_limit) = (None, false);
    let mut tally = Tally::new((step, frame), end, mid, shape.logs_impulses, buffers, result);
    match simulation.step(&mut tally) {
        Ok(()) => {
            *beyond_limit = layout.has_polynomials && tally.has_equal_lists();
            tally.finish(simulation.state(), layout.has_impulses, layout.has_polynomials);
        }
        Err(cause) => *error = Some(cause),
    }
}

/// Judges a step that has a result by the fair rules.
fn judge_fairly(slot: &mut StepSlot, worker: &mut Worker, shape: &StepRules<'_>) {
    let StepSlot { step, before, mid, end, result, fair_judgment: judged, is_extraordinary, is_deferred, .. } = slot;
    if let (Some(context), None, false) = (&shape.fair, &slot.error, slot.is_beyond_limit) {
        let frame = shape.layout.end_record(*step);
        let mid = shape.layout.has_polynomials.then_some(&*mid);
        let records = Records { step: *step, frame, before, mid, end };
        *is_extraordinary = !records.states().all(|state| context.ordinary_range.contains(state));
        *is_deferred = *is_extraordinary && !records.starts_from_ordinary_states(context);
        if !*is_deferred {
            *judged = fair::judge_records(context, &mut worker.simulation, records, result.is_identical);
        }
    }
}
