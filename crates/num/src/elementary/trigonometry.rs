//! Sine and cosine by a table of angles in steps of 1/128 and short series in between, like IBM's library (Gal and
//! Bachelis, ACM TOMS 17, 1991). An angle beyond the table is first reduced to one near zero.
use super::{
    multiply_add,
    reduction::{HALF_PI, ReducedAngle, reduce_large, reduce_small},
    tables::ANGLE_TABLE,
};

/// The high words of the angles at which the next method begins.
const SINE_IS_ANGLE_LIMIT: u32 = 0x3e50_0000;
const COSINE_IS_ONE_LIMIT: u32 = 0x3e40_0000;
const TABLE_LIMIT: u32 = 0x3feb_6000;
const QUARTER_LIMIT: u32 = 0x4003_68fd;
const NEAR_LIMIT_BITS: u32 = 0x4199_21fb;
/// The constant that, added to an angle, rounds it to 1/128; the number of the step is in the lowest bits of the sum.
const ROUNDING_SHIFT: f64 = f64::from_bits(0x42c8_0000_0000_0000);
/// The angle below which Taylor's series is used without the table.
const TAYLOR_LIMIT: f64 = f64::from_bits(0x3fc0_20c4_9ba5_e354);
/// Taylor's series of the sine from `x^3` on.
const TAYLOR_COEFFICIENTS: [f64; 5] = [
    f64::from_bits(0xbfc5_5555_5555_5555),
    f64::from_bits(0x3f81_1111_1111_0ece),
    f64::from_bits(0xbf2a_01a0_19db_08b8),
    f64::from_bits(0x3ec7_1de2_7b9a_7ed9),
    f64::from_bits(0xbe5a_ddff_c2fc_df59),
];
/// The sine's terms in `x^3` and `x^5` between two angles of the table, and the terms of one less the cosine.
const SINE_COEFFICIENTS: [f64; 2] = [f64::from_bits(0xbfc5_5555_5555_5515), f64::from_bits(0x3f81_1110_e829_872f)];
const COSINE_COEFFICIENTS: [f64; 3] =
    [0.5, f64::from_bits(0xbfa5_5555_5555_5535), f64::from_bits(0x3f56_c16b_edd9_e239)];

/// Returns the sine of an angle in radians, or NaN for infinity.
pub fn sin(angle: f64) -> f64 {
    match high_word(angle) {
        word if word < SINE_IS_ANGLE_LIMIT => angle,
        word if word < TABLE_LIMIT => sine(angle, 0.0),
        word if word < QUARTER_LIMIT => cosine(HALF_PI[0] - angle.abs(), HALF_PI[1]).copysign(angle),
        word => reduce(angle, word).map_or(f64::NAN, |reduced| sine_at_quarter(reduced, 0)),
    }
}

/// Returns the cosine of an angle in radians, or NaN for infinity.
pub fn cos(angle: f64) -> f64 {
    match high_word(angle) {
        word if word < COSINE_IS_ONE_LIMIT => 1.0,
        word if word < TABLE_LIMIT => cosine(angle, 0.0),
        word if word < QUARTER_LIMIT => {
            let rest = HALF_PI[0] - angle.abs();
            let sum = rest + HALF_PI[1];
            sine(sum, (rest - sum) + HALF_PI[1])
        }
        word => reduce(angle, word).map_or(f64::NAN, |reduced| sine_at_quarter(reduced, 1)),
    }
}

/// Returns the upper half of the bits of an angle's absolute value, which has the order of the angles.
fn high_word(angle: f64) -> u32 {
    (angle.abs().to_bits() >> 32) as u32
}

fn reduce(angle: f64, word: u32) -> Option<ReducedAngle> {
    match word {
        _ if !angle.is_finite() => None,
        word if word < NEAR_LIMIT_BITS => Some(reduce_small(angle)),
        _ => Some(reduce_large(angle)),
    }
}

/// Returns the sine of an angle plus `more` quarter turns.
fn sine_at_quarter(ReducedAngle { quarters, angle, rest }: ReducedAngle, more: u32) -> f64 {
    let quarter = quarters + more;
    let value = if quarter & 1 == 0 { sine(angle, rest) } else { cosine(angle, rest) };
    if quarter & 2 == 0 { value } else { -value }
}

/// Returns the table's entries for the angle nearest to `modulus`, and the difference from this angle. The index of the
/// entries is in the sum's lowest bits.
fn nearest_angle(modulus: f64) -> ([f64; 4], f64) {
    let sum = ROUNDING_SHIFT + modulus;
    let row = 4 * (sum.to_bits() as u32) as usize;
    (std::array::from_fn(|i| f64::from_bits(ANGLE_TABLE[row + i])), modulus - (sum - ROUNDING_SHIFT))
}

/// Returns the sine of `x + dx` for `|x|` up to 0.86 and a `dx` that is small compared with it.
fn sine(x: f64, dx: f64) -> f64 {
    if x.abs() < TAYLOR_LIMIT {
        let square = x * x;
        let series = TAYLOR_COEFFICIENTS
            .iter()
            .rev()
            .copied()
            .reduce(|sum, next| multiply_add(sum, square, next))
            .unwrap_or(0.0);
        return x + multiply_add(square, multiply_add(series, x, -(0.5 * dx)), dx);
    }
    let ([sine, sine_rest, cosine, cosine_rest], difference) = nearest_angle(x.abs());
    let dx = if x <= 0.0 { -dx } else { dx };
    let square = difference * difference;
    let s = difference
        + multiply_add(difference * square, multiply_add(SINE_COEFFICIENTS[1], square, SINE_COEFFICIENTS[0]), dx);
    let c = multiply_add(difference, dx, square * cosine_complement(square));
    let rest = multiply_add(-c, sine, multiply_add(s, cosine_rest, sine_rest));
    (sine + multiply_add(s, cosine, rest)).copysign(x)
}

/// Returns the cosine of `x + dx`, for the same arguments as [`sine`].
fn cosine(x: f64, dx: f64) -> f64 {
    let ([sine, sine_rest, cosine, cosine_rest], difference) = nearest_angle(x.abs());
    let difference = difference + if x < 0.0 { -dx } else { dx };
    let square = difference * difference;
    let s =
        multiply_add(difference * square, multiply_add(SINE_COEFFICIENTS[1], square, SINE_COEFFICIENTS[0]), difference);
    let c = square * cosine_complement(square);
    let rest = multiply_add(-c, cosine, multiply_add(-s, sine_rest, cosine_rest));
    cosine + multiply_add(-s, sine, rest)
}

/// Returns `(1 - cos x) / x²` for a small `x` with this square.
fn cosine_complement(square: f64) -> f64 {
    multiply_add(square, multiply_add(COSINE_COEFFICIENTS[2], square, COSINE_COEFFICIENTS[1]), COSINE_COEFFICIENTS[0])
}
