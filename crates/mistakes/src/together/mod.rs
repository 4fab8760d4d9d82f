//! Finds the likely mistakes of one submission from all its scenes together.

use crate::diagnose::{correct_trace, explain_together, is_named_in};
use disclosure::{limit_result, limit_smallest_scene};
use fosssim_findings::{
    Hints, Visibility,
    explanation::Explanation,
    grade::{Grade, GroupGrade, SceneGrade},
    smallest_scene::SmallestScene,
};
use std::{borrow::Cow, time::Duration};

pub mod disclosure;

/// Returns the grade with only the scene details that hints allow for students, and without information about other
/// submissions. Groups that students do not see are included.
pub fn disclosed_grade(grade: &Grade) -> Cow<'_, Grade> {
    let is_all_disclosed = grade.groups.iter().all(|group| group.hints == Hints::Full);
    if is_all_disclosed && grade.same_program.is_empty() && grade.smallest.is_empty() {
        return Cow::Borrowed(grade);
    }
    let mut disclosed = Grade { same_program: Vec::new(), smallest: visible_smallest_scenes(grade), ..grade.clone() };
    if is_all_disclosed {
        return Cow::Owned(disclosed);
    }
    for group in &mut disclosed.groups {
        for scene in &mut group.scenes {
            limit_result(group.hints, &mut scene.result);
        }
    }
    if !disclosed.groups.iter().all(|group| group.hints.explains()) {
        disclosed.located_failure = None;
    }
    reconcile_explanations(&mut disclosed);
    Cow::Owned(disclosed)
}

/// Returns only the part of the grade that students see immediately. The points and the verdict are those of the
/// remaining groups, and hints limit the reports on their scenes ([`disclosed_grade`]). Unless the suite shows the
/// programs' output, scenes have only their verdicts ([`withhold`](fosssim_findings::SceneResult::withhold)).
pub fn immediate_grade(grade: &Grade) -> Cow<'_, Grade> {
    if grade.is_visible() {
        return disclosed_grade(grade);
    }
    let grade = disclosed_grade(grade);
    let is_visible = |group: &&GroupGrade| group.visibility == Visibility::Visible;
    let groups: Vec<GroupGrade> = grade.groups.iter().filter(is_visible).cloned().collect();
    let (verdict, points, max_points) = Grade::totals(&groups);
    let mut visible = Grade {
        verdict,
        points,
        max_points,
        groups,
        // The counts include scenes that are not in this grade.
        located_failure: None,
        wall: Duration::ZERO,
        ..grade.as_ref().clone()
    };
    if grade.shows_output {
        reconcile_explanations(&mut visible);
    } else {
        visible.groups.iter_mut().for_each(GroupGrade::withhold);
    }
    Cow::Owned(visible)
}

/// Returns the smallest scenes that students may see. Each is made from a scene of a visible group, and has only the
/// details that the group's hints allow. There are none if the suite withholds the programs' output, because smallest
/// scenes depend on it.
fn visible_smallest_scenes(grade: &Grade) -> Vec<SmallestScene> {
    let disclosed = |small: &SmallestScene| {
        let is_origin = |scene: &SceneGrade| scene.scene == small.origin;
        let group = grade.groups.iter().find(|group| group.scenes.iter().any(is_origin))?;
        (group.visibility == Visibility::Visible).then(|| limit_smallest_scene(group.hints, small.clone()))?
    };
    if grade.is_visible() || grade.shows_output {
        grade.smallest.iter().filter_map(disclosed).collect()
    } else {
        Vec::new()
    }
}

/// Returns the points of the scenes that a mistake alone makes wrong, which is the gain from fixing it. On these
/// scenes, the simulator with only this mistake makes the same wrong steps as the submission. Points for speed and
/// extra points are not included.
pub fn mistake_points(grade: &Grade, mistake: &Explanation) -> f64 {
    joint_points(grade, std::slice::from_ref(mistake))
}

/// Returns the points that are gained by fixing all of these mistakes, but not by fixing single ones.
pub fn shared_points(grade: &Grade, mistakes: &[Explanation]) -> f64 {
    let single: f64 = mistakes.iter().map(|mistake| mistake_points(grade, mistake)).sum();
    (joint_points(grade, mistakes) - single).max(0.0)
}

/// Returns the points of the scenes that only these mistakes make wrong.
fn joint_points(grade: &Grade, mistakes: &[Explanation]) -> f64 {
    // The simulator cannot make an unknown mistake.
    let is_simulated = |mistake: &&Explanation| !mistake.is_unexplained() && !mistake.names_stage();
    let mistakes: Vec<&Explanation> = mistakes.iter().filter(is_simulated).collect();
    let is_named = |explanation: &Explanation| {
        mistakes.iter().any(|mistake| is_named_in(mistake, std::slice::from_ref(explanation)))
    };
    let is_mended = |scene: &SceneGrade| {
        // If several mistakes are proven, they reproduce the steps only together.
        let mut proven = scene.explanations.iter().filter(|explanation| explanation.is_proven()).peekable();
        proven.peek().is_some() && proven.all(is_named)
    };
    let group_points = |group: &GroupGrade| {
        let is_right = |scene: &SceneGrade| scene.verdict.is_accepted() || is_mended(scene);
        if group.all_or_nothing && !group.scenes.iter().all(is_right) {
            return 0.0;
        }
        let lost_points = |scene: &SceneGrade| scene.points.map_or(0.0, |points| scene.max_points - points);
        group.scenes.iter().filter(|scene| group.all_or_nothing || is_mended(scene)).map(lost_points).sum()
    };
    // The sum of no numbers is -0.
    grade.groups.iter().filter(|group| !group.extra).map(group_points).sum::<f64>() + 0.0
}

/// Returns the mistake that explains most wrong scenes, if several scenes have explanations. Several scenes nearly
/// always distinguish mistakes that look the same in one scene.
pub fn find_likely_mistake(grade: &Grade) -> Option<Explanation> {
    let explained_count = grade.scenes().filter(|scene| !scene.explanations.is_empty()).count();
    if explained_count > 1 { find_likely_mistakes(grade).into_iter().next().map(|(likely, _)| likely) } else { None }
}

/// Returns whether all scenes that a mistake explains give only extra points.
pub fn is_only_extra(grade: &Grade, mistake: &Explanation) -> bool {
    let names = |group: &GroupGrade| group.scenes.iter().any(|scene| is_named_in(mistake, &scene.explanations));
    grade.groups.iter().any(names) && grade.groups.iter().all(|group| group.extra || !names(group))
}

/// Returns at most three likely mistakes, with the number of wrong scenes that each explains. The mistake that explains
/// most scenes comes first; later ones explain most of the rest, and explain those scenes completely
/// ([`explain_together`]). Mistakes that cost only extra points come last.
pub fn find_likely_mistakes(grade: &Grade) -> Vec<(Explanation, usize)> {
    let mut likely = explain_together(grade.scenes().map(|scene| scene.explanations.as_slice()), &grade.refuted_keys);
    likely.sort_by_key(|mistake| is_only_extra(grade, mistake));
    likely
        .into_iter()
        .filter(|likely| {
            likely.reproduced > 0
                || likely.names_stage()
                || likely.reports_non_finite_value()
                || likely.is_unexplained()
        })
        .map(|likely| (likely.clone(), count_explained_scenes(grade, &likely)))
        .collect()
}

/// Returns the number of scenes whose explanations name `mistake`, or one of its unwritten stages.
pub fn count_explained_scenes(grade: &Grade, mistake: &Explanation) -> usize {
    grade.scenes().filter(|scene| is_named_in(mistake, &scene.explanations)).count()
}

/// Corrects each scene's explanations with those of all other scenes: several wrong scenes can confirm a mistake, and a
/// right one can refute it. A caller that removes groups from a grade must call it again, so that nothing about them is
/// revealed.
pub fn reconcile_explanations(grade: &mut Grade) {
    let speak_together = !grade.refuted_keys.is_empty() || find_likely_mistake(grade).is_some();
    let likely = if speak_together { find_likely_mistakes(grade) } else { Vec::new() };
    let likely: Vec<Explanation> = likely.into_iter().map(|(explanation, _)| explanation).collect();
    for scene in grade.groups.iter_mut().flat_map(|group| &mut group.scenes) {
        let corrected = correct_trace(&scene.result.explanations, &likely, &grade.refuted_keys);
        (scene.corrected_explanations, scene.agreed_count) = (corrected.explanations, corrected.agreed_count);
    }
}
