//! The pairs that a penalty force sums, and their order.
//!
//! A detection pass has one order (collisions.md 1). The contest's detection has another (Theme 2, Milestone 3): the
//! original sweeps along x, and a pair of particles counts when the later of the two begins, where a particle begins at
//! its lowest x. Then particles and edges follow, sorted by particle and edge, then particles and half-planes.
use crate::{
    scene::{CollisionDetection, Scene},
    sim::{
        nearby::{NearPairs, Nearby, is_beyond},
        pair::{Pair, PairKind, pair},
        pairs::{Objects, PassCursor, is_end},
    },
};
use fosssim_num::vector::{Vec2, at};
use std::cmp::Ordering;

/// The pairs of a scene's penalty force, with the memory to find those that are near.
#[derive(Debug, Clone)]
pub struct PenaltyPairs {
    radii: Vec<f64>,
    edges: Vec<[usize; 2]>,
    half_planes: usize,
    thickness: f64,
    nearby: Option<Nearby>,
    sweep: Option<Sweep>,
}

impl PenaltyPairs {
    /// The pairs for the bodies of a scene and this thickness.
    #[must_use]
    pub fn new(scene: &Scene, thickness: f64, detection: CollisionDetection) -> Self {
        Self {
            radii: scene.particles.iter().map(|particle| particle.radius).collect(),
            edges: scene.edges.iter().map(|edge| [edge.first, edge.second]).collect(),
            half_planes: scene.half_planes.len(),
            thickness,
            nearby: Nearby::of_many(scene, thickness),
            sweep: (detection == CollisionDetection::Contest).then(Sweep::default),
        }
    }

    /// Hands all pairs to `hear`, in the order in which they are summed, that may be closer at positions `x` (2N) than
    /// their radii and the thickness. In large scenes few others are among them.
    pub fn visit(&mut self, x: &[f64], mut hear: impl FnMut(Pair)) {
        let particles = self.radii.len();
        let edges = &self.edges;
        let objects = Objects { particles, edges: edges.len(), half_planes: self.half_planes };
        let row = |i: usize| objects.row(PassCursor::of(i));
        let edges_of = |i: usize| (0..edges.len()).filter(move |&edge| !is_end(edges[edge], i));
        let found = self.nearby.as_mut().and_then(|nearby| nearby.find(x));
        if let Some(sweep) = &mut self.sweep {
            sweep.particles(&self.radii, x, found.as_ref(), |i, j| hear(pair(PairKind::ParticleParticle, i, j)));
            match &found {
                Some(found) => found.edges().for_each(|[i, edge]| hear(pair(PairKind::ParticleEdge, i, edge))),
                None => (0..particles)
                    .for_each(|i| edges_of(i).for_each(|edge| hear(pair(PairKind::ParticleEdge, i, edge)))),
            }
            for i in 0..particles {
                let [.., half_planes] = row(i);
                half_planes.for_each(|half_plane| hear(pair(PairKind::ParticleHalfPlane, i, half_plane)));
            }
            return;
        }
        let mut found = found.map(NearPairs::sorted);
        for i in 0..particles {
            let [others, _, half_planes] = row(i);
            if let Some(found) = &mut found {
                let [others, edges] = found.next(i);
                others.for_each(|j| hear(pair(PairKind::ParticleParticle, i, j)));
                edges.for_each(|edge| hear(pair(PairKind::ParticleEdge, i, edge)));
            } else {
                // Nearly all others are beyond reach, which is asked here with as few instructions as possible.
                let (own, radius) = (at(x, i), self.radii[i]);
                let places = x.as_chunks::<2>().0[others.clone()].iter().zip(&self.radii[others.clone()]);
                for (j, (&other, other_radius)) in others.zip(places) {
                    if !is_beyond(Vec2::from(other) - own, (radius + other_radius) + self.thickness) {
                        hear(pair(PairKind::ParticleParticle, i, j));
                    }
                }
                edges_of(i).for_each(|edge| hear(pair(PairKind::ParticleEdge, i, edge)));
            }
            half_planes.for_each(|half_plane| hear(pair(PairKind::ParticleHalfPlane, i, half_plane)));
        }
    }
}

/// The memory of sweeps.
#[derive(Debug, Clone, Default)]
struct Sweep {
    order: Vec<Begin>,
    pairs: Vec<[Begin; 2]>,
}

/// Where a particle begins.
#[derive(Debug, Clone, Copy)]
struct Begin {
    x: f64,
    particle: u32,
}

impl Begin {
    #[expect(clippy::cast_possible_truncation, reason = "a scene with 2^32 objects does not fit into memory")]
    fn of(particle: usize, radii: &[f64], x: &[f64]) -> Self {
        Self { x: at(x, particle).x - radii[particle], particle: particle as u32 }
    }

    /// Particles that begin at the same place come in the order of the scene.
    fn cmp(&self, other: &Self) -> Ordering {
        self.x.partial_cmp(&other.x).unwrap_or(Ordering::Equal).then(self.particle.cmp(&other.particle))
    }
}

impl Sweep {
    /// Hands all pairs of particles to `hear`, those that were found if they were, the smaller number first.
    fn particles(
        &mut self,
        radii: &[f64],
        x: &[f64],
        found: Option<&NearPairs<'_>>,
        mut hear: impl FnMut(usize, usize),
    ) {
        let mut hear = |[one, other]: [&Begin; 2]| {
            let (one, other) = (one.particle as usize, other.particle as usize);
            hear(one.min(other), one.max(other));
        };
        let Self { order, pairs } = self;
        if let Some(found) = found {
            let pair = |both: [usize; 2]| {
                let [one, other] = both.map(|particle| Begin::of(particle, radii, x));
                if one.cmp(&other) == Ordering::Less { [one, other] } else { [other, one] }
            };
            pairs.clear();
            pairs.extend(found.particles().map(pair));
            pairs.sort_unstable_by(|a, b| a[0].cmp(&b[0]).then_with(|| a[1].cmp(&b[1])));
            pairs.iter().for_each(|pair| hear(pair.each_ref()));
            return;
        }
        order.clear();
        // A particle that is nowhere reaches nothing, and has no place in an order.
        order.extend((0..radii.len()).map(|particle| Begin::of(particle, radii, x)).filter(|begin| !begin.x.is_nan()));
        order.sort_unstable_by(Begin::cmp);
        for (index, one) in order.iter().enumerate() {
            order[index + 1..].iter().for_each(|other| hear([one, other]));
        }
    }
}
