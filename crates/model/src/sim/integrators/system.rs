//! The dense matrix of the implicit integrators (simulation.md 4, system matrix).
use crate::sim::{bodies::Bodies, forces::Forces};

/// A 2x2 block, `[row][column]`.
pub(crate) type Block = [[f64; 2]; 2];

/// A square matrix of 2N rows, column-major.
#[derive(Debug, Clone)]
pub(crate) struct Matrix {
    size: usize,
    entries: Vec<f64>,
}

impl Matrix {
    /// The zero matrix for `particles` particles.
    pub fn new(particles: usize) -> Self {
        let size = 2 * particles;
        Self { size, entries: vec![0.0; size * size] }
    }

    /// Number of rows, 2N.
    pub fn size(&self) -> usize {
        self.size
    }

    /// All entries, column after column.
    pub fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// One entry.
    #[cfg(test)]
    pub fn get(&self, row: usize, column: usize) -> f64 {
        self.entries[column * self.size + row]
    }

    /// One entry, to be changed.
    pub fn get_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.entries[column * self.size + row]
    }

    /// Adds `block` where the rows of particle `row` meet the columns of particle `column`.
    pub fn add_block(&mut self, row: usize, column: usize, block: &Block) {
        for (r, line) in block.iter().enumerate() {
            for (c, &value) in line.iter().enumerate() {
                *self.get_mut(2 * row + r, 2 * column + c) += value;
            }
        }
    }

    /// Subtracts `block` there.
    pub fn subtract_block(&mut self, row: usize, column: usize, block: &Block) {
        for (r, line) in block.iter().enumerate() {
            for (c, &value) in line.iter().enumerate() {
                *self.get_mut(2 * row + r, 2 * column + c) -= value;
            }
        }
    }

    /// Fills the matrix with `M + h (Hv + h Hx)` at positions `x` and velocities `v`; the rows and columns of fixed
    /// particles become those of the identity.
    pub fn assemble(&mut self, bodies: &Bodies, forces: &Forces, h: f64, x: &[f64], v: &[f64]) {
        self.entries.fill(0.0);
        forces.add_position_hessians(bodies, x, v, self);
        self.scale(h);
        forces.add_velocity_hessians(bodies, x, self);
        self.scale(h);
        for index in 0..self.size {
            *self.get_mut(index, index) += bodies.masses[index / 2];
        }
        for (particle, &fixed) in bodies.fixed.iter().enumerate() {
            if fixed {
                for index in [2 * particle, 2 * particle + 1] {
                    for other in 0..self.size {
                        *self.get_mut(index, other) = 0.0;
                        *self.get_mut(other, index) = 0.0;
                    }
                    *self.get_mut(index, index) = 1.0;
                }
            }
        }
    }

    fn scale(&mut self, h: f64) {
        for entry in &mut self.entries {
            *entry *= h;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene::Force,
        sim::samples::{fixed, particle, scene},
    };

    #[test]
    fn drag_and_mass_stand_on_the_diagonal_and_a_fixed_particle_has_the_identity() {
        let mut scene =
            scene(vec![particle((0.0, 0.0), (0.0, 0.0), 2.0, 0.1), fixed(particle((1.0, 0.0), (0.0, 0.0), 3.0, 0.1))]);
        scene.forces.push(Force::Drag { coefficient: 0.5 });
        let (bodies, forces) = (Bodies::new(&scene), Forces::new(&scene));
        let mut matrix = Matrix::new(2);
        matrix.assemble(&bodies, &forces, 0.5, &[0.0, 0.0, 1.0, 0.0], &[0.0; 4]);
        for row in 0..4 {
            for column in 0..4 {
                let diagonal = if row < 2 { 2.25 } else { 1.0 };
                assert_eq!(matrix.get(row, column), if row == column { diagonal } else { 0.0 }, "{row} {column}");
            }
        }
    }
}
