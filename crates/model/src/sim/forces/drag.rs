//! Linear drag (simulation.md 3, dragdamping): a force `-b v` on every particle.
use crate::sim::matrix::Matrix;

/// Adds `b v`.
pub(super) fn add_gradient(coefficient: f64, v: &[f64], gradient: &mut [f64]) {
    for (entry, &v) in gradient.iter_mut().zip(v) {
        *entry += coefficient * v;
    }
}

/// Adds `b` to every diagonal entry.
pub(super) fn add_velocity_hessian(coefficient: f64, matrix: &mut Matrix) {
    for index in 0..matrix.size() {
        *matrix.get_mut(index, index) += coefficient;
    }
}
