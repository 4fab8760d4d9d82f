//! Programs and scenes as the tools try them: the traces that programs write, and what the judge says of these.
use anyhow::{Context, ensure};
use fosssim_oracle::{
    assignments::Assignment,
    diagnose::probe_scenes,
    judge::{
        Outcome,
        fair::FairVerdict,
        replay::{self, Options},
    },
    scene::{Scene, original},
    sim::{RootSearch, Simulation},
    student::{self, Student},
    suite::{
        plan,
        scene_files::{self, SceneFile},
    },
    trace::{Frame, Layout, Reader, Recorder},
};
use rayon::prelude::*;
use std::path::Path;

/// The trace that a program writes; where it does not come to an end, what it has written by then.
#[must_use]
pub fn trace(scene: &Scene, student: Student) -> Vec<u8> {
    student::trace(scene, student).unwrap_or_else(|(bytes, _)| bytes)
}

/// The reference's own trace; nothing where a step has no result.
#[must_use]
pub fn reference(scene: &Scene) -> Option<Vec<u8>> {
    let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
    let mut recorder = Recorder::start(Vec::new(), Layout::of(scene), simulation.state());
    (0..scene.steps()).try_for_each(|_| simulation.step(&mut recorder)).ok()?;
    Some(recorder.finish().ok()?.0)
}

/// The records of a trace, up to the first that can't be read.
#[must_use]
pub fn frames(scene: &Scene, trace: &[u8]) -> Vec<Frame> {
    let (mut reader, mut frame, mut all) = (Reader::of_slice(trace, Layout::of(scene)), Frame::default(), Vec::new());
    while reader.next(&mut frame).unwrap_or(false) {
        all.push(std::mem::take(&mut frame));
    }
    all
}

/// How the tools judge: on one thread, since they try many things at one time.
#[must_use]
pub fn options(fair: bool) -> Options {
    Options { threads: 1, fair, ..Options::default() }
}

/// The outcome by both rule books.
#[must_use]
pub fn judged(scene: &Scene, trace: &[u8]) -> Outcome {
    replay::judge(scene, trace, &options(true), &mut ())
}

/// Whether the fair rules accept.
#[must_use]
pub fn is_accepted(outcome: &Outcome) -> bool {
    outcome.fair.as_ref().is_some_and(|fair| fair.verdict == FairVerdict::Accepted)
}

/// A scene with the trace of a right program.
#[derive(Debug)]
pub struct Watched {
    /// Its name.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// The trace of a right program.
    pub right: Vec<u8>,
}

impl Watched {
    /// Prepares a scene.
    #[must_use]
    pub fn new(name: String, scene: Scene) -> Self {
        let right = trace(&scene, Student::default());
        Self { name, scene, right }
    }

    /// The scenes in the groups of a folder.
    ///
    /// # Errors
    /// When one can't be read, or there is none.
    pub fn of_folder(folder: &Path) -> anyhow::Result<Vec<Self>> {
        let files =
            scene_files::list(folder, ".xml").with_context(|| format!("{}: can't be read", folder.display()))?;
        ensure!(!files.is_empty(), "{}: no group of this folder holds a scene", folder.display());
        let watched = |SceneFile { name, path, .. }: SceneFile| -> anyhow::Result<Self> {
            let scene = original::read(&std::fs::read(&path)?).with_context(|| path.display().to_string())?.scene;
            Ok(Self::new(name, scene))
        };
        files.into_par_iter().map(watched).collect()
    }

    /// The scenes of a suite, those first that take the least time.
    ///
    /// # Errors
    /// When there is no such suite.
    pub fn of_suite(suite: &str) -> anyhow::Result<Vec<Self>> {
        let plan = plan::find(suite)?;
        let mut scenes: Vec<Self> =
            plan.scenes().map(|task| Self::new(task.name.clone(), task.scene.clone())).collect();
        scenes.sort_by_key(|scene| scene.right.len());
        Ok(scenes)
    }

    /// The probe scenes.
    #[must_use]
    pub fn probes() -> Vec<Self> {
        probe_scenes(Assignment::DEFAULT).into_iter().map(|(name, scene)| Self::new(name, scene)).collect()
    }

    /// Whether the fair rules refuse what this program writes; a program that does not come to an end has written less.
    #[must_use]
    pub fn refuses(&self, student: Student) -> bool {
        let trace = trace(&self.scene, student);
        trace != self.right && !is_accepted(&judged(&self.scene, &trace))
    }
}
