//! Vectors and states as nalgebra's types, at the border to programs that compute with those (feature `nalgebra`).
//!
//! Inside, [`Vec2`] stays: nalgebra divides each component where the original multiplies by the reciprocal, and an
//! operator can't be forbidden by a lint. Conversion changes no bit.
use super::vector::Vec2;
use nalgebra::{MatrixView2xX, Vector2};

impl From<Vec2> for Vector2<f64> {
    fn from(vector: Vec2) -> Self {
        Self::new(vector.x, vector.y)
    }
}

impl From<Vector2<f64>> for Vec2 {
    fn from(vector: Vector2<f64>) -> Self {
        Self::new(vector.x, vector.y)
    }
}

/// The positions or velocities of a state, `x` and `y` of each particle in turn, as a matrix with a column per
/// particle. Nothing is copied.
#[must_use]
pub fn columns(values: &[f64]) -> MatrixView2xX<'_, f64> {
    MatrixView2xX::from_slice(values, values.len() / 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        linear::{Workspace, solve},
        vector::over,
    };
    use nalgebra::{DMatrix, DVector};
    use proptest::{prelude::*, test_runner::RngSeed};

    fn bits(vector: Vec2) -> [u64; 2] {
        [vector.x.to_bits(), vector.y.to_bits()]
    }

    fn vector() -> impl Strategy<Value = Vec2> {
        (-1e3..1e3, -1e3..1e3).prop_map(|(x, y)| Vec2::new(x, y))
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: RngSeed::Fixed(1),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        #[test]
        fn sums_products_and_the_inner_product_have_nalgebras_bits(a in vector(), b in vector(), s in -1e3..1e3) {
            let (c, d) = (Vector2::from(a), Vector2::from(b));
            prop_assert_eq!(bits(a + b), bits((c + d).into()));
            prop_assert_eq!(bits(a - b), bits((c - d).into()));
            prop_assert_eq!(bits(a * s), bits((c * s).into()));
            prop_assert_eq!(a.dot(&b).to_bits(), c.dot(&d).to_bits());
        }

        /// An independent method finds what the original's order of operations finds.
        #[test]
        fn the_solver_agrees_with_singular_values(list in prop::collection::vec(-1.0..1.0, 42)) {
            let (n, mut rhs) = (6, list[36..].to_vec());
            // A dominant diagonal keeps the matrix regular.
            let matrix = DMatrix::from_column_slice(n, n, &list[..36]) + DMatrix::identity(n, n) * 8.0;
            let target = DVector::from_column_slice(&rhs);
            let expected = matrix.clone().svd(true, true).solve(&target, 1e-12).expect("both factors");
            solve(matrix.clone().as_mut_slice(), &mut rhs, &mut Workspace::default());
            let found = DVector::from_column_slice(&rhs);
            prop_assert!((matrix * &found - target).norm() < 1e-13);
            // The decomposition is iterative: it leaves a residual of up to 1e-11.
            prop_assert!((found - expected).norm() < 1e-9);
        }
    }

    #[test]
    fn division_differs_which_is_why_our_type_has_none() {
        let differs = |n: u32| {
            let (vector, divisor) = (Vec2::new(f64::from(n), 1.0), 1.0 + f64::from(n) / 7.0);
            bits(over(vector, divisor)) != bits((Vector2::from(vector) / divisor).into())
        };
        assert!((1..1000).any(differs));
    }

    #[test]
    fn a_state_is_a_matrix_with_a_column_per_particle() {
        let matrix = columns(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!((matrix.ncols(), Vec2::from(matrix.column(1).into_owned())), (2, Vec2::new(3.0, 4.0)));
    }
}
