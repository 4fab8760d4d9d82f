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
        match self {
            Self::Bodies => {
                keep_edges(&mut scene, |edge| !parts.contains(&edge.0) && !parts.contains(&edge.1));
                scene.forces.retain(|force| bodies(force).iter().flatten().all(|body| !parts.contains(body)));
                scene.particles.drain(parts.clone());
                let moved = |index: &mut usize| *index -= if *index >= parts.end { parts.len() } else { 0 };
                scene.edges.iter_mut().flat_map(|edge| [&mut edge.first, &mut edge.second]).for_each(moved);
                for force in &mut scene.forces {
                    if let Force::Gravitation { first, second, .. } | Force::Vortex { first, second, .. } = force {
                        [first, second].into_iter().for_each(moved);
                    }
                }
            }
            Self::Edges => {
                let mut number = 0;
                keep_edges(&mut scene, |_| {
                    number += 1;
                    !parts.contains(&(number - 1))
                });
            }
            Self::HalfPlanes => _ = scene.half_planes.drain(parts.clone()),
            Self::Forces => _ = scene.forces.drain(parts.clone()),
        }
        scene
    }
}

/// Removes all edges but these, by their ends, and the springs on those.
fn keep_edges(scene: &mut Scene, mut keeps: impl FnMut((usize, usize)) -> bool) {
    let kept: Vec<bool> = scene.edges.iter().map(|edge| keeps((edge.first, edge.second))).collect();
    let mut old = kept.iter();
    scene.edges.retain(|_| old.next() == Some(&true));
    let before = |index: usize| kept[..index].iter().filter(|is_kept| **is_kept).count();
    scene.forces.retain_mut(|force| match force {
        Force::Spring { edge, .. } if !kept[*edge] => false,
        Force::Spring { edge, .. } => {
            *edge = before(*edge);
            true
        }
        _ => true,
    });
}

/// Returns the bodies that a force names, which the removal of bodies renumbers.
const fn bodies(force: &Force) -> [Option<usize>; 2] {
    match *force {
        Force::Gravitation { first, second, .. } | Force::Vortex { first, second, .. } => [Some(first), Some(second)],
        // A spring names its edge.
        Force::Spring { .. } | Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } => [None; 2],
    }
}
