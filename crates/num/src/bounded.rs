//! Numbers with a bound on their rounding error, by running error analysis.
//!
//! A [`BoundedValue`] is a computed value with a bound. A correct program may evaluate the same formula in any order.
//! Its result then differs from the value by at most about `units * u` times the bound, where `u = 2^-53`, to first
//! order. The rules are those of Wilkinson's running error analysis (Higham, *Accuracy and Stability of Numerical
//! Algorithms*, 2nd ed., section 3.3), with the absolute values of the operands instead of the result's for sums.
//! Canceling terms therefore keep their weight, and the bound also covers other orders of summation. Bounds are never
//! written to a trace.
use super::{
    lanes::{Modulus, Number, Plane},
    vector::Vec2,
};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The unit roundoff of doubles, `2^-53`.
pub const UNIT_ROUNDOFF: f64 = 1.110_223_024_625_156_5e-16;

/// A value and a bound of its error, in units of [`UNIT_ROUNDOFF`] times the unit of the value. There may be one
/// number, or one in each [lane](super::lanes).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BoundedValue<N = f64> {
    /// The computed value.
    pub value: N,
    /// The sum of the absolute values of all rounded intermediate results, weighted by their effect; at least 0, or
    /// NaN.
    pub bound: N,
}

/// A vector of bounded components.
pub type BoundedVector<N = f64> = Plane<BoundedValue<N>>;

impl BoundedValue {
    /// Returns a number without error, such as a factor of a formula.
    #[inline]
    pub const fn from_exact(value: f64) -> Self {
        Self { value, bound: 0.0 }
    }

    /// Returns an input with an error of at most one rounding.
    #[inline]
    pub const fn from_rounded(value: f64) -> Self {
        Self { value, bound: value.abs() }
    }
}

impl BoundedVector {
    /// Returns a vector without error.
    #[inline]
    pub fn from_exact(v: Vec2) -> Self {
        Self { x: BoundedValue::from_exact(v.x), y: BoundedValue::from_exact(v.y) }
    }

    /// Returns a vector whose components each have an error of at most one rounding.
    #[inline]
    pub fn from_rounded(v: Vec2) -> Self {
        Self { x: BoundedValue::from_rounded(v.x), y: BoundedValue::from_rounded(v.y) }
    }
}

impl<N: Number + Modulus> Add for BoundedValue<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let rounding = self.value.modulus() + other.value.modulus();
        Self { value: self.value + other.value, bound: self.bound + other.bound + rounding }
    }
}

impl<N: Number + Modulus> Sub for BoundedValue<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let rounding = self.value.modulus() + other.value.modulus();
        Self { value: self.value - other.value, bound: self.bound + other.bound + rounding }
    }
}

impl<N: Number + Modulus> Mul for BoundedValue<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let bound = self.bound * other.value.modulus() + self.value.modulus() * other.bound + value.modulus();
        Self { value, bound }
    }
}

/// If the divisor is 0, the bound is infinite or NaN.
impl Div for BoundedValue {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let bound = (self.bound + value.abs() * other.bound) / other.value.abs() + value.abs();
        Self { value, bound }
    }
}

impl<N: Number> Neg for BoundedValue<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, bound: self.bound }
    }
}

/// The factor is exact.
impl Mul<BoundedValue> for f64 {
    type Output = BoundedValue;
    #[inline(always)]
    fn mul(self, other: BoundedValue) -> BoundedValue {
        let value = self * other.value;
        BoundedValue { value, bound: self.abs() * other.bound + value.abs() }
    }
}

/// An upper bound of a number's absolute value. A difference is computed as a sum. A formula of such numbers gives
/// upper bounds of its results and of their error bounds, whatever the signs.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Magnitude(pub f64);

impl Modulus for Magnitude {
    fn modulus(self) -> Self {
        self
    }
}

impl Add for Magnitude {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Magnitude {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "whatever the signs, a difference is no larger than the sum")]
    fn sub(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Mul for Magnitude {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Neg for Magnitude {
    type Output = Self;
    fn neg(self) -> Self {
        self
    }
}

/// The factor is exact.
impl Mul<BoundedValue<Magnitude>> for f64 {
    type Output = BoundedValue<Magnitude>;
    fn mul(self, other: BoundedValue<Magnitude>) -> BoundedValue<Magnitude> {
        let value = Magnitude(self.abs() * other.value.0);
        BoundedValue { value, bound: Magnitude(self.abs() * other.bound.0) + value }
    }
}

impl<N: Number + Modulus> Mul<BoundedVector<N>> for BoundedValue<N> {
    type Output = BoundedVector<N>;
    #[inline(always)]
    fn mul(self, other: BoundedVector<N>) -> BoundedVector<N> {
        Plane { x: self * other.x, y: self * other.y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// These are the rules of running error analysis for numbers that can be computed by hand.
    #[test]
    fn each_operation_has_the_bound_of_its_rule() {
        let number = |value: f64, bound: f64| BoundedValue { value, bound };
        let (a, b) = (number(-12.0, 5.0), number(4.0, 3.0));
        assert_eq!(a + b, number(-8.0, 5.0 + 3.0 + 12.0 + 4.0));
        assert_eq!(a - b, number(-16.0, 5.0 + 3.0 + 12.0 + 4.0));
        assert_eq!(a * b, number(-48.0, 5.0 * 4.0 + 12.0 * 3.0 + 48.0));
        assert_eq!(a / b, number(-3.0, (5.0 + 3.0 * 3.0) / 4.0 + 3.0));
        assert_eq!(-2.0 * a, number(24.0, 2.0 * 5.0 + 24.0));
        assert_eq!(-a, number(12.0, 5.0));
        let size = |value: f64, bound: f64| BoundedValue { value: Magnitude(value), bound: Magnitude(bound) };
        let (c, d) = (size(12.0, 5.0), size(4.0, 3.0));
        assert_eq!(c + d, size(16.0, 24.0));
        assert_eq!(c - d, size(16.0, 24.0));
        assert_eq!(c * d, size(48.0, 104.0));
        assert_eq!(-2.0 * c, size(24.0, 34.0));
        let vector = BoundedVector::from_rounded(Vec2::new(-12.0, 4.0));
        assert_eq!((vector.x, vector.y), (number(-12.0, 12.0), number(4.0, 4.0)));
        let twice = b * vector;
        assert_eq!((twice.x, twice.y), (b * vector.x, b * vector.y));
    }

    /// `(a + b) - a` with a large `a`: the remaining part of `b` may deviate by a rounding of `a`, and the bound must
    /// cover it.
    #[test]
    fn canceled_terms_keep_their_weight() {
        let (a, b) = (BoundedValue::from_exact(1e10), BoundedValue::from_exact(0.1));
        let left = (a + b) - a;
        assert!((left.value - 0.1).abs() > 1e-8);
        assert!((left.value - 0.1).abs() <= left.bound * UNIT_ROUNDOFF);
    }

    /// Tests that neither value nor bound is larger than its size, whatever the signs of the inputs.
    #[test]
    fn sizes_are_the_most_that_values_and_bounds_can_be() {
        let number = |value: f64| BoundedValue { value, bound: 2.0 * value.abs() };
        let size = |value: f64| BoundedValue { value: Magnitude(value), bound: Magnitude(2.0 * value) };
        let (a, b, c) = (size(0.7), size(1.3), size(0.1));
        let most = -2.0 * (a * b - c * a) + b;
        for signs in 0..8 {
            let sign = |bit: u32| if signs >> bit & 1 == 1 { -1.0 } else { 1.0 };
            let (a, b, c) = (number(sign(0) * 0.7), number(sign(1) * 1.3), number(sign(2) * 0.1));
            let found = -2.0 * (a * b - c * a) + b;
            assert!(found.value.abs() <= most.value.0 && found.bound <= most.bound.0 * (1.0 + 1e-15), "{signs}");
        }
    }

    #[test]
    fn a_quotient_knows_its_condition() {
        let quotient = BoundedValue::from_rounded(1.0) / BoundedValue { value: 1e-8, bound: 1.0 };
        assert_eq!(quotient.value, 1e8);
        assert!(quotient.bound >= 1e16);
        assert!(!(BoundedValue::from_rounded(1.0) / BoundedValue::from_exact(0.0)).bound.is_finite());
    }

    /// Two orders of summing the same dot product differ by less than the bounds allow.
    #[test]
    fn other_orders_of_evaluation_stay_within_the_bound() {
        let (a, b) = (Vec2::new(0.1, -0.3), Vec2::new(0.7, 0.233_333));
        let bounded = BoundedVector::from_exact(a).dot(BoundedVector::from_exact(b));
        let otherwise = a.y * b.y + a.x * b.x;
        assert_eq!(bounded.value, a.dot(&b));
        assert!((bounded.value - otherwise).abs() <= bounded.bound * UNIT_ROUNDOFF);
    }
}
