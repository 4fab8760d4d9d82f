//! Points for speed. They depend on a submission's processor time compared with the reference program's. Both run
//! alternately on the same machine. Wall time is not used, because other running programs affect it.
use super::{
    result::SceneResult,
    timing::{TimedRun, Timing},
    verdict::Verdict,
};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The rules by which a suite gives points for the speed of a group.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpeedMarking {
    /// The points that the speed is worth, in addition to the points for scenes.
    pub points: f64,
    /// The largest ratio of the submission's time to the reference's that gives all points.
    pub full_at: f64,
    /// The smallest ratio that gives no points. It is greater than `full_at`. Between the two, points decrease
    /// linearly.
    pub none_at: f64,
    /// The number of times that each scene is run for the measurement.
    pub runs: u32,
}

impl SpeedMarking {
    /// Returns the points that a ratio gives.
    pub fn points_at(&self, ratio: f64) -> f64 {
        self.points * ((self.none_at - ratio) / (self.none_at - self.full_at)).clamp(0.0, 1.0)
    }
}

/// The points that a group gets for speed, and how they were computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpeedGrade {
    /// The rules by which the suite gives points for the speed of this group.
    pub marking: SpeedMarking,
    /// The points that the submission gets for speed. `None` if the grader could not measure it; that never gives zero
    /// points.
    pub points: Option<f64>,
    /// The calculation of the points, or the reason why there are none.
    pub source: SpeedSource,
}

/// The calculation of points for speed, or the reason why there are none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SpeedSource {
    /// Some scenes of the group are not accepted, so there are no points for speed.
    NotAccepted,
    /// All scenes of the group were timed. The value is the result.
    Measured(SpeedRatio),
    /// In a timed run of this scene, the verdict was not the same as in the graded run.
    Failed {
        /// The name of the scene.
        scene: String,
        /// The verdict on the timed run.
        verdict: Verdict,
    },
    /// Grading was stopped before the speed was measured, or the grader failed.
    Unmeasured,
    /// Students must not see the points, because a program could reveal a hidden scene by its time.
    Withheld,
}

/// The submission's processor time, divided by the reference program's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpeedRatio {
    /// The ratio of the minimum times over all runs. Other running programs affect minimum times least.
    pub ratio: f64,
    /// The smallest ratio in a round of runs.
    pub least: f64,
    /// The largest ratio in a round of runs.
    pub most: f64,
    /// The number of rounds. In each round, every scene is run once.
    pub runs: u32,
}

impl SpeedGrade {
    /// Returns the points for the speed of a group, from the timings of its scenes.
    pub fn from_scenes<'a>(marking: SpeedMarking, scenes: impl IntoIterator<Item = &'a SceneResult>) -> Self {
        let source = source(&scenes.into_iter().collect::<Vec<_>>());
        let points = match &source {
            SpeedSource::Measured(measured) => Some(marking.points_at(measured.ratio)),
            SpeedSource::Unmeasured => None,
            SpeedSource::NotAccepted | SpeedSource::Failed { .. } | SpeedSource::Withheld => Some(0.0),
        };
        Self { marking, points, source }
    }
}

fn source(scenes: &[&SceneResult]) -> SpeedSource {
    if scenes.iter().any(|scene| matches!(scene.verdict, Verdict::JudgeError | Verdict::NotRun)) {
        return SpeedSource::Unmeasured;
    }
    if scenes.is_empty() || !scenes.iter().all(|scene| scene.verdict.is_accepted()) {
        return SpeedSource::NotAccepted;
    }
    let mut timed = Vec::new();
    for scene in scenes {
        match &scene.timing {
            Some(Timing { failed: Some(verdict), .. }) => {
                return SpeedSource::Failed { scene: scene.scene.clone(), verdict: *verdict };
            }
            Some(Timing { runs, .. }) if !runs.is_empty() => timed.push(runs.as_slice()),
            _ => return SpeedSource::Unmeasured,
        }
    }
    SpeedSource::Measured(ratio(&timed))
}

/// Returns the ratios of the sums over all scenes: one of the minimum times, and the smallest and the largest of a
/// round.
fn ratio(scenes: &[&[TimedRun]]) -> SpeedRatio {
    // The clock has a resolution of a microsecond, so it may measure zero.
    let seconds = |time: Duration| time.as_secs_f64().max(1e-6);
    let sum = |choose_run: &dyn Fn(&[TimedRun]) -> TimedRun| {
        let (submission, reference) = scenes
            .iter()
            .map(|runs| choose_run(runs))
            .fold((0.0, 0.0), |sum, run| (sum.0 + seconds(run.submission), sum.1 + seconds(run.reference)));
        submission / reference
    };
    let rounds = scenes.iter().map(|runs| runs.len()).min().unwrap_or(0);
    let each: Vec<f64> = (0..rounds).map(|round| sum(&|runs: &[TimedRun]| runs[round])).collect();
    let fastest = |runs: &[TimedRun]| TimedRun {
        submission: runs.iter().map(|run| run.submission).min().unwrap_or_default(),
        reference: runs.iter().map(|run| run.reference).min().unwrap_or_default(),
    };
    SpeedRatio {
        ratio: sum(&fastest),
        least: each.iter().copied().fold(f64::INFINITY, f64::min),
        most: each.iter().copied().fold(0.0, f64::max),
        runs: u32::try_from(rounds).unwrap_or(u32::MAX),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::Reason;

    const MARKING: SpeedMarking = SpeedMarking { points: 40.0, full_at: 2.0, none_at: 10.0, runs: 2 };

    fn scene(verdict: Verdict, runs: &[(u64, u64)], failed: Option<Verdict>) -> SceneResult {
        let run = |&(submission, reference): &(u64, u64)| TimedRun {
            submission: Duration::from_millis(submission),
            reference: Duration::from_millis(reference),
        };
        let timing = Timing { machine: "here".to_owned(), runs: runs.iter().map(run).collect(), failed };
        SceneResult {
            timing: (!runs.is_empty()).then_some(timing),
            ..SceneResult::without_run("a/b", 1, verdict, Reason::Right)
        }
    }

    #[test]
    fn points_fall_linearly_between_two_ratios() {
        let at = |ratio| MARKING.points_at(ratio);
        assert_eq!([0.5, 2.0, 4.0, 6.0, 10.0, 99.0].map(at), [40.0, 40.0, 30.0, 20.0, 0.0, 0.0]);
    }

    /// The second round was disturbed. It increases the spread, but costs no points.
    #[test]
    fn the_minimum_times_count_and_the_spread_is_reported() {
        let right = Verdict::Accepted;
        let scenes = [scene(right, &[(30, 10), (90, 10)], None), scene(right, &[(50, 10), (30, 30)], None)];
        let grade = SpeedGrade::from_scenes(MARKING, &scenes);
        let expected = SpeedRatio { ratio: 3.0, least: 3.0, most: 4.0, runs: 2 };
        assert_eq!((grade.source, grade.points), (SpeedSource::Measured(expected), Some(35.0)));
    }

    #[test]
    fn being_right_counts_before_being_fast_and_faults_of_ours_are_nobodys_zero() {
        let (right, wrong) = (Verdict::Accepted, Verdict::WrongAnswer);
        let of = |scenes: &[SceneResult]| {
            let grade = SpeedGrade::from_scenes(MARKING, scenes);
            (grade.source, grade.points)
        };
        let timed = || scene(right, &[(10, 10)], None);
        assert_eq!(of(&[timed(), scene(wrong, &[], None)]), (SpeedSource::NotAccepted, Some(0.0)));
        assert_eq!(of(&[timed(), scene(right, &[], None)]), (SpeedSource::Unmeasured, None));
        assert_eq!(of(&[timed(), scene(Verdict::JudgeError, &[], None)]), (SpeedSource::Unmeasured, None));
        let failed = SpeedSource::Failed { scene: "a/b".to_owned(), verdict: wrong };
        assert_eq!(of(&[timed(), scene(right, &[(10, 10)], Some(wrong))]), (failed, Some(0.0)));
    }
}
