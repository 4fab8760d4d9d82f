//! Our own JSON (`schemas/grade.schema.json`): everything a grade holds.
use super::{super::explain::ExplanationView, phrases::NOT_GRADED, plain, printed, speed_words};
use crate::{check::cause_view, view::document, words};
use fosssim_findings::{
    Book, Grade, GroupGrade, PassedOver, Rules, SceneGrade, Visibility,
    speed::{SpeedGrade, SpeedSource},
};
use fosssim_mistakes::together::{likely_mistake, likely_mistakes};
use serde::Serialize;

/// The version of the schema; it rises when a reader of the old one would misunderstand the new one.
const SCHEMA: u32 = 4;

#[derive(Serialize)]
struct GradeDocument {
    schema: u32,
    version: &'static str,
    grades: Vec<GradeView>,
    /// Entries of the class that are no submissions; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    passed_over: Vec<PassedOver>,
}

#[derive(Serialize)]
struct GradeView {
    submission: String,
    suite: String,
    rules: Rules,
    /// The book that gives verdicts and points.
    official: Book,
    verdict: &'static str,
    code: &'static str,
    /// `null` when the grader failed or was stopped: that is nobody's zero.
    points: Option<f64>,
    max_points: f64,
    wall_seconds: f64,
    sandbox: Vec<String>,
    warnings: Vec<String>,
    build: Option<BuildView>,
    /// The contents that the scenes have in common in which the program crashes or runs into a limit.
    located: Option<LocatedView>,
    /// The mistake that explains most wrong scenes, where several have explanations.
    likely_mistake: Option<ExplanationView>,
    /// Up to three mistakes that explain the wrong scenes together.
    likely_mistakes: Vec<ExplanationView>,
    groups: Vec<GroupView>,
}

#[derive(Serialize)]
struct LocatedView {
    text: String,
    failed: usize,
    with: usize,
    without: usize,
    first_scene: String,
    last_complete_step: u32,
}

#[derive(Serialize)]
struct BuildView {
    succeeded: bool,
    end: String,
    output: String,
}

#[derive(Serialize)]
struct GroupView {
    name: String,
    visibility: Visibility,
    verdict: &'static str,
    points: Option<f64>,
    max_points: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<SpeedView>,
    scenes: Vec<SceneView>,
}

#[derive(Serialize)]
struct SpeedView {
    points: Option<f64>,
    max_points: f64,
    text: String,
    ratio: Option<f64>,
    least_ratio: Option<f64>,
    greatest_ratio: Option<f64>,
    runs: u32,
}

#[derive(Serialize)]
struct SceneView {
    scene: String,
    verdict: &'static str,
    code: &'static str,
    summary: String,
    difference: Option<serde_json::Value>,
    details: Vec<String>,
    explanations: Vec<ExplanationView>,
    points: Option<f64>,
    max_points: f64,
    right_steps: u32,
    steps: u32,
    cpu_seconds: f64,
    wall_seconds: f64,
    memory_bytes: Option<u64>,
    stdout: String,
    stderr: String,
    cached: bool,
}

/// All grades in one document.
pub(super) fn render(grades: &[Grade], passed_over: &[PassedOver]) -> String {
    let (grades, passed_over) = (grades.iter().map(view).collect(), passed_over.iter().map(passed).collect());
    document(&GradeDocument { schema: SCHEMA, version: env!("CARGO_PKG_VERSION"), grades, passed_over })
}

fn passed(entry: &PassedOver) -> PassedOver {
    PassedOver { name: plain(&entry.name), why: plain(&entry.why) }
}

/// A line per grade, and one per entry that is no submission, which has no points either.
#[must_use]
pub fn lines(grades: &[Grade], passed_over: &[PassedOver]) -> String {
    let grades = grades.iter().map(|grade| serde_json::to_string(&view(grade)));
    let passed_over = passed_over.iter().map(|entry| {
        let PassedOver { name, why } = passed(entry);
        let line = serde_json::json!({ "submission": name, "verdict": NOT_GRADED, "points": null, "reason": why });
        serde_json::to_string(&line)
    });
    grades.chain(passed_over).map(|line| line.unwrap_or_default() + "\n").collect()
}

fn view(grade: &Grade) -> GradeView {
    GradeView {
        submission: plain(&grade.submission),
        suite: plain(&grade.suite),
        rules: grade.rules,
        official: grade.rules.official(),
        verdict: grade.verdict.words(),
        code: grade.verdict.code(),
        points: grade.points,
        max_points: grade.max_points,
        wall_seconds: grade.wall.as_secs_f64(),
        sandbox: grade.layers.clone(),
        warnings: grade.warnings.iter().map(|warning| plain(warning)).collect(),
        build: grade.build.as_ref().map(|build| BuildView {
            succeeded: build.end.is_success(),
            end: plain(&words::build(&build.end)),
            output: printed(&build.output),
        }),
        located: grade.located.as_ref().map(|found| LocatedView {
            text: plain(&words::located(found)),
            failed: found.failed,
            with: found.with,
            without: found.without,
            first_scene: plain(&found.first),
            last_complete_step: found.step,
        }),
        likely_mistake: likely_mistake(grade).as_ref().map(ExplanationView::from),
        likely_mistakes: likely_mistakes(grade).iter().map(|(mistake, _)| ExplanationView::from(mistake)).collect(),
        groups: grade.groups.iter().map(group).collect(),
    }
}

fn group(group: &GroupGrade) -> GroupView {
    GroupView {
        name: plain(&group.name),
        visibility: group.visibility,
        verdict: group.verdict.words(),
        points: group.points,
        max_points: group.max_points,
        speed: group.speed.as_ref().map(speed),
        scenes: group.scenes.iter().map(scene).collect(),
    }
}

fn speed(speed: &SpeedGrade) -> SpeedView {
    let measured = match speed.source {
        SpeedSource::Measured(measured) => Some(measured),
        _ => None,
    };
    SpeedView {
        points: speed.points,
        max_points: speed.marking.points,
        text: plain(&speed_words(speed)),
        ratio: measured.map(|measured| measured.ratio),
        least_ratio: measured.map(|measured| measured.least),
        greatest_ratio: measured.map(|measured| measured.most),
        runs: measured.map_or(0, |measured| measured.runs),
    }
}

fn scene(scene: &SceneGrade) -> SceneView {
    SceneView {
        scene: plain(&scene.scene),
        verdict: scene.verdict.words(),
        code: scene.verdict.code(),
        summary: plain(&words::summary(scene)),
        difference: scene.differs.map(cause_view),
        details: words::details(scene).iter().map(|detail| plain(detail)).collect(),
        explanations: scene.settled.iter().map(ExplanationView::from).collect(),
        points: scene.points,
        max_points: scene.max_points,
        right_steps: scene.right_steps,
        steps: scene.steps,
        cpu_seconds: scene.measured.cpu.as_secs_f64(),
        wall_seconds: scene.measured.wall.as_secs_f64(),
        memory_bytes: scene.measured.memory,
        stdout: printed(&scene.stdout),
        stderr: printed(&scene.stderr),
        cached: scene.cached,
    }
}
