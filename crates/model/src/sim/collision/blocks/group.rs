//! The pairs of some particles in a row, one per lane, with every edge and every half-plane, and of one particle with some
//! others: coefficients, and what the closed forms of the certificate say about them.
use super::{
    super::{particle_edge, particle_half_plane, particle_particle},
    lists::Lists,
};
use crate::sim::bodies::Bodies;
use fosssim_num::{
    certificate::lanes::{excludes_edge, excludes_two, is_small},
    lanes::{Lanes, Mask, Plane, Simd},
    vector::Vec2,
};
use std::ops::Range;

crate::drops_leading!();

/// Numbers of a pair with an edge: its coefficients, and what is known about it.
pub(super) const OF_EDGE: usize = 18;

/// Numbers of a pair of particles, or with a half-plane.
pub(super) const OF_TWO: usize = 6;

/// What is known about a pair, the last of its numbers: an impact is excluded, and no leading coefficient is small.
pub(super) const WHOLE: f64 = 0.0;

/// An impact is excluded, and a leading coefficient is small and will be dropped.
pub(super) const TRIMMED: f64 = 1.0;

/// The pairs of a group of particles with edges and half-planes. Numbers of one pair lie a lane's width apart.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    /// The particles.
    pub particles: Range<usize>,
    /// The pairs with edges, edge by edge.
    pub edges: Vec<f64>,
    /// The pairs with half-planes.
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
        self.edges.resize(bodies.edges.len() * OF_EDGE * width, 0.0);
        self.half_planes.resize(bodies.points.len() * OF_TWO * width, 0.0);
        let (x, d, radius) = lists.particles(simd, first);
        let mut largest = Lanes::all(simd, 0.0);
        for (edge, numbers) in self.edges.chunks_exact_mut(OF_EDGE * width).enumerate() {
            let motion = lists.edge(simd, edge);
            let sum = radius + Lanes::all(simd, bodies.edge_radii[edge]);
            let pair = particle_edge::coefficients(x, d, &motion, sum);
            let [o0, o1, o2, o3, o4] = pair.distance;
            let [f0, f1, f2] = pair.beyond_first;
            let [s0, s1, s2] = pair.before_second;
            let [a0, a1, a2, a3, a4, a5] = pair.approach;
            let excluded = excludes_edge(pair.distance, pair.beyond_first, pair.before_second, pair.approach);
            let has_small = is_small(o0) | is_small(a0) | is_small(f0) | is_small(s0);
            let known = known(excluded, has_small);
            let all = [o0, o1, o2, o3, o4, f0, f1, f2, s0, s1, s2, a0, a1, a2, a3, a4, a5, known];
            for (lanes, place) in all.iter().zip(numbers.chunks_exact_mut(width)) {
                lanes.store(place);
                largest = largest.max(lanes.abs());
            }
        }
        for (half_plane, numbers) in self.half_planes.chunks_exact_mut(OF_TWO * width).enumerate() {
            let point = all(simd, bodies.points[half_plane]);
            let normal = all(simd, bodies.normals[half_plane]);
            let squared = Lanes::all(simd, lists.squares[half_plane]);
            let (overlap, approach) = particle_half_plane::coefficients(x, d, radius, point, normal, squared);
            largest = store(overlap, approach, numbers, largest);
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
    numbers: &mut [f64],
    largest: Lanes<S>,
) -> Lanes<S> {
    let (x1, d1, r1) = lists.particle(simd, first);
    let (x2, d2, r2) = lists.particles(simd, second);
    let (overlap, approach) = particle_particle::coefficients(x1, d1, x2, d2, r1 + r2);
    store(overlap, approach, numbers, largest)
}

/// Asks the certificate about a parabola and a line with the same leading coefficient, and stores everything.
#[inline(always)]
fn store<S: Simd>(
    overlap: [Lanes<S>; 3],
    approach: [Lanes<S>; 2],
    numbers: &mut [f64],
    mut largest: Lanes<S>,
) -> Lanes<S> {
    let excluded = excludes_two(overlap, approach);
    let ([a, b, c], [d, e]) = (overlap, approach);
    let all = [a, b, c, d, e, known(excluded, is_small(a))];
    for (lanes, place) in all.iter().zip(numbers.chunks_exact_mut(Lanes::<S>::COUNT)) {
        lanes.store(place);
        largest = largest.max(lanes.abs());
    }
    largest
}

/// [`WHOLE`], [`TRIMMED`], or more where the certificate has to be asked.
#[inline(always)]
fn known<S: Simd>(excluded: Mask<S>, has_small: Mask<S>) -> Lanes<S> {
    TRIMMED * has_small.as_numbers() + 2.0 * (!excluded).as_numbers()
}
