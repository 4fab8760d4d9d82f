//! Removes parts of a scene with all that depends on them: edges with their ends, forces with their bodies.
use fosssim_model::scene::{Force, Scene};
use std::ops::Range;

fosssim_num::closed_set! {
    /// The kinds of parts, in the order in which they are removed.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum PartKind {
        /// Particles, with their edges, and the forces on both.
        Bodies,
        /// Edges, with their springs.
        Edges,
        /// Half-planes.
        HalfPlanes,
        /// Forces.
        Forces,
    }
}

impl PartKind {
    /// Counts a scene's parts of this kind.
    pub(crate) const fn count(self, scene: &Scene) -> usize {
        match self {
            Self::Bodies => scene.particles.len(),
            Self::Edges => scene.edges.len(),
            Self::HalfPlanes => scene.half_planes.len(),
            Self::Forces => scene.forces.len(),
        }
    }

    /// Returns the scene without these parts.
    pub(crate) fn without_parts(self, scene: &Scene, parts: &Range<usize>) -> Scene {
        let mut scene = scene.clone();
        let without = |index: usize| match index {
            index if parts.contains(&index) => None,
            index if index < parts.start => Some(index),
            index => Some(index - parts.len()),
        };
        match self {
            Self::Bodies => {
                scene.particles.drain(parts.clone());
                renumber(&mut scene, &without, &Some);
            }
            Self::Edges => renumber(&mut scene, &Some, &without),
            Self::HalfPlanes => _ = scene.half_planes.drain(parts.clone()),
            Self::Forces => _ = scene.forces.drain(parts.clone()),
        }
        scene
    }
}

/// The new number of a part; `None` if it is removed.
type NewNumber<'a> = dyn Fn(usize) -> Option<usize> + 'a;

/// Gives bodies and edges their new numbers, and removes edges and forces that depend on removed ones.
fn renumber(scene: &mut Scene, body: &NewNumber<'_>, edge: &NewNumber<'_>) {
    let set = |new: Option<usize>, index: &mut usize| new.inspect(|new| *index = *new).is_some();
    let mut edges: Vec<Option<usize>> = Vec::new();
    scene.edges.retain_mut(|one| {
        let is_kept = edge(edges.len()).is_some()
            && set(body(one.first), &mut one.first)
            && set(body(one.second), &mut one.second);
        edges.push(is_kept.then(|| edges.iter().flatten().count()));
        is_kept
    });
    scene.forces.retain_mut(|force| match force {
        Force::Spring { edge, .. } => set(edges[*edge], edge),
        Force::Gravitation { first, second, .. } | Force::Vortex { first, second, .. } => {
            set(body(*first), first) && set(body(*second), second)
        }
        Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } => true,
    });
}
