//! The pairs that a detection pass checks: their kinds, order and number, and the owner of a logged polynomial
//! (collisions.md 1, trace-format.md 2).
//!
//! This is the only enumeration of a pass. Code that visits the pairs of a particle by kind, to share values between
//! pairs, gets the ranges from [`ObjectCounts::remaining_row`].
use super::pair::{Pair, PairKind, PairKindMap, pair};
use crate::scene::Scene;
use std::{cmp::Ordering, ops::Range};

/// The number of objects of each kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct ObjectCounts {
    /// The number of particles.
    pub particles: usize,
    /// The number of edges.
    pub edges: usize,
    /// The number of half-planes.
    pub half_planes: usize,
}

/// The next pair of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PassCursor {
    /// The index of the particle.
    pub first: usize,
    /// The kind of the second object.
    pub kind: PairKind,
    /// The number of the second object. After the last number, the next kind follows.
    pub second: usize,
}

impl PassCursor {
    /// Returns the first pair whose first object is particle `first`.
    #[inline]
    pub const fn from_first(first: usize) -> Self {
        Self { first, kind: PairKind::ALL[0], second: 0 }
    }

    /// Returns the position after a pair.
    #[inline]
    pub const fn after_pair(kind: PairKind, first: usize, second: usize) -> Self {
        Self { first, kind, second: second + 1 }
    }
}

impl ObjectCounts {
    /// Returns the numbers of the objects that a particle is paired with: all later particles, all edges (but see
    /// [`is_end`]), and all half-planes.
    #[inline]
    fn second_range(self, kind: PairKind, first: usize) -> Range<usize> {
        match kind {
            PairKind::ParticleParticle => first + 1..self.particles,
            PairKind::ParticleEdge => 0..self.edges,
            PairKind::ParticleHalfPlane => 0..self.half_planes,
        }
    }

    /// Returns the rest of a particle's pairs from a position on: for each kind, in the order of the pass, the numbers
    /// of the second objects. The edges include those that end in the particle ([`is_end`]).
    #[inline(always)]
    pub fn remaining_row(self, from: PassCursor) -> [Range<usize>; PairKind::ALL.len()] {
        PairKind::ALL.map(|kind| {
            let Range { start, end } = self.second_range(kind, from.first);
            match kind.cmp(&from.kind) {
                Ordering::Less => end..end,
                Ordering::Equal => start.max(from.second)..end,
                Ordering::Greater => start..end,
            }
        })
    }
}

/// Returns whether a particle is an end of an edge. In this case the two are not a pair.
#[inline]
pub(super) fn is_end(ends: [usize; 2], particle: usize) -> bool {
    ends.contains(&particle)
}

/// The pairs of one pass over a scene.
#[derive(Debug, Clone, Default)]
pub struct Pairs {
    particles: usize,
    /// The endpoints of each edge.
    edges: Vec<[usize; 2]>,
    half_planes: usize,
}

/// Returns the pairs of one pass over a scene.
pub fn pairs(scene: &Scene) -> Pairs {
    let edges = scene.edges.iter().map(|edge| [edge.first, edge.second]).collect();
    Pairs { particles: scene.particles.len(), edges, half_planes: scene.half_planes.len() }
}

impl Pairs {
    /// Returns all pairs in the order of the pass: particle by particle, with all later particles, then with the edges
    /// that do not end in it, then with the half-planes.
    pub fn iter(&self) -> impl Iterator<Item = Pair> + Clone {
        (0..self.particles).flat_map(|particle| self.pairs_of_particle(particle))
    }

    /// Returns the pairs whose first object is particle `first`.
    pub fn pairs_of_particle(&self, first: usize) -> impl Iterator<Item = Pair> + Clone {
        PairKind::ALL.into_iter().zip(self.object_counts().remaining_row(PassCursor::from_first(first))).flat_map(
            move |(kind, seconds)| {
                let is_pair = move |&second: &usize| match kind {
                    PairKind::ParticleEdge => !is_end(self.edges[second], first),
                    PairKind::ParticleParticle | PairKind::ParticleHalfPlane => true,
                };
                seconds.filter(is_pair).map(move |second| pair(kind, first, second))
            },
        )
    }

    fn object_counts(&self) -> ObjectCounts {
        ObjectCounts { particles: self.particles, edges: self.edges.len(), half_planes: self.half_planes }
    }

    /// Returns the number of pairs of each kind.
    pub fn counts(&self) -> PairKindMap<usize> {
        let end_pairs: usize = self.edges.iter().map(|[one, other]| if one == other { 1 } else { 2 }).sum();
        PairKindMap::from_fn(|kind| match kind {
            PairKind::ParticleParticle => self.particles * self.particles.saturating_sub(1) / 2,
            PairKind::ParticleEdge => self.particles * self.edges.len() - end_pairs,
            PairKind::ParticleHalfPlane => self.particles * self.half_planes,
        })
    }

    /// Returns the number of pairs.
    pub fn count(&self) -> usize {
        self.counts().values().sum()
    }

    /// Returns the number of polynomials of a pass, if passes log polynomials.
    pub fn polynomial_count(&self) -> usize {
        self.counts().iter().map(|(kind, count)| kind.polynomial_count() * count).sum()
    }

    /// Returns the owner of polynomial `index` of a step's list: the number of the pass, the pair, and the polynomial's
    /// number within the pair. Returns `None` if passes have no polynomials.
    pub fn locate_polynomial(&self, index: usize) -> Option<(usize, Pair, usize)> {
        let per_pass = self.polynomial_count();
        let (pass, mut rest) = (index.checked_div(per_pass)?, index % per_pass.max(1));
        for particle in 0..self.particles {
            let edge_count = self.edges.iter().filter(|&&ends| !is_end(ends, particle)).count();
            let particle_polynomials = PairKind::ParticleParticle.polynomial_count() * (self.particles - particle - 1)
                + PairKind::ParticleEdge.polynomial_count() * edge_count
                + PairKind::ParticleHalfPlane.polynomial_count() * self.half_planes;
            if let Some(more) = rest.checked_sub(particle_polynomials) {
                rest = more;
                continue;
            }
            for pair in self.pairs_of_particle(particle) {
                match rest.checked_sub(pair.kind.polynomial_count()) {
                    Some(more) => rest = more,
                    None => return Some((pass, pair, rest)),
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene::original,
        sim::{Detection, Observer, Pass, RootSearch, Simulation},
    };

    /// Returns five discs, edges that share ends, and half-planes; far apart, except for two discs that meet.
    fn scene(collision: &str) -> Scene {
        let particle = |x: f64, y: f64, vx: f64| {
            format!("<particle m=\"1\" px=\"{x}\" py=\"{y}\" vx=\"{vx}\" vy=\"0\" fixed=\"0\" radius=\"0.25\"/>")
        };
        let particles: String =
            [(0.0, 0.0, 4.0), (1.0, 0.0, -4.0), (9.0, 9.0, 0.0), (13.0, 9.0, 0.0), (9.0, 20.0, 0.0)]
                .map(|(x, y, vx)| particle(x, y, vx))
                .concat();
        let xml = format!(
            "<scene><duration time=\"0.2\"/><integrator type=\"explicit-euler\" dt=\"0.1\"/>{collision}{particles}\
             <edge i=\"2\" j=\"3\" radius=\"0.1\"/><edge i=\"3\" j=\"4\" radius=\"0.1\"/>\
             <halfplane px=\"0\" py=\"-9\" nx=\"0\" ny=\"1\"/><halfplane px=\"0\" py=\"90\" nx=\"0\" \
                 ny=\"-1\"/></scene>"
        );
        original::read(xml.as_bytes()).expect("a scene").scene
    }

    /// Records the pairs that each pass checked.
    #[derive(Default)]
    struct Looked(Vec<Vec<(Pair, usize)>>);

    impl Observer for Looked {
        fn begin_pass(&mut self, _: Pass) {
            self.0.push(Vec::new());
        }

        fn observe_detection(&mut self, detection: &Detection<'_>) {
            self.0.last_mut().expect("a pass").push((detection.pair, detection.polynomials.len()));
        }
    }

    #[test]
    fn every_pass_looks_at_these_pairs_in_this_order() {
        for collision in [
            "<collision type=\"simple\" COR=\"1\"/>",
            "<collision type=\"continuous-time\" COR=\"1\"/>",
            "<collision type=\"hybrid\" COR=\"1\" maxiters=\"2\" k=\"1\" thickness=\"0.01\"/>",
        ] {
            let scene = scene(collision);
            let expected: Vec<Pair> = pairs(&scene).iter().collect();
            assert_eq!(expected.len(), pairs(&scene).count());
            let mut looked = Looked::default();
            let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
            simulation.step(&mut looked).expect("a step");
            assert!(!looked.0.is_empty());
            for pass in &looked.0 {
                assert_eq!(pass.iter().map(|(pair, _)| *pair).collect::<Vec<_>>(), expected, "{collision}");
                let logged: usize = pass.iter().map(|(_, polynomials)| polynomials).sum();
                assert!(logged == 0 || logged == pairs(&scene).polynomial_count(), "{collision}");
            }
        }
    }

    #[test]
    fn each_polynomial_of_a_step_finds_its_pair() {
        let scene = scene("<collision type=\"continuous-time\"/>");
        let pairs = pairs(&scene);
        // There are ten pairs of discs, fifteen minus four of discs and edges, and ten of discs and half-planes.
        assert_eq!(pairs.counts(), PairKindMap::from([10, 6, 10]));
        assert_eq!(pairs.polynomial_count(), 2 * 10 + 4 * 6 + 2 * 10);
        let mut index = 0;
        for pass in 0..3 {
            for pair in pairs.iter() {
                for number in 0..pair.kind.polynomial_count() {
                    assert_eq!(pairs.locate_polynomial(index), Some((pass, pair, number)));
                    index += 1;
                }
            }
        }
    }

    #[test]
    fn without_pairs_there_is_no_polynomial() {
        let xml = b"<scene><duration time=\"1\"/><integrator type=\"explicit-euler\" dt=\"1\"/></scene>";
        let scene = original::read(xml).expect("a scene").scene;
        let pairs = pairs(&scene);
        assert_eq!((pairs.iter().count(), pairs.polynomial_count(), pairs.locate_polynomial(0)), (0, 0, None));
    }

    #[test]
    fn numbers_lead_back_to_kinds() {
        for (number, kind) in PairKind::ALL.into_iter().enumerate() {
            assert_eq!((kind.index(), PairKind::from_code(kind.code())), (number, Some(kind)));
            assert!(kind.polynomial_count() <= PairKind::MAX_POLYNOMIALS);
        }
        assert_eq!((PairKind::from_code(-1), PairKind::from_code(3)), (None, None));
    }
}
