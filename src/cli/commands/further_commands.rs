//! Suggests commands that show more about a scene that is not accepted. They repeat the user's own command line, for
//! that scene only.
use crate::{
    assignments::Assignment,
    cli::arguments::grade::GradeArguments as Arguments,
    report::untrusted_text::quote,
    suite::{Grade, SceneGrade, Submission, Verdict, config::Hints, library, plan::Plan},
};
use std::path::{Path, PathBuf};

/// The parts of the grading that the suggested commands repeat.
pub(super) struct FurtherCommands<'a> {
    pub(super) arguments: &'a Arguments,
    pub(super) plan: &'a Plan,
    pub(super) submissions: &'a [Submission],
    /// A function that returns the file in which a scene's trace is kept; `None` if traces are not kept.
    pub(super) trace: &'a dyn Fn(&str, &str) -> Option<PathBuf>,
}

impl FurtherCommands<'_> {
    /// Returns the suggested commands for a wrong scene, or for a submission in which none is wrong.
    pub(super) fn list_commands(&self, grade: &Grade, scene: Option<&SceneGrade>) -> Vec<String> {
        let Some(submission) = self.submissions.iter().find(|submission| submission.name == grade.submission) else {
            return Vec::new();
        };
        let is_whole = !self.arguments.failed && self.arguments.scene.is_empty();
        let Some(scene) = scene else {
            let submit = "The program is right on every scene of the suite: submit it.".to_owned();
            let lines = vec![if is_whole { submit } else { format!("$ {}", self.grade_command(submission)) }];
            return if grade.verdict.is_accepted() && self.submissions.len() == 1 { lines } else { Vec::new() };
        };
        let mut lines = Vec::new();
        let is_wrong_trace = scene.verdict.is_wrong_trace();
        let hints = if self.plan.staff_hints < Hints::Full && is_wrong_trace { " --hints full" } else { "" };
        let has_one_scene = self.plan.scenes().count() == 1;
        if !has_one_scene || !hints.is_empty() {
            lines.push(format!("$ {} --scene {}{hints}", self.grade_command(submission), quote(&scene.scene)));
        }
        let kept_trace = (self.trace)(&grade.submission, &scene.scene).filter(|trace| trace.exists());
        if let (Some(trace), Some(name)) = (kept_trace, self.scene_argument(&scene.scene)) {
            lines.push(format!("$ fosssim-oracle check {} {}", quote(&name), quote(&trace.to_string_lossy())));
        }
        let wrong = grade.scenes().filter(|scene| !scene.verdict.is_accepted()).count();
        let is_default = is_whole && self.arguments.suite == Assignment::DEFAULT.key();
        let ran = grade.scenes().filter(|scene| scene.verdict != Verdict::NotRun).count();
        if ran > 1 && wrong == grade.scenes().count() && is_default {
            let others = Assignment::ALL.into_iter().filter(|other| *other != Assignment::DEFAULT);
            let others: Vec<&str> = others.map(Assignment::key).collect();
            lines.push(format!("if this program belongs to another milestone: --suite {}", others.join(", ")));
        }
        if wrong > 1 && wrong < grade.scenes().count() && !self.arguments.failed && self.submissions.len() == 1 {
            lines.push(format!("$ {} --failed", self.grade_command(submission)));
        }
        lines
    }

    /// Returns the name of a scene in the form that `check` accepts; `None` if the scene cannot be named.
    fn scene_argument(&self, name: &str) -> Option<String> {
        let task = self.plan.scenes().find(|task| task.name == name)?;
        if library::find_scene(name).is_some_and(|embedded| embedded == task.xml) {
            return Some(format!("asset:{name}"));
        }
        let file = Path::new(&self.arguments.suite).with_file_name(format!("{name}.xml"));
        file.is_file().then(|| file.to_string_lossy().into_owned())
    }

    /// Returns the command that grades this submission with the same options.
    fn grade_command(&self, submission: &Submission) -> String {
        let Arguments { suite, rules, program, single, recorded, unsafe_no_sandbox, output, .. } = self.arguments;
        let path = match &submission.program {
            // The submission is an entry in a folder of programs.
            Some(entry) if !*single && submission.name.ends_with(entry.as_str()) => submission.path.join(entry),
            _ => submission.path.clone(),
        };
        let output = output.as_ref().filter(|_| self.submissions.len() == 1);
        let options = [
            (suite != Assignment::DEFAULT.key()).then(|| format!(" --suite {}", quote(suite))),
            rules.map(|_| format!(" --rules {}", self.plan.rules.name())),
            (program != "FOSSSim").then(|| format!(" --program {}", quote(program))),
            output.map(|output| format!(" --output {}", quote(&output.to_string_lossy()))),
            single.then(|| " --single".to_owned()),
            recorded.then(|| " --recorded".to_owned()),
            unsafe_no_sandbox.then(|| " --unsafe-no-sandbox".to_owned()),
        ];
        let options: String = options.into_iter().flatten().collect();
        format!("fosssim-oracle grade {}{options}", quote(&path.to_string_lossy()))
    }
}
