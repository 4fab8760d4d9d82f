//! Sums of products outside detection. This student's compiler rounds after each operation, or fuses a product and a
//! sum.
use fosssim_num::vector::{Vec2, set_vector, vector_at};

use super::{Mistake, author::Student};

/// Returns a number rounded to single precision.
pub fn round_to_f32(value: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "the mistake is to use a float instead of a double")]
    let single = value as f32;
    f64::from(single)
}

impl Student {
    /// Returns `addend + a * b`.
    pub fn add_product(self, addend: f64, a: f64, b: f64) -> f64 {
        if self.makes(Mistake::FusedArithmetic) {
            #[expect(clippy::disallowed_methods, reason = "a student's compiler may fuse operations")]
            return a.mul_add(b, addend);
        }
        addend + a * b
    }

    /// Returns `v + s * w`.
    pub fn add_scaled(self, v: Vec2, s: f64, w: Vec2) -> Vec2 {
        Vec2::new(self.add_product(v.x, s, w.x), self.add_product(v.y, s, w.y))
    }

    /// Returns the dot product of two vectors, rounded as this student's compiler does.
    pub fn dot(self, a: Vec2, b: Vec2) -> f64 {
        self.add_product(a.x * b.x, a.y, b.y)
    }

    /// Returns `a + factor * b`, entry by entry.
    pub fn add_scaled_lists(self, a: &[f64], factor: f64, b: &[f64]) -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| self.add_product(*a, factor, *b)).collect()
    }

    /// Adds `s * w` to the vector of one particle.
    pub fn add_scaled_at(self, array: &mut [f64], particle: usize, s: f64, w: Vec2) {
        set_vector(array, particle, self.add_scaled(vector_at(array, particle), s, w));
    }
}
