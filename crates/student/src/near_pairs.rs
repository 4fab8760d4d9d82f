//! A search for nearby pairs that misses some pairs, or finds some twice.
use fosssim_model::sim::PairKind;
use fosssim_num::vector::{Vec2, vector_at};

use super::{StepMistake, world::World};

/// The search for nearby pairs at certain positions.
pub struct NearPairSearch<'a> {
    world: &'a World,
    h: f64,
    /// The positions that are checked.
    x: Vec<f64>,
    /// The rank of each particle among all particles, sorted by their smallest x-coordinates. The list is empty if the
    /// student's mistake does not need it.
    ranks: Vec<usize>,
}

/// A body's bounding box, as its lower and upper corners.
type BoundingBox = [Vec2; 2];

impl<'a> NearPairSearch<'a> {
    /// Creates the search at positions `x`, which the particles reached with velocities `v`, for layers of thickness
    /// `h`.
    pub fn new(world: &'a World, h: f64, x: &[f64], v: &[f64]) -> Self {
        let student = world.student;
        let start = || world.initial_state().x;
        let x = match () {
            () if student.makes(StepMistake::NearPairsOfStart) => start(),
            // The first step has no previous step.
            () if student.makes(StepMistake::NearPairsOfLastStep) && x != start() => {
                x.iter().zip(v).map(|(x, v)| x - world.scene.time_step * v).collect()
            }
            () => x.to_vec(),
        };
        let mut ranks = Vec::new();
        if student.makes(StepMistake::NearPairsNeighborsOnly) {
            let begin = |i: usize| x[2 * i] - world.scene.particles[i].radius;
            let mut order: Vec<usize> = (0..world.scene.particles.len()).collect();
            order.sort_by(|&one, &other| begin(one).total_cmp(&begin(other)));
            ranks = vec![0; order.len()];
            order.into_iter().enumerate().for_each(|(rank, particle)| ranks[particle] = rank);
        }
        Self { world, h, x, ranks }
    }

    /// Returns how many times the student's program finds a nearby pair: 0, 1 or 2.
    pub fn pair_count(&self, kind: PairKind, one: usize, other: usize) -> u32 {
        if !self.is_found(kind, one, other) {
            return 0;
        }
        let makes = |mistake: StepMistake| self.world.student.makes(mistake);
        let is_doubled = match kind {
            PairKind::ParticleParticle => false,
            PairKind::ParticleEdge => makes(StepMistake::NearPairsEdgesDoubled),
            PairKind::ParticleHalfPlane => makes(StepMistake::NearPairsHalfPlanesDoubled),
        };
        if is_doubled || makes(StepMistake::NearPairsDoubled) { 2 } else { 1 }
    }

    fn is_found(&self, kind: PairKind, one: usize, other: usize) -> bool {
        let makes = |mistake: StepMistake| self.world.student.makes(mistake);
        let scene = &self.world.scene;
        let (last, is_two) = (scene.particles.len() - 1, kind == PairKind::ParticleParticle);
        let is_either = |particle: usize| one == particle || (is_two && other == particle);
        if (makes(StepMistake::NearPairsFirstMissing) && is_either(0))
            || (makes(StepMistake::NearPairsLastMissing) && is_either(last))
        {
            return false;
        }
        if makes(StepMistake::NearPairsFixedSkipped) {
            let is_fixed = |particle: usize| self.world.is_fixed(particle);
            if is_fixed(one) || (is_two && is_fixed(other)) {
                return false;
            }
        }
        match kind {
            PairKind::ParticleParticle => {
                let are_neighbors = self.ranks.is_empty() || self.ranks[one].abs_diff(self.ranks[other]) == 1;
                are_neighbors && self.boxes_meet(self.particle_box(one), self.particle_box(other))
            }
            PairKind::ParticleEdge => {
                !(makes(StepMistake::NearPairsLastEdgeMissing) && other + 1 == scene.edges.len())
                    && self
                        .edge_boxes(other)
                        .into_iter()
                        .any(|edge_box| self.boxes_meet(self.particle_box(one), edge_box))
            }
            PairKind::ParticleHalfPlane => {
                !(makes(StepMistake::NearPairsLastHalfPlaneMissing) && other + 1 == scene.half_planes.len())
            }
        }
    }

    fn boxes_meet(&self, one: BoundingBox, other: BoundingBox) -> bool {
        let makes = |mistake: StepMistake| self.world.student.makes(mistake);
        let looks = [
            StepMistake::NearPairsBoxesOfPoints,
            StepMistake::NearPairsEdgeEnds,
            StepMistake::NearPairsEdgeFirstEnd,
            StepMistake::NearPairsOfStart,
            StepMistake::NearPairsOfLastStep,
        ];
        // Without these mistakes, the boxes of a nearby pair always overlap.
        !looks.into_iter().any(makes)
            || (0..2).all(|axis| one[0][axis] <= other[1][axis] && other[0][axis] <= one[1][axis])
    }

    fn particle_box(&self, particle: usize) -> BoundingBox {
        let is_point = self.world.student.makes(StepMistake::NearPairsBoxesOfPoints);
        let radius = if is_point { 0.0 } else { self.world.scene.particles[particle].radius };
        let (center, side) = (vector_at(&self.x, particle), radius + 0.5 * self.h);
        [center - Vec2::new(side, side), center + Vec2::new(side, side)]
    }

    /// Returns the boxes of an edge in this student's program. The search finds the edge if one of them overlaps.
    fn edge_boxes(&self, edge: usize) -> Vec<BoundingBox> {
        let edge = self.world.scene.edges[edge];
        let side = edge.radius + 0.5 * self.h;
        let around = |low: Vec2, high: Vec2| [low - Vec2::new(side, side), high + Vec2::new(side, side)];
        let (first, second) = (vector_at(&self.x, edge.first), vector_at(&self.x, edge.second));
        match () {
            () if self.world.student.makes(StepMistake::NearPairsEdgeFirstEnd) => vec![around(first, first)],
            () if self.world.student.makes(StepMistake::NearPairsEdgeEnds) => {
                vec![around(first, first), around(second, second)]
            }
            () => {
                let low = Vec2::new(first.x.min(second.x), first.y.min(second.y));
                let high = Vec2::new(first.x.max(second.x), first.y.max(second.y));
                vec![around(low, high)]
            }
        }
    }
}
