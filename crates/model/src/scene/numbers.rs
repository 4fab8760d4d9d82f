//! Numbers for the strict reader: the whole text must be a number.
//!
//! If the original reads the longest prefix and ignores the rest (scene-format.md 2), messages name what the original
//! would have read. White space around a number is allowed.

/// The reason why a text is not a valid number.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum NumberError {
    /// The text is empty.
    Empty,
    /// The text does not start with digits.
    NoNumber,
    /// Other characters follow the number. The value is the number that the original would read.
    Trailing(String),
    /// The number has a decimal comma. The value is the text with a point instead.
    Comma(String),
    /// The text is `inf` or `nan`.
    NotFinite,
    /// The number is too large for a 64-bit float.
    Overflow,
    /// The number has a point or an exponent where a whole number is required.
    NotWhole,
    /// The whole number is outside the 32-bit range.
    TooLarge,
}

/// Returns a finite 64-bit float, and whether a nonzero number became zero.
pub(super) fn parse_scalar(text: &str) -> Result<(f64, bool), NumberError> {
    let text = text.trim_ascii();
    let length = number_length(text);
    if length < text.len() || text.is_empty() {
        return Err(classify_error(text, length));
    }
    let value: f64 = text.parse().map_err(|_| NumberError::NoNumber)?;
    if value.is_infinite() {
        return Err(NumberError::Overflow);
    }
    let mantissa = text.split(['e', 'E']).next().unwrap_or_default();
    let vanished = value == 0.0 && mantissa.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    Ok((value, vanished))
}

/// Returns a whole 32-bit number.
pub(super) fn parse_integer(text: &str) -> Result<i32, NumberError> {
    let text = text.trim_ascii();
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return text.parse().map_err(|_| NumberError::TooLarge);
    }
    Err(match parse_scalar(text) {
        Ok(_) => NumberError::NotWhole,
        Err(flaw) => flaw,
    })
}

fn classify_error(text: &str, length: usize) -> NumberError {
    let bare = text.strip_prefix(['+', '-']).unwrap_or(text).to_ascii_lowercase();
    if text.is_empty() {
        NumberError::Empty
    } else if bare.starts_with("inf") || bare.starts_with("nan") {
        NumberError::NotFinite
    } else if length == 0 {
        NumberError::NoNumber
    } else {
        let with_point = text.replacen(',', ".", 1);
        if text[length..].starts_with(',') && number_length(&with_point) == text.len() {
            NumberError::Comma(with_point)
        } else {
            NumberError::Trailing(text[..length].to_owned())
        }
    }
}

/// Returns the number of leading bytes that have the form of a number, or 0 if there are no digits.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let Some(end) = mantissa_end(bytes) else { return 0 };
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = count_digits(bytes, end + 1 + sign);
        if exponent > 0 {
            return end + 1 + sign + exponent;
        }
    }
    end
}

/// Returns the offset at which a number's sign, digits and fraction end, or `None` if there are no digits.
pub(super) fn mantissa_end(text: &[u8]) -> Option<usize> {
    let sign = usize::from(matches!(text.first(), Some(b'+' | b'-')));
    let integer_digits = count_digits(text, sign);
    let point = sign + integer_digits;
    let fraction = if text.get(point) == Some(&b'.') { 1 + count_digits(text, point + 1) } else { 0 };
    (integer_digits > 0 || fraction > 1).then_some(point + fraction)
}

/// Returns the number of digits at `from`.
pub(super) fn count_digits(text: &[u8], from: usize) -> usize {
    text.get(from..).unwrap_or_default().iter().take_while(|byte| byte.is_ascii_digit()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_texts_are_read() {
        for (text, value) in [(" 1.5\t", 1.5), ("-.5e1", -5.0), ("+3.", 3.0), ("0e999999999999", 0.0)] {
            assert_eq!(parse_scalar(text), Ok((value, false)), "{text}");
        }
        assert_eq!(parse_scalar("1e-400"), Ok((0.0, true)));
        assert_eq!(parse_integer(" +07 "), Ok(7));
        assert_eq!(parse_integer("-2147483648"), Ok(i32::MIN));
    }

    #[test]
    fn every_flaw_has_its_name() {
        for (text, flaw) in [
            ("", NumberError::Empty),
            (" \n", NumberError::Empty),
            ("x", NumberError::NoNumber),
            ("-", NumberError::NoNumber),
            (".", NumberError::NoNumber),
            ("1.5 m", NumberError::Trailing("1.5".into())),
            ("1e", NumberError::Trailing("1".into())),
            ("0x10", NumberError::Trailing("0".into())),
            ("1,5", NumberError::Comma("1.5".into())),
            ("1,5,2", NumberError::Trailing("1".into())),
            ("-Infinity", NumberError::NotFinite),
            ("NaN", NumberError::NotFinite),
            ("-1e400", NumberError::Overflow),
            ("é", NumberError::NoNumber),
        ] {
            assert_eq!(parse_scalar(text), Err(flaw), "{text}");
        }
        assert_eq!(parse_integer("1.0"), Err(NumberError::NotWhole));
        assert_eq!(parse_integer("2147483648"), Err(NumberError::TooLarge));
        assert_eq!(parse_integer("99999999999999999999"), Err(NumberError::TooLarge));
        assert_eq!(parse_integer("3x"), Err(NumberError::Trailing("3".into())));
    }
}
