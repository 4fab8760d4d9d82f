//! Runs the variable-shift iteration for a real zero (root-finder.md 14).
use super::{
    Coefficients,
    constants::{ETA_2, UNIT_ERROR},
};

/// The number of unsuccessful steps after which the iteration fails.
const MAX_STEPS: usize = 10;

/// The result of a linear iteration.
pub(super) enum Outcome {
    /// A zero was found. The values are the zero and the quotient.
    Zero(f64, Coefficients),
    /// The iteration stalls near this point, so two zeros may be close together.
    Cluster(f64),
    /// The iteration did not converge.
    Failed,
}

/// Iterates from `s`. Unless a zero is found, `k` is changed.
#[inline]
pub(super) fn run<const N: usize>(
    polynomial: &Coefficients,
    k: &mut Coefficients,
    mut s: f64,
    all_steps: &mut u32,
) -> Outcome {
    let mut steps = 0;
    let mut t = 0.0_f64;
    let mut previous_size = 0.0;
    loop {
        *all_steps += 1;
        let q = horner::<N>(polynomial, s);
        let value = q[N];
        let size = value.abs();
        let mut error = 0.5 * q[0].abs();
        for q in &q[1..=N] {
            error = error * s.abs() + q.abs();
        }
        if size <= 20.0 * (ETA_2 * error - UNIT_ERROR * size) {
            return Outcome::Zero(s, q);
        }
        steps += 1;
        if steps > MAX_STEPS {
            return Outcome::Failed;
        }
        // Both comparisons are false for a NaN, so the iteration counts as stalled.
        let advances = t.abs() > 0.001 * (s - t).abs() || size < previous_size;
        if steps >= 2 && !advances {
            return Outcome::Cluster(s);
        }
        previous_size = size;
        *k = next_k::<N>(k, &q, s, value);
        let mut value_at_s = k[0];
        for &kappa in &k[1..N] {
            value_at_s = value_at_s * s + kappa;
        }
        t = if value_at_s.abs() > ((k[N - 1] * 10.0) * UNIT_ERROR).abs() { -value / value_at_s } else { 0.0 };
        s += t;
    }
}

/// Runs Horner's scheme. Returns the quotient by `z - s`, with the value at `s` in entry `N`.
#[inline(always)]
fn horner<const N: usize>(polynomial: &Coefficients, s: f64) -> Coefficients {
    let mut q = Coefficients::default();
    q[0] = polynomial[0];
    for i in 1..=N {
        q[i] = q[i - 1] * s + polynomial[i];
    }
    q
}

/// Returns the next K polynomial with the shift `s`.
#[inline(always)]
fn next_k<const N: usize>(k: &Coefficients, q: &Coefficients, s: f64, value: f64) -> Coefficients {
    let mut w = Coefficients::default();
    w[0] = k[0];
    for i in 1..N {
        w[i] = w[i - 1] * s + k[i];
    }
    let mut next = Coefficients::default();
    if w[N - 1].abs() <= (k[N - 1].abs() * 10.0) * UNIT_ERROR {
        next[1..N].copy_from_slice(&w[..N - 1]);
    } else {
        let ratio = -value / w[N - 1];
        next[0] = q[0];
        for i in 1..N {
            next[i] = ratio * w[i - 1] + q[i];
        }
    }
    next
}
