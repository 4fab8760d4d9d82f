//! Numbers with double the usual precision, as a program with a wider type than double would use.
//!
//! A number is an unevaluated sum of two doubles (T. J. Dekker, *A floating-point technique for extending the available
//! precision*, Numerische Mathematik 18, 1971).
use std::ops::{Add, Div, Mul, Sub};

use super::arithmetic::Number;

/// An unevaluated sum of two doubles.
#[derive(Clone, Copy)]
pub struct WideNumber {
    high: f64,
    low: f64,
}

impl From<f64> for WideNumber {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

/// Returns `a + b` exactly.
fn two_sum(a: f64, b: f64) -> WideNumber {
    let high = a + b;
    let part = high - a;
    WideNumber { high, low: (a - (high - part)) + (b - part) }
}

/// Returns `a + b` exactly; `a` must be the larger in size.
fn quick_two_sum(a: f64, b: f64) -> WideNumber {
    let high = a + b;
    WideNumber { high, low: b - (high - a) }
}

/// Returns two numbers with about half of the double's digits each. Their sum is the double.
fn split(a: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

/// Returns `a * b` exactly.
fn two_product(a: f64, b: f64) -> WideNumber {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    WideNumber { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Add for WideNumber {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = two_sum(self.high, other.high);
        quick_two_sum(sum.high, sum.low + (self.low + other.low))
    }
}

impl Sub for WideNumber {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for WideNumber {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        quick_two_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for WideNumber {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        quick_two_sum(first, rest.high / other.high)
    }
}

impl Number for WideNumber {
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }

    fn to_double(self) -> f64 {
        self.high
    }
}
