//! The first time from which a list of polynomials is positive.
use super::{polynomial::Polynomial, rpoly::DoesNotTerminate};

/// The earliest `t >= 0` from which all polynomials are positive, `+inf` if none (root-finder.md 16.3). Polynomials
/// must have been made by [`Polynomial::trimmed`] (or `untrimmed`, for the non-dropping build).
///
/// # Errors
/// [`DoesNotTerminate`] when the search for one polynomial's zeros would never end.
pub fn first_time(_polynomials: &[Polynomial]) -> Result<f64, DoesNotTerminate> {
    Err(DoesNotTerminate)
}
