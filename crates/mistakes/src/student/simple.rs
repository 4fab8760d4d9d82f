//! Collision type `simple`: one pass over the positions at the end of the step, changing velocities (collisions.md 6).
use fosssim_num::vector::{Vec2, at, length, put, unit};

use super::{
    objects::{Contact, Object, Pair, State},
    response::{clamped, restitution},
    world::{StepLog, World, add},
};

/// Handles all pairs in order; each sees the velocities that the pairs before it left.
pub fn handle(world: &World, state: &mut State, log: &mut StepLog) {
    let bounce = 2.0 * ((1.0 + restitution(world)) / 2.0);
    for pair in world.pairs() {
        let n = match pair.object {
            Object::Particle(other) => particle_particle(world, state, bounce, pair.particle, other),
            Object::Edge(edge) => particle_edge(world, state, bounce, pair.particle, edge),
            Object::HalfPlane(plane) => particle_half_plane(world, state, bounce, pair.particle, plane),
        };
        log.impulses.extend(n.map(|n| contact(pair, n)));
    }
}

fn contact(pair: Pair, n: Vec2) -> Contact {
    Contact { pair, n, time: 0.0 }
}

fn push(world: &World, state: &mut State, particle: usize, change: Vec2) {
    if !world.fixed(particle) {
        add(&mut state.v, particle, change);
    }
}

fn particle_particle(world: &World, state: &mut State, bounce: f64, one: usize, two: usize) -> Option<Vec2> {
    let n = at(&state.x, two) - at(&state.x, one);
    let (v1, v2) = (at(&state.v, one), at(&state.v, two));
    let reach = world.scene.particles[one].radius + world.scene.particles[two].radius;
    if !(length(n) < reach && (v1 - v2).dot(&n) > 0.0) {
        return None;
    }
    let u = unit(n);
    let impulse = bounce * (v2 - v1).dot(&u);
    let (m1, m2) = (world.collision_mass(0, 0, one), world.collision_mass(0, 1, two));
    push(world, state, one, impulse / (1.0 + m1 / m2) * u);
    push(world, state, two, -(impulse / (m2 / m1 + 1.0) * u));
    Some(n)
}

fn particle_edge(world: &World, state: &mut State, bounce: f64, one: usize, index: usize) -> Option<Vec2> {
    let edge = world.scene.edges[index];
    let (two, three) = (edge.first, edge.second);
    let [x1, x2, x3] = [one, two, three].map(|particle| at(&state.x, particle));
    let [v1, v2, v3] = [one, two, three].map(|particle| at(&state.v, particle));
    let alpha = clamped((x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2)));
    let n = x2 + alpha * (x3 - x2) - x1;
    let reach = world.scene.particles[one].radius + edge.radius;
    if !(length(n) < reach && (v1 - v2 - alpha * (v3 - v2)).dot(&n) > 0.0) {
        return None;
    }
    let u = unit(n);
    let impulse = bounce * (v2 + alpha * (v3 - v2) - v1).dot(&u);
    let beta = 1.0 - alpha;
    let [m1, m2, m3] = [(0, one), (1, two), (2, three)].map(|(role, one)| world.collision_mass(1, role, one));
    push(world, state, one, impulse / (1.0 + beta * beta * m1 / m2 + alpha * alpha * m1 / m3) * u);
    push(world, state, two, -(beta * impulse / (m2 / m1 + beta * beta + alpha * alpha * m2 / m3) * u));
    push(world, state, three, -(alpha * impulse / (m3 / m1 + beta * beta * m3 / m2 + alpha * alpha) * u));
    Some(n)
}

fn particle_half_plane(world: &World, state: &mut State, bounce: f64, one: usize, index: usize) -> Option<Vec2> {
    let plane = world.scene.half_planes[index];
    let q = unit(plane.normal);
    let n = (plane.point - at(&state.x, one)).dot(&q) * q;
    let v = at(&state.v, one);
    if !(length(n) < world.scene.particles[one].radius && v.dot(&n) > 0.0) {
        return None;
    }
    let u = unit(n);
    put(&mut state.v, one, v - bounce * v.dot(&u) * u);
    Some(n)
}
