//! Gaussian elimination with complete pivoting, in the original's order of operations (simulation.md 5).

/// Scratch space of [`solve`], kept between calls so that none allocates after the first.
#[derive(Debug, Clone, Default)]
pub struct Workspace {}

/// Solves `A d = rhs` in place: `matrix` is n x n **column-major** and destroyed, `rhs` becomes the solution.
/// n is even. A rank-deficient matrix gives zeros for the unknowns beyond its rank.
pub fn solve(_matrix: &mut [f64], _rhs: &mut [f64], _workspace: &mut Workspace) {}
