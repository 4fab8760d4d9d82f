//! The numbers of a pass: one list per number of all particles, for lanes to be loaded from.
use super::{super::particle_edge::EdgeMotions, Setting};
use crate::sim::bodies::Bodies;
use fosssim_num::{
    lanes::{Lanes, MOST_LANES, Plane, Simd},
    tolerances::LANES_LARGEST_INPUT,
    vector::{Vec2, at},
};

/// The lists of a pass.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    /// Positions at the start of the step (x, y), displacements (x, y) and radii of particles, with as many entries
    /// behind the last one as lanes may reach; these repeat it.
    particles: [Vec<f64>; 5],
    /// The squared lengths of half-planes' normals.
    pub squares: Vec<f64>,
    /// For each particle the edges that end in it, ascending.
    own_edges: Vec<Vec<usize>>,
    /// Whether what does not change is moderate.
    has_moderate_constants: bool,
}

/// Two vectors and a number per lane.
type Five<S> = (Plane<Lanes<S>>, Plane<Lanes<S>>, Lanes<S>);

impl Lists {
    /// Fills all lists; false if an input is too large or no number.
    pub fn prepare(&mut self, setting: Setting<'_>) -> bool {
        let Setting { bodies, q_start, displacements, .. } = setting;
        // Even an empty list has entries behind its end.
        if self.particles[4].is_empty() {
            self.constants(bodies);
        }
        let [x, y, dx, dy, _] = &mut self.particles;
        for ((start, shift), (((x, y), dx), dy)) in
            (q_start.as_chunks::<2>().0.iter().zip(displacements.as_chunks::<2>().0))
                .zip(x.iter_mut().zip(y).zip(dx).zip(dy))
        {
            (*x, *y, *dx, *dy) = (start[0], start[1], shift[0], shift[1]);
        }
        let count = bodies.particles();
        for list in &mut self.particles[..4] {
            if let [.., last] = list[..count] {
                list[count..].fill(last);
            }
        }
        self.has_moderate_constants && are_moderate(q_start) && are_moderate(displacements)
    }

    /// Takes over the displacements of these particles; false as in [`Lists::prepare`].
    pub fn refresh(&mut self, setting: Setting<'_>, moved: [usize; 3]) -> bool {
        let count = setting.bodies.particles();
        moved.into_iter().all(|particle| {
            let shift = at(setting.displacements, particle);
            for (list, value) in self.particles[2..4].iter_mut().zip([shift.x, shift.y]) {
                list[particle] = value;
                if particle + 1 == count {
                    list[count..].fill(value);
                }
            }
            are_moderate(&[shift.x, shift.y])
        })
    }

    /// Fills the lists of values that do not change while the scene is simulated.
    fn constants(&mut self, bodies: &Bodies) {
        let count = bodies.particles();
        self.own_edges = vec![Vec::new(); count];
        for (edge, ends) in bodies.edges.iter().enumerate() {
            for &end in ends {
                // An edge may end twice in one particle.
                if self.own_edges[end].last() != Some(&edge) {
                    self.own_edges[end].push(edge);
                }
            }
        }
        self.particles = std::array::from_fn(|_| vec![0.0; count + MOST_LANES]);
        self.particles[4][..count].copy_from_slice(&bodies.radii);
        self.squares = bodies.normals.iter().map(|normal| normal.dot(normal)).collect();
        let vectors = bodies.points.iter().chain(&bodies.normals);
        self.has_moderate_constants = are_moderate(&bodies.radii)
            && are_moderate(&bodies.edge_radii)
            && vectors.into_iter().all(|vector: &Vec2| are_moderate(&[vector.x, vector.y]));
    }

    /// Edges that end in a particle, from number `from` on.
    #[inline]
    pub fn own_edges(&self, particle: usize, from: usize) -> &[usize] {
        let own = &self.own_edges[particle];
        &own[own.partition_point(|&edge| edge < from)..]
    }

    /// Position, displacement and radius of one particle, in all lanes.
    #[inline(always)]
    pub fn particle<S: Simd>(&self, simd: S, index: usize) -> Five<S> {
        let [x, y, dx, dy, radius] = &self.particles;
        let position = Plane { x: Lanes::all(simd, x[index]), y: Lanes::all(simd, y[index]) };
        let displacement = Plane { x: Lanes::all(simd, dx[index]), y: Lanes::all(simd, dy[index]) };
        (position, displacement, Lanes::all(simd, radius[index]))
    }

    /// The same of the particles from `first` on.
    #[inline(always)]
    pub fn particles<S: Simd>(&self, simd: S, first: usize) -> Five<S> {
        let [x, y, dx, dy, radius] = &self.particles;
        let position = Plane { x: Lanes::load(simd, &x[first..]), y: Lanes::load(simd, &y[first..]) };
        let displacement = Plane { x: Lanes::load(simd, &dx[first..]), y: Lanes::load(simd, &dy[first..]) };
        (position, displacement, Lanes::load(simd, &radius[first..]))
    }

    /// The motion of an edge with these ends, in all lanes.
    #[inline(always)]
    pub fn edge<S: Simd>(&self, simd: S, [first, second]: [usize; 2]) -> EdgeMotions<Lanes<S>> {
        let ((x2, d2, _), (x3, d3, _)) = (self.particle(simd, first), self.particle(simd, second));
        EdgeMotions::new(x2, d2, x3, d3)
    }
}

/// Whether all are numbers that are not too large.
fn are_moderate(numbers: &[f64]) -> bool {
    numbers.iter().fold(true, |all, number| all & (number.abs() <= LANES_LARGEST_INPUT))
}
