//! Grades the traces of a submission with a suite, as `grade --traces` does.
use crate::{
    dropped::{PageHost, PageProgress, ReadFault, open},
    parts::PageAnswer,
};
use fosssim_grading::{
    SceneGrade, SceneResult, Verdict,
    plan::{self, MatchingScenes, Plan, PlannedGroup},
    result::Reason,
    traces,
};
use fosssim_mistakes::{
    diagnose::{Explanation, is_named_in},
    together::disclosure::limit_result,
};
use fosssim_report::{grade, words};
use serde::Deserialize;
use serde_json::{Value, json};
use std::io::{Read, empty};

/// The request to begin grading a submission with a suite. Scenes that the suite names as files were dropped together
/// with it. `scenes` has their names as the suite may write them, in the order of the parts after the suite's text.
#[derive(Debug, Deserialize)]
pub(crate) struct SuiteRequest {
    /// The name of an embedded suite; `None` if its text was dropped.
    suite: Option<String>,
    /// The names of the dropped scenes.
    #[serde(default)]
    scenes: Vec<String>,
    /// Whether the suite's hints limit the output, as in `grade --for student`. True if the course made the page for
    /// students.
    #[serde(default)]
    is_for_students: bool,
}

/// The request to judge one scene.
#[derive(Debug, Deserialize)]
pub(crate) struct SceneRequest {
    /// The index of the scene among the suite's scenes.
    number: usize,
    /// Whether there is a trace. It is the dropped file with the number 0.
    has_trace: bool,
}

/// A submission that is being graded, and its results so far.
#[derive(Debug)]
pub(crate) struct UploadedSubmission {
    plan: Plan,
    is_for_students: bool,
    results: Vec<Option<SceneResult>>,
}

impl UploadedSubmission {
    /// Reads the suite. Returns its groups, and the names of their scenes, in order.
    pub(crate) fn from_request(request: &SuiteRequest, parts: &[&[u8]]) -> Result<(Value, Self), String> {
        let name = request.suite.clone().unwrap_or_else(plan::default_name);
        let (text, dropped) = match (&request.suite, parts.split_first()) {
            (None, Some((text, dropped))) => {
                (std::str::from_utf8(text).map_err(|_| "the suite is not UTF-8")?, dropped)
            }
            _ => {
                let text = plan::find_built_in_suite(&name).ok_or_else(|| {
                    let names = plan::built_in_names().collect::<Vec<_>>().join(", ");
                    format!("there is no suite {name} among {names}{}", plan::suggest(&name))
                })?;
                (text, &[][..])
            }
        };
        let mut files = |pattern: &str| find_matching_scenes(pattern, &request.scenes, dropped);
        let plan = plan::load_with(text, &mut files).map_err(|error| {
            error.problems.iter().map(|(at, message)| format!("suite.toml:{at}: {message}\n")).collect::<String>()
        })?;
        let group = |group: &PlannedGroup| -> Value {
            let scenes: Vec<&str> = group.scenes.iter().map(|task| task.name.as_str()).collect();
            json!({ "name": group.name, "points": group.marking.points, "scenes": scenes })
        };
        let groups: Vec<Value> = plan.groups.iter().map(group).collect();
        let results = vec![None; plan.scenes().count()];
        let is_for_students = request.is_for_students;
        Ok((json!({ "suite": plan.name, "groups": groups }), Self { plan, is_for_students, results }))
    }

    /// Judges the trace of one scene.
    pub(crate) fn judge_scene(&mut self, request: &SceneRequest, host: &dyn PageHost) -> PageAnswer {
        let task = self.plan.scenes().nth(request.number).ok_or("the suite has no scene with this number")?;
        let fault = ReadFault::new();
        let trace: Box<dyn Read + Send> = match request.has_trace {
            true => Box::new(open(host, 0, &fault).take(self.plan.limits.trace)),
            false => Box::new(empty()),
        };
        let mut progress = PageProgress { host, all: task.scene.step_count() };
        let (mut result, _) = traces::judge_trace(&self.plan, task, trace, &mut progress);
        if let Some(error) = fault.get() {
            return Err(format!("cannot read the trace of {}: {error}", task.name));
        }
        if self.is_for_students {
            limit_result(self.plan.student_hints(&task.name), &mut result);
        }
        let value = json!({
            "verdict": result.verdict.name(),
            "accepted": result.verdict == Verdict::Accepted,
            "isMissing": matches!(result.reason, Reason::NoTrace),
            "right": result.right_steps,
            "steps": result.steps,
            "why": words::summarize(&result),
        });
        self.results[request.number] = Some(result);
        Ok((value, Vec::new()))
    }

    /// Computes the grade from the results of all scenes. The second part of the answer is what `grade --traces
    /// --format json` prints.
    pub(crate) fn finish_submission(&self, name: &str) -> PageAnswer {
        let results: Option<Vec<SceneResult>> = self.results.iter().cloned().collect();
        let results = results.ok_or("not all scenes have been judged")?;
        let graded = traces::grade(&self.plan, name.to_owned(), results, Vec::new());
        let points = |points, max_points| {
            let (points, max_points) = (grade::format_optional_points(points), grade::format_points(max_points));
            json!({ "points": points, "of": max_points })
        };
        let scene_view = |scene: &SceneGrade| -> Value {
            let likely = scene.corrected_explanations.first().map(|mistake| grade::describe_in_scene(scene, mistake));
            let mut view = points(scene.points, scene.max_points);
            view["likely"] = json!(likely);
            view
        };
        let scenes: Vec<Value> = graded.scenes().map(scene_view).collect();
        let groups: Vec<Value> = graded.groups.iter().map(|group| points(group.points, group.max_points)).collect();
        let cause_view = |scenes: &grade::AlikeScenes<'_>| -> Value {
            let names: Vec<&str> = scenes.iter().map(|scene| scene.scene.as_str()).collect();
            let likely = scenes[0].corrected_explanations.iter();
            let likely: Vec<String> = likely.map(|mistake| grade::describe_in_scene(scenes[0], mistake)).collect();
            let summary = if likely.is_empty() { words::summarize(scenes[0]) } else { likely.join(" ") };
            json!({ "words": summary, "scenes": names })
        };
        let unfit = words::describe_unfit(&graded);
        let likely = if unfit.is_some() { Vec::new() } else { grade::find_likely_mistakes(&graded) };
        // A scene with two mistakes is listed with both.
        let mistake_view = |(mistake, _): &(Explanation, usize)| -> Value {
            let clearest = grade::clearest_scene(&graded, mistake).map(|scene| &scene.scene);
            let named_scenes = graded.scenes().filter(|scene| is_named_in(mistake, &scene.explanations));
            let others = named_scenes.map(|scene| &scene.scene).filter(|name| Some(*name) != clearest);
            let (what, worth) = (grade::describe_likely(&graded, mistake), grade::describe_worth(&graded, mistake));
            json!({ "words": what, "worth": worth, "scenes": clearest.into_iter().chain(others).collect::<Vec<_>>() })
        };
        let is_likely =
            |scene: &&SceneGrade| likely.iter().any(|(mistake, _)| is_named_in(mistake, &scene.explanations));
        let is_cause = |scenes: &&grade::AlikeScenes<'_>| {
            !scenes.iter().all(is_likely) && (!scenes[0].corrected_explanations.is_empty() || scenes.len() > 1)
        };
        let others = grade::group_by_cause(&graded);
        let others = others.iter().filter(is_cause).map(cause_view);
        let causes: Vec<Value> = likely.iter().map(mistake_view).chain(others).collect();
        let value = json!({
            "causes": causes,
            "points": grade::format_optional_points(graded.points),
            "of": grade::format_points(graded.max_points),
            "verdict": graded.verdict.name(),
            "unfit": unfit,
            "scenes": scenes,
            "groups": groups,
        });
        Ok((value, vec![grade::json(&[graded]).into_bytes()]))
    }
}

/// Returns the dropped scenes that a pattern matches. It is compared with their paths relative to the suite.
fn find_matching_scenes(pattern: &str, names: &[String], files: &[&[u8]]) -> Result<MatchingScenes, String> {
    let glob = glob::Pattern::new(pattern).map_err(|error| format!("pattern {pattern}: {error}"))?;
    let found: MatchingScenes = names
        .iter()
        .zip(files)
        .filter(|(name, _)| glob.matches(name))
        .map(|(name, xml)| (name.strip_suffix(".xml").unwrap_or(name).to_owned(), xml.to_vec()))
        .collect();
    if found.is_empty() {
        return Err(format!("no scene file matches {pattern}: drop the folder of the suite with its scenes"));
    }
    Ok(found)
}
