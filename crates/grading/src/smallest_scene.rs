//! Finds the smallest scene for each cause of wrong results. The program is run in the sandbox on smaller and smaller
//! scenes.
use super::{config::RunLimits, failure_cause::FailureKind, runner::Runner, task::SceneTask};
use fosssim_evidence::{KeptPart, examine};
pub use fosssim_findings::smallest_scene::SmallestScene;
use fosssim_judge::{Stop, kept_trace::MAX_KEPT_BYTES, replay::Options};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};
use fosssim_sandbox::{ProcessorTimeScope, RunEnd, processor_time};
use fosssim_shrink::{Observation, SmallScene, WrongReason, reduce, step_starts};
use std::{path::Path, time::Duration};

/// The maximum number of scenes that are tried for one cause. The smallest ones are tried first.
const MAX_SCENES: usize = 4;
/// The maximum number of bodies in a scene that is made smaller. Traces of larger scenes are too long to be kept as a
/// whole.
pub const MAX_BODIES: usize = 400;
/// The maximum number of scenes without a known cause for which a smallest scene is searched for.
const MAX_UNNAMED_CAUSES: usize = 2;

/// The limits on the search if smallest scenes are only one part of a report.
pub const QUICK_LIMITS: ShrinkLimits = ShrinkLimits { runs: 300, time: Duration::from_secs(2), step: None };

/// The limits of processor time and wall time for one run.
const RUN_TIME_LIMITS: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(2)];

/// Returns limits that allow only as much time as a program needs for a small scene. If the trace is complete when time
/// runs out, it is still read.
pub fn shorten_limits(limits: &RunLimits) -> RunLimits {
    RunLimits { cpu: limits.cpu.min(RUN_TIME_LIMITS[0]), wall: limits.wall.min(RUN_TIME_LIMITS[1]), ..*limits }
}

/// A function that describes a smallest scene for staff.
pub type DescribeSmallest<'a> = dyn Fn(&ShrunkScene) -> SmallestScene + Sync + 'a;

/// The limits on the search for one cause, and the step at which the search begins.
#[derive(Debug, Clone, Copy)]
pub struct ShrinkLimits {
    /// The maximum number of times that the program is run.
    pub runs: u32,
    /// The maximum processor time of these runs and of the searching thread.
    pub time: Duration,
    /// The wrong step at which the search begins. With `None`, the first wrong steps are tried.
    pub step: Option<u32>,
}

/// A cause, and the scenes on which the program is wrong because of it. The cause is `None` if it is known only after a
/// run.
pub type Cause<'a> = (Option<WrongReason>, Vec<&'a SceneTask>);

/// The smallest scene that was found for a cause.
#[derive(Debug, Clone)]
pub struct ShrunkScene {
    /// The reason why the program is wrong on the scene.
    pub reason: WrongReason,
    /// The name of the scene from which it was made.
    pub origin: String,
    /// The reduced scene.
    pub scene: SmallScene,
    /// The program's behavior on the smallest scene.
    pub observation: Observation,
    /// The number of times that the program was run.
    pub runs: u32,
}

/// A scene on which the program is wrong, and what is known about it.
#[derive(Debug, Clone, Copy)]
pub struct WrongScene<'a> {
    /// The scene that was run.
    pub task: &'a SceneTask,
    /// The explanations of the trace that the program wrote.
    pub explanations: &'a [Explanation],
    /// The result of the run.
    pub ended: &'a RunEnd,
}

/// Returns the causes of the wrong scenes: the likely mistakes, the ways in which the program failed, and for a few
/// scenes an unknown cause.
pub fn group_causes<'a>(likely: &[Explanation], wrong: &[WrongScene<'a>]) -> Vec<Cause<'a>> {
    let likely =
        likely.iter().filter(|explanation| explanation.is_about_program() || explanation.reports_non_finite_value());
    let likely = likely.map(|mistake| WrongReason::Mistake(mistake.clone().into()));
    let (mut all, mut left): (Vec<Cause<'a>>, Vec<&WrongScene<'a>>) = (Vec::new(), wrong.iter().collect());
    for reason in likely.chain(wrong.iter().filter_map(|wrong_scene| WrongReason::from_end(wrong_scene.ended))) {
        let is_of = |scene: &&WrongScene<'a>| match (&reason, WrongReason::from_end(scene.ended)) {
            (WrongReason::Mistake(mistake), None) => is_named_in(mistake, scene.explanations),
            (reason, end) => end.as_ref() == Some(reason),
        };
        left.retain(|scene| !is_of(scene));
        let scenes: Vec<&SceneTask> = wrong.iter().filter(is_of).map(|wrong_scene| wrong_scene.task).collect();
        if !scenes.is_empty() && all.iter().all(|(known, _)| known.as_ref() != Some(&reason)) {
            all.push((Some(reason), scenes));
        }
    }
    all.extend(left.iter().take(MAX_UNNAMED_CAUSES).map(|wrong_scene| (None, vec![wrong_scene.task])));
    all
}

/// Returns whether a scene shows only what those in `found` show: it has the content of one of them, or its
/// explanations name the cause of one.
pub fn is_repetition(small: &SmallestScene, found: &[SmallestScene]) -> bool {
    found.iter().any(|scene| {
        let cause = scene.explanations.first().filter(|cause| cause.is_about_program());
        scene.xml == small.xml || cause.is_some_and(|cause| is_named_in(cause, &small.explanations))
    })
}

/// Searches for smallest scenes, by running a program on smaller and smaller ones.
pub struct Shrinker<'a> {
    /// The runner that runs the program.
    pub runner: Runner<'a>,
    /// The path of the program.
    pub program: &'a Path,
    /// The milestone that determines the form of the scenes.
    pub assignment: Assignment,
    /// The limits on the search for one cause.
    pub limits: ShrinkLimits,
}

impl Shrinker<'_> {
    /// Returns the smallest scene for a cause; `None` if no smaller scene shows it.
    ///
    /// # Errors
    /// Fails if the grader or the machine fails. The error is the reason, as text.
    pub fn shrink_cause(&self, (reason, mut tasks): Cause<'_>) -> Result<Option<ShrunkScene>, String> {
        tasks.retain(|task| task.scene.particles.len() <= MAX_BODIES);
        tasks.sort_by_key(|task| (task.scene.particles.len(), task.scene.step_count()));
        let mut spent = Duration::ZERO;
        // Only the processor time of this thread counts, because other threads may be grading.
        let start = processor_time(ProcessorTimeScope::Thread);
        let is_over = |spent: Duration| {
            let own = processor_time(ProcessorTimeScope::Thread).saturating_sub(start);
            spent + own >= self.limits.time || self.runner.cancellation.is_canceled()
        };
        for task in tasks.into_iter().take(MAX_SCENES) {
            let observed = self.observe(&task.scene, &mut spent)?;
            let Some(reason) = reason.clone().or_else(|| WrongReason::first_reason(&task.scene, &observed)) else {
                continue;
            };
            let steps = self.limits.step.map_or_else(|| list_wrong_steps(&task.scene, &observed), |step| vec![step]);
            let (mut runs, mut fault, mut last_observation) = (0, Ok(()), None);
            let mut is_reproduced = |scene: &Scene, is_only_reason: bool| {
                if runs == self.limits.runs || is_over(spent) {
                    return None;
                }
                runs += 1;
                let observed = self.observe(scene, &mut spent).map_err(|error| fault = Err(error)).ok();
                let observed = observed.filter(|_| !self.runner.cancellation.is_canceled())?;
                let is_reproduced = reason.is_reproduced(scene, &observed, is_only_reason);
                last_observation = if is_reproduced { Some(observed) } else { last_observation.take() };
                Some(is_reproduced)
            };
            let small = reduce(&step_starts(&task.scene, &observed.trace, &steps), self.assignment, &mut is_reproduced);
            fault?;
            if let Some((small, observed)) = small.zip(last_observation) {
                return Ok(Some(ShrunkScene {
                    reason,
                    origin: task.name.clone(),
                    scene: small,
                    observation: observed,
                    runs,
                }));
            }
        }
        Ok(None)
    }

    /// Runs the program on a scene, and adds the time that it took to `spent`.
    fn observe(&self, scene: &Scene, spent: &mut Duration) -> Result<Observation, String> {
        let xml = scene::write(scene).into_bytes();
        let task = SceneTask { name: "smallest".to_owned(), xml, scene: scene.clone(), recording: None };
        let (trace, outcome) = self.runner.collect_trace(self.program, &task, MAX_KEPT_BYTES)?;
        *spent += outcome.cpu;
        Ok(Observation { trace, ended: outcome.ended })
    }
}

/// Returns the wrong steps of a run. If the program did not end normally, this is the step after its last record.
fn list_wrong_steps(scene: &Scene, observation: &Observation) -> Vec<u32> {
    let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
    let examined = examine(scene, &observation.trace[..], KeptPart::Nothing, &options, &mut ());
    let is_unreadable = matches!(examined.outcome.stop, Some(Stop::Trace { .. }));
    let ended = FailureKind::from_end(&observation.ended).is_some() || is_unreadable;
    let behind =
        (ended && examined.outcome.steps_judged < scene.step_count()).then_some(examined.outcome.steps_judged + 1);
    let wrong = examined.rulings.iter().zip(1..).filter(|(ruling, _)| ruling.wrong_by_fair && !ended);
    behind.into_iter().chain(wrong.map(|(_, step)| step)).collect()
}
