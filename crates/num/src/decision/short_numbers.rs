//! Short numbers, for which formulas are exact in every order of evaluation.
//!
//! A double is an integer times a power of two. The inputs of a formula may all be integer multiples of *one* power of
//! two. If these integers are short, every sum and product of the formula still fits into 53 bits, and nothing is
//! rounded.

/// Returns whether all values are integer multiples of one power of two with quotients whose absolute values are below
/// `2^bits`. Zeros fit everywhere; a value that is not finite fits nowhere. `bits` 0 admits zeros only.
pub fn are_short(values: &[f64], bits: u32) -> bool {
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for &value in values {
        if !value.is_finite() {
            return false;
        }
        if value != 0.0 {
            let (mantissa, exponent) = split_double(value);
            lowest = lowest.min(exponent + mantissa.trailing_zeros().cast_signed());
            highest = highest.max(exponent + mantissa.ilog2().cast_signed() + 1);
        }
    }
    // If all values are zero, there is no span. Otherwise the span is from the lowest set bit of any value to above the
    // highest.
    highest == i32::MIN || i64::from(highest) - i64::from(lowest) <= i64::from(bits)
}

/// Returns `|value|` as mantissa and power of two. The mantissa of zero is 0, and `value` must be finite.
pub(super) fn split_double(value: f64) -> (u64, i32) {
    let bits = value.to_bits();
    let exponent = i32::try_from((bits >> 52) & 0x7FF).unwrap_or(0);
    let fraction = bits & ((1 << 52) - 1);
    if exponent == 0 { (fraction, -1074) } else { (fraction | (1 << 52), exponent - 1075) }
}

#[cfg(test)]
mod tests {
    use super::{are_short, split_double};

    #[test]
    fn short_values_share_a_power_of_two() {
        assert!(are_short(&[], 0));
        assert!(are_short(&[0.0, -0.0], 0));
        assert!(are_short(&[0.5, -3.0, 0.0, 7.25], 5));
        assert!(!are_short(&[0.5, -3.0, 0.0, 7.25], 4));
        // Each product alone is short, but not both together.
        assert!(!are_short(&[1e9, 0.0625], 30));
        assert!(are_short(&[f64::MAX, f64::MIN], 53));
        assert!(!are_short(&[f64::MAX, 5e-324], 2000));
        assert!(are_short(&[f64::MAX, 5e-324], 2098));
    }

    #[test]
    fn decimals_are_long_and_what_is_not_finite_is_never_short() {
        assert!(!are_short(&[0.1], 50));
        assert!(are_short(&[0.1], 53));
        assert!(are_short(&[5e-324], 1));
        assert!(!are_short(&[f64::NAN], 2000) && !are_short(&[f64::INFINITY], 2000));
    }

    #[test]
    fn mantissas_and_exponents_make_the_value() {
        for value in [1.0, 0.1, 3.5e300, 2.0_f64 * f64::MIN_POSITIVE, 12.0] {
            let (mantissa, exponent) = split_double(value);
            let scale = f64::from_bits(u64::try_from(exponent + 1023).unwrap_or(0) << 52);
            if exponent > -1022 {
                assert_eq!(mantissa as f64 * scale, value);
            }
        }
        assert_eq!(split_double(5e-324), (1, -1074));
        assert_eq!(split_double(-0.0).0, 0);
    }
}
