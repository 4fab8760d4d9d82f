//! Computes a grade from the results of a submission's scenes: the verdicts, the points, and the mistakes that several
//! scenes show together.
use super::{
    config::{Credit, Marking, POINTS_RANGE},
    grade::{Grade, GroupGrade, SceneGrade},
    library,
    plan::{Plan, PlannedGroup},
    result::SceneResult,
    verdict::Verdict,
};
use fosssim_findings::speed::SpeedGrade;
use fosssim_mistakes::diagnose::{self, Explanation};
use fosssim_model::scene::Scene;
use std::time::Duration;

/// Shares a group's points evenly among its scenes, and adds up the points of the scenes. The flag of each result is
/// true if it was reused from an earlier grading.
///
/// An accepted scene gets all its points. With [`Credit::Steps`], a scene with a complete but wrong trace gets the
/// share of its steps without a finding, but never all its points. Every other scene gets zero points. With
/// [`Credit::All`], the group gets points only if every scene is accepted. If the grader failed on a scene or did not
/// run it, neither the scene nor its group has points.
pub fn grade_group(name: &str, marking: Marking, results: Vec<(SceneResult, bool)>) -> GroupGrade {
    let each = scene_points(marking.points, results.len());
    let all_accepted = results.iter().all(|(result, _)| result.verdict.is_accepted());
    let scenes: Vec<SceneGrade> = results
        .into_iter()
        .map(|(result, cached)| {
            let points = point_share(marking.credit, &result, all_accepted).map(|share| each * share);
            let settled = result.explanations.clone();
            SceneGrade { result, points, max_points: each, cached, corrected_explanations: settled, agreed_count: 0 }
        })
        .collect();
    let points = group_points(marking.points, all_accepted, &scenes);
    let speed = marking.speed.map(|speed| SpeedGrade::from_scenes(speed, scenes.iter().map(|scene| &scene.result)));
    GroupGrade {
        name: name.to_owned(),
        visibility: marking.visibility,
        hints: marking.hints,
        extra: marking.is_extra,
        all_or_nothing: marking.credit == Credit::All,
        points: add_speed_points(points, speed.as_ref()),
        max_points: marking.points + marking.speed.map_or(0.0, |speed| speed.points),
        speed,
        note: None,
        verdict: scenes.iter().map(|scene| scene.verdict).max().unwrap_or(Verdict::NotRun),
        scenes,
    }
}

/// Computes the grade from the results of all scenes, in the order of the plan. It does not contain the build, the
/// sandbox and the times yet. Speed counts if `is_timed` is true.
pub(super) fn build_grade(plan: &Plan, submission: String, is_timed: bool, results: Vec<(SceneResult, bool)>) -> Grade {
    let mut results = mark_unwritten(results).into_iter();
    let to_grade = |planned: &PlannedGroup| {
        let marking = Marking { speed: planned.marking.speed.filter(|_| is_timed), ..planned.marking };
        let results = results.by_ref().take(planned.scenes.len()).collect();
        GroupGrade { note: planned.note.clone(), ..grade_group(&planned.name, marking, results) }
    };
    let groups: Vec<GroupGrade> = plan.groups.iter().map(to_grade).collect();
    let (verdict, points, max_points) = Grade::totals(&groups);
    Grade {
        submission,
        suite: plan.name.clone(),
        rules: plan.rules,
        verdict,
        points,
        max_points,
        // If nothing was run, there is no output that could reveal a hidden scene.
        shows_output: true,
        refuted_keys: find_refuted(plan, &groups),
        groups,
        build: None,
        warnings: Vec::new(),
        layers: Vec::new(),
        wall: Duration::ZERO,
        inferred_milestone: None,
        located_failure: None,
        program: None,
        same_program: Vec::new(),
        earlier_grade: None,
        smallest: Vec::new(),
        notes: plan.notes.clone(),
    }
}

/// Treats the results as parts of one submission. If the trace of any scene has entries, an empty trace of another
/// scene counts as wrong, not as unwritten.
fn mark_unwritten(mut results: Vec<(SceneResult, bool)>) -> Vec<(SceneResult, bool)> {
    let is_judged =
        |(result, _): &(SceneResult, bool)| matches!(result.verdict, Verdict::Accepted | Verdict::WrongAnswer);
    if results.iter().any(is_judged) {
        for (result, _) in results.iter_mut().filter(|(result, _)| result.verdict == Verdict::Unwritten) {
            result.verdict = Verdict::WrongAnswer;
        }
    }
    results
}

/// Adds the points of the scenes and the points for speed; `None` if one of them is missing.
fn add_speed_points(scenes: Option<f64>, speed: Option<&SpeedGrade>) -> Option<f64> {
    speed.map_or(scenes, |speed| Some(scenes? + speed.points?))
}

/// Returns the points that one scene is worth, in a group of `scenes` scenes.
#[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
fn scene_points(points: f64, scenes: usize) -> f64 {
    if scenes == 0 { 0.0 } else { points / scenes as f64 }
}

/// Returns the points that a group gets. The full score is exact, because a sum of rounded shares could be 99.99999
/// instead of 100.
fn group_points(points: f64, all_accepted: bool, scenes: &[SceneGrade]) -> Option<f64> {
    match all_accepted && !scenes.is_empty() {
        true => Some(points),
        false => scenes.iter().map(|scene| scene.points).sum(),
    }
}

/// Returns the share of a scene's points that its result gives. Returns `None` if the grader failed or did not run the
/// scene, so that there are no points.
fn point_share(credit: Credit, result: &SceneResult, all_accepted: bool) -> Option<f64> {
    Some(match (credit, result.verdict) {
        (_, Verdict::NotRun | Verdict::JudgeError) => return None,
        (Credit::All, _) => f64::from(u8::from(all_accepted)),
        (_, Verdict::Accepted) => 1.0,
        // All steps of a wrong trace can be right, because the first record may be wrong, or small errors may add up.
        (Credit::Steps, Verdict::WrongAnswer) => {
            let right = result.right_steps.min(result.steps.saturating_sub(1));
            f64::from(right) / f64::from(result.steps.max(1))
        }
        _ => 0.0,
    })
}

/// Returns a sentence about points or a verdict in a grade that do not follow from its scenes; `None` if everything is
/// consistent. A grade from a file that is not trusted is checked before its points are used.
pub fn find_contradiction(grade: &Grade) -> Option<&'static str> {
    let (verdict, points, max_points) = Grade::totals(&grade.groups);
    if !grade.groups.iter().all(|group| POINTS_RANGE.contains(&group.max_points)) || grade.max_points != max_points {
        Some("the maximum points do not fit any suite")
    } else if grade.points != points || !grade.groups.iter().all(is_consistent) {
        Some("the points do not follow from the verdicts")
    } else if grade.verdict != verdict {
        Some("the verdict is not the worst of the scenes' verdicts")
    } else {
        None
    }
}

/// Returns whether a group's points and verdict follow from the verdicts of its scenes, by any of the rules for partial
/// credit.
fn is_consistent(group: &GroupGrade) -> bool {
    let all_accepted = group.scenes.iter().all(|scene| scene.verdict.is_accepted());
    let max_points = group.max_points_of_scenes();
    let each = scene_points(max_points, group.scenes.len());
    let has_its_share = |credit, scene: &SceneGrade| {
        scene.max_points == each
            && scene.points == point_share(credit, &scene.result, all_accepted).map(|share| each * share)
    };
    let credits = [Credit::Scenes, Credit::Steps, Credit::All];
    credits.into_iter().any(|credit| group.scenes.iter().all(|scene| has_its_share(credit, scene)))
        && group.speed.as_ref().is_none_or(|speed| {
            *speed == SpeedGrade::from_scenes(speed.marking, group.scenes.iter().map(|scene| &scene.result))
        })
        && group.points == add_speed_points(group_points(max_points, all_accepted, &group.scenes), group.speed.as_ref())
        && group.verdict == group.scenes.iter().map(|scene| scene.verdict).max().unwrap_or(Verdict::NotRun)
}

/// Returns the keys of the likely mistakes that accepted scenes refute. The smallest accepted scenes are tried first.
fn find_refuted(plan: &Plan, groups: &[GroupGrade]) -> Vec<String> {
    let graded_scenes = || groups.iter().flat_map(|group| &group.scenes).zip(plan.scenes());
    let wrong: Vec<(&Scene, &[Explanation])> = graded_scenes()
        .map(|(scene, task)| (&task.scene, scene.explanations.as_slice()))
        .filter(|(_, explanations)| !explanations.is_empty())
        .collect();
    if wrong.is_empty() {
        return Vec::new();
    }
    let mut right: Vec<&Scene> = graded_scenes()
        .filter(|(scene, _)| scene.verdict == Verdict::Accepted && scene.difference_cause.is_none())
        .map(|(_, task)| &task.scene)
        .collect();
    right.sort_by_key(|scene| u64::from(scene.step_count()) * (scene.particles.len() * scene.particles.len()) as u64);
    // A built-in scene belongs to the milestone that its folder names. For other scenes, the milestone follows from
    // their contents.
    let bundled = plan.scenes().filter_map(|task| library::find_assignment(&task.name)).max();
    let whose = bundled.or_else(|| diagnose::find_milestone(plan.scenes().map(|task| &task.scene)));
    diagnose::refuted_keys(whose, &wrong, &right)
}

#[cfg(target_os = "linux")]
mod programs;
#[cfg(test)]
mod together_tests;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        config::{Hints, Visibility},
        result::Reason,
    };

    fn scene(verdict: Verdict, right_steps: u32) -> (SceneResult, bool) {
        (SceneResult { right_steps, ..SceneResult::without_run("a/b", 10, verdict, Reason::Right) }, false)
    }

    fn sum_points(credit: Credit, scenes: Vec<(SceneResult, bool)>) -> f64 {
        let marking = Marking {
            points: 30.0,
            credit,
            visibility: Visibility::Visible,
            hints: Hints::Full,
            is_extra: false,
            speed: None,
        };
        grade_group("g", marking, scenes).points.expect("points")
    }

    #[test]
    fn partial_credit_follows_the_suite() {
        let mixed = || vec![scene(Verdict::Accepted, 10), scene(Verdict::WrongAnswer, 5), scene(Verdict::TimeLimit, 9)];
        assert_eq!(sum_points(Credit::Scenes, mixed()), 10.0);
        assert_eq!(sum_points(Credit::Steps, mixed()), 15.0);
        assert_eq!(sum_points(Credit::All, mixed()), 0.0);
        for credit in [Credit::Scenes, Credit::Steps, Credit::All] {
            assert_eq!(sum_points(credit, vec![scene(Verdict::Accepted, 10); 7]), 30.0);
        }
    }

    #[test]
    fn the_worst_scene_names_the_group_and_nothing_run_gives_nothing() {
        let marking = Marking {
            points: 5.0,
            credit: Credit::Scenes,
            visibility: Visibility::Hidden,
            hints: Hints::Full,
            is_extra: false,
            speed: None,
        };
        let graded = grade_group("g", marking, vec![scene(Verdict::Accepted, 10), scene(Verdict::RuntimeError, 0)]);
        assert_eq!(graded.verdict, Verdict::RuntimeError);
        let empty = grade_group("g", marking, Vec::new());
        assert_eq!((empty.points, empty.verdict), (Some(0.0), Verdict::NotRun));
    }

    #[test]
    fn a_wrong_answer_never_has_full_points() {
        assert_eq!(sum_points(Credit::Steps, vec![scene(Verdict::WrongAnswer, 10)]), 27.0);
        let of_one_step = SceneResult { steps: 1, ..scene(Verdict::WrongAnswer, 1).0 };
        assert_eq!(sum_points(Credit::Steps, vec![(of_one_step, false)]), 0.0);
    }

    #[test]
    fn scenes_without_a_verdict_have_no_points_and_neither_has_their_group() {
        for missing in [Verdict::NotRun, Verdict::JudgeError] {
            for credit in [Credit::Scenes, Credit::Steps, Credit::All] {
                let marking = Marking {
                    points: 30.0,
                    credit,
                    visibility: Visibility::Visible,
                    hints: Hints::Full,
                    is_extra: false,
                    speed: None,
                };
                let graded = grade_group("g", marking, vec![scene(Verdict::WrongAnswer, 5), scene(missing, 0)]);
                assert_eq!((graded.points, graded.scenes[1].points), (None, None));
                assert!(graded.scenes[0].points.is_some());
            }
        }
    }
}
