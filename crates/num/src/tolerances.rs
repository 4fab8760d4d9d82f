//! Every tolerance of the crate: unit, meaning, and the effect of changing it.

/// Leading coefficients below this are dropped before a polynomial is solved or logged (absolute, strict;
/// root-finder.md 15.1). Changing it changes every trace.
pub const LEADING_COEFFICIENT: f64 = 1e-12;

/// Zeros whose imaginary part is below this count as real (absolute, strict; root-finder.md 15.3).
pub const IMAGINARY_PART: f64 = 1e-8;

/// Parity: contact normals may differ by this Euclidean distance (scene length unit; oracle-behavior.md 6).
pub const PARITY_NORMAL: f64 = 1e-9;

/// Parity: a rescaled coefficient may differ by this (absolute, whatever its size; oracle-behavior.md 6).
pub const PARITY_COEFFICIENT: f64 = 1e-10;

/// Parity: polynomials whose coefficients' moduli sum to less than this count as zero (oracle-behavior.md 6).
pub const PARITY_ZERO_POLYNOMIAL: f64 = 1e-10;

/// Parity: bound of the accumulated position and velocity residuals (strict; oracle-behavior.md 6).
pub const PARITY_ACCUMULATED: f64 = 1e-6;

/// Parity: bound of the maximum position and velocity residuals (strict; oracle-behavior.md 6).
pub const PARITY_MAXIMUM: f64 = 1e-10;

/// In the contest bodies that are closer than this leave each other alone (scene length unit; simulation.md 3.1).
/// Changing it changes traces of bodies at the same place.
pub const CONTEST_DISTANCE: f64 = 1e-10;

/// Newton's method of implicit-euler stops when the update's norm is below this (velocity unit; simulation.md 4).
pub const NEWTON_UPDATE: f64 = 1e-9;

/// Newton's method of implicit-euler is given up after this many iterations. The original has no limit and hangs
/// (simulation.md 4); convergence takes fewer than ten. A much lower limit could reject a scene that the original
/// records.
pub const NEWTON_ITERATIONS: u32 = 10_000;

/// Certificate: a line's zero is near when its modulus is at most this (fraction of the step). Larger values let
/// rounding decide the root finder's sample one step beyond the zero (certificate, closed forms).
pub const LINE_NEAR: f64 = (1_u64 << 40) as f64;

/// Certificate: a parabola's zeros are near when the coefficient of degree 2 - i is at most the leading one times the
/// i-th power of this. Larger values let rounding decide the samples.
pub const PARABOLA_NEAR: f64 = (1_u64 << 22) as f64;

/// Certificate: a parabola is negative when its Bernstein coefficients are below this share of the sum of moduli.
/// Smaller values no longer cover the rounding of its zeros (some 2^-50).
pub const PARABOLA_MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

/// Certificate: a parabola has no real zero when b^2 is below 4ac times this.
pub const PARABOLA_COMPLEX: f64 = 1.0 - 1.0 / (1_u64 << 20) as f64;

/// Certificate: the least product of complex zeros (fraction of the step, squared) whose imaginary parts are surely
/// above [`IMAGINARY_PART`]: with [`PARABOLA_COMPLEX`] they exceed 2^-10 times the root of this.
pub const PARABOLA_ROOM: f64 = 1.0 / (1_u64 << 30) as f64;

/// Certificate: products of two coefficients, and sums of moduli, of at least this and less than [`PARABOLA_LARGEST`]
/// neither overflow nor underflow in the closed form of a parabola's zeros. Wider bounds let them.
pub const PARABOLA_SMALLEST: f64 = 1e-200;

/// Certificate: see [`PARABOLA_SMALLEST`].
pub const PARABOLA_LARGEST: f64 = 1e200;

/// Certificate: as [`PARABOLA_NEAR`], for degrees three to five whose zeros are apart ([`DISCRIMINANT_MARGIN`]).
/// Sixteen times as much has shown no disagreement either.
pub const BERNSTEIN_NEAR: f64 = (1_u64 << 24) as f64;

/// Certificate: zeros are apart when no relative change of this size of the coefficients makes two of them coincide. It
/// has to exceed the rounding of a sample's value (some 2^-48 of the terms) clearly.
pub const DISCRIMINANT_MARGIN: f64 = 1.0 / (1_u64 << 30) as f64;

/// Certificate: as [`PARABOLA_MARGIN`], for degrees three to five. It has to cover what deflation does to the zeros,
/// which is measured, not proved.
pub const BERNSTEIN_MARGIN: f64 = 1.0 / (1_u64 << 30) as f64;

/// Certificate: searches among coefficients between this and [`SEARCH_LARGEST_COEFFICIENT`] (or zero) are known to end;
/// among subnormal numbers some do not (root-finder.md 9.5). Parabolas without a real zero have a leading coefficient
/// of this size.
pub const SEARCH_SMALLEST_COEFFICIENT: f64 = 1e-150;

/// Certificate: see [`SEARCH_SMALLEST_COEFFICIENT`].
pub const SEARCH_LARGEST_COEFFICIENT: f64 = 1e150;

/// Detection in lanes: positions, displacements, radii, half-planes' points and normals up to this modulus (scene
/// length unit) make no NaN and no infinity among coefficients, which are of degree six; beyond it pairs are computed
/// one by one. Much larger values would let the sign of a NaN depend on how pairs are put together.
pub const LANES_LARGEST_INPUT: f64 = 1e48;

/// Fair: a correct program may be off by this many units of the running error bound (numerics.md 2; LAPACK's test
/// ratios use 30). Smaller values reject correct programs that evaluate in another way, larger ones hide small
/// mistakes.
pub const FAIR_UNITS: f64 = 64.0;

/// Fair: a coefficient may also be off by this many units of all the polynomial's error bounds together. Programs that
/// find coefficients by interpolation need it; it is far below what changes a decision on [0, 1].
pub const FAIR_NORM_UNITS: f64 = 16.0;

/// Fair: coefficients that are off by this part of [`FAIR_NORM_UNITS`] of their sum of moduli are clearly right. Larger
/// values report less of a program's use of the tolerances, smaller ones compute more bounds.
pub const FAIR_CLEAR: f64 = 0.25;

/// Fair: the tolerance of a root finder at the time of impact, in units of the polynomials' error bounds there.
/// Covers deflation and other solvers than the course's.
pub const FAIR_ROOT_UNITS: f64 = 1024.0;

/// Fair: a time of impact may be off by this fraction of the step, whatever the polynomials: a careful root finder
/// other than the course's may leave this error.
pub const FAIR_TIME: f64 = 1.0 / (1_u64 << 40) as f64;

/// Fair: two times of impact between which nothing moves by more than this many roundings of its position are one
/// moment. Larger values bring the responses to them apart by more than round-off.
pub const FAIR_MOMENT: f64 = 8.0;

/// Fair: leading coefficients below this many times [`LEADING_COEFFICIENT`] may be lost without a word: factors near 1
/// move others across that bound than the course's own formulas do. Larger values let factors change times of impact.
pub const FAIR_LOSS: f64 = 4.0;

/// Fair: factors whose binary exponents lie farther from the mean of their kind than this many times its standard
/// deviation are outliers, which prove no missing polynomial. A factor that fewer than one polynomial in ten shows is
/// one, too. Larger values let few polynomials prove many, smaller ones accuse programs with several factors.
pub const FAIR_OUTLIER: f64 = 3.0;

/// Fair: states may be this many times as large, or as close together, as any in the reference's own run; beyond that
/// nothing is left to be right or wrong.
pub const FAIR_REACH: f64 = (1_u64 << 20) as f64;

/// Fair: how often a step's own sensitivity to roundings of its inputs a state may be off.
pub const FAIR_SENSITIVITY: f64 = 8.0;

/// Known mistakes: a re-simulated coefficient may differ by this share of itself ... Larger values of this constant and
/// the next four miss small mistakes; smaller values take other arithmetic for a mistake.
pub const KNOWN_COEFFICIENT: f64 = 1e-10;

/// Known mistakes: ... and by this share of its polynomial's largest one, since the terms of a coefficient may cancel.
pub const KNOWN_COEFFICIENT_FLOOR: f64 = 1e-12;

/// Known mistakes: a coefficient that only one side has dropped is at most this (absolute; see
/// [`LEADING_COEFFICIENT`]).
pub const KNOWN_DROPPED: f64 = 2.0 * LEADING_COEFFICIENT;

/// Known mistakes: a re-simulated coordinate or velocity may differ by this share of the largest one of its kind plus
/// 1.
pub const KNOWN_STATE: f64 = 1e-10;

/// Known mistakes: the same of implicit steps, where Newton's method stops so near to the same state that a wrong
/// derivative shows in its last digits only.
pub const KNOWN_NEWTON_STATE: f64 = 2e-14;

/// Known mistakes: a re-simulated contact vector may differ by this share of its length plus 1.
pub const KNOWN_NORMAL: f64 = 1e-9;

/// Known mistakes: a re-simulated time of impact may differ by this (fraction of the step). A double zero is known to
/// about the root of the unit roundoff.
pub const KNOWN_TIME: f64 = 1e-7;

/// Explanations: a coordinate or velocity of a trace's first record may differ from the scene's by this share of the
/// largest one of its kind or 1. It covers the rounding to single precision; smaller values take a trace with rounded
/// numbers for another scene's.
pub const FIRST_RECORD: f64 = 1e-6;
