//! The grade of one submission, scene by scene.
use super::{
    Hints, Rules,
    earlier::EarlierGrade,
    explanation::Explanation,
    located::LocatedFailure,
    result::{BuildEnd, SceneResult},
    smallest::SmallestScene,
    speed::{SpeedGrade, SpeedSource},
    verdict::Verdict,
};
use fosssim_model::assignments::Assignment;
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, ops::Deref, time::Duration};

/// The visibility of a group's results, in Gradescope's terms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Visibility {
    /// The results are visible immediately.
    Visible,
    /// The results are visible only to staff.
    Hidden,
    /// The results are visible to students after the due date.
    AfterDueDate,
    /// The results are visible to students after grades are published.
    AfterPublished,
}

/// A course's note on a mistake or a group; reports show it next to their own text.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct CourseNote {
    /// The text of the note.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// The address of a lecture or a section, with `http` or `https`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<String>,
    /// The points in the course's rubric, which are shown but not counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<f64>,
}

impl CourseNote {
    /// Writes the note in one line; `text` and `link` format the text and the address.
    pub fn line(&self, text: impl Fn(&str) -> String, link: impl Fn(&str) -> String) -> String {
        let words = self.text.as_deref().map(|words| text(words.trim_end_matches('.')));
        let points = self.points.map(|points| format!("rubric points: {points}"));
        let parts: Vec<String> = [words, self.link.as_deref().map(link), points].into_iter().flatten().collect();
        parts.join("; ")
    }
}

/// Writes the note in one line, with the unchanged address.
impl std::fmt::Display for CourseNote {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&self.line(str::to_owned, str::to_owned))
    }
}

/// The maximum number of submissions with the same program that a grade names, so that output for a class does not grow
/// quadratically.
const MAX_NAMED: usize = 20;

/// The grade of one submission on one suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grade {
    /// The submission's name, which is its file or folder name.
    pub submission: String,
    /// The suite's name.
    pub suite: String,
    /// The requested rule books; the official one decides verdicts and points.
    pub rules: Rules,
    /// The worst verdict of the groups that count.
    pub verdict: Verdict,
    /// The points reached, without extra points; `None` if the grader failed or was stopped before the last scene. A
    /// failure of the grader never gives zero points.
    pub points: Option<f64>,
    /// The maximum number of points, without extra points.
    pub max_points: f64,
    /// The groups, in the suite's order.
    pub groups: Vec<GroupGrade>,
    /// Whether reports for students show text that the program controls, such as its output. If groups are hidden, they
    /// do so only if the suite allows it.
    pub shows_output: bool,
    /// The end of the build, if the suite builds.
    pub build: Option<Build>,
    /// Warnings about missing layers of the sandbox; empty if every required layer was active.
    pub warnings: Vec<String>,
    /// The layers of the sandbox that were active.
    pub layers: Vec<String>,
    /// The total wall time of all runs, including reused results.
    pub wall: Duration,
    /// Keys of mistakes that accepted scenes contradict.
    pub refuted: Vec<String>,
    /// The milestone that the program seems to implement, if it is not the suite's.
    pub looks_like: Option<Assignment>,
    /// The common properties of the scenes in which the program crashes or exceeds a limit, if hints allow them.
    pub located: Option<LocatedFailure>,
    /// The digest of the program; `None` if there is no program that can be run.
    pub program: Option<String>,
    /// Other submissions of the class with an identical program (at most 20), for staff only.
    pub same_program: Vec<String>,
    /// The earlier grade that this one is compared with.
    #[serde(default)]
    pub before: Option<EarlierGrade>,
    /// The smallest scene for each cause, if requested.
    #[serde(default)]
    pub smallest: Vec<SmallestScene>,
    /// The course's notes on mistakes, by the mistakes' keys.
    #[serde(default)]
    pub notes: BTreeMap<String, CourseNote>,
}

impl Grade {
    /// Returns the common verdict, points and maximum points of groups. Extra groups count only if there are no others.
    #[must_use]
    pub fn totals(groups: &[GroupGrade]) -> (Verdict, Option<f64>, f64) {
        let has_others = groups.iter().any(|group| !group.extra);
        let counted = || groups.iter().filter(move |group| !group.extra);
        let verdicts = groups.iter().filter(|group| !group.extra || !has_others).map(|group| group.verdict);
        (
            verdicts.max().unwrap_or(Verdict::NotRun),
            counted().map(|group| group.points).sum(),
            counted().map(|group| group.max_points).sum(),
        )
    }

    /// Returns the extra points reached and their maximum; `None` if the suite gives no extra points.
    #[must_use]
    pub fn extra(&self) -> Option<(f64, f64)> {
        let extra = || self.groups.iter().filter(|group| group.extra);
        let reached: Option<f64> = extra().map(|group| group.points).sum();
        extra().next().and(reached).map(|reached| (reached, extra().map(|group| group.max_points).sum()))
    }

    /// Records in each grade of a class which other submissions have the same program.
    pub fn note_same_programs(grades: &mut [Self]) {
        let mut owners: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for grade in grades.iter() {
            if let Some(program) = &grade.program {
                owners.entry(program.clone()).or_default().push(grade.submission.clone());
            }
        }
        for grade in grades {
            let same = grade.program.as_ref().map(|program| owners[program].iter());
            let others = same.into_iter().flatten().filter(|other| **other != grade.submission);
            grade.same_program = others.take(MAX_NAMED).cloned().collect();
        }
    }

    /// Returns whether students may see all groups.
    #[must_use]
    pub fn is_visible(&self) -> bool {
        self.groups.iter().all(|group| group.visibility == Visibility::Visible)
    }

    /// Returns the grade with its hidden groups published.
    #[must_use]
    pub fn with_hidden_published(&self) -> Self {
        let mut published = self.clone();
        published.groups.iter_mut().for_each(|group| group.visibility = Visibility::Visible);
        published
    }

    /// Returns the course's note on a mistake.
    #[must_use]
    pub fn note(&self, mistake: &Explanation) -> Option<&CourseNote> {
        self.notes.get(&mistake.key)
    }

    /// Returns all scenes, in the suite's order.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneGrade> {
        self.groups.iter().flat_map(|group| &group.scenes)
    }

    /// Returns whether the grader failed on a part of the grade. Students must not get such a grade.
    #[must_use]
    pub fn is_our_fault(&self) -> bool {
        self.verdict == Verdict::JudgeError
    }

    /// Returns whether scenes were not run, so that there are no points.
    #[must_use]
    pub fn is_incomplete(&self) -> bool {
        self.count(Verdict::NotRun) > 0
    }

    /// Returns the fault of the whole submission, if there is one: it has no runnable program, it does not build, it
    /// belongs to a different milestone, or nothing is written yet.
    #[must_use]
    pub fn unfit(&self) -> Option<SubmissionFault<'_>> {
        if let Some(other) = self.looks_like {
            return Some(SubmissionFault::Milestone(other));
        }
        let first = self.scenes().next()?;
        let is_unfit = matches!(first.verdict, Verdict::Unusable | Verdict::CompileError | Verdict::Unwritten);
        let same = |scene: &SceneGrade| {
            (scene.verdict, &scene.reason, &scene.ended) == (first.verdict, &first.reason, &first.ended)
        };
        (is_unfit && self.scenes().all(same)).then(|| {
            self.failed_build()
                .map_or(SubmissionFault::Scene(&first.result), |build| SubmissionFault::Build(&build.end))
        })
    }

    /// Returns the build, if it failed to make a program.
    #[must_use]
    pub fn failed_build(&self) -> Option<&Build> {
        self.build.as_ref().filter(|build| !build.end.is_success())
    }

    /// Returns whether both grades are of the same scenes, in the same groups and for the same points.
    #[must_use]
    pub fn is_of_the_suite_of(&self, other: &Self) -> bool {
        let alike = |(own, other): (&GroupGrade, &GroupGrade)| {
            (&own.name, own.visibility, own.hints, own.max_points)
                == (&other.name, other.visibility, other.hints, other.max_points)
                && own.scenes.iter().map(|scene| &scene.scene).eq(other.scenes.iter().map(|scene| &scene.scene))
        };
        (&self.suite, self.rules, self.shows_output) == (&other.suite, other.rules, other.shows_output)
            && self.groups.len() == other.groups.len()
            && self.groups.iter().zip(&other.groups).all(alike)
    }

    /// Returns the number of results that were reused from an earlier run.
    #[must_use]
    pub fn taken_over(&self) -> usize {
        self.scenes().filter(|scene| scene.cached).count()
    }

    /// Returns the number of scenes that the two rule books judge differently.
    #[must_use]
    pub fn differing(&self) -> usize {
        self.scenes().filter(|scene| scene.differs.is_some()).count()
    }

    /// Returns the number of scenes with this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.scenes().filter(|scene| scene.verdict == verdict).count()
    }
}

/// An entry of a class's folder that was skipped because it is not a submission, with the reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct SkippedEntry {
    /// The name that the entry would have as a submission.
    pub name: String,
    /// The reason, as text.
    pub why: String,
}

/// The end of the build step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Build {
    /// The way the build ended.
    pub end: BuildEnd,
    /// The compiler's output, truncated; raw text that a report has to escape.
    pub output: String,
}

/// A fault of a submission itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SubmissionFault<'a> {
    /// The submission's build failed.
    Build(&'a BuildEnd),
    /// The program implements this milestone, but the suite tests a different one.
    Milestone(Assignment),
    /// All scenes have the same fault; the value is the result of the first scene.
    Scene(&'a SceneResult),
}

/// One group of scenes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupGrade {
    /// The group's name.
    pub name: String,
    /// The visibility of the group's results.
    pub visibility: Visibility,
    /// The hints that students get for the group's scenes.
    pub hints: Hints,
    /// The points reached, including those for speed; `None` if a scene or the speed has no points.
    pub points: Option<f64>,
    /// The maximum number of points.
    pub max_points: f64,
    /// Whether the points are extra: they count in neither the sum nor the maximum of the grade.
    #[serde(default)]
    pub extra: bool,
    /// Whether the group gives points only if all of its scenes are accepted.
    #[serde(default)]
    pub all_or_nothing: bool,
    /// The points for speed, if the suite gives any.
    pub speed: Option<SpeedGrade>,
    /// The course's note on the group.
    #[serde(default)]
    pub note: Option<CourseNote>,
    /// The worst verdict of the group's scenes.
    pub verdict: Verdict,
    /// The group's scenes.
    pub scenes: Vec<SceneGrade>,
}

/// One scene and its points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneGrade {
    /// The result of the scene.
    pub result: SceneResult,
    /// The points reached; `None` if the grader failed or did not run the scene. A failure of the grader never gives
    /// zero points.
    pub points: Option<f64>,
    /// The maximum number of points.
    pub max_points: f64,
    /// Whether the result was reused from an earlier run.
    pub cached: bool,
    /// The likely mistakes in the scene, the likeliest first. They come from all scenes together if these show a common
    /// mistake, otherwise from this scene alone ([`SceneResult::explanations`]). Reports show these explanations.
    pub settled: Vec<Explanation>,
    /// The number of explanations, at the start of [`settled`](Self::settled), that come from all scenes together.
    pub agreed: usize,
}

impl GroupGrade {
    /// Returns the sum of the maximum points of the group's scenes.
    #[must_use]
    pub fn max_points_of_scenes(&self) -> f64 {
        self.max_points - self.speed.as_ref().map_or(0.0, |speed| speed.marking.points)
    }

    /// Removes everything from the group's scenes and speed that students may not see when groups are hidden.
    pub fn withhold(&mut self) {
        self.scenes.iter_mut().for_each(SceneGrade::withhold);
        if let Some(speed) = &mut self.speed {
            speed.source = SpeedSource::Withheld;
        }
    }
}

impl SceneGrade {
    /// Removes everything from the result that students may not see when groups are hidden ([`SceneResult::withhold`]).
    pub fn withhold(&mut self) {
        self.result.withhold();
        (self.settled, self.agreed) = (Vec::new(), 0);
    }
}

impl Deref for SceneGrade {
    type Target = SceneResult;

    fn deref(&self) -> &SceneResult {
        &self.result
    }
}
