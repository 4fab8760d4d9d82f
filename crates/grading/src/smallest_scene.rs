//! Finds the smallest scene for each cause of wrong results. The program is run in the sandbox on smaller and smaller
//! scenes.
use super::{config::RunLimits, failure_cause::FailureKind, runner::Runner, task::SceneTask};
use fosssim_evidence::{KeptPart, examine};
use fosssim_findings::explanation::Subject;
pub use fosssim_findings::smallest_scene::SmallestScene;
use fosssim_judge::{
    Book, FindingDetail, Stop,
    kept_trace::MAX_KEPT_BYTES,
    replay::{Options, judge},
};
use fosssim_mistakes::diagnose::{Explanation, ExplanationTopic, explain, is_named_in};
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
    /// The explanations of the trace that the program wrote for the smallest scene.
    pub explanations: Vec<Explanation>,
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

impl ShrunkScene {
    /// Returns the mistake for which the scene was made, or else the likeliest mistake that it shows. Returns `None` if
    /// that says nothing about the program.
    fn mistake(&self) -> Option<&Explanation> {
        let mistake = match &self.reason {
            WrongReason::Mistake(mistake) => Some(&**mistake),
            _ => self.explanations.first(),
        };
        mistake.filter(|mistake| mistake.is_about_program())
    }

    /// Returns whether the scene shows only what those in `found` show. It then is one of them, or nothing in it names
    /// its own mistake apart from theirs. If no known mistake explains the scene, its only difference may be that of
    /// one of them, or be about pairs for which their polynomials are wrong.
    fn is_repetition(&self, found: &[Self]) -> bool {
        if matches!(self.reason, WrongReason::Ended(..) | WrongReason::BrokenTrace) {
            return found.iter().any(|one| one.reason == self.reason);
        }
        let mistakes: Vec<&Explanation> = found.iter().filter_map(Self::mistake).collect();
        let is_named_before = |explanation: &Explanation| {
            mistakes.iter().any(|mistake| is_named_in(mistake, std::slice::from_ref(explanation)))
        };
        let (own, all) = (self.mistake(), &self.explanations);
        let others: Vec<Explanation> = all.iter().filter(|one| !is_named_before(one)).cloned().collect();
        let is_new = own.is_some_and(|own| is_named_in(own, &others));
        if own.is_some_and(is_named_before) || (others.len() < all.len() && !is_new) {
            return true;
        }
        let is_known = own.is_some_and(|own| own.topic == ExplanationTopic::Mistake);
        let only = self.only_finding().filter(|_| !is_known);
        let kind = only.filter(|_| own.is_none()).and_then(|only| only.pair()).map(|pair| pair.kind);
        let is_about = |subject: &Subject| kind == Some(subject.kind());
        mistakes.iter().any(|mistake| mistake.subjects().iter().any(is_about))
            || found.iter().any(|one| {
                one.scene.scene == self.scene.scene || only.is_some_and(|only| one.only_finding() == Some(only))
            })
    }

    /// Returns the only finding of the fair rules; `None` if there are several.
    fn only_finding(&self) -> Option<FindingDetail> {
        let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
        let outcome = judge(&self.scene.scene, &self.observation.trace[..], &options, &mut ());
        let findings = outcome.findings_by(Book::Fair);
        findings.first_divergence.as_ref().filter(|_| findings.counts.total() == 1).map(|finding| finding.detail)
    }
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
    /// Returns the smallest scene for each cause, without scenes that show only what earlier ones show. Calls `begin`
    /// before each search.
    ///
    /// # Errors
    /// Fails if the grader or the machine fails. The error is the reason, as text.
    pub fn shrink_causes(&self, causes: Vec<Cause<'_>>, begin: &dyn Fn()) -> Result<Vec<ShrunkScene>, String> {
        let mut found = Vec::new();
        for cause in causes {
            begin();
            found.extend(self.shrink_cause(cause)?.filter(|small| !small.is_repetition(&found)));
        }
        Ok(found)
    }

    /// Returns the smallest scene for a cause; `None` if no smaller scene shows it.
    fn shrink_cause(&self, (reason, mut tasks): Cause<'_>) -> Result<Option<ShrunkScene>, String> {
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
                    explanations: explain(&small.scene, &observed.trace),
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
        let xml = scene::to_xml(scene).into_bytes();
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

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_findings::FindingKind;
    use fosssim_student::{self as student, Student};

    /// Returns a scene that was made for the mistake `reason`, with a program that has the mistake `key`.
    fn shrunk(key: &str, reason: &str, xml: &str) -> ShrunkScene {
        let scene = scene::read("small.xml", xml.as_bytes()).expect("a scene").scene;
        let mistake = student::find(key).expect("a row").mistake;
        let trace = student::record_trace(&scene, Student::new(Some(mistake))).expect("a whole trace");
        ShrunkScene {
            reason: WrongReason::Mistake(Explanation::with_topic(reason, ExplanationTopic::Mistake).into()),
            origin: "a scene".to_owned(),
            explanations: explain(&scene, &trace),
            scene: SmallScene { scene, step: 1, is_minimal: true },
            observation: Observation { trace, ended: RunEnd::Exited(0) },
            runs: 1,
        }
    }

    fn two_bodies(x: &str) -> String {
        format!(
            r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="1"/>
            <collision type="continuous-time" COR="1"/>
            <particle px="0" py="0" vx="0" vy="0.5" m="1" fixed="0" radius="1"/>
            <particle px="{x}" py="0.5" vx="0" vy="0" m="1" fixed="0" radius="1"/></scene>"#
        )
    }

    /// An interval that is open at both ends cannot be distinguished from one that is open at its start if the impact
    /// is at the start.
    #[test]
    fn a_scene_that_shows_only_an_earlier_mistake_is_a_repetition() {
        let start = shrunk("decision-open-start", "decision-open-start", &two_bodies("0"));
        let interval = shrunk("decision-open-start", "decision-open-interval", &two_bodies("0.5"));
        assert!(!start.is_repetition(&[]) && interval.is_repetition(std::slice::from_ref(&start)));
        let other = shrunk("pp-radii-squared-apart", "pp-radii-squared-apart", &two_bodies("0.5"));
        assert!(!other.is_repetition(&[start]));
    }

    #[test]
    fn an_unexplained_scene_with_the_difference_of_an_earlier_one_is_a_repetition() {
        let earlier = shrunk("decision-open-start", "decision-open-start", &two_bodies("0"));
        let unexplained = |mut small: ShrunkScene| {
            (small.reason, small.explanations) = (WrongReason::Finding(FindingKind::Velocity, None), Vec::new());
            small
        };
        let same = unexplained(shrunk("decision-open-start", "decision-open-start", &two_bodies("0")));
        let other = unexplained(shrunk("pp-radii-squared-apart", "pp-radii-squared-apart", &two_bodies("0.5")));
        assert!(same.is_repetition(std::slice::from_ref(&earlier)) && !other.is_repetition(&[earlier]));
    }
}
