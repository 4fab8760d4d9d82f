//! Prints numbers as C++ streams do by default (`%g` with six significant digits, `oracle-behavior.md`, head), and in
//! the shortest exact form.

use std::fmt::Write;

/// The number of significant digits of C++ streams.
const SIGNIFICANT_DIGITS: i32 = 6;

/// The length of the longest text, `-1.79769e+308`.
const MAX_LENGTH: usize = 13;

/// Returns the number in the format `%g` with six significant digits, as printed by glibc: `0`, `-0`, `1e-05`,
/// `0.00282843`, `1e+06`, `inf`, `-inf`, `nan` or, with the sign bit set, `-nan`. Rounds to nearest, exact ties to
/// even, as the library does.
pub fn format_g(value: f64) -> String {
    let sign = if value.is_sign_negative() { "-" } else { "" };
    if value.is_nan() {
        return format!("{sign}nan");
    }
    if value.is_infinite() {
        return format!("{sign}inf");
    }
    if value == 0.0 {
        return format!("{sign}0");
    }
    // The exponent after rounding decides between the two notations (999999.5 is 1e+06).
    let mut scientific = String::with_capacity(MAX_LENGTH);
    // Writing to a string does not fail.
    let _ = write!(scientific, "{:.5e}", value.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let (first, rest) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let mut text = String::with_capacity(MAX_LENGTH);
    text += sign;
    match exponent {
        -4..0 => {
            text += "0.";
            (exponent..-1).for_each(|_| text.push('0'));
            text += first;
            text += rest.trim_end_matches('0');
        }
        0..SIGNIFICANT_DIGITS => {
            let (integer, fraction) = rest.split_at(exponent.unsigned_abs() as usize);
            text += first;
            text += integer;
            push_fraction(&mut text, fraction);
        }
        _ => {
            text += first;
            push_fraction(&mut text, rest);
            let _ = write!(text, "e{exponent:+03}");
        }
    }
    text
}

/// Adds the decimal point and the digits after it, without zeros at the end.
fn push_fraction(text: &mut String, digits: &str) {
    let digits = digits.trim_end_matches('0');
    if !digits.is_empty() {
        text.push('.');
        *text += digits;
    }
}

/// Returns the shortest text that reads back as the same bits, with an exponent if it would be long otherwise:
/// `-0.1875`, `1e-12`, `nan`, `-nan`, `inf`.
pub fn format_exact(value: f64) -> String {
    let magnitude = value.abs();
    if value.is_finite() && (magnitude == 0.0 || (1e-5..1e9).contains(&magnitude)) {
        format!("{value}")
    } else if value.is_finite() {
        format!("{value:e}")
    } else {
        format_g(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_reads_back_as_the_same_bits() {
        for value in [0.1 + 0.2, -0.1875, 1e-12, 123_456_789.125, 1e22, -5e-324, 0.0, -0.0] {
            let text = format_exact(value);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
        }
        assert_eq!(format_exact(1e-12), "1e-12");
        assert_eq!(format_exact(-0.1875), "-0.1875");
        assert_eq!(format_exact(f64::NAN.copysign(-1.0)), "-nan");
    }

    #[test]
    fn general_prints_what_the_c_library_prints() {
        let cases = [
            (0.0, "0"),
            (-0.0, "-0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (100_000.0, "100000"),
            (999_999.0, "999999"),
            (999_999.5, "1e+06"),
            (1e6, "1e+06"),
            (1_234_567.0, "1.23457e+06"),
            (0.0001, "0.0001"),
            (0.000_099_999_99, "0.0001"),
            (0.000_099_999_9, "9.99999e-05"),
            (1e-5, "1e-05"),
            (0.002_828_427_124_746_19, "0.00282843"),
            (8.485_281_374_238_57e-11, "8.48528e-11"),
            (1.414_213_562e-3, "0.00141421"),
            (1e100, "1e+100"),
            (1.5e-300, "1.5e-300"),
            (5e-324, "4.94066e-324"),
            (f64::MAX, "1.79769e+308"),
            (123.456_789, "123.457"),
            (10.0, "10"),
            (120.0, "120"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN.copysign(1.0), "nan"),
            (f64::NAN.copysign(-1.0), "-nan"),
        ];
        for (value, text) in cases {
            assert_eq!(format_g(value), text, "{value:?}");
        }
    }

    #[test]
    fn general_rounds_exact_ties_to_even() {
        assert_eq!(format_g(1_000_005.0), "1e+06");
        assert_eq!(format_g(1_000_015.0), "1.00002e+06");
        assert_eq!(format_g(100_000.5), "100000");
        assert_eq!(format_g(100_001.5), "100002");
    }
}
