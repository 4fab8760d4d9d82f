//! Grades as a shard keeps them for `merge`: everything that reports are made of.
use crate::{
    judge::Rules,
    suite::{
        Build, Grade, GroupGrade, SceneGrade, Verdict,
        config::Visibility,
        journal::{self, Key},
    },
};
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::time::Duration;

/// A grade, line by line of [`Grade`].
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct KeptGrade {
    pub(super) submission: String,
    suite: String,
    rules: String,
    verdict: String,
    points: Option<f64>,
    max_points: f64,
    groups: Vec<KeptGroup>,
    shows_output: bool,
    build: Option<KeptBuild>,
    warnings: Vec<String>,
    layers: Vec<String>,
    wall_seconds: f64,
    refuted: Vec<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct KeptBuild {
    succeeded: bool,
    end: String,
    output: String,
}

#[derive(Debug, Serialize, Deserialize)]
struct KeptGroup {
    name: String,
    visibility: String,
    points: Option<f64>,
    max_points: f64,
    verdict: String,
    scenes: Vec<KeptScene>,
}

#[derive(Debug, Serialize, Deserialize)]
struct KeptScene {
    /// As a line of the journal.
    result: Value,
    points: Option<f64>,
    max_points: f64,
    cached: bool,
}

impl KeptGrade {
    /// A grade to be kept.
    ///
    /// # Errors
    /// When a result can't be written as a line of the journal.
    pub(super) fn of(grade: &Grade) -> Result<Self> {
        let group = |group: &GroupGrade| {
            Ok(KeptGroup {
                name: group.name.clone(),
                visibility: group.visibility.key().to_owned(),
                points: group.points,
                max_points: group.max_points,
                verdict: group.verdict.words().to_owned(),
                scenes: group.scenes.iter().map(KeptScene::of).collect::<Result<_>>()?,
            })
        };
        Ok(Self {
            submission: grade.submission.clone(),
            suite: grade.suite.clone(),
            rules: grade.rules.name().to_owned(),
            verdict: grade.verdict.words().to_owned(),
            points: grade.points,
            max_points: grade.max_points,
            groups: grade.groups.iter().map(group).collect::<Result<_>>()?,
            shows_output: grade.shows_output,
            build: grade.build.as_ref().map(|build| KeptBuild {
                succeeded: build.succeeded,
                end: build.end.clone(),
                output: build.output.clone(),
            }),
            warnings: grade.warnings.clone(),
            layers: grade.layers.clone(),
            wall_seconds: grade.wall.as_secs_f64(),
            refuted: grade.refuted.clone(),
        })
    }

    /// The grade again.
    ///
    /// # Errors
    /// When something in it is not what a grader writes.
    pub(super) fn into_grade(self) -> Result<Grade> {
        let groups = self.groups.into_iter().map(KeptGroup::into_group).collect::<Result<_>>();
        Ok(Grade {
            groups: groups.with_context(|| format!("the grade of {}", self.submission))?,
            submission: self.submission,
            suite: self.suite,
            rules: Rules::from_name(&self.rules).context("rules that nobody knows")?,
            verdict: verdict(&self.verdict)?,
            points: self.points,
            max_points: self.max_points,
            shows_output: self.shows_output,
            build: self.build.map(|build| Build { succeeded: build.succeeded, end: build.end, output: build.output }),
            warnings: self.warnings,
            layers: self.layers,
            wall: Duration::try_from_secs_f64(self.wall_seconds).unwrap_or_default(),
            refuted: self.refuted,
        })
    }
}

impl KeptGroup {
    fn into_group(self) -> Result<GroupGrade> {
        Ok(GroupGrade {
            name: self.name,
            visibility: Visibility::from_key(&self.visibility).context("a visibility that nobody knows")?,
            points: self.points,
            max_points: self.max_points,
            verdict: verdict(&self.verdict)?,
            scenes: self.scenes.into_iter().map(KeptScene::into_scene).collect::<Result<_>>()?,
        })
    }
}

impl KeptScene {
    fn of(scene: &SceneGrade) -> Result<Self> {
        // What a result depends on is the journal's concern: nobody looks for this one by its key.
        let key = Key::of(&blake3::hash(b""), b"", &[]);
        let line = journal::line(&key, "", &scene.result);
        Ok(Self {
            result: serde_json::from_slice(&line).context("a result can't be kept")?,
            points: scene.points,
            max_points: scene.max_points,
            cached: scene.cached,
        })
    }

    fn into_scene(self) -> Result<SceneGrade> {
        let line = serde_json::to_vec(&self.result)?;
        let (_, result) = journal::read_line(&line).context("a result that is damaged, or another version's")?;
        Ok(SceneGrade { result, points: self.points, max_points: self.max_points, cached: self.cached })
    }
}

fn verdict(words: &str) -> Result<Verdict> {
    Verdict::from_words(words).with_context(|| format!("there is no verdict {words:?}"))
}
