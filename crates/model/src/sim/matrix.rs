//! Adds and subtracts 2x2 blocks of body pairs in the dense matrix of the implicit integrators.
use nalgebra::{DMatrix, Matrix2};

/// Adds a block on the diagonal for each of two particles, and subtracts it where the rows of one cross the columns of
/// the other.
pub(crate) fn add_coupling(matrix: &mut DMatrix<f64>, [a, b]: [usize; 2], block: &Matrix2<f64>) {
    for [row, column] in [[a, a], [b, b]] {
        let mut target = matrix.fixed_view_mut::<2, 2>(2 * row, 2 * column);
        target += block;
    }
    for [row, column] in [[a, b], [b, a]] {
        let mut target = matrix.fixed_view_mut::<2, 2>(2 * row, 2 * column);
        target -= block;
    }
}

/// Subtracts the block, the opposite of [`add_coupling`]. Adding the negated block instead would give a NaN a different
/// sign.
pub(crate) fn subtract_coupling(matrix: &mut DMatrix<f64>, [a, b]: [usize; 2], block: &Matrix2<f64>) {
    for [row, column] in [[a, a], [b, b]] {
        let mut target = matrix.fixed_view_mut::<2, 2>(2 * row, 2 * column);
        target -= block;
    }
    for [row, column] in [[a, b], [b, a]] {
        let mut target = matrix.fixed_view_mut::<2, 2>(2 * row, 2 * column);
        target += block;
    }
}
