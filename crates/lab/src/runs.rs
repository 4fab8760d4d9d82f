//! Runs programs on scenes for the tools: gives the traces that programs write, and the judge's results for them.
use anyhow::{Context, ensure};
use fosssim_oracle::{
    judge::{
        Outcome,
        fair::FairVerdict,
        replay::{self, Options},
    },
    scene::{Scene, original},
    student::{self, Student},
    suite::scene_files::{self, SceneFile},
};
use rayon::prelude::*;
use std::path::Path;

/// Returns the trace that a program writes, or the part written so far if the program does not end.
pub fn record_trace(scene: &Scene, student: Student) -> Vec<u8> {
    student::record_trace(scene, student).unwrap_or_else(|(bytes, _)| bytes)
}

/// Returns the outcome by both rule books, on one thread, because the tools try many programs at one time.
pub fn judge_trace(scene: &Scene, trace: &[u8]) -> Outcome {
    replay::judge(scene, trace, &Options { threads: 1, uses_fair_rules: true, ..Options::default() }, &mut ())
}

/// Returns whether the fair rules accept the trace.
pub fn is_accepted(outcome: &Outcome) -> bool {
    outcome.fair.as_ref().is_some_and(|fair| fair.verdict == FairVerdict::Accepted)
}

/// A scene with the trace of a correct program.
#[derive(Debug)]
pub struct WatchedScene {
    /// The scene's name.
    pub name: String,
    /// The scene that the programs simulate.
    pub scene: Scene,
    /// The trace of a correct program.
    pub right: Vec<u8>,
}

impl WatchedScene {
    /// Returns the scenes in the groups of a folder.
    ///
    /// # Errors
    /// Fails if one cannot be read, or there are none.
    pub fn from_folder(folder: &Path) -> anyhow::Result<Vec<Self>> {
        let files =
            scene_files::list_files(folder, ".xml").with_context(|| format!("{}: can't be read", folder.display()))?;
        ensure!(!files.is_empty(), "{}: no group of this folder contains a scene", folder.display());
        let watched = |SceneFile { name, path, .. }: SceneFile| -> anyhow::Result<Self> {
            let scene = original::read(&std::fs::read(&path)?).with_context(|| path.display().to_string())?.scene;
            let right = record_trace(&scene, Student::default());
            Ok(Self { name, scene, right })
        };
        files.into_par_iter().map(watched).collect()
    }
}
