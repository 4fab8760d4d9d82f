//! Formats numbers. What the original prints has the form of C's `%g`; other reports use the shortest text that is
//! exact.
//!
//! The functions are pure.

pub use fosssim_num::number_format::format_g;

/// Formats a number as the shortest text that reads back as the same number. A zero has no sign.
pub fn format_exact(value: f64) -> String {
    fosssim_num::number_format::format_exact(value + 0.0)
}

/// Formats a number as a short fraction such as `1/3`. Returns `None` if it differs from the fraction by more than a
/// few roundings, or has few digits anyway.
fn format_fraction(value: f64) -> Option<String> {
    let is_near = |denominator: &f64| {
        let (scaled, rounded) = (value * denominator, (value * denominator).round());
        (1.0..1000.0).contains(&rounded.abs()) && (scaled - rounded).abs() <= 4.0 * f64::EPSILON * rounded.abs()
    };
    let denominator = (2_u32..60).map(f64::from).find(is_near).filter(|_| value.to_string().len() > 9)?;
    Some(format!("{}/{denominator}", (value * denominator).round()))
}

/// The bound below which a number counts as zero if it is shown with numbers near 1.
const ZERO_BOUND: f64 = 1e-13;

/// Formats a number as in a calculation by hand: with few decimals, as a short fraction, or with six digits.
pub(crate) fn format_short(value: f64) -> String {
    format_rounded_or(if value.abs() < ZERO_BOUND { 0.0 } else { value }, format_g)
}

/// Formats a number with few decimals or as a short fraction, if it differs from that by at most a few roundings.
/// Otherwise returns the result of `fallback`.
pub(crate) fn format_rounded_or(value: f64, fallback: fn(f64) -> String) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    let is_near = value.abs() < 1e9 && (rounded - value).abs() <= ZERO_BOUND * value.abs();
    if is_near { format_exact(rounded) } else { format_fraction(value).unwrap_or_else(|| fallback(value)) }
}

/// Formats a count with separated thousands, such as `1 234 567`. Four digits are not separated.
pub fn group_digits(value: u64) -> String {
    let digits = value.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut grouped = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// Formats a count and its noun, such as `1 step` or `12 345 steps`.
pub fn format_count(value: u64, noun: &str) -> String {
    let plural = if value == 1 { "" } else { "s" };
    format!("{} {noun}{plural}", group_digits(value))
}

/// Formats two values in the same notation, as short as a comparison allows: with six digits, but at least two digits
/// from the first that differs. Also returns the position from which the texts differ; `None` if they are equal.
pub fn format_pair(expected: f64, actual: f64) -> (String, String, Option<usize>) {
    let texts = format_alike(expected, actual).unwrap_or_else(|| (format_g(expected), format_g(actual)));
    let (one, other) = (texts.0.as_bytes(), texts.1.as_bytes());
    let common_count = one.iter().zip(other).take_while(|(one, other)| one == other).count();
    let parts = expected.to_bits() != actual.to_bits() && texts.0 != texts.1;
    // If the parts before the decimal point have different lengths, digits can't be compared.
    let integer_length = |text: &str| text.find('.').unwrap_or(text.len());
    let difference_start = if integer_length(&texts.0) == integer_length(&texts.1) { common_count } else { 0 };
    (texts.0, texts.1, parts.then_some(difference_start))
}

/// Formats both values with as many decimals as needed. If they are very large or very small, both have the same power
/// of ten. Returns `None` if no notation fits both.
fn format_alike(expected: f64, actual: f64) -> Option<(String, String)> {
    let larger = expected.abs().max(actual.abs());
    let power = |value: f64| -> Option<i32> { format!("{value:e}").split_once('e')?.1.parse().ok() };
    if !(expected.is_finite() && actual.is_finite()) || larger == 0.0 {
        return None;
    }
    let (top, gap) = (power(larger)?, (expected - actual).abs());
    let gap_power = if gap > 0.0 { power(gap)? } else { top };
    // Values of very different sizes can't be compared digit by digit.
    let smaller = expected.abs().min(actual.abs());
    if smaller > 0.0 && top - power(smaller)? > 4 {
        return None;
    }
    let digits = (top - gap_power + 2).clamp(6, 17);
    if (-4..9).contains(&top) {
        let decimals = usize::try_from(digits - 1 - top).unwrap_or(0);
        return Some((format!("{expected:.decimals$}"), format!("{actual:.decimals$}")));
    }
    let decimals = usize::try_from(digits - 1).unwrap_or(5);
    let scaled = |value: f64| format!("{:.decimals$}e{top}", value / 10_f64.powi(top));
    Some((scaled(expected), scaled(actual)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compared_values_have_one_notation_and_end_soon_after_they_part() {
        let of = |one: f64, other: f64| {
            let (one, other, place) = format_pair(one, other);
            (format!("{one} {other}"), place)
        };
        assert_eq!(of(-0.189_912_345_678, -0.004_412_345_678), ("-0.189912 -0.004412".to_owned(), Some(3)));
        assert_eq!(
            of(-1.188_915_324_228_893_8e-9, -3.962_980_248_972_745e-8),
            ("-0.11889e-8 -3.96298e-8".to_owned(), Some(1))
        );
        assert_eq!(of(1.0, 1.000_000_000_000_2), ("1.00000000000000 1.00000000000020".to_owned(), Some(14)));
        assert_eq!(of(0.5, 0.5), ("0.500000 0.500000".to_owned(), None));
        assert_eq!(of(0.0, 0.25), ("0.000000 0.250000".to_owned(), Some(2)));
        assert_eq!(of(1.0, f64::NAN).0, "1 nan");
        assert_eq!(of(12.5, 1e-9), ("12.5 1e-09".to_owned(), Some(0)));
        assert_eq!(of(9.5, 10.5).1, Some(0));
    }

    #[test]
    fn fractions_are_short_and_near() {
        let texts =
            [1.0 / 3.0, -7.0 / 11.0, 0.1 + 0.2, 0.25, 0.333_333_3].map(|value| format_rounded_or(value, format_exact));
        assert_eq!(texts, ["1/3", "-7/11", "0.3", "0.25", "0.3333333"]);
    }

    #[test]
    fn counts_are_grouped_from_five_digits_on() {
        assert_eq!(group_digits(0), "0");
        assert_eq!(group_digits(1234), "1234");
        assert_eq!(group_digits(12_345), "12 345");
        assert_eq!(group_digits(1_234_567), "1 234 567");
        assert_eq!((format_count(1, "step"), format_count(0, "step")), ("1 step".to_owned(), "0 steps".to_owned()));
    }
}
