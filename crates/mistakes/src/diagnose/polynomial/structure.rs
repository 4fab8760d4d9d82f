//! Guesses about the whole list of coefficients: it may be reversed, negated, cut, replaced by another polynomial's, or
//! NaN.
use super::{
    compare::{expected_at, logged_at, polynomial_matches},
    study::{Candidate, PolynomialSample, PolynomialStudy, median, ratio},
};
use crate::diagnose::{Guess, ListGuess, PolynomialDetail};
use fosssim_num::{
    bounded::BoundedValue,
    tolerances::{FAIR_UNITS, MIN_LEADING_COEFFICIENT},
};
use fosssim_student::assignments::t2m2::{Subject, formulas::readings};

fosssim_model::drops_leading!();

/// The unit roundoff of a single-precision number.
const SINGLE_ROUNDOFF: f64 = 1.0 / (1_u64 << 24) as f64;

/// Returns the structural guesses that reproduce at least half of the wrong samples.
pub(super) fn collect_candidates(study: &PolynomialStudy) -> Vec<Candidate> {
    let mut found = Vec::new();
    add_properties(study, &mut found);
    add_rearrangements(study, &mut found);
    add_other_polynomials(study, &mut found);
    add_cuts(study, &mut found);
    found.extend(guess_scaled_displacements(study));
    found
}

fn new_candidate(guess: ListGuess, detail: Option<PolynomialDetail>, cost: f64, reproduced: usize) -> Candidate {
    let details = detail.into_iter().collect();
    Candidate { guess: Guess::List(guess), details, forms: Vec::new(), cost, reproduced }
}

/// Adds guesses about properties of the logged list, which need no predicted polynomial.
fn add_properties(study: &PolynomialStudy, found: &mut Vec<Candidate>) {
    let mut check = |guess, detail, cost, holds: &dyn Fn(&PolynomialSample) -> bool| {
        if let Some(reproduced) = study.count_if(holds) {
            found.push(new_candidate(guess, detail, cost, reproduced));
        }
    };
    check(ListGuess::AllZero, None, 1.0, &|case| case.logged.iter().all(|&value| value == 0.0));
    if let Some(first) = study.probes().next().map(|case| case.logged)
        && let [value, ..] = *first
        && value != 0.0
    {
        if first.len() == 1 {
            let detail = PolynomialDetail::Holds(value);
            check(ListGuess::Constant, Some(detail), 1.5, &|case| case.logged == [value]);
        }
        check(ListGuess::AllEqual, Some(PolynomialDetail::Every(value)), 1.2, &|case| {
            case.logged.len() > 1 && case.logged.iter().all(|&other| other == value)
        });
    }
    check(ListGuess::SinglePrecision, Some(PolynomialDetail::SinglePrecision), 2.0, &|case| is_single_precision(case));
    check(ListGuess::Monic, None, 1.5, &|case| {
        let leading = case.logged.first() == Some(&1.0);
        let power = case.logged.len().saturating_sub(1);
        case.is_right
            || leading
                && polynomial_matches(&case.expected, case.logged, 1.0 / expected_at(&case.expected, power).value)
    });
    check(ListGuess::TooLong, None, 8.0, &|case| case.is_right || case.logged.len() > case.expected.len());
}

/// Returns whether all logged numbers are single-precision and close to the expected ones.
fn is_single_precision(case: &PolynomialSample) -> bool {
    let single = |value: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "the test is whether truncation changes the number")]
        let rounded = value as f32;
        f64::from(rounded) == value
    };
    let units = 2.0 * FAIR_UNITS * SINGLE_ROUNDOFF;
    let is_close = |power: usize| {
        let expected = expected_at(&case.expected, power);
        let value = logged_at(case.logged, power).unwrap_or(0.0);
        let room = units * (case.scale * expected.bound + value.abs());
        (value - case.scale * expected.value).abs() <= room + MIN_LEADING_COEFFICIENT
    };
    let is_short = case.logged.len() <= case.expected.len();
    is_short && case.logged.iter().all(|&value| single(value)) && (0..case.expected.len()).all(is_close)
}

fn negate_coefficients(list: &[BoundedValue]) -> Vec<BoundedValue> {
    list.iter().map(|&coefficient| -coefficient).collect()
}

fn reverse_coefficients(list: &[BoundedValue]) -> Vec<BoundedValue> {
    list.iter().rev().copied().collect()
}

fn predict(
    study: &PolynomialStudy,
    guess: ListGuess,
    detail: Option<PolynomialDetail>,
    cost: f64,
    predict: impl Fn(&PolynomialSample) -> Vec<BoundedValue>,
) -> Option<Candidate> {
    let (reproduced, scaled) = study.count_predicted(predict)?;
    Some(new_candidate(guess, detail, cost + if scaled { 1.0 } else { 0.0 }, reproduced))
}

/// Adds guesses with the polynomial's own coefficients in another order or with another sign.
fn add_rearrangements(study: &PolynomialStudy, found: &mut Vec<Candidate>) {
    let mut check = |guess, cost, change: &dyn Fn(&[BoundedValue]) -> Vec<BoundedValue>| {
        found.extend(predict(study, guess, None, cost, |case| change(&case.expected)));
    };
    check(ListGuess::Reversed, 1.0, &reverse_coefficients);
    check(ListGuess::Negated, 1.0, &negate_coefficients);
    check(ListGuess::ReversedNegated, 2.5, &|list| negate_coefficients(&reverse_coefficients(list)));
    check(ListGuess::TrailingZero, 2.5, &|list| list.iter().copied().chain([BoundedValue::from_exact(0.0)]).collect());
    for degree in 1..=study.subject.degree() {
        for other in 0..degree {
            let detail = Some(PolynomialDetail::Exchanged { powers: [degree, other] });
            let indices = [degree, other].map(|power| study.subject.degree() - power);
            found.extend(predict(study, ListGuess::TwoExchanged, detail, 3.0, |case| {
                let mut list = case.expected.clone();
                list.swap(indices[0], indices[1]);
                list
            }));
        }
    }
}

/// Adds guesses with exchanged polynomials of the same detection.
fn add_other_polynomials(study: &PolynomialStudy, found: &mut Vec<Candidate>) {
    for &other in Subject::all_of_kind(study.subject.kind()) {
        if other == study.subject {
            continue;
        }
        let formula = &readings(other)[0];
        let detail = || Some(PolynomialDetail::InPlaceOf { used: other, expected: study.subject });
        let formed = |case: &PolynomialSample| formula.polynomial(&case.inputs);
        found.extend(predict(study, ListGuess::OtherPolynomial, detail(), 1.5, formed));
        let negative = |case: &PolynomialSample| negate_coefficients(&formed(case));
        found.extend(predict(study, ListGuess::OtherPolynomialNegated, detail(), 3.0, negative));
    }
}

/// Adds guesses that only the first or last coefficients were logged.
fn add_cuts(study: &PolynomialStudy, found: &mut Vec<Candidate>) {
    for length in 1..=study.subject.degree() {
        let guess = if length == 1 { ListGuess::ConstantOnly } else { ListGuess::Cut };
        let (last, first) = (PolynomialDetail::LastOnly(length), PolynomialDetail::FirstOnly(length));
        let end = |case: &PolynomialSample| case.expected[case.expected.len() - length..].to_vec();
        found.extend(predict(study, guess, Some(last), 2.0 + 0.01 * length as f64, end));
        let beginning = |case: &PolynomialSample| case.expected[..length].to_vec();
        found.extend(predict(study, ListGuess::CutEnd, Some(first), 2.5, beginning));
    }
}

/// Returns the guess that every displacement is multiplied by the same factor, for example because it is a velocity.
/// Each coefficient is then multiplied by a power of this factor. Returns `None` if no positive factor except 1 fits.
fn guess_scaled_displacements(study: &PolynomialStudy) -> Option<Candidate> {
    let step = |case: &PolynomialSample| Some(ratio(case, 1)? / ratio(case, 0)?);
    let factor = median(study.probes().filter_map(step).collect())?;
    let is_new = factor > 0.0 && (factor - 1.0).abs() > 1e-9;
    if !is_new || study.subject.degree() < 2 {
        return None;
    }
    let factor = BoundedValue { value: factor, bound: 16.0 * factor };
    let detail = PolynomialDetail::Displacements(factor.value);
    predict(study, ListGuess::DisplacementScale, Some(detail), 3.0, |case| {
        let mut power = BoundedValue::from_exact(1.0);
        let mut list = reverse_coefficients(&case.expected);
        for coefficient in &mut list {
            *coefficient = *coefficient * power;
            power = power * factor;
        }
        reverse_coefficients(&list)
    })
}
