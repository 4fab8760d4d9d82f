//! Two-dimensional vectors with the original's order of operations.
//!
//! [`Vec2`] has exactly the operations that the specification uses, each rounded as it says (`simulation.md`,
//! conventions). **It has no division and no `normalize`**: the original multiplies by the reciprocal where a library
//! would divide each component. Use [`over`] and [`unit`](fn@unit).

use std::iter::Sum;
use std::ops::{Add, AddAssign, Index, Mul, MulAssign, Neg, Sub, SubAssign};

/// A point or a direction in the plane, in the scene's length unit; x to the right, y up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec2 {
    /// To the right.
    pub x: f64,
    /// Up.
    pub y: f64,
}

impl Vec2 {
    /// The vector `(x, y)`.
    #[inline]
    #[must_use]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The vector `(0, 0)`.
    #[inline]
    #[must_use]
    pub const fn zeros() -> Self {
        Self::new(0.0, 0.0)
    }

    /// The inner product, `x*x' + y*y'`: two products and a sum, each rounded.
    #[inline]
    #[must_use]
    pub fn dot(&self, other: &Self) -> f64 {
        self.x * other.x + self.y * other.y
    }
}

impl Add for Vec2 {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Vec2 {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl Neg for Vec2 {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}

impl Mul<Vec2> for f64 {
    type Output = Vec2;

    #[inline]
    fn mul(self, v: Vec2) -> Vec2 {
        Vec2::new(self * v.x, self * v.y)
    }
}

impl Mul<f64> for Vec2 {
    type Output = Self;

    #[inline]
    fn mul(self, scalar: f64) -> Self {
        Self::new(self.x * scalar, self.y * scalar)
    }
}

impl AddAssign for Vec2 {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Vec2 {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign<f64> for Vec2 {
    #[inline]
    fn mul_assign(&mut self, scalar: f64) {
        *self = *self * scalar;
    }
}

impl Sum for Vec2 {
    /// From left to right, beginning with zero.
    fn sum<I: Iterator<Item = Self>>(vectors: I) -> Self {
        vectors.fold(Self::zeros(), Add::add)
    }
}

impl From<[f64; 2]> for Vec2 {
    #[inline]
    fn from([x, y]: [f64; 2]) -> Self {
        Self::new(x, y)
    }
}

impl From<Vec2> for [f64; 2] {
    #[inline]
    fn from(v: Vec2) -> Self {
        [v.x, v.y]
    }
}

impl Index<usize> for Vec2 {
    type Output = f64;

    /// `x` at 0, `y` at 1; panics at any other index.
    #[inline]
    fn index(&self, index: usize) -> &f64 {
        [&self.x, &self.y][index]
    }
}

/// `v / s` as the original evaluates it: `r = 1/s`, then `(r*v.x, r*v.y)`. `s = 0` gives infinities or NaN.
#[inline]
#[must_use]
pub fn over(v: Vec2, s: f64) -> Vec2 {
    let reciprocal = 1.0 / s;
    Vec2::new(reciprocal * v.x, reciprocal * v.y)
}

/// The length `sqrt(x*x + y*y)`, without rescaling: it over- and underflows where the squares do.
#[inline]
#[must_use]
pub fn length(v: Vec2) -> f64 {
    (v.x * v.x + v.y * v.y).sqrt()
}

/// `v` divided by its length, by way of the reciprocal. The zero vector gives NaN components (`0 * inf`).
#[inline]
#[must_use]
pub fn unit(v: Vec2) -> Vec2 {
    let reciprocal = 1.0 / length(v);
    Vec2::new(v.x * reciprocal, v.y * reciprocal)
}

/// Reads the vector of element `index` from an array in trace order (`x0, y0, x1, y1, ...`).
#[inline]
#[must_use]
pub fn at(array: &[f64], index: usize) -> Vec2 {
    Vec2::new(array[2 * index], array[2 * index + 1])
}

/// Writes the vector of element `index` into an array in trace order.
#[inline]
pub fn put(array: &mut [f64], index: usize, v: Vec2) {
    array[2 * index] = v.x;
    array[2 * index + 1] = v.y;
}
