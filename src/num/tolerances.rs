//! Every tolerance of the crate: unit, meaning, and what changing it breaks.

/// Leading coefficients below this are dropped before a polynomial is solved or logged (absolute, strict;
/// root-finder.md 15.1). Changing it changes every trace.
pub const LEADING_COEFFICIENT: f64 = 1e-12;

/// Zeros whose imaginary part is below this count as real (absolute, strict; root-finder.md 15.3).
pub const IMAGINARY_PART: f64 = 1e-8;

/// Parity: contact normals may differ by this Euclidean distance (scene length unit; oracle-behaviour.md 6).
pub const PARITY_NORMAL: f64 = 1e-9;

/// Parity: a rescaled coefficient may differ by this (absolute, whatever its size; oracle-behaviour.md 6).
pub const PARITY_COEFFICIENT: f64 = 1e-10;

/// Parity: polynomials whose coefficients' moduli sum to less than this count as zero (oracle-behaviour.md 6).
pub const PARITY_ZERO_POLYNOMIAL: f64 = 1e-10;

/// Parity: bound of the accumulated position and velocity residuals (strict; oracle-behaviour.md 6).
pub const PARITY_ACCUMULATED: f64 = 1e-6;

/// Parity: bound of the maximum position and velocity residuals (strict; oracle-behaviour.md 6).
pub const PARITY_MAXIMUM: f64 = 1e-10;

/// Newton's method of implicit-euler stops when the update's norm is below this (velocity unit; simulation.md 4).
pub const NEWTON_UPDATE: f64 = 1e-9;

/// Newton's method of implicit-euler is given up after this many iterations. The original has no limit and hangs
/// (simulation.md 4); convergence takes fewer than ten. Lowering it far could refuse a scene that the original records.
pub const NEWTON_ITERATIONS: u32 = 10_000;
