//! PrairieLearn's results.json: a score from 0 to 1. If the grader failed, or the upload has no program that can be
//! run, `gradable` is false, and the upload does not count as an attempt.
use super::{describe_difference, describe_repeated_reason, describe_speed, format_score, head_lines, scene_lines};
use crate::untrusted_text::{clean_output, strip_control_characters, to_one_line};
use crate::{style::Style, view::to_document, words};
use fosssim_findings::{Grade, SceneGrade, Verdict};
use fosssim_mistakes::together::immediate_grade;
use serde::Serialize;

/// The maximum length of a text, in characters. PrairieLearn accepts up to a megabyte.
const MAX_TEXT_LENGTH: usize = 4000;

#[derive(Serialize)]
struct Results {
    gradable: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    message: String,
    output: String,
    groups: Vec<Group>,
    tests: Vec<Test>,
}

/// A group of the suite, in the form that the PrairieLearn element `fosssim-report` reads
/// (`integrations/prairielearn`).
#[derive(Serialize)]
struct Group {
    name: String,
    verdict: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<f64>,
    max_points: f64,
}

#[derive(Serialize)]
struct Test {
    name: String,
    group: String,
    description: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<f64>,
    max_points: f64,
    message: String,
    output: String,
}

/// Renders the results of one submission.
pub(crate) fn render(grade: &Grade) -> String {
    let visible_grade = immediate_grade(grade);
    let mut scenes: Vec<_> =
        visible_grade.groups.iter().flat_map(|group| group.scenes.iter().map(move |scene| (group, scene))).collect();
    scenes.sort_by_key(|(_, scene)| scene.verdict.is_accepted());
    let tests = scenes
        .into_iter()
        .map(|(group, scene)| Test {
            name: to_one_line(&scene.scene),
            group: to_one_line(&group.name),
            description: scene.verdict.name().to_owned(),
            points: scene.points,
            max_points: scene.max_points,
            message: if grade.submission_fault().is_some() {
                describe_repeated_reason(scene).to_owned()
            } else {
                truncate(&words::summarize(scene))
            },
            output: truncate(&describe_scene(scene)),
        })
        .chain(visible_grade.groups.iter().filter_map(|group| Some((group, group.speed.as_ref()?))).map(
            |(group, speed)| Test {
                name: format!("speed ({})", to_one_line(&group.name)),
                group: to_one_line(&group.name),
                description: "processor time compared with the reference's".to_owned(),
                points: speed.points,
                max_points: speed.marking.points,
                message: truncate(&describe_speed(speed)),
                output: String::new(),
            },
        ))
        .collect();
    let build = grade.failed_build();
    // A fault of the whole upload applies to all groups.
    let head = match build {
        Some(_) => Vec::new(),
        None if grade.submission_fault().is_some() => head_lines(grade),
        None => head_lines(&visible_grade),
    };
    let is_gradable = grade.points.is_some() && grade.verdict != Verdict::Unusable;
    let results = Results {
        gradable: is_gradable,
        score: grade
            .points
            .filter(|_| is_gradable)
            .map(|points| if grade.max_points > 0.0 { points / grade.max_points } else { 0.0 }),
        message: match grade.verdict {
            Verdict::JudgeError => "The grader failed; this attempt is not counted.".to_owned(),
            _ if grade.is_incomplete() => "Grading was stopped before its end; this attempt is not counted.".to_owned(),
            // The verdict must not reveal results of groups that students do not see.
            verdict if visible_grade.groups.len() == grade.groups.len() => verdict.name().to_owned(),
            _ => format!(
                "{} on the tests shown here ({}); other tests are hidden",
                visible_grade.verdict,
                format_score(visible_grade.points.unwrap_or_default(), visible_grade.max_points)
            ),
        },
        output: grade
            .warnings
            .iter()
            .map(|warning| format!("warning: {warning}"))
            .chain(head)
            .chain(build.map(|build| format!("{}\n{}", words::build(&build.end), clean_output(&build.output))))
            .map(|text| truncate(&text))
            .collect::<Vec<_>>()
            .join("\n"),
        groups: visible_grade
            .groups
            .iter()
            .map(|group| Group {
                name: to_one_line(&group.name),
                verdict: group.verdict.name().to_owned(),
                points: group.points,
                max_points: group.max_points,
            })
            .collect(),
        tests,
    };
    to_document(&results)
}

/// Returns everything about a scene that follows its summary.
fn describe_scene(scene: &SceneGrade) -> String {
    let mut lines: Vec<String> = describe_difference(scene).into_iter().collect();
    lines.extend(words::list_details(scene));
    lines.extend(scene_lines(scene, Style::Plain));
    lines.join("\n")
}

fn truncate(text: &str) -> String {
    let text = strip_control_characters(text);
    match text.char_indices().nth(MAX_TEXT_LENGTH) {
        Some((end, _)) => format!("{} [cut short]", &text[..end]),
        None => text,
    }
}
