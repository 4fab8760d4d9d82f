//! The search for the smallest scene for each cause of a program's mistakes, which runs the program in the sandbox on
//! ever smaller scenes.
use super::{
    config::{Hints, RunLimits},
    execute::Runner,
    located::FailureKind,
    task::SceneTask,
};
use fosssim_evidence::{KeptPart, examine};
pub use fosssim_findings::smallest::SmallestScene;
use fosssim_judge::{Stop, kept::LONGEST, replay::Options};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};
use fosssim_sandbox::{RunEnd, TimeOf, processor_time};
use fosssim_shrink::{EndTest, Observation, Reducer, SmallScene, WrongReason, beginnings};
use std::{
    cell::{Cell, OnceCell},
    path::Path,
    time::Duration,
};

/// The maximum number of scenes that are tried for one cause, the smallest first.
const MAX_SCENES: usize = 4;
/// The maximum number of bodies of a scene that is reduced; traces of larger scenes are too long to be kept whole.
pub const MAX_BODIES: usize = 400;
/// The maximum number of causes without a name for which a scene is made.
const MAX_UNNAMED_CAUSES: usize = 2;

/// The limits for smallest scenes at the end of a report.
pub const QUICK_LIMITS: ShrinkLimits = ShrinkLimits { runs: 300, time: Duration::from_secs(2) };

/// The minimum time for a cause without a name; a quarter of the limit if that is more.
const UNNAMED_CAUSE_TIME: Duration = Duration::from_secs(5);

/// The limits of processor time and wall time of a run.
const RUN_TIME_LIMITS: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(2)];

/// Returns limits with no more time than a program needs on a small scene. A trace that is complete at the time limit
/// is still read.
#[must_use]
pub fn impatient(limits: &RunLimits) -> RunLimits {
    RunLimits { cpu: limits.cpu.min(RUN_TIME_LIMITS[0]), wall: limits.wall.min(RUN_TIME_LIMITS[1]), ..*limits }
}

/// A function that describes a smallest scene, with the hints for its students.
pub type DescribeSmallest<'a> = dyn Fn(&ShrunkScene, Hints) -> SmallestScene + Sync + 'a;

/// The limits of the work for one cause.
#[derive(Debug, Clone, Copy)]
pub struct ShrinkLimits {
    /// The maximum number of runs of the program.
    pub runs: u32,
    /// The maximum processor time of these runs and of this thread.
    pub time: Duration,
}

/// A cause, and the scenes on which a program is wrong because of it.
#[derive(Debug, Clone)]
pub struct WrongScenes<'a> {
    /// The cause, if it is known before a run is judged.
    pub reason: Option<WrongReason>,
    /// The scenes.
    pub scenes: Vec<&'a SceneTask>,
}

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
pub fn causes<'a>(likely: &[Explanation], wrong: &[WrongScene<'a>]) -> Vec<WrongScenes<'a>> {
    let mut left: Vec<WrongScene<'a>> = wrong.to_vec();
    let mut all = Vec::new();
    let mut take = |reason: Option<WrongReason>, is_of: &dyn Fn(&WrongScene<'a>) -> bool| {
        let scenes: Vec<_> = wrong.iter().filter(|one| is_of(one)).map(|one| one.task).collect();
        left.retain(|one| !is_of(one));
        if !scenes.is_empty() {
            all.push(WrongScenes { reason, scenes });
        }
    };
    for one in likely.iter().filter(|one| one.is_vote() || one.is_not_finite()) {
        let is_of = |wrong: &WrongScene<'_>| {
            FailureKind::from_end(wrong.ended).is_none()
                && match one.is_not_finite() {
                    true => wrong.explanations.iter().any(Explanation::is_not_finite),
                    false => is_named_in(one, wrong.explanations),
                }
        };
        let reason =
            if one.is_not_finite() { WrongReason::NotFinite } else { WrongReason::Mistake(one.clone().into()) };
        take(Some(reason), &is_of);
    }
    let mut ends: Vec<&RunEnd> = Vec::new();
    for one in wrong {
        if FailureKind::from_end(one.ended).is_some() && !ends.contains(&one.ended) {
            ends.push(one.ended);
        }
    }
    for end in ends {
        take(Some(WrongReason::Ended(end.clone())), &|wrong| wrong.ended == end);
    }
    all.extend(left.iter().take(MAX_UNNAMED_CAUSES).map(|one| WrongScenes { reason: None, scenes: vec![one.task] }));
    all
}

/// Runs a program on ever smaller scenes.
pub struct Shrinker<'a> {
    /// The runner of the program.
    pub runner: Runner<'a>,
    /// The path of the program.
    pub program: &'a Path,
    /// The milestone that decides the form of the scenes.
    pub assignment: Assignment,
    /// The limits of the work for one cause.
    pub limits: ShrinkLimits,
    /// The wrong step with which the search begins; `None` for the first ones.
    pub step: Option<u32>,
}

impl Shrinker<'_> {
    /// Returns the smallest scene for a cause; `None` if no part of a scene reproduces it.
    ///
    /// # Errors An error of the grader or the machine, as text.
    pub fn smallest(&self, cause: &WrongScenes<'_>) -> Result<Option<ShrunkScene>, String> {
        let mut tasks = cause.scenes.clone();
        tasks.retain(|task| task.scene.particles.len() <= MAX_BODIES);
        tasks.sort_by_key(|task| (task.scene.particles.len(), task.scene.steps()));
        let spent = Cell::new(Duration::ZERO);
        // Only this thread's time counts, because other threads may grade.
        let begun = processor_time(TimeOf::Thread);
        let time = || spent.get() + processor_time(TimeOf::Thread).saturating_sub(begun);
        for task in tasks.into_iter().take(MAX_SCENES) {
            if time() >= self.limits.time || self.runner.cancellation.is_cancelled() {
                break;
            }
            let seen = self.observe(&task.scene, &spent)?;
            let Some(reason) = cause.reason.clone().or_else(|| WrongReason::first(&task.scene, &seen)) else {
                continue;
            };
            let steps = self.step.map_or_else(|| wrong_steps(&task.scene, &seen), |step| vec![step]);
            let begin = beginnings(&task.scene, &seen.trace, &steps);
            let all = self.limits.time;
            let limit = if reason.is_unnamed() { all.min(UNNAMED_CAUSE_TIME.max(all / 4)) } else { all };
            let is_over = || time() >= limit || self.runner.cancellation.is_cancelled();
            // In the best case, the scene distinguishes the mistake from all others.
            let search = |leads| self.reduce((&reason, leads), begin.clone(), &spent, &is_over);
            let (mut found, mut held) = search(true)?;
            if found.is_none() {
                (found, held) = search(false)?;
            }
            let Some(small) = found else { continue };
            let seen = match self.runner.cancellation.is_cancelled() {
                // The time is used up, so the earlier result must suffice.
                true => held,
                false => Some(self.observe(&small.scene, &spent)?),
            };
            let Some(seen) = seen else { continue };
            // The result of a program that is not reproducible is dropped.
            if reason.holds(&small.scene, &seen) {
                return Ok(Some(ShrunkScene { reason, origin: task.name.clone(), small, seen }));
            }
        }
        Ok(None)
    }

    /// Reduces one of the scenes, and returns it with the program's run on it.
    fn reduce(
        &self,
        (reason, leads): (&WrongReason, bool),
        begin: Vec<(u32, Scene)>,
        spent: &Cell<Duration>,
        is_over: &EndTest<'_>,
    ) -> Result<(Option<SmallScene>, Option<Observation>), String> {
        let (fault, held) = (OnceCell::new(), Cell::new(None));
        let holds = |scene: &Scene| {
            if is_over() {
                return None;
            }
            let seen = self.observe(scene, spent).map_err(|words| fault.set(words)).ok()?;
            if self.runner.cancellation.is_cancelled() {
                return None;
            }
            let holds = if leads { reason.leads(scene, &seen) } else { reason.holds(scene, &seen) };
            if holds {
                held.set(Some(seen));
            }
            Some(holds)
        };
        let (assignment, most_runs) = (self.assignment, self.limits.runs);
        let found = Reducer { reason, assignment, holds: &holds, is_over, most_runs }.reduce(begin);
        fault.into_inner().map_or(Ok((found, held.into_inner())), Err)
    }

    /// Runs the program on a scene.
    fn observe(&self, scene: &Scene, spent: &Cell<Duration>) -> Result<Observation, String> {
        let xml = scene::write(scene).into_bytes();
        let task = SceneTask { name: "smallest".to_owned(), xml, scene: scene.clone(), recording: None };
        let (trace, outcome) = self.runner.collect(self.program, &task, LONGEST)?;
        spent.set(spent.get() + outcome.cpu);
        Ok(Observation { trace, ended: outcome.ended })
    }
}

/// Returns the wrong steps of a run; if the program did not end well, the step after its last record.
fn wrong_steps(scene: &Scene, seen: &Observation) -> Vec<u32> {
    let options = Options { threads: 1, fair: true, ..Options::default() };
    let examined = examine(scene, &seen.trace[..], KeptPart::Nothing, &options, &mut ());
    let is_unreadable = matches!(examined.outcome.stop, Some(Stop::Trace { .. }));
    let ended = FailureKind::from_end(&seen.ended).is_some() || is_unreadable;
    let behind = (ended && examined.outcome.steps_judged < scene.steps()).then_some(examined.outcome.steps_judged + 1);
    let wrong = examined.rulings.iter().zip(1..).filter(|(ruling, _)| ruling.wrong_by_fair && !ended);
    behind.into_iter().chain(wrong.map(|(_, step)| step)).collect()
}
