//! The impulses that resolve one contact (collisions.md 3): positions and velocities at the end of the step change.
use fosssim_model::scene::Collision;
use fosssim_num::vector::{Vec2, at, over, unit};

use super::{
    Area, Mistake,
    author::Student,
    hooks::{Change, Place, Share},
    objects::{Contact, Object, State},
    rounding::single,
    world::{World, add, subtract},
};

/// The parts of the assignment whose mistakes are made here.
const HERE: &[Area] = &[Area::Response];

/// Twice `(1 + COR) / 2`.
pub fn bounce(world: &World) -> f64 {
    let student = world.student;
    let f = match student.mistake_in(HERE) {
        Some(Mistake::ResponseNoRestitution) => 1.0,
        Some(Mistake::ResponseInelastic) => 0.5,
        Some(Mistake::ResponseRestitutionOnly) => restitution(world) / 2.0,
        _ => (1.0 + student.number(Place::Restitution, restitution(world))) / 2.0,
    };
    if student.makes(Mistake::ResponseHalved) { f } else { 2.0 * f }
}

/// The coefficient of restitution of the scene; 1 where it has none.
fn restitution(world: &World) -> f64 {
    match world.scene.collision {
        Collision::Simple { restitution }
        | Collision::ContinuousTime { restitution }
        | Collision::Hybrid { restitution, .. } => restitution,
        Collision::None | Collision::Penalty { .. } => 1.0,
    }
}

/// Changes `result` so that `contact` does not happen. The impulse is computed from the motion from `q_start` to
/// `predicted.x`, which may be an earlier state than the one that is changed.
pub fn respond(world: &World, contact: &Contact, q_start: &[f64], predicted: &State, result: &mut State) {
    let (student, (kind, _)) = (world.student, contact.pair.object.numbers());
    let u = if student.makes(Mistake::ResponseNotNormalised) { contact.n } else { unit(contact.n) };
    let u = student.vector(Place::UnitVector { kind }, u);
    let mut response = PairResponse { world, contact, q_start, predicted, result, u, bounce: bounce(world), kind };
    let particle = contact.pair.particle;
    match contact.pair.object {
        Object::Particle(other) => response.particle_particle(particle, other),
        Object::Edge(index) => {
            let (edge, all) = (world.scene.edges[index], world.scene.particles.len());
            let first = student.index(Place::ResponseEnd { role: 1 }, edge.first, edge.second, all);
            let second = student.index(Place::ResponseEnd { role: 2 }, edge.second, edge.first, all);
            response.particle_edge(contact.time, [particle, first, second]);
        }
        Object::HalfPlane(_) => response.particle_half_plane(particle),
    }
}

struct PairResponse<'a> {
    world: &'a World,
    contact: &'a Contact,
    q_start: &'a [f64],
    predicted: &'a State,
    result: &'a mut State,
    /// The unit contact vector.
    u: Vec2,
    /// Twice `(1 + COR) / 2`.
    bounce: f64,
    /// The kind of the pair, as places number it.
    kind: usize,
}

impl PairResponse<'_> {
    /// The particle's mean velocity over the step.
    fn velocity(&self, role: usize, particle: usize) -> Vec2 {
        let (student, kind) = (self.world.student, self.kind);
        let place = Place::MeanVelocity { kind, role };
        if student.makes(Mistake::ResponseEndVelocity) || student.is_stale(place) {
            return at(&self.predicted.v, particle);
        }
        // A student who changes the positions for responses answers a round's contacts one by one.
        let predicted = student.fresh(Place::Simultaneous { kind }, &self.predicted.x, &self.result.x);
        let mean = over(at(predicted, particle) - at(self.q_start, particle), self.world.scene.time_step);
        student.vector(place, mean)
    }

    /// The mass of a body beside which `other` stands.
    fn mass(&self, role: usize, particle: usize, other: usize) -> f64 {
        let (world, kind) = (self.world, self.kind);
        let all = world.scene.particles.len();
        let index = world.student.index(Place::ResponseMass { kind, role }, particle, other, all);
        world.collision_mass(kind, role, index)
    }

    /// Pushes a particle that is not fixed: `share / inertia` is the change of its speed along `u`.
    fn push(&mut self, role: usize, particle: usize, sign: f64, share: f64, moved: f64, inertia: f64) {
        let (student, kind) = (self.world.student, self.kind);
        let spares = student.holds(Place::SparesFixed { kind, role }, self.world.fixed(particle));
        if spares && !student.makes(Mistake::ResponseMovesFixed) {
            return;
        }
        let share = student.number(Place::VelocityChange { kind, role }, share);
        let moved = student.number(Place::PositionChange { kind, role }, moved);
        if let Some(Change::Respond(change)) = student.change {
            let (velocity, position) = (sign * (share / inertia) * self.u, sign * (moved / inertia) * self.u);
            return self.respond(role, particle, *change, velocity, position);
        }
        let sign = if student.makes(Mistake::ResponseSign) { -sign } else { sign };
        let (share, moved) = if student.makes(Mistake::ResponseSinglePrecision) {
            (single(share), single(moved))
        } else {
            (share, moved)
        };
        if !student.makes(Mistake::ResponsePositionsOnly) {
            student.push(&mut self.result.v, particle, sign * (share / inertia), self.u);
        }
        if !student.makes(Mistake::ResponseVelocitiesOnly) {
            let moved = if student.makes(Mistake::ResponsePositionNoStep) { share } else { moved };
            student.push(&mut self.result.x, particle, sign * (moved / inertia), self.u);
        }
    }

    /// Applies a mistake that the catalogue does not have to a change.
    fn respond(&mut self, role: usize, particle: usize, change: fn(&mut Share), velocity: Vec2, position: Vec2) {
        let before = self.velocity(role, particle);
        let (pair, u, bounce) = (self.contact.pair, self.u, self.bounce);
        let mut share = Share { role, pair, u, velocity, position, before, bounce };
        change(&mut share);
        add(&mut self.result.v, particle, share.velocity);
        add(&mut self.result.x, particle, share.position);
    }

    fn particle_particle(&mut self, one: usize, two: usize) {
        let h = self.world.scene.time_step;
        let student = self.world.student;
        let (m1, m2) = masses(student, self.mass(0, one, two), self.mass(1, two, one));
        let closing = self.velocity(1, two) - self.velocity(0, one);
        let impulse = self.bounce * student.dot(closing, self.u);
        let (mut inertia1, mut inertia2) = (1.0 + m1 / m2, m2 / m1 + 1.0);
        if student.makes(Mistake::ResponseInverseMasses) {
            let (w1, w2) = (1.0 / m1, 1.0 / m2);
            (inertia1, inertia2) = ((w1 + w2) / w1, (w1 + w2) / w2);
        }
        self.push(0, one, 1.0, impulse, h * impulse, inertia1);
        if !student.makes(Mistake::ResponseFirstOnly) {
            self.push(1, two, -1.0, impulse, h * impulse, inertia2);
        }
    }

    fn particle_edge(&mut self, time: f64, [one, two, three]: [usize; 3]) {
        let student = self.world.student;
        let h = self.world.scene.time_step;
        let (v1, v2, v3) = (self.velocity(0, one), self.velocity(1, two), self.velocity(2, three));
        let elapsed = if student.makes(Mistake::ResponseEdgeAtStart) { 0.0 } else { time * h };
        let elapsed = student.number(Place::ResponseTime, elapsed);
        let impact =
            |particle: usize, velocity: Vec2| student.add_scaled(at(self.q_start, particle), elapsed, velocity);
        let (y1, y2, y3) = (impact(one, v1), impact(two, v2), impact(three, v3));
        let along = y3 - y2;
        let alpha = clamped(student, student.dot(y1 - y2, along) / student.dot(along, along));
        let alpha = share_of_second(student, student.number(Place::ResponseAlpha, alpha));
        let beta = 1.0 - alpha;
        let edge_velocity = if student.makes(Mistake::ResponseEdgeStill) {
            Vec2::zeros()
        } else {
            student.add_scaled(v2, alpha, v3 - v2)
        };
        let impulse = self.bounce * student.dot(edge_velocity - v1, self.u);
        let [m1, m2, m3] =
            [(0, one, two), (1, two, three), (2, three, two)].map(|(role, this, other)| self.mass(role, this, other));
        let squares = |role| {
            let place = Place::SquareInInertia { role };
            (student.fresh(place, beta * beta, beta), student.fresh(place, alpha * alpha, alpha))
        };
        let (low, high) = squares(0);
        let mut inertia1 = 1.0 + low * m1 / m2 + high * m1 / m3;
        let (low, high) = squares(1);
        let mut inertia2 = m2 / m1 + low + high * m2 / m3;
        let (low, high) = squares(2);
        let mut inertia3 = m3 / m1 + low * m3 / m2 + high;
        if student.makes(Mistake::ResponseInverseMasses) {
            let [w1, w2, w3] = [m1, m2, m3].map(|mass| 1.0 / mass);
            let all = w1 + beta * beta * w2 + alpha * alpha * w3;
            (inertia1, inertia2, inertia3) = (all / w1, all / w2, all / w3);
        }
        self.push(0, one, 1.0, impulse, h * impulse, inertia1);
        if student.makes(Mistake::ResponseFirstOnly) {
            return;
        }
        self.push(1, two, -1.0, beta * impulse, h * beta * impulse, inertia2);
        if !student.makes(Mistake::ResponseOneEndpoint) {
            self.push(2, three, -1.0, alpha * impulse, h * alpha * impulse, inertia3);
        }
    }

    /// A half-plane bounces fixed particles, too: the course's own response has no test for them.
    fn particle_half_plane(&mut self, one: usize) {
        let student = self.world.student;
        let spares = student.makes(Mistake::ResponseHalfPlaneSparesFixed) && self.world.fixed(one);
        if student.holds(Place::SparesFixed { kind: 2, role: 0 }, spares) {
            return;
        }
        let h = self.world.scene.time_step;
        let mut speed = student.dot(self.velocity(0, one), self.u);
        if let Some(Change::Respond(change)) = student.change {
            let velocity = -self.bounce * speed * self.u;
            return self.respond(0, one, *change, velocity, h * velocity);
        }
        if student.makes(Mistake::ResponseSinglePrecision) {
            speed = single(speed);
        }
        let mut sign = if student.makes(Mistake::ResponseSign) { -1.0 } else { 1.0 };
        if student.makes(Mistake::ResponseHalfPlaneHalved) {
            sign = 0.5;
        }
        if !student.makes(Mistake::ResponsePositionsOnly) {
            let bounce = student.number(Place::VelocityChange { kind: 2, role: 0 }, self.bounce);
            let change = bounce * speed * self.u;
            subtract(&mut self.result.v, one, sign * change);
        }
        if !student.makes(Mistake::ResponseVelocitiesOnly) {
            let moved = if student.makes(Mistake::ResponsePositionNoStep) { self.bounce } else { h * self.bounce };
            let moved = student.number(Place::PositionChange { kind: 2, role: 0 }, moved);
            let change = moved * speed * self.u;
            subtract(&mut self.result.x, one, sign * change);
        }
    }
}

/// The masses of two particles in this student's formulas.
pub fn masses(student: Student, first: f64, second: f64) -> (f64, f64) {
    match student.mistake_in(HERE) {
        Some(Mistake::ResponseMassesSwapped) => (second, first),
        Some(Mistake::ResponseEqualMasses) => (1.0, 1.0),
        _ => (first, second),
    }
}

/// The share of an edge's second end in this student's formulas.
pub fn share_of_second(student: Student, alpha: f64) -> f64 {
    match student.mistake_in(HERE) {
        Some(Mistake::ResponseEdgeMiddle) => 0.5,
        Some(Mistake::ResponseEdgeSwapped) => 1.0 - alpha,
        _ => alpha,
    }
}

/// Between 0 and 1 in this student's program; 0 when it is not a number.
pub fn clamped(student: Student, alpha: f64) -> f64 {
    let positive = if student.holds(Place::ResponseClampLow, 0.0 < alpha) { alpha } else { 0.0 };
    if student.holds(Place::ResponseClampHigh, positive < 1.0) { positive } else { 1.0 }
}
