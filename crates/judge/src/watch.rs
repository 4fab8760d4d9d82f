//! The observer of a step that is compared with the trace's bytes.
use fosssim_model::{
    sim::{Detection, Impulse, Observer, Pass, Resume, State, Wanted},
    trace::{Layout, StepBytes},
};

/// The observer of a step: its records as bytes, and what its passes saw.
#[derive(Debug)]
pub(super) struct Watch {
    /// The records.
    pub(super) bytes: StepBytes,
    passes: Vec<SeenPass>,
    /// How many of these are the step's.
    seen: usize,
    /// Records of one step.
    pub(super) records_per_step: u64,
    /// Impulses, whether or not they are logged.
    pub(super) impulses: Vec<Impulse>,
}

/// What a pass saw.
#[derive(Debug, Clone)]
pub(super) struct SeenPass {
    /// Which pass it is.
    pub(super) pass: Pass,
    /// Positions at the start of the step, 2N.
    pub(super) q_start: Vec<f64>,
    /// Positions at its end as the pass began to see them, 2N.
    pub(super) q_end: Vec<f64>,
    /// Number of hits.
    pub(super) hits: usize,
}

impl Watch {
    /// Has seen no step yet.
    pub(super) fn new(layout: Layout) -> Self {
        let records_per_step = u64::from(layout.records_per_step());
        Self { bytes: StepBytes::new(layout), passes: Vec::new(), seen: 0, records_per_step, impulses: Vec::new() }
    }

    /// The step's passes.
    pub(super) fn passes(&self) -> &[SeenPass] {
        &self.passes[..self.seen]
    }
}

impl Observer for Watch {
    fn begin_step(&mut self, step: u32) {
        self.seen = 0;
        self.impulses.clear();
        self.bytes.begin_step(step);
    }

    fn begin_pass(&mut self, pass: Pass) {
        if self.seen == self.passes.len() {
            self.passes.push(SeenPass { pass, q_start: Vec::new(), q_end: Vec::new(), hits: 0 });
        }
        self.passes[self.seen].pass = pass;
        self.seen += 1;
        self.bytes.begin_pass(pass);
    }

    fn pass_positions(&mut self, q_start: &[f64], q_end: &[f64]) {
        if let Some(seen) = self.passes[..self.seen].last_mut() {
            q_start.clone_into(&mut seen.q_start);
            q_end.clone_into(&mut seen.q_end);
        }
    }

    #[inline]
    fn wanted(&mut self) -> Wanted<'_> {
        self.bytes.wanted()
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        self.bytes.detection(detection);
    }

    fn end_pass(&mut self, _: Pass, hits: usize) {
        if let Some(seen) = self.passes[..self.seen].last_mut() {
            seen.hits = hits;
        }
    }

    fn impulse(&mut self, impulse: &Impulse) {
        self.impulses.push(*impulse);
        self.bytes.impulse(impulse);
    }

    fn synchronise(&mut self, state: &mut State) -> Resume {
        self.bytes.synchronise(state)
    }

    fn end_step(&mut self, step: u32, state: &State) {
        self.bytes.end_step(step, state);
    }
}
