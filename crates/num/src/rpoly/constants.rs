//! The constants of the root finder (root-finder.md 1). All are plain binary64; the tests compare their bits.

/// The unit error, as a decimal number instead of 2^-52.
pub(super) const UNIT_ERROR: f64 = 2.22e-16;
/// The "large" number of Algorithm 493: the largest of single precision.
pub(super) const LARGEST_NUMBER: f64 = 3.4e38;
/// The "small" number of Algorithm 493: the smallest normal one of single precision.
pub(super) const SMALLEST_NUMBER: f64 = 1.2e-38;
/// The target of scaling for the smallest coefficient.
pub(super) const SCALING_TARGET: f64 = SMALLEST_NUMBER / UNIT_ERROR;
/// The weights of the rounding-error bounds.
pub(super) const ETA_2: f64 = UNIT_ERROR + UNIT_ERROR;
pub(super) const ETA_7: f64 = 5.0 * UNIT_ERROR + 2.0 * UNIT_ERROR;
pub(super) const ETA_9: f64 = 5.0 * UNIT_ERROR + 4.0 * UNIT_ERROR;

/// The first direction of the shift.
pub(super) const START_X: f64 = f64::from_bits(0x3FE6_A09E_667F_3BCD);
pub(super) const START_Y: f64 = -START_X;
/// The rotation of the direction by 94 degrees for each shift.
pub(super) const ROTATION_COSINE: f64 = f64::from_bits(0xBFB1_DB90_2EC1_47E0);
pub(super) const ROTATION_SINE: f64 = f64::from_bits(0x3FEF_EC0B_6FC0_5F20);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bits_are_those_of_the_specification() {
        let table = [
            (UNIT_ERROR, 0x3CAF_FE5A_B7E8_AD5E),
            (LARGEST_NUMBER, 0x47EF_F933_C78C_DFAD),
            (SMALLEST_NUMBER, 0x3810_5563_C4FF_E223),
            (SCALING_TARGET, 0x3B50_563A_D843_FBF2),
            (ETA_2, 0x3CBF_FE5A_B7E8_AD5E),
            (ETA_7, 0x3CDB_FE8F_60EB_97B2),
            (ETA_9, 0x3CE1_FF13_0772_E185),
            (std::f64::consts::LN_2, 0x3FE6_2E42_FEFA_39EF),
            (START_X, 0.5_f64.sqrt().to_bits()),
        ];
        for (constant, bits) in table {
            assert_eq!(constant.to_bits(), bits, "{constant:e}");
        }
    }
}
