//! Limits the work of judging one trace.
//!
//! Steps are judged from the trace's own states, so a trace chooses what the reference has to compute. States from
//! which every round of impulses finds new collisions cost as many detection passes as the scene allows rounds. Such a
//! trace costs thousands of times as much as the scene's own run, and the fair rules repeat such steps. Subnormal
//! numbers slow processors down as well, and root searches and Newton's method may take many steps. The work is counted
//! ([`Simulation::work`]) instead of measured by a clock, so that the same bytes have the same verdict on every
//! machine.
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Observer, RootSearch, Simulation, StepError, min_work, pairs},
};

/// The work that is allowed for every trace, even if its scene is simple. It takes about a tenth of a second.
pub(crate) const MIN_WORK: u64 = 1_000_000;

/// The multiple of the work of the scene's own run that the original's rules may use, in addition to the work that is
/// allowed for every trace.
const PARITY_WORK_FACTOR: u64 = 10;
/// The multiple of the work of the scene's own run that the fair rules may use. They repeat a step at most 26 times;
/// the trace of a wrong program needs 11 repetitions.
const FAIR_WORK_FACTOR: u64 = 40;

/// The work that is left for one trace.
#[derive(Debug)]
pub struct Budget<'a> {
    scene: &'a Scene,
    factor: u64,
    remaining: u64,
    /// The work that is allowed before the work of the scene's own run is known.
    min_work: u64,
    is_extended: bool,
}

impl<'a> Budget<'a> {
    /// Creates the budget for judging a trace of `scene` by the original's rules, or by the fair rules if `fair`. Each
    /// rule book has a separate budget. Explaining and showing a trace have the same limit as the original's rules.
    pub fn new(scene: &'a Scene, fair: bool) -> Self {
        let factor = if fair { FAIR_WORK_FACTOR } else { PARITY_WORK_FACTOR };
        let at_least = min_scene_work(scene).saturating_mul(factor);
        Self { scene, factor, remaining: MIN_WORK.saturating_add(at_least), min_work: at_least, is_extended: false }
    }

    /// Returns the budget with `floor` as the work that is allowed before the work of the scene's own run is known.
    pub(crate) fn with_floor(self, floor: u64) -> Self {
        Self { remaining: floor, min_work: 0, ..self }
    }

    /// Returns the remaining work.
    pub fn remaining(&self) -> u64 {
        self.remaining
    }

    /// Subtracts `work` from the remaining work, and returns `false` if too little remains.
    pub fn spend(&mut self, work: u64) -> bool {
        if work > self.remaining {
            self.extend();
        }
        let rest = self.remaining.checked_sub(work);
        self.remaining = rest.unwrap_or(0);
        rest.is_some()
    }

    /// Simulates one more step from the trace's own state.
    ///
    /// # Errors
    /// Fails with a [`StepError`] of kind `Work` if no work remains.
    pub fn step(&mut self, simulation: &mut Simulation, observer: &mut dyn Observer) -> Result<(), StepError> {
        if self.remaining < (MIN_WORK.saturating_add(self.min_work)) / 2 {
            self.extend();
        }
        let begin = simulation.work();
        simulation.limit_work(begin.saturating_add(self.remaining));
        let result = simulation.step(observer);
        self.spend(simulation.work() - begin);
        result
    }

    /// Adds the work of the scene's own run, once, and returns whether it added anything.
    pub fn extend(&mut self) -> bool {
        if std::mem::replace(&mut self.is_extended, true) {
            return false;
        }
        let own = scene_work(self.scene).saturating_mul(self.factor).saturating_sub(self.min_work);
        self.remaining = self.remaining.saturating_add(own);
        own > 0
    }
}

/// Returns a lower bound for the work of the scene's own run. In each step, it counts one detection pass and one
/// iteration of Newton's method if the scene uses them. Nearly all traces stay below the allowed multiple of this
/// bound, so the scene need not be run.
fn min_scene_work(scene: &Scene) -> u64 {
    let pass = match scene.collision {
        Collision::ContinuousTime { .. } | Collision::Hybrid { .. } => pairs(scene).count() as u64,
        Collision::None | Collision::Penalty { .. } | Collision::Simple { .. } => 0,
    };
    u64::from(scene.step_count()).saturating_mul(pass.saturating_add(min_work(scene)))
}

/// Returns the work of the scene's own run.
fn scene_work(scene: &Scene) -> u64 {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    for _ in 0..scene.step_count() {
        if simulation.step(&mut ()).is_err() {
            break;
        }
    }
    simulation.work()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        options::Options,
        outcome::{Outcome, Stop},
        parity::Overall,
        replay::judge_with_memory,
        rules::{Book, Ruling},
        samples::{changed_reference_trace, encode_frames, scene, simulate},
    };

    /// Returns a scene in which a ball moves between two posts. Where the posts overlap the ball, each round of
    /// impulses throws it from one to the other.
    fn posts(start: f64, rounds: u32) -> Scene {
        let post = |x| format!(r#"<particle m="1" px="{x}" py="0" vx="0" vy="0" fixed="1" radius="0.2"/>"#);
        scene(&format!(
            r#"<scene><duration time="4"/><integrator type="explicit-euler" dt="0.1"/>
            <collision type="hybrid" COR="1" maxiters="{rounds}" k="0" thickness="0.01"/>
            <particle m="1" px="0" py="{start}" vx="1" vy="0" fixed="0" radius="0.2"/>{}{}</scene>"#,
            post(-0.25),
            post(0.25)
        ))
    }

    /// Returns a trace of `scene` in which every step except the first begins between the posts.
    fn squeezed(scene: &Scene) -> Vec<u8> {
        changed_reference_trace(scene, |frames| {
            for frame in &mut frames[1..] {
                frame.state.positions[..2].copy_from_slice(&[0.0, 0.0]);
                frame.state.velocities[..2].copy_from_slice(&[1.0, 0.0]);
            }
        })
    }

    fn judged(floor: u64, scene: &Scene, mut trace: &[u8], fair: bool, threads: usize) -> Outcome {
        let options = Options { uses_fair_rules: fair, threads, ..Options::default() };
        judge_with_memory(usize::MAX, Some(floor), scene, &mut trace, &options, &mut ())
    }

    /// Returns the step at which judging stopped because of its work, or `None` if it did not.
    fn given_up(outcome: &Outcome) -> Option<u32> {
        match outcome.stop {
            Some(Stop::Step(StepError::Work { step })) => Some(step),
            _ => None,
        }
    }

    fn is_given_up_in_the_second_step(fair: bool) {
        let scene = posts(100.0, 2_000_000_000);
        let trace = squeezed(&scene);
        let outcome = judged(MIN_WORK, &scene, &trace, fair, 1);
        assert_eq!((given_up(&outcome), outcome.parity.overall), (Some(2), Overall::None), "{:?}", outcome.stop);
        assert_eq!(outcome.steps_judged, 1);
    }

    #[test]
    fn a_step_without_end_is_given_up() {
        is_given_up_in_the_second_step(false);
    }

    #[test]
    fn a_step_without_end_is_given_up_by_the_fair_rules_too() {
        is_given_up_in_the_second_step(true);
    }

    #[test]
    fn the_end_of_judging_does_not_depend_on_threads() {
        let scene = posts(100.0, 2000);
        let trace = squeezed(&scene);
        let of_threads = |threads| {
            let outcome = judged(150_000, &scene, &trace, false, threads);
            (given_up(&outcome), outcome.parity.findings.wrong_steps)
        };
        let alone = of_threads(1);
        assert!(alone.0.expect("given up") > 2, "{alone:?}");
        assert_eq!([of_threads(2), of_threads(5)], [alone, alone]);
    }

    #[test]
    fn the_cost_of_fair_does_not_affect_parity() {
        let scene = posts(100.0, 2000);
        let trace = squeezed(&scene);
        let alone = judged(1_500_000, &scene, &trace, false, 1);
        assert_eq!((given_up(&alone), alone.parity.overall), (None, Overall::Failed));
        let mut ends = [1, 2, 5].map(|threads| {
            let outcome = judged(1_500_000, &scene, &trace, true, threads);
            assert_eq!(outcome.steps_judged, scene.step_count());
            assert_eq!(format!("{:?}", outcome.parity), format!("{:?}", alone.parity));
            assert_eq!(outcome.ruling(Book::Fair), Ruling::WrongAnswer, "by what it has seen");
            let fair = outcome.fair.expect("asked");
            (fair.first_unjudged_step.expect("given up"), format!("{fair:?}"))
        });
        assert!((3..scene.step_count()).contains(&ends[0].0), "step {}", ends[0].0);
        ends.sort();
        assert_eq!(ends[0], ends[2]);
    }

    /// Such a scene needs only elimination, and a second run would double the time of a grading.
    #[test]
    fn an_implicit_scene_is_not_run_to_allow_its_own_work() {
        let particles = (0..40).map(|x| format!(r#"<particle m="1" px="{x}" py="0" vx="0" vy="0" fixed="0"/>"#));
        let edges = (0..39).map(|edge| format!(r#"<edge i="{edge}" j="{}"/>"#, edge + 1));
        let springs = (0..39).map(|edge| format!(r#"<springforce edge="{edge}" k="9" l0="0.5"/>"#));
        let bodies: String = particles.chain(edges).chain(springs).collect();
        let scene = scene(&format!(
            r#"<scene><duration time="20"/><integrator type="implicit-euler" dt="0.1"/>{bodies}</scene>"#
        ));
        let own = scene_work(&scene);
        assert!(own > MIN_WORK, "{own}");
        let mut budget = Budget::new(&scene, false);
        assert!(budget.spend(own));
        assert!(!budget.is_extended);
    }

    #[test]
    fn the_work_of_the_scene_itself_is_always_allowed() {
        let scene = posts(0.0, 20_000);
        let trace = encode_frames(&scene, &simulate(&scene, ()));
        let floor = scene_work(&scene) / 2;
        for fair in [false, true] {
            let outcome = judged(floor, &scene, &trace, fair, 2);
            assert_eq!((given_up(&outcome), outcome.parity.overall), (None, Overall::Passed));
        }
    }
}
