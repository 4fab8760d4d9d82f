//! The broad phase: finds the pairs that may be closer than their radii and a margin, without checking all pairs.
//!
//! Particles are sorted into strips by size ([`strips`]); edges, and particles of larger sizes, search for smaller
//! particles in the rectangle that they reach. If particles are spread evenly this takes time in proportion to their
//! number. The result is a superset, by the same roundings that the forces make: leaving out the others never changes a
//! bit.
mod strips;
#[cfg(test)]
mod tests;

use crate::scene::{Edge, Scene};
use fosssim_num::vector::{Vec2, at};
use strips::{PlacedParticle, Rectangle, Strips};

/// Radii of one size are at most this many times smaller than the largest of it.
const RANGE: f64 = 4.0;

/// Pairs that are kept, per object. Where there are more, nearly all pairs count, and going through them needs no list.
const MOST_PAIRS: usize = 32;

/// Below this number of pairs a check of all of them is cheaper.
const FEWEST_PAIRS: usize = 1 << 10;

/// The pairs that may be near each other, with the memory for the next search.
///
/// Radii and edges are the scene's; memory grows with the number of particles and edges.
#[derive(Debug, Clone)]
pub(super) struct NearbyPairs {
    radii: Vec<f64>,
    /// By falling size.
    sizes: Vec<Strips>,
    edges: Vec<Edge>,
    margin: f64,
    most: usize,
    particles: Vec<Numbers>,
    edge_pairs: Vec<Numbers>,
    tested: u64,
}

/// Two numbers of 32 bits in the order in which lists are sorted, the first one above.
type Numbers = u64;

const fn numbers(first: u32, second: u32) -> Numbers {
    (first as u64) << 32 | second as u64
}

/// Returns both numbers.
fn differ_by(numbers: Numbers) -> [usize; 2] {
    [(numbers >> 32) as usize, (numbers & u64::from(u32::MAX)) as usize]
}

/// The pairs that were found, particle by particle; all others are at least as far apart as their radii and the margin.
#[derive(Debug)]
pub(super) struct NearRows<'a> {
    particles: &'a [Numbers],
    edges: &'a [Numbers],
}

impl<'a> NearRows<'a> {
    /// Returns the later particles, and the edges, that are near a particle. Called for particles in their order.
    pub fn next(&mut self, particle: usize) -> [impl Iterator<Item = usize> + use<'a>; 2] {
        [&mut self.particles, &mut self.edges].map(|list| {
            let (own, later) = list.split_at(list.iter().take_while(|&&pair| differ_by(pair)[0] <= particle).count());
            *list = later;
            own.iter().map(|&pair| differ_by(pair)[1])
        })
    }
}

impl NearbyPairs {
    /// Creates the search for the particles and edges of a scene, if it is cheaper than checking all of them.
    pub fn for_many(scene: &Scene, margin: f64) -> Option<Self> {
        let particles = scene.particles.len();
        (particles * (particles / 2 + scene.edges.len()) >= FEWEST_PAIRS).then(|| Self::new(scene, margin))
    }

    /// Creates the search for the particles and edges of a scene.
    pub fn new(scene: &Scene, margin: f64) -> Self {
        let radii: Vec<f64> = scene.particles.iter().map(|particle| particle.radius).collect();
        // A particle without a radius reaches nothing.
        let numbered = (0..).zip(&radii).filter(|(_, radius)| !radius.is_nan());
        let mut by_size: Vec<(u32, f64)> = numbered.map(|(particle, &radius)| (particle, radius)).collect();
        by_size.sort_by(|one, other| other.1.total_cmp(&one.1));
        let size = |radius: f64| radius + 0.5 * margin.max(0.0);
        let mut sizes = Vec::new();
        let mut rest = &by_size[..];
        while let Some(&(_, largest)) = rest.first() {
            let count = rest.partition_point(|&(_, radius)| !(size(radius) * RANGE < size(largest)));
            let (own, smaller) = rest.split_at(count.max(1));
            sizes.push(Strips::new(own, margin));
            rest = smaller;
        }
        let most = MOST_PAIRS * (scene.particles.len() + scene.edges.len());
        let (particles, edge_pairs) = (Vec::new(), Vec::new());
        Self { radii, sizes, edges: scene.edges.clone(), margin, most, particles, edge_pairs, tested: 0 }
    }

    /// Finds the pairs at positions `x` (2N). `None` if there are too many to be kept: then the caller checks all.
    pub fn find(&mut self, x: &[f64]) -> Option<NearRows<'_>> {
        let Self { radii, sizes, edges, margin, most, particles, edge_pairs, tested } = self;
        particles.clear();
        edge_pairs.clear();
        sizes.iter_mut().for_each(|size| size.update(x));
        let mut keep = |one: &PlacedParticle, other: &PlacedParticle| {
            let [first, second] = [one, other].map(|entry| radii[entry.particle as usize]);
            if !is_beyond(other.place - one.place, (first + second) + *margin) {
                let (one, other) = (one.particle, other.particle);
                particles.push(numbers(one.min(other), one.max(other)));
            }
            particles.len() <= *most
        };
        for (index, size) in sizes.iter().enumerate() {
            *tested += size.pairs(&mut keep);
            for smaller in &sizes[index + 1..] {
                for one in size.entries() {
                    let reach = (radii[one.particle as usize] + smaller.radius()) + *margin;
                    if let Some(rectangle) = around([one.place; 2], reach) {
                        *tested += smaller.within(rectangle, everywhere, |other| keep(one, other));
                    }
                }
            }
        }
        for (index, &edge) in edges.iter().enumerate() {
            for size in sizes.iter() {
                *tested += near_edge(size, radii, index, edge, *margin, x, edge_pairs);
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

    /// Returns the number of tested pairs so far: the work of all searches.
    #[cfg(test)]
    pub fn tested(&self) -> u64 {
        self.tested
    }
}

/// Returns whether the vector is certainly not shorter than `reach`, without a square root.
///
/// With `s` the rounded `reach * reach`, a rounded squared length above `s` is at least the next number after `s`,
/// hence above the exact square of `reach`; its root is then at least `reach` after rounding too. A negative `reach`
/// is never undercut, and NaN gives `false`.
#[inline]
pub(super) fn is_beyond(n: Vec2, reach: f64) -> bool {
    n.x * n.x + n.y * n.y > reach * reach
}

/// Returns the range that leaves no part of a row out.
fn everywhere(_: [f64; 2]) -> [f64; 2] {
    [f64::NEG_INFINITY, f64::INFINITY]
}

/// Returns a little more than a distance at these places, for all roundings on the way to a vector between them.
fn widen(reach: f64, places: [Vec2; 2]) -> f64 {
    let most = places.iter().fold(0.0_f64, |most, place| most.max(place.x.abs()).max(place.y.abs()));
    reach * (1.0 + 1e-9) + most * 1e-12 + LEAST_REACH
}

/// The squares of smaller lengths may be zero when rounded.
const LEAST_REACH: f64 = 1e-150;

/// Returns all that is not further than `reach` from the line between two places. `None` if nothing is.
fn around(places: [Vec2; 2], reach: f64) -> Option<Rectangle> {
    if !(reach > 0.0) {
        return None;
    }
    let [one, other] = places;
    let room = widen(reach, places);
    let room = Vec2::new(room, room);
    let low = Vec2::new(one.x.min(other.x), one.y.min(other.y)) - room;
    Some(Rectangle { low, high: Vec2::new(one.x.max(other.x), one.y.max(other.y)) + room })
}

/// Adds the particles of a size that an edge may reach.
fn near_edge(
    size: &Strips,
    radii: &[f64],
    index: usize,
    edge: Edge,
    margin: f64,
    x: &[f64],
    found: &mut Vec<Numbers>,
) -> u64 {
    let ends = [at(x, edge.first), at(x, edge.second)];
    let reach = (size.radius() + edge.radius) + margin;
    let Some(rectangle) = around(ends, reach) else { return 0 };
    let [x2, x3] = ends;
    let x32 = x3 - x2;
    let (squared, room) = (x32.dot(&x32), widen(reach, ends));
    // The part of a row that the edge crosses; all of it if that is not known well.
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
    size.within(rectangle, narrow, |entry| {
        let (particle, x1) = (entry.particle, entry.place);
        if edge.first != particle as usize && edge.second != particle as usize {
            // As the forces compute it; NaN is kept.
            let alpha = ((x1 - x2).dot(&x32) / squared).clamp(0.0, 1.0);
            if !is_beyond((x2 + alpha * x32) - x1, (radii[particle as usize] + edge.radius) + margin) {
                found.push(numbers(particle, index as u32));
            }
        }
        true
    })
}
