//! The approach of a particle and an edge, which is the quintic supplied by the course, and its variants.
use super::factorized;
use fosssim_model::sim::PointMotion;

use crate::{Area, Mistake, author::Student};

/// Returns the quintic, as supplied or computed in another way with the right coefficients.
pub fn approach(student: Student, bodies: &[PointMotion; 3]) -> Vec<f64> {
    match student.mistake_in(&[Area::ParticleEdge]) {
        Some(Mistake::QuinticRight | Mistake::FactorizedAll) => factorized::quintic(bodies),
        _ => course_formula(student, bodies),
    }
}

/// Returns the course's formula, term by term and in its order, with its wrong cubic coefficient unless the student has
/// corrected it.
fn course_formula(student: Student, [one, two, three]: &[PointMotion; 3]) -> Vec<f64> {
    let (x12, x32, x21) = (one.start - two.start, three.start - two.start, two.start - one.start);
    let d12 = one.shift - two.shift;
    let d32 = three.shift - two.shift;
    let d21 = two.shift - one.shift;
    let a = x32.dot(&x32);
    let b = x32.dot(&d32);
    let c = d32.dot(&d32);
    let d = d21.dot(&d21);
    let e = d21.dot(&x21);
    let f = x12.dot(&x32);
    let g = x12.dot(&d32) + d12.dot(&x32);
    let h = d12.dot(&d32);
    let i = d32.dot(&x21) + d21.dot(&x32);
    let j = d32.dot(&d21);
    let k = a * f;
    let l = a * g + 2.0 * b * f;
    let m = a * h + 2.0 * b * g + c * f;
    let n = c * g + 2.0 * b * h;
    let o = c * h;
    let (p, q) = (b, c);
    let cubic_slip = if student.has_right_approach() { 2.0 * f * h * q } else { 2.0 * f * g * q };
    vec![
        -h * h * q - c * c * d - 2.0 * o * j,
        -h * h * p - 2.0 * g * h * q - 4.0 * b * c * d - c * c * e - o * i - 2.0 * n * j,
        -2.0 * g * h * p
            - cubic_slip
            - g * g * q
            - 2.0 * a * c * d
            - 4.0 * b * b * d
            - 4.0 * b * c * e
            - n * i
            - 2.0 * m * j,
        -2.0 * f * h * p
            - g * g * p
            - 2.0 * f * g * q
            - 4.0 * a * b * d
            - 2.0 * a * c * e
            - 4.0 * b * b * e
            - m * i
            - 2.0 * l * j,
        -2.0 * f * g * p - f * f * q - a * a * d - 4.0 * a * b * e - l * i - 2.0 * k * j,
        -f * f * p - a * a * e - k * i,
    ]
}
