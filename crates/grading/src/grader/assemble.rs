//! From the results of a submission's scenes to its grade.
use super::{Grading, lock};
use crate::{
    config::Visibility,
    grade::{Grade, GroupGrade},
    patience,
    result::SceneResult,
    score,
    verdict::Verdict,
};
use fosssim_mistakes::diagnose::{self, Explanation};
use fosssim_model::scene::Scene;

/// So many accepted scenes are asked whether they speak against a likely mistake.
const WITNESSES: usize = 12;

impl Grading<'_> {
    /// The grade, of the results of all scenes in the plan's order, each with the word whether it was found. The
    /// submission's copy goes away now.
    pub(in super::super) fn grade(&self, mut results: Vec<(SceneResult, bool)>) -> Grade {
        let (plan, options) = (self.grader.plan, self.grader.options);
        let build = match lock(&self.staged).take().as_deref() {
            Some(Ok(staged)) => staged.build.clone(),
            _ => None,
        };
        // What ran beside the scene that was the end does not count, or the number of jobs would.
        let known: Vec<_> = results.iter().map(|(result, _)| Some((result.verdict, result.wall))).collect();
        if let Some((end, why)) = patience::end(&plan.patience, options.fail_fast, &known) {
            for (result, scene) in results.iter_mut().zip(plan.scenes()).skip(end) {
                *result = (patience::left_out(scene, why), false);
            }
        }
        let wall = results.iter().map(|(result, _)| result.wall).sum();
        let mut results = results.into_iter();
        let groups: Vec<_> = plan
            .groups
            .iter()
            .map(|group| score::group(&group.name, group.marking, results.by_ref().take(group.scenes.len()).collect()))
            .collect();
        let refuted = self.refuted(&groups);
        let active = self.grader.backend.layers().iter().filter(|report| report.active);
        Grade {
            submission: self.submission.name.clone(),
            suite: plan.name.clone(),
            rules: self.grader.effective_rules(),
            verdict: groups.iter().map(|group| group.verdict).max().unwrap_or(Verdict::NotRun),
            points: groups.iter().map(|group| group.points).sum(),
            max_points: plan.max_points(),
            shows_output: plan.show_output || groups.iter().all(|group| group.visibility == Visibility::Visible),
            groups,
            build,
            warnings: self.grader.backend.weaknesses(),
            layers: active.map(|report| report.layer.name().to_owned()).collect(),
            wall,
            refuted,
        }
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
