//! Decides when the remaining scenes of a submission are skipped, so that a class does not wait for one program that
//! never ends.
//!
//! The functions are pure, and depend only on the results so far, in the suite's order. Further results can only make
//! the end earlier. Therefore scenes that are skipped while others still run remain skipped, and the same scenes are
//! skipped for any number of jobs.
use super::{
    config::SkipLimits,
    result::{NotRunReason, Reason, SceneResult},
    task::SceneTask,
    verdict::Verdict,
};
use std::time::Duration;

/// Returns the result of a skipped scene. If limits were exceeded, the scene counts like the scenes that exceeded them,
/// because the submission is at fault.
pub(super) fn skipped_result(task: &SceneTask, reason: NotRunReason) -> SceneResult {
    let verdict = match reason {
        NotRunReason::Limits { verdict, .. } => verdict,
        NotRunReason::Total(_) => Verdict::TimeLimit,
        NotRunReason::FailFast => Verdict::NotRun,
    };
    SceneResult::without_run(&task.name, task.scene.step_count(), verdict, Reason::Skipped(reason))
}

/// The factor between the limit on all scenes that exceed a limit and the limit on consecutive ones. Each such scene
/// takes the whole limit, and a program that never ends in some scenes usually does not end in many others.
const SCATTERED_FACTOR: u32 = 4;

/// Returns the first scene that is skipped, and the reason; `None` if no scene is. `verdicts_and_times` has the verdict
/// and the duration of each finished scene.
pub(super) fn find_first_skipped(
    limits: &SkipLimits,
    fail_fast: bool,
    verdicts_and_times: &[Option<(Verdict, Duration)>],
) -> Option<(usize, NotRunReason)> {
    let (mut stopped, mut worst, mut total) = (0, Verdict::Accepted, Duration::ZERO);
    let (mut scattered, mut worst_of_all) = (0, Verdict::Accepted);
    for (number, verdicts_and_times) in verdicts_and_times.iter().enumerate() {
        if total >= limits.total {
            return Some((number, NotRunReason::Total(limits.total)));
        }
        let Some((verdict, took)) = *verdicts_and_times else {
            stopped = 0;
            continue;
        };
        total += took;
        (stopped, worst) = match is_limit(verdict) {
            true if stopped > 0 => (stopped + 1, worst.max(verdict)),
            true => (1, verdict),
            false => (0, verdict),
        };
        if stopped == limits.time_outs && stopped > 0 {
            return Some((number + 1, NotRunReason::Limits { scenes: stopped, verdict: worst }));
        }
        if is_limit(verdict) {
            (scattered, worst_of_all) = (scattered + 1, worst_of_all.max(verdict));
            if scattered == SCATTERED_FACTOR * limits.time_outs {
                return Some((number + 1, NotRunReason::Limits { scenes: scattered, verdict: worst_of_all }));
            }
        }
        if fail_fast && !matches!(verdict, Verdict::Accepted | Verdict::NotRun) {
            return Some((number + 1, NotRunReason::FailFast));
        }
    }
    None
}

/// Returns whether a verdict means that the program was stopped at a limit. An endless loop reaches one of these limits
/// first: time, memory, or the size of its output.
const fn is_limit(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::TimeLimit | Verdict::MemoryLimit | Verdict::OutputLimit)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATIENCE: SkipLimits = SkipLimits { time_outs: 3, total: Duration::from_secs(100) };
    const LATE: Option<(Verdict, Duration)> = Some((Verdict::TimeLimit, Duration::from_secs(20)));
    const LARGE: Option<(Verdict, Duration)> = Some((Verdict::MemoryLimit, Duration::from_secs(1)));
    const LONG: Option<(Verdict, Duration)> = Some((Verdict::OutputLimit, Duration::from_secs(1)));
    const FINE: Option<(Verdict, Duration)> = Some((Verdict::Accepted, Duration::from_secs(20)));
    const WRONG: Option<(Verdict, Duration)> = Some((Verdict::WrongAnswer, Duration::ZERO));

    #[test]
    fn scenes_in_a_row_that_run_into_a_limit_are_the_end() {
        let end = |known: &[_]| find_first_skipped(&PATIENCE, false, known);
        let limits = |verdict| NotRunReason::Limits { scenes: 3, verdict };
        assert_eq!(end(&[LATE, LATE, LATE, None, FINE]), Some((3, limits(Verdict::TimeLimit))));
        assert_eq!(end(&[LARGE, LATE, LONG, FINE]), Some((3, limits(Verdict::TimeLimit))), "whichever they are");
        assert_eq!(end(&[LATE, LARGE, WRONG, LARGE]), None);
        assert_eq!(
            end(&[LATE, WRONG, LARGE, LARGE, LONG]),
            Some((5, limits(Verdict::MemoryLimit))),
            "the worst of the row"
        );
        assert_eq!(end(&[LATE, LATE, FINE, LATE]), None);
        // A scene without a verdict does not belong to the chain, and the end can only move forward.
        assert_eq!(end(&[None, LATE, LATE, LATE, None]), Some((4, limits(Verdict::TimeLimit))));
        assert_eq!(end(&[LATE, LATE, LATE, LATE, None]), Some((3, limits(Verdict::TimeLimit))));
        assert_eq!(super::find_first_skipped(&SkipLimits { time_outs: 0, ..PATIENCE }, false, &[LATE; 4]), None);
    }

    #[test]
    fn many_scenes_that_run_into_a_limit_are_the_end_even_with_others_between() {
        let verdicts_and_times: Vec<_> = (0..30).map(|number| if number % 2 == 0 { LARGE } else { WRONG }).collect();
        let limits = NotRunReason::Limits { scenes: 12, verdict: Verdict::MemoryLimit };
        assert_eq!(find_first_skipped(&PATIENCE, false, &verdicts_and_times), Some((23, limits)));
        assert_eq!(find_first_skipped(&PATIENCE, false, &verdicts_and_times[..22]), None);
        assert_eq!(find_first_skipped(&SkipLimits { time_outs: 0, ..PATIENCE }, false, &verdicts_and_times), None);
        // Scenes without a verdict yet cannot move the end backward.
        let later: Vec<_> =
            verdicts_and_times.iter().enumerate().map(|(number, entry)| entry.filter(|_| number != 0)).collect();
        assert_eq!(find_first_skipped(&PATIENCE, false, &later), Some((25, limits)));
    }

    #[test]
    fn the_time_of_all_scenes_together_is_limited() {
        assert_eq!(find_first_skipped(&PATIENCE, false, &[FINE; 5]), None);
        assert_eq!(find_first_skipped(&PATIENCE, false, &[FINE; 8]), Some((5, NotRunReason::Total(PATIENCE.total))));
        assert_eq!(
            find_first_skipped(&PATIENCE, false, &[FINE, None, FINE, FINE, FINE, FINE, None]),
            Some((6, NotRunReason::Total(PATIENCE.total)))
        );
    }

    #[test]
    fn the_first_scene_that_is_not_accepted_is_the_end_when_asked_for() {
        assert_eq!(
            find_first_skipped(&PATIENCE, true, &[FINE, None, WRONG, WRONG, None]),
            Some((3, NotRunReason::FailFast))
        );
        assert_eq!(find_first_skipped(&PATIENCE, true, &[FINE, WRONG, WRONG]), Some((2, NotRunReason::FailFast)));
        assert_eq!(find_first_skipped(&PATIENCE, false, &[FINE, WRONG, WRONG]), None);
    }
}
