//! Linear drag (simulation.md 3, dragdamping): a force `-b v` on every particle.
use nalgebra::DMatrix;

/// Adds the gradient `b v`.
pub(super) fn add_gradient(coefficient: f64, v: &[f64], gradient: &mut [f64]) {
    for (entry, &v) in gradient.iter_mut().zip(v) {
        *entry += coefficient * v;
    }
}

/// Adds `b` to every diagonal entry of the velocity Hessian.
pub(super) fn add_velocity_hessian(coefficient: f64, matrix: &mut DMatrix<f64>) {
    for index in 0..matrix.nrows() {
        matrix[(index, index)] += coefficient;
    }
}
