//! `ln x = k ln 2 + ln c + ln(z/c)` for `x = 2^k z` with a `c` close to `z` from a table (Tang, ACM TOMS 16, 1990).
use super::{multiply_add, tables::LOGARITHM_TABLE};

/// The number ln 2 in two parts. A product of the first part with an exponent is exact.
const LN_2: [f64; 2] = [f64::from_bits(0x3fe6_2e42_fefa_3800), f64::from_bits(0x3d2e_f357_93c7_6730)];
/// The coefficients of `ln(1 + r) - r` from `r^2` on, for `|r| < 1/256`.
const SERIES_COEFFICIENTS: [f64; 5] = [
    f64::from_bits(0xbfe0_0000_0000_0001),
    f64::from_bits(0x3fd5_5555_5551_305b),
    f64::from_bits(0xbfcf_ffff_ffeb_4590),
    f64::from_bits(0x3fc9_99b3_24f1_0111),
    f64::from_bits(0xbfc5_5575_e506_c89f),
];
/// The series for arguments from `1 - 2^-4` to `1 + 0x1.09p-4`.
const NEAR_ONE_COEFFICIENTS: [f64; 11] = [
    f64::from_bits(0xbfe0_0000_0000_0000),
    f64::from_bits(0x3fd5_5555_5555_5577),
    f64::from_bits(0xbfcf_ffff_ffff_fdcb),
    f64::from_bits(0x3fc9_9999_9995_dd0c),
    f64::from_bits(0xbfc5_5555_5567_45a7),
    f64::from_bits(0x3fc2_4924_a344_de30),
    f64::from_bits(0xbfbf_ffff_a442_3d65),
    f64::from_bits(0x3fbc_7184_282a_d6ca),
    f64::from_bits(0xbfb9_99eb_43b0_68ff),
    f64::from_bits(0x3fb7_8182_f7af_d085),
    f64::from_bits(0xbfb5_5213_75d1_45cd),
];
/// The bits of 0.6875, where the table begins.
const TABLE_START_BITS: u64 = 0x3fe6_0000_0000_0000;
/// The bits of `1 - 2^-4`, and the number of doubles from there on that are close to one.
const NEAR_ONE_START_BITS: u64 = 0x3fee_0000_0000_0000;
const NEAR_ONE_BIT_COUNT: u64 = 0x0003_0900_0000_0000;
/// The number 2^27, with which a number is split into two halves of its bits.
const HALF_BITS_FACTOR: f64 = 134_217_728.0;

/// Returns the natural logarithm. The result is `-inf` at zero and NaN below.
pub fn ln(x: f64) -> f64 {
    let mut bits = x.to_bits();
    if bits.wrapping_sub(NEAR_ONE_START_BITS) < NEAR_ONE_BIT_COUNT {
        return ln_near_one(x);
    }
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    if !(x > 0.0) || x == f64::INFINITY {
        return if x == f64::INFINITY { x } else { f64::NAN };
    }
    if x < f64::MIN_POSITIVE {
        bits = (x * f64::from_bits((1023 + 52) << 52)).to_bits().wrapping_sub(52 << 52);
    }
    let offset = bits.wrapping_sub(TABLE_START_BITS);
    let row = 2 * (offset >> 45 & 127) as usize;
    let exponent = f64::from((offset.cast_signed() >> 52) as i32);
    let z = f64::from_bits(bits.wrapping_sub(offset & 0xfff << 52));
    let [reciprocal, logarithm] = [LOGARITHM_TABLE[row], LOGARITHM_TABLE[row + 1]].map(f64::from_bits);
    let r = multiply_add(z, reciprocal, -1.0);
    let high = multiply_add(exponent, LN_2[0], logarithm);
    let sum = high + r;
    let square = r * r;
    let low = multiply_add(square, SERIES_COEFFICIENTS[0], multiply_add(exponent, LN_2[1], high - sum + r));
    let inner = multiply_add(
        multiply_add(r, SERIES_COEFFICIENTS[4], SERIES_COEFFICIENTS[3]),
        square,
        multiply_add(r, SERIES_COEFFICIENTS[2], SERIES_COEFFICIENTS[1]),
    );
    multiply_add(r * square, inner, low) + sum
}

/// Returns the logarithm of a number close to one, with the first two terms of the series in two parts each.
fn ln_near_one(x: f64) -> f64 {
    if x == 1.0 {
        return 0.0;
    }
    let b = &NEAR_ONE_COEFFICIENTS;
    let r = x - 1.0;
    let square = r * r;
    let cube = r * square;
    let first = multiply_add(square, b[3], multiply_add(r, b[2], b[1]));
    let second = multiply_add(square, b[6], multiply_add(r, b[5], b[4]));
    let third = multiply_add(cube, b[10], multiply_add(square, b[9], multiply_add(r, b[8], b[7])));
    let inner = multiply_add(multiply_add(third, cube, second), cube, first);
    let high = multiply_add(-HALF_BITS_FACTOR, r, multiply_add(r, HALF_BITS_FACTOR, r));
    let low = r - high;
    let sum = multiply_add(high * high, b[0], r);
    let rest = multiply_add(high * high, b[0], r - sum);
    let rest = multiply_add(b[0] * low, high + r, rest);
    sum + multiply_add(inner, cube, rest)
}
