//! A lower bound on the moduli of the zeros (root-finder.md 9). It is the positive zero, to half a percent, of the
//! polynomial whose coefficients are the moduli of the coefficients, with the last one negated.
use super::{Coefficients, DoesNotTerminate};
use crate::elementary::{exp, ln};

/// The number of Newton steps after which the iteration is known to cycle; every other iteration takes fewer than 500.
const MAX_NEWTON_STEPS: usize = 1000;

/// Returns the bound for a polynomial of degree `N`, or 0 if its constant term is 0. Its steps are added to `steps`.
///
/// # Errors
/// Fails with [`DoesNotTerminate`] if a coefficient is not finite, or if the Newton iteration cycles among subnormal
/// numbers.
#[inline]
pub(super) fn lower_bound<const N: usize>(polynomial: &Coefficients, steps: &mut u32) -> Result<f64, DoesNotTerminate> {
    if !polynomial[..=N].iter().all(|coefficient| coefficient.is_finite()) {
        return Err(DoesNotTerminate);
    }
    let mut moduli = Coefficients::default();
    for i in 0..=N {
        moduli[i] = polynomial[i].abs();
    }
    moduli[N] = -moduli[N];
    let x = decimate::<N>(&moduli, start::<N>(&moduli), steps);
    newton::<N>(&moduli, x, steps)
}

/// Returns the starting point: the geometric mean of the zeros' moduli, or the Newton step from the origin if that is
/// nearer.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "N is at most six")]
fn start<const N: usize>(moduli: &Coefficients) -> f64 {
    let constant = moduli[N].abs();
    let mean = exp((ln(constant) - ln(moduli[0])) / N as f64);
    if moduli[N - 1] != 0.0 {
        let newton = constant / moduli[N - 1];
        if newton < mean {
            return newton;
        }
    }
    mean
}

/// Divides `x` by ten while the polynomial stays positive, and returns the last `x`. With finite coefficients this ends
/// after about 600 rounds at the latest, at zero.
#[inline]
fn decimate<const N: usize>(moduli: &Coefficients, mut x: f64, steps: &mut u32) -> f64 {
    loop {
        *steps += 1;
        let tenth = x * 0.1;
        let mut value = moduli[0];
        for &modulus in &moduli[1..=N] {
            value = value * tenth + modulus;
        }
        if value <= 0.0 {
            return x;
        }
        x = tenth;
    }
}

/// Returns the result of Newton's iteration, which ends when a step changes `x` by less than half a percent. With `x =
/// 0` the ratio is NaN and there is no step.
#[inline]
fn newton<const N: usize>(moduli: &Coefficients, mut x: f64, all_steps: &mut u32) -> Result<f64, DoesNotTerminate> {
    let mut step = x;
    let mut steps = 0;
    while (step / x).abs() > 0.005 {
        if steps == MAX_NEWTON_STEPS {
            return Err(DoesNotTerminate);
        }
        steps += 1;
        *all_steps += 1;
        let mut value = moduli[0];
        let mut slope = value;
        for &modulus in &moduli[1..N] {
            value = value * x + modulus;
            slope = slope * x + value;
        }
        value = value * x + moduli[N];
        step = value / slope;
        x -= step;
    }
    Ok(x)
}
