//! The rules of the original that make the two rule books differ about a trace.
//!
//! The original's rules are described in oracle-behavior.md 4 to 6, and the reasons why they can't be trusted in
//! numerics.md 1.
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// A rule of the original that makes the verdicts differ. Rules by which the original rejects come first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "snake_case")]
    pub enum Cause {
        /// Parity fails: coefficients of all sizes are compared with the same absolute bound.
        AbsoluteCoefficients =
            "the original compares coefficients at an absolute 1e-10, after rescaling by sums of moduli: the \
             round-off of large ones exceeds it",
        /// Parity fails: small leading coefficients are dropped before degrees are compared.
        DroppedCoefficients =
            "the original compares degrees after leading coefficients below an absolute 1e-12 have been dropped: a \
             factor or a rounding moves them across that bound",
        /// Parity fails: a polynomial that is only round-off is compared with zero.
        VanishingPolynomial =
            "the original treats a polynomial below an absolute 1e-10 as zero, and its round-off elsewhere as wrong",
        /// Parity fails: the approach polynomial has the course's slip.
        ApproachForm =
            "the original has the course's slip in t^3 of the particle-edge approach polynomial, and the trace has \
             the right form",
        /// Parity fails: states in scenes of all sizes are compared with the same absolute bound.
        AbsoluteStates = "the original compares states at an absolute 1e-10: the round-off of large numbers exceeds it",
        /// Parity fails: contact normals are compared with an absolute bound.
        AbsoluteNormals =
            "the original compares contact normals at an absolute 1e-9: the round-off of long ones exceeds it",
        /// Parity fails: the round-off of all steps is summed.
        AccumulatedResiduals =
            "the original adds up the round-off of all steps and particles, and its bound of 1e-6 does not grow \
             with them",
        /// Parity fails: round-off may change a decision.
        BorderlineDecision =
            "the original accepts only one result of a decision that round-off may flip, and the trace has the other",
        /// Parity passes: the original never checks the first record.
        FirstRecord = "the original never checks the first record against the scene",
        /// Parity passes: the original copies the states of mid records without checking them.
        MidRecord = "the original never checks a step's mid record",
        /// Parity passes: the original does not compare times of impact.
        ContactTime = "the original does not compare times of impact",
        /// Parity passes: a collision that is logged twice counts once.
        RepeatedCollision = "the original counts a collision that is logged several times as one",
        /// Parity passes: the original decides with its own polynomials, not with the trace's.
        OwnPolynomials =
            "the original decides with its own polynomials, so it does not check the trace's decisions",
        /// Parity passes: the original does not check whether the course's library can have written a polynomial.
        ImpossibleLog = "the original does not check whether the course's library can have written the log",
        /// Parity passes: the original accepts values that are not numbers.
        NotANumber = "the original accepts values that are not numbers",
        /// Parity passes: the original accepts errors below an absolute bound, even if they are large relative to the
        /// value.
        SmallErrors = "the original compares at absolute bounds: smaller errors pass, however large for the value",
        /// Parity passes: the original does not read the bytes after the last record.
        TrailingBytes = "the original does not check what follows the last record",
        /// Parity passes: the original skips damaged data.
        Damage = "the original skips damage silently",
    }
}

impl Cause {
    /// Returns whether the original rejects and the fair rules accept; otherwise the fair rules reject and the original
    /// accepts.
    #[must_use]
    pub const fn original_fails(self) -> bool {
        (self as u8) <= (Self::BorderlineDecision as u8)
    }
}

/// Writes one sentence about the original, without a full stop.
impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
