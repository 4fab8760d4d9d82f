//! Finds the smallest scene for each cause of wrong results, by running the program in the sandbox on smaller and
//! smaller scenes.
use super::{config::RunLimits, execute::Runner, located::FailureKind, task::SceneTask};
use fosssim_evidence::{KeptPart, examine};
pub use fosssim_findings::smallest::SmallestScene;
use fosssim_judge::{Stop, kept::MAX_KEPT_BYTES, replay::Options};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};
use fosssim_sandbox::{ProcessorTimeScope, RunEnd, processor_time};
use fosssim_shrink::{Observation, SmallScene, WrongReason, reduce, step_starts};
use std::{path::Path, time::Duration};

/// The maximum number of scenes that are tried for one cause, the smallest first.
const MAX_SCENES: usize = 4;
/// The maximum number of bodies of a scene that is reduced; traces of larger scenes are too long to be kept whole.
pub const MAX_BODIES: usize = 400;
/// The maximum number of causes without a name for which a scene is made.
const MAX_UNNAMED_CAUSES: usize = 2;

/// The limits for smallest scenes that are only one part of a report.
pub const QUICK_LIMITS: ShrinkLimits = ShrinkLimits { runs: 300, time: Duration::from_secs(2), step: None };

/// The limits of processor time and wall time of a run.
const RUN_TIME_LIMITS: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(2)];

/// Returns limits that allow only as much time as a program needs on a small scene. A trace that is complete at the
/// time limit is still read.
#[must_use]
pub fn shorten_limits(limits: &RunLimits) -> RunLimits {
    RunLimits { cpu: limits.cpu.min(RUN_TIME_LIMITS[0]), wall: limits.wall.min(RUN_TIME_LIMITS[1]), ..*limits }
}

/// Describes a smallest scene for staff.
pub type DescribeSmallest<'a> = dyn Fn(&ShrunkScene) -> SmallestScene + Sync + 'a;

/// The limits of the work for one cause, and the step at which the search begins.
#[derive(Debug, Clone, Copy)]
pub struct ShrinkLimits {
    /// The maximum number of runs of the program.
    pub runs: u32,
    /// The maximum processor time of these runs and of this thread.
    pub time: Duration,
    /// The wrong step with which the search begins; by default the first ones.
    pub step: Option<u32>,
}

/// A cause (`None` if it is known only after a run) and the scenes on which the program is wrong because of it.
pub type Cause<'a> = (Option<WrongReason>, Vec<&'a SceneTask>);

/// The smallest scene for a cause.
#[derive(Debug, Clone)]
pub struct ShrunkScene {
    /// The cause of the wrong result.
    pub reason: WrongReason,
    /// The name of the original scene.
    pub origin: String,
    /// The reduced scene.
    pub small: SmallScene,
    /// The program's run on the scene.
    pub seen: Observation,
    /// The number of runs of the program.
    pub runs: u32,
}

/// A program's run on a scene on which it is wrong.
#[derive(Debug, Clone, Copy)]
pub struct WrongScene<'a> {
    /// The scene.
    pub task: &'a SceneTask,
    /// The explanations of the program's trace.
    pub explanations: &'a [Explanation],
    /// The end of the program.
    pub ended: &'a RunEnd,
}

/// Returns the causes of wrong scenes: the likely mistakes, the kinds of failing ends, and a few unexplained scenes.
#[must_use]
pub fn group_causes<'a>(likely: &[Explanation], wrong: &[WrongScene<'a>]) -> Vec<Cause<'a>> {
    let likely =
        likely.iter().filter(|one| one.is_vote() || one.is_not_finite()).map(|one| match one.is_not_finite() {
            true => WrongReason::NotFinite,
            false => WrongReason::Mistake(one.clone().into()),
        });
    let (mut all, mut left): (Vec<Cause<'a>>, Vec<&WrongScene<'a>>) = (Vec::new(), wrong.iter().collect());
    for reason in likely.chain(wrong.iter().filter_map(|one| WrongReason::from_end(one.ended))) {
        let is_of = |one: &&WrongScene<'a>| match (&reason, WrongReason::from_end(one.ended)) {
            (WrongReason::Mistake(mistake), None) => is_named_in(mistake, one.explanations),
            (WrongReason::NotFinite, None) => one.explanations.iter().any(Explanation::is_not_finite),
            (reason, end) => end.as_ref() == Some(reason),
        };
        left.retain(|one| !is_of(one));
        let scenes: Vec<&SceneTask> = wrong.iter().filter(is_of).map(|one| one.task).collect();
        if !scenes.is_empty() && all.iter().all(|(known, _)| known.as_ref() != Some(&reason)) {
            all.push((Some(reason), scenes));
        }
    }
    all.extend(left.iter().take(MAX_UNNAMED_CAUSES).map(|one| (None, vec![one.task])));
    all
}

/// Runs a program on smaller and smaller scenes.
pub struct Shrinker<'a> {
    /// The runner of the program.
    pub runner: Runner<'a>,
    /// The path of the program.
    pub program: &'a Path,
    /// The milestone that decides the form of the scenes.
    pub assignment: Assignment,
    /// The limits of the work for one cause.
    pub limits: ShrinkLimits,
}

impl Shrinker<'_> {
    /// Returns the smallest scene for a cause; `None` if no part of a scene reproduces it.
    ///
    /// # Errors
    /// Fails if the grader or the machine fails, with the reason as text.
    pub fn shrink_cause(&self, (reason, mut tasks): Cause<'_>) -> Result<Option<ShrunkScene>, String> {
        tasks.retain(|task| task.scene.particles.len() <= MAX_BODIES);
        tasks.sort_by_key(|task| (task.scene.particles.len(), task.scene.step_count()));
        let mut spent = Duration::ZERO;
        // Only the time of this thread counts, because other threads may be grading.
        let begun = processor_time(ProcessorTimeScope::Thread);
        let is_over = |spent: Duration| {
            let own = processor_time(ProcessorTimeScope::Thread).saturating_sub(begun);
            spent + own >= self.limits.time || self.runner.cancellation.is_cancelled()
        };
        for task in tasks.into_iter().take(MAX_SCENES) {
            let seen = self.observe(&task.scene, &mut spent)?;
            let Some(reason) = reason.clone().or_else(|| WrongReason::first_reason(&task.scene, &seen)) else {
                continue;
            };
            let steps = self.limits.step.map_or_else(|| wrong_steps(&task.scene, &seen), |step| vec![step]);
            let (mut runs, mut fault, mut held) = (0, Ok(()), None);
            let mut holds = |scene: &Scene, is_alone: bool| {
                if runs == self.limits.runs || is_over(spent) {
                    return None;
                }
                runs += 1;
                let seen = self.observe(scene, &mut spent).map_err(|words| fault = Err(words)).ok();
                let seen = seen.filter(|_| !self.runner.cancellation.is_cancelled())?;
                let holds = reason.holds(scene, &seen, is_alone);
                held = if holds { Some(seen) } else { held.take() };
                Some(holds)
            };
            let small = reduce(&step_starts(&task.scene, &seen.trace, &steps), self.assignment, &mut holds);
            fault?;
            if let Some((small, seen)) = small.zip(held) {
                return Ok(Some(ShrunkScene { reason, origin: task.name.clone(), small, seen, runs }));
            }
        }
        Ok(None)
    }

    /// Runs the program on a scene.
    fn observe(&self, scene: &Scene, spent: &mut Duration) -> Result<Observation, String> {
        let xml = scene::write(scene).into_bytes();
        let task = SceneTask { name: "smallest".to_owned(), xml, scene: scene.clone(), recording: None };
        let (trace, outcome) = self.runner.collect(self.program, &task, MAX_KEPT_BYTES)?;
        *spent += outcome.cpu;
        Ok(Observation { trace, ended: outcome.ended })
    }
}

/// Returns the wrong steps of a run; if the program did not end well, the step after its last record.
fn wrong_steps(scene: &Scene, seen: &Observation) -> Vec<u32> {
    let options = Options { threads: 1, fair: true, ..Options::default() };
    let examined = examine(scene, &seen.trace[..], KeptPart::Nothing, &options, &mut ());
    let is_unreadable = matches!(examined.outcome.stop, Some(Stop::Trace { .. }));
    let ended = FailureKind::from_end(&seen.ended).is_some() || is_unreadable;
    let behind =
        (ended && examined.outcome.steps_judged < scene.step_count()).then_some(examined.outcome.steps_judged + 1);
    let wrong = examined.rulings.iter().zip(1..).filter(|(ruling, _)| ruling.wrong_by_fair && !ended);
    behind.into_iter().chain(wrong.map(|(_, step)| step)).collect()
}
