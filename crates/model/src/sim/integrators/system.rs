//! The system matrix of the implicit integrators (simulation.md 4, system matrix).
use super::ImplicitScratch;
use crate::sim::{bodies::Bodies, forces::Forces, observer::StepController};
use fosssim_num::linear;
use nalgebra::DMatrix;

/// A scene's bodies and forces for an implicit method.
pub(super) struct System<'a> {
    /// The scene's bodies.
    pub bodies: &'a Bodies,
    /// The scene's forces.
    pub forces: &'a mut Forces,
    /// The time step.
    pub h: f64,
    /// Receives each matrix before it is solved, and may replace it.
    pub controller: Option<&'a mut dyn StepController>,
}

impl System<'_> {
    /// Solves the system at `scratch.x` and `scratch.v`; the solution replaces `rhs`.
    pub fn solve(&mut self, scratch: &mut ImplicitScratch, rhs: &mut [f64]) {
        let ImplicitScratch { matrix, workspace, x, v, .. } = scratch;
        assemble(matrix, self.bodies, self.forces, self.h, x, v);
        if let Some(steer) = &mut self.controller {
            steer.observe_system(matrix.as_mut_slice());
        }
        linear::solve(matrix.as_mut_slice(), rhs, workspace);
    }
}

/// Fills the matrix with `M + h (Hv + h Hx)` at positions `x` and velocities `v`; the rows and columns of fixed
/// particles become those of the identity.
pub(crate) fn assemble(matrix: &mut DMatrix<f64>, bodies: &Bodies, forces: &Forces, h: f64, x: &[f64], v: &[f64]) {
    let scale = |matrix: &mut DMatrix<f64>| matrix.as_mut_slice().iter_mut().for_each(|entry| *entry *= h);
    matrix.as_mut_slice().fill(0.0);
    forces.add_position_hessians(bodies, x, v, matrix);
    scale(matrix);
    forces.add_velocity_hessians(bodies, x, matrix);
    scale(matrix);
    for index in 0..matrix.nrows() {
        matrix[(index, index)] += bodies.masses[index / 2];
    }
    for (particle, &fixed) in bodies.fixed.iter().enumerate() {
        if fixed {
            for index in [2 * particle, 2 * particle + 1] {
                matrix.row_mut(index).fill(0.0);
                matrix.column_mut(index).fill(0.0);
                matrix[(index, index)] = 1.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene::Force,
        sim::samples::{fixed_copy, particle, scene},
    };

    #[test]
    fn drag_and_mass_stand_on_the_diagonal_and_a_fixed_particle_has_the_identity() {
        let mut scene = scene(vec![
            particle((0.0, 0.0), (0.0, 0.0), 2.0, 0.1),
            fixed_copy(particle((1.0, 0.0), (0.0, 0.0), 3.0, 0.1)),
        ]);
        scene.forces.push(Force::Drag { coefficient: 0.5 });
        let (bodies, forces) = (Bodies::new(&scene), Forces::new(&scene));
        let mut matrix = DMatrix::zeros(4, 4);
        assemble(&mut matrix, &bodies, &forces, 0.5, &[0.0, 0.0, 1.0, 0.0], &[0.0; 4]);
        for row in 0..4 {
            for column in 0..4 {
                let diagonal = if row < 2 { 2.25 } else { 1.0 };
                assert_eq!(matrix[(row, column)], if row == column { diagonal } else { 0.0 }, "{row} {column}");
            }
        }
    }
}
