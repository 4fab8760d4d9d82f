//! All tolerances of the project: unit, meaning, and the effect of changes.

/// Leading coefficients below this value are dropped before a polynomial is solved or logged (absolute, strict;
/// root-finder.md 15.1). Changing it changes every trace.
pub const MIN_LEADING_COEFFICIENT: f64 = 1e-12;

/// Zeros with a smaller imaginary part count as real (absolute, strict; root-finder.md 15.3).
pub const MIN_IMAGINARY_PART: f64 = 1e-8;

/// Parity: contact normals may differ by this Euclidean distance (scene length unit; oracle-behavior.md 6).
pub const PARITY_NORMAL_DISTANCE: f64 = 1e-9;

/// Parity: the absolute bound for the difference of a rescaled coefficient (oracle-behavior.md 6).
pub const PARITY_COEFFICIENT_DIFFERENCE: f64 = 1e-10;

/// Parity: polynomials count as zero if the sum of their absolute coefficients is below this bound (oracle-behavior.md
/// 6).
pub const PARITY_ZERO_COEFFICIENT_SUM: f64 = 1e-10;

/// Parity: bound of the accumulated position and velocity residuals (strict; oracle-behavior.md 6).
pub const PARITY_ACCUMULATED_RESIDUAL: f64 = 1e-6;

/// Parity: bound of the maximum position and velocity residuals (strict; oracle-behavior.md 6).
pub const PARITY_MAX_RESIDUAL: f64 = 1e-10;

/// In the contest, bodies at a smaller distance do not interact (scene length unit; simulation.md 3.1). Changing it
/// changes traces of bodies at the same position.
pub const CONTEST_MIN_DISTANCE: f64 = 1e-10;

/// Newton's method of implicit-euler stops when the update's norm is below this bound (velocity unit; simulation.md 4).
pub const NEWTON_UPDATE_NORM: f64 = 1e-9;

/// The maximum number of iterations of Newton's method in implicit-euler. The original has no limit and hangs
/// (simulation.md 4); convergence takes fewer than ten. A much lower limit could reject a scene that the original
/// records.
pub const MAX_NEWTON_ITERATIONS: u32 = 10_000;

/// Certificate: a line's zero is near if its absolute value is at most this limit (fraction of the step). With larger
/// values, rounding could decide the root finder's sample one step beyond the zero (certificate, closed forms).
pub const LINE_NEAR_LIMIT: f64 = (1_u64 << 40) as f64;

/// Certificate: a parabola's zeros are near if the coefficient of degree 2 - i is at most the leading one times the
/// i-th power of this limit. With larger values, rounding could decide the samples.
pub const PARABOLA_NEAR_LIMIT: f64 = (1_u64 << 22) as f64;

/// Certificate: a parabola is negative if its Bernstein coefficients are below this share of the sum of its absolute
/// coefficients. Smaller values do not cover the rounding of its zeros (about 2^-50).
pub const PARABOLA_MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

/// Certificate: a parabola has no real zero if `b² < 4ac` times this factor.
pub const PARABOLA_COMPLEX_FACTOR: f64 = 1.0 - 1.0 / (1_u64 << 20) as f64;

/// Certificate: the minimum product of complex zeros (fraction of the step, squared) whose imaginary parts are provably
/// above [`MIN_IMAGINARY_PART`]; with [`PARABOLA_COMPLEX_FACTOR`] they exceed 2^-10 times the square root of this
/// product.
pub const PARABOLA_MIN_ZERO_PRODUCT: f64 = 1.0 / (1_u64 << 30) as f64;

/// Certificate: the smallest product of two coefficients, and the smallest sum of absolute coefficients, for which the
/// closed form of a parabola's zeros cannot underflow. With a smaller value it could.
pub const PARABOLA_MIN_PRODUCT: f64 = 1e-200;

/// Certificate: like [`PARABOLA_MIN_PRODUCT`], the limit below which the closed form cannot overflow.
pub const PARABOLA_MAX_PRODUCT: f64 = 1e200;

/// Certificate: like [`PARABOLA_NEAR_LIMIT`], for degrees three to five with separated zeros ([`DISCRIMINANT_MARGIN`]).
/// Sixteen times this value has shown no disagreement either.
pub const BERNSTEIN_NEAR_LIMIT: f64 = (1_u64 << 24) as f64;

/// Certificate: zeros are separated if no relative change of this size of the coefficients makes two of them coincide.
/// It must clearly exceed the rounding of a sample's value (about 2^-48 of the terms).
pub const DISCRIMINANT_MARGIN: f64 = 1.0 / (1_u64 << 30) as f64;

/// Certificate: like [`PARABOLA_MARGIN`], for degrees three to five. It must cover the effect of deflation on the
/// zeros, which is measured, not proved.
pub const BERNSTEIN_MARGIN: f64 = 1.0 / (1_u64 << 30) as f64;

/// Certificate: the root finder's search is known to end if all coefficients are zero or between this value and
/// [`SEARCH_MAX_COEFFICIENT`]. With subnormal coefficients, some searches do not end (root-finder.md 9.5). Parabolas
/// without a real zero have a leading coefficient of this size.
pub const SEARCH_MIN_COEFFICIENT: f64 = 1e-150;

/// Certificate: the upper end of the range that begins at [`SEARCH_MIN_COEFFICIENT`].
pub const SEARCH_MAX_COEFFICIENT: f64 = 1e150;

/// Detection in lanes: inputs with absolute values up to this limit (scene length unit) give no coefficient that is NaN
/// or infinite, because coefficients are products of at most six inputs. The inputs are positions, displacements,
/// radii, and half-planes' points and normals. With larger inputs, pairs are computed individually. With a much larger
/// limit, the sign of a NaN would depend on the grouping of pairs.
pub const LANES_MAX_INPUT: f64 = 1e48;

/// Fair: a correct program may deviate by this many units of the running error bound (numerics.md 2; LAPACK's test
/// ratios use 30). Smaller values reject correct programs that evaluate formulas in a different way, larger ones hide
/// small mistakes.
pub const FAIR_UNITS: f64 = 64.0;

/// Fair: a coefficient may additionally deviate by this many units of the sum of the polynomial's error bounds.
/// Programs that find coefficients by interpolation need it; it is far below the change that affects a decision on [0,
/// 1].
pub const FAIR_NORM_UNITS: f64 = 16.0;

/// Fair: coefficients that deviate by at most this part of [`FAIR_NORM_UNITS`] of the sum of the absolute coefficients
/// are clearly right. With larger values, less of a program's use of the tolerances is reported; with smaller ones,
/// more bounds are computed.
pub const FAIR_CLEAR_SHARE: f64 = 0.25;

/// Fair: the tolerance of a root finder at the time of impact, in units of the polynomials' error bounds there. It
/// covers deflation, and solvers that are not the course's.
pub const FAIR_ROOT_UNITS: f64 = 1024.0;

/// Fair: a time of impact may deviate by this fraction of the step, for all polynomials, because even a careful root
/// finder may have this error.
pub const FAIR_TIME_SHARE: f64 = 1.0 / (1_u64 << 40) as f64;

/// Fair: two times of impact are the same moment if nothing moves between them by more than this many roundings of its
/// position. With larger values, the responses at the two times differ by more than round-off.
pub const FAIR_MOMENT_ROUNDINGS: f64 = 8.0;

/// Fair: leading coefficients below this many times [`MIN_LEADING_COEFFICIENT`] may be lost without a finding. A
/// program with a factor near 1 may lose other coefficients than the course's formulas do. With larger values, factors
/// could change times of impact.
pub const FAIR_LOSS_FACTOR: f64 = 4.0;

/// Fair: a factor is an outlier if its binary exponent differs from the mean of its kind by more than this many
/// standard deviations. Outliers prove nothing about missing coefficients. By this rule, a different factor that fewer
/// than one polynomial in ten shows is an outlier. With larger values few polynomials could prove many; with smaller
/// ones programs with several factors would be rejected.
pub const FAIR_OUTLIER_DEVIATIONS: f64 = 3.0;

/// Fair: a state cannot be judged if a position or velocity is more than this many times as large as in the reference's
/// own run. A state cannot be judged either if the extent of all particles together is more than this many times
/// smaller.
pub const FAIR_REACH_FACTOR: f64 = (1_u64 << 20) as f64;

/// Fair: a state may deviate by this many times the step's own sensitivity to rounding errors of its inputs.
pub const FAIR_SENSITIVITY_FACTOR: f64 = 8.0;

/// Known mistakes: a re-simulated coefficient may differ by this share of itself. With larger values of this constant
/// and the next four, small mistakes are missed; with smaller values, other arithmetic counts as a mistake.
pub const KNOWN_COEFFICIENT_ERROR: f64 = 1e-10;

/// Known mistakes: a re-simulated coefficient may differ by this share of its polynomial's largest one, because the
/// terms of a coefficient may cancel.
pub const KNOWN_COEFFICIENT_FLOOR: f64 = 1e-12;

/// Known mistakes: the maximum absolute value of a coefficient that only one side has dropped (absolute; see
/// [`MIN_LEADING_COEFFICIENT`]).
pub const KNOWN_DROPPED_COEFFICIENT: f64 = 2.0 * MIN_LEADING_COEFFICIENT;

/// Known mistakes: a re-simulated coordinate or velocity may differ by this share of the largest one of its kind plus
/// 1.
pub const KNOWN_STATE_ERROR: f64 = 1e-10;

/// Known mistakes: the tolerance that replaces [`KNOWN_STATE_ERROR`] for implicit steps. Newton's method stops so near
/// to the same state that a wrong derivative shows only in the last digits.
pub const KNOWN_NEWTON_STATE_ERROR: f64 = 2e-14;

/// Known mistakes: a re-simulated contact vector may differ by this share of its length plus 1.
pub const KNOWN_NORMAL_ERROR: f64 = 1e-9;

/// Known mistakes: a re-simulated time of impact may differ by this (fraction of the step). A double zero is known to
/// about the square root of the unit roundoff.
pub const KNOWN_TIME_ERROR: f64 = 1e-7;

/// Explanations: a coordinate or velocity of a trace's first record may differ from the scene's by this share of the
/// largest one of its kind or 1. It covers the rounding to single precision; with smaller values, a trace with rounded
/// numbers would seem to belong to another scene.
pub const FIRST_RECORD_ERROR: f64 = 1e-6;
