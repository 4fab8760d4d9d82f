//! Two numbers that undergo the same operations, as processors do at once: the formulas of two pairs for the time of one.
//!
//! Each lane rounds like a single number, so no bit depends on how pairs are put together.
use fosssim_num::vector::Vec2;
use std::ops::{Add, Mul, Neg, Sub};

/// Two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Lanes(pub [f64; 2]);

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self([self.0[0] - other.0[0], self.0[1] - other.0[1]])
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}

impl Mul<Lanes> for f64 {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, other: Lanes) -> Lanes {
        Lanes([self * other.0[0], self * other.0[1]])
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self([-self.0[0], -self.0[1]])
    }
}

/// Two vectors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Lanes2 {
    x: Lanes,
    y: Lanes,
}

impl Lanes2 {
    /// These two.
    #[inline(always)]
    pub fn new([a, b]: [Vec2; 2]) -> Self {
        Self { x: Lanes([a.x, b.x]), y: Lanes([a.y, b.y]) }
    }

    /// One vector twice.
    #[inline(always)]
    pub fn both(v: Vec2) -> Self {
        Self::new([v, v])
    }

    /// The inner products `x*x' + y*y'`.
    #[inline(always)]
    pub fn dot(self, other: Self) -> Lanes {
        self.x * other.x + self.y * other.y
    }
}

impl Sub for Lanes2 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}
