//! The rules of the original that lead to different judgments of a trace by the two rule books.
//!
//! The original's rules are described in oracle-behavior.md 4 to 6, and numerics.md 1 explains why they can't be
//! trusted.
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// A rule of the original because of which the verdicts differ. Rules by which the original rejects a trace come
    /// first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "snake_case")]
    pub enum Cause {
        /// Parity rejects: coefficients of all sizes are compared with the same absolute bound.
        AbsoluteCoefficients =
            "the original compares coefficients with an absolute bound of 1e-10, after rescaling them by the sums of \
                their absolute values; the round-off of large coefficients exceeds this bound",
        /// Parity rejects: small leading coefficients are dropped before degrees are compared.
        DroppedCoefficients =
            "the original compares degrees after dropping leading coefficients below an absolute bound of 1e-12; a \
                factor or a rounding moves coefficients across this bound",
        /// Parity rejects: a polynomial that consists only of round-off is compared with zero.
        VanishingPolynomial =
            "the original treats a polynomial below an absolute bound of 1e-10 as zero, and rejects the round-off \
                that the trace contains instead",
        /// Parity rejects: the original's approach polynomial contains the course's slip.
        ApproachForm =
            "the original has the course's slip in t^3 of the particle-edge approach polynomial, and the trace has \
             the right form",
        /// Parity rejects: states in scenes of all sizes are compared with the same absolute bound.
        AbsoluteStates = "the original compares states with an absolute bound of 1e-10; the round-off of large \
            numbers exceeds this bound",
        /// Parity rejects: contact normals are compared with an absolute bound.
        AbsoluteNormals =
            "the original compares contact normals with an absolute bound of 1e-9; the round-off of long normals \
                exceeds this bound",
        /// Parity rejects: the round-off of all steps is added up.
        AccumulatedResiduals =
            "the original adds up the round-off of all steps and particles, but its bound of 1e-6 does not grow with \
                their number",
        /// Parity rejects: a decision differs because of round-off.
        BorderlineDecision =
            "the original accepts only one result of a decision that round-off may change, and the trace has the \
                other result",
        /// Parity accepts: the original never checks the first record.
        FirstRecord = "the original never checks the first record against the scene",
        /// Parity accepts: the original copies the states of mid records without checking them.
        MidRecord = "the original never checks a step's mid record",
        /// Parity accepts: the original does not compare times of impact.
        ContactTime = "the original does not compare times of impact",
        /// Parity accepts: a collision that is logged twice counts once.
        RepeatedCollision = "the original counts a collision that is logged several times as one",
        /// Parity accepts: the original decides with its own polynomials instead of the trace's.
        OwnPolynomials =
            "the original decides with its own polynomials, so it does not check the trace's decisions",
        /// Parity accepts: the original does not check whether the course's library could have written a polynomial.
        ImpossibleLog = "the original does not check whether the course's library could have written the log",
        /// Parity accepts: the original accepts values that are not numbers.
        NotANumber = "the original accepts values that are not numbers",
        /// Parity accepts: the original accepts errors below an absolute bound, even if they are large relative to the
        /// value.
        SmallErrors = "the original compares with absolute bounds, so it accepts smaller errors, even if they are \
            large relative to the value",
        /// Parity accepts: the original does not read the bytes after the last record.
        TrailingBytes = "the original does not check what follows the last record",
        /// Parity accepts: the original skips damaged data.
        Damage = "the original skips damage silently",
    }
}

impl Cause {
    /// Returns whether the original rejects the trace and the fair rules accept it. The result is false in the opposite
    /// case.
    pub const fn is_original_too_strict(self) -> bool {
        (self as u8) <= (Self::BorderlineDecision as u8)
    }
}

/// Writes one sentence about the original, without a full stop.
impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
