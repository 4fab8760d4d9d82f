//! Goes through all pairs in the order of the trace, particle by particle.
use super::{
    Group, Lists, Setting,
    group::{OF_EDGE, OF_TWO, TRIMMED, WHOLE, of_particles},
    settle::{Output, decide},
};
use crate::sim::{
    observer::Impulse,
    pair::{Pair, PairKind, pair},
    pairs::Place,
    polynomial_bytes::PolynomialBytes,
    search::SearchCounts,
    step_error::StepError,
};
use fosssim_num::lanes::{Lanes, MOST_LANES, Simd, Work};
use std::ops::Range;

/// The pairs from a place on, up to the next hit.
pub(super) struct Pairs<'a> {
    pub lists: &'a Lists,
    pub group: &'a mut Group,
    pub setting: Setting<'a>,
    pub place: &'a mut Place,
    pub counts: &'a mut SearchCounts,
    pub bytes: Option<&'a mut PolynomialBytes>,
}

/// Bytes of a pair with an edge, and of another one, where nothing is dropped.
const EDGE_BYTES: usize = 4 * 4 + 8 * 17;
const TWO_BYTES: usize = 2 * 4 + 8 * 5;

impl Work for Pairs<'_> {
    type Output = Result<Option<Impulse>, StepError>;

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) -> Self::Output {
        let bodies = self.setting.bodies;
        let particles = bodies.particles();
        while self.place.first < particles {
            let first = self.place.first;
            let pairs = TWO_BYTES * (particles - first + bodies.points.len()) + EDGE_BYTES * bodies.edges.len();
            let mut bytes = self.bytes.take();
            let mut output = Output::new(bytes.as_mut().map(|bytes| bytes.room(pairs)));
            let ends = self.row(simd, &mut output);
            let Output { used, polynomials, largest, found, .. } = output;
            if let Some(bytes) = &mut bytes {
                bytes.added(used, polynomials);
                bytes.raise(largest.max(self.group.largest));
            }
            self.bytes = bytes;
            if ends {
                return found;
            }
            *self.place = Place::of(first + 1);
        }
        Ok(None)
    }
}

impl Pairs<'_> {
    /// What is left of the pairs of one particle. Whether something was found, which the output holds; at a hit the place is the
    /// next pair's.
    #[inline(always)]
    fn row<S: Simd>(&mut self, simd: S, output: &mut Output<'_>) -> bool {
        let first = self.place.first;
        let [particles, edges, half_planes] = self.setting.bodies.objects().row(*self.place);
        if self.particles(simd, first, particles, output) {
            return true;
        }
        if edges.is_empty() && half_planes.is_empty() {
            return false;
        }
        if !self.group.particles.contains(&first) {
            self.group.fill(simd, self.lists, self.setting.bodies, first);
        }
        self.edges(simd, first, edges, output) || self.half_planes(simd, first, half_planes, output)
    }

    /// A particle and these edges, as far as it is no end of them.
    #[inline(always)]
    fn edges<S: Simd>(&mut self, _: S, first: usize, seconds: Range<usize>, output: &mut Output<'_>) -> bool {
        let width = Lanes::<S>::COUNT;
        let lane = first - self.group.particles.start;
        let mut own = self.lists.own_edges(first, seconds.start);
        for edge in seconds {
            if let [skipped, others @ ..] = own
                && *skipped == edge
            {
                own = others;
                continue;
            }
            let numbers = &self.group.edges[edge * OF_EDGE * width..(edge + 1) * OF_EDGE * width];
            let pair = Numbers { numbers, width, lane };
            if pair.settle::<17, 4, EDGE_BYTES>(
                (PairKind::ParticleEdge, [5, 3, 3, 6]),
                [first, edge],
                (self.setting, self.counts, self.place),
                output,
            ) {
                return true;
            }
        }
        false
    }

    /// A particle and these half-planes.
    #[inline(always)]
    fn half_planes<S: Simd>(&mut self, _: S, first: usize, seconds: Range<usize>, output: &mut Output<'_>) -> bool {
        let width = Lanes::<S>::COUNT;
        let lane = first - self.group.particles.start;
        for half_plane in seconds {
            let numbers = &self.group.half_planes[half_plane * OF_TWO * width..(half_plane + 1) * OF_TWO * width];
            let pair = Numbers { numbers, width, lane };
            if pair.settle::<5, 2, TWO_BYTES>(
                (PairKind::ParticleHalfPlane, [3, 2]),
                [first, half_plane],
                (self.setting, self.counts, self.place),
                output,
            ) {
                return true;
            }
        }
        false
    }

    /// A particle and these particles.
    #[inline(always)]
    fn particles<S: Simd>(&mut self, simd: S, first: usize, seconds: Range<usize>, output: &mut Output<'_>) -> bool {
        let width = Lanes::<S>::COUNT;
        let mut numbers = [0.0; OF_TWO * MOST_LANES];
        let mut largest = Lanes::all(simd, 0.0);
        let end = seconds.end;
        for block in seconds.step_by(width) {
            largest = of_particles(simd, self.lists, [first, block], &mut numbers[..OF_TWO * width], largest);
            for lane in 0..width.min(end - block) {
                let pair = Numbers { numbers: &numbers[..OF_TWO * width], width, lane };
                if pair.settle::<5, 2, TWO_BYTES>(
                    (PairKind::ParticleParticle, [3, 2]),
                    [first, block + lane],
                    (self.setting, self.counts, self.place),
                    output,
                ) {
                    output.largest = output.largest.max(largest.largest());
                    return true;
                }
            }
        }
        output.largest = output.largest.max(largest.largest());
        false
    }
}

/// One pair among those of a block.
struct Numbers<'a> {
    /// All numbers of all pairs.
    numbers: &'a [f64],
    /// How many pairs there are.
    width: usize,
    /// Which one is meant.
    lane: usize,
}

impl Numbers<'_> {
    /// Decides about the pair and writes its polynomials: `COUNT` with `lengths` coefficients, which take `BYTES` where none
    /// is dropped. Whether something was found, which the output holds.
    #[inline(always)]
    fn settle<const COEFFICIENTS: usize, const COUNT: usize, const BYTES: usize>(
        &self,
        (kind, lengths): (PairKind, [usize; COUNT]),
        [first, second]: [usize; 2],
        (setting, counts, place): (Setting<'_>, &mut SearchCounts, &mut Place),
        output: &mut Output<'_>,
    ) -> bool {
        let Self { numbers, width, lane } = *self;
        let known = numbers[COEFFICIENTS * width + lane];
        if known == WHOLE || known == TRIMMED {
            counts.calls += 1;
            counts.excluded += 1;
            if output.room.is_none() {
                return false;
            }
        }
        let mut coefficients = [0.0; COEFFICIENTS];
        for (number, coefficient) in coefficients.iter_mut().enumerate() {
            *coefficient = numbers[number * width + lane];
        }
        if known == WHOLE {
            output.write_whole::<COEFFICIENTS, COUNT, BYTES>(&coefficients, lengths);
            return false;
        }
        let open = (known != TRIMMED).then_some((setting, counts, pair(kind, first, second)));
        let ends = match kind {
            PairKind::ParticleEdge => of_edge(&coefficients, open, output),
            PairKind::ParticleParticle | PairKind::ParticleHalfPlane => of_two(&coefficients, open, output),
        };
        if ends {
            *place = Place::behind(kind, first, second);
        }
        ends
    }
}

/// A pair that is still to be decided, with what is needed for it.
type Open<'a> = Option<(Setting<'a>, &'a mut SearchCounts, Pair)>;

/// Decides about a pair of particles, or with a half-plane, if it is open, and writes its polynomials.
#[inline(never)]
fn of_two(coefficients: &[f64], open: Open<'_>, output: &mut Output<'_>) -> bool {
    let Some(all) = coefficients.first_chunk::<5>() else { return false };
    let ends = settle(coefficients, [3, 2], open, output);
    if output.found.is_ok() {
        output.write_two(all);
    }
    ends
}

/// Decides about a pair with an edge, if it is open, and writes its polynomials.
#[inline(never)]
fn of_edge(coefficients: &[f64], open: Open<'_>, output: &mut Output<'_>) -> bool {
    let Some(all) = coefficients.first_chunk::<17>() else { return false };
    let ends = settle(coefficients, [5, 3, 3, 6], open, output);
    if output.found.is_ok() {
        output.write_edge(all);
    }
    ends
}

/// Whether a pair that is open is a hit, or its search has no end; the output holds which.
#[inline(always)]
fn settle<const COUNT: usize>(
    coefficients: &[f64],
    lengths: [usize; COUNT],
    open: Open<'_>,
    output: &mut Output<'_>,
) -> bool {
    let Some((setting, counts, pair)) = open else { return false };
    match decide(setting, counts, pair, coefficients, lengths) {
        Ok(None) => false,
        found => {
            output.found = found;
            true
        }
    }
}
