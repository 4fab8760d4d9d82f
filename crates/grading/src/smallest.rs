//! The smallest scene for each cause of a program's mistakes: runs the program in the sandbox on ever smaller scenes.
use super::{
    config::{Hints, RunLimits},
    execute::Runner,
    located::FailureKind,
    task::SceneTask,
};
use fosssim_evidence::{KeptPart, examine};
pub use fosssim_findings::smallest::SmallestScene;
use fosssim_judge::{Stop, kept::MAX_KEPT_BYTES, replay::Options};
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

/// Scenes that are tried for one cause, the smallest first.
const MOST_SCENES: usize = 4;
/// Scenes with more bodies are not made smaller: their traces are too long to be kept whole.
pub const MOST_BODIES: usize = 400;
/// Causes without a name of which a scene is made.
const MOST_UNNAMED: usize = 2;

/// The limits where the smallest scenes are only the end of a report.
pub const QUICK: ShrinkLimits = ShrinkLimits { runs: 300, time: Duration::from_secs(2) };

/// The time for a cause that has no name, or a quarter of the limit if that is more.
const UNNAMED: Duration = Duration::from_secs(5);

/// The time on the processor and on the clock of a run.
const PATIENCE: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(2)];

/// Returns limits with no more time than a program needs on a small scene. A trace that is complete at its end is read
/// all the same.
#[must_use]
pub fn impatient(limits: &RunLimits) -> RunLimits {
    RunLimits { cpu: limits.cpu.min(PATIENCE[0]), wall: limits.wall.min(PATIENCE[1]), ..*limits }
}

/// Describes a smallest scene, with these hints for its students.
pub type DescribeSmallest<'a> = dyn Fn(&ShrunkScene, Hints) -> SmallestScene + Sync + 'a;

/// The most that may be spent on one cause.
#[derive(Debug, Clone, Copy)]
pub struct ShrinkLimits {
    /// Runs of the program.
    pub runs: u32,
    /// The processor time of these runs, and of this process meanwhile.
    pub time: Duration,
}

/// A cause, and the scenes on which a program is wrong because of it.
#[derive(Debug, Clone)]
pub struct WrongScenes<'a> {
    /// The reason, if it is known before a run is judged.
    pub reason: Option<WrongReason>,
    /// The scenes.
    pub scenes: Vec<&'a SceneTask>,
}

/// The smallest scene for a cause.
#[derive(Debug, Clone)]
pub struct ShrunkScene {
    /// The reason why the program is wrong on the scene.
    pub reason: WrongReason,
    /// The scene that it is made of.
    pub origin: String,
    /// The scene.
    pub small: SmallScene,
    /// The program's run on the scene.
    pub seen: Observation,
}

/// A program's run on a scene on which it is wrong.
#[derive(Debug, Clone, Copy)]
pub struct WrongScene<'a> {
    /// The scene.
    pub task: &'a SceneTask,
    /// The explanations of its trace.
    pub explanations: &'a [Explanation],
    /// The way the program ended.
    pub ended: &'a RunEnd,
}

/// Returns the causes of wrong scenes: the likely mistakes, the ways in which the program does not end well, and a few
/// of the scenes that nothing explains.
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
    all.extend(left.iter().take(MOST_UNNAMED).map(|one| WrongScenes { reason: None, scenes: vec![one.task] }));
    all
}

/// Runs a program on ever smaller scenes.
pub struct Shrinker<'a> {
    /// The way in which the program is run.
    pub runner: Runner<'a>,
    /// The program.
    pub program: &'a Path,
    /// The milestone whose programs' scenes are made.
    pub assignment: Assignment,
    /// The most that may be spent on one cause.
    pub limits: ShrinkLimits,
    /// The wrong step with which the search begins; by default the first ones.
    pub step: Option<u32>,
}

impl Shrinker<'_> {
    /// Returns the smallest scene for a cause; `None` if neither a step nor some steps show it again.
    ///
    /// # Errors
    /// Faults of ours or of the machine, in words.
    pub fn smallest(&self, cause: &WrongScenes<'_>) -> Result<Option<ShrunkScene>, String> {
        let mut tasks = cause.scenes.clone();
        tasks.retain(|task| task.scene.particles.len() <= MOST_BODIES);
        tasks.sort_by_key(|task| (task.scene.particles.len(), task.scene.steps()));
        let spent = Cell::new(Duration::ZERO);
        // Other threads may grade; their time does not count.
        let begun = processor_time(TimeOf::Thread);
        let time = || spent.get() + processor_time(TimeOf::Thread).saturating_sub(begun);
        for task in tasks.into_iter().take(MOST_SCENES) {
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
            let limit = if reason.is_unnamed() { all.min(UNNAMED.max(all / 4)) } else { all };
            let is_over = || time() >= limit || self.runner.cancellation.is_cancelled();
            // At best the scene alone distinguishes the mistake from all others.
            let search = |leads| self.reduce((&reason, leads), begin.clone(), &spent, &is_over);
            let (mut found, mut held) = search(true)?;
            if found.is_none() {
                (found, held) = search(false)?;
            }
            let Some(small) = found else { continue };
            let seen = match self.runner.cancellation.is_cancelled() {
                // No program runs any more: the earlier result must suffice.
                true => held,
                false => Some(self.observe(&small.scene, &spent)?),
            };
            let Some(seen) = seen else { continue };
            // A program that does another thing each time shows nothing.
            if reason.holds(&small.scene, &seen) {
                return Ok(Some(ShrunkScene { reason, origin: task.name.clone(), small, seen }));
            }
        }
        Ok(None)
    }

    /// Reduces one of these scenes, and returns it with the program's run on it.
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
        let (trace, outcome) = self.runner.collect(self.program, &task, MAX_KEPT_BYTES)?;
        spent.set(spent.get() + outcome.cpu);
        Ok(Observation { trace, ended: outcome.ended })
    }
}

/// Returns the steps of a run that are wrong; of a program that did not end well, the one behind its last record.
fn wrong_steps(scene: &Scene, seen: &Observation) -> Vec<u32> {
    let options = Options { threads: 1, fair: true, ..Options::default() };
    let examined = examine(scene, &seen.trace[..], KeptPart::Nothing, &options, &mut ());
    let is_unreadable = matches!(examined.outcome.stop, Some(Stop::Trace { .. }));
    let ended = FailureKind::from_end(&seen.ended).is_some() || is_unreadable;
    let behind = (ended && examined.outcome.steps_judged < scene.steps()).then_some(examined.outcome.steps_judged + 1);
    let wrong = examined.rulings.iter().zip(1..).filter(|(ruling, _)| ruling.wrong_by_fair && !ended);
    behind.into_iter().chain(wrong.map(|(_, step)| step)).collect()
}
