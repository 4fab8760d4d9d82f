//! The numbers of a pass: one list per quantity of all particles, from which lanes are loaded.
use super::{super::particle_edge::EdgeMotions, PassInput};
use crate::sim::bodies::Bodies;
use fosssim_num::{
    lanes::{Lanes, MAX_LANES, Plane, Simd},
    tolerances::LANES_MAX_INPUT,
    vector::{Vec2, vector_at},
};

/// The lists of a pass.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    /// The start positions (x, y), displacements (x, y) and radii of particles. The last entry is repeated as often as
    /// lanes may reach beyond the end.
    particles: [Vec<f64>; 5],
    /// The edges' coordinates: starts and displacements of first and second ends, and radii.
    edges: [Vec<f64>; 9],
    /// Whether the edges' lists are filled in this pass; they are needed only after a response has moved bodies.
    has_edges: bool,
    /// The squared lengths of the half-planes' normals.
    pub squares: Vec<f64>,
    /// The edges that end in each particle, ascending.
    particle_edges: Vec<Vec<usize>>,
    /// Whether the constants are moderate.
    has_moderate_constants: bool,
}

/// The effect of a response on the lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RefreshResult {
    /// The particle's end position is the same, bit for bit.
    Same,
    /// The particle's end position has changed.
    Moved {
        /// Whether an edge ends in the particle.
        is_end: bool,
    },
    /// The displacement is too large for lanes, or NaN.
    TooLarge,
}

/// The position, displacement and radius of one particle per lane.
type MotionLanes<S> = (Plane<Lanes<S>>, Plane<Lanes<S>>, Lanes<S>);

impl Lists {
    /// Fills all lists. Returns false if an input is too large or NaN.
    pub fn prepare(&mut self, input: PassInput<'_>) -> bool {
        let PassInput { bodies, q_start, displacements, .. } = input;
        // Even an empty list has padding after its end.
        if self.particles[4].is_empty() {
            self.fill_constants(bodies);
        }
        let [x, y, dx, dy, _] = &mut self.particles;
        for ((start, shift), (((x, y), dx), dy)) in
            (q_start.as_chunks::<2>().0.iter().zip(displacements.as_chunks::<2>().0))
                .zip(x.iter_mut().zip(y).zip(dx).zip(dy))
        {
            (*x, *y, *dx, *dy) = (start[0], start[1], shift[0], shift[1]);
        }
        repeat_last(&mut self.particles[..4], bodies.particle_count());
        self.has_edges = false;
        self.has_moderate_constants && are_moderate(q_start) && are_moderate(displacements)
    }

    /// Copies the current displacement of a particle.
    pub fn refresh(&mut self, input: PassInput<'_>, particle: usize) -> RefreshResult {
        let PassInput { bodies, displacements, .. } = input;
        let shift = vector_at(displacements, particle);
        let [_, _, dx, dy, _] = &self.particles;
        if [dx[particle], dy[particle]].map(f64::to_bits) == [shift.x, shift.y].map(f64::to_bits) {
            return RefreshResult::Same;
        }
        if !are_moderate(&[shift.x, shift.y]) {
            return RefreshResult::TooLarge;
        }
        store_vector(&mut self.particles[2..4], particle, bodies.particle_count(), shift);
        if std::mem::replace(&mut self.has_edges, true) {
            for &edge in &self.particle_edges[particle] {
                for (end, lists) in self.edges.chunks_exact_mut(4).enumerate() {
                    if bodies.edges[edge][end] == particle {
                        store_vector(&mut lists[2..4], edge, bodies.edges.len(), shift);
                    }
                }
            }
        } else {
            for (end, lists) in self.edges.chunks_exact_mut(4).enumerate() {
                for (list, particle_values) in lists.iter_mut().zip(&self.particles) {
                    for (entry, ends) in list.iter_mut().zip(&bodies.edges) {
                        *entry = particle_values[ends[end]];
                    }
                }
            }
            repeat_last(&mut self.edges[..8], bodies.edges.len());
        }
        RefreshResult::Moved { is_end: !self.particle_edges[particle].is_empty() }
    }

    /// Fills the lists of values that do not change while the scene is simulated.
    fn fill_constants(&mut self, bodies: &Bodies) {
        let (count, edges) = (bodies.particle_count(), bodies.edges.len());
        self.particle_edges = vec![Vec::new(); count];
        for (edge, ends) in bodies.edges.iter().enumerate() {
            for &end in ends {
                // Both ends of an edge may be the same particle.
                if self.particle_edges[end].last() != Some(&edge) {
                    self.particle_edges[end].push(edge);
                }
            }
        }
        self.particles = std::array::from_fn(|_| vec![0.0; count + MAX_LANES]);
        self.particles[4][..count].copy_from_slice(&bodies.radii);
        self.edges = std::array::from_fn(|_| vec![0.0; edges + MAX_LANES]);
        self.edges[8][..edges].copy_from_slice(&bodies.edge_radii);
        self.squares = bodies.normals.iter().map(|normal| normal.dot(normal)).collect();
        let vectors = bodies.points.iter().chain(&bodies.normals);
        self.has_moderate_constants = are_moderate(&bodies.radii)
            && are_moderate(&bodies.edge_radii)
            && vectors.into_iter().all(|vector: &Vec2| are_moderate(&[vector.x, vector.y]));
    }

    /// Returns the edges that end in a particle, from number `from` on.
    #[inline]
    pub fn edges_from(&self, particle: usize, from: usize) -> &[usize] {
        let own = &self.particle_edges[particle];
        &own[own.partition_point(|&edge| edge < from)..]
    }

    /// Returns the position, displacement and radius of one particle, in all lanes.
    #[inline(always)]
    pub fn particle<S: Simd>(&self, simd: S, index: usize) -> MotionLanes<S> {
        let [x, y, dx, dy, radius] = &self.particles;
        let position = Plane { x: Lanes::splat(simd, x[index]), y: Lanes::splat(simd, y[index]) };
        let displacement = Plane { x: Lanes::splat(simd, dx[index]), y: Lanes::splat(simd, dy[index]) };
        (position, displacement, Lanes::splat(simd, radius[index]))
    }

    /// Returns the motions of the particles from `first` on.
    #[inline(always)]
    pub fn particles<S: Simd>(&self, simd: S, first: usize) -> MotionLanes<S> {
        let [x, y, dx, dy, radius] = &self.particles;
        (load_plane(simd, x, y, first), load_plane(simd, dx, dy, first), Lanes::load(simd, &radius[first..]))
    }

    /// Returns the motions and radii of the edges from `first` on.
    #[inline(always)]
    pub fn edges<S: Simd>(&self, simd: S, first: usize) -> (EdgeMotions<Lanes<S>>, Lanes<S>) {
        let [x2, y2, dx2, dy2, x3, y3, dx3, dy3, radius] = &self.edges;
        let (x2, d2) = (load_plane(simd, x2, y2, first), load_plane(simd, dx2, dy2, first));
        let (x3, d3) = (load_plane(simd, x3, y3, first), load_plane(simd, dx3, dy3, first));
        (EdgeMotions::new(x2, d2, x3, d3), Lanes::load(simd, &radius[first..]))
    }

    /// Returns the motion of the edge with two given ends, in all lanes.
    #[inline(always)]
    pub fn edge<S: Simd>(&self, simd: S, [first, second]: [usize; 2]) -> EdgeMotions<Lanes<S>> {
        let ((x2, d2, _), (x3, d3, _)) = (self.particle(simd, first), self.particle(simd, second));
        EdgeMotions::new(x2, d2, x3, d3)
    }
}

/// Loads the vectors that begin at index `first` from the arrays `x` and `y`.
#[inline(always)]
fn load_plane<S: Simd>(simd: S, x: &[f64], y: &[f64], first: usize) -> Plane<Lanes<S>> {
    Plane { x: Lanes::load(simd, &x[first..]), y: Lanes::load(simd, &y[first..]) }
}

/// Fills the entries after the first `count` with the last of them.
fn repeat_last(lists: &mut [Vec<f64>], count: usize) {
    for list in lists {
        if let [.., last] = list[..count] {
            list[count..].fill(last);
        }
    }
}

/// Writes a vector into entry `index` of two lists with `count` entries; the last entry is repeated after them.
fn store_vector(lists: &mut [Vec<f64>], index: usize, count: usize, vector: Vec2) {
    for (list, value) in lists.iter_mut().zip([vector.x, vector.y]) {
        let end = if index + 1 == count { list.len() } else { index + 1 };
        list[index..end].fill(value);
    }
}

/// Returns whether all numbers are finite and not too large.
fn are_moderate(numbers: &[f64]) -> bool {
    numbers.iter().fold(true, |all, number| all & (number.abs() <= LANES_MAX_INPUT))
}
