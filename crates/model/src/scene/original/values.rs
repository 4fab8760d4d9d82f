//! Reads numbers like a C++ stream: the longest prefix counts, the rest is ignored (scene-format.md 2).
use crate::scene::numbers::{count_digits, mantissa_end};

/// Parses a 64-bit float, correctly rounded. Returns `None` if the text or its exponent has no digits, and on overflow.
/// Underflow gives zero.
pub(super) fn parse_scalar(text: &[u8]) -> Option<f64> {
    let text = trim_start(text);
    let mut end = mantissa_end(text)?;
    if matches!(text.get(end), Some(b'e' | b'E')) {
        end += 1;
        end += usize::from(matches!(text.get(end), Some(b'+' | b'-')));
        let exponent = count_digits(text, end);
        if exponent == 0 {
            return None;
        }
        end += exponent;
    }
    // The prefix has the form that the standard library reads with correct rounding.
    let value: f64 = std::str::from_utf8(&text[..end]).ok()?.parse().ok()?;
    value.is_finite().then_some(value)
}

/// Parses a 32-bit integer. Returns `None` if the text does not start with one.
pub(super) fn parse_integer(text: &[u8]) -> Option<i32> {
    i32::try_from(parse_long(text)?).ok()
}

/// Parses a boolean. Returns `None` if the text does not start with an integer that is 0 or 1.
pub(super) fn parse_boolean(text: &[u8]) -> Option<bool> {
    match parse_long(text)? {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    }
}

/// Converts a scalar to a 32-bit integer by rounding toward zero. A value that does not fit gives the smallest integer.
pub(super) fn truncate(value: f64) -> i32 {
    let truncated = value.trunc();
    if truncated >= f64::from(i32::MIN) && truncated <= f64::from(i32::MAX) {
        #[expect(clippy::cast_possible_truncation, reason = "whole and in range")]
        let integer = truncated as i32;
        integer
    } else {
        i32::MIN
    }
}

fn parse_long(text: &[u8]) -> Option<i64> {
    let text = trim_start(text);
    let sign = usize::from(matches!(text.first(), Some(b'+' | b'-')));
    let end = sign + count_digits(text, sign);
    std::str::from_utf8(&text[..end]).ok()?.parse().ok()
}

/// Removes the white space of the C locale at the start.
fn trim_start(text: &[u8]) -> &[u8] {
    let start = text.iter().position(|byte| !matches!(byte, b' ' | b'\t'..=b'\r')).unwrap_or(text.len());
    &text[start..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_prefix_of_a_scalar_counts() {
        for (text, value) in [
            ("0.05xyz", 0.05),
            ("0.05 7", 0.05),
            ("1d5", 1.0),
            ("0x10", 0.0),
            ("0,05", 0.0),
            (" \t\r\u{b}\u{c}\n+.5", 0.5),
            ("5.", 5.0),
            ("5.e1", 50.0),
            ("1e5e5", 1e5),
            ("1e5.5", 1e5),
            ("1.2.3", 1.2),
            ("1e-400", 0.0),
            ("1e-99999999999999999999", 0.0),
            ("179769313486231570000000000000000000000000e267", f64::MAX),
            ("0.1000000000000000055511151231257827021181583404541015625", 0.1),
        ] {
            assert_eq!(parse_scalar(text.as_bytes()), Some(value), "{text}");
        }
        assert_eq!(parse_scalar(b"-0").map(f64::to_bits), Some((-0.0_f64).to_bits()));
    }

    #[test]
    fn values_that_are_not_scalars_fail() {
        for text in ["", " ", "x", "+", "-", ".", ".e5", "+-1", "inf", "nan", "1e", "1e+", "1ex", "1e400", "-1e400"] {
            assert_eq!(parse_scalar(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn integers_and_truth_values() {
        assert_eq!(parse_integer(b" 0.7"), Some(0));
        assert_eq!(parse_integer(b"-2147483648"), Some(i32::MIN));
        assert_eq!(parse_integer(b"+12abc"), Some(12));
        assert_eq!(parse_integer(b"0x10"), Some(0));
        for text in ["", "x", "-", "2147483648", "99999999999999999999999"] {
            assert_eq!(parse_integer(text.as_bytes()), None, "{text}");
        }
        assert_eq!(parse_boolean(b"01"), Some(true));
        assert_eq!(parse_boolean(b"1.5"), Some(true));
        assert_eq!(parse_boolean(b"-0"), Some(false));
        for text in ["2", "-1", "true", ""] {
            assert_eq!(parse_boolean(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn a_scalar_is_truncated_toward_zero() {
        assert_eq!(truncate(-1.9), -1);
        assert_eq!(truncate(2_147_483_647.9), i32::MAX);
        assert_eq!(truncate(2_147_483_648.0), i32::MIN);
        assert_eq!(truncate(-1e300), i32::MIN);
    }
}
