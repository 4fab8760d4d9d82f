//! Two-dimensional vectors with the original's order of operations.
//!
//! The vectors are nalgebra's, whose sums, products and inner product are rounded as the specification requires
//! (`simulation.md`, conventions). **No code divides or normalizes them with nalgebra's operations.** The original
//! multiplies by the reciprocal where a library divides each component. Use [`divide`] and [`unit`](fn@unit); the lints
//! of the numeric crates enforce this.
use nalgebra::{MatrixView2xX, Vector2};

/// A point or a direction in the plane, in the scene's length unit; x to the right, y up.
pub type Vec2 = Vector2<f64>;

/// Returns `v / s`, evaluated like the original: `r = 1/s`, then `(r*v.x, r*v.y)`. `s = 0` gives infinities or NaN.
#[inline]
pub fn divide(v: Vec2, s: f64) -> Vec2 {
    let reciprocal = 1.0 / s;
    Vec2::new(reciprocal * v.x, reciprocal * v.y)
}

/// Returns the length `sqrt(x*x + y*y)`, without rescaling, so it overflows and underflows with the squares.
#[inline]
pub fn length(v: Vec2) -> f64 {
    (v.x * v.x + v.y * v.y).sqrt()
}

/// Returns `v` divided by its length, using the reciprocal. The zero vector gives NaN components (`0 * inf`).
#[inline]
pub fn unit(v: Vec2) -> Vec2 {
    let reciprocal = 1.0 / length(v);
    Vec2::new(v.x * reciprocal, v.y * reciprocal)
}

/// Returns a matrix that has one column per particle, without copying. `values` contains the positions or velocities of
/// a state, with `x` and `y` of each particle in turn.
pub fn columns(values: &[f64]) -> MatrixView2xX<'_, f64> {
    MatrixView2xX::from_slice(values, values.len() / 2)
}

/// Returns whether two lists are identical, bit for bit.
#[inline]
pub fn has_same_bits(one: &[f64], other: &[f64]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one.to_bits() == other.to_bits())
}

/// Returns the vector of element `index` of an array in trace order (`x0, y0, x1, y1, ...`).
#[inline]
pub fn vector_at(array: &[f64], index: usize) -> Vec2 {
    Vec2::new(array[2 * index], array[2 * index + 1])
}

/// Writes the vector of element `index` into an array in trace order.
#[inline]
pub fn set_vector(array: &mut [f64], index: usize, v: Vec2) {
    array[2 * index] = v.x;
    array[2 * index + 1] = v.y;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::{Workspace, solve};
    use nalgebra::{DMatrix, DVector};
    use proptest::{prelude::*, test_runner::RngSeed};

    fn bits(vector: Vec2) -> [u64; 2] {
        [vector.x.to_bits(), vector.y.to_bits()]
    }

    fn vector() -> impl Strategy<Value = Vec2> {
        (-1e3..1e3, -1e3..1e3).prop_map(|(x, y)| Vec2::new(x, y))
    }

    /// With the reciprocal, five thirds are one rounding error smaller than with a division.
    #[test]
    fn a_vector_is_divided_by_way_of_the_reciprocal() {
        let reciprocal = 1.0 / 3.0;
        assert_eq!(bits(divide(Vec2::new(5.0, -7.0), 3.0)), bits(Vec2::new(reciprocal * 5.0, reciprocal * -7.0)));
        assert!(divide(Vec2::new(5.0, 0.0), 3.0).x < 5.0 / 3.0);
        assert_eq!(divide(Vec2::new(1.0, -1.0), 0.0), Vec2::new(f64::INFINITY, f64::NEG_INFINITY));
    }

    #[test]
    fn a_vector_that_is_put_into_an_array_is_there() {
        let mut array = [0.0; 6];
        set_vector(&mut array, 1, Vec2::new(2.0, 3.0));
        assert_eq!((array, vector_at(&array, 1)), ([0.0, 0.0, 2.0, 3.0, 0.0, 0.0], Vec2::new(2.0, 3.0)));
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: RngSeed::Fixed(1),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        /// The sums and products are those of the components, as written in the specification.
        #[test]
        fn sums_and_products_are_those_of_the_components(a in vector(), b in vector(), s in -1e3..1e3) {
            prop_assert_eq!(bits(a + b), bits(Vec2::new(a.x + b.x, a.y + b.y)));
            prop_assert_eq!(bits(a - b), bits(Vec2::new(a.x - b.x, a.y - b.y)));
            prop_assert_eq!(bits(a * s), bits(Vec2::new(a.x * s, a.y * s)));
            prop_assert_eq!(a.dot(&b).to_bits(), (a.x * b.x + a.y * b.y).to_bits());
        }

        /// An independent method must agree with the original's order of operations.
        #[test]
        fn the_solver_agrees_with_singular_values(list in prop::collection::vec(-1.0..1.0, 42)) {
            let (n, mut rhs) = (6, list[36..].to_vec());
            // A dominant diagonal keeps the matrix regular.
            let matrix = DMatrix::from_column_slice(n, n, &list[..36]) + DMatrix::identity(n, n) * 8.0;
            let target = DVector::from_column_slice(&rhs);
            let expected = matrix.clone().svd(true, true).solve(&target, 1e-12).expect("both factors");
            solve(matrix.clone().as_mut_slice(), &mut rhs, &mut Workspace::default());
            let found = DVector::from_column_slice(&rhs);
            prop_assert!((matrix * &found - target).amax() < 1e-13);
            // The decomposition is iterative and leaves a residual of up to 1e-11.
            prop_assert!((found - expected).amax() < 1e-9);
        }
    }

    #[test]
    fn division_differs_which_is_why_nobody_may_use_it() {
        let differs = |n: u32| {
            let (vector, divisor) = (Vec2::new(f64::from(n), 1.0), 1.0 + f64::from(n) / 7.0);
            bits(divide(vector, divisor)) != bits(vector / divisor)
        };
        assert!((1..1000).any(differs));
    }

    #[test]
    fn a_state_is_a_matrix_with_a_column_per_particle() {
        let matrix = columns(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!((matrix.ncols(), matrix.column(1).into_owned()), (2, Vec2::new(3.0, 4.0)));
    }
}
