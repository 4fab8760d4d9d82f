//! From verdicts to points.
use super::{
    config::{Credit, Visibility},
    grade::{GroupGrade, SceneGrade},
    verdict::Verdict,
};

/// What of a group decides its points.
#[derive(Debug, Clone, Copy)]
pub struct Stakes {
    /// Points of the whole group.
    pub points: f64,
    /// How partial success counts.
    pub credit: Credit,
    /// Who sees it.
    pub visibility: Visibility,
}

/// Shares a group's points evenly among its scenes and adds up what was reached.
///
/// With [`Credit::Steps`] a scene with a complete trace and a wrong answer gets the share of its steps without a
/// finding; any other verdict but accepted gets nothing. With [`Credit::All`] every scene has to be accepted.
#[must_use]
pub fn group(name: &str, stakes: Stakes, mut scenes: Vec<SceneGrade>) -> GroupGrade {
    #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
    let each = if scenes.is_empty() { 0.0 } else { stakes.points / scenes.len() as f64 };
    let all_accepted = scenes.iter().all(|scene| scene.verdict.is_accepted());
    for scene in &mut scenes {
        scene.max_points = each;
        let share = match (stakes.credit, scene.verdict) {
            (Credit::All, _) => f64::from(u8::from(all_accepted)),
            (_, Verdict::Accepted) => 1.0,
            (Credit::Steps, Verdict::WrongAnswer) if scene.steps > 0 => {
                f64::from(scene.right_steps) / f64::from(scene.steps)
            }
            _ => 0.0,
        };
        scene.points = each * share;
    }
    // The full score is exact: sums of rounded shares would make 99.99999 of 100.
    let points = if all_accepted { stakes.points } else { scenes.iter().map(|scene| scene.points).sum() };
    GroupGrade {
        name: name.to_owned(),
        visibility: stakes.visibility,
        points: if scenes.is_empty() { 0.0 } else { points },
        max_points: stakes.points,
        verdict: scenes.iter().map(|scene| scene.verdict).max().unwrap_or(Verdict::NotRun),
        scenes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn scene(verdict: Verdict, right_steps: u32) -> SceneGrade {
        SceneGrade {
            scene: "a/b".to_owned(),
            verdict,
            summary: String::new(),
            differs: None,
            details: Vec::new(),
            explanations: Vec::new(),
            points: 0.0,
            max_points: 0.0,
            right_steps,
            steps: 10,
            cpu: Duration::ZERO,
            wall: Duration::ZERO,
            memory: None,
            stdout: String::new(),
            stderr: String::new(),
            cached: false,
        }
    }

    fn points(credit: Credit, scenes: Vec<SceneGrade>) -> f64 {
        group("g", Stakes { points: 30.0, credit, visibility: Visibility::Visible }, scenes).points
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
        let stakes = Stakes { points: 5.0, credit: Credit::Scenes, visibility: Visibility::Hidden };
        let graded = group("g", stakes, vec![scene(Verdict::Accepted, 10), scene(Verdict::RuntimeError, 0)]);
        assert_eq!(graded.verdict, Verdict::RuntimeError);
        let empty = group("g", stakes, Vec::new());
        assert_eq!((empty.points, empty.verdict), (0.0, Verdict::NotRun));
    }
}
