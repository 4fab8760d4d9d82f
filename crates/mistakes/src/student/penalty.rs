//! The penalty force, which `penalty` and `hybrid` scenes add to the others (simulation.md 3).
use fosssim_model::{
    scene::CollisionDetection,
    sim::{PairKind, PenaltyPairs},
};
use fosssim_num::vector::{Vec2, at, length, unit};

use super::{
    Area, StepMistake,
    near_pairs::NearPairSearch,
    world::{World, add, subtract},
};

/// The layer around bodies that repels others.
#[derive(Clone, Copy)]
pub struct PenaltyLayer {
    /// Stiffness.
    pub k: f64,
    /// Thickness.
    pub h: f64,
    /// How pairs are found, which orders the sum. In the contest bodies at the same place leave each other alone.
    pub detection: CollisionDetection,
}

/// Adds the gradient of the penalty force at positions `x`, which velocities `v` have led to. Pairs out of its reach
/// add nothing, so that a program may leave them out.
pub fn add_gradient(world: &World, layer: PenaltyLayer, x: &[f64], v: &[f64], g: &mut [f64]) {
    let student = world.student;
    let has_own_pairs = student.mistake_in(&[Area::Penalty, Area::NearPairs]).is_some();
    let mut force = PenaltySum { world, layer, x, g };
    if !has_own_pairs {
        return PenaltyPairs::new(&world.scene, layer.h, layer.detection)
            .visit(x, |pair| force.add(pair.kind, (pair.first as usize, pair.second as usize)));
    }
    if student.makes(StepMistake::PenaltyMissing) {
        return;
    }
    let near = NearPairSearch::new(world, layer.h, x, v);
    let mut visit = |kind: PairKind, (one, other): (usize, usize)| {
        for _ in 0..near.times(kind, one, other) {
            force.add(kind, (one, other));
            if kind == PairKind::ParticleParticle && student.makes(StepMistake::PenaltyBothOrders) {
                force.add(kind, (other, one));
            }
        }
    };
    // Such a force reaches pairs that are apart.
    if student.makes(StepMistake::PenaltyAlways) || student.makes(StepMistake::PenaltyEdgeUnclamped) {
        for pair in world.pairs() {
            let (kind, other) = pair.object.numbers();
            visit(PairKind::ALL[kind], (pair.particle, other));
        }
    } else {
        PenaltyPairs::new(&world.scene, layer.h, layer.detection)
            .visit(x, |pair| visit(pair.kind, (pair.first as usize, pair.second as usize)));
    }
}

/// The sum, as far as it has come.
struct PenaltySum<'a> {
    world: &'a World,
    layer: PenaltyLayer,
    x: &'a [f64],
    g: &'a mut [f64],
}

impl PenaltySum<'_> {
    fn makes(&self, mistake: StepMistake) -> bool {
        self.world.student.makes(mistake)
    }

    fn add(&mut self, kind: PairKind, pair: (usize, usize)) {
        match kind {
            PairKind::ParticleParticle if !self.makes(StepMistake::PenaltyNoParticles) => self.particle_particle(pair),
            PairKind::ParticleEdge if !self.makes(StepMistake::PenaltyNoEdges) => self.particle_edge(pair),
            PairKind::ParticleHalfPlane if !self.makes(StepMistake::PenaltyNoHalfPlanes) => {
                self.particle_half_plane(pair);
            }
            _ => {}
        }
    }

    fn repels(&self, distance: f64, reach: f64) -> bool {
        let is_near = distance < reach || self.makes(StepMistake::PenaltyAlways);
        is_near && !(self.layer.detection == CollisionDetection::Contest && distance == 0.0)
    }

    /// `k` times how deep the layers of two bodies overlap, a negative number; none where they do not.
    fn depth(&self, distance: f64, [first, second]: [f64; 2]) -> Option<[f64; 2]> {
        let PenaltyLayer { k, h, .. } = self.layer;
        let makes = |mistake: StepMistake| self.makes(mistake);
        let (mut first, mut second) = (first, second);
        if makes(StepMistake::PenaltyNoRadii) {
            (first, second) = (0.0, 0.0);
        }
        if makes(StepMistake::PenaltyFirstRadiusOnly) {
            second = 0.0;
        }
        let is_bare = makes(StepMistake::PenaltyNoThickness);
        let of_test = if is_bare || makes(StepMistake::PenaltyThicknessInDepthOnly) { 0.0 } else { h };
        if !self.repels(distance, first + second + of_test) {
            return None;
        }
        let h = if is_bare || makes(StepMistake::PenaltyThicknessInTestOnly) { 0.0 } else { h };
        let k = if makes(StepMistake::PenaltyNoStiffness) { 1.0 } else { k };
        let k = if makes(StepMistake::PenaltySign) { -k } else { k };
        let depth = distance - first - second - h;
        Some([k, if makes(StepMistake::PenaltyDepthSquared) { depth * depth } else { depth }])
    }

    fn unit(&self, n: Vec2) -> Vec2 {
        if self.makes(StepMistake::PenaltyDirection) { n } else { unit(n) }
    }

    /// Adds to the gradient of a body that is not the pair's first.
    fn add_other(&mut self, particle: usize, push: Vec2) {
        if self.makes(StepMistake::PenaltySameSign) {
            subtract(self.g, particle, push);
        } else if !self.makes(StepMistake::PenaltyFirstOnly) {
            add(self.g, particle, push);
        }
    }

    fn particle_particle(&mut self, (i, j): (usize, usize)) {
        let particles = &self.world.scene.particles;
        let n = at(self.x, j) - at(self.x, i);
        let Some([k, depth]) = self.depth(length(n), [particles[i].radius, particles[j].radius]) else { return };
        // In the contest the original's direction is normalised twice.
        let is_contest = self.layer.detection == CollisionDetection::Contest;
        let u = if is_contest { self.unit(self.unit(n)) } else { self.unit(n) };
        let push = k * depth * u;
        subtract(self.g, i, push);
        self.add_other(j, push);
    }

    fn particle_edge(&mut self, (i, edge): (usize, usize)) {
        let edge = self.world.scene.edges[edge];
        let (x1, x2, x3) = (at(self.x, i), at(self.x, edge.first), at(self.x, edge.second));
        let alpha = (x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2));
        // A NaN stays one here, unlike in the responses.
        let alpha = match () {
            () if self.makes(StepMistake::PenaltyEdgeUnclamped) => alpha,
            () if self.makes(StepMistake::PenaltyEdgeMiddle) => 0.5,
            () => alpha.clamp(0.0, 1.0),
        };
        let n = x2 + alpha * (x3 - x2) - x1;
        let radius = if self.makes(StepMistake::PenaltyEdgeNoRadius) { 0.0 } else { edge.radius };
        let Some([k, depth]) = self.depth(length(n), [self.world.scene.particles[i].radius, radius]) else { return };
        let u = self.unit(n);
        let [first, second] = match () {
            () if self.makes(StepMistake::PenaltyEdgeSharesSwapped) => [alpha, 1.0 - alpha],
            () if self.makes(StepMistake::PenaltyEdgeEqualShares) => [0.5, 0.5],
            () if self.makes(StepMistake::PenaltyEdgeFullShares) => [1.0, 1.0],
            () => [1.0 - alpha, alpha],
        };
        subtract(self.g, i, k * depth * u);
        self.add_other(edge.first, k * first * depth * u);
        if !self.makes(StepMistake::PenaltyEdgeOneEnd) {
            self.add_other(edge.second, k * second * depth * u);
        }
    }

    fn particle_half_plane(&mut self, (i, plane): (usize, usize)) {
        if plane > 0 && self.makes(StepMistake::PenaltyFirstHalfPlaneOnly) {
            return;
        }
        let plane = self.world.scene.half_planes[plane];
        let q = plane.normal;
        let along = (plane.point - at(self.x, i)).dot(&q);
        let is_undivided = self.makes(StepMistake::PenaltyNormalUndivided);
        let n = if is_undivided { along * q } else { along / q.dot(&q) * q };
        let Some([k, depth]) = self.depth(length(n), [self.world.scene.particles[i].radius, 0.0]) else { return };
        let u = self.unit(n);
        let push = if is_undivided { k * depth * u } else { k * depth * u.dot(&q) / q.dot(&q) * q };
        subtract(self.g, i, if self.makes(StepMistake::PenaltyHalfPlaneSign) { -push } else { push });
    }
}
