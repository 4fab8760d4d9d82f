//! The grade of one submission, with the results of all scenes.
use super::{
    Hints, Rules,
    earlier_grade::EarlierGrade,
    explanation::Explanation,
    located_failure::LocatedFailure,
    result::{BuildEnd, SceneResult},
    smallest_scene::SmallestScene,
    speed::{SpeedGrade, SpeedSource},
    verdict::Verdict,
};
use fosssim_model::assignments::Assignment;
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, ops::Deref, time::Duration};

/// The readers who see the results of a group, and when. The names are Gradescope's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Visibility {
    /// Students see the results immediately.
    Visible,
    /// Only staff see the results.
    Hidden,
    /// Students see the results after the due date.
    AfterDueDate,
    /// Students see the results after the grades are published.
    AfterPublished,
}

/// A course's note on a mistake or a group. Reports show it after their own text.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct CourseNote {
    /// The text of the note.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// The URL of a lecture or a section, which begins with `http` or `https`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<String>,
    /// The points in the course's rubric. They are shown, but not counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<f64>,
}

/// Formats the note as one line.
impl std::fmt::Display for CourseNote {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let words = self.text.as_deref().map(|words| words.trim_end_matches('.').to_owned());
        let points = self.points.map(|points| format!("rubric points: {points}"));
        let parts: Vec<String> = [words, self.link.clone(), points].into_iter().flatten().collect();
        formatter.write_str(&parts.join("; "))
    }
}

/// The maximum number of submissions with the same program that a grade names. Without a limit, the output for a class
/// would grow quadratically.
const MAX_NAMED: usize = 20;

/// The grade of one submission on one suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grade {
    /// The name of the submission, which is the name of its file or folder.
    pub submission: String,
    /// The name of the suite.
    pub suite: String,
    /// The rule books by which traces are judged. The official one gives the verdicts and the points.
    pub rules: Rules,
    /// The worst verdict of the groups whose points count.
    pub verdict: Verdict,
    /// The points that the submission gets, without extra points. `None` if the grader failed, or was stopped before
    /// the last scene; that never gives zero points.
    pub points: Option<f64>,
    /// The points that the suite is worth, without extra points.
    pub max_points: f64,
    /// The groups, in the suite's order.
    pub groups: Vec<GroupGrade>,
    /// Whether reports for students show text that the program controls, such as its output. If the suite has hidden
    /// groups, reports show it only if the suite allows it.
    pub shows_output: bool,
    /// The result of building the submission; `None` if the suite builds nothing.
    pub build: Option<Build>,
    /// Warnings about layers of the sandbox that are not available; empty if all required layers were active.
    pub warnings: Vec<String>,
    /// The layers of the sandbox that were active.
    pub layers: Vec<String>,
    /// The total wall time of all runs. It includes the runs whose results were reused.
    pub wall: Duration,
    /// The keys of mistakes that accepted scenes refute.
    #[serde(rename = "refuted")]
    pub refuted_keys: Vec<String>,
    /// The milestone that the program probably implements, if it is not the suite's.
    #[serde(rename = "looks_like")]
    pub inferred_milestone: Option<Assignment>,
    /// The common features of the scenes in which the program crashes or exceeds a limit, if the hints allow it.
    #[serde(rename = "located")]
    pub located_failure: Option<LocatedFailure>,
    /// The digest of the program; `None` if the submission has no program that can be run.
    pub program: Option<String>,
    /// The names of other submissions in the class with an identical program, at most 20. Only staff see them.
    pub same_program: Vec<String>,
    /// The earlier grade with which this grade is compared.
    #[serde(default)]
    #[serde(rename = "before")]
    pub earlier_grade: Option<EarlierGrade>,
    /// The smallest scene for each cause, if the user requested it.
    #[serde(default)]
    pub smallest: Vec<SmallestScene>,
    /// The course's notes on mistakes, by the mistakes' keys.
    #[serde(default)]
    pub notes: BTreeMap<String, CourseNote>,
}

impl Grade {
    /// Returns the common verdict of groups, their points, and the points that they are worth. Extra groups count only
    /// if there are no other groups.
    pub fn totals(groups: &[GroupGrade]) -> (Verdict, Option<f64>, f64) {
        let has_others = groups.iter().any(|group| !group.extra);
        let regular_groups = || groups.iter().filter(move |group| !group.extra);
        let verdicts = groups.iter().filter(|group| !group.extra || !has_others).map(|group| group.verdict);
        (
            verdicts.max().unwrap_or(Verdict::NotRun),
            regular_groups().map(|group| group.points).sum(),
            regular_groups().map(|group| group.max_points).sum(),
        )
    }

    /// Returns the extra points that the submission gets and the maximum; `None` if the suite has no extra points.
    pub fn extra_points(&self) -> Option<(f64, f64)> {
        let extra = || self.groups.iter().filter(|group| group.extra);
        let reached: Option<f64> = extra().map(|group| group.points).sum();
        extra().next().and(reached).map(|reached| (reached, extra().map(|group| group.max_points).sum()))
    }

    /// Stores in each grade of a class which other submissions have the same program.
    pub fn record_same_programs(grades: &mut [Self]) {
        let mut owners: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for grade in grades.iter() {
            if let Some(program) = &grade.program {
                owners.entry(program.clone()).or_default().push(grade.submission.clone());
            }
        }
        for grade in grades {
            let sharers = grade.program.as_ref().map(|program| owners[program].iter());
            let others = sharers.into_iter().flatten().filter(|other| **other != grade.submission);
            grade.same_program = others.take(MAX_NAMED).cloned().collect();
        }
    }

    /// Returns whether students may see all groups.
    pub fn is_visible(&self) -> bool {
        self.groups.iter().all(|group| group.visibility == Visibility::Visible)
    }

    /// Returns the grade as it is after its hidden groups are published.
    pub fn with_hidden_published(&self) -> Self {
        let mut published = self.clone();
        published.groups.iter_mut().for_each(|group| group.visibility = Visibility::Visible);
        published
    }

    /// Returns the course's note on a mistake, if there is one.
    pub fn course_note(&self, mistake: &Explanation) -> Option<&CourseNote> {
        self.notes.get(&mistake.key)
    }

    /// Returns all scenes, in the suite's order.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneGrade> {
        self.groups.iter().flat_map(|group| &group.scenes)
    }

    /// Returns whether the grader failed on any part of the submission. Students must not get such a grade.
    pub fn is_grader_fault(&self) -> bool {
        self.verdict == Verdict::JudgeError
    }

    /// Returns whether some scenes were not run. The submission then has no points.
    pub fn is_incomplete(&self) -> bool {
        self.count_verdict(Verdict::NotRun) > 0
    }

    /// Returns the reason why the submission as a whole could not be graded as usual. Either it has no program that can
    /// be run, it could not be built, it belongs to another milestone, or nothing is written in it yet. Returns `None`
    /// if there is no such reason.
    pub fn submission_fault(&self) -> Option<SubmissionFault<'_>> {
        if let Some(other) = self.inferred_milestone {
            return Some(SubmissionFault::Milestone(other));
        }
        let first = self.scenes().next()?;
        let is_unfit = matches!(first.verdict, Verdict::Unusable | Verdict::CompileError | Verdict::Unwritten);
        let has_same_problem = |scene: &SceneGrade| {
            (scene.verdict, &scene.reason, &scene.ended) == (first.verdict, &first.reason, &first.ended)
        };
        (is_unfit && self.scenes().all(has_same_problem)).then(|| {
            self.failed_build()
                .map_or(SubmissionFault::Scene(&first.result), |build| SubmissionFault::Build(&build.end))
        })
    }

    /// Returns the result of the build if it did not produce a program.
    pub fn failed_build(&self) -> Option<&Build> {
        self.build.as_ref().filter(|build| !build.end.is_success())
    }

    /// Returns whether both grades have the same scenes, in the same groups and for the same points.
    pub fn has_same_suite(&self, other: &Self) -> bool {
        let is_same_group = |(own, other): (&GroupGrade, &GroupGrade)| {
            (&own.name, own.visibility, own.hints, own.max_points)
                == (&other.name, other.visibility, other.hints, other.max_points)
                && own.scenes.iter().map(|scene| &scene.scene).eq(other.scenes.iter().map(|scene| &scene.scene))
        };
        (&self.suite, self.rules, self.shows_output) == (&other.suite, other.rules, other.shows_output)
            && self.groups.len() == other.groups.len()
            && self.groups.iter().zip(&other.groups).all(is_same_group)
    }

    /// Returns the number of scenes whose results were reused from an earlier grading.
    pub fn count_reused(&self) -> usize {
        self.scenes().filter(|scene| scene.cached).count()
    }

    /// Returns the number of scenes that the two rule books judge differently.
    pub fn count_differing(&self) -> usize {
        self.scenes().filter(|scene| scene.difference_cause.is_some()).count()
    }

    /// Returns the number of scenes that have this verdict.
    pub fn count_verdict(&self, verdict: Verdict) -> usize {
        self.scenes().filter(|scene| scene.verdict == verdict).count()
    }
}

/// An entry of a class's folder that was skipped because it is not a submission.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct SkippedEntry {
    /// The name that the entry would have as a submission.
    pub name: String,
    /// The reason why the entry was skipped.
    #[serde(rename = "why")]
    pub reason: String,
}

/// The result of building a submission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Build {
    /// The result of the build.
    pub end: BuildEnd,
    /// The compiler's output, cut if it is long. It is raw text, which reports must escape.
    pub output: String,
}

/// The reason why a submission as a whole could not be graded as usual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SubmissionFault<'a> {
    /// The submission could not be built.
    Build(&'a BuildEnd),
    /// The program implements this milestone, but the suite tests another one.
    Milestone(Assignment),
    /// All scenes have the same fault. The value is the result of the first scene.
    Scene(&'a SceneResult),
}

/// One group of scenes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupGrade {
    /// The name of the group.
    pub name: String,
    /// The readers who see the results of the group, and when.
    pub visibility: Visibility,
    /// The level of detail that students get for the group's scenes.
    pub hints: Hints,
    /// The points that the group gets, including points for speed. `None` if a scene or the speed has no points.
    pub points: Option<f64>,
    /// The points that the group is worth, including points for speed.
    pub max_points: f64,
    /// Whether the group's points are extra points. They count in neither the sum nor the maximum of the grade.
    #[serde(default)]
    pub extra: bool,
    /// Whether the group gives points only if all of its scenes are accepted.
    #[serde(default)]
    pub all_or_nothing: bool,
    /// The points for speed, if the suite gives any.
    pub speed: Option<SpeedGrade>,
    /// The course's note on the group, if there is one.
    #[serde(default)]
    pub note: Option<CourseNote>,
    /// The worst verdict of the group's scenes.
    pub verdict: Verdict,
    /// The results of the group's scenes.
    pub scenes: Vec<SceneGrade>,
}

/// The result of a scene, and its points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneGrade {
    /// The result of the scene.
    pub result: SceneResult,
    /// The points that the submission gets for the scene. `None` if the grader failed or did not run the scene; that
    /// never gives zero points.
    pub points: Option<f64>,
    /// The points that the scene is worth.
    pub max_points: f64,
    /// Whether the result was reused from an earlier grading.
    pub cached: bool,
    /// The likely mistakes in the scene that reports show, the likeliest first. They come from
    /// explaining all scenes together if one of those explanations applies to this scene, and otherwise from this scene
    /// alone ([`SceneResult::explanations`]).
    #[serde(rename = "settled")]
    pub corrected_explanations: Vec<Explanation>,
    /// The number of explanations at the start of [`corrected_explanations`](Self::corrected_explanations) that come
    /// from explaining all scenes together.
    #[serde(rename = "agreed")]
    pub agreed_count: usize,
}

impl GroupGrade {
    /// Returns the points that all scenes of the group are worth, without points for speed.
    pub fn max_points_of_scenes(&self) -> f64 {
        self.max_points - self.speed.as_ref().map_or(0.0, |speed| speed.marking.points)
    }

    /// Removes everything about the group's scenes and its speed that students must not see while groups are hidden.
    pub fn withhold(&mut self) {
        self.scenes.iter_mut().for_each(SceneGrade::withhold);
        if let Some(speed) = &mut self.speed {
            speed.source = SpeedSource::Withheld;
        }
    }
}

impl SceneGrade {
    /// Removes everything from the result that students must not see while groups are hidden
    /// ([`SceneResult::withhold`]).
    pub fn withhold(&mut self) {
        self.result.withhold();
        (self.corrected_explanations, self.agreed_count) = (Vec::new(), 0);
    }
}

impl Deref for SceneGrade {
    type Target = SceneResult;

    fn deref(&self) -> &SceneResult {
        &self.result
    }
}
