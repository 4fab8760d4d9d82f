//! How far the reference's own run goes: which states of a trace lead nowhere.
//!
//! Steps are judged from the trace's own states, so a single wrong step can lead to where nothing is left to get wrong:
//! numbers that are none, that are so large that everything else is round-off, or that are all the same. Such steps
//! are never right, unless the reference itself gets there from the scene's start.
use super::{
    formulas::extent,
    step::{Context, Records, StepJudgement, judge},
};
use crate::finding::Detail;
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation, State},
};
use fosssim_num::{
    tolerances::FAIR_REACH,
    vector::{Vec2, at},
};

impl Range {
    /// What the scene's start tells.
    fn of(scene: &Scene) -> Self {
        let radii = scene.particles.iter().map(|particle| extent(particle.position) + particle.radius);
        let sizes = radii.chain(scene.half_planes.iter().map(|half_plane| extent(half_plane.point)));
        let position = Some(sizes.fold(0.0, f64::max)).filter(|size| *size > 0.0).unwrap_or(1.0);
        let fastest = scene.particles.iter().map(|particle| extent(particle.velocity)).fold(0.0, f64::max);
        let velocity = fastest.max(position / scene.time_step);
        let places = scene.particles.iter().map(|particle| particle.position);
        Self { position, velocity, spread: spread(places) }
    }
}

/// What a step's states are compared with at once; most need nothing else.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ordinary(Range);

impl Ordinary {
    /// What the scene's start leads one to expect.
    pub fn of(scene: &Scene) -> Self {
        Self(Range::of(scene))
    }

    /// Whether nothing in a state is out of the ordinary.
    pub fn holds(&self, state: &State) -> bool {
        beyond(&self.0, state).is_none()
    }
}

/// Compares states with the reference's own run, which is simulated as far as it is needed: for ordinary states not at all.
#[derive(Debug)]
pub(crate) struct Reach<'a> {
    scene: &'a Scene,
    range: Range,
    run: Option<Run>,
    /// Judges steps that are extraordinary for the reference, too.
    other: Option<Simulation>,
}

/// What the sizes of states lie between.
#[derive(Debug, Clone, Copy)]
struct Range {
    /// The largest position.
    position: f64,
    /// The largest velocity.
    velocity: f64,
    /// The least extent of all particles together.
    spread: f64,
}

/// The reference's own run so far.
#[derive(Debug)]
struct Run {
    simulation: Simulation,
    steps: u32,
    /// Whether it has no finite state any more.
    is_lost: bool,
}

impl<'a> Reach<'a> {
    /// Nothing but the scene is known.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, range: Range::of(scene), run: None, other: None }
    }

    /// Judges a step with a state that is out of the ordinary. `known` is its judgement, if it starts from ordinary states;
    /// else it is judged only if the reference gets there, too. Steps are asked about in their order. Besides the judgement
    /// it says how much work that took, which ends soon beyond `most_work`.
    pub fn judge(
        &mut self,
        context: &Context<'_>,
        records: Records<'_>,
        identical: bool,
        known: Option<StepJudgement>,
        most_work: u64,
    ) -> (StepJudgement, u64) {
        self.run_to(records.step);
        let is_lost = self.run.as_ref().is_some_and(|run| run.is_lost);
        let found = (!is_lost).then(|| self.beyond_reach(&records)).flatten();
        match (known, found) {
            (Some(judged), Some(detail)) if judged.total() == 0 => (judged.also(records, detail), 0),
            (Some(judged), _) => (judged, 0),
            (None, Some(detail)) => (StepJudgement::default().also(records, detail), 0),
            (None, None) => {
                let simulation = self.other.get_or_insert_with(|| Simulation::new(self.scene, RootSearch::WhereNeeded));
                let begin = simulation.work();
                simulation.limit_work(begin.saturating_add(most_work));
                let judged = judge(context, simulation, None, records, identical);
                (judged, simulation.work() - begin)
            }
        }
    }

    /// The first particle that is where the reference never comes near.
    fn beyond_reach(&self, records: &Records<'_>) -> Option<Detail> {
        records.states().find_map(|state| {
            let particle = beyond(&self.range, state)?;
            let (position, velocity) = (at(&state.positions, particle), at(&state.velocities, particle));
            Some(Detail::BeyondReach { particle, position: position.into(), velocity: velocity.into() })
        })
    }

    /// Follows the reference to the end of a step.
    fn run_to(&mut self, step: u32) {
        let run = self.run.get_or_insert_with(|| Run {
            simulation: Simulation::new(self.scene, RootSearch::WhereNeeded),
            steps: 0,
            is_lost: false,
        });
        while run.steps < step && !run.is_lost {
            run.steps += 1;
            let has_result = run.simulation.step(&mut ()).is_ok();
            let State { positions, velocities } = run.simulation.state();
            run.is_lost = !has_result || !positions.iter().chain(velocities).all(|value| value.is_finite());
            let largest = |vectors: &[f64]| (0..vectors.len() / 2).map(|p| extent(at(vectors, p))).fold(0.0, f64::max);
            self.range.position = self.range.position.max(largest(positions));
            self.range.velocity = self.range.velocity.max(largest(velocities));
            let places = (0..positions.len() / 2).map(|particle| at(positions, particle));
            self.range.spread = self.range.spread.min(spread(places));
        }
    }
}

/// The first particle whose state is beyond what the range allows.
fn beyond(range: &Range, state: &State) -> Option<usize> {
    let particles = state.positions.len() / 2;
    let is_far = |value: f64, most: f64| !(value <= FAIR_REACH * most);
    let far = (0..particles).find(|&particle| {
        is_far(extent(at(&state.positions, particle)), range.position)
            || is_far(extent(at(&state.velocities, particle)), range.velocity)
    });
    let places = || (0..particles).map(|particle| at(&state.positions, particle));
    far.or_else(|| (spread(places()) * FAIR_REACH < range.spread).then_some(0))
}

/// The extent of all points together; 0 of one point.
fn spread(points: impl Iterator<Item = Vec2>) -> f64 {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let [x, y] = points.fold([none; 2], |[x, y], point| [widened(x, point.x), widened(y, point.y)]);
    (x[1] - x[0]).max(y[1] - y[0]).max(0.0)
}

fn widened([low, high]: [f64; 2], value: f64) -> [f64; 2] {
    [low.min(value), high.max(value)]
}
