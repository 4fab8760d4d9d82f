//! Numbers as text: C's `%g` for everything that the original prints, and the shortest exact form for our own reports.
//!
//! Pure functions.

pub use fosssim_num::printed::general;

/// The shortest text that reads back as the same bits, with an exponent where it would be long otherwise: `-0.1875`,
/// `1e-12`, `nan`, `-nan`, `inf`.
#[must_use]
pub fn exact(value: f64) -> String {
    let magnitude = value.abs();
    if value.is_finite() && (magnitude == 0.0 || (1e-5..1e9).contains(&magnitude)) {
        format!("{value}")
    } else if value.is_finite() {
        format!("{value:e}")
    } else {
        general(value)
    }
}

/// A count with thin separation of thousands: `1 234 567`; four digits stay together.
#[must_use]
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut grouped = String::with_capacity(digits.len() + digits.len() / 3);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// A count with its noun: `1 step`, `12 345 steps`.
#[must_use]
pub fn counted(value: u64, noun: &str) -> String {
    let plural = if value == 1 { "" } else { "s" };
    format!("{} {noun}{plural}", count(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_reads_back_as_the_same_bits() {
        for value in [0.1 + 0.2, -0.1875, 1e-12, 123_456_789.125, 1e22, -5e-324, 0.0, -0.0] {
            let text = exact(value);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
        }
        assert_eq!(exact(1e-12), "1e-12");
        assert_eq!(exact(-0.1875), "-0.1875");
        assert_eq!(exact(f64::NAN.copysign(-1.0)), "-nan");
    }

    #[test]
    fn counts_are_grouped_from_five_digits_on() {
        assert_eq!(count(0), "0");
        assert_eq!(count(1234), "1234");
        assert_eq!(count(12_345), "12 345");
        assert_eq!(count(1_234_567), "1 234 567");
        assert_eq!((counted(1, "step"), counted(0, "step")), ("1 step".to_owned(), "0 steps".to_owned()));
    }
}
