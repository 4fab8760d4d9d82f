//! Searches for a smaller scene by attempts in a fixed order, until a whole pass of attempts makes nothing smaller.
use crate::{
    reductions::REDUCTIONS,
    size::{Size, measure_size},
};
use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};
use std::collections::BTreeSet;

/// A scene on which a program is wrong, after the search has made it as small as possible.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallScene {
    /// The smallest scene that was found.
    pub scene: Scene,
    /// The wrong step of the original scene, with which the search began.
    pub step: u32,
    /// Whether no single attempt makes the scene smaller. Otherwise the search was stopped.
    pub is_minimal: bool,
}

/// A function that runs the program, and returns whether the scene fails for the original reason, and only for that
/// reason if this is requested. The result `None` ends the search.
pub type RunProgram<'a> = dyn FnMut(&Scene, bool) -> Option<bool> + 'a;

/// Returns the smallest scene that a search finds. The search begins with the first of these scenes that fails only for
/// the original reason. If there is none, it begins with the first scene that also fails for other reasons. Returns
/// `None` if no scene fails for the original reason.
pub fn reduce(
    beginnings: &[(u32, Scene)],
    assignment: Assignment,
    is_reproduced: &mut RunProgram<'_>,
) -> Option<SmallScene> {
    for is_only_reason in [true, false] {
        for (step, scene) in beginnings {
            if is_reproduced(scene, is_only_reason)? {
                let size = measure_size(scene, assignment);
                let refuted = BTreeSet::new();
                let mut search =
                    Search { assignment, is_only_reason, is_reproduced, scene: scene.clone(), size, refuted };
                let is_minimal = search.run().is_some();
                return Some(SmallScene { scene: search.scene, step: *step, is_minimal });
            }
        }
    }
    None
}

/// A running search, with the best scene so far.
struct Search<'a, 'b> {
    assignment: Assignment,
    /// Whether scenes must fail only for the original reason.
    is_only_reason: bool,
    is_reproduced: &'a mut RunProgram<'b>,
    scene: Scene,
    size: Size,
    /// The scenes that do not fail for the original reason, as XML.
    refuted: BTreeSet<String>,
}

impl Search<'_, '_> {
    /// Searches until a whole pass of attempts makes nothing smaller, or returns `None` if the search had to end
    /// before.
    fn run(&mut self) -> Option<()> {
        loop {
            let size = self.size;
            for reduction in REDUCTIONS {
                let mut index = 0;
                while let Some(attempts) = reduction(&self.scene, self.assignment, index) {
                    // After a successful attempt, the same kind is tried again.
                    index += usize::from(!self.take_smaller(attempts)?);
                }
            }
            if self.size == size {
                return Some(());
            }
        }
    }

    /// Takes the first of these scenes that is smaller and fails for the original reason. Returns whether there is one,
    /// or `None` if the search must end.
    fn take_smaller(&mut self, attempts: Vec<Scene>) -> Option<bool> {
        for scene in attempts {
            let (size, xml) = (measure_size(&scene, self.assignment), scene::to_xml(&scene));
            if size >= self.size || self.refuted.contains(&xml) {
                continue;
            }
            if (self.is_reproduced)(&scene, self.is_only_reason)? {
                (self.size, self.scene) = (size, scene);
                return Some(true);
            }
            self.refuted.insert(xml);
        }
        Some(false)
    }
}
