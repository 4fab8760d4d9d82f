//! The elementary functions of the numeric core, in one place.
//!
//! They are those of the system's C library, by way of the standard library's methods: the same ones that a
//! submission calls on the same machine, and the ones the original was recorded with (root-finder.md 0.5,
//! collisions.md 5). None is always correctly rounded, so another implementation changes the last bit of a few
//! results in a thousand. No other place of the crate calls them; `clippy.toml` sees to that.

/// `e^x` of the system's C library.
#[inline]
#[must_use]
#[expect(clippy::disallowed_methods, reason = "this module is the one place that may call it")]
pub fn exp(x: f64) -> f64 {
    x.exp()
}

/// The natural logarithm of the system's C library; `-inf` at zero, NaN below.
#[inline]
#[must_use]
#[expect(clippy::disallowed_methods, reason = "this module is the one place that may call it")]
pub fn ln(x: f64) -> f64 {
    x.ln()
}

/// The sine of an angle in radians, of the system's C library.
#[inline]
#[must_use]
#[expect(clippy::disallowed_methods, reason = "this module is the one place that may call it")]
pub fn sin(angle: f64) -> f64 {
    angle.sin()
}

/// The cosine of an angle in radians, of the system's C library.
#[inline]
#[must_use]
#[expect(clippy::disallowed_methods, reason = "this module is the one place that may call it")]
pub fn cos(angle: f64) -> f64 {
    angle.cos()
}

#[cfg(test)]
mod tests {
    use super::{cos, exp, ln, sin};

    #[test]
    fn exact_arguments_have_exact_values() {
        assert_eq!(exp(0.0).to_bits(), 1.0_f64.to_bits());
        assert_eq!(exp(f64::NEG_INFINITY).to_bits(), 0.0_f64.to_bits());
        assert_eq!(ln(1.0).to_bits(), 0.0_f64.to_bits());
        assert_eq!(ln(0.0), f64::NEG_INFINITY);
        assert_eq!(sin(0.0).to_bits(), 0.0_f64.to_bits());
        assert_eq!(cos(0.0).to_bits(), 1.0_f64.to_bits());
    }

    #[test]
    fn the_rotation_by_94_degrees_has_the_bits_of_the_specification() {
        let angle = 94.0 * 0.017_453_293;
        assert_eq!(cos(angle).to_bits(), 0xBFB1_DB90_2EC1_47E0);
        assert_eq!(sin(angle).to_bits(), 0x3FEF_EC0B_6FC0_5F20);
    }
}
