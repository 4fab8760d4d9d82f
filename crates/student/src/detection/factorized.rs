//! The particle-edge polynomials, computed from two quadratics. With `w = x1 - x2` and `e = x3 - x2`, both linear in t,
//! the quadratics are the cross product `q = e x w` and the squared length `g = e.e`.
//!
//! The quartic is `R² g - q²`; the mathematically right quintic is `-q (2 q' g - q g') / 2`.
use fosssim_num::vector::Vec2;

use fosssim_model::sim::PointMotion;

fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns `q` and `g`, highest power first.
fn quadratics([one, two, three]: &[PointMotion; 3]) -> ([f64; 3], [f64; 3]) {
    let (w0, w1) = (one.start - two.start, one.shift - two.shift);
    let (e0, e1) = (three.start - two.start, three.shift - two.shift);
    let q = [cross(e1, w1), cross(e1, w0) + cross(e0, w1), cross(e0, w0)];
    let g = [e1.dot(&e1), 2.0 * e0.dot(&e1), e0.dot(&e0)];
    (q, g)
}

/// Returns the product of two polynomials.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut result = vec![0.0; a.len() + b.len() - 1];
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            result[i + j] += a * b;
        }
    }
    result
}

fn derivative(p: &[f64; 3]) -> [f64; 2] {
    [2.0 * p[0], p[1]]
}

/// Returns the overlap polynomial for the infinite line. `square` is the square of the sum of the radii.
pub fn quartic(bodies: &[PointMotion; 3], square: f64) -> Vec<f64> {
    let (q, g) = quadratics(bodies);
    let mut result: Vec<f64> = product(&q, &q).iter().map(|coefficient| -coefficient).collect();
    for (k, g) in g.iter().enumerate() {
        result[k + 2] += square * g;
    }
    result
}

/// Returns the approach polynomial. All its coefficients are mathematically right.
pub fn quintic(bodies: &[PointMotion; 3]) -> Vec<f64> {
    let (q, g) = quadratics(bodies);
    let first = product(&derivative(&q), &g);
    let second = product(&q, &derivative(&g));
    let inner: Vec<f64> = first.iter().zip(&second).map(|(first, second)| 2.0 * first - second).collect();
    product(&q, &inner).iter().map(|coefficient| -0.5 * coefficient).collect()
}

/// Returns the polynomial alpha < 1, computed from the letters of the other polynomials.
pub fn alpha_below_one([one, two, three]: &[PointMotion; 3]) -> Vec<f64> {
    let (x12, x32) = (one.start - two.start, three.start - two.start);
    let (d12, d32) = (one.shift - two.shift, three.shift - two.shift);
    let slope = x12.dot(&d32) + d12.dot(&x32);
    vec![d32.dot(&d32) - d12.dot(&d32), 2.0 * d32.dot(&x32) - slope, x32.dot(&x32) - x12.dot(&x32)]
}
