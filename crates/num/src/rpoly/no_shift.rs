//! Runs the no-shift stage, whose five steps make the small zeros stand out (root-finder.md 10).
use super::{Coefficients, constants::UNIT_ERROR};

/// The number of steps of this stage.
const STEP_COUNT: usize = 5;

/// Returns the K polynomial (degree `N - 1`) after five steps without shift, started from the derivative divided by
/// `N`.
#[inline]
pub(super) fn run<const N: usize>(polynomial: &Coefficients) -> Coefficients {
    let mut k = derivative::<N>(polynomial);
    let mut vanishes = k[N - 1] == 0.0;
    for _ in 0..STEP_COUNT {
        if vanishes {
            k.copy_within(0..N - 1, 1);
            k[0] = 0.0;
            vanishes = k[N - 1] == 0.0;
        } else {
            let t = -polynomial[N] / k[N - 1];
            for j in (1..N).rev() {
                k[j] = t * k[j - 1] + polynomial[j];
            }
            k[0] = polynomial[0];
            vanishes = k[N - 1].abs() <= (polynomial[N - 1].abs() * UNIT_ERROR) * 10.0;
        }
    }
    k
}

#[inline]
#[expect(clippy::cast_precision_loss, reason = "N is at most six")]
fn derivative<const N: usize>(polynomial: &Coefficients) -> Coefficients {
    let mut k = Coefficients::default();
    k[0] = polynomial[0];
    for i in 1..N {
        // There are two roundings, first of the product and then of the quotient.
        k[i] = ((N - i) as f64 * polynomial[i]) / N as f64;
    }
    k
}
