//! Completes the grade of a program that was run.
use crate::{
    config::Visibility,
    failure_cause::{FailureKind, Features, LocatedFailure, TriedScene, locate_failure},
    grade::Grade,
    grader::{SubmissionGrading, lock},
    guard::catch_panic,
    milestone,
    plan::PlannedGroup,
    program_file,
    result::{Reason, RunEnd, SceneResult},
    runner::Runner,
    score, skipped_scenes,
    smallest_scene::{
        DescribeSmallest, QUICK_LIMITS, Shrinker, SmallestScene, WrongScene, group_causes, shorten_limits,
    },
    staging::StagedProgram,
    verdict::Verdict,
};
use fosssim_mistakes::{
    diagnose::Explanation,
    together::{find_likely_mistakes, reconcile_explanations},
};
use fosssim_model::assignments::Assignment;

/// The maximum number of causes of a submission for which a smallest scene is searched for.
const MAX_CAUSES: usize = 4;

impl SubmissionGrading<'_> {
    /// Grades the results of all scenes, in the order of the plan. The flag of each result is true if it was reused.
    /// If the suite gives points for speed, the submission is timed first.
    pub(crate) fn grade(&self, mut results: Vec<(SceneResult, bool)>) -> Grade {
        let (plan, options) = (self.grader.plan, self.grader.options);
        // Discards scenes that ran in parallel with the one at which grading stopped. Otherwise the grade would depend
        // on the number of jobs.
        let verdicts_and_times: Vec<_> = results
            .iter()
            .map(|(result, _)| Some((result.verdict, result.measured.wall + result.measured.judging)))
            .collect();
        if let Some((end, reason)) =
            skipped_scenes::find_first_skipped(&plan.skip_limits, options.fail_fast, &verdicts_and_times)
        {
            for (result, scene) in results.iter_mut().zip(plan.scenes()).skip(end) {
                *result = (skipped_scenes::skipped_result(scene, reason), false);
            }
        }
        self.time_scenes(&mut results);
        let looks_like = self.infer_milestone(&results);
        let wall = results.iter().map(|(result, _)| result.measured.wall).sum();
        if self.grader.smallest.is_some() && results.iter().any(|(result, _)| is_wrong(result)) {
            drop(self.staged_program());
        }
        // When this value is dropped, the copy of the submission is removed.
        let staged = lock(&self.staged).take();
        let (program, build) = match staged.as_deref() {
            Some(Ok(staged)) => (staged.program_digest(), staged.build.clone()),
            Some(Err(_)) => (None, None),
            None => (self.digest(), None),
        };
        let mut warnings = self.grader.backend.weaknesses();
        if self.submission.file.as_ref().is_some_and(|file| file.is_shared && !file.has_other_owner) {
            warnings.push(program_file::SHARED_FILE.to_owned());
        }
        let is_visible = |group: &PlannedGroup| group.marking.visibility == Visibility::Visible;
        let active = self.grader.backend.layers().iter().filter(|report| report.active);
        let mut grade = Grade {
            rules: self.grader.effective_rules(),
            shows_output: plan.show_output || plan.groups.iter().all(is_visible),
            build,
            warnings,
            layers: active.map(|report| report.layer.name().to_owned()).collect(),
            wall,
            inferred_milestone: looks_like,
            program: program.map(|digest| digest.to_string()),
            ..score::build_grade(plan, self.submission.name.clone(), true, results)
        };
        if plan.staff_hints.explains() {
            grade.located_failure = find_failing_features(&grade, || self.shared.load_features(plan));
        }
        reconcile_explanations(&mut grade);
        if let (Some(show), Some(Ok(staged))) = (self.grader.smallest, staged.as_deref()) {
            // The grade must not be lost if this part panics.
            grade.smallest = catch_panic(|| self.find_smallest(&grade, staged, show)).unwrap_or_default();
        }
        grade
    }

    /// Finds the smallest scene for each cause. If scenes that students see show the cause, the smallest scene is made
    /// from them, so that it reveals nothing about others.
    fn find_smallest(&self, grade: &Grade, staged: &StagedProgram, show: &DescribeSmallest<'_>) -> Vec<SmallestScene> {
        let plan = self.grader.plan;
        let is_visible = |name: &str| {
            let groups = grade.groups.iter().filter(|group| group.visibility == Visibility::Visible);
            groups.flat_map(|group| &group.scenes).any(|scene| scene.scene == name)
        };
        let likely: Vec<Explanation> = find_likely_mistakes(grade).into_iter().map(|(mistake, _)| mistake).collect();
        let wrong = grade.scenes().zip(plan.scenes()).filter(|(scene, _)| is_wrong(scene));
        let wrong: Vec<WrongScene<'_>> = wrong
            .filter_map(|(scene, task)| {
                Some(WrongScene { task, explanations: &scene.explanations, ended: scene.ended.as_ref()? })
            })
            .collect();
        let Some(first) = plan.scenes().next() else { return Vec::new() };
        let limits = shorten_limits(&plan.limits);
        let shrinker = Shrinker {
            runner: Runner { limits: &limits, cards: None, ..self.new_runner(first, None) },
            program: &staged.program,
            assignment: plan.assignment(),
            limits: QUICK_LIMITS,
        };
        let mut causes = group_causes(&likely, &wrong);
        causes.truncate(MAX_CAUSES);
        for (_, tasks) in &mut causes {
            if tasks.iter().any(|task| is_visible(&task.name)) {
                tasks.retain(|task| is_visible(&task.name));
            }
        }
        shrinker.shrink_causes(causes, &|| ()).unwrap_or_default().iter().map(show).collect()
    }

    /// Infers the milestone for which the program was written, if the library of that milestone lacks features that the
    /// suite's milestone has. This is tried only if no scene is accepted and at least half of the scenes have no
    /// readable trace.
    fn infer_milestone(&self, results: &[(SceneResult, bool)]) -> Option<Assignment> {
        let expected = self.grader.plan.milestone?;
        let count =
            |has_verdict: fn(Verdict) -> bool| results.iter().filter(|(result, _)| has_verdict(result.verdict)).count();
        let unread = |verdict| matches!(verdict, Verdict::RuntimeError | Verdict::BadTrace | Verdict::NoOutput);
        if count(Verdict::is_accepted) > 0 || 2 * count(unread) < results.len() {
            return None;
        }
        let (staged, first) = (self.staged_program(), self.grader.plan.scenes().next()?);
        let program = &staged.as_ref().as_ref().ok()?.program;
        // The grade must not be lost if this part fails.
        let found = milestone::infer_milestone(&self.new_runner(first, None), program).ok().flatten();
        found.filter(|found| milestone::lacks(*found, expected))
    }
}

/// Returns whether a program was run on the scene and is wrong.
fn is_wrong(result: &SceneResult) -> bool {
    let is_grader_fault = matches!(result.verdict, Verdict::JudgeError | Verdict::NotRun | Verdict::Unusable);
    !is_grader_fault && !result.verdict.is_accepted() && result.ended.is_some()
}

/// Returns the features that all failing scenes have in common. `features` computes the features of all scenes, in
/// order. It is called only if some scenes fail and others do not.
fn find_failing_features<'a>(grade: &Grade, features: impl FnOnce() -> &'a [Features]) -> Option<LocatedFailure> {
    let failing = |ended: &Option<RunEnd>| ended.as_ref().and_then(FailureKind::from_end);
    let was_run = |reason: &Reason| !matches!(reason, Reason::Skipped(_) | Reason::Stopped | Reason::Failed(_));
    let run = || grade.scenes().filter(|scene| was_run(&scene.reason) && scene.ended.is_some());
    let failed_count = run().filter(|scene| failing(&scene.ended).is_some()).count();
    if failed_count == 0 || failed_count == run().count() {
        return None;
    }
    let scenes: Vec<TriedScene<'_>> = grade
        .scenes()
        .zip(features())
        .filter(|(scene, _)| was_run(&scene.reason) && scene.ended.is_some() && scene.verdict != Verdict::NotRun)
        .map(|(scene, features)| {
            let steps = match scene.reason {
                Reason::Program(reached) => reached.steps,
                _ => 0,
            };
            TriedScene { scene: &scene.scene, failure: failing(&scene.ended), steps, features }
        })
        .collect();
    locate_failure(&scenes)
}
