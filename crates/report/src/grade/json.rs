//! The program's own JSON (`schemas/grade.schema.json`), with everything in a grade.
use super::{super::explain::ExplanationView, describe_speed, phrases::NOT_GRADED};
use crate::foreign::{clean_output, strip_control_characters};
use crate::{
    check::CauseView,
    smallest::SmallestView,
    view::{to_document, view},
    words,
};
use fosssim_findings::Verdict;
use fosssim_findings::{
    Book, Build, CourseNote, Grade, GroupGrade, Rules, SceneGrade, SkippedEntry, Visibility,
    changes::Changes,
    located::LocatedFailure,
    speed::{SpeedGrade, SpeedRatio, SpeedSource},
};
use fosssim_mistakes::together::{likely_mistake, likely_mistakes, worth};
use serde::Serialize;
use std::collections::BTreeMap;

/// The version of the schema. It is increased if a reader of the old version would misunderstand the new one.
const SCHEMA: u32 = 4;

/// The document of `grade --format json`. Its version in `schema` is increased if a reader of the old version would
/// misunderstand the new one.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(crate) struct GradeDocument {
    /// The version of this shape.
    #[schemars(extend("const" = SCHEMA))]
    schema: u32,
    /// The version of the program.
    version: &'static str,
    /// The grades of the submissions.
    grades: Vec<GradeView>,
    /// The entries of the class's folder that are not submissions; left out if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    passed_over: Vec<SkippedEntry>,
}

view! {
    /// The grade of a submission.
    #[schemars(deny_unknown_fields)]
    struct GradeView from grade: Grade {
        /// The submission's name.
        submission: String = strip_control_characters(&grade.submission),
        /// The suite's name.
        suite: String = strip_control_characters(&grade.suite),
        /// The requested rule books.
        rules: Rules = grade.rules,
        /// The book that gives verdicts and points.
        official: Book = grade.rules.official(),
        /// The worst verdict of all scenes.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::name)))]
        verdict: &'static str = grade.verdict.name(),
        /// The verdict as one word, such as `AC`.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::code)))]
        code: &'static str = grade.verdict.code(),
        /// The points reached; null if the grader failed or was stopped. A failure of the grader never gives zero
        /// points.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = grade.points,
        /// The maximum number of points.
        #[schemars(range(min = 0.0))]
        max_points: f64 = grade.max_points,
        /// The total wall time of all runs.
        #[schemars(range(min = 0.0))]
        wall_seconds: f64 = grade.wall.as_secs_f64(),
        /// The layers of the sandbox that were active.
        sandbox: Vec<String> = grade.layers.clone(),
        /// The weaknesses of the sandbox on this host.
        warnings: Vec<String> = grade.warnings.iter().map(|warning| strip_control_characters(warning)).collect(),
        /// The fault of the whole submission as a sentence, such as a program for a different milestone; omitted if
        /// there is none.
        #[serde(skip_serializing_if = "Option::is_none")]
        unfit: Option<String> = words::describe_unfit(grade).map(|unfit| strip_control_characters(&unfit)),
        /// The end of the build; null if the suite builds nothing.
        build: Option<BuildView> = grade.build.as_ref().map(BuildView::from),
        /// The common contents of the scenes in which the program crashes or exceeds a limit; null if there are none.
        located: Option<LocatedView> = grade.located.as_ref().map(LocatedView::from),
        /// The mistake that explains most wrong scenes, if several have explanations.
        likely_mistake: Option<ExplanationView> = likely_mistake(grade).as_ref().map(ExplanationView::from),
        /// Up to three mistakes that explain the wrong scenes together, the most frequent first.
        #[schemars(length(max = 3))]
        likely_mistakes: Vec<ExplanationView> =
            likely_mistakes(grade).iter().map(|(mistake, _)| ExplanationView::from(mistake)).collect(),
        /// For each of the likely mistakes, the points of the scenes that are wrong only because of this mistake.
        #[schemars(length(max = 3))]
        worth: Vec<f64> = likely_mistakes(grade).iter().map(|(mistake, _)| worth(grade, mistake)).collect(),
        /// The smallest scene for each cause; left out if not requested.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        smallest: Vec<SmallestView> = grade.smallest.iter().map(SmallestView::from).collect(),
        /// The course's notes on the likely mistakes, by their keys; left out if there are none.
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        notes: BTreeMap<String, CourseNote> = likely_mistakes(grade)
            .iter()
            .filter_map(|(mistake, _)| Some((mistake.key.clone(), grade.note(mistake)?.clone())))
            .collect(),
        /// Other submissions with an identical program (at most 20); left out if there are none.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        same_program: Vec<String> = grade.same_program.iter().map(|name| strip_control_characters(name)).collect(),
        /// The changes since an earlier grading; left out if none was given.
        #[serde(skip_serializing_if = "Option::is_none")]
        changes: Option<ChangesView> = grade.changes().as_ref().map(ChangesView::from),
        /// The groups in the suite's order.
        groups: Vec<GroupView> = grade.groups.iter().map(GroupView::from).collect(),
    }
}

view! {
    /// The changes since an earlier grading of the same submission.
    #[schemars(deny_unknown_fields)]
    struct ChangesView from changes: Changes<'_> {
        /// The points in the earlier grading; null if it had none.
        points: Option<f64> = changes.points,
        /// The maximum number of points in the earlier grading.
        max_points: f64 = changes.max_points,
        /// The scenes that became right.
        right: Vec<String> = changes.right.iter().map(|scene| strip_control_characters(&scene.scene)).collect(),
        /// The scenes that are no longer right.
        broke: Vec<String> = changes.broke.iter().map(|scene| strip_control_characters(&scene.scene)).collect(),
        /// The scenes that fail with another verdict than before.
        others: Vec<String> = changes.others.iter().map(|(scene, _)| strip_control_characters(&scene.scene)).collect(),
    }
}

view! {
    /// The scenes in which a program fails.
    #[schemars(deny_unknown_fields)]
    struct LocatedView from found: LocatedFailure {
        /// The common contents of these scenes as a sentence.
        text: String = strip_control_characters(&words::describe_located(found)),
        /// The number of scenes in which the program fails.
        failed: usize = found.failed,
        /// The number of failing scenes that have the contents.
        with: usize = found.with,
        /// The number of scenes with the contents in which the program does not fail.
        without: usize = found.without,
        /// The first scene in which the program fails.
        first_scene: String = strip_control_characters(&found.first),
        /// The last step of that scene that is complete in the trace.
        last_complete_step: u32 = found.step,
    }
}

view! {
    /// The build step's end.
    #[schemars(deny_unknown_fields)]
    struct BuildView from build: Build {
        /// Whether the build made a program.
        succeeded: bool = build.end.is_success(),
        /// The end of the build as a sentence.
        end: String = strip_control_characters(&words::build(&build.end)),
        /// The compiler's output, truncated if it is long.
        output: String = clean_output(&build.output),
    }
}

view! {
    /// A group of scenes.
    #[schemars(deny_unknown_fields)]
    struct GroupView from group: GroupGrade {
        /// The group's name.
        name: String = strip_control_characters(&group.name),
        /// The visibility of the group's results.
        visibility: Visibility = group.visibility,
        /// The worst verdict of the group's scenes.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::name)))]
        verdict: &'static str = group.verdict.name(),
        /// The points reached, including those for speed; null if a scene has none.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = group.points,
        /// The maximum number of points.
        #[schemars(range(min = 0.0))]
        max_points: f64 = group.max_points,
        /// Whether the points count in neither the sum nor the maximum of the grade; left out if false.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        extra: bool = group.extra,
        /// The points for speed, which are part of the group's points; left out if the suite gives none.
        #[serde(skip_serializing_if = "Option::is_none")]
        speed: Option<SpeedView> = group.speed.as_ref().map(SpeedView::from),
        /// The course's note on the group; left out if there is none.
        #[serde(skip_serializing_if = "Option::is_none")]
        note: Option<CourseNote> = group.note.clone(),
        /// The group's scenes.
        scenes: Vec<SceneView> = group.scenes.iter().map(SceneView::from).collect(),
    }
}

view! {
    /// Points for speed.
    #[schemars(deny_unknown_fields)]
    struct SpeedView from speed: SpeedGrade {
        /// The points reached; null if the grader could not measure.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = speed.points,
        /// The maximum number of points.
        #[schemars(range(min = 0.0))]
        max_points: f64 = speed.marking.points,
        /// The measurement as a sentence.
        text: String = strip_control_characters(&describe_speed(speed)),
        /// The submission's minimum processor time, divided by the reference's.
        #[schemars(range(min = 0.0))]
        ratio: Option<f64> = measure_ratio(speed).map(|measured| measured.ratio),
        /// The smallest ratio of a round of runs.
        #[schemars(range(min = 0.0))]
        least_ratio: Option<f64> = measure_ratio(speed).map(|measured| measured.least),
        /// The largest ratio of a round of runs.
        #[schemars(range(min = 0.0))]
        greatest_ratio: Option<f64> = measure_ratio(speed).map(|measured| measured.most),
        /// The number of rounds.
        runs: u32 = measure_ratio(speed).map_or(0, |measured| measured.runs),
    }
}

view! {
    /// A scene of a grade.
    #[schemars(deny_unknown_fields)]
    struct SceneView from scene: SceneGrade {
        /// The scene's name.
        scene: String = strip_control_characters(&scene.scene),
        /// The scene's verdict.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::name)))]
        verdict: &'static str = scene.verdict.name(),
        /// The verdict as one word, such as `AC`.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::code)))]
        code: &'static str = scene.verdict.code(),
        /// The reason for the verdict, in one line.
        summary: String = strip_control_characters(&words::summarize(scene)),
        /// The rule by which the two rule books judge the scene differently; null if they agree.
        difference: Option<CauseView> = scene.differs.as_ref().map(CauseView::from),
        /// The place of the first difference, and the number of findings of each kind, if hints allow it.
        details: Vec<String> = words::list_details(scene).iter().map(|line| strip_control_characters(line)).collect(),
        /// The likely mistakes, the likeliest first, if hints allow it.
        explanations: Vec<ExplanationView> = scene.settled.iter().map(ExplanationView::from).collect(),
        /// The points reached; null if the grader failed or did not run the scene.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = scene.points,
        /// The maximum number of points.
        #[schemars(range(min = 0.0))]
        max_points: f64 = scene.max_points,
        /// The number of steps that are right.
        right_steps: u32 = scene.right_steps,
        /// The number of steps of the scene.
        steps: u32 = scene.steps,
        /// The processor time of the run.
        #[schemars(range(min = 0.0))]
        cpu_seconds: f64 = scene.measured.cpu.as_secs_f64(),
        /// The wall time of the run.
        #[schemars(range(min = 0.0))]
        wall_seconds: f64 = scene.measured.wall.as_secs_f64(),
        /// The peak memory of the program; null if unknown.
        memory_bytes: Option<u64> = scene.measured.memory,
        /// The program's standard output, truncated if it is long.
        stdout: String = clean_output(&scene.stdout),
        /// The program's standard error, truncated if it is long.
        stderr: String = clean_output(&scene.stderr),
        /// Whether the result was reused from an earlier run.
        cached: bool = scene.cached,
    }
}

/// Renders all grades in one document.
pub(crate) fn render(grades: &[Grade], passed_over: &[SkippedEntry]) -> String {
    let (grades, passed_over) =
        (grades.iter().map(GradeView::from).collect(), passed_over.iter().map(with_plain_words).collect());
    to_document(&GradeDocument { schema: SCHEMA, version: env!("CARGO_PKG_VERSION"), grades, passed_over })
}

fn with_plain_words(entry: &SkippedEntry) -> SkippedEntry {
    SkippedEntry { name: strip_control_characters(&entry.name), why: strip_control_characters(&entry.why) }
}

/// Returns a line per grade, and a line per entry that is not a submission.
#[must_use]
pub fn lines(grades: &[Grade], passed_over: &[SkippedEntry]) -> String {
    let grades = grades.iter().map(|grade| serde_json::to_string(&GradeView::from(grade)));
    let passed_over = passed_over.iter().map(|entry| {
        let SkippedEntry { name, why } = with_plain_words(entry);
        let line = serde_json::json!({ "submission": name, "verdict": NOT_GRADED, "points": null, "reason": why });
        serde_json::to_string(&line)
    });
    grades.chain(passed_over).map(|line| line.unwrap_or_default() + "\n").collect()
}

/// Returns the speed ratio, if the submission was timed.
fn measure_ratio(speed: &SpeedGrade) -> Option<SpeedRatio> {
    match speed.source {
        SpeedSource::Measured(measured) => Some(measured),
        _ => None,
    }
}
