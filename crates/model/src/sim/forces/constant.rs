//! A constant force on every particle, independent of its mass (simulation.md 3, constantforce). It has no Hessian.
use super::subtract;
use fosssim_num::vector::Vec2;

/// Adds the gradient, which is the negated force.
pub(super) fn add_gradient(force: Vec2, gradient: &mut [f64]) {
    for index in 0..gradient.len() / 2 {
        subtract(gradient, index, force);
    }
}
