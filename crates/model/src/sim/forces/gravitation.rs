//! Newtonian attraction of two particles (simulation.md 3, gravitationalforce).
use super::{add, subtract};
use crate::sim::matrix::add_coupling;
use fosssim_num::vector::{divide, length, vector_at};
use nalgebra::{DMatrix, Matrix2};

/// Adds the gradient of the attraction. Its size is `G m m' / r^2`, along the line between the particles. The result is
/// NaN if they coincide.
pub(super) fn add_gradient(masses: &[f64], [a, b]: [usize; 2], constant: f64, x: &[f64], gradient: &mut [f64]) {
    let d = vector_at(x, b) - vector_at(x, a);
    let r = length(d);
    let n = divide(d, r);
    let s = constant * masses[b] * masses[a] / (r * r);
    subtract(gradient, a, s * n);
    add(gradient, b, s * n);
}

/// Adds the position Hessian `G m m' / r^3 (I - 3 n nT)`.
pub(super) fn add_position_hessian(
    masses: &[f64],
    [a, b]: [usize; 2],
    constant: f64,
    x: &[f64],
    matrix: &mut DMatrix<f64>,
) {
    let d = vector_at(x, b) - vector_at(x, a);
    let r = length(d);
    let n = divide(d, r);
    let s = constant * masses[b] * masses[a] / (r * r * r);
    let block = Matrix2::from_fn(|row, column| {
        let identity = if row == column { 1.0 } else { 0.0 };
        (identity - (3.0 * n[row]) * n[column]) * s
    });
    add_coupling(matrix, [a, b], &block);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hessian_is_the_derivative_of_the_gradient() {
        let masses = [2.0, 3.0];
        let x = [0.1, -0.2, 1.3, 0.9];
        let gradient = |x: &[f64]| {
            let mut gradient = [0.0; 4];
            add_gradient(&masses, [0, 1], 0.7, x, &mut gradient);
            gradient
        };
        let mut hessian = DMatrix::zeros(4, 4);
        add_position_hessian(&masses, [0, 1], 0.7, &x, &mut hessian);
        let h = 1e-6;
        for column in 0..4 {
            let (mut up, mut down) = (x, x);
            up[column] += h;
            down[column] -= h;
            for row in 0..4 {
                let difference = (gradient(&up)[row] - gradient(&down)[row]) / (2.0 * h);
                assert!((hessian[(row, column)] - difference).abs() < 1e-8, "{row} {column}");
            }
        }
    }

    #[test]
    fn particles_attract_each_other() {
        let mut gradient = [0.0; 4];
        add_gradient(&[1.0, 4.0], [0, 1], 1.0, &[0.0, 0.0, 2.0, 0.0], &mut gradient);
        assert_eq!(gradient, [-1.0, 0.0, 1.0, 0.0]);
    }
}
