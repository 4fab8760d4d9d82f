//! The original's findings about polynomials (oracle-behavior.md 6.2).
use super::{StepResult, sum_of_moduli};
use crate::{
    finding::{Finding, FindingDetail, FindingKind, PolynomialPlace, RescaledCoefficient},
    progress::Remark,
    wrong_coefficients::{find_differing_powers, find_factor},
};
use fosssim_num::{
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    tolerances::{PARITY_COEFFICIENT_DIFFERENCE, PARITY_ZERO_COEFFICIENT_SUM},
};

/// The findings about polynomials, which count only if the two lists have the same length.
#[derive(Debug, Default)]
pub(crate) struct PendingFindings {
    runs: Vec<(FindingKind, u32)>,
    first_findings: Vec<Finding>,
}

impl PendingFindings {
    /// Removes all findings.
    pub(crate) fn clear(&mut self) {
        self.runs.clear();
        self.first_findings.clear();
    }

    fn record(&mut self, kind: FindingKind, finding: impl FnOnce() -> Finding) {
        if !self.first_findings.iter().any(|first| first.kind() == kind) {
            self.first_findings.push(finding());
        }
        match self.runs.last_mut() {
            Some((last, count)) if *last == kind => *count = count.saturating_add(1),
            _ => self.runs.push((kind, 1)),
        }
    }

    /// Records the fault of a polynomial of the current step and frame, if it does not match the reference's.
    pub(crate) fn compare(
        &mut self,
        (step, frame): (u32, u64),
        own: &[f64],
        actual: &[f64],
        place: impl Fn() -> PolynomialPlace,
    ) {
        let expected = &Polynomial::untrimmed(own);
        let finding = |detail| Finding { step, frame, detail };
        let logged_polynomial = Polynomial::untrimmed(&actual[..actual.len().min(MAX_COEFFICIENTS)]);
        if own.len() != actual.len() {
            self.record(FindingKind::PolynomialDegree, || {
                let (expected, actual_size) = (*expected, actual.len());
                finding(FindingDetail::PolynomialDegree {
                    place: place(),
                    expected,
                    actual_size,
                    actual: logged_polynomial,
                })
            });
            return;
        }
        let (sum_actual, sum_own) = (sum_of_moduli(actual), sum_of_moduli(own));
        if sum_actual < PARITY_ZERO_COEFFICIENT_SUM && sum_own < PARITY_ZERO_COEFFICIENT_SUM {
            return;
        }
        if sum_own < PARITY_ZERO_COEFFICIENT_SUM {
            self.record(FindingKind::VanishingPolynomial, || {
                finding(FindingDetail::VanishingPolynomial {
                    place: place(),
                    expected: *expected,
                    actual: logged_polynomial,
                })
            });
            return;
        }
        for (number, (&own_coefficient, &coefficient)) in own.iter().zip(actual).enumerate() {
            let rescaled = (own_coefficient * sum_actual) / sum_own;
            let residual = (coefficient - rescaled).abs();
            // In the original, a NaN passes, because the original tests whether the distance is larger than the bound.
            if residual > PARITY_COEFFICIENT_DIFFERENCE {
                self.record(FindingKind::Coefficient, || {
                    let power = own.len() - 1 - number;
                    let rescaled = RescaledCoefficient { power, expected: rescaled, actual: coefficient, residual };
                    finding(describe_wrong_coefficient(place(), rescaled, expected, &logged_polynomial))
                });
            }
        }
    }

    /// Adds all findings to `result`. The two lists must have the same length.
    pub(crate) fn deliver(&mut self, result: &mut StepResult) {
        for &(kind, count) in &self.runs {
            result.remarks.push(Remark::Polynomials(kind, count));
            result.counts.add(kind, u64::from(count));
        }
        result.first_findings.append(&mut self.first_findings);
    }
}

/// Returns the finding about the coefficient that a person would call wrong.
fn describe_wrong_coefficient(
    place: PolynomialPlace,
    rescaled: RescaledCoefficient,
    expected: &Polynomial,
    actual: &Polynomial,
) -> FindingDetail {
    let (own, logged) = (expected.coefficients(), actual.coefficients());
    let factor = find_factor(own, logged);
    // If only the original's bound rejects a coefficient, its power is the original's.
    let power = find_differing_powers(own, logged, factor).first().copied().unwrap_or(rescaled.power);
    let coefficient_at = |coefficients: &[f64]| coefficients.iter().rev().nth(power).copied().unwrap_or(0.0);
    let (right, wrong) = (factor * coefficient_at(own), coefficient_at(logged));
    FindingDetail::Coefficient {
        place,
        power,
        expected: right,
        actual: wrong,
        residual: (wrong - right).abs(),
        rescaled: Some(rescaled),
        expected_polynomial: *expected,
        actual_polynomial: *actual,
    }
}
