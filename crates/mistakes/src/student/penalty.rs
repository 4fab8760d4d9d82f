//! The penalty force, which `penalty` and `hybrid` scenes add to the others (simulation.md 3).
use fosssim_num::vector::{at, length, unit};

use super::world::{World, add, subtract};

/// Adds the gradient of the penalty force with stiffness `k` and thickness `h`.
pub fn add_gradient(world: &World, k: f64, h: f64, x: &[f64], g: &mut [f64]) {
    let particles = &world.scene.particles;
    for i in 0..particles.len() {
        for j in i + 1..particles.len() {
            particle_particle(world, k, h, (i, j), x, g);
        }
        for (index, edge) in world.scene.edges.iter().enumerate() {
            if edge.first != i && edge.second != i {
                particle_edge(world, k, h, (i, index), x, g);
            }
        }
        for plane in 0..world.scene.half_planes.len() {
            particle_half_plane(world, k, h, (i, plane), x, g);
        }
    }
}

fn particle_particle(world: &World, k: f64, h: f64, (i, j): (usize, usize), x: &[f64], g: &mut [f64]) {
    let (first, second) = (world.scene.particles[i].radius, world.scene.particles[j].radius);
    let n = at(x, j) - at(x, i);
    let distance = length(n);
    if distance < first + second + h {
        let push = k * (distance - first - second - h) * unit(n);
        subtract(g, i, push);
        add(g, j, push);
    }
}

fn particle_edge(world: &World, k: f64, h: f64, (i, edge): (usize, usize), x: &[f64], g: &mut [f64]) {
    let edge = world.scene.edges[edge];
    let radius = world.scene.particles[i].radius;
    let (x1, x2, x3) = (at(x, i), at(x, edge.first), at(x, edge.second));
    let alpha = (x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2));
    // A NaN stays one here, unlike in the responses.
    let alpha = alpha.clamp(0.0, 1.0);
    let n = x2 + alpha * (x3 - x2) - x1;
    let distance = length(n);
    if distance < radius + edge.radius + h {
        let depth = distance - radius - edge.radius - h;
        let u = unit(n);
        subtract(g, i, k * depth * u);
        add(g, edge.first, k * (1.0 - alpha) * depth * u);
        add(g, edge.second, k * alpha * depth * u);
    }
}

fn particle_half_plane(world: &World, k: f64, h: f64, (i, plane): (usize, usize), x: &[f64], g: &mut [f64]) {
    let plane = world.scene.half_planes[plane];
    let radius = world.scene.particles[i].radius;
    let q = plane.normal;
    let n = (plane.point - at(x, i)).dot(&q) / q.dot(&q) * q;
    let distance = length(n);
    if distance < radius + h {
        subtract(g, i, k * (distance - radius - h) * unit(n).dot(&q) / q.dot(&q) * q);
    }
}
