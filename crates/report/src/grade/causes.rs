//! Groups the scenes of a submission by the cause of their verdicts, and selects the scene that shows each cause best.
//! All reports use this order and these scenes.
use crate::words;
use fosssim_findings::{Grade, Reason, SceneGrade, Verdict};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use fosssim_mistakes::together::find_likely_mistakes;
use std::{cmp::Reverse, collections::BTreeMap};

/// Scenes whose verdicts have the same cause. The first one shows the cause best, and the others are in the suite's
/// order.
pub type AlikeScenes<'a> = Vec<&'a SceneGrade>;

/// Returns the listed scenes, grouped by cause. Causes that cost more than extra points are first; among them, causes
/// with likely mistakes, then causes by the number of their scenes. Skipped scenes follow, and then accepted scenes
/// that the rule books judge differently.
pub fn group_by_cause(grade: &Grade) -> Vec<AlikeScenes<'_>> {
    let likely: Vec<Explanation> = find_likely_mistakes(grade).into_iter().map(|(mistake, _)| mistake).collect();
    let mut found: BTreeMap<(Verdict, Vec<String>), (usize, AlikeScenes<'_>)> = BTreeMap::new();
    for (index, scene) in grade.scenes().enumerate().filter(|(_, scene)| is_listed(scene)) {
        found.entry((scene.verdict, describe_cause(scene))).or_insert((index, Vec::new())).1.push(scene);
    }
    let mut causes: Vec<_> = found.into_values().collect();
    let extra: Vec<bool> = grade.groups.iter().flat_map(|group| group.scenes.iter().map(|_| group.extra)).collect();
    causes.sort_by_key(|(index, scenes)| {
        let first = scenes[0];
        let is_right = first.verdict.is_accepted();
        let is_left_out = matches!(first.reason, Reason::Skipped(_));
        (
            is_right,
            is_left_out,
            extra[*index],
            rank(&likely, &first.corrected_explanations),
            Reverse(scenes.len()),
            *index,
        )
    });
    for (_, scenes) in &mut causes {
        let best = (0..scenes.len()).min_by_key(|&index| clarity_rank(scenes[index])).unwrap_or(0);
        scenes[..=best].rotate_right(1);
    }
    causes.into_iter().map(|(_, scenes)| scenes).collect()
}

/// Returns the scene that shows a mistake most clearly; `None` if no scene shows it.
pub fn clearest_scene<'a>(grade: &'a Grade, mistake: &Explanation) -> Option<&'a SceneGrade> {
    let named_scenes = grade.scenes().filter(|scene| is_named_in(mistake, &scene.explanations));
    named_scenes.min_by_key(|scene| clarity_rank(scene))
}

/// Returns the best rank that one of these explanations has among the likely mistakes. Explanations that are not likely
/// mistakes rank after all of them, and no explanation ranks last.
pub(crate) fn rank(likely: &[Explanation], own: &[Explanation]) -> usize {
    let named = likely.iter().position(|explanation| is_named_in(explanation, own));
    named.unwrap_or(likely.len() + usize::from(own.is_empty()))
}

/// Returns how hard a cause is to see in a scene. The clearest scene has the smallest value. The criteria are, in this
/// order: whether the rule books differ (then the fault may be round-off), the number of explanations that agree with
/// all scenes, the number of explanations of this scene alone, the number of findings (which grows with the length of
/// the motion), and the number of steps.
fn clarity_rank(scene: &SceneGrade) -> (bool, usize, usize, u64, u32) {
    let found = scene.disclosure.as_ref().map_or(0, |all| all.official().counts.total());
    (scene.difference_cause.is_some(), scene.corrected_explanations.len(), scene.explanations.len(), found, scene.steps)
}

/// Returns whether the report describes the scene: it is not accepted, or the rule books differ.
pub(crate) fn is_listed(scene: &SceneGrade) -> bool {
    scene.verdict != Verdict::NotRun && (!scene.verdict.is_accepted() || scene.difference_cause.is_some())
}

/// Returns texts that are equal for scenes whose verdicts have the same cause: the end of the program, its likely
/// mistakes, the kind of the first finding, or the summary without numbers. Each accepted scene has a cause of its own.
fn describe_cause(scene: &SceneGrade) -> Vec<String> {
    if scene.verdict.is_accepted() {
        return vec![scene.scene.clone()];
    }
    if !matches!(scene.verdict, Verdict::WrongAnswer | Verdict::BadTrace) {
        // If the program logs nothing, the place of the first difference does not matter.
        let details = if scene.verdict == Verdict::Unwritten { Vec::new() } else { words::list_details(scene) };
        return std::iter::once(words::describe_ending(scene)).chain(details).collect();
    }
    if !scene.corrected_explanations.is_empty() {
        return scene.corrected_explanations.iter().map(words::explanation::describe).collect();
    }
    let first = scene.disclosure.as_ref().and_then(|all| all.official().first_divergence.as_ref());
    let kind = first.map(|first| format!("{:?}", first.kind()));
    vec![kind.unwrap_or_else(|| words::summarize(scene).replace(|letter: char| letter.is_ascii_digit(), ""))]
}

#[cfg(test)]
mod tests {
    use super::{super::samples, *};
    use fosssim_findings::{Cause, result::BadTrace};

    /// A program that never ends is stopped on some scenes, and is not run on the many later ones.
    #[test]
    fn the_first_cause_is_of_scenes_that_were_run() {
        let grade = samples::endless_grade();
        let causes = group_by_cause(&grade);
        let names: Vec<Vec<&str>> =
            causes.iter().map(|scenes| scenes.iter().map(|scene| scene.scene.as_str()).collect()).collect();
        assert_eq!(names, [vec!["Detection/a"], vec!["Detection/b", "Detection/c"]]);
    }

    /// Additional bytes after the last record of every trace are one cause, although the fair rules accept them.
    #[test]
    fn wrong_scenes_on_which_the_rule_books_differ_can_share_a_cause() {
        let mut grade = samples::accepted_grade();
        for scene in &mut grade.groups[0].scenes {
            scene.result.verdict = Verdict::BadTrace;
            scene.result.reason = Reason::Trace(BadTrace::TrailingBytes);
            scene.result.difference_cause = Some(Cause::TrailingBytes);
        }
        assert_eq!(group_by_cause(&grade).iter().map(Vec::len).collect::<Vec<_>>(), [2]);
        // A cause that costs more than extra points is first.
        grade.groups[0].extra = true;
        grade.groups[1].scenes[0].result.verdict = Verdict::RuntimeError;
        assert_eq!(group_by_cause(&grade)[0][0].scene, "Impulses/a");
    }
}
