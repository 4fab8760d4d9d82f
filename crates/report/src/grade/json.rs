//! Our own JSON (`schemas/grade.schema.json`): everything a grade holds.
use super::{super::explain::ExplanationView, phrases::NOT_GRADED, speed_words};
use crate::foreign::{plain, printed};
use crate::{check::CauseView, view::document, words};
use fosssim_findings::Verdict;
use fosssim_findings::{
    Book, Grade, GroupGrade, PassedOver, Rules, SceneGrade, Visibility,
    speed::{SpeedGrade, SpeedSource},
};
use fosssim_mistakes::together::{likely_mistake, likely_mistakes};
use serde::Serialize;

/// The version of the schema; it rises when a reader of the old one would misunderstand the new one.
const SCHEMA: u32 = 4;

/// The document of `grade --format json`. The number in `schema` rises when a reader of the old one would misunderstand
/// the new one.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(crate) struct GradeDocument {
    /// The version of this shape.
    #[schemars(extend("const" = SCHEMA))]
    schema: u32,
    /// The version of the program.
    version: &'static str,
    /// The submissions.
    grades: Vec<GradeView>,
    /// Entries of the class's folder that are no submissions; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    passed_over: Vec<PassedOver>,
}

/// The grade of a submission.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct GradeView {
    /// The submission's name.
    submission: String,
    /// The suite's name.
    suite: String,
    /// The rule books that were asked.
    rules: Rules,
    /// The book that gives verdicts and points.
    official: Book,
    /// The worst verdict of all scenes.
    #[schemars(extend("enum" = Verdict::ALL.map(Verdict::words)))]
    verdict: &'static str,
    /// The same in short.
    #[schemars(extend("enum" = Verdict::ALL.map(Verdict::code)))]
    code: &'static str,
    /// Null when the grader failed or was stopped: that is nobody's zero.
    #[schemars(range(min = 0.0))]
    points: Option<f64>,
    /// Points that can be reached.
    #[schemars(range(min = 0.0))]
    max_points: f64,
    /// The wall time of all runs together.
    #[schemars(range(min = 0.0))]
    wall_seconds: f64,
    /// Layers of the sandbox that were active.
    sandbox: Vec<String>,
    /// Weaknesses of the sandbox.
    warnings: Vec<String>,
    /// How the build ended; null where the suite builds nothing.
    build: Option<BuildView>,
    /// The contents that the scenes have in common in which the program crashes or runs into a limit; null where
    /// nothing is known.
    located: Option<LocatedView>,
    /// The mistake that explains most wrong scenes, where several have explanations.
    likely_mistake: Option<ExplanationView>,
    /// Up to three mistakes that explain the wrong scenes together, the one that explains most first.
    #[schemars(length(max = 3))]
    likely_mistakes: Vec<ExplanationView>,
    /// The groups in the suite's order.
    groups: Vec<GroupView>,
}

/// The scenes in which a program fails.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct LocatedView {
    /// The whole in words.
    text: String,
    /// Scenes in which the program fails.
    failed: usize,
    /// Of these, scenes that have the contents.
    with: usize,
    /// Scenes that have the contents, and in which it does not fail.
    without: usize,
    /// The first scene in which it fails.
    first_scene: String,
    /// The last step of that scene that its trace holds whole.
    last_complete_step: u32,
}

/// The build step's end.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BuildView {
    /// Whether there is a program.
    succeeded: bool,
    /// How it ended, in words.
    end: String,
    /// The compiler's output, cut where it is long.
    output: String,
}

/// A group of scenes.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct GroupView {
    /// Its name.
    name: String,
    /// The readers who see it.
    visibility: Visibility,
    /// The worst verdict of its scenes.
    #[schemars(extend("enum" = Verdict::ALL.map(Verdict::words)))]
    verdict: &'static str,
    /// Points reached, those for speed included; null where a scene has none.
    #[schemars(range(min = 0.0))]
    points: Option<f64>,
    /// Points that can be reached.
    #[schemars(range(min = 0.0))]
    max_points: f64,
    /// True where its points count neither in the sum nor in the maximum of the grade; left out elsewhere.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    extra: bool,
    /// Points for speed, which are part of the group's points; left out where the suite gives none.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<SpeedView>,
    /// Its scenes.
    scenes: Vec<SceneView>,
}

/// Points for speed.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct SpeedView {
    /// Points reached; null when the grader could not measure.
    #[schemars(range(min = 0.0))]
    points: Option<f64>,
    /// Points that can be reached.
    #[schemars(range(min = 0.0))]
    max_points: f64,
    /// The measurement in words.
    text: String,
    /// The submission's processor time, divided by the reference's: of the least times.
    #[schemars(range(min = 0.0))]
    ratio: Option<f64>,
    /// The least ratio of a round of runs.
    #[schemars(range(min = 0.0))]
    least_ratio: Option<f64>,
    /// The greatest ratio of a round of runs.
    #[schemars(range(min = 0.0))]
    greatest_ratio: Option<f64>,
    /// Rounds of runs.
    runs: u32,
}

/// A scene of a grade.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct SceneView {
    /// Its name.
    scene: String,
    /// Its verdict.
    #[schemars(extend("enum" = Verdict::ALL.map(Verdict::words)))]
    verdict: &'static str,
    /// The same in short.
    #[schemars(extend("enum" = Verdict::ALL.map(Verdict::code)))]
    code: &'static str,
    /// The reason for the verdict, in one line.
    summary: String,
    /// The reason why the two rule books judge the scene differently; null where they do not.
    difference: Option<CauseView>,
    /// Where the trace diverges first, and how many findings there are of each kind, as far as hints allow.
    details: Vec<String>,
    /// Likely mistakes, the likeliest first, as far as hints allow.
    explanations: Vec<ExplanationView>,
    /// Points reached; null when the grader failed, or did not come to run it.
    #[schemars(range(min = 0.0))]
    points: Option<f64>,
    /// Points that can be reached.
    #[schemars(range(min = 0.0))]
    max_points: f64,
    /// Steps that are right.
    right_steps: u32,
    /// Steps of the scene.
    steps: u32,
    /// The processor time of the run.
    #[schemars(range(min = 0.0))]
    cpu_seconds: f64,
    /// The wall time of the run.
    #[schemars(range(min = 0.0))]
    wall_seconds: f64,
    /// The most memory that it had; null where that is not known.
    memory_bytes: Option<u64>,
    /// The program's output, cut where it is long.
    stdout: String,
    /// Its standard error, likewise.
    stderr: String,
    /// Whether the result was taken from an earlier run.
    cached: bool,
}

/// All grades in one document.
pub(crate) fn render(grades: &[Grade], passed_over: &[PassedOver]) -> String {
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
        extra: group.extra,
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
        difference: scene.differs.map(CauseView::from),
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
