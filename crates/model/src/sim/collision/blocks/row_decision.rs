//! Decides single pairs with known coefficients, and writes their polynomials.
use super::{
    super::{impact::time_of_impact, motion::PairMotion},
    PassInput,
    group::{EDGE_ROW_LENGTH, LINE_INDEX, ROW_PADDING, SHORT_ROW_LENGTH},
};
use crate::sim::{
    observer::{ImpactTime, Impulse},
    pair::Pair,
    pairs::PassCursor,
    search::{RootSearch, SearchCounts},
    step_error::StepError,
};
use fosssim_num::{lanes::copy_little_endian, polynomial::Polynomial};

crate::drops_leading!();

/// The maximum number of bytes that the polynomials of a pair with an edge take.
pub(super) const MAX_EDGE_BYTES: usize = 4 * 4 + 8 * 17;
pub(super) const MAX_TWO_POLYNOMIAL_BYTES: usize = 2 * 4 + 8 * 5;

/// The buffer for polynomials, and the number written so far.
pub(super) struct LoggedRows<'a> {
    /// Memory for all polynomials; empty if they are not needed.
    pub buffer: &'a mut [u8],
    /// The number of bytes written.
    pub used_bytes: usize,
    /// The number of polynomials written.
    pub polynomial_count: usize,
    /// The number of pairs for which the certificate's closed forms have excluded an impact within the step.
    pub excluded: u64,
    /// The largest absolute value of a coefficient.
    pub largest: f64,
    /// The hit that was found, or the reason why the search would never end. It is stored here because it is rare and
    /// large.
    pub result: Result<Option<Impulse>, StepError>,
}

impl<'a> LoggedRows<'a> {
    /// Creates the state before anything is written.
    #[inline(always)]
    pub fn new(room: &'a mut [u8]) -> Self {
        Self { buffer: room, used_bytes: 0, polynomial_count: 0, excluded: 0, largest: 0.0, result: Ok(None) }
    }

    /// Decides a pair. Returns whether there is a result, like [`LoggedRows::record_result`].
    #[inline(always)]
    pub fn decide(
        &mut self,
        counts: &mut SearchCounts,
        decide: impl FnOnce(&mut SearchCounts) -> Result<Option<Impulse>, StepError>,
        pair: Pair,
        cursor: &mut PassCursor,
    ) -> bool {
        let found = decide(counts);
        self.record_result(found, pair, cursor)
    }

    /// Stores the result of a pair. Returns whether there is one: a hit, or an endless search, whose polynomials are
    /// not logged. The cursor is then after the pair.
    #[inline(always)]
    fn record_result(&mut self, hit: Result<Option<Impulse>, StepError>, pair: Pair, cursor: &mut PassCursor) -> bool {
        if matches!(hit, Ok(None)) {
            return false;
        }
        if hit.is_err() {
            self.buffer = &mut [];
        }
        self.result = hit;
        *cursor = PassCursor::after_pair(pair.kind, pair.first as usize, pair.second as usize);
        true
    }

    /// Writes the polynomials of a pair with an edge without their small leading coefficients, whose bits are set in
    /// `small`.
    #[inline(always)]
    pub fn write_edge(&mut self, row: &[f64; EDGE_ROW_LENGTH + ROW_PADDING], small: u64) {
        let Some(room) = self.buffer.get_mut(self.used_bytes..).and_then(<[u8]>::first_chunk_mut::<MAX_EDGE_BYTES>)
        else {
            return;
        };
        let mut used = 0;
        write_polynomial::<5>(room, &mut used, row, small);
        write_polynomial::<3>(room, &mut used, &row[5..], small >> 5);
        write_polynomial::<3>(room, &mut used, &row[8..], small >> 8);
        write_polynomial::<6>(room, &mut used, &row[11..], small >> 11);
        self.used_bytes += used;
        self.polynomial_count += 4;
    }

    /// Writes both polynomials of a particle-particle or particle-half-plane pair without their small leading
    /// coefficients, whose bits are set in `small`.
    #[inline(always)]
    pub fn write_two_polynomials(&mut self, row: &[f64; SHORT_ROW_LENGTH], small: u64) {
        let Some(room) =
            self.buffer.get_mut(self.used_bytes..).and_then(<[u8]>::first_chunk_mut::<MAX_TWO_POLYNOMIAL_BYTES>)
        else {
            return;
        };
        let mut used = 0;
        write_polynomial::<3>(room, &mut used, row, small);
        write_polynomial::<2>(room, &mut used, &row[LINE_INDEX..], small >> 3);
        self.used_bytes += used;
        self.polynomial_count += 2;
    }
}

/// Writes the polynomial whose coefficients begin `row`. The maximum number of coefficients is always written, but only
/// the bytes of those that are kept count.
#[inline(always)]
fn write_polynomial<const LENGTH: usize>(room: &mut [u8], used: &mut usize, row: &[f64], small: u64) {
    // The number of leading small coefficients; `LENGTH` if all are small.
    let dropped = (!small | 1 << LENGTH).trailing_zeros() as usize;
    let Some(coefficients) = row.get(dropped..).and_then(<[f64]>::first_chunk::<LENGTH>) else { return };
    let Some((size, bytes)) = room.get_mut(*used..).and_then(<[u8]>::split_first_chunk_mut::<4>) else { return };
    let Some(bytes) = bytes.get_mut(..8 * LENGTH) else { return };
    #[expect(clippy::cast_possible_truncation, reason = "at most six")]
    let count = (LENGTH - dropped) as u32;
    *size = count.to_le_bytes();
    copy_little_endian(coefficients, bytes);
    *used += 4 + 8 * (LENGTH - dropped);
}

/// Returns the hit of a pair with an edge, if there is one. Uses the root finder if the certificate has no answer.
#[inline(never)]
pub(super) fn decide_edge(
    input: &PassInput<'_>,
    counts: &mut SearchCounts,
    pair: Pair,
    row: &[f64; EDGE_ROW_LENGTH + ROW_PADDING],
) -> Result<Option<Impulse>, StepError> {
    decide_polynomials(input, counts, pair, row, [5, 3, 3, 6])
}

/// Returns the hit of a pair without an edge, if there is one.
#[inline(never)]
pub(super) fn decide_two_polynomials(
    input: &PassInput<'_>,
    counts: &mut SearchCounts,
    pair: Pair,
    row: &[f64; SHORT_ROW_LENGTH],
) -> Result<Option<Impulse>, StepError> {
    let [a, b, c, _, d, e, ..] = *row;
    decide_polynomials(input, counts, pair, &[a, b, c, d, e], [3, 2])
}

/// Returns the hit of a pair, if there is one. Its polynomials have the given lengths, small leading coefficients
/// included.
#[inline(always)]
fn decide_polynomials<const COUNT: usize>(
    input: &PassInput<'_>,
    counts: &mut SearchCounts,
    pair: Pair,
    coefficients: &[f64],
    lengths: [usize; COUNT],
) -> Result<Option<Impulse>, StepError> {
    let mut begin = 0;
    let mut polynomials = [Polynomial::default(); COUNT];
    for (polynomial, length) in polynomials.iter_mut().zip(lengths) {
        *polynomial = Polynomial::untrimmed(&coefficients[begin..begin + length]);
        polynomial.trim();
        begin += length;
    }
    let time = time_of_impact(RootSearch::OnDemand, counts, input.step, pair, &polynomials)?;
    let ImpactTime::Found(time) = time else { return Ok(None) };
    if !(time <= 1.0) {
        return Ok(None);
    }
    let motion = PairMotion::from_bodies(input.bodies, pair, input.q_start, input.displacements);
    Ok(motion.normal(time).map(|normal| Impulse { pair, normal, time }))
}
