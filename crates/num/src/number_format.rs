//! Prints numbers as C++ streams do by default (`%g` with six significant digits, `oracle-behavior.md`, head), and in
//! the shortest exact form.

/// The number of significant digits of C++ streams.
const SIGNIFICANT_DIGITS: i32 = 6;

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
    let scientific = format!("{:.5e}", value.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let digits = digits.trim_end_matches('0');
    if (-4..SIGNIFICANT_DIGITS).contains(&exponent) {
        format!("{sign}{}", format_positional(digits, exponent))
    } else {
        let (first, rest) = digits.split_at(1);
        let point = if rest.is_empty() { "" } else { "." };
        let exponent_sign = if exponent < 0 { '-' } else { '+' };
        format!("{sign}{first}{point}{rest}e{exponent_sign}{:02}", exponent.unsigned_abs())
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

/// Returns the digits `d.ddd` times ten to the power of `exponent`, written without an exponent.
fn format_positional(digits: &str, exponent: i32) -> String {
    if exponent < 0 {
        let zeros = "0".repeat(exponent.unsigned_abs() as usize - 1);
        return format!("0.{zeros}{digits}");
    }
    let integer_digits = exponent.unsigned_abs() as usize + 1;
    if digits.len() <= integer_digits {
        format!("{digits:0<integer_digits$}")
    } else {
        format!("{}.{}", &digits[..integer_digits], &digits[integer_digits..])
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
