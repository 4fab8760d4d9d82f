//! Finds overlaps that are right except for the radii, whatever the wrong radii are: whole numbers, the larger one, or
//! those of another body.
use super::{
    compare::logged_at,
    study::{Candidate, PolynomialSample, PolynomialStudy},
    take_distinct,
};
use crate::diagnose::{Guess, PolynomialDetail, QuantityGuess};
use fosssim_model::sim::PairKind;
use fosssim_num::bounded::BoundedValue;
use fosssim_student::assignments::t2m2::{Inputs, Subject, formulas::readings};
use std::collections::BTreeMap;

/// The maximum number of radii that are reported.
const MAX_EXAMPLES: usize = 3;

/// The relative difference below which two squared radii are equal.
const SQUARE_TOLERANCE: f64 = 1e-9;

/// Radii are reported as multiples of one over this number.
const RESOLUTION: f64 = 1e9;

/// The cost of the guess. Every guess about a particular wrong radius costs less.
const COST: f64 = 4.6;

/// Returns the guess that only the radii are wrong, or `None` if they do not explain the wrong polynomials. A single
/// coefficient could be wrong for many reasons. Therefore a pair must have the same wrong radii wherever its bodies
/// are.
pub(super) fn collect_candidates(study: &PolynomialStudy) -> Option<Candidate> {
    let subject = study.subject;
    if !matches!(subject, Subject::ParticleOverlap | Subject::EdgeOverlap | Subject::HalfPlaneOverlap) {
        return None;
    }
    let (reproduced, rescaled) = study.count_predicted(|case| {
        let square = fit_square(subject, case).map(BoundedValue::from_exact).unwrap_or(case.inputs.square);
        overlap(subject, &case.inputs, square)
    })?;
    let mut squares: BTreeMap<([u32; 2], [u64; 2]), (f64, f64)> = BTreeMap::new();
    let wrong = || study.cases.iter().filter(|case| !case.is_right);
    for case in wrong() {
        let (pair, square) = (case.sample.pair, fit_square(subject, case)?);
        let radii = case.inputs.radii.map(|radius| radius.value);
        let key = ([pair.first, pair.second], radii.map(f64::to_bits));
        let known = squares.entry(key).or_insert((square, radii[0] + radii[1]));
        if (square - known.0).abs() > SQUARE_TOLERANCE * known.0.max(known.1 * known.1) {
            return None;
        }
    }
    // A fitted square has the round-off of coefficients.
    let rounded = |square: f64| (square.sqrt() * RESOLUTION).round() / RESOLUTION;
    let reaches = squares.into_values().map(|(square, expected)| (rounded(square), expected));
    let reach = |(used, expected)| PolynomialDetail::Reach { kind: subject.kind(), used, expected };
    let mut details = take_distinct(reaches.map(reach), usize::MAX);
    let is_confirmed = subject.kind() == PairKind::ParticleEdge || details.len() < wrong().count();
    details.truncate(MAX_EXAMPLES);
    is_confirmed.then(|| Candidate {
        guess: Guess::Quantity(QuantityGuess::Radius),
        details,
        forms: Vec::new(),
        cost: COST + if rescaled { 2.0 } else { 0.0 },
        reproduced,
    })
}

/// Returns the overlap with another square of the sum of the radii.
fn overlap(subject: Subject, inputs: &Inputs, square: BoundedValue) -> Vec<BoundedValue> {
    readings(subject)[0].polynomial(&Inputs { square, ..*inputs })
}

/// Returns the square of the sum of the radii that the logged overlap contains, by least squares, or `None` if it is
/// negative.
fn fit_square(subject: Subject, case: &PolynomialSample) -> Option<f64> {
    let [with_zero, with_one] =
        [0.0, 1.0].map(|square| overlap(subject, &case.inputs, BoundedValue::from_exact(square)));
    let (mut product, mut norm) = (0.0, 0.0);
    for (power, (none, one)) in with_zero.iter().rev().zip(with_one.iter().rev()).enumerate() {
        let slope = one.value - none.value;
        let logged = logged_at(case.logged, power).unwrap_or(0.0) / case.scale;
        product += slope * (logged - none.value);
        norm += slope * slope;
    }
    let (square, right) = (product / norm, case.inputs.square.value);
    (square >= -SQUARE_TOLERANCE * right).then_some(square.max(0.0))
}
