//! Collects all samples of one polynomial of one kind of pair, and measures how well a guess reproduces them.
use super::{
    Sample,
    compare::{
        coefficient_matches, exceeds_round_off, expected_at, fit_scale, fit_scale_to_powers, is_right, logged_at,
        polynomial_matches,
    },
};
use crate::diagnose::{Guess, PolynomialDetail};
use fosssim_judge::fair::formulas::BoundedPairMotion;
use fosssim_num::{bounded::BoundedValue, tolerances::MIN_LEADING_COEFFICIENT};
use fosssim_student::assignments::t2m2::{
    Inputs, Reading, Subject,
    formulas::{Formula, readings},
};

fosssim_model::drops_leading!();

/// The maximum number of samples; more samples only take more time.
const MAX_CASES: usize = 1200;

/// The number of wrong samples on which a guess is tried before it is tried on all.
const PROBE_COUNT: usize = 12;

/// One in this many right samples may contradict a guess because of round-off.
const SAMPLES_PER_EXCEPTION: usize = 50;

/// The relative difference below which ratios to the expected coefficients are equal. The limit allows for the rounding
/// of coefficients whose terms cancel down to a ten-thousandth.
const RATIO_TOLERANCE: f64 = 1e-9;

/// One polynomial of one sample.
pub(super) struct PolynomialSample<'a> {
    /// The sample that contains the polynomial.
    pub sample: &'a Sample,
    /// The logged coefficients.
    pub logged: &'a [f64],
    /// The inputs of the formulas.
    pub inputs: Inputs,
    /// The coefficients that should have been logged. The quintic is in the form that the course supplies.
    pub expected: Vec<BoundedValue>,
    /// Whether the logged polynomial is right, in any accepted form.
    pub is_right: bool,
    /// The positive factor that the submission's polynomials seem to have in this sample.
    pub scale: f64,
}

/// The samples of one polynomial.
pub(super) struct PolynomialStudy<'a> {
    /// The polynomial that is studied.
    pub subject: Subject,
    /// The samples that have the polynomial, with finite inputs.
    pub cases: Vec<PolynomialSample<'a>>,
    /// The number of wrong polynomials.
    pub wrong_count: usize,
    probes: Vec<usize>,
}

/// A guess that reproduces samples.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// The guess itself.
    pub guess: Guess,
    /// The details of the guess, which describe the wrong formula completely.
    pub details: Vec<PolynomialDetail>,
    /// All lists of details that reproduce equally many samples, the likeliest first. It is empty if there is only one
    /// such list.
    pub forms: Vec<Vec<PolynomialDetail>>,
    /// The cost of the guess; a likelier guess costs less. The cost is 1 to 3 for a change of the whole list, about 3
    /// for one factor or sign, and 4 for one wrong input. It is 5 or more for wrong letters and foreign terms. The
    /// costs of several edits are added.
    pub cost: f64,
    /// The number of samples that the guess reproduces.
    pub reproduced: usize,
}

impl<'a> PolynomialStudy<'a> {
    /// Creates the study of one polynomial from all samples. Returns `None` if no sample is wrong.
    pub fn new(subject: Subject, samples: &'a [Sample]) -> Option<Self> {
        let number = Subject::all_of_kind(subject.kind()).iter().position(|&other| other == subject)?;
        let mut cases: Vec<PolynomialSample<'a>> = samples
            .iter()
            .filter(|sample| sample.motion.kind() == subject.kind())
            .filter_map(|sample| {
                let logged = sample.polynomials.get(number)?.as_slice();
                let inputs = Inputs::new(&sample.motion);
                let polynomials = BoundedPairMotion::from(&sample.motion).polynomials();
                let expected = polynomials.polynomial(number).to_vec();
                let right = is_right(&expected, logged)
                    || polynomials.other_form(number).is_some_and(|other| is_right(other, logged));
                let finite = expected.iter().all(|coefficient| coefficient.bound.is_finite())
                    && logged.iter().all(|value| value.is_finite());
                finite.then_some(PolynomialSample { sample, logged, inputs, expected, is_right: right, scale: 1.0 })
            })
            .collect();
        accept_small_scales(&mut cases);
        if cases.iter().all(|case| case.is_right) {
            return None;
        }
        let cases = thin_out(cases);
        let all_wrong: Vec<usize> = (0..cases.len()).filter(|&index| !cases[index].is_right).collect();
        let probes = spread_indices(all_wrong.len(), PROBE_COUNT).map(|index| all_wrong[index]).collect();
        let mut study = Self { subject, cases, wrong_count: all_wrong.len(), probes };
        study.find_scales();
        Some(study)
    }

    /// Returns the wrong samples on which a guess is tried first.
    pub fn probes(&self) -> impl Iterator<Item = &PolynomialSample<'a>> {
        self.probes.iter().map(|&index| &self.cases[index])
    }

    /// Returns the number of samples that a predicted polynomial reproduces. The prediction may be multiplied by the
    /// sample's scale ([`PolynomialSample::scale`]). If this reproduces too few samples, it may be multiplied by any
    /// positive scale. The flag is set in the second case. Returns `None` if fewer than half of the wrong samples are
    /// reproduced.
    pub fn count_predicted(&self, predict: impl Fn(&PolynomialSample) -> Vec<BoundedValue>) -> Option<(usize, bool)> {
        let at_usual_scale = |case: &PolynomialSample| {
            let predicted = predict(case);
            polynomial_matches(&predicted, case.logged, case.scale) || polynomial_matches(&predicted, case.logged, 1.0)
        };
        let (usual, free) =
            (self.count_if(at_usual_scale), self.count_if(|case| fits_at_any_scale(&predict(case), case)));
        match (usual, free) {
            (Some(usual), Some(free)) if free > usual => Some((free, true)),
            (Some(usual), _) => Some((usual, false)),
            (None, free) => free.map(|free| (free, true)),
        }
    }

    /// Returns the number of samples with a property. Returns `None` if fewer than half of the wrong samples have it,
    /// if the first wrong sample lacks it, or if right samples contradict it.
    pub fn count_if(&self, holds: impl Fn(&PolynomialSample) -> bool) -> Option<usize> {
        if self.cases.iter().find(|case| !case.is_right).is_some_and(|first| !holds(first)) {
            return None;
        }
        let mut failed = 0;
        for case in self.probes() {
            failed += usize::from(!holds(case));
            if 2 * failed > self.probes.len() {
                return None;
            }
        }
        let (mut wrong, mut right) = (0, 0);
        for case in &self.cases {
            if holds(case) {
                *(if case.is_right { &mut right } else { &mut wrong }) += 1;
            }
        }
        let all_right = self.cases.len() - self.wrong_count;
        // A mistake that reproduces all wrong samples may occur only under a condition, so right samples do not
        // contradict it.
        let is_enough = wrong == self.wrong_count
            || (2 * wrong >= self.wrong_count && all_right - right <= all_right / SAMPLES_PER_EXCEPTION);
        is_enough.then_some(wrong + right)
    }

    /// Returns the number of samples that the right formula reproduces within the tolerance of a guess.
    pub fn count_reproduced(&self) -> usize {
        let holds = |case: &&PolynomialSample| {
            polynomial_matches(&case.expected, case.logged, case.scale) || fits_at_any_scale(&case.expected, case)
        };
        self.cases.iter().filter(holds).count()
    }

    /// Returns the largest deviation of a coefficient, relative to the size of its terms.
    pub fn max_error(&self) -> f64 {
        let case_error = |case: &PolynomialSample| {
            let scale = fit_scale(&case.expected, case.logged).unwrap_or(case.scale);
            let powers = 0..case.expected.len().max(case.logged.len());
            let errors = powers.map(|power| {
                let expected = expected_at(&case.expected, power);
                let residual = (logged_at(case.logged, power).unwrap_or(0.0) - scale * expected.value).abs();
                let missing = if power < case.logged.len() { 0.0 } else { MIN_LEADING_COEFFICIENT };
                if residual <= missing { 0.0 } else { residual / (scale * expected.bound) }
            });
            // NaN counts as the largest error.
            errors.fold(0.0_f64, |maximum, error| if error <= maximum { maximum } else { error })
        };
        self.cases.iter().map(case_error).fold(0.0_f64, |maximum, error| if error <= maximum { maximum } else { error })
    }

    /// Finds the positive factor that most coefficients agree on: 1, another factor for all samples, or one for each
    /// sample.
    fn find_scales(&mut self) {
        // A scale other than 1 must match clearly more coefficients, because the median ratio always matches some
        // coefficient.
        let unscaled = self.count_agreements(|_| 1.0) * 1.05 + 0.1 * self.cases.len() as f64 + 1.0;
        let mut best: (f64, Option<Vec<f64>>) = (unscaled, None);
        for anchor in 0..=self.subject.degree() {
            let ratios: Vec<Option<f64>> = self.cases.iter().map(|case| ratio(case, anchor)).collect();
            let Some(usual) = median(ratios.iter().copied().flatten().collect()).filter(|&usual| usual > 0.0) else {
                continue;
            };
            let agreement = self.count_agreements(|_| usual) * 1.02;
            if agreement > best.0 {
                best = (agreement, Some(vec![usual; self.cases.len()]));
            }
            let powers = self.find_agreeing_powers(&ratios);
            if powers.len() < 2 {
                continue;
            }
            let each: Vec<f64> = self
                .cases
                .iter()
                .map(|case| fit_scale_to_powers(&case.expected, case.logged, |power| powers.contains(&power)))
                .map(|scale| scale.unwrap_or(usual))
                .collect();
            // A scale that is fitted to each sample always matches one coefficient of it.
            let agreement = self.count_agreements(|index| each[index]) - self.cases.len() as f64;
            if agreement > best.0 {
                best = (agreement, Some(each));
            }
        }
        if let Some(scales) = best.1 {
            self.cases.iter_mut().zip(scales).for_each(|(case, scale)| case.scale = scale);
        }
    }

    /// Returns the powers whose coefficients have the same ratio to the expected ones as the given power, in nearly all
    /// samples.
    fn find_agreeing_powers(&self, ratios: &[Option<f64>]) -> Vec<usize> {
        let agrees = |case: &PolynomialSample, anchor: Option<f64>, power: usize| {
            let (anchor, other) = (anchor?, ratio(case, power)?);
            Some(anchor > 0.0 && (other - anchor).abs() <= RATIO_TOLERANCE * anchor)
        };
        let powers = 0..=self.subject.degree();
        powers
            .filter(|&power| {
                let (mut known, mut alike) = (0, 0);
                for (case, anchor) in self.cases.iter().zip(ratios) {
                    let agrees = agrees(case, *anchor, power);
                    known += usize::from(agrees.is_some());
                    alike += usize::from(agrees == Some(true));
                }
                alike > 0 && 10 * alike >= 9 * known
            })
            .collect()
    }

    /// Returns the number of logged coefficients that match the expected ones with the given scales. Dropped
    /// coefficients are not counted, because with a small scale all of them could be right.
    fn count_agreements(&self, scale: impl Fn(usize) -> f64) -> f64 {
        let agreeing = |(index, case): (usize, &PolynomialSample)| {
            let agrees = |power: &usize| {
                let (expected, logged) = (expected_at(&case.expected, *power), logged_at(case.logged, *power));
                logged.is_some() && exceeds_round_off(expected) && coefficient_matches(expected, logged, scale(index))
            };
            (0..case.expected.len()).filter(agrees).count()
        };
        self.cases.iter().enumerate().map(agreeing).sum::<usize>() as f64
    }

    /// Returns the number of samples in which each coefficient differs, as one line for each coefficient that ever
    /// differs. The lines name `subject` as the polynomial.
    pub fn count_differences(&self, subject: Option<Subject>) -> Vec<PolynomialDetail> {
        let differs = |case: &&PolynomialSample, power: usize| {
            !coefficient_matches(expected_at(&case.expected, power), logged_at(case.logged, power), case.scale)
        };
        let line = |power: usize| {
            let count = self.cases.iter().filter(|case| differs(case, power)).count();
            (count > 0).then_some(PolynomialDetail::Differs { subject, power, count, of: self.cases.len() })
        };
        (0..=self.subject.degree()).rev().filter_map(line).collect()
    }

    /// Returns the readings of this polynomial.
    pub fn formula_readings(&self) -> impl Iterator<Item = (Reading, &'static Formula)> + use<> {
        let subject = self.subject;
        readings(subject).iter().enumerate().map(move |(number, formula)| (Reading { subject, number }, formula))
    }
}

/// Returns the ratio of the logged to the expected coefficient, or `None` if the expected one is too small for an
/// accurate ratio.
pub(super) fn ratio(case: &PolynomialSample, power: usize) -> Option<f64> {
    let expected = expected_at(&case.expected, power);
    let ratio = logged_at(case.logged, power)? / expected.value;
    (expected.value.abs() > 1e-4 * expected.bound && ratio.is_finite()).then_some(ratio)
}

/// Returns the median, or `None` if there are no values.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Returns `count` indices below `length` that are evenly spread, or all indices if there are fewer.
pub(super) fn spread_indices(length: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(length);
    (0..count).map(move |index| index * length / count)
}

/// Returns whether a prediction matches the logged polynomial at some scale. If fewer than two coefficients exceed
/// round-off, some scale always fits, so the sample's own scale is used.
fn fits_at_any_scale(predicted: &[BoundedValue], case: &PolynomialSample) -> bool {
    if predicted.iter().filter(|coefficient| exceeds_round_off(**coefficient)).count() < 2 {
        return polynomial_matches(predicted, case.logged, case.scale);
    }
    fit_scale(predicted, case.logged).is_some_and(|scale| polynomial_matches(predicted, case.logged, scale))
}

/// Treats wrong samples as right if they match with the median scale of right samples. With a small scale, the course's
/// library drops coefficients that matter, so the scale cannot be fitted to each sample.
fn accept_small_scales(cases: &mut [PolynomialSample]) {
    let scales = cases.iter().filter(|case| case.is_right).filter_map(|case| fit_scale(&case.expected, case.logged));
    let Some(usual) = median(scales.collect()) else { return };
    for case in cases.iter_mut().filter(|case| !case.is_right) {
        case.is_right = polynomial_matches(&case.expected, case.logged, usual);
    }
}

/// Returns at most [`MAX_CASES`] of the samples, in their order. At most three quarters of them are wrong if there are
/// more samples.
fn thin_out(cases: Vec<PolynomialSample>) -> Vec<PolynomialSample> {
    if cases.len() <= MAX_CASES {
        return cases;
    }
    let chosen = |right: bool, count: usize| {
        let indices: Vec<usize> = (0..cases.len()).filter(|&index| cases[index].is_right == right).collect();
        spread_indices(indices.len(), count).map(|index| indices[index]).collect::<Vec<_>>()
    };
    let wrong = chosen(false, MAX_CASES * 3 / 4);
    let right = chosen(true, MAX_CASES - wrong.len());
    let mut keep = vec![false; cases.len()];
    wrong.into_iter().chain(right).for_each(|index| keep[index] = true);
    cases.into_iter().zip(keep).filter_map(|(case, keep)| keep.then_some(case)).collect()
}
