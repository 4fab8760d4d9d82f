//! The grade: what one submission got, scene by scene.
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

/// The visibility of a group's results, in Gradescope's words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Visibility {
    /// Everybody sees it immediately.
    Visible,
    /// Staff only.
    Hidden,
    /// Students, after the due date.
    AfterDueDate,
    /// Students, after grades are published.
    AfterPublished,
}

/// A course's own words on a mistake or a group: reports show them next to ours.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct CourseNote {
    /// A sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// The address of a lecture or a section; `http` or `https`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<String>,
    /// Points in the course's rubric; shown, never counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<f64>,
}

impl CourseNote {
    /// Writes the note in one line: the report decides how text and an address are written.
    pub fn line(&self, text: impl Fn(&str) -> String, link: impl Fn(&str) -> String) -> String {
        let words = self.text.as_deref().map(|words| text(words.trim_end_matches('.')));
        let points = self.points.map(|points| format!("rubric points: {points}"));
        let parts: Vec<String> = [words, self.link.as_deref().map(link), points].into_iter().flatten().collect();
        parts.join("; ")
    }
}

/// A line of text, with the address as it is.
impl std::fmt::Display for CourseNote {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&self.line(str::to_owned, str::to_owned))
    }
}

/// The greatest number of submissions with the same program that a grade names: output for a class of equal programs
/// must not grow by its square.
const MOST_NAMED: usize = 20;

/// The grade of one submission on one suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grade {
    /// The submission's name: its file or folder name.
    pub submission: String,
    /// The suite's name.
    pub suite: String,
    /// The requested rule books; verdicts and points are by the official one.
    pub rules: Rules,
    /// The worst verdict of the groups that count.
    pub verdict: Verdict,
    /// Points reached, without extra ones; `None` when the grader failed or was stopped before the last scene; no
    /// student gets a zero for that.
    pub points: Option<f64>,
    /// The greatest number of points, without extra ones.
    pub max_points: f64,
    /// Groups in the suite's order.
    pub groups: Vec<GroupGrade>,
    /// Whether reports for students show what the program could have chosen, as its output. They do not if groups are
    /// hidden, unless the suite allows it.
    pub shows_output: bool,
    /// The way the build ended, when the suite builds.
    pub build: Option<Build>,
    /// The weaknesses of the sandbox, in words; empty when every required layer held.
    pub warnings: Vec<String>,
    /// Layers of the sandbox that were active.
    pub layers: Vec<String>,
    /// Wall time of all runs together, those taken from an earlier grading included.
    pub wall: Duration,
    /// Keys of mistakes that accepted scenes speak against.
    pub refuted: Vec<String>,
    /// The milestone of which the program seems to be, if that is not the suite's.
    pub looks_like: Option<Assignment>,
    /// The common properties of the scenes in which the program crashes or runs into a limit, where hints let them
    /// through.
    pub located: Option<LocatedFailure>,
    /// The digest of the program; `None` if there is no program that can be run.
    pub program: Option<String>,
    /// Other submissions of the class whose programs are equal, byte for byte, at most 20; for staff only.
    pub same_program: Vec<String>,
    /// The earlier grade with which this one is compared.
    #[serde(default)]
    pub before: Option<EarlierGrade>,
    /// The smallest scene for each cause, if requested.
    #[serde(default)]
    pub smallest: Vec<SmallestScene>,
    /// The course's own words on mistakes, by their keys.
    #[serde(default)]
    pub notes: BTreeMap<String, CourseNote>,
}

impl Grade {
    /// Returns the verdict, the points and the maximum that follow from groups. Extra groups count only if there are no
    /// others.
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

    /// Returns the extra points reached and their maximum; `None` if the suite gives none.
    #[must_use]
    pub fn extra(&self) -> Option<(f64, f64)> {
        let extra = || self.groups.iter().filter(|group| group.extra);
        let reached: Option<f64> = extra().map(|group| group.points).sum();
        extra().next().and(reached).map(|reached| (reached, extra().map(|group| group.max_points).sum()))
    }

    /// Notes in each grade of a class which other submissions have the same program.
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
            grade.same_program = others.take(MOST_NAMED).cloned().collect();
        }
    }

    /// Returns whether all groups are for students' eyes.
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

    /// Returns the course's own words on a mistake.
    #[must_use]
    pub fn note(&self, mistake: &Explanation) -> Option<&CourseNote> {
        self.notes.get(&mistake.key)
    }

    /// Returns all scenes in order.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneGrade> {
        self.groups.iter().flat_map(|group| &group.scenes)
    }

    /// Returns whether the grader failed somewhere, so that the grade must not reach a student.
    #[must_use]
    pub fn is_our_fault(&self) -> bool {
        self.verdict == Verdict::JudgeError
    }

    /// Returns whether scenes were not run, so that there are no points yet.
    #[must_use]
    pub fn is_incomplete(&self) -> bool {
        self.count(Verdict::NotRun) > 0
    }

    /// Returns the fault of the submission itself, and the reason of each of its scenes: no program that can be run is
    /// in it, its sources do not build, it is of another milestone, or nothing is written yet.
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

    /// Returns the build, where it made no program.
    #[must_use]
    pub fn failed_build(&self) -> Option<&Build> {
        self.build.as_ref().filter(|build| !build.end.is_success())
    }

    /// Returns whether two grades are of one suite: of the same scenes, in the same groups, for the same points.
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

    /// Returns the number of results that were taken from an earlier run.
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

/// An entry of a class's folder that is not a submission, and the reason: no entry is left out silently.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct PassedOver {
    /// The entry's name, as the name of a submission.
    pub name: String,
    /// Why, in words.
    pub why: String,
}

/// The build step's end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Build {
    /// The way it ended.
    pub end: BuildEnd,
    /// The compiler's output, capped; raw text that a report has to escape.
    pub output: String,
}

/// A fault of a submission itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SubmissionFault<'a> {
    /// The submission's build failed.
    Build(&'a BuildEnd),
    /// The program is of this milestone, and the suite of another.
    Milestone(Assignment),
    /// The words of its first scene, and of all others with it.
    Scene(&'a SceneResult),
}

/// One group of scenes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupGrade {
    /// The group's name.
    pub name: String,
    /// The readers who see the group.
    pub visibility: Visibility,
    /// The hints that students get for its scenes.
    pub hints: Hints,
    /// Points reached, including those for speed; `None` when a scene or its speed has none.
    pub points: Option<f64>,
    /// Points that can be reached.
    pub max_points: f64,
    /// Whether its points are extra: they count neither in the sum nor in the maximum of the grade.
    #[serde(default)]
    pub extra: bool,
    /// Whether it gives points only where all of its scenes are accepted.
    #[serde(default)]
    pub all_or_nothing: bool,
    /// Points for speed, where the suite gives any.
    pub speed: Option<SpeedGrade>,
    /// The course's own words on the group.
    #[serde(default)]
    pub note: Option<CourseNote>,
    /// The worst verdict of its scenes.
    pub verdict: Verdict,
    /// The group's scenes.
    pub scenes: Vec<SceneGrade>,
}

/// One scene with its points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneGrade {
    /// The result.
    pub result: SceneResult,
    /// Points reached; `None` when the grader failed or did not run it; no student gets a zero for that.
    pub points: Option<f64>,
    /// Points that can be reached.
    pub max_points: f64,
    /// Whether the result was taken from an earlier run.
    pub cached: bool,
    /// The likely mistakes here, the likeliest first. They follow from all scenes together if these name one, else from
    /// this scene alone (made of [`SceneResult::explanations`]). Reports show these.
    pub settled: Vec<Explanation>,
    /// The number of explanations, the first of [`settled`](Self::settled), that all scenes together give.
    pub agreed: usize,
}

impl GroupGrade {
    /// Returns the points that can be reached in its scenes.
    #[must_use]
    pub fn max_points_of_scenes(&self) -> f64 {
        self.max_points - self.speed.as_ref().map_or(0.0, |speed| speed.marking.points)
    }

    /// Leaves of its scenes and its speed what students may know where groups are hidden from them.
    pub fn withhold(&mut self) {
        self.scenes.iter_mut().for_each(SceneGrade::withhold);
        if let Some(speed) = &mut self.speed {
            speed.source = SpeedSource::Withheld;
        }
    }
}

impl SceneGrade {
    /// Leaves what students may know where groups are hidden from them ([`SceneResult::withhold`]).
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
