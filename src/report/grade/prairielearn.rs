//! PrairieLearn's results.json: a score in [0, 1]; `gradable: false` for faults of ours, which charge no attempt.
use super::{one_line, plain};
use crate::suite::{Grade, Verdict};
use serde::Serialize;

/// PrairieLearn refuses more than a megabyte; texts are cut long before.
const LONGEST_TEXT: usize = 4000;

#[derive(Serialize)]
struct Results {
    gradable: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    message: String,
    output: String,
    tests: Vec<Test>,
}

#[derive(Serialize)]
struct Test {
    name: String,
    description: String,
    points: f64,
    max_points: f64,
    message: String,
    output: String,
}

/// The results of one submission.
pub(super) fn render(grade: &Grade) -> String {
    let shown = grade.groups.iter().filter(|group| group.visibility == crate::suite::config::Visibility::Visible);
    let tests = shown
        .flat_map(|group| &group.scenes)
        .map(|scene| Test {
            name: one_line(&scene.scene),
            description: scene.verdict.words().to_owned(),
            points: scene.points,
            max_points: scene.max_points,
            message: cut(&scene.summary),
            output: cut(&scene.details.join("\n")),
        })
        .collect();
    let build = grade.build.as_ref().filter(|build| !build.succeeded);
    let results = Results {
        gradable: grade.points.is_some(),
        score: grade.points.map(|points| if grade.max_points > 0.0 { points / grade.max_points } else { 0.0 }),
        message: match grade.verdict {
            Verdict::JudgeError => "The grader failed; this attempt is not counted.".to_owned(),
            verdict => verdict.words().to_owned(),
        },
        output: build.map(|build| cut(&format!("{}\n{}", build.end, build.output))).unwrap_or_default(),
        tests,
    };
    let mut text = serde_json::to_string_pretty(&results).unwrap_or_default();
    text.push('\n');
    text
}

fn cut(text: &str) -> String {
    let text = plain(text);
    match text.char_indices().nth(LONGEST_TEXT) {
        Some((end, _)) => format!("{} [cut short]", &text[..end]),
        None => text,
    }
}
