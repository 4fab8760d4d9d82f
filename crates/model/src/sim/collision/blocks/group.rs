//! Computes coefficients, and the results of the certificate's closed forms, for blocks of pairs. A block has several
//! consecutive particles, one per lane, with every edge and every half-plane, or one particle with several others or
//! several edges.
use super::{
    super::{
        particle_edge::{self, EdgePolynomials},
        particle_half_plane, particle_particle,
    },
    lists::Lists,
};
use crate::sim::bodies::Bodies;
use fosssim_num::{
    certificate::lanes::{excludes_edge, excludes_two_polynomials, is_small, search_terminates},
    lanes::{Lanes, Plane, Simd},
    vector::Vec2,
};
use std::ops::Range;

crate::drops_leading!();

/// The length of the row of a pair with an edge: its coefficients, the known facts ([`OPEN_BIT`]), and padding.
pub(super) const EDGE_ROW_LENGTH: usize = 20;

/// The index of the known facts in the row of a pair with an edge.
pub(super) const EDGE_FACTS_INDEX: usize = 17;

/// The length of the row of a pair of particles, or of a pair with a half-plane: the parabola's coefficients, the known
/// facts, the line's coefficients, and padding. A row is read soon after it is stored, which is fast if it is read in
/// the same pieces.
pub(super) const SHORT_ROW_LENGTH: usize = 8;

/// The index of the facts in the row.
pub(super) const FACTS_INDEX: usize = 3;

/// The index at which the line begins.
pub(super) const LINE_INDEX: usize = 4;

/// The number of entries after a row that may be read, whatever their values are: the number of coefficients of a
/// polynomial, plus two.
pub(super) const ROW_PADDING: usize = 8;

/// The bit that marks an open pair in the number of facts. It is the lowest bit, and is set if the certificate must
/// decide whether there is an impact. The next bits mark coefficients that are small enough to be dropped when they
/// lead. The highest bits are unused.
pub(super) const OPEN_BIT: u64 = 1;

/// 2^52: after small powers of two are added, their sum is in the lowest bits of the mantissa.
const BIT_SUM_BASE: f64 = (1_u64 << 52) as f64;

/// The pairs of a group of particles with edges and half-planes, as rows of numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct PairGroup {
    /// The group's particles.
    pub particles: Range<usize>,
    /// The pairs with edges, edge by edge, and for each edge particle by particle, with room for the lanes that reach
    /// beyond the last edge.
    pub edges: Vec<f64>,
    /// The pairs with half-planes, in the same order.
    pub half_planes: Vec<f64>,
    /// The largest absolute value of a coefficient.
    pub largest_modulus: f64,
    /// A bit mask of the particles that a response has moved since their pairs were computed.
    moved_particles: u32,
    /// Whether a response has moved an edge in this pass. A second response would then invalidate the results of other
    /// particles.
    has_moved_edges: bool,
}

impl PairGroup {
    /// Removes all pairs, at the start of a pass.
    pub fn clear(&mut self) {
        self.particles = 0..0;
        self.has_moved_edges = false;
    }

    /// Removes the pairs that depend on a particle that a response has moved; all pairs if it is the end of an edge.
    pub fn invalidate(&mut self, particle: usize, is_end: bool) {
        if is_end {
            self.particles = 0..0;
            self.has_moved_edges = true;
        } else if self.particles.contains(&particle) {
            self.moved_particles |= 1 << (particle - self.particles.start);
        }
    }

    /// Ensures that the pairs of a particle with half-planes, and with edges from `edge` on, are computed.
    #[inline(always)]
    pub fn ensure_computed<S: Simd>(&mut self, simd: S, lists: &Lists, bodies: &Bodies, first: usize, edge: usize) {
        let width = Lanes::<S>::COUNT;
        let edge_count = bodies.edges.len();
        let mut largest = Lanes::splat(simd, 0.0);
        let is_alone = if self.particles.contains(&first) {
            let lane = 1 << (first - self.particles.start);
            if self.moved_particles & lane == 0 {
                return;
            }
            self.moved_particles &= !lane;
            largest = Lanes::splat(simd, self.largest_modulus);
            true
        } else {
            self.particles = first..first + if self.has_moved_edges { 1 } else { width };
            self.moved_particles = 0;
            self.edges.resize((edge_count + width) * EDGE_ROW_LENGTH * width + ROW_PADDING, 0.0);
            self.half_planes.resize(bodies.points.len() * SHORT_ROW_LENGTH * width, 0.0);
            self.has_moved_edges
        };
        if is_alone {
            largest = self.compute_edges(simd, lists, first, edge..edge_count, largest);
        } else {
            for edge in 0..edge_count {
                largest = self.compute_edge(simd, lists, bodies, edge, largest);
            }
        }
        self.largest_modulus = self.compute_half_planes(simd, lists, bodies, largest).largest();
    }

    /// Computes the pairs of all particles with one edge. Returns the largest absolute values so far.
    #[inline(always)]
    fn compute_edge<S: Simd>(
        &mut self,
        simd: S,
        lists: &Lists,
        bodies: &Bodies,
        edge: usize,
        largest: Lanes<S>,
    ) -> Lanes<S> {
        let (x, d, radius) = lists.particles(simd, self.particles.start);
        let motion = lists.edge(simd, bodies.edges[edge]);
        let pair = particle_edge::coefficients(x, d, &motion, radius + Lanes::splat(simd, bodies.edge_radii[edge]));
        let begin = edge * EDGE_ROW_LENGTH * Lanes::<S>::COUNT;
        store_edges(simd, &pair, EDGE_ROW_LENGTH, &mut self.edges[begin..], largest)
    }

    /// Computes the pairs of one particle with several edges.
    #[inline(always)]
    fn compute_edges<S: Simd>(
        &mut self,
        simd: S,
        lists: &Lists,
        first: usize,
        edges: Range<usize>,
        mut largest: Lanes<S>,
    ) -> Lanes<S> {
        let width = Lanes::<S>::COUNT;
        let (x, d, radius) = lists.particle(simd, first);
        let lane = first - self.particles.start;
        let mut edge = edges.start;
        while edge < edges.end {
            let (motions, edge_radii) = lists.edges(simd, edge);
            let pair = particle_edge::coefficients(x, d, &motions, radius + edge_radii);
            let begin = (edge * width + lane) * EDGE_ROW_LENGTH;
            largest = store_edges(simd, &pair, EDGE_ROW_LENGTH * width, &mut self.edges[begin..], largest);
            edge += width;
        }
        largest
    }

    /// Computes the pairs of all particles with all half-planes.
    #[inline(always)]
    fn compute_half_planes<S: Simd>(
        &mut self,
        simd: S,
        lists: &Lists,
        bodies: &Bodies,
        mut largest: Lanes<S>,
    ) -> Lanes<S> {
        let (x, d, radius) = lists.particles(simd, self.particles.start);
        for (half_plane, rows) in self.half_planes.chunks_exact_mut(SHORT_ROW_LENGTH * Lanes::<S>::COUNT).enumerate() {
            let point = splat_plane(simd, bodies.points[half_plane]);
            let normal = splat_plane(simd, bodies.normals[half_plane]);
            let squared = Lanes::splat(simd, lists.squares[half_plane]);
            let (overlap, approach) = particle_half_plane::coefficients(x, d, radius, point, normal, squared);
            largest = store_short_rows(simd, overlap, approach, rows, largest);
        }
        largest
    }
}

/// Returns the vector with its components copied to all lanes.
#[inline(always)]
fn splat_plane<S: Simd>(simd: S, vector: Vec2) -> Plane<Lanes<S>> {
    Plane { x: Lanes::splat(simd, vector.x), y: Lanes::splat(simd, vector.y) }
}

/// Computes the pairs of a particle with the particles from `second` on. Returns the largest absolute values so far.
#[inline(always)]
pub(super) fn compute_particles<S: Simd>(
    simd: S,
    lists: &Lists,
    [first, second]: [usize; 2],
    rows: &mut [f64],
    largest: Lanes<S>,
) -> Lanes<S> {
    let (x1, d1, r1) = lists.particle(simd, first);
    let (x2, d2, r2) = lists.particles(simd, second);
    let (overlap, approach) = particle_particle::coefficients(x1, d1, x2, d2, r1 + r2);
    store_short_rows(simd, overlap, approach, rows, largest)
}

/// Applies the certificate to pairs with edges, and stores the rows. The rows of two lanes are `stride` apart. Returns
/// the largest absolute values so far.
#[inline(always)]
fn store_edges<S: Simd>(
    simd: S,
    pair: &EdgePolynomials<Lanes<S>>,
    stride: usize,
    rows: &mut [f64],
    mut largest: Lanes<S>,
) -> Lanes<S> {
    let EdgePolynomials { distance, beyond_first, before_second, approach } = *pair;
    let ([o0, o1, o2, o3, o4], [a0, a1, a2, a3, a4, a5]) = (distance, approach);
    let ([f0, f1, f2], [s0, s1, s2]) = (beyond_first, before_second);
    // Code that needs all numbers precedes code with branches, across which few numbers stay in registers.
    let all = [o0, o1, o2, o3, o4, f0, f1, f2, s0, s1, s2, a0, a1, a2, a3, a4, a5];
    let small = small_coefficient_bits(simd, &all);
    for lanes in &all {
        largest = largest.max(lanes.abs());
    }
    let ends = search_terminates(&distance) & search_terminates(&approach);
    let fours = [[o0, o1, o2, o3], [o4, f0, f1, f2], [s0, s1, s2, a0], [a1, a2, a3, a4]];
    Lanes::store_by_lane(&fours, stride, rows);
    let facts = small + (!excludes_edge(ends, distance, beyond_first, before_second, approach)).select_or_zero(1.0);
    Lanes::store_by_lane(&[[a5, facts, facts, facts]], stride, &mut rows[16..]);
    largest
}

/// Applies the certificate to a parabola and a line, and stores the rows.
#[inline(always)]
fn store_short_rows<S: Simd>(
    simd: S,
    overlap: [Lanes<S>; 3],
    approach: [Lanes<S>; 2],
    rows: &mut [f64],
    mut largest: Lanes<S>,
) -> Lanes<S> {
    let excluded = excludes_two_polynomials(overlap, approach);
    let ([a, b, c], [d, e]) = (overlap, approach);
    let all = [a, b, c, d, e];
    let facts = small_coefficient_bits(simd, &all) + (!excluded).select_or_zero(1.0);
    for lanes in &all {
        largest = largest.max(lanes.abs());
    }
    Lanes::store_by_lane(&[[a, b, c, facts], [d, e, d, e]], SHORT_ROW_LENGTH, rows);
    largest
}

/// Returns the bits of small coefficients; see [`OPEN_BIT`].
#[inline(always)]
fn small_coefficient_bits<S: Simd, const COEFFICIENTS: usize>(simd: S, all: &[Lanes<S>; COEFFICIENTS]) -> Lanes<S> {
    let mut facts = Lanes::splat(simd, BIT_SUM_BASE);
    for (number, coefficient) in all.iter().enumerate() {
        facts = facts + is_small(*coefficient).select_or_zero(f64::from(2_u32 << number));
    }
    facts
}
