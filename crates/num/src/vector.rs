//! Two-dimensional vectors with the original's order of operations.
//!
//! [`Vec2`] is nalgebra's `Vector2<f64>`: sums, differences, `scalar * vector` and `dot` (`x*x' + y*y'`) round as the
//! specification says. **Never divide a `Vec2` by a scalar and never call its `normalize`**: nalgebra divides each
//! component, the original multiplies by the reciprocal (`simulation.md`, conventions). Use [`over`] and [`unit`](fn@unit).

/// A point or a direction in the plane, in the scene's length unit; x to the right, y up.
pub type Vec2 = nalgebra::Vector2<f64>;

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
