//! `e^x = 2^(k/128) e^r` with `|r| <= ln 2 / 256` (Tang, ACM TOMS 15, 1989; with a table of 128 powers).
use super::{multiply_add, tables::POWER_TABLE};

/// The number 128 / ln 2.
const STEPS_PER_E: f64 = f64::from_bits(0x4067_1547_652b_82fe);
/// The number -ln 2 / 128 in two parts. A product of the first part with a small integer is exact.
const MINUS_STEP: [f64; 2] = [f64::from_bits(0xbf76_2e42_fefa_0000), f64::from_bits(0xbd0c_f79a_bc9e_3b3a)];
/// The constant that, added to a number, rounds it to an integer in the lowest bits of the sum.
const ROUNDING_SHIFT: f64 = f64::from_bits(0x4338_0000_0000_0000);
/// The coefficients of `e^r - 1 - r` from `r^2` on.
const SERIES_COEFFICIENTS: [f64; 4] = [
    f64::from_bits(0x3fdf_ffff_ffff_fdbd),
    f64::from_bits(0x3fc5_5555_5555_543c),
    f64::from_bits(0x3fa5_5555_cf17_2b91),
    f64::from_bits(0x3f81_1111_67a4_d017),
];
/// The exponents of 2^-54, 512 and 1024 in a number's bits.
const TINY_EXPONENT: u64 = 0x3c9;
const LARGE_EXPONENT: u64 = 0x408;
const OVERFLOW_EXPONENT: u64 = 0x409;

/// Returns `e^x`. The result is infinite above 709.78 and zero below -745.13.
pub fn exp(x: f64) -> f64 {
    let exponent = x.to_bits() >> 52 & 0x7ff;
    if exponent < TINY_EXPONENT || exponent == 0x7ff {
        return if x == f64::NEG_INFINITY { 0.0 } else { 1.0 + x };
    }
    if exponent >= OVERFLOW_EXPONENT {
        return if x < 0.0 { 0.0 } else { f64::INFINITY };
    }
    let shifted = multiply_add(x, STEPS_PER_E, ROUNDING_SHIFT);
    let k = shifted.to_bits();
    let parts = shifted - ROUNDING_SHIFT;
    let r = multiply_add(parts, MINUS_STEP[1], multiply_add(parts, MINUS_STEP[0], x));
    let row = 2 * (k & 127) as usize;
    let tail = f64::from_bits(POWER_TABLE[row]);
    let power = POWER_TABLE[row + 1].wrapping_add(k << 45);
    let square = r * r;
    let low = multiply_add(multiply_add(r, SERIES_COEFFICIENTS[1], SERIES_COEFFICIENTS[0]), square, r + tail);
    let more = multiply_add(square * square, multiply_add(r, SERIES_COEFFICIENTS[3], SERIES_COEFFICIENTS[2]), low);
    if exponent < LARGE_EXPONENT {
        let power = f64::from_bits(power);
        return multiply_add(power, more, power);
    }
    if k & 0x8000_0000 == 0 {
        // The power may be too large for a number, so it is temporarily reduced by 2^1009.
        let power = f64::from_bits(power.wrapping_sub(1009 << 52));
        return multiply_add(power, more, power) * f64::from_bits((1023 + 1009) << 52);
    }
    scale_subnormal(f64::from_bits(power.wrapping_add(1022 << 52)), more) * f64::MIN_POSITIVE
}

/// Returns `power (1 + more)`, rounded like a subnormal number; a product with 2^-1022 would round its last bits again.
fn scale_subnormal(power: f64, more: f64) -> f64 {
    let change = power * more;
    let value = power + change;
    if value >= 1.0 {
        return value;
    }
    let round_off = power - value + change;
    let sum = 1.0 + value;
    let rest = 1.0 - sum + value + round_off;
    let rounded = (sum + rest) - 1.0;
    if rounded == 0.0 { 0.0 } else { rounded }
}
