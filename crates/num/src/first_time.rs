//! The first time from which a list of polynomials is positive.
//!
//! This is part II of root-finder.md. The zeros cut the line into gaps, and one sample per gap shows whether the
//! polynomial is positive there. The sets of all polynomials are then intersected. As in the original, the samples are
//! trusted. Rounding may decide a sample, and zeros that the root finder did not find are simply missing.
use super::{
    interval::{Interval, Intervals},
    polynomial::{Polynomial, evaluate},
    rpoly::{self, DoesNotTerminate, MAX_DEGREE, Zeros},
    tolerances::MIN_IMAGINARY_PART,
};

/// Returns the earliest `t >= 0` from which all polynomials are positive, `+inf` if none (root-finder.md 16.3).
/// Polynomials must have been created by [`Polynomial::trimmed`] (or `untrimmed`, for the non-dropping build of
/// root-finder.md 15.1).
///
/// All polynomials are solved, even if an earlier one is nowhere positive, because this decides whether the search
/// ends. The result is `+0`, positive or `+inf`, never `-0` and never NaN for finite coefficients. It is `+inf` if the
/// list is empty, or contains an empty polynomial or one of the form `c z^m`.
///
/// # Errors
/// Fails with [`DoesNotTerminate`] if the search for one polynomial's zeros would never end.
///
/// # Panics
/// Panics if more than ten polynomials have sets with the maximum number of intervals. A detection has at most four
/// polynomials.
#[inline]
pub fn first_time(polynomials: &[Polynomial]) -> Result<f64, DoesNotTerminate> {
    first_time_with_steps(polynomials, &mut 0)
}

/// Returns the time of [`first_time`], and adds the steps of the root searches to `steps` ([`Zeros::steps`]).
///
/// # Errors
/// Fails with [`DoesNotTerminate`] if the search for one polynomial's zeros would never end.
///
/// # Panics
/// Panics like [`first_time`].
#[inline]
pub fn first_time_with_steps(polynomials: &[Polynomial], steps: &mut u64) -> Result<f64, DoesNotTerminate> {
    let lists = polynomials.iter().map(Polynomial::coefficients);
    // Two polynomials of degree five at most have at most five common intervals; four of them have at most nine.
    match polynomials.len() {
        0..=2 => intersect_sets::<5>(lists, steps),
        3..=4 => intersect_sets::<9>(lists, steps),
        _ => intersect_sets::<32>(lists, steps),
    }
}

/// Returns the time of [`first_time`] for coefficient lists, highest power first, used unchanged; degrees up to
/// [`MAX_DEGREE`].
///
/// # Errors
/// Fails with [`DoesNotTerminate`] if the search for one polynomial's zeros would never end.
///
/// # Panics
/// Panics if more than ten lists have sets with the maximum number of intervals.
pub fn first_time_of_lists<'a>(lists: impl IntoIterator<Item = &'a [f64]>) -> Result<f64, DoesNotTerminate> {
    intersect_sets::<32>(lists.into_iter(), &mut 0)
}

/// Returns the first time in the intersection of the positive sets, which may consist of at most `CAPACITY` intervals.
#[inline]
fn intersect_sets<'a, const CAPACITY: usize>(
    mut lists: impl Iterator<Item = &'a [f64]>,
    steps: &mut u64,
) -> Result<f64, DoesNotTerminate> {
    let Some(first) = lists.next() else { return Ok(f64::INFINITY) };
    let mut set = Intervals::<CAPACITY>::EMPTY;
    for &interval in solve_positive_set(first, steps)?.as_slice() {
        set.push(interval);
    }
    for list in lists {
        set = set.intersection(&solve_positive_set(list, steps)?);
    }
    Ok(set.next_time(0.0))
}

/// The positive set of one polynomial: before merging, at most one interval per gap between six zeros.
pub type PositiveSet = Intervals<{ MAX_DEGREE + 1 }>;

/// Returns the intervals in which one polynomial is positive, judged by one sample per gap between its real zeros
/// (root-finder.md 15.3).
///
/// # Errors
/// Fails with [`DoesNotTerminate`] if the search for the polynomial's zeros would never end.
///
/// # Panics
/// Panics if there are more than [`MAX_DEGREE`]` + 1` coefficients.
pub fn positive_set(coefficients: &[f64]) -> Result<PositiveSet, DoesNotTerminate> {
    solve_positive_set(coefficients, &mut 0)
}

fn solve_positive_set(coefficients: &[f64], steps: &mut u64) -> Result<PositiveSet, DoesNotTerminate> {
    let mut set = PositiveSet::EMPTY;
    let zeros = match coefficients.len() {
        0 => return Ok(set),
        1 => Zeros::default(),
        _ => rpoly::zeros(coefficients)?,
    };
    *steps += u64::from(zeros.steps());
    let mut storage = [0.0; MAX_DEGREE];
    let breaks = sorted_real_parts(&zeros, &mut storage);
    let (Some(&first), Some(&last)) = (breaks.first(), breaks.last()) else {
        // If there is no real zero, the time 0 represents the whole line.
        if evaluate(coefficients, 0.0) > 0.0 {
            set.push(Interval::ALL_TIMES);
        }
        return Ok(set);
    };
    if evaluate(coefficients, first - 1.0) > 0.0 {
        set.push(Interval { lo: f64::NEG_INFINITY, hi: first });
    }
    for pair in breaks.windows(2) {
        if evaluate(coefficients, (pair[0] + pair[1]) * 0.5) > 0.0 {
            set.push(Interval { lo: pair[0], hi: pair[1] });
        }
    }
    if evaluate(coefficients, last + 1.0) > 0.0 {
        set.push(Interval { lo: last, hi: f64::INFINITY });
    }
    set.normalize();
    Ok(set)
}

/// Returns the real parts of the zeros that count as real, ascending.
///
/// This is the original's insertion sort, step by step; with a NaN among the values the result depends on the method.
fn sorted_real_parts<'a>(zeros: &Zeros, storage: &'a mut [f64; MAX_DEGREE]) -> &'a [f64] {
    let mut length = 0;
    for &(re, im) in zeros.as_slice() {
        if im.abs() < MIN_IMAGINARY_PART {
            let mut index = length;
            if re < storage[0] {
                while index > 0 {
                    storage[index] = storage[index - 1];
                    index -= 1;
                }
            } else {
                while index > 0 && storage[index - 1] > re {
                    storage[index] = storage[index - 1];
                    index -= 1;
                }
            }
            storage[index] = re;
            length += 1;
        }
    }
    &storage[..length]
}

#[cfg(test)]
mod tests {
    use super::first_time;
    use crate::polynomial::Polynomial;

    type Make = fn(&[f64]) -> Polynomial;

    fn time(make: Make, lists: &[&[f64]]) -> u64 {
        let polynomials: Vec<Polynomial> = lists.iter().map(|list| make(list)).collect();
        first_time(&polynomials).expect("terminates").to_bits()
    }

    #[test]
    fn the_examples_of_the_specification_in_the_dropping_build() {
        let never = f64::INFINITY.to_bits();
        let half = 0.5_f64.to_bits();
        let cases: [(&[&[f64]], u64); 16] = [
            (&[], never),
            (&[&[1.0, -0.5]], half),
            (&[&[1.0, 0.0]], never),
            (&[&[1.0, 0.0, 0.0]], never),
            (&[&[1.0, -1.0, 0.0]], 1.0_f64.to_bits()),
            (&[&[-1.0, 1.0, 0.0]], 0),
            (&[&[-1.0, 0.25]], 0),
            (&[&[1.0, -0.5], &[-1.0, 0.5]], half),
            (&[&[1.0, -1.0, 0.25]], 0),
            (&[&[-1.0, 1.0, -0.25]], never),
            (&[&[0.0, 0.0]], never),
            (&[&[1e-13, 1.0, -0.5]], half),
            (&[&[1e-12, 1.0, -0.5]], 0x3FDF_FFFF_FFFF_EE68),
            (&[&[1.0, 0.0, 1e-18], &[1.0, -0.25]], 0.25_f64.to_bits()),
            (&[&[-0.09, 0.33, -0.28], &[-0.09, 0.165]], 0x3FF5_5555_5555_5555),
            (&[&[1.0, -3.0, 2.0], &[1.0, 0.0]], never),
        ];
        for (lists, expected) in cases {
            assert_eq!(time(Polynomial::trimmed, lists), expected, "{lists:?}");
        }
        assert_eq!(time(Polynomial::trimmed, &[&[0.0, 1.0, -0.5]]), half);
    }

    #[test]
    fn the_examples_of_the_specification_in_the_non_dropping_build() {
        let untrimmed: Make = Polynomial::untrimmed;
        assert_eq!(time(untrimmed, &[&[0.0, 1.0, -0.5]]), f64::INFINITY.to_bits());
        assert_eq!(time(untrimmed, &[&[0.0, 1.0, 0.5]]), 0);
        assert_eq!(time(untrimmed, &[&[1e-13, 1.0, -0.5]]), 0x3FDF_FFFF_FFFF_FE3E);
    }

    #[test]
    fn a_later_polynomial_that_cannot_be_solved_is_noticed_even_if_the_first_is_never_positive() {
        let never = Polynomial::trimmed(&[-1.0]);
        let endless = Polynomial::trimmed(&[1.0, f64::NAN, 1.0, 1.0]);
        assert!(first_time(&[never, endless]).is_err());
        // The search for degree two ends, whatever its coefficients are.
        let infinite = Polynomial::trimmed(&[1.0, f64::INFINITY, 1.0]);
        assert_eq!(first_time(&[never, infinite]).expect("terminates"), f64::INFINITY);
    }
}
