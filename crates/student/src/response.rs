//! The impulses that resolve one contact (collisions.md 3): positions and velocities at the end of the step change.
use fosssim_model::scene::Collision;
use fosssim_num::vector::{Vec2, divide, unit, vector_at};

use super::{
    Area, Mistake,
    author::Student,
    objects::{Contact, Object, State},
    rounding::round_to_f32,
    world::{World, subtract},
};

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Response];

/// Returns the factor of the impulse, which is `1 + COR` in a correct program. It is twice its half, because some
/// mistakes forget to double the half.
pub fn restitution_factor(world: &World) -> f64 {
    let student = world.student;
    let f = match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::ResponseNoRestitution) => 1.0,
        Some(Mistake::ResponseInelastic) => 0.5,
        Some(Mistake::ResponseRestitutionOnly) => restitution(world) / 2.0,
        _ => (1.0 + restitution(world)) / 2.0,
    };
    if student.makes(Mistake::ResponseHalved) { f } else { 2.0 * f }
}

/// Returns the coefficient of restitution of the scene, or 1 if the scene has none.
fn restitution(world: &World) -> f64 {
    match world.scene.collision {
        Collision::Simple { restitution }
        | Collision::ContinuousTime { restitution }
        | Collision::Hybrid { restitution, .. } => restitution,
        Collision::None | Collision::Penalty { .. } => 1.0,
    }
}

/// Changes `result` so that `contact` does not happen. The impulse is computed from the motion from `q_start` to
/// `predicted.x`. `predicted` may be an earlier state than `result`.
pub fn respond(world: &World, contact: &Contact, q_start: &[f64], predicted: &State, result: &mut State) {
    let u = if world.student.makes(Mistake::ResponseNotNormalized) { contact.n } else { unit(contact.n) };
    let mut response = PairResponse { world, q_start, predicted, result, u, factor: restitution_factor(world) };
    let particle = contact.pair.particle;
    match contact.pair.object {
        Object::Particle(other) => response.particle_particle(particle, other),
        Object::Edge(index) => {
            let edge = world.scene.edges[index];
            response.particle_edge(contact.time, [particle, edge.first, edge.second]);
        }
        Object::HalfPlane(_) => response.particle_half_plane(particle),
    }
}

struct PairResponse<'a> {
    world: &'a World,
    q_start: &'a [f64],
    predicted: &'a State,
    result: &'a mut State,
    /// The unit contact vector.
    u: Vec2,
    /// The factor of the impulse, from [`restitution_factor`].
    factor: f64,
}

impl PairResponse<'_> {
    /// Returns the velocity of the particle from which the impulse is computed. A correct program uses its mean
    /// velocity over the step.
    fn velocity(&self, particle: usize) -> Vec2 {
        if self.world.student.makes(Mistake::ResponseEndVelocity) {
            return vector_at(&self.predicted.v, particle);
        }
        divide(vector_at(&self.predicted.x, particle) - vector_at(self.q_start, particle), self.world.scene.time_step)
    }

    /// Changes a particle that is not fixed. Its velocity changes by `sign * share / inertia` along `u`, and its
    /// position by `sign * moved / inertia`.
    fn push(&mut self, particle: usize, sign: f64, share: f64, moved: f64, inertia: f64) {
        let student = self.world.student;
        if self.world.is_fixed(particle) && !student.makes(Mistake::ResponseMovesFixed) {
            return;
        }
        let sign = if student.makes(Mistake::ResponseSign) { -sign } else { sign };
        let (share, moved) = if student.makes(Mistake::ResponseSinglePrecision) {
            (round_to_f32(share), round_to_f32(moved))
        } else {
            (share, moved)
        };
        if !student.makes(Mistake::ResponsePositionsOnly) {
            student.add_scaled_at(&mut self.result.v, particle, sign * (share / inertia), self.u);
        }
        if !student.makes(Mistake::ResponseVelocitiesOnly) {
            let moved = if student.makes(Mistake::ResponsePositionNoStep) { share } else { moved };
            student.add_scaled_at(&mut self.result.x, particle, sign * (moved / inertia), self.u);
        }
    }

    fn particle_particle(&mut self, one: usize, two: usize) {
        let h = self.world.scene.time_step;
        let student = self.world.student;
        let (m1, m2) = response_masses(student, self.world.collision_mass(one), self.world.collision_mass(two));
        let closing = self.velocity(two) - self.velocity(one);
        let impulse = self.factor * student.dot(closing, self.u);
        let (mut inertia1, mut inertia2) = (1.0 + m1 / m2, m2 / m1 + 1.0);
        if student.makes(Mistake::ResponseInverseMasses) {
            let (w1, w2) = (1.0 / m1, 1.0 / m2);
            (inertia1, inertia2) = ((w1 + w2) / w1, (w1 + w2) / w2);
        }
        self.push(one, 1.0, impulse, h * impulse, inertia1);
        if !student.makes(Mistake::ResponseFirstOnly) {
            self.push(two, -1.0, impulse, h * impulse, inertia2);
        }
    }

    fn particle_edge(&mut self, time: f64, [one, two, three]: [usize; 3]) {
        let student = self.world.student;
        let h = self.world.scene.time_step;
        let (v1, v2, v3) = (self.velocity(one), self.velocity(two), self.velocity(three));
        let elapsed = if student.makes(Mistake::ResponseEdgeAtStart) { 0.0 } else { time * h };
        let impact =
            |particle: usize, velocity: Vec2| student.add_scaled(vector_at(self.q_start, particle), elapsed, velocity);
        let (y1, y2, y3) = (impact(one, v1), impact(two, v2), impact(three, v3));
        let edge = y3 - y2;
        let alpha = clamp(student.dot(y1 - y2, edge) / student.dot(edge, edge));
        let alpha = second_end_weight(student, alpha);
        let beta = 1.0 - alpha;
        let edge_velocity = if student.makes(Mistake::ResponseEdgeStill) {
            Vec2::zeros()
        } else {
            student.add_scaled(v2, alpha, v3 - v2)
        };
        let impulse = self.factor * student.dot(edge_velocity - v1, self.u);
        let [m1, m2, m3] = [one, two, three].map(|particle| self.world.collision_mass(particle));
        let (low, high) = (beta * beta, alpha * alpha);
        let mut inertia1 = 1.0 + low * m1 / m2 + high * m1 / m3;
        let mut inertia2 = m2 / m1 + low + high * m2 / m3;
        let mut inertia3 = m3 / m1 + low * m3 / m2 + high;
        if student.makes(Mistake::ResponseInverseMasses) {
            let [w1, w2, w3] = [m1, m2, m3].map(|mass| 1.0 / mass);
            let all = w1 + beta * beta * w2 + alpha * alpha * w3;
            (inertia1, inertia2, inertia3) = (all / w1, all / w2, all / w3);
        }
        self.push(one, 1.0, impulse, h * impulse, inertia1);
        if student.makes(Mistake::ResponseFirstOnly) {
            return;
        }
        self.push(two, -1.0, beta * impulse, h * beta * impulse, inertia2);
        if !student.makes(Mistake::ResponseOneEndpoint) {
            self.push(three, -1.0, alpha * impulse, h * alpha * impulse, inertia3);
        }
    }

    /// Bounces a particle off a half-plane, even a fixed one, because the course's own response does not test for it.
    fn particle_half_plane(&mut self, one: usize) {
        let student = self.world.student;
        let spares = student.makes(Mistake::ResponseHalfPlaneSparesFixed) && self.world.is_fixed(one);
        if spares {
            return;
        }
        let h = self.world.scene.time_step;
        let mut speed = student.dot(self.velocity(one), self.u);
        if student.makes(Mistake::ResponseSinglePrecision) {
            speed = round_to_f32(speed);
        }
        let mut sign = if student.makes(Mistake::ResponseSign) { -1.0 } else { 1.0 };
        if student.makes(Mistake::ResponseHalfPlaneHalved) {
            sign = 0.5;
        }
        if !student.makes(Mistake::ResponsePositionsOnly) {
            let change = self.factor * speed * self.u;
            subtract(&mut self.result.v, one, sign * change);
        }
        if !student.makes(Mistake::ResponseVelocitiesOnly) {
            let moved = if student.makes(Mistake::ResponsePositionNoStep) { self.factor } else { h * self.factor };
            let change = moved * speed * self.u;
            subtract(&mut self.result.x, one, sign * change);
        }
    }
}

/// Returns the masses of two particles in this student's formulas.
pub fn response_masses(student: Student, first: f64, second: f64) -> (f64, f64) {
    match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::ResponseMassesSwapped) => (second, first),
        Some(Mistake::ResponseEqualMasses) => (1.0, 1.0),
        _ => (first, second),
    }
}

/// Returns the weight of an edge's second end in this student's formulas. `alpha` is the right weight.
pub fn second_end_weight(student: Student, alpha: f64) -> f64 {
    match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::ResponseEdgeMiddle) => 0.5,
        Some(Mistake::ResponseEdgeSwapped) => 1.0 - alpha,
        _ => alpha,
    }
}

/// Returns the number limited to the range from 0 to 1. A NaN becomes 0.
pub fn clamp(alpha: f64) -> f64 {
    let positive = if 0.0 < alpha { alpha } else { 0.0 };
    if positive < 1.0 { positive } else { 1.0 }
}
