//! JSON in this program's own form (`schemas/grade.schema.json`). It contains everything in a grade.
use super::{super::explain::ExplanationView, describe_in_scene, describe_likely, describe_speed, phrases::NOT_GRADED};
use crate::untrusted_text::{clean_output, strip_control_characters};
use crate::{
    check::CauseView,
    smallest::SmallestView,
    view::{to_document, view},
    words,
};
use fosssim_findings::Verdict;
use fosssim_findings::{
    Book, Build, CourseNote, Grade, GroupGrade, Rules, SceneGrade, SkippedEntry, Visibility,
    changes::GradeChanges,
    located_failure::LocatedFailure,
    speed::{SpeedGrade, SpeedRatio, SpeedSource},
};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_mistakes::together::{find_likely_mistake, find_likely_mistakes, mistake_points};
use serde::Serialize;
use std::collections::BTreeMap;

/// The version of the schema. It increases if a program that reads the old version could misread the new one.
const SCHEMA: u32 = 4;

/// Returns a likely mistake in the words of the other reports.
fn view_likely_mistake(grade: &Grade, mistake: &Explanation) -> ExplanationView {
    let view = ExplanationView::from(mistake);
    let text = if mistake.is_unexplained() { describe_likely(grade, mistake) } else { view.text };
    ExplanationView { text, ..view }
}

/// Returns a scene's explanation in the words of the other reports.
fn view_in_scene(scene: &SceneGrade, mistake: &Explanation) -> ExplanationView {
    ExplanationView { text: describe_in_scene(scene, mistake), ..ExplanationView::from(mistake) }
}

/// The document that `grade --format json` writes. The version in `schema` increases if a program that reads the old
/// version could misread the new one.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(crate) struct GradeDocument {
    /// The version of the schema.
    #[schemars(extend("const" = SCHEMA))]
    schema: u32,
    /// The version of fosssim-oracle that wrote the document.
    version: &'static str,
    /// The grades of the submissions.
    grades: Vec<GradeView>,
    /// The skipped entries of the class's folder, which are not submissions; left out if there are none.
    #[serde(rename = "passed_over", skip_serializing_if = "Vec::is_empty")]
    skipped_entries: Vec<SkippedEntry>,
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
        /// The rule book that gives the verdicts and the points.
        official: Book = grade.rules.official(),
        /// The worst verdict of all scenes.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::name)))]
        verdict: &'static str = grade.verdict.name(),
        /// The code of the verdict, such as `AC`.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::code)))]
        code: &'static str = grade.verdict.code(),
        /// The points that the submission gets; null if the grader failed or was stopped, because that never gives zero
        /// points.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = grade.points,
        /// The maximum number of points of the suite.
        #[schemars(range(min = 0.0))]
        max_points: f64 = grade.max_points,
        /// The total wall time of all runs, in seconds.
        #[schemars(range(min = 0.0))]
        wall_seconds: f64 = grade.wall.as_secs_f64(),
        /// The layers of the sandbox that were active.
        sandbox: Vec<String> = grade.layers.clone(),
        /// The weaknesses of the sandbox on this host.
        warnings: Vec<String> = grade.warnings.iter().map(|warning| strip_control_characters(warning)).collect(),
        /// The reason why the whole submission could not be graded as usual, as a sentence. An example is a program for
        /// a different milestone. Omitted if there is no such reason.
        #[serde(skip_serializing_if = "Option::is_none")]
        unfit: Option<String> = words::describe_unfit(grade).map(|unfit| strip_control_characters(&unfit)),
        /// The result of the build; null if the suite builds nothing.
        build: Option<BuildView> = grade.build.as_ref().map(BuildView::from),
        /// The common features of the scenes in which the program crashes or exceeds a limit; null if there are no such
        /// scenes.
        located: Option<LocatedView> = grade.located_failure.as_ref().map(LocatedView::from),
        /// The mistake that explains most of the wrong scenes; null if fewer than two scenes have explanations.
        likely_mistake: Option<ExplanationView> =
            find_likely_mistake(grade).map(|mistake| view_likely_mistake(grade, &mistake)),
        /// Up to three mistakes that together explain the wrong scenes, the most frequent first.
        #[schemars(length(max = 3))]
        likely_mistakes: Vec<ExplanationView> =
            find_likely_mistakes(grade).iter().map(|(mistake, _)| view_likely_mistake(grade, mistake)).collect(),
        /// For each of the likely mistakes, the points of the scenes that are wrong only because of it.
        #[schemars(length(max = 3))]
        worth: Vec<f64> =
            find_likely_mistakes(grade).iter().map(|(mistake, _)| mistake_points(grade, mistake)).collect(),
        /// The smallest scene for each cause; left out if the user did not request it.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        smallest: Vec<SmallestView> = grade.smallest.iter().map(SmallestView::from).collect(),
        /// The course's notes on the likely mistakes, by the keys of the mistakes; left out if there are none.
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        notes: BTreeMap<String, CourseNote> = find_likely_mistakes(grade)
            .iter()
            .filter_map(|(mistake, _)| Some((mistake.key.clone(), grade.course_note(mistake)?.clone())))
            .collect(),
        /// The names of other submissions with an identical program, at most 20; left out if there are none.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        same_program: Vec<String> = grade.same_program.iter().map(|name| strip_control_characters(name)).collect(),
        /// The changes since an earlier grading; left out if the user did not give one.
        #[serde(skip_serializing_if = "Option::is_none")]
        changes: Option<ChangesView> = grade.changes().as_ref().map(ChangesView::from),
        /// The groups in the suite's order.
        groups: Vec<GroupView> = grade.groups.iter().map(GroupView::from).collect(),
    }
}

view! {
    /// The changes since an earlier grading of the same submission.
    #[schemars(deny_unknown_fields)]
    struct ChangesView from changes: GradeChanges<'_> {
        /// The points in the earlier grading; null if it gave no points.
        points: Option<f64> = changes.earlier_points,
        /// The maximum number of points in the earlier grading.
        max_points: f64 = changes.compared_points,
        /// The scenes that were not accepted before and are now.
        right: Vec<String> = changes.newly_right.iter().map(|scene| strip_control_characters(&scene.scene)).collect(),
        /// The scenes that were accepted before and are not now.
        broke: Vec<String> = changes.newly_wrong.iter().map(|scene| strip_control_characters(&scene.scene)).collect(),
        /// The scenes that were not accepted before and are not now, with a different verdict.
        others: Vec<String> =
            changes.other_changes.iter().map(|(scene, _)| strip_control_characters(&scene.scene)).collect(),
    }
}

view! {
    /// The scenes in which the program fails, and what they have in common.
    #[schemars(deny_unknown_fields)]
    struct LocatedView from found: LocatedFailure {
        /// The common features of these scenes, as a sentence.
        text: String = strip_control_characters(&words::describe_located(found)),
        /// The number of scenes in which the program fails.
        failed: usize = found.failed_scenes,
        /// The number of failing scenes that have these features.
        with: usize = found.scenes_with_features,
        /// The number of scenes that have these features and in which the program does not fail.
        without: usize = found.scenes_without_features,
        /// The first scene in which the program fails.
        first_scene: String = strip_control_characters(&found.first_scene),
        /// The last step of `first_scene` that is complete in the trace.
        last_complete_step: u32 = found.step,
    }
}

view! {
    /// The result of building the submission.
    #[schemars(deny_unknown_fields)]
    struct BuildView from build: Build {
        /// Whether the build produced a program.
        succeeded: bool = build.end.is_success(),
        /// The end of the build, as a sentence.
        end: String = strip_control_characters(&words::build(&build.end)),
        /// The output of the build, cut if it is long.
        output: String = clean_output(&build.output),
    }
}

view! {
    /// A group of scenes.
    #[schemars(deny_unknown_fields)]
    struct GroupView from group: GroupGrade {
        /// The group's name.
        name: String = strip_control_characters(&group.name),
        /// The visibility of the group's results for students.
        visibility: Visibility = group.visibility,
        /// The worst verdict of the group's scenes.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::name)))]
        verdict: &'static str = group.verdict.name(),
        /// The points that the group gets, including points for speed; null if a scene of the group has no points.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = group.points,
        /// The points that the group is worth.
        #[schemars(range(min = 0.0))]
        max_points: f64 = group.max_points,
        /// Whether the group's points are extra points, which count in neither the sum nor the maximum of the grade;
        /// left out if false.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        extra: bool = group.extra,
        /// The points for speed, which are part of the group's points; left out if the suite gives no points for speed.
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
    /// The points for speed that a group gets.
    #[schemars(deny_unknown_fields)]
    struct SpeedView from speed: SpeedGrade {
        /// The points that the submission gets for its speed; null if the grader could not measure it.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = speed.points,
        /// The points that the speed is worth.
        #[schemars(range(min = 0.0))]
        max_points: f64 = speed.marking.points,
        /// A sentence about the measurement and the points.
        text: String = strip_control_characters(&describe_speed(speed)),
        /// The submission's smallest processor time, divided by the reference's smallest; null if nothing was measured.
        #[schemars(range(min = 0.0))]
        ratio: Option<f64> = measure_ratio(speed).map(|measured| measured.ratio),
        /// The smallest ratio of processor times in one round of runs.
        #[schemars(range(min = 0.0))]
        least_ratio: Option<f64> = measure_ratio(speed).map(|measured| measured.least),
        /// The largest ratio of processor times in one round of runs.
        #[schemars(range(min = 0.0))]
        greatest_ratio: Option<f64> = measure_ratio(speed).map(|measured| measured.most),
        /// The number of rounds of runs.
        runs: u32 = measure_ratio(speed).map_or(0, |measured| measured.runs),
    }
}

view! {
    /// The result of a scene.
    #[schemars(deny_unknown_fields)]
    struct SceneView from scene: SceneGrade {
        /// The scene's name.
        scene: String = strip_control_characters(&scene.scene),
        /// The scene's verdict.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::name)))]
        verdict: &'static str = scene.verdict.name(),
        /// The code of the verdict, such as `AC`.
        #[schemars(extend("enum" = Verdict::ALL.map(Verdict::code)))]
        code: &'static str = scene.verdict.code(),
        /// The reason for the verdict, in one line.
        summary: String = strip_control_characters(&words::summarize(scene)),
        /// The reason why the two rule books judge the scene differently; null if they agree.
        difference: Option<CauseView> = scene.difference_cause.as_ref().map(CauseView::from),
        /// The place of the first difference, and the number of findings of each kind, if the hints allow it.
        details: Vec<String> = words::list_details(scene).iter().map(|line| strip_control_characters(line)).collect(),
        /// The likely mistakes, the likeliest first, if the hints allow it.
        explanations: Vec<ExplanationView> =
            scene.corrected_explanations.iter().map(|mistake| view_in_scene(scene, mistake)).collect(),
        /// The points that the submission gets for the scene; null if the grader failed or did not run it.
        #[schemars(range(min = 0.0))]
        points: Option<f64> = scene.points,
        /// The points that the scene is worth.
        #[schemars(range(min = 0.0))]
        max_points: f64 = scene.max_points,
        /// The number of steps that are right.
        right_steps: u32 = scene.right_steps,
        /// The number of steps of the scene.
        steps: u32 = scene.steps,
        /// The processor time of the run, in seconds.
        #[schemars(range(min = 0.0))]
        cpu_seconds: f64 = scene.measured.cpu.as_secs_f64(),
        /// The wall time of the run, in seconds.
        #[schemars(range(min = 0.0))]
        wall_seconds: f64 = scene.measured.wall.as_secs_f64(),
        /// The peak memory of the program in bytes; null if it is unknown.
        memory_bytes: Option<u64> = scene.measured.memory,
        /// The program's standard output, cut if it is long.
        stdout: String = clean_output(&scene.stdout),
        /// The program's standard error, cut if it is long.
        stderr: String = clean_output(&scene.stderr),
        /// Whether the result was taken from an earlier grading.
        cached: bool = scene.cached,
    }
}

/// Renders all grades as one document.
pub(crate) fn render(grades: &[Grade], skipped_entries: &[SkippedEntry]) -> String {
    let (grades, skipped_entries) =
        (grades.iter().map(GradeView::from).collect(), skipped_entries.iter().map(strip_entry).collect());
    to_document(&GradeDocument { schema: SCHEMA, version: env!("CARGO_PKG_VERSION"), grades, skipped_entries })
}

fn strip_entry(entry: &SkippedEntry) -> SkippedEntry {
    SkippedEntry { name: strip_control_characters(&entry.name), reason: strip_control_characters(&entry.reason) }
}

/// Renders one line of JSON per grade, and one per skipped entry.
pub fn render_lines(grades: &[Grade], skipped_entries: &[SkippedEntry]) -> String {
    let grades = grades.iter().map(|grade| serde_json::to_string(&GradeView::from(grade)));
    let skipped_entries = skipped_entries.iter().map(|entry| {
        let SkippedEntry { name, reason } = strip_entry(entry);
        let line = serde_json::json!({ "submission": name, "verdict": NOT_GRADED, "points": null, "reason": reason });
        serde_json::to_string(&line)
    });
    grades.chain(skipped_entries).map(|line| line.unwrap_or_default() + "\n").collect()
}

/// Returns the ratio of processor times, if the submission was timed.
fn measure_ratio(speed: &SpeedGrade) -> Option<SpeedRatio> {
    match speed.source {
        SpeedSource::Measured(measured) => Some(measured),
        _ => None,
    }
}
