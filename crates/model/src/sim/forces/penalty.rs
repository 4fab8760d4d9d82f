//! The penalty force: everything closer than the thickness repels (simulation.md 3, penalty force).
//!
//! Its Hessians count as zero, as in the original. There is no guard against zero distance: the direction is NaN then,
//! and reaches the gradient when the distance test holds.
use super::{add, subtract};
use crate::sim::{
    bodies::Bodies,
    pairs::{PassCursor, is_end},
};
use fosssim_num::vector::{Vec2, at, length, unit};

/// Stiffness `k` (force per length) and thickness `h` (length) of the layer around every body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Penalty {
    /// `k`
    pub stiffness: f64,
    /// `h`
    pub thickness: f64,
}

/// Whether the vector is certainly not shorter than `reach`, without a square root.
///
/// With `s` the rounded `reach * reach`, a rounded squared length above `s` is at least the next number after `s`,
/// hence above the exact square of `reach`; its root is then at least `reach` after rounding too. A negative `reach`
/// is never undercut, and NaN gives `false`.
#[inline]
fn beyond(n: Vec2, reach: f64) -> bool {
    n.x * n.x + n.y * n.y > reach * reach
}

impl Penalty {
    /// Adds the gradient, pair by pair in the order of a detection pass.
    pub fn add_gradient(self, bodies: &Bodies, x: &[f64], gradient: &mut [f64]) {
        for i in 0..bodies.particles() {
            let [particles, edges, half_planes] = bodies.objects().row(PassCursor::of(i));
            // Nearly all others are beyond reach, which is asked here with as few instructions as possible.
            let (own, radius) = (at(x, i), bodies.radii[i]);
            let others = x.as_chunks::<2>().0[particles.clone()].iter().zip(&bodies.radii[particles.clone()]);
            for (j, (other, other_radius)) in particles.zip(others) {
                let n = Vec2::new(other[0], other[1]) - own;
                if !beyond(n, (radius + other_radius) + self.thickness) {
                    self.particle_particle(bodies, i, j, x, gradient);
                }
            }
            for edge in edges {
                if !is_end(bodies.edges[edge], i) {
                    self.particle_edge(bodies, i, edge, x, gradient);
                }
            }
            for half_plane in half_planes {
                self.particle_half_plane(bodies, i, half_plane, x, gradient);
            }
        }
    }

    fn particle_particle(self, bodies: &Bodies, i: usize, j: usize, x: &[f64], gradient: &mut [f64]) {
        let n = at(x, j) - at(x, i);
        let (r1, r2) = (bodies.radii[i], bodies.radii[j]);
        let reach = (r1 + r2) + self.thickness;
        let l = length(n);
        if l < reach {
            let u = unit(n);
            let s = self.stiffness * (((l - r1) - r2) - self.thickness);
            subtract(gradient, i, s * u);
            add(gradient, j, s * u);
        }
    }

    #[inline]
    fn particle_edge(self, bodies: &Bodies, i: usize, edge: usize, x: &[f64], gradient: &mut [f64]) {
        let [first, second] = bodies.edges[edge];
        let (x1, x2, x3) = (at(x, i), at(x, first), at(x, second));
        let x32 = x3 - x2;
        // These comparisons keep a NaN, unlike those of the responses.
        let alpha = ((x1 - x2).dot(&x32) / x32.dot(&x32)).clamp(0.0, 1.0);
        let n = (x2 + alpha * x32) - x1;
        let (r1, r2) = (bodies.radii[i], bodies.edge_radii[edge]);
        let reach = (r1 + r2) + self.thickness;
        if beyond(n, reach) {
            return;
        }
        let l = length(n);
        if l < reach {
            let u = unit(n);
            let depth = ((l - r1) - r2) - self.thickness;
            let k = self.stiffness;
            subtract(gradient, i, (k * depth) * u);
            add(gradient, first, ((k * (1.0 - alpha)) * depth) * u);
            add(gradient, second, ((k * alpha) * depth) * u);
        }
    }

    #[inline]
    fn particle_half_plane(self, bodies: &Bodies, i: usize, half_plane: usize, x: &[f64], gradient: &mut [f64]) {
        let (p, q) = (bodies.points[half_plane], bodies.normals[half_plane]);
        let squared = q.dot(&q);
        let n = ((p - at(x, i)).dot(&q) / squared) * q;
        let r = bodies.radii[i];
        let reach = r + self.thickness;
        if beyond(n, reach) {
            return;
        }
        let l = length(n);
        if l < reach {
            let u = unit(n);
            let s = self.stiffness * ((l - r) - self.thickness) * u.dot(&q) / squared;
            subtract(gradient, i, s * q);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::samples::{Numbers, edge, half_plane, particle, scene};

    fn gradient(bodies: &Bodies, x: &[f64]) -> Vec<f64> {
        let mut gradient = vec![0.0; x.len()];
        Penalty { stiffness: 10.0, thickness: 0.1 }.add_gradient(bodies, x, &mut gradient);
        gradient
    }

    #[test]
    fn bodies_within_the_thickness_repel_and_others_do_not() {
        let x = [0.0, 0.0, 0.25, 0.0, 0.0, 5.0];
        let mut scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
        scene.half_planes.push(half_plane((0.0, 4.85), (0.0, 2.0)));
        let g = gradient(&Bodies::new(&scene), &x);
        // Gap 0.05 under a thickness of 0.1: a force of 10 * 0.05, away from the other (the gradient towards it).
        assert!((g[0] - 0.5).abs() < 1e-14 && (g[2] + 0.5).abs() < 1e-14, "{g:?}");
        assert!((g[5] + 0.5).abs() < 1e-14, "{g:?}");
        assert_eq!([g[1], g[3], g[4]], [0.0; 3]);
    }

    #[test]
    fn an_edge_shares_the_force_among_its_ends() {
        let x = [0.25, 0.2, 0.0, 0.0, 1.0, 0.0];
        let mut scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
        scene.edges.push(edge(1, 2, 0.05));
        let g = gradient(&Bodies::new(&scene), &x);
        assert!((g[1] + 0.5).abs() < 1e-14 && (g[3] - 0.375).abs() < 1e-14 && (g[5] - 0.125).abs() < 1e-14, "{g:?}");
    }

    #[test]
    fn coincident_particles_give_nan() {
        let x = [1.0, 1.0, 1.0, 1.0];
        let scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
        assert!(gradient(&Bodies::new(&scene), &x).iter().all(|g| g.is_nan()));
    }

    /// Leaving out the square root never changes the outcome of the distance test, at and around equality.
    #[test]
    fn the_early_way_out_agrees_with_the_test_by_length() {
        let mut numbers = Numbers(1);
        for _ in 0..20_000 {
            let (x, y) = numbers.pair();
            let scale = if numbers.next() < 0.0 { 1.0 } else { 1e-160 };
            let n = Vec2::new(x * scale, y * scale);
            let l = length(n);
            for reach in [l, l.next_up(), l.next_down(), -l, 0.0, f64::INFINITY, f64::NAN] {
                assert!(!(beyond(n, reach) && l < reach), "{n:?} {reach}");
            }
        }
    }
}
