//! A call as the bytes of both sides have it.
use super::fair::Likeness;
use fosssim_model::sim::Pair;
use fosssim_num::polynomial::MAX_COEFFICIENTS;

/// Numbers of coefficients of a particle and an edge's complete polynomials, and of other pairs'.
pub(super) const OF_EDGE: [usize; 4] = [5, 3, 3, 6];
pub(super) const OF_TWO: [usize; 2] = [3, 2];

/// A polynomial of both sides, as bytes of its coefficients.
pub(super) type Both<'a> = [&'a [u8]; 2];

/// A call of which a polynomial is not the reference's.
pub(super) struct Call<'a> {
    /// The pair.
    pub(super) pair: Pair,
    /// The number of its first polynomial.
    pub(super) index: usize,
    /// Its polynomials.
    pub(super) both: &'a [Both<'a>],
    /// How many coefficients they have where nothing is lost.
    pub(super) lengths: &'a [usize],
    /// How they compare; all is 0 of those without coefficients, or of different lengths.
    pub(super) alike: &'a [Likeness],
    /// Whether the trace's have lost other leading coefficients than the reference's.
    pub(super) has_lost: bool,
    /// Whether the reference has searched the zeros.
    pub(super) is_searched: bool,
}

/// The coefficients of a polynomial from their bytes.
pub(super) struct Numbers {
    numbers: [f64; MAX_COEFFICIENTS],
    length: usize,
}

impl Numbers {
    /// The first ones of these.
    pub(super) fn of(bytes: &[u8]) -> Self {
        let mut numbers = [0.0; MAX_COEFFICIENTS];
        let list = bytes.as_chunks::<8>().0;
        numbers.iter_mut().zip(list).for_each(|(number, bytes)| *number = f64::from_le_bytes(*bytes));
        Self { numbers, length: list.len().min(MAX_COEFFICIENTS) }
    }

    /// Highest power first.
    pub(super) fn list(&self) -> &[f64] {
        &self.numbers[..self.length]
    }
}
