//! The search: attempts in a fixed order, until a whole pass of them helps nothing.
use crate::{
    clear::clear_decisions,
    features::plainer,
    numbers::{rounder, transformed_scenes, turned_scenes},
    parts::PartKind,
    reason::WrongReason,
    size::SceneSize,
};
use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};
use std::collections::BTreeSet;

/// Passes after which the search ends even if the last one helped.
const MOST_PASSES: u32 = 8;

/// A scene on which a program is wrong, made as small as it gets.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallScene {
    /// The scene.
    pub scene: Scene,
    /// The wrong step of the scene with which the search began.
    pub step: u32,
    /// The number of runs of the program.
    pub runs: u32,
    /// Whether no single attempt makes it smaller; else the search was stopped.
    pub is_minimal: bool,
}

/// Whether the program is wrong on a scene for the reason; nothing stops the search.
pub type Holds<'a> = dyn Fn(&Scene) -> Option<bool> + 'a;

/// Whether the search must end now.
pub type EndTest<'a> = dyn Fn() -> bool + 'a;

/// Makes scenes smaller on which a program stays wrong for the same reason.
#[derive(Clone, Copy)]
pub struct Reducer<'a> {
    /// The reason.
    pub reason: &'a WrongReason,
    /// The milestone of the program.
    pub assignment: Assignment,
    /// Runs the program for each attempt.
    pub holds: &'a Holds<'a>,
    /// Ends the search as soon as this is true, also between two runs.
    pub is_over: &'a EndTest<'a>,
    /// The most runs.
    pub most_runs: u32,
}

impl Reducer<'_> {
    /// Begins with the first of these steps' scenes on which the program is wrong for the reason, and makes it smaller;
    /// `None` if there is no such scene.
    #[must_use]
    pub fn reduce(self, beginnings: Vec<(u32, Scene)>) -> Option<SmallScene> {
        for ((step, scene), runs) in beginnings.into_iter().zip(1..=self.most_runs) {
            if (self.holds)(&scene)? {
                let mut search = Search::new(&self, scene, runs);
                let is_minimal = search.run();
                return Some(SmallScene { scene: search.best, step, runs: search.runs, is_minimal });
            }
        }
        None
    }
}

/// A search under way.
struct Search<'a> {
    reducer: &'a Reducer<'a>,
    best: Scene,
    size: SceneSize,
    traits: SceneTraits,
    refuted: BTreeSet<String>,
    runs: u32,
    is_stopped: bool,
}

/// Properties of a scene that smaller ones keep.
#[derive(Clone, Copy, Default)]
struct SceneTraits {
    /// No decision depends on round-off.
    is_clear: bool,
    /// The reference with the named mistake is wrong on it.
    shows: bool,
    /// The number of warnings, and of parts that the assignment's library does not know.
    oddities: usize,
}

impl SceneTraits {
    fn new(scene: &Scene, reducer: &Reducer<'_>) -> Self {
        Self {
            is_clear: clear_decisions(scene).is_some(),
            shows: reducer.reason.shows(scene) == Some(true),
            oddities: oddities(scene, reducer.assignment).unwrap_or(usize::MAX),
        }
    }
}

impl<'a> Search<'a> {
    fn new(reducer: &'a Reducer<'a>, best: Scene, runs: u32) -> Self {
        let (traits, size) = (SceneTraits::new(&best, reducer), SceneSize::from_scene(&best));
        Self { reducer, best, size, traits, refuted: BTreeSet::new(), runs, is_stopped: false }
    }

    /// Searches until a whole pass helps nothing; returns whether that was so.
    fn run(&mut self) -> bool {
        for _ in 0..MOST_PASSES {
            let before = self.size;
            PartKind::ALL.into_iter().for_each(|kind| self.remove(kind));
            while self.take(plainer(&self.best, self.reducer.assignment)) {}
            while self.take(transformed_scenes(&self.best)) {}
            self.round();
            while self.take(turned_scenes(&self.best)) {}
            if self.is_stopped || self.size == before {
                break;
            }
        }
        !self.is_stopped
    }

    /// Removes halves of the parts, then quarters, down to single parts.
    fn remove(&mut self, kind: PartKind) {
        let mut length = kind.count(&self.best).div_ceil(2).max(1);
        loop {
            let count = kind.count(&self.best);
            // From the end, so that the rest keeps its numbers as long as possible.
            let starts = (0..count).step_by(length).rev();
            // One at a time: a scene of thousands of bodies has as many parts, and each attempt is a copy.
            let best = self.best.clone();
            let without = starts.map(|start| kind.without_parts(&best, &(start..(start + length).min(count))));
            if self.take(without) {
                continue;
            }
            if length == 1 || self.is_stopped {
                return;
            }
            length /= 2;
        }
    }

    /// Tries rounder numbers, one by one.
    fn round(&mut self) {
        let mut index = 0;
        while let Some(candidates) = rounder(&self.best, index) {
            if self.is_stopped {
                return;
            }
            // After a number that was taken there may be a rounder one.
            if !self.take(candidates) {
                index += 1;
            }
        }
    }

    /// Takes the first of these scenes that is smaller and on which the program is wrong for the reason.
    fn take(&mut self, candidates: impl IntoIterator<Item = Scene>) -> bool {
        for scene in candidates {
            self.is_stopped |= (self.reducer.is_over)();
            if self.is_stopped {
                break;
            }
            if !self.fits(&scene) {
                continue;
            }
            let may_run = self.runs < self.reducer.most_runs;
            let Some(holds) = may_run.then(|| (self.reducer.holds)(&scene)).flatten() else {
                self.is_stopped = true;
                break;
            };
            self.runs += 1;
            if holds {
                self.size = SceneSize::from_scene(&scene);
                self.traits = SceneTraits::new(&scene, self.reducer);
                self.best = scene;
                return true;
            }
            self.refuted.insert(scene::write(&scene));
        }
        false
    }

    /// Returns whether a scene is worth a run: smaller, with the properties that smaller ones keep, and not refuted.
    fn fits(&self, scene: &Scene) -> bool {
        SceneSize::from_scene(scene) < self.size
            && oddities(scene, self.reducer.assignment).is_some_and(|count| count <= self.traits.oddities)
            && (!self.traits.is_clear || clear_decisions(scene).is_some())
            && (!self.traits.shows || self.reducer.reason.shows(scene) != Some(false))
            && !self.refuted.contains(&scene::write(scene))
    }
}

/// Counts the warnings about a scene, and its parts that programs of the assignment do not know; `None` if it is not
/// sound.
fn oddities(scene: &Scene, assignment: Assignment) -> Option<usize> {
    let loaded = scene::read("", scene::write(scene).as_bytes()).ok().filter(|loaded| loaded.scene == *scene)?;
    Some(loaded.warnings.len() + scene.unknown_to(assignment).count())
}
