//! The position polynomials in twice the usual precision, rounded once at the end, as a program with `long double`
//! would compute them.
//!
//! A number is an unevaluated sum of two doubles (T. J. Dekker, *A floating-point technique for extending the available
//! precision*, Numerische Mathematik 18, 1971).
use std::ops::{Add, Mul, Sub};

use crate::num::vector::Vec2;

use super::Body;

#[derive(Clone, Copy)]
struct Wide {
    high: f64,
    low: f64,
}

impl From<f64> for Wide {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

/// `a + b` exactly.
fn two_sum(a: f64, b: f64) -> Wide {
    let high = a + b;
    let part = high - a;
    Wide { high, low: (a - (high - part)) + (b - part) }
}

/// `a + b` exactly, `a` being the larger in size.
fn quick_two_sum(a: f64, b: f64) -> Wide {
    let high = a + b;
    Wide { high, low: b - (high - a) }
}

/// Splits a double into two of half the length.
fn split(a: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

/// `a * b` exactly.
fn two_product(a: f64, b: f64) -> Wide {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    Wide { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Add for Wide {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = two_sum(self.high, other.high);
        quick_two_sum(sum.high, sum.low + (self.low + other.low))
    }
}

impl Sub for Wide {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for Wide {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        quick_two_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

type WideVec = [Wide; 2];

fn wide(v: Vec2) -> WideVec {
    [v.x.into(), v.y.into()]
}

fn minus(a: WideVec, b: WideVec) -> WideVec {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: WideVec, b: WideVec) -> Wide {
    a[0] * b[0] + a[1] * b[1]
}

fn rounded(list: &[Wide]) -> Vec<f64> {
    list.iter().map(|wide| wide.high).collect()
}

/// The overlap of two particles.
pub fn particle_particle(one: &Body, two: &Body) -> Vec<f64> {
    let x = minus(wide(two.start), wide(one.start));
    let d = minus(wide(two.displacement), wide(one.displacement));
    let reach = Wide::from(one.radius) + Wide::from(two.radius);
    let zero = Wide::from(0.0);
    rounded(&[zero - dot(d, d), Wide::from(-2.0) * dot(x, d), reach * reach - dot(x, x)])
}

/// The overlap of a particle with a half-plane.
pub fn particle_half_plane(one: &Body, point: Vec2, normal: Vec2) -> Vec<f64> {
    let q = wide(normal);
    let s = dot(wide(one.displacement), q);
    let w = dot(minus(wide(point), wide(one.start)), q);
    let radius = Wide::from(one.radius);
    rounded(&[Wide::from(0.0) - s * s, Wide::from(2.0) * w * s, radius * radius * dot(q, q) - w * w])
}

/// The overlap of a particle with an edge's line.
pub fn particle_edge([one, two, three]: &[Body; 3], edge_radius: f64) -> Vec<f64> {
    let w0 = minus(wide(one.start), wide(two.start));
    let w1 = minus(wide(one.displacement), wide(two.displacement));
    let e0 = minus(wide(three.start), wide(two.start));
    let e1 = minus(wide(three.displacement), wide(two.displacement));
    let cross = |a: WideVec, b: WideVec| a[0] * b[1] - a[1] * b[0];
    let two = Wide::from(2.0);
    let (q2, q1, q0) = (cross(e1, w1), cross(e1, w0) + cross(e0, w1), cross(e0, w0));
    let (g2, g1, g0) = (dot(e1, e1), two * dot(e0, e1), dot(e0, e0));
    let reach = Wide::from(one.radius) + Wide::from(edge_radius);
    let s = reach * reach;
    rounded(&[
        Wide::from(0.0) - q2 * q2,
        Wide::from(0.0) - two * q2 * q1,
        s * g2 - (q1 * q1 + two * q2 * q0),
        s * g1 - two * q1 * q0,
        s * g0 - q0 * q0,
    ])
}
