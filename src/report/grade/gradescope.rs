//! Gradescope's results.json. A fault of ours has no score: the harness exits with an error instead of a zero.
use super::{super::explain, difference, likely_mistake, plain, points};
use crate::suite::{Grade, SceneGrade, Verdict, config::Visibility};
use serde::Serialize;

#[derive(Serialize)]
struct Results {
    #[serde(skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    execution_time: u64,
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
    visibility: &'static str,
}

#[derive(Serialize)]
struct Extra {
    verdict: &'static str,
    suite: String,
    version: &'static str,
    sandbox: Vec<String>,
}

/// The results of one submission.
pub(super) fn render(grade: &Grade) -> String {
    let mut tests = Vec::new();
    for (g, group) in grade.groups.iter().enumerate() {
        for (s, scene) in group.scenes.iter().enumerate() {
            tests.push(Test {
                score: (scene.verdict != Verdict::JudgeError).then_some(rounded(scene.points)),
                max_score: rounded(scene.max_points),
                status: if scene.verdict.is_accepted() { "passed" } else { "failed" },
                name: format!("{} ({})", plain(&scene.scene), plain(&group.name)),
                number: format!("{}.{}", g + 1, s + 1),
                output: output(scene),
                tags: vec![scene.verdict.code().to_owned()],
                visibility: group.visibility.key(),
            });
        }
    }
    let results = Results {
        score: grade.points.map(rounded),
        execution_time: grade.wall.as_secs(),
        output: overall(grade),
        output_format: "text",
        test_output_format: "text",
        test_name_format: "text",
        stdout_visibility: "hidden",
        tests,
        extra_data: Extra {
            verdict: grade.verdict.words(),
            suite: plain(&grade.suite),
            version: env!("CARGO_PKG_VERSION"),
            sandbox: grade.layers.clone(),
        },
    };
    let mut text = serde_json::to_string_pretty(&results).unwrap_or_default();
    text.push('\n');
    text
}

fn overall(grade: &Grade) -> String {
    // What everybody reads at once says nothing about groups that not everybody sees.
    let all_visible = grade.groups.iter().all(|group| group.visibility == Visibility::Visible);
    let mut lines = vec![match grade.points {
        Some(_) if !all_visible => "Graded.".to_owned(),
        Some(reached) => format!("{}: {} of {} points.", grade.verdict, points(reached), points(grade.max_points)),
        None => "The grader failed; this is not your fault and costs nothing. Staff has to look at it.".to_owned(),
    }];
    if let Some(build) = grade.build.as_ref().filter(|build| !build.succeeded) {
        lines.push(format!("{}\n{}", plain(&build.end), plain(&build.output)));
    }
    if all_visible {
        lines.extend(likely_mistake(grade).map(|line| plain(&line)));
    }
    lines.extend(grade.warnings.iter().map(|warning| format!("Warning: {}", plain(warning))));
    lines.join("\n")
}

fn output(scene: &SceneGrade) -> String {
    let mut lines = vec![format!("{}: {}", scene.verdict, plain(&scene.summary))];
    lines.extend(difference(scene));
    lines.extend(scene.details.iter().map(|detail| plain(detail)));
    lines.extend(explain::lines(&scene.explanations).iter().map(|line| plain(line)));
    if scene.verdict >= Verdict::NoOutput && !scene.stderr.is_empty() {
        lines.push(format!("The program's error output:\n{}", plain(&scene.stderr)));
    }
    lines.join("\n")
}

/// Points with six decimals at most, so that shares of a group add up to what is shown.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
