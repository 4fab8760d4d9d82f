//! Handles collisions at the end of a step with impulses.
use fosssim_model::scene::Scene;
use fosssim_num::vector::{Vec2, divide, length, set_vector, vector_at};
use fosssim_oracle::student::{Contact, Object, Pair, State};

/// A particle that an impulse changes, with its share of the impulse; the first body's share is positive.
type ImpulseShare = (usize, f64);

/// Handles all pairs in the order of detection.
pub(super) fn handle(scene: &Scene, restitution: f64, state: &mut State) -> Vec<Contact> {
    let State { x, v } = state;
    let mut contacts = Vec::new();
    for (particle, body) in scene.particles.iter().enumerate() {
        let place = vector_at(x, particle);
        let mut meet = |object: Object, n: Vec2, reach: f64, others: &[ImpulseShare]| {
            let shares: Vec<ImpulseShare> = std::iter::once((particle, 1.0)).chain(others.iter().copied()).collect();
            if length(n) < reach && respond(scene, restitution, v, n, &shares) {
                contacts.push(Contact { pair: Pair { particle, object }, n, time: 0.0 });
            }
        };
        for (other, second) in scene.particles.iter().enumerate().skip(particle + 1) {
            meet(Object::Particle(other), vector_at(x, other) - place, body.radius + second.radius, &[(other, -1.0)]);
        }
        for (index, edge) in scene.edges.iter().enumerate() {
            if particle == edge.first || particle == edge.second {
                continue;
            }
            let (x2, x3) = (vector_at(x, edge.first), vector_at(x, edge.second));
            let along = x3 - x2;
            let alpha = ((place - x2).dot(&along) / along.dot(&along)).clamp(0.0, 1.0);
            let n = (1.0 - alpha) * x2 + alpha * x3 - place;
            let shares = [(edge.first, -(1.0 - alpha)), (edge.second, -alpha)];
            meet(Object::Edge(index), n, body.radius + edge.radius, &shares);
        }
        for (index, plane) in scene.half_planes.iter().enumerate() {
            let q = divide(plane.normal, length(plane.normal));
            meet(Object::HalfPlane(index), (plane.point - place).dot(&q) * q, body.radius, &[]);
        }
    }
    contacts
}

/// Responds to a contact if its bodies approach, and returns whether they do.
fn respond(scene: &Scene, restitution: f64, v: &mut [f64], n: Vec2, shares: &[ImpulseShare]) -> bool {
    let speed = shares.iter().map(|&(particle, share)| share * vector_at(v, particle)).sum::<Vec2>().dot(&n);
    if !(speed > 0.0) {
        return false;
    }
    let u = divide(n, length(n));
    // A half-plane also stops a fixed particle.
    let mobility = |&(particle, share): &ImpulseShare| {
        let body = &scene.particles[particle];
        if body.fixed && shares.len() > 1 { 0.0 } else { share * share / body.mass }
    };
    let impulse = (1.0 + restitution) * speed / length(n) / shares.iter().map(mobility).sum::<f64>();
    for share in shares.iter().filter(|share| mobility(share) > 0.0) {
        let &(particle, part) = share;
        set_vector(v, particle, vector_at(v, particle) - impulse * part / scene.particles[particle].mass * u);
    }
    true
}
