//! Collects the evidence of one logged polynomial. A right polynomial shows a factor and a form, and a wrong one has a
//! fault. Some evidence depends on the factors of other polynomials.
use super::{
    compare::{
        Match, Mismatch, claimed_factors, compare, compare_with_one, is_wrong_with_every_factor, possible_factors,
        round_off_factor,
    },
    formulas::ExpectedPolynomials,
    pending_polynomials::{NO_FACTORS, PendingCause, PendingPolynomials},
    step_judgment::StepJudgment,
};
use crate::finding::{Finding, FindingDetail, PolynomialPlace};
use fosssim_findings::fair::Form;
use fosssim_model::sim::PairKind;
use fosssim_num::{
    bounded::BoundedValue,
    polynomial::{MAX_COEFFICIENTS, Polynomial},
};

fosssim_model::drops_leading!();

/// A logged polynomial, with the pass and the pair to which it belongs.
#[derive(Debug, Clone, Copy)]
pub(super) struct LoggedPolynomial<'a> {
    /// The polynomial's pass, pair, condition and index.
    pub place: PolynomialPlace,
    /// The polynomial's number within its pair.
    pub number: usize,
    /// The polynomial's coefficients, highest power first.
    pub coefficients: &'a [f64],
}

/// The judgment of a logged polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PolynomialJudgment {
    /// The polynomial is right.
    Right,
    /// The polynomial is right in the definition's form, not the course's.
    RightForm,
    /// The polynomial does not show its factor, and is right only with certain factors.
    DependsOnFactor,
    /// The polynomial is wrong.
    Wrong(Mismatch),
}

/// Returns the comparison of a polynomial with the course's form.
pub(super) fn compare_first(
    step_judgment: &StepJudgment,
    expected: &ExpectedPolynomials,
    logged: &LoggedPolynomial<'_>,
) -> Result<Match, Mismatch> {
    let own = expected.polynomial(logged.number);
    // If another form exists, the fault in the first form does not matter.
    if expected.other_form(logged.number).is_some() && is_wrong_with_every_factor(own, logged.coefficients) {
        return Err(Mismatch::TooLong);
    }
    compare(own, logged.coefficients, &step_judgment.likely_factors(logged.place.pair.kind, logged.number))
}

impl StepJudgment {
    /// Records what a polynomial shows about the program. `first` is its comparison with the course's form. If the
    /// polynomial is right only with some factors, and its positions are known (`is_known`), it is judged at the end of
    /// the trace.
    pub(super) fn record_evidence(
        &mut self,
        expected: &ExpectedPolynomials,
        logged: &LoggedPolynomial<'_>,
        first: Result<Match, Mismatch>,
        is_known: bool,
    ) -> PolynomialJudgment {
        let LoggedPolynomial { place, number, coefficients: list } = *logged;
        let own = expected.polynomial(number);
        let add_pending = |judged: &mut Self, form: Form, expected: &[BoundedValue], factors: Option<[f64; 2]>| {
            if is_known {
                judged.add_pending(logged, (form, PendingCause::Missing), expected, factors.unwrap_or(NO_FACTORS));
            }
            PolynomialJudgment::DependsOnFactor
        };
        // A polynomial depends on its factor if the expected one is only round-off in each of its forms, and the logged
        // one is larger.
        let forms = std::iter::once(own).chain(expected.other_form(number));
        let min_factor = forms.map(|form| round_off_factor(form, list)).reduce(|one, other| Some(one?.min(other?)));
        if let Some(min_factor) = min_factor.flatten().filter(|_| first.is_ok()) {
            if is_known {
                self.add_pending(logged, (Form::Either, PendingCause::RoundOff), own, [min_factor, f64::INFINITY]);
            }
            return PolynomialJudgment::DependsOnFactor;
        }
        // The course's form is already known, so a further right polynomial in this form adds nothing.
        let tells_nothing = first.is_ok() && self.course_form.is_some();
        let Some(right) = expected.other_form(number).filter(|_| !tells_nothing) else {
            return match first.map_err(|mismatch| (mismatch, possible_factors(own, list))) {
                Ok(found) => self.record_factor(logged, own, found, is_known),
                Err((_, factors @ Some(_))) => add_pending(self, Form::Either, own, factors),
                Err((mismatch, None)) => PolynomialJudgment::Wrong(mismatch),
            };
        };
        let other = compare(right, list, &self.likely_factors(place.pair.kind, number));
        match (first, other) {
            (Ok(found), other) => {
                // A polynomial that does not show its factor cannot show the form.
                if other.is_err() && found.scale.is_some() && possible_factors(right, list).is_none() {
                    self.course_form = self.course_form.or(Some(place));
                } else if other.is_err() {
                    add_pending(self, Form::Right, right, possible_factors(right, list));
                }
                self.record_factor(logged, own, found, is_known)
            }
            (Err(_), Ok(found)) => match possible_factors(own, list) {
                None if found.scale.is_some() => {
                    self.right_form = self.right_form.or(Some(place));
                    self.record_factor(logged, right, found, is_known);
                    PolynomialJudgment::RightForm
                }
                factors => add_pending(self, Form::Course, own, factors),
            },
            (Err(_), Err(mismatch)) => match [own, right].map(|form| possible_factors(form, list)) {
                [None, None] => PolynomialJudgment::Wrong(mismatch),
                [course, definition] => {
                    add_pending(self, Form::Course, own, course);
                    add_pending(self, Form::Right, right, definition)
                }
            },
        }
    }

    /// Records the factor of a right polynomial. A polynomial with a single coefficient that lacks others, which the
    /// course's library would keep with the factor 1, only claims a factor. Other polynomials must confirm it.
    fn record_factor(
        &mut self,
        logged: &LoggedPolynomial<'_>,
        expected: &[BoundedValue],
        found: Match,
        is_known: bool,
    ) -> PolynomialJudgment {
        let claims = found.scale.and_then(|scale| claimed_factors(expected, logged.coefficients, scale));
        match claims {
            None => self.add_share_and_factor(logged.place.pair.kind, logged.number, &found),
            Some(factors) => {
                self.shares.coefficient = self.shares.coefficient.max(found.tolerance_share);
                if is_known {
                    self.add_pending(logged, (Form::Either, PendingCause::Claim), expected, factors);
                }
            }
        }
        PolynomialJudgment::Right
    }

    /// Records the used share of the tolerance of a right polynomial, and its factor, if it shows one.
    #[inline]
    pub(super) fn add_share_and_factor(&mut self, kind: PairKind, number: usize, found: &Match) {
        self.shares.coefficient = self.shares.coefficient.max(found.tolerance_share);
        if let Some(scale) = found.scale {
            self.factors[kind][number].add_factor(scale);
        }
    }

    /// Records that the trace uses the course's form, if an approach polynomial that is identical to the reference's
    /// shows it.
    pub(super) fn record_course_form(&mut self, expected: &ExpectedPolynomials, logged: &LoggedPolynomial<'_>) {
        let Some(right) = expected.other_form(logged.number) else { return };
        let has_course_form = || {
            compare(right, logged.coefficients, &[1.0]).is_err()
                && possible_factors(right, logged.coefficients).is_none()
                && compare(expected.polynomial(logged.number), logged.coefficients, &[1.0])
                    .is_ok_and(|found| found.scale.is_some())
        };
        if self.course_form.is_none() && has_course_form() {
            self.course_form = Some(logged.place);
        }
    }

    /// Adds a polynomial that is right only with the factors of the given range.
    fn add_pending(
        &mut self,
        logged: &LoggedPolynomial<'_>,
        (form, cause): (Form, PendingCause),
        expected: &[BoundedValue],
        [min_factor, max_factor]: [f64; 2],
    ) {
        let kind_and_number = (logged.place.pair.kind, logged.number);
        let finding = || {
            let mismatch = compare_with_one(expected, logged.coefficients).err().unwrap_or(Mismatch::TooLong);
            let detail = wrong_polynomial_finding(logged, expected, mismatch);
            Finding { step: self.step, frame: self.frame, detail }
        };
        let is_like = |pending: &PendingPolynomials| {
            (pending.place, pending.form, pending.cause) == (kind_and_number, form, cause)
        };
        let Some(pending) = self.pending.iter().position(is_like) else {
            let finding = finding();
            let (min_factor, max_factor) = ((min_factor, finding), (max_factor, finding));
            self.pending.push(PendingPolynomials {
                place: kind_and_number,
                form,
                cause,
                count: 1,
                least_factor: min_factor,
                greatest_factor: max_factor,
            });
            return;
        };
        let PendingPolynomials { least_factor: (old_least, _), greatest_factor: (old_greatest, _), .. } =
            self.pending[pending];
        let new = (min_factor > old_least || max_factor < old_greatest).then(finding);
        let pending = &mut self.pending[pending];
        pending.count += 1;
        if let Some(new) = new {
            if min_factor > old_least {
                pending.least_factor = (min_factor, new);
            }
            if max_factor < old_greatest {
                pending.greatest_factor = (max_factor, new);
            }
        }
    }
}

/// Returns the finding about a wrong polynomial.
pub(super) fn wrong_polynomial_finding(
    logged: &LoggedPolynomial<'_>,
    expected: &[BoundedValue],
    mismatch: Mismatch,
) -> FindingDetail {
    let &LoggedPolynomial { place, coefficients: list, .. } = logged;
    let right: Vec<f64> = expected.iter().map(|c| c.value).collect();
    let (right, logged_polynomial) =
        (Polynomial::trimmed(&right), Polynomial::untrimmed(&list[..list.len().min(MAX_COEFFICIENTS)]));
    match mismatch {
        Mismatch::Coefficient { power, expected, actual, .. } => FindingDetail::Coefficient {
            place,
            power,
            expected,
            actual,
            residual: (actual - expected).abs(),
            rescaled: None,
            expected_polynomial: right,
            actual_polynomial: logged_polynomial,
        },
        Mismatch::TooLong => FindingDetail::PolynomialDegree {
            place,
            expected: right,
            actual_size: list.len(),
            actual: logged_polynomial,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_findings::Role;
    use fosssim_model::sim::{Pair, Pass, Stage};

    /// Returns whether polynomials, each of which is right with the factors of one range in `bounds`, are all right
    /// with `factor`.
    fn are_right_with(bounds: &[[f64; 2]], factor: f64) -> bool {
        let pair = Pair { kind: PairKind::ParticleParticle, first: 0, second: 1 };
        let pass = Pass { stage: Stage::ContinuousTime, index: 0 };
        let place = PolynomialPlace { pass, pair, role: Role::Overlap, index: 0 };
        let mut judged = StepJudgment::default();
        for factors in bounds {
            let expected = [1e-14, 1.0, 2.0].map(BoundedValue::from_exact);
            let logged = LoggedPolynomial { place, number: 0, coefficients: &[1.0, 2.0] };
            judged.add_pending(&logged, (Form::Either, PendingCause::Missing), &expected, *factors);
        }
        judged.pending.iter().all(|pending| pending.finding([factor, factor]).is_none())
    }

    #[test]
    fn each_of_the_polynomials_bounds_the_factor() {
        let (any, at_least_ten, at_most_half) = ([0.1, 1e3], [10.0, 1e3], [0.1, 0.5]);
        assert!(are_right_with(&[any, any], 1.0));
        for bound in [at_least_ten, at_most_half] {
            for order in [[any, bound, any], [bound, any, any], [any, any, bound]] {
                assert!(!are_right_with(&order, 1.0), "{order:?}");
                assert!(are_right_with(&order, if bound == at_least_ten { 20.0 } else { 0.2 }), "{order:?}");
            }
        }
    }
}
