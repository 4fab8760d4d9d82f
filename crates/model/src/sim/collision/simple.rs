//! `simple` handling: impulses for bodies that overlap at the end of the step and approach (collisions.md 6).
//!
//! Velocities change immediately, so that later pairs see them; positions never change.
use super::{
    super::{
        bodies::Bodies,
        observer::{Decision, Detection, Impulse, Observer, Pass, Stage, Time},
        pair::{PairKind, pair},
        pairs::{PassCursor, is_end},
        state::State,
    },
    particle_edge, particle_half_plane, particle_particle,
    response::{Law, Response},
};
use fosssim_num::vector::Vec2;

/// Handles the overlaps at the end of a step.
pub(super) fn handle<O: Observer>(bodies: &Bodies, law: &Law, q_start: &[f64], state: &mut State, observer: &mut O) {
    let pass = Pass { stage: Stage::Simple, index: 0 };
    let State { positions: x, velocities: v } = state;
    observer.begin_pass(pass);
    let mut looking = RunningPass { pass, bodies, factor: law.factor, q_start, x, v, observer, hits: 0 };
    for i in 0..bodies.particles() {
        let [particles, edges, half_planes] = bodies.objects().row(PassCursor::from_first(i));
        particles.for_each(|j| looking.try_particles(i, j));
        edges.filter(|&edge| !is_end(bodies.edges[edge], i)).for_each(|edge| looking.try_edge(i, edge));
        half_planes.for_each(|half_plane| looking.try_half_plane(i, half_plane));
    }
    let hits = looking.hits;
    observer.end_pass(pass, hits);
}

/// A pass at work.
struct RunningPass<'a, O> {
    pass: Pass,
    bodies: &'a Bodies,
    factor: f64,
    q_start: &'a [f64],
    x: &'a [f64],
    v: &'a mut [f64],
    observer: &'a mut O,
    hits: usize,
}

impl<O: Observer> RunningPass<'_, O> {
    fn try_particles(&mut self, i: usize, j: usize) {
        let normal = particle_particle::overlap(self.bodies, self.x, self.v, i, j);
        self.settle(PairKind::ParticleParticle, i, j, normal, |looking, n| {
            particle_particle::simple_response(looking.bodies, looking.factor, looking.v, i, j, n)
        });
    }

    fn try_edge(&mut self, i: usize, edge: usize) {
        let normal = particle_edge::overlap(self.bodies, self.x, self.v, i, edge);
        self.settle(PairKind::ParticleEdge, i, edge, normal, |looking, n| {
            let (bodies, ends) = (looking.bodies, looking.bodies.edges[edge]);
            particle_edge::simple_response(bodies, looking.factor, looking.x, looking.v, i, ends, n)
        });
    }

    fn try_half_plane(&mut self, i: usize, half_plane: usize) {
        let normal = particle_half_plane::overlap(self.bodies, self.x, self.v, i, half_plane);
        self.settle(PairKind::ParticleHalfPlane, i, half_plane, normal, |looking, n| {
            particle_half_plane::simple_response(looking.factor, looking.v, i, n)
        });
    }

    /// Decides about a pair, and answers if it collides.
    fn settle(
        &mut self,
        kind: PairKind,
        first: usize,
        second: usize,
        normal: Option<Vec2>,
        respond: impl FnOnce(&Self, Vec2) -> Response,
    ) {
        let pair = pair(kind, first, second);
        let decision = normal.map_or(Decision::Miss { time: Time::None }, |normal| Decision::Hit { time: 0.0, normal });
        let decision = self.observer.steers().map_or(decision, |steer| steer.decide(pair, decision));
        let (pass, q_start, q_end, velocities) = (self.pass, self.q_start, self.x, &*self.v);
        self.observer.detection(&Detection { pass, pair, polynomials: &[], decision, q_start, q_end, velocities });
        if let Decision::Hit { normal, .. } = decision {
            self.hits += 1;
            self.observer.hit(pair);
            respond(self, normal).apply_velocities(self.v);
            self.observer.impulse(&Impulse { pair, normal, time: 0.0 });
        }
    }
}
