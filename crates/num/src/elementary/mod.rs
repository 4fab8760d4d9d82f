//! The elementary functions of the numeric core, with one implementation for every target.
//!
//! A submission calls those of its C library, and the original was recorded with them (root-finder.md 0.5,
//! collisions.md 5). This is the GNU C library, 2.28 or later, on a processor with fused multiply-add. None of them is
//! always correctly rounded, so another implementation changes the last bit of a few results in a thousand. The
//! functions here return that library's bits on every target and processor. They use its algorithms and tables, and a
//! fused operation wherever its machine code has one. NaN's sign and payload are not specified. No other code of the
//! crate may call the standard library's methods; `clippy.toml` enforces that.
#![expect(clippy::disallowed_methods, reason = "the bits are those of fused operations")]

mod exponential;
mod logarithm;
mod reduction;
mod tables;
mod trigonometry;

pub use exponential::exp;
pub use logarithm::ln;
pub use trigonometry::{cos, sin};

/// Returns `a * b + c`, rounded once.
#[inline]
fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
    a.mul_add(b, c)
}

#[cfg(test)]
mod tests;
