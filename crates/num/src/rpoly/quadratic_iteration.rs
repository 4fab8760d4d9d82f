//! Runs the variable-shift iteration for a quadratic factor (root-finder.md 13).
use super::{
    Coefficients, Zero,
    constants::{ETA_2, ETA_7, ETA_9, UNIT_ERROR},
    quadratic,
    scalars::{Division, Scalars},
};

/// The number of unsuccessful steps after which the iteration fails.
const MAX_STEPS: usize = 20;
/// The number of steps of the additional fixed-shift loop for clusters.
const CLUSTER_STEPS: usize = 5;

/// Returns two zeros and the quotient, from the starting factor `z² + u z + v`. On failure the result is `None`, and
/// `k` is changed.
#[inline]
pub(super) fn run<const N: usize>(
    polynomial: &Coefficients,
    k: &mut Coefficients,
    mut u: f64,
    mut v: f64,
    all_steps: &mut u32,
) -> Option<([Zero; 2], Coefficients)> {
    let mut steps = 0;
    let mut tried_cluster = false;
    let mut relative_step = 0.0;
    let mut previous_size = 0.0;
    loop {
        *all_steps += 1;
        let zeros = quadratic::zeros(1.0, u, v);
        let [small, (large, _)] = zeros;
        // Real zeros of different moduli are left to the linear iteration.
        if (small.0.abs() - large.abs()).abs() > 0.01 * large.abs() {
            return None;
        }
        let mut division = Division::<N>::new(polynomial, u, v);
        let size = (division.a() - small.0 * division.b()).abs() + (small.1 * division.b()).abs();
        if size <= 20.0 * rounding_error(&division, small.0) {
            return Some((zeros, division.q));
        }
        steps += 1;
        if steps > MAX_STEPS {
            return None;
        }
        // Both comparisons are false for a NaN, which leads into the cluster step.
        let advances = relative_step > 0.01 || size < previous_size;
        if steps >= 2 && !advances && !tried_cluster {
            if relative_step < UNIT_ERROR {
                relative_step = UNIT_ERROR;
            }
            let nudge = relative_step.sqrt();
            u -= u * nudge;
            v += v * nudge;
            division = Division::new(polynomial, u, v);
            for _ in 0..CLUSTER_STEPS {
                *k = Scalars::new(k, &division).next_k(&division);
            }
            tried_cluster = true;
            steps = 0;
        }
        previous_size = size;
        *k = Scalars::new(k, &division).next_k(&division);
        let (new_u, new_v) = Scalars::new(k, &division).estimate(k, polynomial, &division);
        if new_v == 0.0 {
            return None;
        }
        relative_step = ((new_v - v) / new_v).abs();
        u = new_u;
        v = new_v;
    }
}

/// Returns a bound on the rounding error of P at the factor's zero with real part `x`.
#[inline(always)]
fn rounding_error<const N: usize>(division: &Division<N>, x: f64) -> f64 {
    let (a, b) = (division.a(), division.b());
    let modulus = division.v.abs().sqrt();
    let t = -x * b;
    let mut error = 2.0 * division.q[0].abs();
    for q in &division.q[1..N] {
        error = error * modulus + q.abs();
    }
    error = error * modulus + (a + t).abs();
    error *= ETA_9;
    (error - ETA_7 * ((a + t).abs() + b.abs() * modulus)) + ETA_2 * t.abs()
}
