//! The penalty force, which `penalty` and `hybrid` scenes add to the others (simulation.md 3).
use fosssim_model::{
    scene::CollisionDetection,
    sim::{PairKind, PenaltyPairs},
};
use fosssim_num::vector::{Vec2, length, unit, vector_at};

use super::{
    Area, Slip, StepMistake, Term, author::Student, near_pairs::NearPairSearch, slip_effects::TermPart, world::World,
};

/// The layer around bodies that repels other bodies.
#[derive(Clone, Copy)]
pub struct PenaltyLayer {
    /// The stiffness of the force.
    pub k: f64,
    /// The thickness, which is added to the radii.
    pub h: f64,
    /// The method that finds nearby pairs. It determines the order in which their forces are added. In the contest,
    /// bodies at the same position do not repel each other.
    pub detection: CollisionDetection,
}

/// Adds the gradient of the penalty force to `g`, at positions `x` that the particles reached with velocities `v`.
/// Pairs out of reach add nothing, so a program may omit them.
pub fn add_gradient(world: &World, layer: PenaltyLayer, x: &[f64], v: &[f64], g: &mut [f64]) {
    let student = world.student;
    let has_own_pairs = student.mistake_in(&[Area::Penalty, Area::NearPairs]).is_some();
    let mut force = PenaltySum { world, layer, x, g };
    if !has_own_pairs {
        return PenaltyPairs::new(&world.scene, layer.h, layer.detection)
            .visit_pairs(x, |pair| force.add(pair.kind, (pair.first as usize, pair.second as usize)));
    }
    let near_pairs = NearPairSearch::new(world, layer.h, x, v);
    let mut visit = |kind: PairKind, (one, other): (usize, usize)| {
        for _ in 0..near_pairs.pair_count(kind, one, other) {
            force.add(kind, (one, other));
            if kind == PairKind::ParticleParticle && student.makes(StepMistake::PenaltyBothOrders) {
                force.add(kind, (other, one));
            }
        }
    };
    // A force with such a mistake affects distant pairs as well.
    if PairKind::ALL.into_iter().any(|kind| student.slips(pair_term(kind)).any(|slip| !slip.keeps_distance())) {
        for pair in world.pairs() {
            let (kind, other) = pair.object.numbers();
            visit(PairKind::ALL[kind], (pair.particle, other));
        }
    } else {
        PenaltyPairs::new(&world.scene, layer.h, layer.detection)
            .visit_pairs(x, |pair| visit(pair.kind, (pair.first as usize, pair.second as usize)));
    }
}

const fn pair_term(kind: PairKind) -> Term {
    match kind {
        PairKind::ParticleParticle => Term::PenaltyParticles,
        PairKind::ParticleEdge => Term::PenaltyEdges,
        PairKind::ParticleHalfPlane => Term::PenaltyHalfPlanes,
    }
}

/// The sum of the penalty force so far.
struct PenaltySum<'a> {
    world: &'a World,
    layer: PenaltyLayer,
    x: &'a [f64],
    g: &'a mut [f64],
}

impl PenaltySum<'_> {
    fn add(&mut self, kind: PairKind, pair: (usize, usize)) {
        match kind {
            PairKind::ParticleParticle => self.particle_particle(pair),
            PairKind::ParticleEdge => self.particle_edge(pair),
            PairKind::ParticleHalfPlane => self.particle_half_plane(pair),
        }
    }

    /// Returns the stiffness and the depth of the overlap of two bodies' layers, which is a negative number. Returns
    /// `None` if the layers do not overlap.
    fn overlap_depth(&self, term: Term, distance: f64, [first, second]: [f64; 2]) -> Option<[f64; 2]> {
        let PenaltyLayer { k, h, detection } = self.layer;
        let makes = |slip: Slip| self.world.student.makes_slip(term, slip);
        let h = if makes(Slip::ThicknessTwice) { 2.0 * h } else { h };
        let first = if makes(Slip::NoRadii) { 0.0 } else { first };
        let second = if makes(Slip::NoRadii) || makes(Slip::NoOtherRadius) { 0.0 } else { second };
        let test_thickness = if makes(Slip::NoThickness) || makes(Slip::ThicknessInDepth) { 0.0 } else { h };
        let is_near = distance < first + second + test_thickness || makes(Slip::Always);
        if !is_near || (detection == CollisionDetection::Contest && distance == 0.0) {
            return None;
        }
        let h = if makes(Slip::NoThickness) || makes(Slip::ThicknessInTest) { 0.0 } else { h };
        let k = if makes(Slip::NoFactor) { 1.0 } else { k };
        let depth = distance - first - second - h;
        let power = match () {
            () if makes(Slip::Squared) => depth * depth,
            () if makes(Slip::SquaredWithSign) => depth * depth.abs(),
            () => depth,
        };
        Some([k, power])
    }

    /// Adds a body's part to the gradient.
    fn add_push(&mut self, term: Term, (role, particle): (usize, usize), length: f64, push: Vec2) {
        self.world.contribute(
            self.g,
            TermPart { role, length, is_negative: role == 0, ..TermPart::from_term(term, particle) },
            push,
        );
    }

    fn particle_particle(&mut self, (i, j): (usize, usize)) {
        let term = Term::PenaltyParticles;
        let particles = &self.world.scene.particles;
        let n = vector_at(self.x, j) - vector_at(self.x, i);
        let Some([k, depth]) = self.overlap_depth(term, length(n), [particles[i].radius, particles[j].radius]) else {
            return;
        };
        // In the contest the original normalizes the direction twice.
        let is_contest = self.layer.detection == CollisionDetection::Contest;
        let u = if is_contest { unit(unit(n)) } else { unit(n) };
        self.add_push(term, (0, i), length(n), k * depth * u);
        self.add_push(term, (1, j), length(n), k * depth * u);
    }

    fn particle_edge(&mut self, (i, index): (usize, usize)) {
        let term = Term::PenaltyEdges;
        let world = self.world;
        let makes = |slip: Slip| world.student.makes_slip(term, slip);
        let edge = world.scene.edges[index];
        let (x1, x2, x3) = (vector_at(self.x, i), vector_at(self.x, edge.first), vector_at(self.x, edge.second));
        let alpha = (x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2));
        // A NaN is kept here, unlike in the responses.
        let alpha = closest_alpha(world.student, term, alpha, |alpha| alpha.clamp(0.0, 1.0));
        let n = x2 + alpha * (x3 - x2) - x1;
        let radii = [world.scene.particles[i].radius, world.edge_radius(term, index)];
        let Some([k, depth]) = self.overlap_depth(term, length(n), radii) else { return };
        let u = unit(n);
        let [first, second] = match () {
            () if makes(Slip::SharesExchanged) => [alpha, 1.0 - alpha],
            () if makes(Slip::EqualShares) => [0.5, 0.5],
            () if makes(Slip::FullShares) => [1.0, 1.0],
            () => [1.0 - alpha, alpha],
        };
        self.add_push(term, (0, i), length(n), k * depth * u);
        self.add_push(term, (1, edge.first), length(n), k * first * depth * u);
        self.add_push(term, (2, edge.second), length(n), k * second * depth * u);
    }

    fn particle_half_plane(&mut self, (i, plane): (usize, usize)) {
        if plane > 0 && self.world.student.makes(StepMistake::PenaltyFirstHalfPlaneOnly) {
            return;
        }
        let term = Term::PenaltyHalfPlanes;
        let makes = |slip: Slip| self.world.student.makes_slip(term, slip);
        let plane = self.world.scene.half_planes[plane];
        let q = plane.normal;
        let to_point = plane.point - vector_at(self.x, i);
        if makes(Slip::FrontOnly) && to_point.dot(&q) > 0.0 {
            return;
        }
        let n = match () {
            () if makes(Slip::ToPoint) => to_point,
            () if makes(Slip::NotNormalized) => to_point.dot(&q) * q,
            () => to_point.dot(&q) / q.dot(&q) * q,
        };
        let Some([k, depth]) = self.overlap_depth(term, length(n), [self.world.scene.particles[i].radius, 0.0]) else {
            return;
        };
        let u = unit(n);
        let push = match () {
            () if makes(Slip::ToPoint) || makes(Slip::NotNormalized) => k * depth * u,
            () if makes(Slip::SameNormalBehind) => k * depth * unit(q),
            () if makes(Slip::NormalAsGiven) => k * depth * q,
            () if makes(Slip::OppositeNormalInFront) => k * depth * -unit(q),
            () => k * depth * u.dot(&q) / q.dot(&q) * q,
        };
        self.add_push(term, (0, i), length(n), push);
    }
}

/// Returns the parameter of an edge's closest point in this student's formulas. It is 0 at the first end and 1 at the
/// second. `alpha` is the parameter on the infinite line, and `limited` keeps a parameter between the ends as a correct
/// program does.
pub fn closest_alpha(student: Student, term: Term, alpha: f64, limited: impl Fn(f64) -> f64) -> f64 {
    student
        .slips(term)
        .fold(None, |found, slip| match slip {
            Slip::Unclamped => Some(alpha),
            Slip::Mirrored => Some(limited(1.0 - alpha)),
            Slip::Negated => Some(limited(-alpha)),
            Slip::Truncated => Some(limited(alpha.trunc())),
            Slip::Rounded => Some(limited(alpha).round()),
            Slip::Middle => Some(0.5),
            _ => found,
        })
        .unwrap_or_else(|| limited(alpha))
}
