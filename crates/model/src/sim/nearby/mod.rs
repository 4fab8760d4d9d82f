//! The broad phase finds the pairs that may be closer than the sum of their radii and a margin, without checking all
//! pairs.
//!
//! Particles are sorted into strips by size ([`strips`]); edges, and particles of larger sizes, search for smaller
//! particles in the rectangle that they reach. If particles are spread evenly, the time is proportional to their
//! number. The result is a superset of the nearby pairs, with the same rounding as in the forces, so omitting the other
//! pairs never changes a bit.
mod strips;
#[cfg(test)]
mod tests;

use crate::scene::{Edge, Scene};
use fosssim_num::vector::{Vec2, vector_at};
pub(super) use strips::sort_nearly_sorted;
use strips::{PlacedParticle, Rectangle, Strips};

/// The maximum ratio between the radii of one size class.
const MAX_RADIUS_RATIO: f64 = 4.0;

/// The maximum number of kept pairs per object. With more, nearly all pairs count, and visiting all pairs needs no
/// list.
const MAX_PAIRS_PER_OBJECT: usize = 32;

/// The minimum number of pairs for which a search is worthwhile. With fewer pairs, a check of all pairs is cheaper.
const MIN_PAIRS: usize = 1 << 10;

/// The pairs that may be near each other, with the memory for the next search.
///
/// The copies of radii and edges grow with the number of particles and edges.
#[derive(Debug, Clone)]
pub(super) struct NearbyPairs {
    radii: Vec<f64>,
    /// The particles of each size class, from the largest radii to the smallest.
    size_classes: Vec<Strips>,
    edges: Vec<Edge>,
    margin: f64,
    max_pairs: usize,
    particles: Vec<IndexPair>,
    edge_pairs: Vec<IndexPair>,
    tested_count: u64,
}

/// Two 32-bit numbers in one number. The first is in the high bits, so that lists are sorted by the first.
type IndexPair = u64;

const fn pack_indices(first: u32, second: u32) -> IndexPair {
    (first as u64) << 32 | second as u64
}

/// Returns the first and the second number.
fn unpack_indices(numbers: IndexPair) -> [usize; 2] {
    [(numbers >> 32) as usize, (numbers & u64::from(u32::MAX)) as usize]
}

/// The pairs that were found, particle by particle. All other pairs are at least as far apart as their radii and the
/// margin.
#[derive(Debug)]
pub(super) struct NearRows<'a> {
    particles: &'a [IndexPair],
    edges: &'a [IndexPair],
}

impl<'a> NearRows<'a> {
    /// Returns the later particles, and the edges, near a particle. Must be called for particles in order.
    pub fn next(&mut self, particle: usize) -> [impl Iterator<Item = usize> + use<'a>; 2] {
        [&mut self.particles, &mut self.edges].map(|list| {
            let (own, later) =
                list.split_at(list.iter().take_while(|&&pair| unpack_indices(pair)[0] <= particle).count());
            *list = later;
            own.iter().map(|&pair| unpack_indices(pair)[1])
        })
    }
}

impl NearbyPairs {
    /// Creates the search for the particles and edges of a scene, if it is cheaper than a check of all pairs.
    pub fn for_large_scene(scene: &Scene, margin: f64) -> Option<Self> {
        let particle_count = scene.particles.len();
        (particle_count * (particle_count / 2 + scene.edges.len()) >= MIN_PAIRS).then(|| Self::new(scene, margin))
    }

    /// Creates the search for the particles and edges of a scene.
    pub fn new(scene: &Scene, margin: f64) -> Self {
        let radii: Vec<f64> = scene.particles.iter().map(|particle| particle.radius).collect();
        // A particle whose radius is NaN reaches nothing.
        let numbered = (0..).zip(&radii).filter(|(_, radius)| !radius.is_nan());
        let mut by_size: Vec<(u32, f64)> = numbered.map(|(particle, &radius)| (particle, radius)).collect();
        by_size.sort_by(|one, other| other.1.total_cmp(&one.1));
        let size = |radius: f64| radius + 0.5 * margin.max(0.0);
        let mut sizes = Vec::new();
        let mut rest = &by_size[..];
        while let Some(&(_, largest)) = rest.first() {
            let count = rest.partition_point(|&(_, radius)| !(size(radius) * MAX_RADIUS_RATIO < size(largest)));
            let (own, smaller) = rest.split_at(count.max(1));
            sizes.push(Strips::new(own, margin));
            rest = smaller;
        }
        let max_pairs = MAX_PAIRS_PER_OBJECT * (scene.particles.len() + scene.edges.len());
        let (particles, edge_pairs) = (Vec::new(), Vec::new());
        Self {
            radii,
            size_classes: sizes,
            edges: scene.edges.clone(),
            margin,
            max_pairs,
            particles,
            edge_pairs,
            tested_count: 0,
        }
    }

    /// Finds the pairs at positions `x` (2N). Returns `None` if there are too many to keep; the caller then checks all
    /// pairs.
    pub fn find(&mut self, x: &[f64]) -> Option<NearRows<'_>> {
        let Self {
            radii,
            size_classes: sizes,
            edges,
            margin,
            max_pairs: most,
            particles,
            edge_pairs,
            tested_count: tested,
        } = self;
        particles.clear();
        edge_pairs.clear();
        sizes.iter_mut().for_each(|size| size.update(x));
        let mut keep = |one: &PlacedParticle, other: &PlacedParticle| {
            let [first, second] = [one, other].map(|entry| radii[entry.particle as usize]);
            if !is_beyond(other.position - one.position, (first + second) + *margin) {
                let (one, other) = (one.particle, other.particle);
                particles.push(pack_indices(one.min(other), one.max(other)));
            }
            particles.len() <= *most
        };
        for (index, size) in sizes.iter().enumerate() {
            *tested += size.visit_pairs(&mut keep);
            for smaller in &sizes[index + 1..] {
                for one in size.entries() {
                    let reach = (radii[one.particle as usize] + smaller.radius()) + *margin;
                    if let Some(rectangle) = enclosing_rectangle([one.position; 2], reach) {
                        *tested += smaller.visit_rectangle(rectangle, full_range, |other| keep(one, other));
                    }
                }
            }
        }
        for (index, &edge) in edges.iter().enumerate() {
            for size in sizes.iter() {
                *tested += add_particles_near_edge(size, radii, index, edge, *margin, x, edge_pairs);
            }
            if edge_pairs.len() > *most {
                return None;
            }
        }
        if particles.len() > *most {
            return None;
        }
        particles.sort_unstable();
        edge_pairs.sort_unstable();
        Some(NearRows { particles, edges: edge_pairs })
    }

    /// Returns the number of pairs tested so far, which is the work of all searches.
    #[cfg(test)]
    pub fn tested(&self) -> u64 {
        self.tested_count
    }
}

/// Returns whether the vector is provably not shorter than `reach`, computed without a square root.
///
/// With `s` the rounded `reach * reach`, a rounded squared length above `s` is at least the next number after `s`,
/// hence above the exact square of `reach`; its root is then at least `reach` after rounding too. A negative `reach`
/// is never undercut, and NaN gives `false`.
#[inline]
pub(super) fn is_beyond(n: Vec2, reach: f64) -> bool {
    n.x * n.x + n.y * n.y > reach * reach
}

/// Returns a range that includes every part of a row.
fn full_range(_: [f64; 2]) -> [f64; 2] {
    [f64::NEG_INFINITY, f64::INFINITY]
}

/// Returns slightly more than `reach`, to cover all rounding errors of a vector between two points.
fn widen(reach: f64, positions: [Vec2; 2]) -> f64 {
    let maximum =
        positions.iter().fold(0.0_f64, |maximum, position| maximum.max(position.x.abs()).max(position.y.abs()));
    reach * (1.0 + 1e-9) + maximum * 1e-12 + MIN_REACH
}

/// The minimum reach whose square does not underflow.
const MIN_REACH: f64 = 1e-150;

/// Returns the rectangle of all points that are at most `reach` from the line between two points, or `None` if it is
/// empty.
fn enclosing_rectangle(positions: [Vec2; 2], reach: f64) -> Option<Rectangle> {
    if !(reach > 0.0) {
        return None;
    }
    let [one, other] = positions;
    let room = widen(reach, positions);
    let room = Vec2::new(room, room);
    let low = Vec2::new(one.x.min(other.x), one.y.min(other.y)) - room;
    Some(Rectangle { low, high: Vec2::new(one.x.max(other.x), one.y.max(other.y)) + room })
}

/// Adds the particles of a size class that an edge may reach. Returns the number of checked particles.
fn add_particles_near_edge(
    size: &Strips,
    radii: &[f64],
    index: usize,
    edge: Edge,
    margin: f64,
    x: &[f64],
    found: &mut Vec<IndexPair>,
) -> u64 {
    let ends = [vector_at(x, edge.first), vector_at(x, edge.second)];
    let reach = (size.radius() + edge.radius) + margin;
    let Some(rectangle) = enclosing_rectangle(ends, reach) else { return 0 };
    let [x2, x3] = ends;
    let x32 = x3 - x2;
    let (squared, room) = (x32.dot(&x32), widen(reach, ends));
    // The part of a row that the edge crosses, or the whole row if that is uncertain.
    let narrow = |[low, high]: [f64; 2]| {
        let times = [(low - room - x2.y) / x32.y, (high + room - x2.y) / x32.y].map(|time| time.clamp(0.0, 1.0));
        let [from, to] = times.map(|time| x2.x + time * x32.x);
        if from.is_finite() && to.is_finite() {
            [from.min(to) - 2.0 * room, from.max(to) + 2.0 * room]
        } else {
            [f64::NEG_INFINITY, f64::INFINITY]
        }
    };
    #[expect(clippy::cast_possible_truncation, reason = "a scene with 2^32 objects does not fit into memory")]
    size.visit_rectangle(rectangle, narrow, |entry| {
        let (particle, x1) = (entry.particle, entry.position);
        if edge.first != particle as usize && edge.second != particle as usize {
            // The parameter is computed as in the forces, so a NaN is kept.
            let alpha = ((x1 - x2).dot(&x32) / squared).clamp(0.0, 1.0);
            if !is_beyond((x2 + alpha * x32) - x1, (radii[particle as usize] + edge.radius) + margin) {
                found.push(pack_indices(particle, index as u32));
            }
        }
        true
    })
}
