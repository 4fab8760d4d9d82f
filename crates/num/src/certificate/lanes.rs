//! The certificate's closed forms for several polynomials together: the tests of `closed_form`, in the same order of
//! operations, for polynomials that still have their small leading coefficients.
//!
//! The answers equal those for each polynomial alone if all numbers are finite. Lanes to which a test does not apply
//! compute unused values.
use super::super::{
    lanes::{Lanes, Mask, Simd},
    tolerances::{
        LINE_NEAR_LIMIT, MIN_LEADING_COEFFICIENT, PARABOLA_COMPLEX_FACTOR, PARABOLA_MARGIN, PARABOLA_MAX_PRODUCT,
        PARABOLA_MIN_PRODUCT, PARABOLA_MIN_ZERO_PRODUCT, PARABOLA_NEAR_LIMIT, SEARCH_MAX_COEFFICIENT,
        SEARCH_MIN_COEFFICIENT,
    },
};

/// Returns the lanes in which a coefficient is small enough to be dropped when it leads.
#[inline(always)]
pub fn is_small<S: Simd>(coefficient: Lanes<S>) -> Mask<S> {
    coefficient.abs().is_below(MIN_LEADING_COEFFICIENT)
}

/// Returns the lanes in which the polynomial `a t + b`, with small leading coefficients dropped, is provably not
/// positive within the step.
#[inline(always)]
pub fn is_line_never_positive<S: Simd>(a: Lanes<S>, b: Lanes<S>) -> Mask<S> {
    let (zero, small) = (a.splat_like(0.0), is_small(a));
    // Without its leading coefficient, the polynomial is empty or a constant that is not positive.
    let constant = small & b.is_below(MIN_LEADING_COEFFICIENT);
    let has_near_zero = a.lt(zero) & b.le(zero) & (LINE_NEAR_LIMIT * a).le(b);
    let known = constant | (!small & (b.is_zero() | has_near_zero));
    // The line is positive before its zero at a positive time. Only rounding could hide this.
    let falls = a.lt(zero) & zero.lt(b);
    let open = !(small | known | falls);
    if open.any() { known | (open & is_line_excluded_exactly(a, b)) } else { known }
}

/// Returns the lanes in which the root finder would find that the line `a t + b` is not positive within the step. It
/// performs the root finder's own operations: one zero, and a sample on each side of it.
#[inline(always)]
fn is_line_excluded_exactly<S: Simd>(a: Lanes<S>, b: Lanes<S>) -> Mask<S> {
    let (nothing, one) = (a.splat_like(0.0), a.splat_like(1.0));
    let zero = -b / a;
    let before = nothing.lt(a * (zero - one) + b);
    let after = nothing.lt(a * (zero + one) + b);
    !((before & nothing.lt(zero)) | (after & zero.le(one)))
}

/// Returns the lanes in which the polynomial `a t² + b t + c`, with small leading coefficients dropped, is provably
/// not positive within the step.
#[inline(always)]
pub fn is_never_positive<S: Simd>(a: Lanes<S>, b: Lanes<S>, c: Lanes<S>) -> Mask<S> {
    let small = is_small(a);
    let vanishing = b.is_zero() & c.is_zero();
    let parabola_excluded = (vanishing | is_parabola_excluded(a, b, c)) & !small;
    if small.any() { parabola_excluded | (small & is_line_never_positive(b, c)) } else { parabola_excluded }
}

/// Returns the lanes in which a parabola is provably not positive within the step, because it has no real zero or is
/// below zero with a margin. The leading coefficient must not be small.
#[inline(always)]
fn is_parabola_excluded<S: Simd>(a: Lanes<S>, b: Lanes<S>, c: Lanes<S>) -> Mask<S> {
    let product = 4.0 * a * c;
    let has_no_zero = a.is_below(0.0)
        & (b * b).lt(PARABOLA_COMPLEX_FACTOR * product)
        & c.le(PARABOLA_MIN_ZERO_PRODUCT * a)
        & is_within(product, PARABOLA_MIN_PRODUCT, PARABOLA_MAX_PRODUCT)
        & is_within(-a, SEARCH_MIN_COEFFICIENT, SEARCH_MAX_COEFFICIENT);
    let size = a.abs() + b.abs() + c.abs();
    let below = -PARABOLA_MARGIN * size;
    let negative = c.lt(below)
        & (c + 0.5 * b).lt(below)
        & ((a + b) + c).lt(below)
        & b.abs().le(PARABOLA_NEAR_LIMIT * a.abs())
        & c.abs().le((PARABOLA_NEAR_LIMIT * PARABOLA_NEAR_LIMIT) * a.abs())
        & is_within(size, PARABOLA_MIN_PRODUCT, PARABOLA_MAX_PRODUCT);
    c.is_below(0.0) & (has_no_zero | negative)
}

/// Returns the lanes in which a value is at least `low` and less than `high`.
#[inline(always)]
fn is_within<S: Simd>(value: Lanes<S>, low: f64, high: f64) -> Mask<S> {
    value.is_at_least(low) & value.is_below(high)
}

/// Returns the lanes in which an impact is excluded for a particle-particle or particle-half-plane pair. In these
/// lanes, one of the pair's polynomials (a parabola and a line) is provably not positive within the step.
#[inline(always)]
pub fn excludes_two_polynomials<S: Simd>([a, b, c]: [Lanes<S>; 3], [d, e]: [Lanes<S>; 2]) -> Mask<S> {
    is_never_positive(a, b, c) | is_line_never_positive(d, e)
}

/// Returns the lanes in which the closed forms exclude an impact of a pair with an edge. In these lanes, one of the
/// pair's polynomials is provably not positive within the step, and the search among all of them would end. `ends` has
/// the lanes in which the searches of the first and the last polynomial would end.
#[inline(always)]
pub fn excludes_edge<S: Simd>(
    ends: Mask<S>,
    distance: [Lanes<S>; 5],
    beyond_first: [Lanes<S>; 3],
    before_second: [Lanes<S>; 3],
    approach: [Lanes<S>; 6],
) -> Mask<S> {
    let [o0, o1, o2, o3, o4] = distance;
    let [f0, f1, f2] = beyond_first;
    let [s0, s1, s2] = before_second;
    let [a0, a1, a2, a3, a4, a5] = approach;
    let mut excluded = is_never_positive(f0, f1, f2) | is_never_positive(s0, s1, s2);
    if !excluded.all() {
        // If the overlap or the approach has degree two at most, the closed forms cover it as well.
        let is_parabola = is_small(o0) & is_small(o1);
        if is_parabola.any() {
            excluded = excluded | (is_parabola & is_never_positive(o2, o3, o4));
        }
        let is_parabola = is_small(a0) & is_small(a1) & is_small(a2);
        if is_parabola.any() {
            excluded = excluded | (is_parabola & is_never_positive(a3, a4, a5));
        }
    }
    excluded & ends
}

/// Returns the lanes in which all coefficients have a size for which a search is known to end.
#[inline(always)]
pub fn search_terminates<S: Simd, const LENGTH: usize>(coefficients: &[Lanes<S>; LENGTH]) -> Mask<S> {
    let mut all = has_searchable_size(coefficients[0]);
    for coefficient in &coefficients[1..] {
        all = all & has_searchable_size(*coefficient);
    }
    all
}

#[inline(always)]
fn has_searchable_size<S: Simd>(coefficient: Lanes<S>) -> Mask<S> {
    let modulus = coefficient.abs();
    let largest = modulus.splat_like(SEARCH_MAX_COEFFICIENT);
    modulus.is_zero() | (modulus.is_at_least(SEARCH_MIN_COEFFICIENT) & modulus.le(largest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        certificate::closed_form,
        lanes::{Instructions, LaneWork, MAX_LANES},
        polynomial::trim,
    };
    use proptest::prelude::*;

    struct Ask<'a>(&'a [[f64; MAX_LANES]; 3]);

    impl LaneWork for Ask<'_> {
        type Output = [[f64; MAX_LANES]; 3];
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            let mut answers = [[0.0; MAX_LANES]; 3];
            for first in (0..MAX_LANES).step_by(Lanes::<S>::COUNT) {
                let [a, b, c] = self.0.map(|numbers| Lanes::load(simd, &numbers[first..]));
                let masks = [is_never_positive(a, b, c), is_line_never_positive(b, c), search_terminates(&[a, b, c])];
                for (answer, mask) in answers.iter_mut().zip(masks) {
                    let mut lanes = [0.0; MAX_LANES];
                    mask.select_or_zero(1.0).store(&mut lanes);
                    answer[first..first + Lanes::<S>::COUNT].copy_from_slice(&lanes[..Lanes::<S>::COUNT]);
                }
            }
            answers
        }
    }

    /// Returns numbers of all sizes that occur in formulas, including zeros and bounds of the certificate.
    fn coefficient() -> impl Strategy<Value = f64> {
        let exponents = prop_oneof![-7..7_i32, -53..53_i32, -530..465_i32];
        let power = |exponent: i32| f64::from_bits(u64::try_from(1023 + exponent).expect("not negative") << 52);
        let sign = prop_oneof![Just(0.0), Just(-0.0), Just(1.0), Just(-1.0), Just(-1.0)];
        let bounds = [1e-12, -1e-12, -9.9e-13, 0.5, -0.25, -LINE_NEAR_LIMIT].map(Just);
        prop_oneof![
            4 => (sign, 1.0..2.0, exponents).prop_map(move |(sign, size, exponent)| sign * size * power(exponent)),
            1 => prop::strategy::Union::new(bounds),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 20_000, ..ProptestConfig::default() })]

        #[test]
        fn lanes_say_what_single_polynomials_say(lists in prop::array::uniform3(prop::array::uniform8(coefficient()))) {
            for instructions in [Instructions::default(), Instructions::scalar()] {
                let answers = instructions.run(Ask(&lists));
                for lane in 0..MAX_LANES {
                    let [a, b, c] = lists.map(|numbers| numbers[lane]);
                    let expected = [
                        closed_form::find_exclusion(trim(&[a, b, c])).is_some(),
                        closed_form::find_exclusion(trim(&[b, c])).is_some(),
                        super::super::search_terminates(&[a, b, c]),
                    ];
                    for (answer, expected) in answers.iter().zip(expected) {
                        prop_assert_eq!(answer[lane] == 1.0, expected, "{:?}", [a, b, c]);
                    }
                }
            }
        }
    }
}
