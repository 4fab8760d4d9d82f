//! The damped spring on an edge (simulation.md 3, springforce).
use super::{add, subtract};
use crate::sim::matrix::{Block, Matrix};
use fosssim_num::vector::{Vec2, at, length, over};

/// The spring's length and its direction from the first to the second endpoint (NaN when they coincide).
fn direction([a, b]: [usize; 2], x: &[f64]) -> (f64, Vec2) {
    let d = at(x, b) - at(x, a);
    let l = length(d);
    (l, over(d, l))
}

/// Adds `k (l - l0) n` and the damping `b (n . w) n` on the endpoints, both always.
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
    let damped = (damping * n.dot(&(at(v, b) - at(v, a)))) * n;
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
    matrix: &mut Matrix,
) {
    let (l, n) = direction([a, b], x);
    let n = [n.x, n.y];
    let p: Block = [[n[0] * n[0], n[0] * n[1]], [n[1] * n[0], n[1] * n[1]]];
    let stretch = l - rest_length;
    let reciprocal = 1.0 / l;
    let mut elastic: Block = [[0.0; 2]; 2];
    for r in 0..2 {
        for c in 0..2 {
            let identity = if r == c { 1.0 } else { 0.0 };
            elastic[r][c] = (p[r][c] + (stretch * (identity - p[r][c])) * reciprocal) * stiffness;
        }
    }
    matrix.add_block(a, a, &elastic);
    matrix.add_block(b, b, &elastic);
    matrix.subtract_block(a, b, &elastic);
    matrix.subtract_block(b, a, &elastic);

    let w = at(v, b) - at(v, a);
    let w = [w.x, w.y];
    let mut cross: Block = [[n[0] * w[0], n[0] * w[1]], [n[1] * w[0], n[1] * w[1]]];
    let s = n[0] * w[0] + n[1] * w[1];
    cross[0][0] += s;
    cross[1][1] += s;
    let scale = (-damping) / l;
    let mut damped: Block = [[0.0; 2]; 2];
    for r in 0..2 {
        for c in 0..2 {
            damped[r][c] = (cross[r][c] - (cross[r][0] * p[0][c] + cross[r][1] * p[1][c])) * scale;
        }
    }
    matrix.subtract_block(a, a, &damped);
    matrix.subtract_block(b, b, &damped);
    matrix.add_block(a, b, &damped);
    matrix.add_block(b, a, &damped);
}

/// Adds the velocity Hessian `b n nT` of the damping.
pub(super) fn add_velocity_hessian([a, b]: [usize; 2], damping: f64, x: &[f64], matrix: &mut Matrix) {
    let (_, n) = direction([a, b], x);
    let block: Block = [[(damping * n.x) * n.x, (damping * n.x) * n.y], [(damping * n.y) * n.x, (damping * n.y) * n.y]];
    matrix.add_block(a, a, &block);
    matrix.add_block(b, b, &block);
    matrix.subtract_block(a, b, &block);
    matrix.subtract_block(b, a, &block);
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
        // Length 5, stretch 1, so the force on the first end points to the second: the gradient is its opposite.
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
        let mut by_position = Matrix::new(2);
        add_position_hessian([0, 1], k, l0, b, &x, &v, &mut by_position);
        let mut by_velocity = Matrix::new(2);
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
                assert!((by_position.get(row, column) - difference).abs() < 1e-8, "x {row} {column}");
                let difference = (gradient(&x, &faster)[row] - gradient(&x, &slower)[row]) / (2.0 * h);
                assert!((by_velocity.get(row, column) - difference).abs() < 1e-8, "v {row} {column}");
            }
        }
    }
}
