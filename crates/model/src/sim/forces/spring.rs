//! The damped spring on an edge (simulation.md 3, springforce).
use super::{add, subtract};
use crate::sim::matrix::{add_coupling, subtract_coupling};
use fosssim_num::vector::{Vec2, divide, length, vector_at};
use nalgebra::{DMatrix, Matrix2};

/// Returns the spring's length and its direction from the first to the second endpoint. The direction is NaN if they
/// coincide.
fn direction([a, b]: [usize; 2], x: &[f64]) -> (f64, Vec2) {
    let d = vector_at(x, b) - vector_at(x, a);
    let l = length(d);
    (l, divide(d, l))
}

/// Adds the elastic part `k (l - l0) n` and the damping part `b (n . w) n` for both endpoints, even if a part is zero.
pub(super) fn add_gradient(
    [a, b]: [usize; 2],
    stiffness: f64,
    rest_length: f64,
    damping: f64,
    x: &[f64],
    v: &[f64],
    gradient: &mut [f64],
) {
    let (l, n) = direction([a, b], x);
    let elastic = (stiffness * (l - rest_length)) * n;
    subtract(gradient, a, elastic);
    add(gradient, b, elastic);
    let damped = (damping * n.dot(&(vector_at(v, b) - vector_at(v, a)))) * n;
    subtract(gradient, a, damped);
    add(gradient, b, damped);
}

/// Adds the position Hessian of the elastic part, then that of the damping.
pub(super) fn add_position_hessian(
    [a, b]: [usize; 2],
    stiffness: f64,
    rest_length: f64,
    damping: f64,
    x: &[f64],
    v: &[f64],
    matrix: &mut DMatrix<f64>,
) {
    let (l, n) = direction([a, b], x);
    let p = Matrix2::new(n.x * n.x, n.x * n.y, n.y * n.x, n.y * n.y);
    let stretch = l - rest_length;
    let reciprocal = 1.0 / l;
    let elastic = Matrix2::from_fn(|r, c| {
        let identity = if r == c { 1.0 } else { 0.0 };
        (p[(r, c)] + (stretch * (identity - p[(r, c)])) * reciprocal) * stiffness
    });
    add_coupling(matrix, [a, b], &elastic);

    let w = vector_at(v, b) - vector_at(v, a);
    let s = n.dot(&w);
    let cross = Matrix2::new(n.x * w.x + s, n.x * w.y, n.y * w.x, n.y * w.y + s);
    let scale = (-damping) / l;
    let damped =
        Matrix2::from_fn(|r, c| (cross[(r, c)] - (cross[(r, 0)] * p[(0, c)] + cross[(r, 1)] * p[(1, c)])) * scale);
    subtract_coupling(matrix, [a, b], &damped);
}

/// Adds the velocity Hessian `b n nT` of the damping.
pub(super) fn add_velocity_hessian([a, b]: [usize; 2], damping: f64, x: &[f64], matrix: &mut DMatrix<f64>) {
    let (_, n) = direction([a, b], x);
    let scaled = damping * n;
    let block = Matrix2::new(scaled.x * n.x, scaled.x * n.y, scaled.y * n.x, scaled.y * n.y);
    add_coupling(matrix, [a, b], &block);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretched_spring_pulls_its_ends_together() {
        let x = [0.0, 0.0, 3.0, 4.0];
        let v = [0.0; 4];
        let mut gradient = [0.0; 4];
        add_gradient([0, 1], 2.0, 4.0, 0.0, &x, &v, &mut gradient);
        // Length 5 and stretch 1, so the force on the first end points to the second, and the gradient is the opposite.
        assert!((gradient[0] + 1.2).abs() < 1e-15 && (gradient[1] + 1.6).abs() < 1e-15);
        assert!((gradient[2] - 1.2).abs() < 1e-15 && (gradient[3] - 1.6).abs() < 1e-15);
    }

    /// The Hessians are the derivatives of the gradient, checked by central differences.
    #[test]
    fn hessians_are_derivatives_of_the_gradient() {
        let (k, l0, b) = (3.0, 0.7, 0.4);
        let x = [0.1, -0.2, 1.3, 0.9];
        let v = [0.5, 0.25, -0.75, 1.0];
        let gradient = |x: &[f64], v: &[f64]| {
            let mut gradient = [0.0; 4];
            add_gradient([0, 1], k, l0, b, x, v, &mut gradient);
            gradient
        };
        let mut by_position = DMatrix::zeros(4, 4);
        add_position_hessian([0, 1], k, l0, b, &x, &v, &mut by_position);
        let mut by_velocity = DMatrix::zeros(4, 4);
        add_velocity_hessian([0, 1], b, &x, &mut by_velocity);
        let h = 1e-6;
        for column in 0..4 {
            let (mut up, mut down) = (x, x);
            up[column] += h;
            down[column] -= h;
            let (mut faster, mut slower) = (v, v);
            faster[column] += h;
            slower[column] -= h;
            for row in 0..4 {
                let difference = (gradient(&up, &v)[row] - gradient(&down, &v)[row]) / (2.0 * h);
                assert!((by_position[(row, column)] - difference).abs() < 1e-8, "x {row} {column}");
                let difference = (gradient(&x, &faster)[row] - gradient(&x, &slower)[row]) / (2.0 * h);
                assert!((by_velocity[(row, column)] - difference).abs() < 1e-8, "v {row} {column}");
            }
        }
    }
}
