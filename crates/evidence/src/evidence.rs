//! Reads a judged trace again and simulates the reference next to it, to collect the evidence.
use crate::{
    inspected_step::{InspectedStep, Inspector, WantedCalls, continue_from},
    rulings::StepRuling,
    track::{Track, Window},
};
use fosssim_judge::{Finding, Outcome, budget::Budget};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Detection, Observer, Pair, Pass, ResumeState, RootSearch, Simulation, State, StepController},
    trace::{Layout, LenientFrame, LenientReader, record_memory},
};
use std::io::Read;

/// The maximum number of steps with details, and of numbers in their expected states. In large scenes, fewer steps are
/// kept.
const MAX_INSPECTED_STEPS: usize = 12;
const MAX_NUMBERS: usize = 40_000;

/// The distance of a coordinate, in scene units, above which a motion differs from the reference's.
const MOTION_TOLERANCE: f64 = 1e-10;

/// The class of a step in the strip over all steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepClass {
    /// The step is right, and it ends in the same state as the reference's own run.
    Right,
    /// The step itself is wrong.
    Wrong,
    /// The step is right, but starts from a state that an earlier wrong step has caused.
    Inherited,
    /// The step was not judged, or is in a damaged record, which proves nothing.
    Unknown,
}

impl StepClass {
    /// Returns the letter of the class in a strip.
    pub const fn letter(self) -> char {
        match self {
            Self::Right => 'r',
            Self::Wrong => 'w',
            Self::Inherited => 'i',
            Self::Unknown => 'u',
        }
    }
}

/// The measurements of one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The class of the step.
    pub class: StepClass,
    /// The largest difference of a position coordinate from the reference's, after a step from the trace's own state.
    /// The value is NaN if one of them is NaN.
    pub position: f64,
    /// The largest distance of velocities, measured in the same way.
    pub velocity: f64,
    /// The number of the reference's detection passes.
    pub expected_passes: u32,
    /// The number of detection passes according to the trace's number of polynomials, or `None` if that is not a whole
    /// number of passes.
    pub actual_passes: Option<u32>,
}

/// A step to show in detail, and possibly a pair in one pass, or in all passes in which it collides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Focus {
    /// The step, from 1.
    pub step: u32,
    /// The detection pass, if the fault is in one.
    pub pass: Option<Pass>,
    /// The pair, if the fault is about one.
    pub pair: Option<Pair>,
}

impl Focus {
    /// Returns the step, pass and pair of each finding of both rule books, beginning with the official book's.
    pub fn from_outcome(outcome: &Outcome) -> Vec<Self> {
        let books = outcome.fair.iter().map(|fair| &fair.findings).chain([&outcome.parity.findings]);
        books.flat_map(|book| book.first_divergence.iter().chain(&book.examples)).map(Self::from).collect()
    }
}

impl From<&Finding> for Focus {
    fn from(finding: &Finding) -> Self {
        Self { step: finding.step, pass: finding.detail.pass(), pair: finding.detail.pair() }
    }
}

/// The data that a viewer shows of one trace.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// The layout of the trace.
    pub layout: Layout,
    /// The range of records in the motions.
    pub window: Window,
    /// The reference's own motion from the scene's start.
    pub reference: Track,
    /// The trace's motion.
    pub submission: Track,
    /// The measurements of all steps that both the trace and the reference have.
    pub steps: Vec<Step>,
    /// The steps shown in detail, in order.
    pub inspected: Vec<InspectedStep>,
}

/// Reads a trace and returns its evidence. `rulings` are the judge's rulings in the order of the steps; `fair` selects
/// the rule book that decides; `focus` contains the steps and pairs of findings, the most important first.
///
/// If a trace cannot be read to its end, the evidence covers the readable part.
pub fn gather(
    scene: &Scene,
    trace: &mut dyn Read,
    rulings: &[StepRuling],
    fair: bool,
    focus: &[Focus],
    budget: usize,
) -> Evidence {
    let layout = Layout::for_scene(scene);
    let wrong = |ruling: &StepRuling| if fair { ruling.wrong_by_fair } else { ruling.wrong_by_parity };
    let first_wrong = (1..).zip(rulings).find(|(_, ruling)| wrong(ruling)).map(|(step, _)| step);
    let center = first_wrong.or(focus.first().map(|focus| focus.step)).unwrap_or(0);
    let detailed_steps = find_detailed_steps(focus, first_wrong, layout);
    let mut gathering = EvidenceBuilder::new(scene, Window::for_focus(center, layout, budget));
    let mut reader = LenientReader::new(trace, layout).with_limit(record_memory(scene));
    let (mut mid, mut end) = (LenientFrame::default(), LenientFrame::default());
    if reader.next(&mut end).is_err() {
        return gathering.evidence;
    }
    gathering.begin(&end.state);
    let (mut before, mut seen_wrong) = (end.state.clone(), false);
    for step in 1..=layout.steps {
        gathering.run_freely(step);
        if layout.has_polynomials && reader.next(&mut mid).is_err() || reader.next(&mut end).is_err() {
            break;
        }
        gathering.keep_states(step, &mid, &end);
        let wanted_calls = detailed_steps.contains(&step).then(|| find_wanted_calls(focus, step));
        let Some(count) = gathering.step(step, &before, (&mid, &end), wanted_calls.as_deref()) else { break };
        let ruling = rulings.get(step as usize - 1);
        let is_wrong = ruling.is_some_and(wrong);
        seen_wrong |= is_wrong;
        let class = match ruling {
            None => StepClass::Unknown,
            Some(ruling) if ruling.is_damaged => StepClass::Unknown,
            Some(_) if is_wrong => StepClass::Wrong,
            Some(_) if seen_wrong && gathering.differs_from_free_run(&end.state) => StepClass::Inherited,
            Some(_) => StepClass::Right,
        };
        gathering.keep_step(class, &count, &end);
        before.clone_from(&end.state);
        end.shrink();
        mid.shrink();
    }
    gathering.evidence
}

/// Returns the calls of a step that are shown in detail.
fn find_wanted_calls(focus: &[Focus], step: u32) -> Vec<(WantedCalls, Pair)> {
    let step_focus = focus.iter().filter(|focus| focus.step == step);
    step_focus
        .filter_map(|focus| Some((focus.pass.map_or(WantedCalls::Hits, WantedCalls::InPass), focus.pair?)))
        .collect()
}

/// The evidence so far, with the reference's own run and its steps from the trace's states.
struct EvidenceBuilder<'a> {
    scene: &'a Scene,
    /// The reference's own run.
    free_run: Simulation,
    continues_free_run: bool,
    /// The simulation of single steps from the trace's own states.
    step_run: Simulation,
    work: Budget<'a>,
    evidence: Evidence,
}

impl<'a> EvidenceBuilder<'a> {
    fn new(scene: &'a Scene, window: Window) -> Self {
        let simulation = || Simulation::new(scene, RootSearch::OnDemand);
        let evidence = Evidence {
            layout: Layout::for_scene(scene),
            window,
            reference: Track::default(),
            submission: Track::default(),
            steps: Vec::new(),
            inspected: Vec::new(),
        };
        let work = Budget::new(scene, false);
        Self { scene, free_run: simulation(), continues_free_run: true, step_run: simulation(), work, evidence }
    }

    fn begin(&mut self, first: &State) {
        if self.evidence.window.contains(0, false) {
            self.evidence.reference.push(self.free_run.state());
            self.evidence.submission.push(first);
        }
    }

    /// Returns whether a record of the step is kept.
    fn keeps_record(&self, step: u32, is_mid: bool) -> bool {
        (self.evidence.layout.has_polynomials || !is_mid) && self.evidence.window.contains(step, is_mid)
    }

    /// Advances the reference's own run by one step.
    fn run_freely(&mut self, step: u32) {
        let mut midway = MidState::default();
        self.continues_free_run = self.continues_free_run && self.free_run.step(&mut midway).is_ok();
        if self.continues_free_run {
            if let (Some(state), true) = (&midway.state, self.keeps_record(step, true)) {
                self.evidence.reference.push(state);
            }
            if self.keeps_record(step, false) {
                self.evidence.reference.push(self.free_run.state());
            }
        }
    }

    fn keep_states(&mut self, step: u32, mid: &LenientFrame, end: &LenientFrame) {
        for (frame, is_mid) in [(mid, true), (end, false)] {
            if self.keeps_record(step, is_mid) {
                self.evidence.submission.push(&frame.state);
            }
        }
    }

    /// Runs a step from the trace's own state, or returns `None` if the step has no result. With `wanted` the step is
    /// inspected in detail.
    fn step<'f>(
        &mut self,
        step: u32,
        before: &State,
        (mid, end): (&'f LenientFrame, &'f LenientFrame),
        wanted: Option<&[(WantedCalls, Pair)]>,
    ) -> Option<PassCount<'f>> {
        self.step_run.state_mut().clone_from(before);
        self.step_run.set_steps_done(step - 1);
        // The mid record of `continuous-time` equals the end record, so it is compared with the expected end of the
        // step.
        let mid_state = matches!(self.scene.collision, Collision::Hybrid { .. }).then_some(&mid.state);
        let mut count = PassCount { mid: mid_state, ..PassCount::default() };
        let Some(wanted) = wanted else {
            return self.work.step(&mut self.step_run, &mut count).is_ok().then_some(count);
        };
        let mut inspector =
            Inspector::new(self.scene, step, mid_state, (&end.polynomials, end.logged_polynomials), wanted);
        let is_complete = self.work.step(&mut self.step_run, &mut (&mut inspector, &mut count)).is_ok();
        let impulses = if end.impulses.is_empty() { &mid.impulses } else { &end.impulses };
        inspector.step.actual_contacts.clone_from(impulses);
        // The inspector must observe first: it keeps the expected mid record, and then makes the step continue with the
        // trace's.
        if let (Some(expected), Some(mid)) = (&inspector.step.expected_mid, mid_state) {
            count.deviations = measure_distances(expected, mid);
        }
        self.evidence.inspected.push(inspector.finish());
        is_complete.then_some(count)
    }

    /// Returns whether the state of the reference's own run differs from `end`.
    fn differs_from_free_run(&self, end: &State) -> bool {
        self.continues_free_run && max_distance(&self.free_run.state().positions, &end.positions) > MOTION_TOLERANCE
    }

    fn keep_step(&mut self, class: StepClass, count: &PassCount<'_>, end: &LenientFrame) {
        let [position, velocity] = measure_distances(self.step_run.state(), &end.state);
        self.evidence.steps.push(Step {
            class,
            position: max_with_nan(count.deviations[0], position),
            velocity: max_with_nan(count.deviations[1], velocity),
            expected_passes: count.passes,
            actual_passes: count.count_passes(end.logged_polynomials),
        });
    }
}

/// Returns the steps shown in detail: those of findings, and those around the first wrong step; if there are too many,
/// the most important ones.
fn find_detailed_steps(focus: &[Focus], first_wrong: Option<u32>, layout: Layout) -> Vec<u32> {
    let (steps, max_steps) =
        (layout.steps, (MAX_NUMBERS / (8 * layout.particles).max(1)).clamp(3, MAX_INSPECTED_STEPS));
    let near_steps = first_wrong.into_iter().flat_map(|step| [step, step.saturating_sub(1), step + 1]);
    let mut chosen_steps: Vec<u32> = Vec::new();
    for step in near_steps.chain(focus.iter().map(|focus| focus.step)) {
        if (1..=steps).contains(&step) && !chosen_steps.contains(&step) && chosen_steps.len() < max_steps {
            chosen_steps.push(step);
        }
    }
    chosen_steps
}

/// Returns the distances between two states, in positions and in velocities.
fn measure_distances(one: &State, other: &State) -> [f64; 2] {
    [max_distance(&one.positions, &other.positions), max_distance(&one.velocities, &other.velocities)]
}

/// Returns the largest distance between corresponding numbers of two lists; NaN if a number is NaN.
fn max_distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, max_with_nan)
}

/// Returns the larger number. A NaN counts as larger than any number.
fn max_with_nan(one: f64, other: f64) -> f64 {
    if one.is_nan() || other <= one { one } else { other }
}

/// An observer that keeps the state at the synchronization point.
#[derive(Default)]
struct MidState {
    state: Option<State>,
}

impl Observer for MidState {
    fn observe_synchronization(&mut self, state: &State) {
        self.state = Some(state.clone());
    }
}

/// An observer that counts passes and calls, and makes the step continue with the trace's mid record.
#[derive(Default)]
struct PassCount<'a> {
    mid: Option<&'a State>,
    passes: u32,
    polynomials: usize,
    /// The distances of the trace's mid record from the expected one, in positions and velocities.
    deviations: [f64; 2],
}

impl PassCount<'_> {
    /// Returns the number of passes that log `logged` polynomials. All passes of a step log the same number. Returns
    /// `None` if `logged` is not a whole number of passes.
    fn count_passes(&self, logged: usize) -> Option<u32> {
        let passes = self.passes as usize;
        if self.polynomials == 0 || passes == 0 {
            return (logged == 0).then_some(self.passes);
        }
        let per_pass = self.polynomials / passes;
        logged.is_multiple_of(per_pass).then(|| u32::try_from(logged / per_pass).unwrap_or(u32::MAX))
    }
}

impl Observer for PassCount<'_> {
    fn begin_pass(&mut self, _pass: Pass) {
        self.passes += 1;
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        self.polynomials += detection.polynomials.len();
    }

    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

impl StepController for PassCount<'_> {
    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        if let Some(mid) = self.mid {
            self.deviations = measure_distances(state, mid);
        }
        continue_from(self.mid, state)
    }
}
