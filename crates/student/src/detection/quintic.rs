//! The approach of a particle and an edge: the quintic that the course supplies, and what becomes of it.
use super::{MovingBody, factorized};
use crate::{Area, Mistake, author::Student};

/// The parts of the assignment whose mistakes are made here.
const HERE: &[Area] = &[Area::ParticleEdge];

/// Returns the quintic, or this student's replacement.
pub fn approach(student: Student, bodies: &[MovingBody; 3]) -> Vec<f64> {
    let supplied = || supplied(student, bodies);
    match student.mistake_in(HERE) {
        Some(Mistake::QuinticConstantAlpha) => constant_alpha(bodies),
        Some(Mistake::QuinticNegated) => supplied().iter().map(|coefficient| -coefficient).collect(),
        Some(Mistake::QuinticMissing) => vec![1.0],
        Some(Mistake::QuinticLowestFirst) => supplied().into_iter().rev().collect(),
        Some(Mistake::QuinticNoConstant) => {
            let mut list = supplied();
            list[5] = 0.0;
            list
        }
        Some(Mistake::QuinticCutToLinear) => supplied().split_off(4),
        Some(Mistake::QuinticRight | Mistake::FactorizedAll) => factorized::quintic(bodies),
        _ => supplied(),
    }
}

/// Returns the course's formula, term by term and in its order, its wrong cubic coefficient included unless that was
/// put right.
fn supplied(student: Student, [one, two, three]: &[MovingBody; 3]) -> Vec<f64> {
    let (x12, x32, x21) = (one.start - two.start, three.start - two.start, two.start - one.start);
    let d12 = one.displacement - two.displacement;
    let d32 = three.displacement - two.displacement;
    let d21 = two.displacement - one.displacement;
    let a = x32.dot(&x32);
    let b = x32.dot(&d32);
    let c = d32.dot(&d32);
    let d = if student.makes(Mistake::QuinticOldLetter) { x21.dot(&x21) } else { d21.dot(&d21) };
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
    let cubic_slip = if student.approach_is_right() { 2.0 * f * h * q } else { 2.0 * f * g * q };
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

/// Returns the simplification that the assignment warns of: alpha stays as it is at the start of the step.
fn constant_alpha([one, two, three]: &[MovingBody; 3]) -> Vec<f64> {
    let along = three.start - two.start;
    let alpha = (one.start - two.start).dot(&along) / along.dot(&along);
    let closing = one.displacement - two.displacement - alpha * (three.displacement - two.displacement);
    let n = two.start + alpha * along - one.start;
    vec![-closing.dot(&closing), closing.dot(&n)]
}
