//! The file results.json for Gradescope. If the grader failed, the file has no score: the harness then exits with an
//! error instead of giving zero points.
use super::{describe_difference, describe_repeated_reason, describe_speed, format_points, head_lines, scene_lines};
use crate::untrusted_text::{clean_output, strip_control_characters};
use crate::{number::format_count, style::Style, view::to_document, words};
use fosssim_findings::{
    Grade, SceneGrade, Verdict, Visibility,
    speed::{SpeedGrade, SpeedSource},
};
use fosssim_mistakes::together::immediate_grade;
use serde::Serialize;
use std::{borrow::Cow, fmt::Write};

#[derive(Serialize)]
struct Results {
    #[serde(skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    execution_time: Option<u64>,
    output: String,
    output_format: &'static str,
    test_output_format: &'static str,
    test_name_format: &'static str,
    stdout_visibility: &'static str,
    tests: Vec<Test>,
    extra_data: Extra,
}

#[derive(Serialize)]
struct Test {
    #[serde(skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    max_score: f64,
    status: &'static str,
    name: String,
    number: String,
    output: String,
    tags: Vec<String>,
    visibility: Visibility,
}

#[derive(Serialize)]
struct Extra {
    verdict: &'static str,
    suite: String,
    version: &'static str,
    sandbox: Vec<String>,
}

/// Renders the results of one submission.
pub(crate) fn render(grade: &Grade) -> String {
    let mut tests = Vec::new();
    let tells_all = grade.shows_output || grade.is_visible();
    for (g, group) in grade.groups.iter().enumerate() {
        for (s, scene) in group.scenes.iter().enumerate() {
            tests.push(Test {
                // Without an explicit score, Gradescope would add up the scores of the tests.
                score: grade.points.and(scene.points).map(round_points),
                max_score: round_points(scene.max_points),
                status: if scene.verdict.is_accepted() { "passed" } else { "failed" },
                name: format!("{} ({})", strip_control_characters(&scene.scene), strip_control_characters(&group.name)),
                number: format!("{}.{}", g + 1, s + 1),
                output: match grade.submission_fault() {
                    Some(_) => format!("{}: {}", scene.verdict, describe_repeated_reason(scene)),
                    // Only staff see this test, so it may show everything.
                    None if tells_all || group.visibility == Visibility::Hidden => describe_scene(scene),
                    None => {
                        let mut scene = scene.clone();
                        scene.withhold();
                        describe_scene(&scene)
                    }
                },
                tags: vec![scene.verdict.code().to_owned()],
                visibility: group.visibility,
            });
        }
        if let Some(speed) = &group.speed {
            let output = match tells_all || group.visibility == Visibility::Hidden {
                true => describe_speed(speed),
                false => describe_speed(&SpeedGrade { source: SpeedSource::Withheld, ..speed.clone() }),
            };
            tests.push(Test {
                score: grade.points.and(speed.points).map(round_points),
                max_score: round_points(speed.marking.points),
                status: if speed.points == Some(speed.marking.points) { "passed" } else { "failed" },
                name: format!("speed ({})", strip_control_characters(&group.name)),
                number: format!("{}.{}", g + 1, group.scenes.len() + 1),
                output: strip_control_characters(&output),
                tags: vec!["speed".to_owned()],
                visibility: group.visibility,
            });
        }
    }
    let results = Results {
        score: grade.points.map(round_points),
        execution_time: tells_all.then_some(grade.wall.as_secs()),
        output: describe_grade(grade),
        output_format: "text",
        test_output_format: "text",
        test_name_format: "text",
        stdout_visibility: "hidden",
        tests,
        extra_data: Extra {
            verdict: grade.verdict.name(),
            suite: strip_control_characters(&grade.suite),
            version: env!("CARGO_PKG_VERSION"),
            sandbox: grade.layers.clone(),
        },
    };
    to_document(&results)
}

fn describe_grade(grade: &Grade) -> String {
    // Every reader sees this text immediately, so it must not describe groups that some readers do not see.
    let all_visible = grade.is_visible();
    let mut lines = vec![match grade.points {
        Some(_) if !all_visible => "Graded.".to_owned(),
        Some(reached) => {
            format!("{}: {} of {} points.", grade.verdict, format_points(reached), format_points(grade.max_points))
        }
        None if grade.is_grader_fault() => {
            "The grader failed. This is not your fault and costs no points. Staff must check it.".to_owned()
        }
        None => describe_timeout(grade),
    }];
    if let Some(build) = grade.failed_build() {
        lines.push(format!("{}\n{}", strip_control_characters(&words::build(&build.end)), clean_output(&build.output)));
    } else {
        // A fault of the whole upload does not reveal anything about hidden scenes.
        let visible_grade =
            if grade.submission_fault().is_some() { Cow::Borrowed(grade) } else { immediate_grade(grade) };
        lines.extend(head_lines(&visible_grade).iter().map(|line| strip_control_characters(line)));
    }
    lines.extend(grade.warnings.iter().map(|warning| format!("Warning: {}", strip_control_characters(warning))));
    lines.join("\n")
}

/// Returns the message to a student whose grading was stopped at the platform's time limit. It names the scenes that
/// used most of the time.
fn describe_timeout(grade: &Grade) -> String {
    let missing = grade.count_verdict(Verdict::NotRun);
    let mut text = format!(
        "Grading was stopped at its time limit. {missing} of {} have no result, so there is no score yet.",
        format_count(grade.scenes().count() as u64, "scene")
    );
    let scenes = grade.groups.iter().flat_map(|group| group.scenes.iter().map(move |scene| (group, scene)));
    let longest = scenes.max_by_key(|(_, scene)| scene.measured.wall);
    if let Some((group, longest)) = longest.filter(|(_, scene)| !scene.measured.wall.is_zero())
        && (grade.shows_output || grade.is_visible())
    {
        let _ = write!(text, " Your program took {:.1} s", grade.wall.as_secs_f64());
        let (seconds, scene, summary) = (
            longest.measured.wall.as_secs_f64(),
            strip_control_characters(&longest.scene),
            strip_control_characters(&words::summarize(longest)),
        );
        let _ = match group.visibility {
            Visibility::Visible => write!(text, ", {seconds:.1} s of it in scene {scene}: {summary}."),
            _ => write!(text, ", {seconds:.1} s of it in one scene."),
        };
    }
    text
}

fn describe_scene(scene: &SceneGrade) -> String {
    let mut lines = vec![format!("{}: {}", scene.verdict, strip_control_characters(&words::summarize(scene)))];
    lines.extend(describe_difference(scene));
    lines.extend(words::list_details(scene).iter().map(|detail| strip_control_characters(detail)));
    lines.extend(scene_lines(scene, Style::Plain).iter().map(|line| strip_control_characters(line)));
    if scene.verdict >= Verdict::NoOutput && !scene.stderr.is_empty() {
        lines.push(format!("The program's standard error:\n{}", clean_output(&scene.stderr)));
    }
    lines.join("\n")
}

/// Rounds points to six decimals, so that the shares of a group's scenes add up to the group's points.
fn round_points(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
