//! The pairs of some particles in a row, one per lane, with every edge and every half-plane, and of one particle with
//! some others: coefficients, and what the closed forms of the certificate say about them.
use super::{
    super::{particle_edge, particle_half_plane, particle_particle},
    lists::Lists,
};
use crate::sim::bodies::Bodies;
use fosssim_num::{
    certificate::lanes::{excludes_edge, excludes_two, is_small, search_ends},
    lanes::{Lanes, Plane, Simd},
    vector::Vec2,
};
use std::ops::Range;

crate::drops_leading!();

/// Numbers of a pair with an edge: its coefficients, what is known about it ([`OPEN`]), and room.
pub(super) const EDGE_ROW: usize = 20;

/// Where what is known about it stands.
pub(super) const EDGE_KNOWN: usize = 17;

/// Numbers of a pair of particles, or with a half-plane: the parabola's coefficients, what is known, the line's, and
/// room. A polynomial is read soon after it is stored, which is fast where both are done at once.
pub(super) const TWO_ROW: usize = 8;

/// Where what is known about it stands.
pub(super) const TWO_KNOWN: usize = 3;

/// Where the line begins.
pub(super) const LINE: usize = 4;

/// Numbers behind a row that may be read, too, whatever their values: as many as a polynomial has coefficients, and two
/// more.
pub(super) const BEHIND: usize = 8;

/// Facts about a pair, in the bits of a number: the lowest one is this where the certificate has to be asked
/// whether there is an impact; the next ones say which of its coefficients are so small that they are dropped when they
/// lead; the highest ones say nothing.
pub(super) const OPEN: u64 = 1;

/// The lowest bits of this number plus a sum of small powers of two are that sum.
const NOTHING: f64 = (1_u64 << 52) as f64;

/// The pairs of a group of particles with edges and half-planes: rows of numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    /// The particles.
    pub particles: Range<usize>,
    /// The pairs with edges, edge by edge, and for each of these particle by particle.
    pub edges: Vec<f64>,
    /// The pairs with half-planes, likewise.
    pub half_planes: Vec<f64>,
    /// No coefficient has a larger modulus.
    pub largest: f64,
}

impl Group {
    /// Forgets all pairs.
    pub fn clear(&mut self) {
        self.particles = 0..0;
    }

    /// Computes the pairs of the particles from `first` on.
    #[inline(always)]
    pub fn fill<S: Simd>(&mut self, simd: S, lists: &Lists, bodies: &Bodies, first: usize) {
        let width = Lanes::<S>::COUNT;
        self.particles = first..first + width;
        self.edges.resize(bodies.edges.len() * EDGE_ROW * width + BEHIND, 0.0);
        self.half_planes.resize(bodies.points.len() * TWO_ROW * width, 0.0);
        let (x, d, radius) = lists.particles(simd, first);
        let mut largest = Lanes::all(simd, 0.0);
        for (edge, rows) in self.edges.chunks_exact_mut(EDGE_ROW * width).enumerate() {
            let motion = lists.edge(simd, bodies.edges[edge]);
            let sum = radius + Lanes::all(simd, bodies.edge_radii[edge]);
            let pair = particle_edge::coefficients(x, d, &motion, sum);
            let [o0, o1, o2, o3, o4] = pair.distance;
            let [f0, f1, f2] = pair.beyond_first;
            let [s0, s1, s2] = pair.before_second;
            let [a0, a1, a2, a3, a4, a5] = pair.approach;
            // Code that needs all of them comes before code with branches, across which few numbers can be kept at
            // hand.
            let all = [o0, o1, o2, o3, o4, f0, f1, f2, s0, s1, s2, a0, a1, a2, a3, a4, a5];
            let small = small(simd, &all);
            for lanes in &all {
                largest = largest.max(lanes.abs());
            }
            let ends = search_ends(&pair.distance) & search_ends(&pair.approach);
            let fours = [[o0, o1, o2, o3], [o4, f0, f1, f2], [s0, s1, s2, a0], [a1, a2, a3, a4]];
            Lanes::store_by_lane(&fours, EDGE_ROW, rows);
            let excluded = excludes_edge(ends, pair.distance, pair.beyond_first, pair.before_second, pair.approach);
            let known = small + (!excluded).as_numbers();
            Lanes::store_by_lane(&[[a5, known, known, known]], EDGE_ROW, &mut rows[16..]);
        }
        for (half_plane, rows) in self.half_planes.chunks_exact_mut(TWO_ROW * width).enumerate() {
            let point = all(simd, bodies.points[half_plane]);
            let normal = all(simd, bodies.normals[half_plane]);
            let squared = Lanes::all(simd, lists.squares[half_plane]);
            let (overlap, approach) = particle_half_plane::coefficients(x, d, radius, point, normal, squared);
            largest = store(simd, overlap, approach, rows, largest);
        }
        self.largest = largest.largest();
    }
}

/// A vector in all lanes.
#[inline(always)]
fn all<S: Simd>(simd: S, vector: Vec2) -> Plane<Lanes<S>> {
    Plane { x: Lanes::all(simd, vector.x), y: Lanes::all(simd, vector.y) }
}

/// Computes the pairs of a particle with the particles from `second` on; gives the largest moduli so far.
#[inline(always)]
pub(super) fn of_particles<S: Simd>(
    simd: S,
    lists: &Lists,
    [first, second]: [usize; 2],
    rows: &mut [f64],
    largest: Lanes<S>,
) -> Lanes<S> {
    let (x1, d1, r1) = lists.particle(simd, first);
    let (x2, d2, r2) = lists.particles(simd, second);
    let (overlap, approach) = particle_particle::coefficients(x1, d1, x2, d2, r1 + r2);
    store(simd, overlap, approach, rows, largest)
}

/// Asks the certificate about a parabola and a line, and stores everything.
#[inline(always)]
fn store<S: Simd>(
    simd: S,
    overlap: [Lanes<S>; 3],
    approach: [Lanes<S>; 2],
    rows: &mut [f64],
    mut largest: Lanes<S>,
) -> Lanes<S> {
    let excluded = excludes_two(overlap, approach);
    let ([a, b, c], [d, e]) = (overlap, approach);
    let all = [a, b, c, d, e];
    let known = small(simd, &all) + (!excluded).as_numbers();
    for lanes in &all {
        largest = largest.max(lanes.abs());
    }
    Lanes::store_by_lane(&[[a, b, c, known], [d, e, d, e]], TWO_ROW, rows);
    largest
}

/// Which coefficients are small: see [`OPEN`].
#[inline(always)]
fn small<S: Simd, const COEFFICIENTS: usize>(simd: S, all: &[Lanes<S>; COEFFICIENTS]) -> Lanes<S> {
    let mut known = Lanes::all(simd, NOTHING);
    for (number, coefficient) in all.iter().enumerate() {
        known = known + is_small(*coefficient).or_zero(f64::from(2_u32 << number));
    }
    known
}
