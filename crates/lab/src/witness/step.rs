//! A step as its records tell it, beside what the reference makes of the same beginning. Shares nothing with the code
//! that explains: reads records by itself, and compares plainly.
use fosssim_model::{
    scene::Scene,
    sim::{Decision, Detection, Observer, Pair, Pass, RootSearch, Simulation, Stage, State, Steer, Time, Zone},
    trace::{Layout, Lenient, LenientFrame},
};
use fosssim_num::vector::{Vec2, at, length};

/// Numbers this close are the same: between round-off and what a mistake makes.
const SAME: f64 = 1e-10;

/// The events of the reference's step.
#[derive(Debug, Default, Clone)]
pub(super) struct Heard {
    /// Pass, pair, time, contact vector, index of the first polynomial.
    pub(super) hits: Vec<(usize, Pair, f64, Vec2, usize)>,
    /// The stages of its passes.
    pub(super) passes: Vec<Stage>,
    /// Pairs and the indices of their first polynomials.
    pub(super) pairs: Vec<(Pair, usize)>,
    pub(super) polynomials: Vec<Vec<f64>>,
    /// Round, particles, half-plane.
    pub(super) zones: Vec<(u32, Vec<usize>, bool)>,
    pub(super) middle: State,
    /// Polynomials by the middle of the step.
    pub(super) by_middle: usize,
    /// Misses everything.
    is_blind: bool,
}

impl Observer for Heard {
    fn begin_pass(&mut self, pass: Pass) {
        self.passes.push(pass.stage);
    }

    fn steers(&mut self) -> Option<&mut dyn Steer> {
        Some(self)
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        let first = self.polynomials.len();
        if let Decision::Hit { time, normal } = detection.decision {
            self.hits.push((self.passes.len() - 1, detection.pair, time, normal, first));
        }
        self.pairs.push((detection.pair, first));
        self.polynomials.extend(detection.polynomials.iter().map(|one| one.coefficients().to_vec()));
    }

    fn synchronised(&mut self, state: &State) {
        self.middle = state.clone();
        self.by_middle = self.polynomials.len();
    }

    fn failsafe(&mut self, round: u32, zone: &Zone<'_>) {
        self.zones.push((round, zone.particles.iter().map(|&one| one as usize).collect(), zone.half_plane));
    }
}

impl Steer for Heard {
    fn decide(&mut self, _pair: Pair, decision: Decision) -> Decision {
        if self.is_blind { Decision::Miss { time: Time::Found(f64::INFINITY) } } else { decision }
    }
}

/// One step.
pub(super) struct Step {
    pub(super) before: State,
    pub(super) middle: LenientFrame,
    pub(super) end: LenientFrame,
    pub(super) heard: Heard,
    /// The reference's end.
    pub(super) right: State,
    /// Where the integrator alone leads.
    pub(super) prediction: State,
}

/// The steps of a trace, up to the first that is no number, or has no result.
pub(super) fn steps(scene: &Scene, trace: &[u8]) -> Vec<Step> {
    let layout = Layout::of(scene);
    let mut reader = Lenient::of_slice(trace, layout);
    let mut frame = LenientFrame::default();
    let mut all: Vec<Step> = Vec::new();
    if !layout.polynomials || reader.next(&mut frame).is_err() {
        return all;
    }
    let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
    for number in 0..layout.steps {
        let before = all.last().map_or(&frame, |step| &step.end).state.clone();
        let (mut middle, mut end) = (LenientFrame::default(), LenientFrame::default());
        if reader.next(&mut middle).is_err() || reader.next(&mut end).is_err() || !is_sound(&before) {
            break;
        }
        let mut run = |is_blind: bool| {
            let mut heard = Heard { is_blind, ..Heard::default() };
            simulation.state_mut().clone_from(&before);
            simulation.set_steps_done(number);
            let done = simulation.step(&mut heard).is_ok();
            done.then(|| (heard, simulation.state().clone()))
        };
        let (Some((_, prediction)), Some((heard, right))) = (run(true), run(false)) else { break };
        all.push(Step { before, middle, end, heard, right, prediction });
    }
    all
}

fn is_sound(state: &State) -> bool {
    state.positions.iter().chain(&state.velocities).all(|value| value.is_finite())
}

/// Whether two vectors are the same.
pub(super) fn same(one: Vec2, two: Vec2) -> bool {
    length(one - two) <= SAME * (1.0 + length(one).max(length(two)))
}

/// Whether two polynomials are: the same values but for a positive factor. Small leading coefficients may be missing.
pub(super) fn same_list(ours: &[f64], theirs: &[f64]) -> bool {
    let size = ours.len().max(theirs.len());
    let padded = |list: &[f64]| [vec![0.0; size - list.len()], list.to_vec()].concat();
    let (ours, theirs) = (padded(ours), padded(theirs));
    let most = |list: &[f64]| list.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
    let scale = if most(&ours) > 0.0 { most(&theirs) / most(&ours) } else { 1.0 };
    let close = |scale: f64| {
        ours.iter().zip(&theirs).all(|(a, b)| (scale * a - b).abs() <= 1e-12 * scale.max(1.0) + 1e-9 * most(&theirs))
    };
    close(1.0) || close(scale)
}

impl Step {
    /// Polynomials of a pass.
    pub(super) fn size(&self) -> usize {
        self.heard.polynomials.len() / self.heard.passes.len().max(1)
    }

    /// How many of the first logged polynomials are the reference's.
    pub(super) fn right_lists(&self) -> usize {
        let pairs = self.heard.polynomials.iter().zip(self.end.polynomials.iter());
        pairs.take_while(|(ours, theirs)| same_list(ours, theirs)).count()
    }

    /// A pass that was logged, from 0.
    pub(super) fn logged(&self, pass: usize) -> Option<Vec<&[f64]>> {
        let (first, size) = (pass * self.size(), self.size());
        (first + size <= self.end.polynomials.len())
            .then(|| (first..first + size).map(|index| self.end.polynomials.get(index)).collect())
    }

    /// Whether two logged passes hold the same.
    pub(super) fn same_passes(&self, one: usize, two: usize) -> bool {
        let (Some(one), Some(two)) = (self.logged(one), self.logged(two)) else { return false };
        one.iter().zip(&two).all(|(one, two)| same_list(one, two))
    }

    /// Logged passes before the middle, and behind it.
    pub(super) fn passes(&self) -> (usize, usize) {
        let (middle, all) = (self.middle.polynomials.len(), self.end.polynomials.len());
        (middle / self.size().max(1), all.saturating_sub(middle) / self.size().max(1))
    }

    /// Passes of the reference before the middle, and behind it.
    pub(super) fn right_passes(&self) -> (usize, usize) {
        let behind = self.heard.passes.iter().filter(|stage| matches!(stage, Stage::Geometric { .. })).count();
        (self.heard.passes.len() - behind, behind)
    }

    pub(super) fn is_state(ours: &State, theirs: &State) -> bool {
        Self::are(&ours.positions, &theirs.positions) && Self::are(&ours.velocities, &theirs.velocities)
    }

    /// Whether all points of two lists are the same.
    pub(super) fn are(ours: &[f64], theirs: &[f64]) -> bool {
        (0..ours.len() / 2).all(|one| same(at(ours, one), at(theirs, one)))
    }

    /// Whether the middle is right: polynomials, their number, and the state.
    pub(super) fn has_right_middle(&self) -> bool {
        self.middle.polynomials.len() == self.heard.by_middle
            && self.right_lists() >= self.heard.by_middle
            && Self::is_state(&self.heard.middle, &self.middle.state)
    }

    pub(super) fn is_right(&self) -> bool {
        let count = self.heard.polynomials.len();
        self.has_right_middle()
            && self.end.polynomials.len() == count
            && self.right_lists() == count
            && Self::is_state(&self.right, &self.end.state)
    }
}
