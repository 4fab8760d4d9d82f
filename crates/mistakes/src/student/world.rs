//! What a step works on: the scene's constants, the moving state, and the pairs that detection looks at.
use fosssim_model::scene::Scene;
use fosssim_num::{
    polynomial::Polynomial,
    vector::{Vec2, at, put},
};

use super::{
    author::Student,
    catalogue::Mistake,
    mutants::Change,
    objects::{Contact, Object, Pair, State},
};

/// Everything that stays as it is during a run.
pub struct World {
    /// The scene as loaded.
    pub scene: Scene,
    /// Whose program this is, that is: which mistake it makes.
    pub student: Student,
    /// The mass of each particle twice, in the order of the state.
    pub masses: Vec<f64>,
    /// The pairs of one detection pass, in order (collisions.md 1).
    pub pairs: Vec<Pair>,
}

/// What a step leaves for the trace.
#[derive(Clone, Default)]
pub struct StepLog<'a> {
    /// The impulses, in the order in which they were applied.
    pub impulses: Vec<Contact>,
    /// The polynomials handed to the root finder, in order.
    pub polynomials: Vec<Polynomial>,
    /// Asked about each polynomial, by its index in the log, before its roots are searched.
    pub guard: Option<Guard<'a>>,
}

/// Says whether a step may go on after this polynomial (index in the step's log, coefficients highest power first). Who
/// looks for a certain step saves the rest of it as soon as it is another one, and bounds loops that mistakes make
/// endless.
pub type Guard<'a> = &'a dyn Fn(usize, &[f64]) -> bool;

/// Adds `change` to the vector of one particle.
pub fn add(array: &mut [f64], particle: usize, change: Vec2) {
    put(array, particle, at(array, particle) + change);
}

/// Subtracts `change` from the vector of one particle.
pub fn subtract(array: &mut [f64], particle: usize, change: Vec2) {
    put(array, particle, at(array, particle) - change);
}

impl World {
    /// Prepares a scene for this student's program.
    pub fn new(scene: Scene, student: Student) -> Self {
        let masses = scene.particles.iter().flat_map(|particle| [particle.mass, particle.mass]).collect();
        let mut pairs = pairs(&scene, student);
        if let Some(Change::Pairs(change)) = student.change() {
            change(&mut pairs);
        }
        Self { scene, student, masses, pairs }
    }

    /// The state at time zero.
    pub fn initial_state(&self) -> State {
        let particles = &self.scene.particles;
        State {
            x: particles.iter().flat_map(|particle| [particle.position.x, particle.position.y]).collect(),
            v: particles.iter().flat_map(|particle| [particle.velocity.x, particle.velocity.y]).collect(),
        }
    }

    /// The particle's mass as collisions see it: nothing moves a fixed particle, so its mass is infinite.
    pub fn collision_mass(&self, particle: usize) -> f64 {
        let particle = &self.scene.particles[particle];
        if particle.fixed && !self.student.makes(Mistake::ResponseFixedMassFinite) {
            f64::INFINITY
        } else {
            particle.mass
        }
    }

    /// Whether the particle is fixed.
    pub fn fixed(&self, particle: usize) -> bool {
        self.scene.particles[particle].fixed
    }
}

/// Whether an edge joins two particles.
fn are_connected(scene: &Scene, one: usize, two: usize) -> bool {
    let joins = |edge: &fosssim_model::scene::Edge| {
        (edge.first, edge.second) == (one, two) || (edge.first, edge.second) == (two, one)
    };
    scene.edges.iter().any(joins)
}

/// All pairs in the order of detection: per particle the later particles, the edges of which it is not an endpoint,
/// the half-planes.
fn pairs(scene: &Scene, student: Student) -> Vec<Pair> {
    let count = scene.particles.len();
    let mut pairs = Vec::new();
    for particle in 0..count {
        let first = if student.makes(Mistake::PairsBothOrders) { 0 } else { particle + 1 };
        let last = if student.makes(Mistake::PairsNeighboursOnly) { count.min(particle + 2) } else { count };
        for other in (first..last).filter(|&other| other != particle) {
            let both_fixed = scene.particles[particle].fixed && scene.particles[other].fixed;
            let skips = (both_fixed && student.makes(Mistake::PairsFixedSkipped))
                || (student.makes(Mistake::PairsConnectedSkipped) && are_connected(scene, particle, other));
            if !skips {
                pairs.push(Pair { particle, object: Object::Particle(other) });
            }
        }
        for (index, edge) in scene.edges.iter().enumerate() {
            let endpoint = edge.first == particle || edge.second == particle;
            let still = [particle, edge.first, edge.second].iter().all(|&one| scene.particles[one].fixed);
            if (endpoint && !student.makes(Mistake::PairsEndpointsToo))
                || (still && student.makes(Mistake::PairsFixedSkipped))
            {
                continue;
            }
            pairs.push(Pair { particle, object: Object::Edge(index) });
        }
        for index in 0..scene.half_planes.len() {
            if (index > 0 && student.makes(Mistake::PairsFirstHalfPlaneOnly))
                || (scene.particles[particle].fixed && student.makes(Mistake::PairsFixedSkipped))
            {
                continue;
            }
            pairs.push(Pair { particle, object: Object::HalfPlane(index) });
        }
    }
    if student.makes(Mistake::PairsHalfPlanesFirst) {
        pairs.sort_by_key(|pair| !matches!(pair.object, Object::HalfPlane(_)));
    }
    pairs
}
