//! Formats numbers for labels, with few digits.

/// Formats a number with at most six significant digits, without trailing zeros: `0.14`, `-1.5`, `1e-9`, `2.5e12`,
/// `nan`.
pub fn format_short(value: f64) -> String {
    if !value.is_finite() {
        return if value.is_nan() { "nan".to_owned() } else { format!("{value}") };
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{value:.5e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    if (-4..7).contains(&power) {
        #[expect(clippy::cast_sign_loss, reason = "not negative")]
        let decimals = (5 - power).max(0) as usize;
        return trim_zeros(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{power}", trim_zeros(mantissa))
}

/// Removes trailing zeros after the point.
fn trim_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// Formats a coordinate in pixels, with at most two decimals, never `-0`.
pub fn format_pixel(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = trim_zeros(&text);
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Returns the decades from the one at or below `least` to the one at or above `greatest`, as powers of ten.
pub fn decade_range(lowest: f64, highest: f64) -> (i32, i32) {
    #[expect(clippy::cast_possible_truncation, reason = "a logarithm of a finite double is below 400")]
    let power = |value: f64, round: fn(f64) -> f64| round(value.log10()).clamp(-400.0, 400.0) as i32;
    let low = power(lowest, f64::floor);
    (low, power(highest, f64::ceil).max(low + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (0.14, "0.14"),
            (0.1 + 0.2, "0.3"),
            (-1.5, "-1.5"),
            (1e-9, "1e-9"),
            (2.5e12, "2.5e12"),
            (123_456.789, "123457"),
            (999_999.9, "1000000"),
            (1.0 / 3.0, "0.333333"),
            (0.000_1, "0.0001"),
            (f64::NAN, "nan"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(format_short(value), text);
        }
        assert_eq!(
            (format_pixel(-0.001), format_pixel(12.345), format_pixel(3.0)),
            ("0".into(), "12.35".into(), "3".into())
        );
    }

    #[test]
    fn decades_enclose() {
        assert_eq!(decade_range(3e-12, 2e-3), (-12, -2));
        assert_eq!(decade_range(1e-3, 1e-3), (-3, -2));
    }
}
