//! The forces: gradients of their potentials, and the Hessians that the implicit integrators need.
//!
//! Each kind has its own file; this file contains the order of the forces and the dispatch over all kinds. All
//! gradients are accumulated into one array that starts at +0; the penalty force comes last (simulation.md 2, 3).
//! Forces ignore whether particles are fixed; the integrators set the entries of fixed particles to zero.
mod constant;
mod drag;
mod gravitation;
mod gravity;
mod penalty;
mod spring;
mod vortex;

use super::bodies::Bodies;
use crate::scene::{Collision, CollisionDetection, Force, Scene};
use fosssim_num::vector::{Vec2, set_vector, vector_at};
use nalgebra::DMatrix;
use penalty::Penalty;
pub use penalty::{PenaltyPairs, PenaltyTerms, SweepOrder};

/// All forces of a scene, in the order in which they act.
#[derive(Debug, Clone)]
pub(super) struct Forces {
    list: Vec<Force>,
    penalty: Option<Penalty>,
}

impl Forces {
    /// Creates the scene's forces, including the penalty force of `penalty` and `hybrid` handling (even if its
    /// stiffness or thickness is 0).
    pub fn new(scene: &Scene) -> Self {
        let penalty = match scene.collision {
            Collision::Penalty { stiffness, thickness, detection } => {
                Some(Penalty::new(scene, stiffness, thickness, detection))
            }
            Collision::Hybrid { stiffness, thickness, .. } => {
                Some(Penalty::new(scene, stiffness, thickness, CollisionDetection::AllPairs))
            }
            Collision::None | Collision::Simple { .. } | Collision::ContinuousTime { .. } => None,
        };
        Self { list: scene.forces.clone(), penalty }
    }

    /// Returns the pairs of the penalty force, if there is one.
    pub fn pairs(&mut self) -> Option<&mut PenaltyPairs> {
        self.penalty.as_mut().map(Penalty::pairs)
    }

    /// Returns whether every force has the Hessians that implicit integrators need; a vortex force has none.
    pub fn have_hessians(&self) -> bool {
        !self.list.iter().any(|force| matches!(force, Force::Vortex { .. }))
    }

    /// Fills `gradient` (2N) with dU/dx of all forces at positions `x` and velocities `v`.
    pub fn fill_gradient(&mut self, bodies: &Bodies, x: &[f64], v: &[f64], gradient: &mut [f64]) {
        gradient.fill(0.0);
        for force in &self.list {
            match *force {
                Force::Spring { edge, stiffness, rest_length, damping } => {
                    spring::add_gradient(bodies.edges[edge], stiffness, rest_length, damping, x, v, gradient);
                }
                Force::SimpleGravity { acceleration } => gravity::add_gradient(&bodies.masses, acceleration, gradient),
                Force::Gravitation { first, second, constant } => {
                    gravitation::add_gradient(&bodies.masses, [first, second], constant, x, gradient);
                }
                Force::Constant { force } => constant::add_gradient(force, gradient),
                Force::Drag { coefficient } => drag::add_gradient(coefficient, v, gradient),
                Force::Vortex { first, second, strength, coupling } => {
                    vortex::add_gradient([first, second], strength, coupling, x, v, gradient);
                }
            }
        }
        if let Some(penalty) = &mut self.penalty {
            penalty.add_gradient(bodies, x, gradient);
        }
    }

    /// Adds all d2U/dx2 to `matrix`. The penalty force's Hessian counts as zero (simulation.md 3).
    pub fn add_position_hessians(&self, bodies: &Bodies, x: &[f64], v: &[f64], matrix: &mut DMatrix<f64>) {
        for force in &self.list {
            match *force {
                Force::Spring { edge, stiffness, rest_length, damping } => {
                    spring::add_position_hessian(bodies.edges[edge], stiffness, rest_length, damping, x, v, matrix);
                }
                Force::Gravitation { first, second, constant } => {
                    gravitation::add_position_hessian(&bodies.masses, [first, second], constant, x, matrix);
                }
                Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } | Force::Vortex { .. } => {}
            }
        }
    }

    /// Adds the derivatives of all gradients with respect to velocities to `matrix`.
    pub fn add_velocity_hessians(&self, bodies: &Bodies, x: &[f64], matrix: &mut DMatrix<f64>) {
        for force in &self.list {
            match *force {
                Force::Spring { edge, damping, .. } => {
                    spring::add_velocity_hessian(bodies.edges[edge], damping, x, matrix);
                }
                Force::Drag { coefficient } => drag::add_velocity_hessian(coefficient, matrix),
                Force::SimpleGravity { .. }
                | Force::Gravitation { .. }
                | Force::Constant { .. }
                | Force::Vortex { .. } => {}
            }
        }
    }
}

/// Returns the gradient (2N) of each force of a scene at positions `x` and velocities `v`, in the order in which they
/// act. The penalty force, if there is one, comes last.
pub fn gradients(scene: &Scene, x: &[f64], v: &[f64]) -> Vec<Vec<f64>> {
    let (bodies, Forces { list, penalty }) = (Bodies::new(scene), Forces::new(scene));
    let single_forces = list.into_iter().map(|force| Forces { list: vec![force], penalty: None });
    let last = penalty.map(|penalty| Forces { list: Vec::new(), penalty: Some(penalty) });
    let gradient = |mut forces: Forces| {
        let mut gradient = vec![0.0; x.len()];
        forces.fill_gradient(&bodies, x, v, &mut gradient);
        gradient
    };
    single_forces.chain(last).map(gradient).collect()
}

/// Computes `array[index] += v`.
#[inline]
fn add(array: &mut [f64], index: usize, v: Vec2) {
    set_vector(array, index, vector_at(array, index) + v);
}

/// Computes `array[index] -= v`.
#[inline]
fn subtract(array: &mut [f64], index: usize, v: Vec2) {
    set_vector(array, index, vector_at(array, index) - v);
}
