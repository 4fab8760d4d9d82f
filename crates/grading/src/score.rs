//! From the results of a submission's scenes to its grade: verdicts, points, and what several scenes say together.
use super::{
    config::{Credit, MOST_POINTS, Marking, Visibility},
    grade::{Grade, GroupGrade, SceneGrade},
    grader::{SubmissionGrading, lock},
    located::{Contents, Failing, Located, Tried, locate},
    one_file, patience,
    result::{Reason, SceneResult},
    verdict::Verdict,
};
use fosssim_findings::result::Ended;
use fosssim_mistakes::{
    diagnose::{self, Explanation},
    together::settle,
};
use fosssim_model::scene::Scene;

/// Shares a group's points evenly among its scenes and adds up what was reached. The results come with the word whether
/// they were taken from an earlier run.
///
/// With [`Credit::Steps`] a scene with a complete trace and a wrong answer gets the share of its steps without a
/// finding, never all; any other verdict but accepted gets nothing. With [`Credit::All`] every scene has to be
/// accepted. Scenes on which the grader failed, or which it did not come to run, have no points, nor has their group.
#[must_use]
pub fn group(name: &str, marking: Marking, results: Vec<(SceneResult, bool)>) -> GroupGrade {
    let each = worth(marking.points, results.len());
    let all_accepted = results.iter().all(|(result, _)| result.verdict.is_accepted());
    let scenes: Vec<SceneGrade> = results
        .into_iter()
        .map(|(result, cached)| {
            let points = share(marking.credit, &result, all_accepted).map(|share| each * share);
            let settled = result.explanations.clone();
            SceneGrade { result, points, max_points: each, cached, settled, agreed: 0 }
        })
        .collect();
    let points = sum(marking.points, all_accepted, &scenes);
    GroupGrade {
        name: name.to_owned(),
        visibility: marking.visibility,
        points,
        max_points: marking.points,
        verdict: scenes.iter().map(|scene| scene.verdict).max().unwrap_or(Verdict::NotRun),
        scenes,
    }
}

/// The worth of one scene in a group of this number of scenes.
#[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
fn worth(points: f64, scenes: usize) -> f64 {
    if scenes == 0 { 0.0 } else { points / scenes as f64 }
}

/// The points of a group. The full score is exact: sums of rounded shares would make 99.99999 of 100.
fn sum(points: f64, all_accepted: bool, scenes: &[SceneGrade]) -> Option<f64> {
    match all_accepted && !scenes.is_empty() {
        true => Some(points),
        false => scenes.iter().map(|scene| scene.points).sum(),
    }
}

/// The share of its points that a scene gets.
fn share(credit: Credit, result: &SceneResult, all_accepted: bool) -> Option<f64> {
    Some(match (credit, result.verdict) {
        (_, Verdict::NotRun | Verdict::JudgeError) => return None,
        (Credit::All, _) => f64::from(u8::from(all_accepted)),
        (_, Verdict::Accepted) => 1.0,
        // A trace can be wrong with all its steps right: in its first record, or by small errors that add up.
        (Credit::Steps, Verdict::WrongAnswer) => {
            let right = result.right_steps.min(result.steps.saturating_sub(1));
            f64::from(right) / f64::from(result.steps.max(1))
        }
        _ => 0.0,
    })
}

/// A contradiction in a grade: points, or a verdict, that do not follow from the verdicts of its scenes. A grade from
/// elsewhere is checked before its points are believed.
#[must_use]
pub fn contradiction(grade: &Grade) -> Option<&'static str> {
    let max_points: f64 = grade.groups.iter().map(|group| group.max_points).sum();
    let points: Option<f64> = grade.groups.iter().map(|group| group.points).sum();
    let verdict = grade.groups.iter().map(|group| group.verdict).max().unwrap_or(Verdict::NotRun);
    if !grade.groups.iter().all(|group| MOST_POINTS.contains(&group.max_points)) || grade.max_points != max_points {
        Some("the points that can be reached are none that a suite gives")
    } else if grade.points != points || !grade.groups.iter().all(follows) {
        Some("the points do not follow from the verdicts")
    } else if grade.verdict != verdict {
        Some("the verdict is not the worst of the scenes' verdicts")
    } else {
        None
    }
}

/// Whether a group's points and verdict are what some credit makes of its scenes' verdicts.
fn follows(group: &GroupGrade) -> bool {
    let all_accepted = group.scenes.iter().all(|scene| scene.verdict.is_accepted());
    let each = worth(group.max_points, group.scenes.len());
    let has_its_share = |credit, scene: &SceneGrade| {
        scene.max_points == each && scene.points == share(credit, &scene.result, all_accepted).map(|share| each * share)
    };
    let credits = [Credit::Scenes, Credit::Steps, Credit::All];
    credits.into_iter().any(|credit| group.scenes.iter().all(|scene| has_its_share(credit, scene)))
        && group.points == sum(group.max_points, all_accepted, &group.scenes)
        && group.verdict == group.scenes.iter().map(|scene| scene.verdict).max().unwrap_or(Verdict::NotRun)
}

/// The number of accepted scenes that are checked for evidence against a likely mistake.
const WITNESSES: usize = 12;

impl SubmissionGrading<'_> {
    /// The grade, of the results of all scenes in the plan's order, each with the word whether it was found. The
    /// submission's copy goes away now.
    pub(super) fn grade(&self, mut results: Vec<(SceneResult, bool)>) -> Grade {
        let (plan, options) = (self.grader.plan, self.grader.options);
        let build = match lock(&self.staged).take().as_deref() {
            Some(Ok(staged)) => staged.build.clone(),
            _ => None,
        };
        // What ran beside the scene that was the end does not count, or the number of jobs would.
        let known: Vec<_> = results
            .iter()
            .map(|(result, _)| Some((result.verdict, result.measured.wall + result.measured.judging)))
            .collect();
        if let Some((end, why)) = patience::end(&plan.patience, options.fail_fast, &known) {
            for (result, scene) in results.iter_mut().zip(plan.scenes()).skip(end) {
                *result = (patience::left_out(scene, why), false);
            }
        }
        let wall = results.iter().map(|(result, _)| result.measured.wall).sum();
        let mut results = results.into_iter();
        let groups: Vec<_> = plan
            .groups
            .iter()
            .map(|planned| group(&planned.name, planned.marking, results.by_ref().take(planned.scenes.len()).collect()))
            .collect();
        let refuted = self.refuted(&groups);
        let mut warnings = self.grader.backend.weaknesses();
        if self.submission.file.as_ref().is_some_and(|file| file.is_shared && !file.is_anothers) {
            warnings.push(one_file::SHARED.to_owned());
        }
        let active = self.grader.backend.layers().iter().filter(|report| report.active);
        let mut grade = Grade {
            submission: self.submission.name.clone(),
            suite: plan.name.clone(),
            rules: self.grader.effective_rules(),
            verdict: groups.iter().map(|group| group.verdict).max().unwrap_or(Verdict::NotRun),
            points: groups.iter().map(|group| group.points).sum(),
            max_points: plan.max_points(),
            shows_output: plan.show_output || groups.iter().all(|group| group.visibility == Visibility::Visible),
            groups,
            build,
            warnings,
            layers: active.map(|report| report.layer.name().to_owned()).collect(),
            wall,
            refuted,
            located: None,
        };
        if plan.hints.explains() {
            grade.located = common(&grade, || self.shared.contents(plan));
        }
        settle(&mut grade);
        grade
    }

    /// Likely mistakes that accepted scenes speak against; the smallest of these are asked.
    fn refuted(&self, groups: &[GroupGrade]) -> Vec<String> {
        let graded = || groups.iter().flat_map(|group| &group.scenes).zip(self.grader.plan.scenes());
        let wrong: Vec<&[Explanation]> = graded()
            .map(|(graded, _)| graded.explanations.as_slice())
            .filter(|explanations| !explanations.is_empty())
            .collect();
        if wrong.len() < 2 {
            return Vec::new();
        }
        let mut right: Vec<&Scene> = graded()
            .filter(|(graded, _)| graded.verdict == Verdict::Accepted && graded.differs.is_none())
            .map(|(_, task)| &task.scene)
            .collect();
        right.sort_by_key(|scene| u64::from(scene.steps()) * (scene.particles.len() * scene.particles.len()) as u64);
        right.truncate(WITNESSES);
        diagnose::refuted(&wrong, &right)
    }
}

/// The contents that the failing scenes have in common. `contents` are those of all scenes in their order, computed
/// only where some fail and some do not.
fn common<'a>(grade: &Grade, contents: impl FnOnce() -> &'a [Contents]) -> Option<Located> {
    let failing = |ended: &Option<Ended>| ended.as_ref().and_then(Failing::of);
    let was_run = |reason: &Reason| !matches!(reason, Reason::LeftOut(_) | Reason::Stopped | Reason::Failed(_));
    let run = || grade.scenes().filter(|scene| was_run(&scene.reason) && scene.ended.is_some());
    let failed = run().filter(|scene| failing(&scene.ended).is_some()).count();
    if failed == 0 || failed == run().count() {
        return None;
    }
    let tried: Vec<Tried<'_>> = grade
        .scenes()
        .zip(contents())
        .filter(|(scene, _)| was_run(&scene.reason) && scene.ended.is_some() && scene.verdict != Verdict::NotRun)
        .map(|(scene, contents)| {
            let steps = match scene.reason {
                Reason::Program(reached) => reached.steps,
                _ => 0,
            };
            Tried { scene: &scene.scene, failing: failing(&scene.ended), steps, contents }
        })
        .collect();
    locate(&tried)
}

#[cfg(test)]
mod together_tests;

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(verdict: Verdict, right_steps: u32) -> (SceneResult, bool) {
        (SceneResult { right_steps, ..SceneResult::without_run("a/b", 10, verdict, Reason::Right) }, false)
    }

    fn points(credit: Credit, scenes: Vec<(SceneResult, bool)>) -> f64 {
        let marking = Marking { points: 30.0, credit, visibility: Visibility::Visible };
        group("g", marking, scenes).points.expect("points")
    }

    #[test]
    fn partial_credit_follows_the_suite() {
        let mixed = || vec![scene(Verdict::Accepted, 10), scene(Verdict::WrongAnswer, 5), scene(Verdict::TimeLimit, 9)];
        assert_eq!(points(Credit::Scenes, mixed()), 10.0);
        assert_eq!(points(Credit::Steps, mixed()), 15.0);
        assert_eq!(points(Credit::All, mixed()), 0.0);
        for credit in [Credit::Scenes, Credit::Steps, Credit::All] {
            assert_eq!(points(credit, vec![scene(Verdict::Accepted, 10); 7]), 30.0);
        }
    }

    #[test]
    fn the_worst_scene_names_the_group_and_nothing_run_gives_nothing() {
        let marking = Marking { points: 5.0, credit: Credit::Scenes, visibility: Visibility::Hidden };
        let graded = group("g", marking, vec![scene(Verdict::Accepted, 10), scene(Verdict::RuntimeError, 0)]);
        assert_eq!(graded.verdict, Verdict::RuntimeError);
        let empty = group("g", marking, Vec::new());
        assert_eq!((empty.points, empty.verdict), (Some(0.0), Verdict::NotRun));
    }

    #[test]
    fn a_wrong_answer_never_has_full_points() {
        assert_eq!(points(Credit::Steps, vec![scene(Verdict::WrongAnswer, 10)]), 27.0);
        let of_one_step = SceneResult { steps: 1, ..scene(Verdict::WrongAnswer, 1).0 };
        assert_eq!(points(Credit::Steps, vec![(of_one_step, false)]), 0.0);
    }

    #[test]
    fn what_was_not_run_or_not_judged_has_no_points_and_its_group_neither() {
        for missing in [Verdict::NotRun, Verdict::JudgeError] {
            for credit in [Credit::Scenes, Credit::Steps, Credit::All] {
                let marking = Marking { points: 30.0, credit, visibility: Visibility::Visible };
                let graded = group("g", marking, vec![scene(Verdict::WrongAnswer, 5), scene(missing, 0)]);
                assert_eq!((graded.points, graded.scenes[1].points), (None, None));
                assert!(graded.scenes[0].points.is_some());
            }
        }
    }
}
