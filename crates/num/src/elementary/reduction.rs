//! Reduces an angle by quarters of a turn: by π/2 in parts (Cody and Waite), or, for very large angles, by the digits
//! of 2/π (Payne and Hanek, SIGNUM 18, 1983).
use super::{multiply_add, tables::TWO_OVER_PI};

/// An angle near zero, and the number of subtracted quarters of a turn, of which the last two bits count.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReducedAngle {
    pub(super) quarters: u32,
    pub(super) angle: f64,
    /// The difference of the exact angle from its nearest double.
    pub(super) rest: f64,
}

/// The number π/2 in two parts.
pub(super) const HALF_PI: [f64; 2] = [f64::from_bits(0x3ff9_21fb_5444_2d18), f64::from_bits(0x3c91_a626_3314_5c07)];
/// The number 2/π.
const QUARTERS_PER_RADIAN: f64 = f64::from_bits(0x3fe4_5f30_6dc9_c883);
/// The constant that, added to a number, rounds it to an integer in the lowest bits of the sum.
const ROUNDING_SHIFT: f64 = f64::from_bits(0x4338_0000_0000_0000);
/// The constant that rounds to multiples of four.
const TURN_ROUNDING_SHIFT: f64 = f64::from_bits(0x4358_0000_0000_0000);
/// The number π/2 in four parts. Products of the first three parts with the quarters of a near angle are exact.
const HALF_PI_PARTS: [f64; 4] = [
    f64::from_bits(0x3ff9_21fb_5800_0000),
    f64::from_bits(0xbe4d_de97_3c00_0000),
    f64::from_bits(0xbc8c_b3b3_9800_0000),
    f64::from_bits(0xbacd_747f_23e3_2ed7),
];
/// The number π/2 as a high and a low part, each of half of a number's bits.
const HALF_PI_HIGH_LOW: [f64; 2] = [HALF_PI_PARTS[0], f64::from_bits(0xbe4d_de97_4000_0000)];
/// The factor 2^27 + 1 that splits a number into two halves of its bits.
const SPLIT_FACTOR: f64 = 134_217_729.0;

/// Returns 2 to the power `exponent`.
const fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// Returns the reduced angle of an angle below 1.05e8.
pub(super) fn reduce_small(x: f64) -> ReducedAngle {
    let shifted = multiply_add(x, QUARTERS_PER_RADIAN, ROUNDING_SHIFT);
    let quarters = shifted - ROUNDING_SHIFT;
    let first = multiply_add(-quarters, HALF_PI_PARTS[1], multiply_add(-quarters, HALF_PI_PARTS[0], x));
    let second = multiply_add(-quarters, HALF_PI_PARTS[2], first);
    let angle = multiply_add(-quarters, HALF_PI_PARTS[3], second);
    let rest = multiply_add(-quarters, HALF_PI_PARTS[2], first - second)
        + multiply_add(-quarters, HALF_PI_PARTS[3], second - angle);
    ReducedAngle { quarters: shifted.to_bits() as u32 & 3, angle, rest }
}

/// Returns the reduced angle of any finite angle of at least 1.05e8.
pub(super) fn reduce_large(x: f64) -> ReducedAngle {
    let x = x * power_of_two(-600);
    let scaled = x * SPLIT_FACTOR;
    let high = scaled - (scaled - x);
    let [first, second] = [high, x - high].map(count_quarters);
    let mut whole = first.whole + second.whole;
    let mut part = first.part + second.part;
    let mut rest = if first.part.abs() > second.part.abs() {
        (first.part - part) + second.part
    } else {
        (second.part - part) + first.part
    };
    if part > 0.5 {
        part -= 1.0;
        whole += 1.0;
    } else if part < -0.5 {
        part += 1.0;
        whole -= 1.0;
    }
    let sum = part + (rest + first.rest + second.rest);
    rest = ((part - sum) + rest) + (first.rest + second.rest);
    let scaled = sum * SPLIT_FACTOR;
    let high = scaled - (scaled - sum);
    let low = sum - high;
    let product = sum * HALF_PI[0];
    let more = (((high * HALF_PI_HIGH_LOW[0] - product) + high * HALF_PI_HIGH_LOW[1]) + low * HALF_PI_HIGH_LOW[0])
        + (low * HALF_PI_HIGH_LOW[1] + sum * HALF_PI[1] + rest * HALF_PI[0]);
    let angle = product + more;
    ReducedAngle { quarters: (whole as i32 & 3).cast_unsigned(), angle, rest: (product - angle) + more }
}

/// A number of quarters of a turn: whole quarters (without whole turns), a fraction, and the rounding error of the
/// fraction.
struct Quarters {
    whole: f64,
    part: f64,
    rest: f64,
}

/// Returns the quarters of a turn in `half`, which is one half of an angle's bits, times 2^-600.
fn count_quarters(half: f64) -> Quarters {
    // Digits of 2/π whose product with the angle is a multiple of a turn are left out.
    let exponent = (half.to_bits() >> 52 & 0x7ff) as i32;
    let from = ((exponent - 450) / 24).max(0);
    let mut scale = power_of_two(576 - 24 * from);
    let mut digits = [0.0; 6];
    for (product, digit) in digits.iter_mut().zip(&TWO_OVER_PI[from as usize..]) {
        *product = half * f64::from(*digit) * scale;
        scale *= power_of_two(-24);
    }
    let mut whole = 0.0;
    for digit in &mut digits[..3] {
        let rounded = (*digit + ROUNDING_SHIFT) - ROUNDING_SHIFT;
        whole += rounded;
        *digit -= rounded;
    }
    let sum = digits.iter().rev().fold(0.0, |sum, digit| sum + digit);
    let round_off = digits[1..].iter().fold(digits[0] - sum, |round_off, digit| round_off + digit);
    let rounded = (sum + ROUNDING_SHIFT) - ROUNDING_SHIFT;
    whole += rounded;
    let left = sum - rounded;
    let part = left + round_off;
    whole -= (whole + TURN_ROUNDING_SHIFT) - TURN_ROUNDING_SHIFT;
    Quarters { whole, part, rest: (left - part) + round_off }
}
