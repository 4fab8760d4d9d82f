//! `simple` handling: impulses for bodies that overlap at the end of the step and approach (collisions.md 6).
//!
//! Velocities change immediately, so later pairs use the new ones; positions never change. If pairs that are apart are
//! not needed, only the pairs found by the broad phase are checked.
use super::{
    super::{
        bodies::Bodies,
        nearby::NearbyPairs,
        observer::{Decision, Detection, ImpactTime, Impulse, Observer, Pass, Stage, WantedPairs},
        pair::{PairKind, pair},
        pairs::{PassCursor, is_end},
        state::State,
    },
    particle_edge, particle_half_plane, particle_particle,
    response::{Response, ResponseConstants},
};
use fosssim_num::vector::Vec2;

/// Handles the overlaps at the end of a step; `nearby` finds pairs without a margin.
pub(super) fn handle<O: Observer>(
    bodies: &Bodies,
    law: &ResponseConstants,
    nearby: Option<&mut NearbyPairs>,
    q_start: &[f64],
    state: &mut State,
    observer: &mut O,
) {
    let pass = Pass { stage: Stage::Simple, index: 0 };
    let State { positions: x, velocities: v } = state;
    observer.begin_pass(pass);
    let mut found = match observer.wanted_pairs() {
        WantedPairs::Calls => None,
        WantedPairs::Bytes(_) | WantedPairs::Nothing => nearby.and_then(|nearby| nearby.find(x)),
    };
    let mut running = RunningPass { pass, bodies, factor: law.factor, q_start, x, v, observer, hits: 0 };
    for i in 0..bodies.particle_count() {
        let [particles, edges, half_planes] = bodies.object_counts().remaining_row(PassCursor::from_first(i));
        if let Some(found) = &mut found {
            let [particles, edges] = found.next(i);
            particles.for_each(|j| running.decide_particle_pair(i, j));
            edges.for_each(|edge| running.decide_edge_pair(i, edge));
        } else {
            particles.for_each(|j| running.decide_particle_pair(i, j));
            edges.filter(|&edge| !is_end(bodies.edges[edge], i)).for_each(|edge| running.decide_edge_pair(i, edge));
        }
        half_planes.for_each(|half_plane| running.decide_half_plane_pair(i, half_plane));
    }
    let hits = running.hits;
    observer.end_pass(pass, hits);
}

/// A running pass.
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
    fn decide_particle_pair(&mut self, i: usize, j: usize) {
        let normal = particle_particle::overlap(self.bodies, self.x, self.v, i, j);
        self.decide_pair(PairKind::ParticleParticle, i, j, normal, |running, n| {
            particle_particle::simple_response(running.bodies, running.factor, running.v, i, j, n)
        });
    }

    fn decide_edge_pair(&mut self, i: usize, edge: usize) {
        let normal = particle_edge::overlap(self.bodies, self.x, self.v, i, edge);
        self.decide_pair(PairKind::ParticleEdge, i, edge, normal, |running, n| {
            let (bodies, ends) = (running.bodies, running.bodies.edges[edge]);
            particle_edge::simple_response(bodies, running.factor, running.x, running.v, i, ends, n)
        });
    }

    fn decide_half_plane_pair(&mut self, i: usize, half_plane: usize) {
        let normal = particle_half_plane::overlap(self.bodies, self.x, self.v, i, half_plane);
        self.decide_pair(PairKind::ParticleHalfPlane, i, half_plane, normal, |running, n| {
            particle_half_plane::simple_response(running.factor, running.v, i, n)
        });
    }

    /// Decides a pair, and responds if it collides.
    fn decide_pair(
        &mut self,
        kind: PairKind,
        first: usize,
        second: usize,
        normal: Option<Vec2>,
        respond: impl FnOnce(&Self, Vec2) -> Response,
    ) {
        let pair = pair(kind, first, second);
        let decision =
            normal.map_or(Decision::Miss { time: ImpactTime::None }, |normal| Decision::Hit { time: 0.0, normal });
        let decision = self.observer.as_controller().map_or(decision, |steer| steer.adjust_decision(pair, decision));
        let (pass, q_start, q_end, velocities) = (self.pass, self.q_start, self.x, &*self.v);
        self.observer.observe_detection(&Detection {
            pass,
            pair,
            polynomials: &[],
            decision,
            q_start,
            q_end,
            velocities,
        });
        if let Decision::Hit { normal, .. } = decision {
            self.hits += 1;
            self.observer.observe_hit(pair);
            respond(self, normal).apply_velocities(self.v);
            self.observer.observe_impulse(&Impulse { pair, normal, time: 0.0 });
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        scene::Collision,
        sim::{
            Observer, RootSearch, Simulation,
            samples::{NumberSource, edge, half_plane, particle, scene},
        },
    };

    /// An observer that requests every pair.
    struct Everything;
    impl Observer for Everything {}

    /// Omitting pairs that are apart changes no bit.
    #[test]
    fn velocities_do_not_depend_on_observed_pairs() {
        let mut numbers = NumberSource(3);
        let mut balls = Vec::new();
        for _ in 0..80 {
            let ((x, y), (vx, vy)) = (numbers.next_pair(), numbers.next_pair());
            balls.push(particle((2.0 * x, 2.0 * y), (0.1 * vx, 0.1 * vy), 1.0, 0.1));
        }
        let mut scene = scene(balls);
        scene.collision = Collision::Simple { restitution: 0.7 };
        scene.edges.extend((0..10).map(|number| edge(7 * number, 7 * number + 1, 0.05)));
        scene.half_planes.push(half_plane((0.0, -1.5), (0.2, 1.0)));
        let [mut asked, mut unasked] = [0, 1].map(|_| Simulation::new(&scene, RootSearch::default()));
        let start = asked.state().velocities.clone();
        for _ in 0..5 {
            asked.step(&mut Everything).expect("a step");
            unasked.step(&mut ()).expect("a step");
            assert_eq!(asked.state(), unasked.state());
        }
        let turned_count =
            start.iter().zip(&asked.state().velocities).filter(|(before, after)| before != after).count();
        assert!(turned_count > 50, "{turned_count}");
    }
}
