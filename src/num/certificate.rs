//! Proofs that no root search is needed.
use super::polynomial::Polynomial;

/// Whether [`first_time`](super::first_time::first_time) of these polynomials is certainly greater than 1 (or
/// infinite), with a margin that covers the root finder's own errors. `false` means "not known".
#[inline]
#[must_use]
pub fn excludes_unit_interval(_polynomials: &[Polynomial]) -> bool {
    false
}
