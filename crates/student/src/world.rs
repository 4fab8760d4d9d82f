//! The world of a step: the data that stay constant, the pairs that detection checks, and the log.
use fosssim_model::scene::Scene;
use fosssim_num::{
    polynomial::Polynomial,
    vector::{Vec2, set_vector, vector_at},
};

use std::sync::Arc;

use super::{
    Mistake, Slip, Term,
    author::Student,
    objects::{Contact, Object, Pair, State},
};

/// The data that stay constant during a run. Programs of many students share a scene. No program stores the list of its
/// pairs, because that list has millions of entries in a large scene.
pub struct World {
    /// The scene as loaded.
    pub scene: Arc<Scene>,
    /// The author of this program, who determines its mistakes.
    pub student: Student,
    /// The mass of each particle twice, in the order of the state.
    pub masses: Arc<[f64]>,
}

/// The log of a step for the trace.
#[derive(Clone, Default)]
pub struct StepLog<'a> {
    /// The impulses, in the order in which they were applied.
    pub impulses: Vec<Contact>,
    /// The polynomials passed to the root finder, in order.
    pub polynomials: Vec<Polynomial>,
    /// The guard that receives each polynomial as it is logged, with its index, before the search for its roots.
    pub guard: Option<StepGuard<'a>>,
    /// The work that the polynomials' number does not show: the steps of root searches beyond the usual number, and the
    /// solutions of linear systems.
    pub long_searches: u64,
    /// The positions that the integrator predicted. They are set when the impulse rounds start, and removed when the
    /// impact zones are handled.
    pub prediction: Option<Vec<f64>>,
}

/// A function that returns whether a step may continue after a polynomial. Its arguments are the polynomial's index in
/// the step's log and the coefficients, highest power first. A search for a program that writes certain polynomials
/// stops the step at the first other polynomial. A guard also bounds loops that mistakes make endless.
pub type StepGuard<'a> = &'a dyn Fn(usize, &[f64]) -> bool;

/// Adds `change` to the vector of one particle.
pub fn add(array: &mut [f64], particle: usize, change: Vec2) {
    set_vector(array, particle, vector_at(array, particle) + change);
}

/// Subtracts `change` from the vector of one particle.
pub fn subtract(array: &mut [f64], particle: usize, change: Vec2) {
    set_vector(array, particle, vector_at(array, particle) - change);
}

impl World {
    /// Prepares a scene for a student's program.
    pub fn new(scene: impl Into<Arc<Scene>>, student: Student) -> Self {
        let scene = scene.into();
        let masses = scene.particles.iter().flat_map(|particle| [particle.mass, particle.mass]).collect();
        Self { scene, student, masses }
    }

    /// Returns the world for another student's program.
    pub fn for_student(&self, student: Student) -> Self {
        Self { scene: Arc::clone(&self.scene), student, masses: Arc::clone(&self.masses) }
    }

    /// Returns the pairs of one detection pass, in order (collisions.md 1).
    pub fn pairs(&self) -> impl Iterator<Item = Pair> {
        pairs(&self.scene, self.student)
    }

    /// Returns the state at time zero.
    pub fn initial_state(&self) -> State {
        let particles = &self.scene.particles;
        State {
            x: particles.iter().flat_map(|particle| [particle.position.x, particle.position.y]).collect(),
            v: particles.iter().flat_map(|particle| [particle.velocity.x, particle.velocity.y]).collect(),
        }
    }

    /// Returns the particle's mass in collisions. Nothing moves a fixed particle, so its mass is infinite.
    pub fn collision_mass(&self, particle: usize) -> f64 {
        let particle = &self.scene.particles[particle];
        if particle.fixed && !self.student.makes(Mistake::ResponseFixedMassFinite) {
            f64::INFINITY
        } else {
            particle.mass
        }
    }

    /// Returns whether the particle is fixed.
    pub fn is_fixed(&self, particle: usize) -> bool {
        self.scene.particles[particle].fixed
    }

    /// Returns the radius of an edge that this student's program uses in the quantity `term`.
    pub fn edge_radius(&self, term: Term, edge: usize) -> f64 {
        let edges = &self.scene.edges;
        match () {
            () if self.student.makes_slip(term, Slip::EndRadius) => self.scene.particles[edges[edge].first].radius,
            () if self.student.makes_slip(term, Slip::FirstRadius) => edges[0].radius,
            () => edges[edge].radius,
        }
    }
}

/// Returns whether an edge joins two particles.
fn are_connected(scene: &Scene, one: usize, two: usize) -> bool {
    scene.edges.iter().any(|edge| [(one, two), (two, one)].contains(&(edge.first, edge.second)))
}

/// Returns all pairs that the student's program checks, in order. A correct program checks for each particle the later
/// particles, the edges that do not end in it, and the half-planes.
fn pairs(scene: &Scene, student: Student) -> impl Iterator<Item = Pair> {
    let (planes_first, of) = (student.makes(Mistake::PairsHalfPlanesFirst), ParticlePairs { scene, student });
    let particles = 0..scene.particles.len();
    let before = if planes_first { particles.clone() } else { 0..0 };
    before.flat_map(move |particle| of.pairs_with_half_planes(particle)).chain(particles.flat_map(move |particle| {
        let planes = (!planes_first).then(|| of.pairs_with_half_planes(particle));
        of.pairs_with_particles(particle).chain(of.pairs_with_edges(particle)).chain(planes.into_iter().flatten())
    }))
}

/// The pairs of one particle, in the order of detection.
#[derive(Clone, Copy)]
struct ParticlePairs<'a> {
    scene: &'a Scene,
    student: Student,
}

impl<'a> ParticlePairs<'a> {
    fn pairs_with_particles(self, particle: usize) -> impl Iterator<Item = Pair> + use<'a> {
        let Scene { particles, .. } = self.scene;
        let makes = move |mistake: Mistake| self.student.makes(mistake);
        let first = if makes(Mistake::PairsBothOrders) { 0 } else { particle + 1 };
        let last = if makes(Mistake::PairsNeighborsOnly) { particles.len().min(particle + 2) } else { particles.len() };
        let is_kept = move |other: &usize| {
            let both_fixed = particles[particle].fixed && particles[*other].fixed;
            *other != particle
                && !(both_fixed && makes(Mistake::PairsFixedSkipped))
                && !(makes(Mistake::PairsConnectedSkipped) && are_connected(self.scene, particle, *other))
        };
        (first..last).filter(is_kept).map(move |other| Pair { particle, object: Object::Particle(other) })
    }

    fn pairs_with_edges(self, particle: usize) -> impl Iterator<Item = Pair> + use<'a> {
        let is_fixed = move |particle: usize| self.scene.particles[particle].fixed;
        self.scene.edges.iter().enumerate().filter_map(move |(index, edge)| {
            let is_endpoint = edge.first == particle || edge.second == particle;
            let is_still = [particle, edge.first, edge.second].into_iter().all(is_fixed);
            let is_left_out = (is_endpoint && !self.student.makes(Mistake::PairsEndpointsToo))
                || (is_still && self.student.makes(Mistake::PairsFixedSkipped))
                || (is_fixed(edge.first)
                    && is_fixed(edge.second)
                    && self.student.makes(Mistake::PairsFixedEdgesSkipped));
            (!is_left_out).then_some(Pair { particle, object: Object::Edge(index) })
        })
    }

    fn pairs_with_half_planes(self, particle: usize) -> impl Iterator<Item = Pair> + use<'a> {
        let makes = |mistake: Mistake| self.student.makes(mistake);
        let max_half_planes = match () {
            () if self.scene.particles[particle].fixed && makes(Mistake::PairsFixedSkipped) => 0,
            () if makes(Mistake::PairsFirstHalfPlaneOnly) => 1,
            () => usize::MAX,
        };
        (0..self.scene.half_planes.len().min(max_half_planes))
            .map(move |index| Pair { particle, object: Object::HalfPlane(index) })
    }
}
