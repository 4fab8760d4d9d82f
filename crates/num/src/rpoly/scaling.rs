//! Scales polynomials by a power of two (root-finder.md 8).
use super::{
    Coefficients,
    constants::{LARGEST_NUMBER, SCALING_TARGET},
};
use crate::elementary::ln;

/// Multiplies the coefficients by a power of two for which the smallest is near 5.4e-23, unless they are already
/// moderate or would become too large. NaN coefficients are ignored in the decision.
#[inline]
pub(super) fn scale<const N: usize>(polynomial: &mut Coefficients) {
    let (mut largest, mut smallest) = (0.0, LARGEST_NUMBER);
    for coefficient in &polynomial[..=N] {
        let modulus = coefficient.abs();
        if modulus > largest {
            largest = modulus;
        }
        if modulus != 0.0 && modulus < smallest {
            smallest = modulus;
        }
    }
    let factor = SCALING_TARGET / smallest;
    if (factor > 1.0 && LARGEST_NUMBER / factor < largest) || (factor <= 1.0 && largest < 10.0) {
        return;
    }
    // The exponent is truncated toward zero, even if it is negative. It is between -201 and 1000, so the power is a
    // normal number.
    #[expect(clippy::cast_possible_truncation, reason = "truncation is what the original does")]
    let exponent = (ln(factor) / std::f64::consts::LN_2 + 0.5) as i64;
    if exponent != 0 {
        #[expect(clippy::cast_sign_loss, reason = "positive after adding the bias")]
        let power = f64::from_bits(((exponent + 1023) as u64) << 52);
        for coefficient in &mut polynomial[..=N] {
            *coefficient *= power;
        }
    }
}
