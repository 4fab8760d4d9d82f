//! Correct programs of the milestones whose traces hold states, in arithmetic that differs from the reference's.
//!
//! The programs compute the same results with the formulas of a textbook, in another order and with nalgebra's solvers.
//! The fair rules must accept all of them, so they measure how much of the tolerances a correct program uses.
mod forces;
mod integrators;
mod simple;

use forces::ForceTerms;
use fosssim_model::scene::{Collision, Scene};
use fosssim_oracle::student::{Contact, Record, State, StepLog, Student};

/// The order and the rounding of a program's sums and products, and its solver.
#[derive(Debug, Clone, Copy)]
pub struct Arithmetic {
    /// The arithmetic's name in tables.
    pub name: &'static str,
    /// The order in which forces are added up.
    pub sum: Sum,
    /// The solver of linear systems.
    pub solver: Solver,
    /// Whether products are fused with the sums that follow.
    pub fused: bool,
}

/// The ways to add up contributions to a vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sum {
    /// The last contribution is added first.
    Backward,
    /// The contributions are added in a random order for each sum.
    Shuffled,
    /// The contributions are added in order, with compensation of rounding errors (Kahan).
    Compensated,
}

/// The solvers of linear systems.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// Elimination with partial pivoting.
    Partial,
    /// QR decomposition with Householder reflections.
    Qr,
    /// Cholesky (L L^T); falls back to elimination for matrices that are not positive definite.
    Cholesky,
    /// Singular value decomposition.
    Svd,
}

/// All programs.
pub const ALL: [Arithmetic; 5] = [
    Arithmetic { name: "backward, partial pivots", sum: Sum::Backward, solver: Solver::Partial, fused: false },
    Arithmetic { name: "shuffled, Householder", sum: Sum::Shuffled, solver: Solver::Qr, fused: false },
    Arithmetic { name: "compensated, Cholesky", sum: Sum::Compensated, solver: Solver::Cholesky, fused: false },
    Arithmetic { name: "fused, partial pivots", sum: Sum::Backward, solver: Solver::Partial, fused: true },
    Arithmetic { name: "fused, singular values", sum: Sum::Shuffled, solver: Solver::Svd, fused: true },
];

impl Arithmetic {
    /// Returns `addend + a * b`.
    fn add_product(self, addend: f64, a: f64, b: f64) -> f64 {
        if self.fused {
            #[expect(clippy::disallowed_methods, reason = "a compiler may fuse, and these programs say that it did")]
            return a.mul_add(b, addend);
        }
        addend + a * b
    }

    /// Returns the whole trace of a scene, whose collision handling logs no polynomials. `visit` receives the state and
    /// the contacts after every step.
    ///
    /// # Errors
    /// Fails with the steps so far if a step has no result, because of a vortex force in an implicit step, or because
    /// Newton's method does not converge.
    pub fn trace(self, scene: &Scene, mut visit: impl FnMut(&State, &[Contact])) -> Result<Vec<u8>, Vec<u8>> {
        let mut state = start(scene);
        let mut forces = ForceTerms::new(scene, self);
        let mut bytes = Vec::new();
        record(scene, &state, &[], &mut bytes);
        for _ in 0..scene.step_count() {
            if integrators::advance(scene, self, &mut forces, &mut state).is_none() {
                return Err(bytes);
            }
            let contacts = match scene.collision {
                Collision::Simple { restitution } => simple::handle(scene, restitution, &mut state),
                _ => Vec::new(),
            };
            record(scene, &state, &contacts, &mut bytes);
            visit(&state, &contacts);
        }
        Ok(bytes)
    }
}

/// Returns the initial state of a scene.
#[must_use]
pub fn start(scene: &Scene) -> State {
    let particles = &scene.particles;
    State {
        x: particles.iter().flat_map(|particle| [particle.position.x, particle.position.y]).collect(),
        v: particles.iter().flat_map(|particle| [particle.velocity.x, particle.velocity.y]).collect(),
    }
}

/// Appends the record of a state.
pub fn record(scene: &Scene, state: &State, contacts: &[Contact], bytes: &mut Vec<u8>) {
    let log = StepLog { impulses: contacts.to_vec(), ..StepLog::default() };
    Record::new(Student::default(), &scene.collision, state, &log).encode(bytes);
}
