//! Finds wrong coefficients, one at a time: a wrong factor, or a few terms that are missing, surplus or wrongly
//! weighted.
use super::{
    compare::{coefficient_matches, expected_at, logged_at},
    dictionary::Dictionary,
    study::{Candidate, PolynomialSample, PolynomialStudy, median, spread_indices},
};
use crate::diagnose::{CoefficientGuess, Guess, PolynomialDetail, Weight};
use fosssim_num::{
    bounded::BoundedValue,
    sparse::{DesignMatrix, WeightedColumns},
};
use fosssim_student::assignments::t2m2::{Reading, formulas::Formula};

/// The maximum number of wrong samples in a fit, which also uses half as many right samples.
const MAX_ROWS: usize = 240;

/// The minimum number of samples in a fit that have the coefficient. If there are fewer, samples without it are used as
/// well.
const MIN_ROWS: usize = 12;

/// The minimum number of samples for each weight of an unusual size. With fewer samples, some weights always fit.
const MIN_ROWS_PER_WEIGHT: usize = 4;

/// Weights are multiples of this step.
const WEIGHT_STEP: f64 = 0.25;

/// The maximum distance of a fitted weight from a multiple of the step, in steps; the normal equations are accurate
/// enough for this.
const SNAP_DISTANCE: f64 = 1e-3;

/// The largest weight that is considered a slip.
const MAX_WEIGHT: f64 = 64.0;

/// The maximum number of alternative explanations of a coefficient that are reported.
const MAX_ALTERNATIVES: usize = 3;

/// The maximum number of forms of a polynomial that are compared with those of other traces.
const MAX_FORMS: usize = 64;

/// The cost of a coefficient that is not explained.
const UNKNOWN_COST: f64 = 20.0;

/// A change of one coefficient.
enum CoefficientEdit {
    /// The coefficient has an additional factor.
    Factor(BoundedValue),
    /// The weights of some products in the coefficient are changed by these amounts.
    Terms(Vec<(usize, f64)>),
    /// The change is unknown.
    Unknown,
}

/// The possible edits of one coefficient, the likeliest first. There is at least one.
struct CoefficientEdits {
    power: usize,
    edits: Vec<(CoefficientEdit, f64)>,
}

impl CoefficientEdits {
    fn edit(&self) -> &CoefficientEdit {
        &self.edits[0].0
    }
}

/// Returns the guesses about all wrong coefficients, if at least one coefficient can be explained.
pub(super) fn collect_candidates(study: &PolynomialStudy) -> Vec<Candidate> {
    study.formula_readings().filter_map(|(reading, formula)| candidate(study, formula, reading)).collect()
}

fn candidate(study: &PolynomialStudy, formula: &'static Formula, reading: Reading) -> Option<Candidate> {
    let fitting = TermFit::new(study, formula, reading);
    let wrong = (0..=formula.degree).rev().filter(|&power| fitting.is_wrong(power));
    let guesses: Vec<CoefficientEdits> = wrong.map(|power| fitting.explain_coefficient(power)).collect();
    // A polynomial without an explained coefficient is not a candidate.
    guesses.iter().find(|guess| !matches!(guess.edit(), CoefficientEdit::Unknown))?;
    let is_reproduced = |index: usize| {
        let case = &study.cases[index];
        case.logged.len() <= formula.degree + 1
            && (0..=formula.degree).all(|power| {
                let guess = guesses.iter().find(|guess| guess.power == power);
                let predicted = fitting.predict(index, power, guess.map(CoefficientEdits::edit));
                coefficient_matches(predicted, logged_at(case.logged, power), case.scale)
            })
    };
    let reproduced_count = (0..study.cases.len()).filter(|&index| is_reproduced(index)).count();
    Some(Candidate {
        guess: Guess::Coefficients {
            powers: guesses.iter().map(|guess| guess.power).collect(),
            wrong: fitting.classify_coefficient(&guesses),
        },
        details: guesses.iter().flat_map(|guess| fitting.details(guess)).collect(),
        forms: fitting.forms(&guesses),
        cost: guesses.iter().map(|guess| guess.edits[0].1).sum::<f64>() + 0.1 * reading.number as f64,
        reproduced: reproduced_count,
    })
}

/// The samples with the values of all products.
struct TermFit<'a> {
    study: &'a PolynomialStudy<'a>,
    formula: &'static Formula,
    reading: Reading,
    dictionary: Dictionary,
    expected: Vec<Vec<BoundedValue>>,
    products: Vec<Vec<BoundedValue>>,
}

impl<'a> TermFit<'a> {
    fn new(study: &'a PolynomialStudy<'a>, formula: &'static Formula, reading: Reading) -> Self {
        let dictionary = Dictionary::new(study.subject, formula);
        let expected = study.cases.iter().map(|case| formula.polynomial(&case.inputs)).collect();
        let products = study.cases.iter().map(|case| dictionary.evaluate(&case.inputs)).collect();
        Self { study, formula, reading, dictionary, expected, products }
    }

    fn case(&self, index: usize) -> &PolynomialSample<'a> {
        &self.study.cases[index]
    }

    fn coefficient(&self, index: usize, power: usize) -> BoundedValue {
        expected_at(&self.expected[index], power)
    }

    fn is_reproduced(&self, index: usize, power: usize, predicted: BoundedValue) -> bool {
        let case = self.case(index);
        coefficient_matches(predicted, logged_at(case.logged, power), case.scale)
    }

    fn is_wrong(&self, power: usize) -> bool {
        (0..self.study.cases.len()).any(|index| !self.is_reproduced(index, power, self.coefficient(index, power)))
    }

    fn predict(&self, index: usize, power: usize, edit: Option<&CoefficientEdit>) -> BoundedValue {
        let expected = self.coefficient(index, power);
        match edit {
            None | Some(CoefficientEdit::Unknown) => expected,
            Some(CoefficientEdit::Factor(factor)) => *factor * expected,
            Some(CoefficientEdit::Terms(changes)) => {
                changes.iter().fold(expected, |sum, &(product, weight)| sum + weight * self.products[index][product])
            }
        }
    }

    fn explains_all(&self, power: usize, edit: &CoefficientEdit) -> bool {
        (0..self.study.cases.len())
            .all(|index| self.is_reproduced(index, power, self.predict(index, power, Some(edit))))
    }

    /// Returns the edits of a coefficient that explain all samples, or only [`CoefficientEdit::Unknown`] if there are
    /// none.
    fn explain_coefficient(&self, power: usize) -> CoefficientEdits {
        let terms =
            self.find_term_changes(power).into_iter().map(|(changes, cost)| (CoefficientEdit::Terms(changes), cost));
        let factor = self.find_constant_factor(power).map(|(factor, cost)| (CoefficientEdit::Factor(factor), cost));
        let mut edits: Vec<(CoefficientEdit, f64)> = terms.chain(factor).collect();
        edits.sort_by(|one, two| one.1.total_cmp(&two.1));
        if edits.is_empty() {
            edits.push((CoefficientEdit::Unknown, UNKNOWN_COST));
        }
        CoefficientEdits { power, edits }
    }

    /// Returns the constant factor by which the coefficient is wrong, if there is one.
    fn find_constant_factor(&self, power: usize) -> Option<(BoundedValue, f64)> {
        let ratios = (0..self.study.cases.len()).filter_map(|index| {
            let (case, expected) = (self.case(index), self.coefficient(index, power));
            let value = logged_at(case.logged, power).unwrap_or(0.0);
            (expected.value.abs() > 1e-3 * expected.bound).then(|| value / (case.scale * expected.value))
        });
        let factor = median(ratios.collect())?;
        // Adding 0 turns -0 into 0.
        let simple = (factor * 12.0).round() / 12.0 + 0.0;
        let is_simple = (factor - simple).abs() < 1e-12;
        let factor = if is_simple {
            BoundedValue::from_exact(simple)
        } else {
            BoundedValue { value: factor, bound: 16.0 * factor.abs() }
        };
        let cost = match factor.value {
            -1.0 | 0.0 | 0.5 | 2.0 => 3.2,
            _ if is_simple => 5.0,
            _ => 6.0,
        };
        self.explains_all(power, &CoefficientEdit::Factor(factor)).then_some((factor, cost))
    }

    /// Returns the changes of the fewest terms that explain the coefficient in all samples, with their costs.
    fn find_term_changes(&self, power: usize) -> Vec<(Vec<(usize, f64)>, f64)> {
        let rows = self.fit_rows(power);
        let bounds: Vec<f64> = rows.iter().map(|&index| self.coefficient(index, power).bound).collect();
        let scale = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
            rows.iter().zip(&bounds).map(|(&index, bound)| value(index) / bound).collect()
        };
        let target = scale(&|index| {
            let case = self.case(index);
            let value = logged_at(case.logged, power).unwrap_or(0.0) / case.scale;
            value - self.coefficient(index, power).value
        });
        let columns: Vec<Vec<f64>> = (0..self.dictionary.products.len())
            .map(|product| scale(&|index| self.products[index][product].value))
            .collect();
        let order = self.natural_order(power);
        let prepared = DesignMatrix::new(&columns, &|product| {
            let product = &self.dictionary.products[product];
            product.order == order && !product.is_foreign
        });
        let mut found = Vec::new();
        prepared.find_supports(&target, &mut |support| {
            let Some(changes) = snap_weights(support) else { return false };
            let is_usual = changes.iter().all(|&change| has_usual_size(self.weights(power, change).1));
            let proves_nothing = changes.len() > 1 && rows.len() <= changes.len();
            if proves_nothing || (!is_usual && rows.len() < MIN_ROWS_PER_WEIGHT * changes.len()) {
                return false;
            }
            let edit = CoefficientEdit::Terms(changes);
            let is_explained = self.explains_all(power, &edit);
            if let (true, CoefficientEdit::Terms(changes)) = (is_explained, edit) {
                let cost = changes.iter().map(|change| self.cost(power, order, *change)).sum();
                found.push((changes, cost));
            }
            is_explained
        });
        if found.is_empty() { self.find_lost_products(power) } else { found }
    }

    /// Returns changes in which the letters of a term are added instead of multiplied.
    fn find_lost_products(&self, power: usize) -> Vec<(Vec<(usize, f64)>, f64)> {
        let sums = (0..self.dictionary.products.len()).filter_map(|product| {
            let weight = self.dictionary.weight(self.formula, power, product);
            let letters = self.dictionary.find_factors(product)?;
            (weight != 0.0).then(|| vec![(product, -weight), (letters[0], weight), (letters[1], weight)])
        });
        sums.filter(|sum| self.explains_all(power, &CoefficientEdit::Terms(sum.clone())))
            .map(|sum| (sum, 6.0))
            .collect()
    }

    /// Returns the degree in the displacements of a coefficient's terms.
    fn natural_order(&self, power: usize) -> u8 {
        let term = self.formula.terms.iter().find(|term| term.power == power);
        term.map_or(0, |term| term.letters.iter().map(|&letter| self.formula.letters[letter].order).sum())
    }

    /// Returns the cost of a change of a product's weight.
    fn cost(&self, power: usize, order: u8, (product, change): (usize, f64)) -> f64 {
        let weight = self.dictionary.weight(self.formula, power, product);
        let entry = &self.dictionary.products[product];
        if weight == 0.0 {
            let strange = if entry.order == order { 0.0 } else { 1.5 } + if entry.is_foreign { 0.5 } else { 0.0 };
            return strange + if change.abs() == 1.0 || change.abs() == 2.0 { 4.5 } else { 5.5 };
        }
        match (weight + change) / weight {
            0.0 => 3.0,
            -1.0 => 3.1,
            0.5 | 2.0 => 3.2,
            _ => 4.0,
        }
    }

    /// Returns the indices of the samples of a fit: those with a wrong coefficient, and several others.
    fn fit_rows(&self, power: usize) -> Vec<usize> {
        let usable = |&index: &usize| {
            let logged = logged_at(self.case(index).logged, power);
            self.coefficient(index, power).bound > 0.0 && logged.unwrap_or(0.0).is_finite()
        };
        let all: Vec<usize> = (0..self.study.cases.len()).filter(usable).collect();
        // A dropped coefficient is known only up to 1e-12, which is too inaccurate for a fit.
        let logged = |&index: &usize| logged_at(self.case(index).logged, power).is_some();
        let present: Vec<usize> = all.iter().copied().filter(logged).collect();
        let (right, wrong): (Vec<usize>, Vec<usize>) = if present.len() < MIN_ROWS { all } else { present }
            .into_iter()
            .partition(|&index| self.is_reproduced(index, power, self.coefficient(index, power)));
        let few = |list: &[usize], count: usize| {
            spread_indices(list.len(), count).map(|index| list[index]).collect::<Vec<_>>()
        };
        let mut rows = few(&wrong, MAX_ROWS);
        rows.extend(few(&right, MAX_ROWS / 2));
        rows
    }
}

/// Returns whether people write such a weight: zero, or a power of two from 1/4 to 4, with any sign.
fn has_usual_size(weight: f64) -> bool {
    [0.0, 0.25, 0.5, 1.0, 2.0, 4.0].contains(&weight.abs())
}

/// Returns the weights, rounded to multiples of [`WEIGHT_STEP`]. Returns `None` if they are not close to multiples.
fn snap_weights(support: &WeightedColumns) -> Option<Vec<(usize, f64)>> {
    support
        .iter()
        .map(|&(product, weight)| {
            let steps = weight / WEIGHT_STEP;
            let rounded = steps.round();
            let is_whole = (steps - rounded).abs() <= SNAP_DISTANCE && rounded != 0.0 && weight.abs() <= MAX_WEIGHT;
            is_whole.then_some((product, rounded * WEIGHT_STEP))
        })
        .collect()
}

/// Converts guesses into the reported values.
impl TermFit<'_> {
    fn weights(&self, power: usize, (product, change): (usize, f64)) -> (f64, f64) {
        let expected = self.dictionary.weight(self.formula, power, product);
        (expected, expected + change)
    }

    fn classify_coefficient(&self, guesses: &[CoefficientEdits]) -> CoefficientGuess {
        let [guess] = guesses else { return CoefficientGuess::Several };
        match guess.edit() {
            CoefficientEdit::Factor(factor) if factor.value == 0.0 => CoefficientGuess::Zero,
            CoefficientEdit::Factor(factor) if factor.value == -1.0 => CoefficientGuess::Sign,
            CoefficientEdit::Factor(_) => CoefficientGuess::Factor,
            // An unexplained coefficient alone is not a guess (see `candidate`).
            CoefficientEdit::Unknown => CoefficientGuess::Several,
            CoefficientEdit::Terms(changes) => match changes[..] {
                [change] => match self.weights(guess.power, change) {
                    (0.0, _) => CoefficientGuess::TermForeign,
                    (_, 0.0) => CoefficientGuess::TermMissing,
                    (expected, actual) if expected == -actual => CoefficientGuess::TermSign,
                    _ => CoefficientGuess::TermFactor,
                },
                _ => CoefficientGuess::Terms,
            },
        }
    }

    /// Returns the lists of details of the whole polynomial that follow from the coefficients' edits, the likeliest
    /// first.
    fn forms(&self, guesses: &[CoefficientEdits]) -> Vec<Vec<PolynomialDetail>> {
        guesses.iter().fold(vec![Vec::new()], |forms, guess| {
            let edit_lines = |(edit, _): &(CoefficientEdit, f64)| self.list_details(guess.power, edit);
            let edits: Vec<Vec<PolynomialDetail>> = guess.edits.iter().map(edit_lines).collect();
            let with = |form: &Vec<PolynomialDetail>| {
                edits.iter().map(|lines| [form.as_slice(), lines].concat()).collect::<Vec<_>>()
            };
            forms.iter().flat_map(with).take(MAX_FORMS).collect()
        })
    }

    fn list_details(&self, power: usize, edit: &CoefficientEdit) -> Vec<PolynomialDetail> {
        match edit {
            CoefficientEdit::Factor(factor) => vec![PolynomialDetail::Factor { power, factor: factor.value }],
            CoefficientEdit::Unknown => vec![PolynomialDetail::Unknown { power }],
            CoefficientEdit::Terms(changes) => {
                changes.iter().map(|change| PolynomialDetail::Weight(self.weight(power, *change))).collect()
            }
        }
    }

    fn details(&self, guess: &CoefficientEdits) -> Vec<PolynomialDetail> {
        let as_well = |(edit, _): &(CoefficientEdit, f64)| match edit {
            CoefficientEdit::Terms(changes) => {
                let weights = changes.iter().map(|change| self.weight(guess.power, *change)).collect();
                Some(PolynomialDetail::Alternative(weights))
            }
            _ => None,
        };
        let edits_terms = matches!(guess.edit(), CoefficientEdit::Terms(_));
        let others = guess.edits[1..].iter().filter(|_| edits_terms).filter_map(as_well);
        self.list_details(guess.power, guess.edit()).into_iter().chain(others.take(MAX_ALTERNATIVES)).collect()
    }

    fn weight(&self, power: usize, change: (usize, f64)) -> Weight {
        let (expected, actual) = self.weights(power, change);
        Weight { reading: self.reading, power, letters: self.dictionary.letter_names(change.0), expected, actual }
    }
}
