//! A particle and a half-plane: detection and responses (collisions.md 2, 3, 6).
//!
//! The half-plane is two-sided: only the distance to its boundary counts. A fixed particle is moved as well.
use super::response::{Change, Response, ResponseInput};
use crate::sim::bodies::Bodies;
use fosssim_num::{
    lanes::{Number, Plane},
    vector::{Vec2, length, unit, vector_at},
};
use std::ops::Mul;

/// Returns the coefficients of the two polynomials of a disc that starts at `x` and moves by `d` in the step: "closer
/// than `radius`" and "approaching". Highest power first, for one pair or several. `squared` is `dot(normal, normal)`.
#[inline(always)]
pub fn coefficients<N: Number>(
    x: Plane<N>,
    d: Plane<N>,
    radius: N,
    point: Plane<N>,
    normal: Plane<N>,
    squared: N,
) -> ([N; 3], [N; 2])
where
    f64: Mul<N, Output = N>,
{
    let s = d.dot(normal);
    let w = (point - x).dot(normal);
    ([-s * s, 2.0 * w * s, -w * w + (radius * radius) * squared], [-s * s, w * s])
}

/// Returns the contact normal at time `t`, from the center to its foot on the boundary.
#[inline]
pub(super) fn normal(x: Vec2, d: Vec2, point: Vec2, normal: Vec2, squared: f64, t: f64) -> Vec2 {
    (((point - x) - t * d).dot(&normal) / squared) * normal
}

/// Returns the response along normal `n`, from the mean velocity of the step.
pub(super) fn response(input: &ResponseInput<'_>, i: usize, n: Vec2) -> Response {
    let ResponseInput { law, q_start, q_end, .. } = *input;
    let u = unit(n);
    let speed = law.mean_velocity(q_start, q_end, i).dot(&u);
    let change = Change {
        particle: i,
        velocity: ((2.0 * law.factor) * speed) * u,
        position: (((law.time_step * 2.0) * law.factor) * speed) * u,
    };
    Response { gain: None, loss: [Some(change), None] }
}

/// Returns the vector from the disc's center to the boundary, if the disc overlaps it and approaches it (simple
/// detection).
#[inline]
pub(super) fn overlap(bodies: &Bodies, x: &[f64], v: &[f64], i: usize, half_plane: usize) -> Option<Vec2> {
    let q = unit(bodies.normals[half_plane]);
    let n = (bodies.points[half_plane] - vector_at(x, i)).dot(&q) * q;
    (length(n) < bodies.radii[i] && vector_at(v, i).dot(&n) > 0.0).then_some(n)
}

/// Returns the simple response along normal `n`, from the velocities `v`. Positions do not change.
pub(super) fn simple_response(factor: f64, v: &[f64], i: usize, n: Vec2) -> Response {
    let u = unit(n);
    let velocity = ((2.0 * factor) * vector_at(v, i).dot(&u)) * u;
    Response { gain: None, loss: [Some(Change { particle: i, velocity, position: Vec2::zeros() }), None] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{
        collision::response::ResponseConstants,
        samples::{fixed_copy, half_plane, particle, scene},
    };

    /// This is the example of trace-format.md 3.
    #[test]
    fn the_annotated_example() {
        let (x, d) = (Vec2::new(0.0, 0.5), Vec2::new(0.0, -0.5));
        let (point, q) = (Vec2::new(0.0, 0.0), Vec2::new(0.0, 1.0));
        let (overlap, approach) = coefficients(x.into(), d.into(), 0.25, point.into(), q.into(), 1.0);
        assert_eq!(overlap, [-0.25, 0.5, -0.1875]);
        assert_eq!(approach, [-0.25, 0.25]);
        let n = normal(x, d, point, q, 1.0, 0.5);
        assert_eq!([n.x.to_bits(), n.y.to_bits()], [(-0.0_f64).to_bits(), (-0.25_f64).to_bits()]);
    }

    #[test]
    fn even_a_fixed_particle_bounces() {
        let mut scene = scene(vec![fixed_copy(particle((0.0, 0.5), (0.0, -1.0), 1.0, 0.25))]);
        scene.half_planes.push(half_plane((0.0, 0.0), (0.0, 1.0)));
        let bodies = Bodies::new(&scene);
        let (q_start, q_end) = ([0.0, 0.5], [0.0, 0.0]);
        let input =
            ResponseInput { bodies: &bodies, law: &ResponseConstants::new(1.0, 0.5), q_start: &q_start, q_end: &q_end };
        let (mut q, mut v) = (q_end, [0.0, -1.0]);
        response(&input, 0, Vec2::new(0.0, -0.25)).apply(&mut q, &mut v);
        assert_eq!((q, v), ([0.0, 1.0], [0.0, 1.0]));
    }

    #[test]
    fn simple_detection_works_on_both_sides() {
        let mut scene = scene(vec![particle((0.0, 0.0), (0.0, 0.0), 1.0, 0.25)]);
        scene.half_planes.push(half_plane((0.0, 0.0), (0.0, 2.0)));
        let bodies = Bodies::new(&scene);
        assert_eq!(overlap(&bodies, &[0.0, 0.125], &[0.0, -1.0], 0, 0), Some(Vec2::new(0.0, -0.125)));
        assert_eq!(overlap(&bodies, &[0.0, -0.125], &[0.0, 1.0], 0, 0), Some(Vec2::new(0.0, 0.125)));
        assert_eq!(overlap(&bodies, &[0.0, 0.125], &[0.0, 1.0], 0, 0), None);
        assert_eq!(overlap(&bodies, &[0.0, 0.25], &[0.0, -1.0], 0, 0), None);
    }
}
