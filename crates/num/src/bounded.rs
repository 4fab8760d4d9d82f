//! Numbers that carry a bound on their rounding error: running error analysis.
//!
//! A [`Bounded`] is a computed value with a count `units`: whatever order a correct program evaluates the same formula in,
//! its result lies within about `units * u` of the value, `u = 2^-53`, to first order. The rules are those of
//! Wilkinson's running error analysis (Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., section 3.3), with
//! the modulus of the operands instead of the result's for sums: so terms that cancel keep their weight, and the bound also
//! covers other orders of summation. Nothing of this reaches a trace.
use super::{
    lanes::{Lanes, Modulus, Number, Plane, Simd},
    vector::Vec2,
};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The unit roundoff of doubles, `2^-53`.
pub const UNIT_ROUNDOFF: f64 = 1.110_223_024_625_156_5e-16;

/// A value and the bound of its error in units of [`UNIT_ROUNDOFF`] (same unit as the value); of one number, or of one in
/// each [lane](super::lanes).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bounded<N = f64> {
    /// The computed value.
    pub value: N,
    /// Sum of the moduli of everything that was rounded on the way, weighted by its effect; at least 0, or NaN.
    pub bound: N,
}

/// A vector of bounded components.
pub type Bounded2<N = f64> = Plane<Bounded<N>>;

impl Bounded {
    /// A number without error, such as a factor of a formula.
    #[inline]
    #[must_use]
    pub const fn exact(value: f64) -> Self {
        Self { value, bound: 0.0 }
    }

    /// An input that may be off by one rounding.
    #[inline]
    #[must_use]
    pub const fn rounded(value: f64) -> Self {
        Self { value, bound: value.abs() }
    }
}

impl Bounded2 {
    /// A vector without error.
    #[inline]
    #[must_use]
    pub fn exact(v: Vec2) -> Self {
        Self { x: Bounded::exact(v.x), y: Bounded::exact(v.y) }
    }

    /// A vector whose components may each be off by one rounding.
    #[inline]
    #[must_use]
    pub fn rounded(v: Vec2) -> Self {
        Self { x: Bounded::rounded(v.x), y: Bounded::rounded(v.y) }
    }
}

impl<N: Number + Modulus> Add for Bounded<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let rounding = self.value.modulus() + other.value.modulus();
        Self { value: self.value + other.value, bound: self.bound + other.bound + rounding }
    }
}

impl<N: Number + Modulus> Sub for Bounded<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let rounding = self.value.modulus() + other.value.modulus();
        Self { value: self.value - other.value, bound: self.bound + other.bound + rounding }
    }
}

impl<N: Number + Modulus> Mul for Bounded<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let bound = self.bound * other.value.modulus() + self.value.modulus() * other.bound + value.modulus();
        Self { value, bound }
    }
}

/// A divisor of 0 gives what the division gives, and a bound that is infinite or NaN.
impl Div for Bounded {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let bound = (self.bound + value.abs() * other.bound) / other.value.abs() + value.abs();
        Self { value, bound }
    }
}

impl<N: Number> Neg for Bounded<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, bound: self.bound }
    }
}

/// A factor without error.
impl Mul<Bounded> for f64 {
    type Output = Bounded;
    #[inline(always)]
    fn mul(self, other: Bounded) -> Bounded {
        let value = self * other.value;
        Bounded { value, bound: self.abs() * other.bound + value.abs() }
    }
}

/// A factor without error.
impl<S: Simd> Mul<Bounded<Lanes<S>>> for f64 {
    type Output = Bounded<Lanes<S>>;
    #[inline(always)]
    fn mul(self, other: Bounded<Lanes<S>>) -> Bounded<Lanes<S>> {
        let value = self * other.value;
        Bounded { value, bound: self.abs() * other.bound + value.abs() }
    }
}

impl<N: Number + Modulus> Mul<Bounded2<N>> for Bounded<N> {
    type Output = Bounded2<N>;
    #[inline(always)]
    fn mul(self, other: Bounded2<N>) -> Bounded2<N> {
        Plane { x: self * other.x, y: self * other.y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(a + b) - a` with a large `a`: what is left of `b` may be off by a rounding of `a`, and the bound says so.
    #[test]
    fn cancelled_terms_keep_their_weight() {
        let (a, b) = (Bounded::exact(1e10), Bounded::exact(0.1));
        let left = (a + b) - a;
        assert!((left.value - 0.1).abs() > 1e-8);
        assert!((left.value - 0.1).abs() <= left.bound * UNIT_ROUNDOFF);
    }

    #[test]
    fn a_quotient_knows_its_condition() {
        let quotient = Bounded::rounded(1.0) / Bounded { value: 1e-8, bound: 1.0 };
        assert_eq!(quotient.value, 1e8);
        assert!(quotient.bound >= 1e16);
        assert!(!(Bounded::rounded(1.0) / Bounded::exact(0.0)).bound.is_finite());
    }

    /// Two orders of summing the same dot product differ by less than the bounds allow.
    #[test]
    fn other_orders_of_evaluation_stay_within_the_bound() {
        let (a, b) = (Vec2::new(0.1, -0.3), Vec2::new(0.7, 0.233_333));
        let bounded = Bounded2::exact(a).dot(Bounded2::exact(b));
        let otherwise = a.y * b.y + a.x * b.x;
        assert_eq!(bounded.value, a.dot(&b));
        assert!((bounded.value - otherwise).abs() <= bounded.bound * UNIT_ROUNDOFF);
        assert_eq!(Bounded2::exact(a).cross(Bounded2::exact(b)).value, a.x * b.y - a.y * b.x);
    }
}
