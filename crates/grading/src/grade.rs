//! The grade: what one submission got, scene by scene.
use super::{
    config::Visibility,
    located::Located,
    mirror,
    result::{BuildEnd, SceneResult},
    verdict::Verdict,
};
use fosssim_judge::Rules;
use fosssim_mistakes::diagnose::{Explanation, settled, several};
use serde::{Deserialize, Serialize};
use std::{borrow::Cow, ops::Deref, time::Duration};

/// The grade of one submission on one suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grade {
    /// The submission's name: its file or folder name.
    pub submission: String,
    /// The suite's name.
    pub suite: String,
    /// The rule books that were asked; verdicts and points are by the official one.
    #[serde(with = "mirror::rules")]
    pub rules: Rules,
    /// The worst verdict of all scenes.
    pub verdict: Verdict,
    /// Points reached; `None` when the grader failed or was stopped before the last scene, which is nobody's zero.
    pub points: Option<f64>,
    /// Points that can be reached.
    pub max_points: f64,
    /// Groups in the suite's order.
    pub groups: Vec<GroupGrade>,
    /// Whether reports for students show of a scene what the program could have chosen, as what it printed: not where
    /// groups are hidden, unless the suite says so.
    pub shows_output: bool,
    /// How the build ended, when the suite builds.
    pub build: Option<Build>,
    /// What weakened the sandbox, in words; empty when every required layer held.
    pub warnings: Vec<String>,
    /// Layers of the sandbox that were active.
    pub layers: Vec<String>,
    /// Wall time of all runs together, those taken from an earlier grading included.
    pub wall: Duration,
    /// Keys of mistakes that accepted scenes speak against
    /// ([`diagnose::refuted`](fosssim_mistakes::diagnose::refuted)).
    pub refuted: Vec<String>,
    /// What the scenes have in common in which the program crashes or runs into a limit, where hints let it through.
    pub located: Option<Located>,
}

impl Grade {
    /// Whether all groups are for students' eyes.
    #[must_use]
    pub fn is_visible(&self) -> bool {
        self.groups.iter().all(|group| group.visibility == Visibility::Visible)
    }

    /// The grade with nothing in it but what students see at once: points and verdict are those of the groups that are
    /// left. Unless the suite shows all that programs print, scenes tell their verdicts only
    /// ([`SceneResult::withhold`]).
    #[must_use]
    pub fn for_students(&self) -> Cow<'_, Self> {
        if self.is_visible() {
            return Cow::Borrowed(self);
        }
        let is_visible = |group: &&GroupGrade| group.visibility == Visibility::Visible;
        let groups: Vec<GroupGrade> = self.groups.iter().filter(is_visible).cloned().collect();
        let mut visible = Self {
            verdict: groups.iter().map(|group| group.verdict).max().unwrap_or(Verdict::NotRun),
            points: groups.iter().map(|group| group.points).sum(),
            max_points: groups.iter().map(|group| group.max_points).sum(),
            groups,
            // It counts scenes that are not here.
            located: None,
            wall: Duration::ZERO,
            ..self.clone()
        };
        if self.shows_output {
            visible.settle();
        } else {
            for scene in visible.groups.iter_mut().flat_map(|group| &mut group.scenes) {
                scene.withhold();
            }
        }
        Cow::Owned(visible)
    }

    /// All scenes in order.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneGrade> {
        self.groups.iter().flat_map(|group| &group.scenes)
    }

    /// Whether the grader failed somewhere, so that the grade must not reach a student.
    #[must_use]
    pub fn is_our_fault(&self) -> bool {
        self.verdict == Verdict::JudgeError
    }

    /// Whether scenes were not run, so that there are no points yet.
    #[must_use]
    pub fn is_incomplete(&self) -> bool {
        self.count(Verdict::NotRun) > 0
    }

    /// What is wrong with the submission itself, and the reason of each of its scenes: no program that can be run is in
    /// it, its sources do not build, or nothing is written yet.
    #[must_use]
    pub fn unfit(&self) -> Option<Unfit<'_>> {
        let first = self.scenes().next()?;
        let is_unfit = matches!(first.verdict, Verdict::Unusable | Verdict::CompileError | Verdict::Unwritten);
        let why = |scene: &SceneGrade| (scene.verdict, scene.reason.clone(), scene.ended.clone());
        let same = |scene: &SceneGrade| why(scene) == why(first);
        let build = self.build.as_ref().filter(|build| !build.end.is_success());
        (is_unfit && self.scenes().all(same))
            .then(|| build.map_or(Unfit::Scene(&first.result), |build| Unfit::Build(&build.end)))
    }

    /// Whether two grades are of one suite: of the same scenes, in the same groups, for the same points.
    #[must_use]
    pub fn is_of_the_suite_of(&self, other: &Self) -> bool {
        let alike = |(own, other): (&GroupGrade, &GroupGrade)| {
            (&own.name, own.visibility, own.max_points) == (&other.name, other.visibility, other.max_points)
                && own.scenes.iter().map(|scene| &scene.scene).eq(other.scenes.iter().map(|scene| &scene.scene))
        };
        (&self.suite, self.rules, self.shows_output) == (&other.suite, other.rules, other.shows_output)
            && self.groups.len() == other.groups.len()
            && self.groups.iter().zip(&other.groups).all(alike)
    }

    /// How many of the results were taken from an earlier run.
    #[must_use]
    pub fn taken_over(&self) -> usize {
        self.scenes().filter(|scene| scene.cached).count()
    }

    /// How many scenes the two rule books judge differently.
    #[must_use]
    pub fn differing(&self) -> usize {
        self.scenes().filter(|scene| scene.differs.is_some()).count()
    }

    /// The mistake that explains most wrong scenes, where several have explanations: together they nearly always tell
    /// mistakes apart that one scene can't.
    #[must_use]
    pub fn likely_mistake(&self) -> Option<Explanation> {
        let explained = self.scenes().filter(|scene| !scene.explanations.is_empty()).count();
        if explained > 1 { self.likely_mistakes().into_iter().next().map(|(likely, _)| likely) } else { None }
    }

    /// The likely mistakes, at most three, with the number of wrong scenes that each explains: the one that explains
    /// most, then of what is left the one that explains most of it, provided that it explains it completely
    /// ([`several`]).
    #[must_use]
    pub fn likely_mistakes(&self) -> Vec<(Explanation, usize)> {
        several(self.scenes().map(|scene| scene.explanations.as_slice()), &self.refuted)
            .into_iter()
            .filter(|likely| likely.reproduced > 0 || likely.is_of_stage() || likely.is_not_finite())
            .map(|likely| (likely.clone(), self.explained_by(&likely)))
            .collect()
    }

    /// How many scenes' explanations name this mistake, or a stage of what is not written yet.
    #[must_use]
    pub fn explained_by(&self, mistake: &Explanation) -> usize {
        self.scenes().filter(|scene| mistake.is_named_in(&scene.explanations)).count()
    }

    /// Settles by all scenes together what is said of each ([`SceneGrade::settled`]). A caller that leaves groups out
    /// of a grade asks again, so that nothing of them is told.
    pub fn settle(&mut self) {
        let likely: Vec<Explanation> = match self.likely_mistake() {
            Some(_) => self.likely_mistakes().into_iter().map(|(one, _)| one).collect(),
            None => Vec::new(),
        };
        for scene in self.groups.iter_mut().flat_map(|group| &mut group.scenes) {
            let of_scene = settled(&scene.result.explanations, &likely);
            (scene.settled, scene.agreed) = (of_scene.explanations, of_scene.agreed);
        }
    }

    /// How many scenes have this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.scenes().filter(|scene| scene.verdict == verdict).count()
    }
}

/// An entry of a class's folder that is no submission, and why: nobody is left out in silence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PassedOver {
    /// Its name, as that of a submission ([`names`](crate::names)).
    pub name: String,
    /// Why, in words.
    pub why: String,
}

/// The build step's end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Build {
    /// How it ended.
    pub end: BuildEnd,
    /// The compiler's output, capped; raw text that a report has to escape.
    pub output: String,
}

/// What is wrong with a submission itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unfit<'a> {
    /// Its build.
    Build(&'a BuildEnd),
    /// What its first scene says, and all others with it.
    Scene(&'a SceneResult),
}

/// One group of scenes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupGrade {
    /// Its name.
    pub name: String,
    /// Who sees it.
    pub visibility: Visibility,
    /// Points reached; `None` when a scene has none.
    pub points: Option<f64>,
    /// Points that can be reached.
    pub max_points: f64,
    /// The worst verdict of its scenes.
    pub verdict: Verdict,
    /// Its scenes.
    pub scenes: Vec<SceneGrade>,
}

/// One scene with its points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneGrade {
    /// What happened.
    pub result: SceneResult,
    /// Points reached; `None` when the grader failed or did not come to run it, which is nobody's zero.
    pub points: Option<f64>,
    /// Points that can be reached.
    pub max_points: f64,
    /// Whether the result was taken from an earlier run.
    pub cached: bool,
    /// What is likely wrong here, the likeliest first: what all scenes together say of this one, else what it says
    /// alone ([`SceneResult::explanations`], of which [`Grade::settle`] makes it). This is what reports tell.
    #[serde(with = "mirror::explanations")]
    pub settled: Vec<Explanation>,
    /// The number of explanations, the first of [`settled`](Self::settled), that all scenes together give.
    pub agreed: usize,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        config::{Credit, Marking},
        result::Reason,
        score,
    };
    use fosssim_mistakes::diagnose::{About, NanStage, NotFinite};

    fn told(key: &str, about: About, reproduced: u64) -> Explanation {
        Explanation {
            key: key.to_owned(),
            about,
            details: Vec::new(),
            reproduced,
            samples: reproduced,
            example: None,
            same_as: Vec::new(),
            denies: Vec::new(),
            claims: Vec::new(),
        }
    }

    fn grade(scenes: Vec<Vec<Explanation>>) -> Grade {
        let wrong = |(number, explanations): (usize, Vec<Explanation>)| {
            let run = SceneResult::without_run(&format!("a/{number}"), 9, Verdict::WrongAnswer, Reason::Right);
            (SceneResult { explanations, ..run }, false)
        };
        let marking = Marking { points: 1.0, credit: Credit::Scenes, visibility: Visibility::Visible };
        let results = scenes.into_iter().enumerate().map(wrong).collect();
        let mut grade = Grade {
            submission: String::new(),
            suite: String::new(),
            rules: Rules::Fair,
            verdict: Verdict::WrongAnswer,
            points: Some(0.0),
            max_points: 1.0,
            groups: vec![score::group("a", marking, results)],
            shows_output: true,
            build: None,
            warnings: Vec::new(),
            layers: Vec::new(),
            wall: Duration::ZERO,
            refuted: Vec::new(),
            located: None,
        };
        grade.settle();
        grade
    }

    /// What all scenes together say stands with each that it explains; where numbers end is told of each by itself.
    #[test]
    fn each_scene_says_what_all_together_say() {
        let end = |step, stage| {
            told(Explanation::NOT_FINITE, About::NotFinite(NotFinite { step: Some(step), stage, is_nan: true }), 0)
        };
        let short = told("loop-one-fewer", About::Mistake, 4);
        let empty = Explanation { same_as: vec!["loop-one-fewer".to_owned()], ..told("loop-empty", About::Mistake, 2) };
        let grade = grade(vec![
            vec![empty],
            vec![end(7, NanStage::Zones), short.clone()],
            vec![end(3, NanStage::Zones), short],
            vec![end(5, NanStage::Responses)],
        ]);
        let heads: Vec<(String, usize)> =
            grade.likely_mistakes().into_iter().map(|(one, count)| (one.key, count)).collect();
        assert_eq!(heads, [(Explanation::NOT_FINITE.to_owned(), 2), ("loop-one-fewer".to_owned(), 3)]);
        let said: Vec<Vec<&str>> =
            grade.scenes().map(|scene| scene.settled.iter().map(|one| one.key.as_str()).collect()).collect();
        let both = [Explanation::NOT_FINITE, "loop-one-fewer"];
        assert_eq!(said, [&both[1..], &both, &both, &both[..1]]);
        let steps: Vec<Option<u32>> = grade
            .scenes()
            .filter_map(|scene| match &scene.settled[0].about {
                About::NotFinite(found) => Some(found.step),
                _ => None,
            })
            .collect();
        assert_eq!(steps, [Some(7), Some(3), Some(5)]);
    }
}
