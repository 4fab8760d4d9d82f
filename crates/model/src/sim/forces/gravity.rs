//! Uniform gravity (simulation.md 3, simplegravity): `g_i -= m_i f`. It has no Hessian.
use super::subtract;
use fosssim_num::vector::Vec2;

/// Adds the gradient for the given acceleration.
pub(super) fn add_gradient(masses: &[f64], acceleration: Vec2, gradient: &mut [f64]) {
    for (index, &mass) in masses.iter().enumerate() {
        subtract(gradient, index, mass * acceleration);
    }
}
