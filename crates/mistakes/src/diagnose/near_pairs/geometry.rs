//! The positions and boxes of the bodies of nearby pairs.
use fosssim_model::{
    scene::{Edge, HalfPlane, Scene},
    sim::{Pair, PairKind, State},
};
use fosssim_num::vector::{Vec2, length, vector_at};

/// A body's bounding box, which includes its radius, as its lower and upper corners.
pub(super) type BoundingBox = [Vec2; 2];

/// The geometry of a scene at the start of a step.
pub(super) struct StepGeometry<'a> {
    pub scene: &'a Scene,
    pub before: &'a State,
    /// The positions at the start of the scene.
    pub start_positions: Vec<f64>,
    /// The diameter of the largest particle.
    pub largest_size: f64,
    /// The lower corner of the box of all bodies.
    pub corner: Vec2,
    /// The boxes of particles, then of edges.
    boxes: Vec<BoundingBox>,
}

/// A nearby pair in a step, with its geometry.
#[derive(Clone, Copy)]
pub(super) struct PlacedPair<'a> {
    pub geometry: &'a StepGeometry<'a>,
    pub pair: Pair,
}

impl<'a> StepGeometry<'a> {
    pub fn new(scene: &'a Scene, before: &'a State) -> Self {
        let body_count = scene.particles.len() + scene.edges.len();
        let boxes: Vec<BoundingBox> = (0..body_count).map(|body| body_box(scene, &before.positions, body)).collect();
        Self {
            scene,
            before,
            start_positions: State::for_scene(scene).positions,
            largest_size: scene.particles.iter().fold(0.0, |largest, particle| largest.max(2.0 * particle.radius)),
            corner: boxes.iter().fold(Vec2::repeat(f64::INFINITY), |low, bounds| low.inf(&bounds[0])),
            boxes,
        }
    }
}

impl<'a> PlacedPair<'a> {
    /// Returns the indices of the pair's bodies.
    pub const fn indices(&self) -> [usize; 2] {
        [self.pair.first as usize, self.pair.second as usize]
    }

    pub fn edge(&self) -> Option<&'a Edge> {
        (self.pair.kind == PairKind::ParticleEdge).then(|| &self.geometry.scene.edges[self.indices()[1]])
    }

    pub fn half_plane(&self) -> Option<&'a HalfPlane> {
        (self.pair.kind == PairKind::ParticleHalfPlane).then(|| &self.geometry.scene.half_planes[self.indices()[1]])
    }

    pub fn position(&self, particle: usize) -> Vec2 {
        vector_at(&self.geometry.before.positions, particle)
    }

    /// Returns the first body's center.
    pub fn center(&self) -> Vec2 {
        self.position(self.indices()[0])
    }

    /// Returns the radius of the first body.
    pub fn radius(&self) -> f64 {
        self.geometry.scene.particles[self.indices()[0]].radius
    }

    /// Returns the radius of the second body, or 0 for a half-plane.
    pub fn other_radius(&self) -> f64 {
        match (self.pair.kind, self.edge()) {
            (PairKind::ParticleParticle, _) => self.geometry.scene.particles[self.indices()[1]].radius,
            (_, edge) => edge.map_or(0.0, |edge| edge.radius),
        }
    }

    /// Returns the indices of the pair's bodies in an array of particles and edges. For a half-plane, the second index
    /// is the particle's.
    fn bodies(&self) -> [usize; 2] {
        let [first, second] = self.indices();
        match self.pair.kind {
            PairKind::ParticleParticle => [first, second],
            PairKind::ParticleEdge => [first, self.geometry.scene.particles.len() + second],
            PairKind::ParticleHalfPlane => [first, first],
        }
    }

    /// Returns the boxes of the pair's bodies. For a half-plane, the second box is the particle's.
    pub fn boxes(&self) -> [BoundingBox; 2] {
        self.bodies().map(|body| self.geometry.boxes[body])
    }

    /// Returns the first body's center, and the second body's nearest point.
    pub fn points(&self) -> [Vec2; 2] {
        [self.center(), self.nearest_point(&self.geometry.before.positions)]
    }

    /// Returns whether the pair is near at positions `x`, because its boxes overlap or its half-plane is in reach.
    pub fn is_near(&self, x: &[f64]) -> bool {
        if self.half_plane().is_some() {
            return length(self.nearest_point(x) - vector_at(x, self.indices()[0])) < self.radius();
        }
        let [one, other] = self.bodies().map(|body| body_box(self.geometry.scene, x, body));
        (0..2).all(|axis| one[0][axis] <= other[1][axis] && other[0][axis] <= one[1][axis])
    }

    /// Returns whether the bodies do not approach each other.
    pub fn is_separating(&self) -> bool {
        let State { positions, velocities } = self.geometry.before;
        let later: Vec<f64> = positions.iter().zip(velocities).map(|(x, v)| x + 1e-6 * v).collect();
        let distance = |x: &[f64]| length(self.nearest_point(x) - vector_at(x, self.indices()[0]));
        distance(&later) >= distance(positions)
    }

    /// Returns the boxes of other bodies that begin, on an axis, between the beginnings of the pair's two boxes. They
    /// are in the order of a sweep.
    pub fn boxes_between(&self, axis: usize) -> impl Iterator<Item = BoundingBox> {
        let own = self.bodies();
        let [one, other] = self.boxes().map(|bounds| bounds[0][axis]);
        let all = self.geometry.boxes.iter().enumerate().filter(move |(body, _)| !own.contains(body));
        all.map(|(_, one)| *one).filter(move |body| (one.min(other)..=one.max(other)).contains(&body[0][axis]))
    }

    /// Returns the point of the second body that is nearest to the first one's center.
    fn nearest_point(&self, x: &[f64]) -> Vec2 {
        let [first, second] = self.indices();
        let own = vector_at(x, first);
        if let Some(edge) = self.edge() {
            let (from, edge_vector) = (vector_at(x, edge.first), vector_at(x, edge.second) - vector_at(x, edge.first));
            return from
                + ((own - from).dot(&edge_vector) / edge_vector.dot(&edge_vector)).clamp(0.0, 1.0) * edge_vector;
        }
        self.half_plane().map_or_else(
            || vector_at(x, second),
            |plane| own + (plane.point - own).dot(&plane.normal) / plane.normal.dot(&plane.normal) * plane.normal,
        )
    }
}

/// Returns the box of a particle or, with higher numbers, of an edge.
fn body_box(scene: &Scene, x: &[f64], body: usize) -> BoundingBox {
    let (ends, radius) = match scene.particles.get(body) {
        Some(particle) => ([body; 2], particle.radius),
        None => {
            let edge = &scene.edges[body - scene.particles.len()];
            ([edge.first, edge.second], edge.radius)
        }
    };
    let [one, other] = ends.map(|end| vector_at(x, end));
    [one.inf(&other) - Vec2::repeat(radius), one.sup(&other) + Vec2::repeat(radius)]
}
