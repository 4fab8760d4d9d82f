//! A particle and an edge: detection and responses (collisions.md 2, 3, 6).
//!
//! End caps are not handled. The particles at the ends should be at least as thick as the edge.
mod polynomials;

use super::response::{Change, Response, ResponseInput, clamp};
use crate::sim::bodies::Bodies;
use fosssim_num::vector::{Vec2, length, unit, vector_at};
pub use polynomials::{EdgeMotions, EdgePolynomials, coefficients, coefficients_and_right_cubic};

/// Returns the contact normal at time `t`, from the particle to the closest point of the edge's line. Returns `None`
/// (no hit) if the normal is zero. A NaN normal counts as a hit.
#[inline]
pub(super) fn normal([x1, x2, x3]: [Vec2; 3], [d1, d2, d3]: [Vec2; 3], t: f64) -> Option<Vec2> {
    let a = ((x1 + t * d1) - x2) - t * d2;
    let b = ((x3 + t * d3) - x2) - t * d2;
    let alpha = a.dot(&b) / b.dot(&b);
    let n = (((x2 + t * d2) + alpha * b) - x1) - t * d1;
    (length(n) != 0.0).then_some(n)
}

/// Returns the response along normal `n` at time `t`, from the mean velocities of the step.
pub(super) fn response(input: &ResponseInput<'_>, i: usize, [first, second]: [usize; 2], n: Vec2, t: f64) -> Response {
    let ResponseInput { bodies, law, q_start, q_end } = *input;
    let v1 = law.mean_velocity(q_start, q_end, i);
    let v2 = law.mean_velocity(q_start, q_end, first);
    let v3 = law.mean_velocity(q_start, q_end, second);
    let time = t * law.time_step;
    let y1 = vector_at(q_start, i) + time * v1;
    let y2 = vector_at(q_start, first) + time * v2;
    let y3 = vector_at(q_start, second) + time * v3;
    let alpha = nearest_parameter(y1, y2, y3);
    let on_edge = v2 + alpha * (v3 - v2);
    exchange(bodies, law.factor, law.time_step, [i, first, second], alpha, on_edge - v1, unit(n))
}

/// Returns the vector from the disc's center to the nearest point of the edge, if the disc overlaps the edge and
/// approaches it (simple detection).
#[inline]
pub(super) fn overlap(bodies: &Bodies, x: &[f64], v: &[f64], i: usize, edge: usize) -> Option<Vec2> {
    let [first, second] = bodies.edges[edge];
    let (x1, x2, x3) = (vector_at(x, i), vector_at(x, first), vector_at(x, second));
    let alpha = nearest_parameter(x1, x2, x3);
    let n = (x2 + alpha * (x3 - x2)) - x1;
    if length(n) < bodies.radii[i] + bodies.edge_radii[edge] {
        let (v1, v2, v3) = (vector_at(v, i), vector_at(v, first), vector_at(v, second));
        return (((v1 - v2) - alpha * (v3 - v2)).dot(&n) > 0.0).then_some(n);
    }
    None
}

/// Returns the simple response along normal `n`, from the velocities `v`. Positions do not change.
pub(super) fn simple_response(
    bodies: &Bodies,
    factor: f64,
    x: &[f64],
    v: &[f64],
    i: usize,
    [first, second]: [usize; 2],
    n: Vec2,
) -> Response {
    let alpha = nearest_parameter(vector_at(x, i), vector_at(x, first), vector_at(x, second));
    let (v1, v2, v3) = (vector_at(v, i), vector_at(v, first), vector_at(v, second));
    let on_edge = v2 + alpha * (v3 - v2);
    exchange(bodies, factor, 0.0, [i, first, second], alpha, on_edge - v1, unit(n))
}

/// Returns the parameter in [0, 1] of the edge's point from `y2` to `y3` that is nearest to `y1`, or 0 if it is NaN.
#[inline]
fn nearest_parameter(y1: Vec2, y2: Vec2, y3: Vec2) -> f64 {
    let edge = y3 - y2;
    clamp((y1 - y2).dot(&edge) / edge.dot(&edge))
}

/// Returns the exchange of momentum along the unit vector `u` at parameter `alpha` of the edge for relative velocity
/// `relative` (edge minus particle).
fn exchange(
    bodies: &Bodies,
    factor: f64,
    dt: f64,
    [i, first, second]: [usize; 3],
    alpha: f64,
    relative: Vec2,
    u: Vec2,
) -> Response {
    let (m1, m2, m3) = (bodies.response_masses[i], bodies.response_masses[first], bodies.response_masses[second]);
    let numerator = (2.0 * factor) * relative.dot(&u);
    let b = 1.0 - alpha;
    let denominator1 = 1.0 + b * b * m1 / m2 + alpha * alpha * m1 / m3;
    let denominator2 = m2 / m1 + b * b + alpha * alpha * m2 / m3;
    let denominator3 = m3 / m1 + b * b * m3 / m2 + alpha * alpha;
    let gain = (!bodies.fixed[i]).then(|| Change {
        particle: i,
        velocity: (numerator / denominator1) * u,
        position: ((dt * numerator) / denominator1) * u,
    });
    let share = |particle: usize, weight: f64, denominator: f64| {
        (!bodies.fixed[particle]).then(|| Change {
            particle,
            velocity: ((weight * numerator) / denominator) * u,
            position: (((dt * weight) * numerator) / denominator) * u,
        })
    };
    Response { gain, loss: [share(first, b, denominator2), share(second, alpha, denominator3)] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{
        collision::response::ResponseConstants,
        samples::{NumberSource, edge, particle, scene},
    };

    fn vector((x, y): (f64, f64)) -> Vec2 {
        Vec2::new(x, y)
    }

    #[test]
    fn a_zero_normal_is_none() {
        let x = [(0.0, 1.0), (-1.0, 0.0), (1.0, 0.0)].map(vector);
        let d = [(0.0, -0.5), (0.0, 0.5), (0.0, 0.5)].map(vector);
        assert_eq!(normal(x, d, 0.75), Some(vector((0.0, -0.25))));
        assert_eq!(normal(x, d, 1.0), None);
        let nowhere = [(0.0, 1.0), (1.0, 0.0), (1.0, 0.0)].map(vector);
        assert!(normal(nowhere, d, 0.5).is_some_and(|n| n.x.is_nan()), "an edge without length");
    }

    #[test]
    fn overlap_is_looked_for_along_the_edge_only() {
        let mut scene = scene((0..3).map(|_| particle((0.0, 0.0), (0.0, 0.0), 1.0, 0.1)).collect());
        scene.edges.push(edge(1, 2, 0.15));
        let bodies = Bodies::new(&scene);
        let (x, down) = ([0.0, 0.2, -1.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(overlap(&bodies, &x, &down, 0, 0), Some(vector((0.0, -0.2))));
        assert_eq!(overlap(&bodies, &x, &[0.0, 1.0, 0.0, 0.0, 0.0, 0.0], 0, 0), None, "moving apart");
        assert_eq!(overlap(&bodies, &[3.0, 0.2, -1.0, 0.0, 1.0, 0.0], &down, 0, 0), None, "beyond the end");
    }

    /// An impact conserves momentum, and with restitution 1 reverses the relative speed at the contact.
    #[test]
    fn impacts_conserve_momentum() {
        let mut numbers = NumberSource(11);
        for _ in 0..1000 {
            let masses: [f64; 3] = std::array::from_fn(|_| 1.5 + numbers.next());
            let start: [f64; 6] = std::array::from_fn(|_| numbers.next());
            let v: [f64; 6] = std::array::from_fn(|_| numbers.next());
            let mut scene =
                scene((0..3).map(|p| particle((start[2 * p], start[2 * p + 1]), (0.0, 0.0), masses[p], 0.1)).collect());
            scene.edges.push(edge(1, 2, 0.05));
            let bodies = Bodies::new(&scene);
            let end: [f64; 6] = std::array::from_fn(|k| start[k] + 0.5 * v[k]);
            let input =
                ResponseInput { bodies: &bodies, law: &ResponseConstants::new(1.0, 0.5), q_start: &start, q_end: &end };
            let (mut q, mut after) = (end, v);
            response(&input, 0, [1, 2], vector(numbers.next_pair()), 0.5).apply(&mut q, &mut after);
            for axis in 0..2 {
                let momentum = |v: &[f64; 6]| (0..3).map(|p| masses[p] * v[2 * p + axis]).sum::<f64>();
                assert!((momentum(&v) - momentum(&after)).abs() < 1e-12);
            }
        }
    }
}
