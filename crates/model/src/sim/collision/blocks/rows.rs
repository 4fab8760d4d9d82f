//! Processes all pairs in the order of the trace, particle by particle.
use super::{
    Lists, PairGroup, PassInput,
    group::{
        EDGE_FACTS_INDEX, EDGE_ROW_LENGTH, FACTS_INDEX, OPEN_BIT, ROW_PADDING, SHORT_ROW_LENGTH, compute_particles,
    },
    row_decision::{LoggedRows, MAX_EDGE_BYTES, MAX_TWO_POLYNOMIAL_BYTES, decide_edge, decide_two_polynomials},
};
use crate::sim::{
    observer::Impulse,
    pair::{Pair, PairKind, pair},
    pairs::PassCursor,
    polynomial_bytes::PolynomialBytes,
    search::SearchCounts,
    step_error::StepError,
};
use fosssim_num::lanes::{LaneWork, Lanes, MAX_LANES, Simd};
use std::ops::Range;

/// A search through the pairs from a position on, up to the next hit.
pub(super) struct HitSearch<'a> {
    pub lists: &'a Lists,
    pub group: &'a mut PairGroup,
    pub input: PassInput<'a>,
    pub cursor: &'a mut PassCursor,
    pub counts: &'a mut SearchCounts,
    pub bytes: Option<&'a mut PolynomialBytes>,
}

/// A buffer with one row of polynomial coefficients for each pair of a block.
type Rows = [f64; SHORT_ROW_LENGTH * MAX_LANES];

impl LaneWork for HitSearch<'_> {
    type Output = Result<Option<Impulse>, StepError>;

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) -> Self::Output {
        let bodies = self.input.bodies;
        let particles = bodies.particle_count();
        let mut rows = [0.0; SHORT_ROW_LENGTH * MAX_LANES];
        while self.cursor.first < particles {
            let first = self.cursor.first;
            let pairs = MAX_TWO_POLYNOMIAL_BYTES * (particles - first + bodies.points.len())
                + MAX_EDGE_BYTES * bodies.edges.len();
            let mut bytes = self.bytes.take();
            let room = bytes.as_mut().map_or(&mut [][..], |bytes| bytes.reserve(pairs));
            let mut output = LoggedRows::new(room);
            let ends = self.process_row(simd, &mut rows, &mut output);
            let LoggedRows {
                used_bytes: used, polynomial_count: polynomials, excluded, largest, result: found, ..
            } = output;
            self.counts.calls += excluded;
            if let Some(bytes) = &mut bytes {
                bytes.count_added(used, polynomials);
                bytes.raise_max_modulus(largest.max(self.group.largest_modulus));
            }
            self.bytes = bytes;
            if ends {
                return found;
            }
            *self.cursor = PassCursor::from_first(first + 1);
        }
        Ok(None)
    }
}

impl HitSearch<'_> {
    /// Computes the rest of the pairs of one particle. Returns whether the output contains a result; after a hit the
    /// position is that of the next pair.
    #[inline(always)]
    fn process_row<S: Simd>(&mut self, simd: S, rows: &mut Rows, output: &mut LoggedRows<'_>) -> bool {
        let first = self.cursor.first;
        let [particles, edges, half_planes] = self.input.bodies.object_counts().remaining_row(*self.cursor);
        if self.decide_particle_pairs(simd, first, (particles, rows), output) {
            return true;
        }
        if edges.is_empty() && half_planes.is_empty() {
            return false;
        }
        self.group.ensure_computed(simd, self.lists, self.input.bodies, first, edges.start);
        self.decide_edge_pairs(simd, first, edges, output)
            || self.decide_half_plane_pairs(simd, first, half_planes, output)
    }

    /// Decides the pairs of a particle with the edges `seconds`, except those that end in it.
    #[inline(always)]
    fn decide_edge_pairs<S: Simd>(
        &mut self,
        _: S,
        first: usize,
        seconds: Range<usize>,
        output: &mut LoggedRows<'_>,
    ) -> bool {
        let width = Lanes::<S>::COUNT;
        let lane = first - self.group.particles.start;
        let mut own = self.lists.edges_from(first, seconds.start);
        for edge in seconds {
            if let [skipped, others @ ..] = own
                && *skipped == edge
            {
                own = others;
                continue;
            }
            let Some(row) = self.group.edges[(edge * width + lane) * EDGE_ROW_LENGTH..].first_chunk() else {
                return false;
            };
            let pair = pair(PairKind::ParticleEdge, first, edge);
            if process_edge_pair(pair, row, &self.input, self.counts, self.cursor, output) {
                return true;
            }
        }
        false
    }

    /// Decides the pairs of a particle with the half-planes `seconds`.
    #[inline(always)]
    fn decide_half_plane_pairs<S: Simd>(
        &mut self,
        _: S,
        first: usize,
        seconds: Range<usize>,
        output: &mut LoggedRows<'_>,
    ) -> bool {
        let width = Lanes::<S>::COUNT;
        let lane = first - self.group.particles.start;
        let rows = self.group.half_planes.as_chunks::<SHORT_ROW_LENGTH>().0;
        for second in seconds {
            let pair = pair(PairKind::ParticleHalfPlane, first, second);
            if process_other_pair(pair, &rows[second * width + lane], &self.input, self.counts, self.cursor, output) {
                return true;
            }
        }
        false
    }

    /// Decides the pairs of a particle with the particles `seconds`.
    #[inline(always)]
    fn decide_particle_pairs<S: Simd>(
        &mut self,
        simd: S,
        first: usize,
        (seconds, rows): (Range<usize>, &mut Rows),
        output: &mut LoggedRows<'_>,
    ) -> bool {
        let width = Lanes::<S>::COUNT;
        let mut largest = Lanes::splat(simd, 0.0);
        let mut ends = false;
        let mut block = seconds.start;
        while block < seconds.end && !ends {
            largest = compute_particles(simd, self.lists, [first, block], rows, largest);
            for (row, second) in rows.as_chunks().0[..width].iter().zip(block..seconds.end) {
                let pair = pair(PairKind::ParticleParticle, first, second);
                ends = process_other_pair(pair, row, &self.input, self.counts, self.cursor, output);
                if ends {
                    break;
                }
            }
            block += width;
        }
        output.largest = output.largest.max(largest.largest());
        ends
    }
}

/// Decides a pair with an edge, if the certificate left it open, and writes its polynomials. Returns whether the output
/// contains a result.
#[inline(always)]
fn process_edge_pair(
    pair: Pair,
    row: &[f64; EDGE_ROW_LENGTH + ROW_PADDING],
    input: &PassInput<'_>,
    counts: &mut SearchCounts,
    cursor: &mut PassCursor,
    output: &mut LoggedRows<'_>,
) -> bool {
    let facts = row[EDGE_FACTS_INDEX].to_bits();
    let ends =
        facts & OPEN_BIT != 0 && output.decide(counts, |counts| decide_edge(input, counts, pair, row), pair, cursor);
    if facts & OPEN_BIT == 0 {
        output.excluded += 1;
    }
    output.write_edge(row, facts >> 1);
    ends
}

/// Decides a particle-particle or particle-half-plane pair and writes its polynomials. Returns whether the output
/// contains a result.
#[inline(always)]
fn process_other_pair(
    pair: Pair,
    row: &[f64; SHORT_ROW_LENGTH],
    input: &PassInput<'_>,
    counts: &mut SearchCounts,
    cursor: &mut PassCursor,
    output: &mut LoggedRows<'_>,
) -> bool {
    let facts = row[FACTS_INDEX].to_bits();
    let ends = facts & OPEN_BIT != 0
        && output.decide(counts, |counts| decide_two_polynomials(input, counts, pair, row), pair, cursor);
    if facts & OPEN_BIT == 0 {
        output.excluded += 1;
    }
    output.write_two_polynomials(row, facts >> 1);
    ends
}
