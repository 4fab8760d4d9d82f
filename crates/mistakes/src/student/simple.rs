//! Collision type `simple`: one pass over the positions at the end of the step, changing velocities (collisions.md 6).
use fosssim_num::vector::{Vec2, at, length, put, unit};

use super::{
    Mistake, StepMistake,
    author::Student,
    objects::{Contact, Object, State},
    response::{bounce, clamped, masses, share_of_second},
    world::{StepLog, World, add},
};

/// Handles all pairs in order; each sees the velocities that the pairs before it left.
pub fn handle(world: &World, state: &mut State, log: &mut StepLog) {
    let student = world.student;
    let start = student.makes(StepMistake::SimpleAllFromStart).then(|| state.v.clone());
    let pass = SimplePass { world, bounce: bounce(world), start };
    for pair in world.pairs() {
        let one = pair.particle;
        let n = match pair.object {
            Object::Particle(_) if student.makes(StepMistake::SimpleNoParticles) => None,
            Object::Edge(_) if student.makes(StepMistake::SimpleNoEdges) => None,
            Object::HalfPlane(_) if student.makes(StepMistake::SimpleNoHalfPlanes) => None,
            Object::Particle(other) => pass.particle_particle(state, one, other),
            Object::Edge(edge) => pass.particle_edge(state, one, edge),
            Object::HalfPlane(plane) => pass.particle_half_plane(state, one, plane),
        };
        log.impulses.extend(n.map(|n| Contact { pair, n, time: 0.0 }));
    }
}

struct SimplePass<'a> {
    world: &'a World,
    bounce: f64,
    /// The velocities before the pass, of a student who computes all impulses from them.
    start: Option<Vec<f64>>,
}

impl SimplePass<'_> {
    fn makes(&self, mistake: impl Into<Mistake>) -> bool {
        self.world.student.makes(mistake)
    }

    fn velocity(&self, state: &State, particle: usize) -> Vec2 {
        at(self.start.as_ref().unwrap_or(&state.v), particle)
    }

    /// Whether bodies at this distance that approach at this speed collide.
    fn collides(&self, n: Vec2, reach: f64, approach: f64) -> bool {
        let is_near = match () {
            () if self.makes(StepMistake::SimpleAlways) => true,
            () if self.makes(StepMistake::SimpleTouching) => length(n) <= reach,
            () => length(n) < reach,
        };
        let approaches = match () {
            () if self.makes(StepMistake::SimpleSeparating) => true,
            () if self.makes(StepMistake::SimpleApproachSign) => approach < 0.0,
            () => approach > 0.0,
        };
        is_near && approaches
    }

    /// The distance at which a particle and a body of this radius touch.
    fn reach(&self, particle: usize, other: f64) -> f64 {
        let radius = self.world.scene.particles[particle].radius;
        if self.makes(StepMistake::SimpleFirstRadiusOnly) { radius } else { radius + other }
    }

    fn unit(&self, n: Vec2) -> Vec2 {
        if self.makes(Mistake::ResponseNotNormalised) { n } else { unit(n) }
    }

    fn push(&self, state: &mut State, particle: usize, change: Vec2) {
        if !self.world.fixed(particle) || self.makes(Mistake::ResponseMovesFixed) {
            let change = if self.makes(Mistake::ResponseSign) { -change } else { change };
            add(&mut state.v, particle, change);
        }
    }

    fn particle_particle(&self, state: &mut State, one: usize, two: usize) -> Option<Vec2> {
        let n = at(&state.x, two) - at(&state.x, one);
        let (v1, v2) = (self.velocity(state, one), self.velocity(state, two));
        if !self.collides(n, self.reach(one, self.world.scene.particles[two].radius), (v1 - v2).dot(&n)) {
            return None;
        }
        let u = self.unit(n);
        let impulse = self.bounce * (v2 - v1).dot(&u);
        let (m1, m2) = (self.world.collision_mass(0, 0, one), self.world.collision_mass(0, 1, two));
        let (m1, m2) = masses(self.world.student, m1, m2);
        self.push(state, one, impulse / (1.0 + m1 / m2) * u);
        if !self.makes(Mistake::ResponseFirstOnly) {
            self.push(state, two, -(impulse / (m2 / m1 + 1.0) * u));
        }
        Some(n)
    }

    fn particle_edge(&self, state: &mut State, one: usize, index: usize) -> Option<Vec2> {
        let edge = self.world.scene.edges[index];
        let (two, three) = (edge.first, edge.second);
        let [x1, x2, x3] = [one, two, three].map(|particle| at(&state.x, particle));
        let [v1, v2, v3] = [one, two, three].map(|particle| self.velocity(state, particle));
        let alpha = (x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2));
        let alpha =
            if self.makes(StepMistake::SimpleEdgeUnclamped) { alpha } else { clamped(Student::default(), alpha) };
        let n = x2 + alpha * (x3 - x2) - x1;
        if !self.collides(n, self.reach(one, edge.radius), (v1 - v2 - alpha * (v3 - v2)).dot(&n)) {
            return None;
        }
        let alpha = share_of_second(self.world.student, alpha);
        let u = self.unit(n);
        let of_edge = if self.makes(Mistake::ResponseEdgeStill) { Vec2::zeros() } else { v2 + alpha * (v3 - v2) };
        let impulse = self.bounce * (of_edge - v1).dot(&u);
        let beta = 1.0 - alpha;
        let [m1, m2, m3] = [(0, one), (1, two), (2, three)].map(|(role, one)| self.world.collision_mass(1, role, one));
        let (low, high) =
            if self.makes(StepMistake::SimpleEdgeWeights) { (beta, alpha) } else { (beta * beta, alpha * alpha) };
        self.push(state, one, impulse / (1.0 + low * m1 / m2 + high * m1 / m3) * u);
        if self.makes(Mistake::ResponseFirstOnly) {
            return Some(n);
        }
        self.push(state, two, -(beta * impulse / (m2 / m1 + low + high * m2 / m3) * u));
        if !self.makes(Mistake::ResponseOneEndpoint) {
            self.push(state, three, -(alpha * impulse / (m3 / m1 + low * m3 / m2 + high) * u));
        }
        Some(n)
    }

    fn particle_half_plane(&self, state: &mut State, one: usize, index: usize) -> Option<Vec2> {
        let plane = self.world.scene.half_planes[index];
        let q = if self.makes(StepMistake::SimpleNormalLength) { plane.normal } else { unit(plane.normal) };
        let n = (plane.point - at(&state.x, one)).dot(&q) * q;
        let v = self.velocity(state, one);
        if !self.collides(n, self.world.scene.particles[one].radius, v.dot(&n)) {
            return None;
        }
        if self.world.fixed(one) && self.makes(Mistake::ResponseHalfPlaneSparesFixed) {
            return Some(n);
        }
        let u = self.unit(n);
        let change = self.bounce * v.dot(&u) * u;
        let sign = match () {
            () if self.makes(Mistake::ResponseSign) => -1.0,
            () if self.makes(Mistake::ResponseHalfPlaneHalved) => 0.5,
            () => 1.0,
        };
        let before = at(&state.v, one);
        put(&mut state.v, one, before - sign * change);
        Some(n)
    }
}
