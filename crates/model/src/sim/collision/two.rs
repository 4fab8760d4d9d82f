//! Two numbers that undergo the same operations, as every processor does at once: where pairs are computed one by one.
//!
//! Each rounds like a single number, so no bit depends on how pairs are put together.
use fosssim_num::{lanes::Plane, vector::Vec2};
use std::ops::{Add, Mul, Neg, Sub};

/// Two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Two(pub [f64; 2]);

impl Add for Two {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Sub for Two {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self([self.0[0] - other.0[0], self.0[1] - other.0[1]])
    }
}

impl Mul for Two {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}

impl Mul<Two> for f64 {
    type Output = Two;
    #[inline(always)]
    fn mul(self, other: Two) -> Two {
        Two([self * other.0[0], self * other.0[1]])
    }
}

impl Neg for Two {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self([-self.0[0], -self.0[1]])
    }
}

/// Two vectors.
#[inline(always)]
pub(super) fn two([a, b]: [Vec2; 2]) -> Plane<Two> {
    Plane { x: Two([a.x, b.x]), y: Two([a.y, b.y]) }
}
