//! From verdicts to points.
use super::{
    config::{Credit, Visibility},
    grade::{GroupGrade, SceneGrade},
    result::SceneResult,
    verdict::Verdict,
};

/// What of a group decides its points.
#[derive(Debug, Clone, Copy)]
pub struct Marking {
    /// Points of the whole group.
    pub points: f64,
    /// How partial success counts.
    pub credit: Credit,
    /// Who sees it.
    pub visibility: Visibility,
}

/// Shares a group's points evenly among its scenes and adds up what was reached. The results come with the word whether
/// they were taken from an earlier run.
///
/// With [`Credit::Steps`] a scene with a complete trace and a wrong answer gets the share of its steps without a
/// finding, never all; any other verdict but accepted gets nothing. With [`Credit::All`] every scene has to be accepted.
/// Scenes on which the grader failed, or which it did not come to run, have no points, nor has their group.
#[must_use]
pub fn group(name: &str, marking: Marking, results: Vec<(SceneResult, bool)>) -> GroupGrade {
    #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
    let each = if results.is_empty() { 0.0 } else { marking.points / results.len() as f64 };
    let all_accepted = results.iter().all(|(result, _)| result.verdict.is_accepted());
    let scenes: Vec<SceneGrade> = results
        .into_iter()
        .map(|(result, cached)| {
            let points = share(marking.credit, &result, all_accepted).map(|share| each * share);
            SceneGrade { result, points, max_points: each, cached }
        })
        .collect();
    // The full score is exact: sums of rounded shares would make 99.99999 of 100.
    let points = match all_accepted && !scenes.is_empty() {
        true => Some(marking.points),
        false => scenes.iter().map(|scene| scene.points).sum(),
    };
    GroupGrade {
        name: name.to_owned(),
        visibility: marking.visibility,
        points,
        max_points: marking.points,
        verdict: scenes.iter().map(|scene| scene.verdict).max().unwrap_or(Verdict::NotRun),
        scenes,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::Reason;

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
