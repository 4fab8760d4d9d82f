//! The collision type `simple`: one pass over the positions at the end of the step that changes velocities
//! (collisions.md 6).
use fosssim_model::scene::Collision;
use fosssim_num::vector::{Vec2, length, unit, vector_at};

use super::{
    Slip, Term,
    objects::{Contact, Object, State},
    penalty::closest_alpha,
    response::clamp,
    slip_effects::TermPart,
    world::{StepLog, World},
};

/// Detects and resolves the contacts of all pairs in order, and adds them to `log`. Each pair uses the velocities that
/// the previous pairs have changed.
pub fn handle_collisions(world: &World, state: &mut State, log: &mut StepLog) {
    let pass = SimplePass { world, start: state.v.clone() };
    for pair in world.pairs() {
        let one = pair.particle;
        let n = match pair.object {
            Object::Particle(other) => pass.particle_particle(state, one, other),
            Object::Edge(edge) => pass.particle_edge(state, one, edge),
            Object::HalfPlane(plane) => pass.particle_half_plane(state, one, plane),
        };
        log.impulses.extend(n.map(|n| Contact { pair, n, time: 0.0 }));
    }
}

struct SimplePass<'a> {
    world: &'a World,
    /// The velocities before the pass, for a student who computes impulses from them.
    start: Vec<f64>,
}

/// The terms of the functions and formulas for one kind of pair.
struct SimpleKind {
    detection: Term,
    overlap: Term,
    approach: Term,
    normal: Term,
    response: Term,
}

const PARTICLE_KIND: SimpleKind = SimpleKind {
    detection: Term::DetectParticles,
    overlap: Term::OverlapParticles,
    approach: Term::ApproachParticles,
    normal: Term::NormalParticles,
    response: Term::RespondParticles,
};
const EDGE_KIND: SimpleKind = SimpleKind {
    detection: Term::DetectEdges,
    overlap: Term::OverlapEdges,
    approach: Term::ApproachEdges,
    normal: Term::NormalEdges,
    response: Term::RespondEdges,
};
const HALF_PLANE_KIND: SimpleKind = SimpleKind {
    detection: Term::DetectHalfPlanes,
    overlap: Term::OverlapHalfPlanes,
    approach: Term::ApproachHalfPlanes,
    normal: Term::NormalHalfPlanes,
    response: Term::RespondHalfPlanes,
};

impl SimplePass<'_> {
    fn makes(&self, term: Term, slip: Slip) -> bool {
        self.world.student.makes_slip(term, slip)
    }

    /// Returns whether two bodies collide, given their radii, their contact vector `n`, and their relative velocity
    /// `w`.
    fn is_colliding(&self, kind: &SimpleKind, n: Vec2, radii: [f64; 2], w: Vec2) -> bool {
        let [first, second] = radii;
        let reach = match () {
            () if self.makes(kind.overlap, Slip::FirstOnly) => first,
            () if self.makes(kind.overlap, Slip::SecondOnly) => second,
            () => first + second,
        };
        let holds = |term: Term, small: f64, large: f64| match () {
            () if self.makes(term, Slip::Missing) => true,
            () if self.makes(term, Slip::Sign) => small > large,
            () if self.makes(term, Slip::NotStrict) => small <= large,
            () if self.makes(term, Slip::IgnoresSlowApproach) => small + 0.01 < large,
            () => small < large,
        };
        !self.makes(kind.detection, Slip::Missing)
            && holds(kind.overlap, length(n), reach)
            && holds(kind.approach, 0.0, w.dot(&n))
    }

    /// Returns the contact vector of this student's program. `n` is the right vector.
    fn contact_vector(&self, kind: &SimpleKind, n: Vec2) -> Vec2 {
        self.world.student.slips(kind.normal).fold(n, |n, slip| match slip {
            Slip::Sign => -n,
            Slip::Unit => unit(n),
            Slip::Doubled => 2.0 * n,
            Slip::Halved => 0.5 * n,
            _ => n,
        })
    }

    /// Returns the factor of the impulse, which is `1 + COR` in a correct program.
    fn restitution_factor(&self, kind: &SimpleKind) -> f64 {
        let Collision::Simple { restitution } = self.world.scene.collision else { return 2.0 };
        match () {
            () if self.makes(kind.response, Slip::NoFactor) => 2.0,
            () if self.makes(kind.response, Slip::Inelastic) => 1.0,
            () if self.makes(kind.response, Slip::RestitutionOnly) => restitution,
            () if self.makes(kind.response, Slip::RestitutionTwice) => 2.0 * restitution,
            // As in the reference, half of `1 + COR` is doubled.
            () => 2.0 * ((1.0 + restitution) / 2.0),
        }
    }

    /// Returns the velocity from which an impulse is computed.
    fn velocity(&self, kind: &SimpleKind, state: &State, particle: usize) -> Vec2 {
        let uses_start = self.makes(kind.response, Slip::StartVelocity);
        vector_at(if uses_start { &self.start } else { &state.v }, particle)
    }

    /// Returns the mass of a body of the pair, which is infinite if the body is fixed.
    fn mass(&self, kind: &SimpleKind, particle: usize) -> f64 {
        let is_finite = [Slip::FixedFinite, Slip::FixedAsFree].into_iter().any(|slip| self.makes(kind.response, slip));
        match () {
            () if self.makes(kind.response, Slip::EqualMasses) && !self.world.is_fixed(particle) => 1.0,
            () if self.world.is_fixed(particle) && !is_finite => f64::INFINITY,
            () => self.world.masses[2 * particle],
        }
    }

    /// Changes the velocity of a particle that is not fixed. `role` is its number among the bodies of the pair.
    fn push(&self, kind: &SimpleKind, state: &mut State, (role, particle): (usize, usize), n: Vec2, change: Vec2) {
        if !self.world.is_fixed(particle) || self.makes(kind.response, Slip::FixedAsFree) {
            let part = TermPart { role, length: length(n), ..TermPart::from_term(kind.response, particle) };
            self.world.contribute(&mut state.v, part, change);
        }
    }

    fn particle_particle(&self, state: &mut State, one: usize, two: usize) -> Option<Vec2> {
        let kind = &PARTICLE_KIND;
        let n = vector_at(&state.x, two) - vector_at(&state.x, one);
        let [v1, v2] = self.tested_velocities(kind, [vector_at(&state.v, one), vector_at(&state.v, two)]);
        let radii = [one, two].map(|particle| self.world.scene.particles[particle].radius);
        if !self.is_colliding(kind, n, radii, v1 - v2) {
            return None;
        }
        let n = self.contact_vector(kind, n);
        let (u, bounce) = (unit(n), self.restitution_factor(kind));
        let impulse = |pass: &Self, state: &State| {
            bounce * (pass.velocity(kind, state, two) - pass.velocity(kind, state, one)).dot(&u)
        };
        let (m1, m2) = (self.mass(kind, one), self.mass(kind, two));
        let (m1, m2) = if self.makes(kind.response, Slip::SwappedMasses) { (m2, m1) } else { (m1, m2) };
        let first = impulse(self, state);
        self.push(kind, state, (0, one), n, first / (1.0 + m1 / m2) * u);
        let second = if self.makes(kind.response, Slip::Sequential) { impulse(self, state) } else { first };
        self.push(kind, state, (1, two), n, -(second / (m2 / m1 + 1.0) * u));
        Some(n)
    }

    /// Returns the velocities of two bodies that the test of approach uses.
    fn tested_velocities(&self, kind: &SimpleKind, [first, second]: [Vec2; 2]) -> [Vec2; 2] {
        match () {
            () if self.makes(kind.approach, Slip::FirstOnly) => [first, Vec2::zeros()],
            () if self.makes(kind.approach, Slip::SecondOnly) => [Vec2::zeros(), second],
            () => [first, second],
        }
    }

    fn particle_edge(&self, state: &mut State, one: usize, index: usize) -> Option<Vec2> {
        let (kind, student) = (&EDGE_KIND, self.world.student);
        let edge = self.world.scene.edges[index];
        let (two, three) = (edge.first, edge.second);
        let [x1, x2, x3] = [one, two, three].map(|particle| vector_at(&state.x, particle));
        let [v1, v2, v3] = [one, two, three].map(|particle| vector_at(&state.v, particle));
        let unclamped = (x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2));
        let alpha = closest_alpha(student, Term::ClosestPoint, unclamped, clamp);
        let n = x2 + alpha * (x3 - x2) - x1;
        let seen = match () {
            () if self.makes(kind.approach, Slip::Middle) => 0.5,
            () if self.makes(kind.approach, Slip::Mirrored) => 1.0 - alpha,
            () if self.makes(kind.approach, Slip::Unclamped) => unclamped,
            () => alpha,
        };
        let [particle_velocity, edge_velocity] = self.tested_velocities(kind, [v1, v2]);
        let turning = if self.makes(kind.approach, Slip::FirstOnly) { Vec2::zeros() } else { seen * (v3 - v2) };
        let radii = [self.world.scene.particles[one].radius, self.world.edge_radius(kind.overlap, index)];
        let is_off = self.makes(Term::ClosestPoint, Slip::NothingBeyondEnds) && !(0.0..=1.0).contains(&unclamped);
        if is_off || !self.is_colliding(kind, n, radii, particle_velocity - edge_velocity - turning) {
            return None;
        }
        let n = self.contact_vector(kind, n);
        self.push_edge(state, [one, two, three], n, closest_alpha(student, kind.response, unclamped, clamp));
        Some(n)
    }

    fn push_edge(&self, state: &mut State, [one, two, three]: [usize; 3], n: Vec2, alpha: f64) {
        let kind = &EDGE_KIND;
        let (u, bounce, beta) = (unit(n), self.restitution_factor(kind), 1.0 - alpha);
        let impulse = |pass: &Self, state: &State| {
            let [v1, v2, v3] = [one, two, three].map(|particle| pass.velocity(kind, state, particle));
            let edge_velocity = match () {
                () if pass.makes(Term::RespondEdgeStill, Slip::Missing) => Vec2::zeros(),
                () if pass.makes(Term::RespondEdgeStill, Slip::Middle) => v2 + 0.5 * (v3 - v2),
                () => v2 + alpha * (v3 - v2),
            };
            bounce * (edge_velocity - v1).dot(&u)
        };
        let mut masses = [one, two, three].map(|particle| self.mass(kind, particle));
        if self.makes(kind.response, Slip::SwappedMasses) {
            masses.swap(1, 2);
        }
        let is_held = self.makes(kind.response, Slip::OneEndFixesBoth) && (masses[1] + masses[2]).is_infinite();
        if is_held {
            masses[1..].fill(f64::INFINITY);
        }
        let [m1, m2, m3] = masses;
        let is_plain = self.makes(kind.response, Slip::SharesNotSquared);
        let (low, high) = if is_plain { (beta, alpha) } else { (beta * beta, alpha * alpha) };
        let [second_share, third_share] = match () {
            () if self.makes(kind.response, Slip::FullShares) => [1.0, 1.0],
            () if self.makes(kind.response, Slip::EqualShares) => [0.5, 0.5],
            () if self.makes(kind.response, Slip::SharesExchanged) => [alpha, beta],
            () => [beta, alpha],
        };
        let is_sequential = self.makes(kind.response, Slip::Sequential);
        let first = impulse(self, state);
        self.push(kind, state, (0, one), n, first / (1.0 + low * m1 / m2 + high * m1 / m3) * u);
        if is_held {
            return;
        }
        let is_after = is_sequential || self.makes(kind.response, Slip::AfterParticle);
        let second = if is_after { impulse(self, state) } else { first };
        self.push(kind, state, (1, two), n, -(second_share * second / (m2 / m1 + low + high * m2 / m3) * u));
        let third = if is_sequential { impulse(self, state) } else { second };
        self.push(kind, state, (2, three), n, -(third_share * third / (m3 / m1 + low * m3 / m2 + high) * u));
    }

    /// Detects and resolves a contact with a half-plane. Returns the contact vector, or `None` if there is no contact.
    /// The velocity of a fixed particle is changed as well.
    fn particle_half_plane(&self, state: &mut State, one: usize, index: usize) -> Option<Vec2> {
        let kind = &HALF_PLANE_KIND;
        let plane = self.world.scene.half_planes[index];
        let to_point = plane.point - vector_at(&state.x, one);
        let q = if self.makes(kind.normal, Slip::NotNormalized) { plane.normal } else { unit(plane.normal) };
        let n = if self.makes(kind.normal, Slip::ToPoint) { to_point } else { to_point.dot(&q) * q };
        let seen = vector_at(&state.v, one);
        let is_behind = self.makes(kind.overlap, Slip::SameNormalBehind) && to_point.dot(&q) > 0.0;
        let reach = if is_behind { f64::INFINITY } else { self.world.scene.particles[one].radius };
        if !self.is_colliding(kind, n, [reach, 0.0], seen) {
            return None;
        }
        let n = self.contact_vector(kind, n);
        if self.world.is_fixed(one) && self.makes(kind.response, Slip::FixedUnchanged) {
            return Some(n);
        }
        let (u, bounce, v) = (unit(n), self.restitution_factor(kind), self.velocity(kind, state, one));
        let change = if self.makes(kind.response, Slip::WholeVelocity) { bounce * v } else { bounce * v.dot(&u) * u };
        let part = TermPart { length: length(n), is_negative: true, ..TermPart::from_term(kind.response, one) };
        self.world.contribute(&mut state.v, part, change);
        Some(n)
    }
}
