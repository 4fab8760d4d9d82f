//! Two particles: detection and responses (collisions.md 2, 3, 6).
use super::response::{Change, Response, ResponseInput};
use crate::sim::bodies::Bodies;
use fosssim_num::{
    lanes::{Number, Plane},
    vector::{Vec2, length, unit, vector_at},
};
use std::ops::Mul;

/// Returns the coefficients of the two polynomials of discs that start at `x1` and `x2` and move by `d1` and `d2` in
/// the step: "closer than `radii`" and "approaching". Highest power first, for one pair or several. Time is a fraction
/// of the step.
#[inline(always)]
pub fn coefficients<N: Number>(x1: Plane<N>, d1: Plane<N>, x2: Plane<N>, d2: Plane<N>, radii: N) -> ([N; 3], [N; 2])
where
    f64: Mul<N, Output = N>,
{
    let d = d2 - d1;
    let x = x2 - x1;
    let e = d1 - d2;
    // `e` is `-d`, so `dot(e, e)` is identical to `dot(d, d)`; the sign of a zero `dot(e, x)` may differ.
    let squared = d.dot(d);
    ([-squared, -2.0 * x.dot(d), radii * radii - x.dot(x)], [-squared, e.dot(x)])
}

/// Returns the contact normal at time `t`, from the first to the second center.
#[inline]
pub(super) fn normal(x1: Vec2, d1: Vec2, x2: Vec2, d2: Vec2, t: f64) -> Vec2 {
    (x2 + t * d2) - (x1 + t * d1)
}

/// Returns the response along normal `n`, from the mean velocities of the step.
pub(super) fn response(input: &ResponseInput<'_>, i: usize, j: usize, n: Vec2) -> Response {
    let ResponseInput { bodies, law, q_start, q_end } = *input;
    let v1 = law.mean_velocity(q_start, q_end, i);
    let v2 = law.mean_velocity(q_start, q_end, j);
    exchange(bodies, law.factor, law.time_step, i, j, v2 - v1, unit(n))
}

/// Returns the vector between the centers, if the discs overlap and approach each other (simple detection).
#[inline]
pub(super) fn overlap(bodies: &Bodies, x: &[f64], v: &[f64], i: usize, j: usize) -> Option<Vec2> {
    let n = vector_at(x, j) - vector_at(x, i);
    (length(n) < bodies.radii[i] + bodies.radii[j] && (vector_at(v, i) - vector_at(v, j)).dot(&n) > 0.0).then_some(n)
}

/// Returns the simple response along normal `n`, from the velocities `v`. Positions do not change.
pub(super) fn simple_response(bodies: &Bodies, factor: f64, v: &[f64], i: usize, j: usize, n: Vec2) -> Response {
    exchange(bodies, factor, 0.0, i, j, vector_at(v, j) - vector_at(v, i), unit(n))
}

/// Returns the exchange of momentum along the unit vector `u` for relative velocity `relative` (second minus first).
fn exchange(bodies: &Bodies, factor: f64, dt: f64, i: usize, j: usize, relative: Vec2, u: Vec2) -> Response {
    let (m1, m2) = (bodies.response_masses[i], bodies.response_masses[j]);
    let numerator = (2.0 * factor) * relative.dot(&u);
    let change = |particle: usize, denominator: f64| {
        (!bodies.fixed[particle]).then(|| Change {
            particle,
            velocity: (numerator / denominator) * u,
            position: ((dt * numerator) / denominator) * u,
        })
    };
    Response { gain: change(i, 1.0 + m1 / m2), loss: [change(j, m2 / m1 + 1.0), None] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{
        collision::response::ResponseConstants,
        samples::{NumberSource, fixed_copy, particle, scene},
    };

    #[test]
    fn equal_masses_swap_their_velocities() {
        let q_start = [0.0, 0.0, 1.0, 0.0];
        let q_end = [0.5, 0.0, 0.5, 0.0];
        let scene =
            scene(vec![particle((0.0, 0.0), (1.0, 0.0), 2.0, 0.1), particle((1.0, 0.0), (-1.0, 0.0), 2.0, 0.1)]);
        let bodies = Bodies::new(&scene);
        let input =
            ResponseInput { bodies: &bodies, law: &ResponseConstants::new(1.0, 0.5), q_start: &q_start, q_end: &q_end };
        let (mut q, mut v) = (q_end, [1.0, 0.0, -1.0, 0.0]);
        response(&input, 0, 1, Vec2::new(0.2, 0.0)).apply(&mut q, &mut v);
        assert_eq!(v, [-1.0, 0.0, 1.0, 0.0]);
        assert_eq!(q, [-0.5, 0.0, 1.5, 0.0]);
    }

    #[test]
    fn a_fixed_particle_stays_and_the_other_bounces() {
        let q_start = [0.0, 0.0, 1.0, 0.0];
        let q_end = [0.5, 0.0, 1.0, 0.0];
        let scene = scene(vec![
            particle((0.0, 0.0), (1.0, 0.0), 2.0, 0.1),
            fixed_copy(particle((1.0, 0.0), (0.0, 0.0), 1.0, 0.1)),
        ]);
        let bodies = Bodies::new(&scene);
        let input =
            ResponseInput { bodies: &bodies, law: &ResponseConstants::new(0.0, 0.5), q_start: &q_start, q_end: &q_end };
        let (mut q, mut v) = (q_end, [1.0, 0.0, 0.0, 0.0]);
        response(&input, 0, 1, Vec2::new(0.2, 0.0)).apply(&mut q, &mut v);
        assert_eq!((v, q), ([0.0; 4], [0.0, 0.0, 1.0, 0.0]));
    }

    /// Momentum is conserved, and with restitution 1 so is the kinetic energy.
    #[test]
    fn impacts_conserve_momentum_and_energy() {
        let mut numbers = NumberSource(7);
        for _ in 0..1000 {
            let masses = [1.5 + numbers.next(), 1.5 + numbers.next()];
            let (v1, v2, n) = (numbers.next_pair(), numbers.next_pair(), numbers.next_pair());
            let scene = scene(vec![particle((0.0, 0.0), v1, masses[0], 0.1), particle((1.0, 0.0), v2, masses[1], 0.1)]);
            let bodies = Bodies::new(&scene);
            let q_start = [0.0, 0.0, 1.0, 0.0];
            let v = [v1.0, v1.1, v2.0, v2.1];
            let q_end: [f64; 4] = std::array::from_fn(|k| q_start[k] + 0.5 * v[k]);
            let input = ResponseInput {
                bodies: &bodies,
                law: &ResponseConstants::new(1.0, 0.5),
                q_start: &q_start,
                q_end: &q_end,
            };
            let (mut q, mut after) = (q_end, v);
            response(&input, 0, 1, Vec2::new(n.0, n.1)).apply(&mut q, &mut after);
            let momentum = |v: &[f64; 4], axis: usize| masses[0] * v[axis] + masses[1] * v[axis + 2];
            let energy =
                |v: &[f64; 4]| masses[0] * (v[0] * v[0] + v[1] * v[1]) + masses[1] * (v[2] * v[2] + v[3] * v[3]);
            for axis in 0..2 {
                assert!((momentum(&v, axis) - momentum(&after, axis)).abs() < 1e-13);
            }
            assert!((energy(&v) - energy(&after)).abs() < 1e-12);
        }
    }

    #[test]
    fn overlap_needs_approach() {
        let scene =
            scene(vec![particle((0.0, 0.0), (0.0, 0.0), 1.0, 0.5), particle((0.75, 0.0), (0.0, 0.0), 1.0, 0.5)]);
        let bodies = Bodies::new(&scene);
        let x = [0.0, 0.0, 0.75, 0.0];
        assert_eq!(overlap(&bodies, &x, &[1.0, 0.0, 0.0, 0.0], 0, 1), Some(Vec2::new(0.75, 0.0)));
        assert_eq!(overlap(&bodies, &x, &[-1.0, 0.0, 0.0, 0.0], 0, 1), None);
        assert_eq!(overlap(&bodies, &[0.0, 0.0, 1.0, 0.0], &[1.0, 0.0, 0.0, 0.0], 0, 1), None);
    }
}
