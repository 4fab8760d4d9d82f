//! `simple` handling: impulses where bodies overlap at the end of the step and approach (collisions.md 6).
//!
//! Velocities change at once, so that later pairs see them; positions never change.
use super::{
    super::{
        bodies::Bodies,
        observer::{Decision, Detection, Impulse, Observer, Pass, Stage, Time},
        pair::{Pair, PairKind, pair},
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
    let mut hits = 0;
    observer.begin_pass(pass);
    let mut look = |pair: Pair, normal: Option<Vec2>, v: &mut [f64], respond: &dyn Fn(&[f64], Vec2) -> Response| {
        let decision = normal.map_or(Decision::Miss { time: Time::None }, |normal| Decision::Hit { time: 0.0, normal });
        let decision = observer.decide(pair, decision);
        observer.detection(&Detection { pair, polynomials: &[], decision, q_start, q_end: x });
        if let Decision::Hit { normal, .. } = decision {
            hits += 1;
            respond(v, normal).apply_velocities(v);
            observer.impulse(&Impulse { pair, normal, time: 0.0 });
        }
    };
    for i in 0..bodies.particles() {
        let [particles, edges, half_planes] = bodies.objects().row(PassCursor::of(i));
        for j in particles {
            let normal = particle_particle::overlap(bodies, x, v, i, j);
            look(pair(PairKind::ParticleParticle, i, j), normal, v, &|v, n| {
                particle_particle::simple_response(bodies, law.factor, v, i, j, n)
            });
        }
        for e in edges {
            let ends = bodies.edges[e];
            if !is_end(ends, i) {
                let normal = particle_edge::overlap(bodies, x, v, i, e);
                look(pair(PairKind::ParticleEdge, i, e), normal, v, &|v, n| {
                    particle_edge::simple_response(bodies, law.factor, x, v, i, ends, n)
                });
            }
        }
        for h in half_planes {
            let normal = particle_half_plane::overlap(bodies, x, v, i, h);
            look(pair(PairKind::ParticleHalfPlane, i, h), normal, v, &|v, n| {
                particle_half_plane::simple_response(law.factor, v, i, n)
            });
        }
    }
    observer.end_pass(pass, hits);
}
