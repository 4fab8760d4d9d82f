//! The time integrators (simulation.md 4): one file per implicit integrator, and the dense system that they solve.
//!
//! Explicit Euler moves the positions with the old velocities, `x += h v`, then `v += h F / m`. Forward-backward Euler,
//! also called symplectic, moves the positions with the new velocities, `v += h F / m`, then `x += h v`.
//!
//! An integrator turns positions and velocities at the start of a step into those at its end. No force acts on fixed
//! particles, but their own velocity moves them.
mod implicit;
mod linearized;
mod system;

use super::{bodies::Bodies, forces::Forces, observer::StepController, state::State, step_error::StepError};
use crate::scene::{Integrator, Scene};
use fosssim_num::linear::Workspace;
use nalgebra::DMatrix;
use system::System;

/// The scene's integrator with its scratch arrays.
#[derive(Debug, Clone)]
pub(super) struct Stepper {
    kind: Integrator,
    time_step: f64,
    /// The number -1, opaque to the compiler; see [`Stepper::new`].
    minus_one: f64,
    gradient: Vec<f64>,
    implicit: Option<Box<ImplicitScratch>>,
    newton_work: NewtonWork,
}

/// The work of Newton's method over all steps, in the unit of
/// [`SearchCounts::work`](super::search::SearchCounts::work). Methods whose work per step is constant are not counted.
#[derive(Debug, Clone, Copy)]
struct NewtonWork {
    performed_work: u64,
    limit: u64,
    per_iteration: u64,
}

impl NewtonWork {
    /// Counts an iteration. Returns whether it is within the limit.
    fn iterate(&mut self) -> bool {
        self.performed_work += self.per_iteration;
        self.performed_work <= self.limit
    }
}

/// Returns the minimum work of a step of the scene's integrator, in the unit of
/// [`SearchCounts::work`](super::search::SearchCounts::work): an iteration of Newton's method, if that is used.
/// Elimination takes n³ / 3 operations; a detection call takes a few hundred.
pub fn min_work(scene: &Scene) -> u64 {
    if scene.integrator == Integrator::ImplicitEuler { 1 + (2 * scene.particles.len() as u64).pow(3) / 64 } else { 0 }
}

/// The additional memory of the implicit methods, of size (2N)^2.
#[derive(Debug, Clone)]
struct ImplicitScratch {
    matrix: DMatrix<f64>,
    workspace: Workspace,
    x: Vec<f64>,
    v: Vec<f64>,
    dx: Vec<f64>,
    dv: Vec<f64>,
    previous_update: Vec<f64>,
}

impl Stepper {
    /// Creates the scene's integrator.
    pub fn new(scene: &Scene) -> Self {
        let entry_count = 2 * scene.particles.len();
        let scratch = || ImplicitScratch {
            matrix: DMatrix::zeros(entry_count, entry_count),
            workspace: Workspace::default(),
            x: vec![0.0; entry_count],
            v: vec![0.0; entry_count],
            dx: vec![0.0; entry_count],
            dv: vec![0.0; entry_count],
            previous_update: vec![0.0; entry_count],
        };
        let implicit = scene.integrator.is_implicit().then(|| Box::new(scratch()));
        Self {
            kind: scene.integrator,
            time_step: scene.time_step,
            // The factor of `F = -1 * g` is a multiplication. A compiler that knew the factor would replace it by a
            // sign flip, which gives a NaN residual a different sign than the original's.
            minus_one: std::hint::black_box(-1.0),
            gradient: vec![0.0; entry_count],
            implicit,
            newton_work: NewtonWork { performed_work: 0, limit: u64::MAX, per_iteration: min_work(scene) },
        }
    }

    /// Returns the work of all steps so far.
    pub fn work(&self) -> u64 {
        self.newton_work.performed_work
    }

    /// Sets the maximum work over all steps.
    pub fn limit_work(&mut self, max_work: u64) {
        self.newton_work.limit = max_work;
    }

    /// Returns whether the method needs the Hessians of the forces.
    pub fn is_implicit(&self) -> bool {
        self.implicit.is_some()
    }

    /// Advances `state` by one time step, number `step`. `steer` receives the systems that are solved.
    ///
    /// # Errors
    /// `implicit-euler` fails with [`StepError::Newton`] if Newton's method does not converge, or with
    /// [`StepError::Work`] if the allowed work is exceeded. In both cases the state is unchanged.
    pub fn advance<'a>(
        &mut self,
        step: u32,
        bodies: &'a Bodies,
        forces: &'a mut Forces,
        state: &mut State,
        steer: Option<&'a mut dyn StepController>,
    ) -> Result<(), StepError> {
        let h = self.time_step;
        match (self.kind, self.implicit.as_deref_mut()) {
            (Integrator::ImplicitEuler, Some(scratch)) => {
                let mut system = System { bodies, forces, h, controller: steer };
                implicit::advance(step, &mut system, &mut self.gradient, scratch, &mut self.newton_work, state)?;
            }
            (Integrator::LinearizedImplicitEuler, Some(scratch)) => {
                let mut system = System { bodies, forces, h, controller: steer };
                linearized::advance(&mut system, self.minus_one, &mut self.gradient, scratch, state);
            }
            (Integrator::ExplicitEuler, _) => {
                self.compute_force(bodies, forces, state);
                add_scaled(&mut state.positions, h, &state.velocities);
                add_scaled_accelerations(&mut state.velocities, h, &self.gradient, &bodies.masses);
            }
            (Integrator::ForwardBackwardEuler | Integrator::SymplecticEuler, _) => {
                self.compute_force(bodies, forces, state);
                add_scaled_accelerations(&mut state.velocities, h, &self.gradient, &bodies.masses);
                add_scaled(&mut state.positions, h, &state.velocities);
            }
            (Integrator::ImplicitEuler | Integrator::LinearizedImplicitEuler, None) => {
                unreachable!("the implicit methods are set up with their scratch")
            }
        }
        Ok(())
    }

    /// Replaces the gradient array by the forces `-1 * g` at the current state, zero for fixed particles.
    fn compute_force(&mut self, bodies: &Bodies, forces: &mut Forces, state: &State) {
        forces.fill_gradient(bodies, &state.positions, &state.velocities, &mut self.gradient);
        for entry in &mut self.gradient {
            *entry *= self.minus_one;
        }
        bodies.zero_fixed(&mut self.gradient);
    }
}

/// Computes `target += scale * source`, entry by entry.
fn add_scaled(target: &mut [f64], scale: f64, source: &[f64]) {
    for (target, source) in target.iter_mut().zip(source) {
        *target += scale * source;
    }
}

/// Computes `target += scale * (force / mass)`, entry by entry; the quotient is rounded first.
fn add_scaled_accelerations(target: &mut [f64], scale: f64, force: &[f64], masses: &[f64]) {
    for ((target, force), &mass) in target.chunks_exact_mut(2).zip(force.chunks_exact(2)).zip(masses) {
        target[0] += scale * (force[0] / mass);
        target[1] += scale * (force[1] / mass);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene::{Force, Particle},
        sim::samples::{fixed_copy, particle, scene},
    };
    use fosssim_num::vector::Vec2;

    /// Returns the state after a step of half a second, in which a force of 4 to the right acts on all particles.
    fn advanced(integrator: Integrator, particles: Vec<Particle>) -> State {
        let force = Force::Constant { force: Vec2::new(4.0, 0.0) };
        let scene = Scene { integrator, forces: vec![force], ..scene(particles) };
        let (bodies, mut forces, mut state) = (Bodies::new(&scene), Forces::new(&scene), State::for_scene(&scene));
        Stepper::new(&scene).advance(1, &bodies, &mut forces, &mut state, None).unwrap();
        state
    }

    #[test]
    fn positions_use_the_old_velocity_and_a_fixed_particle_keeps_moving() {
        let particles =
            vec![particle((0.0, 0.0), (1.0, 0.0), 2.0, 0.1), fixed_copy(particle((5.0, 0.0), (0.0, 3.0), 1.0, 0.1))];
        let state = advanced(Integrator::ExplicitEuler, particles);
        assert_eq!(state.positions, [0.5, 0.0, 5.0, 1.5]);
        assert_eq!(state.velocities, [2.0, 0.0, 0.0, 3.0]);
    }

    #[test]
    fn positions_use_the_new_velocity() {
        let state = advanced(Integrator::SymplecticEuler, vec![particle((0.0, 0.0), (1.0, 0.0), 2.0, 0.1)]);
        assert_eq!(state.velocities, [2.0, 0.0]);
        assert_eq!(state.positions, [1.0, 0.0]);
    }
}
