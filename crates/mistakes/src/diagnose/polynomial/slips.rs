//! Finds formulas that are right except for one letter. The letter is scaled, has the wrong sign, or is replaced by
//! another dot product.
use super::study::{Candidate, PolynomialStudy};
use crate::diagnose::{Guess, PolynomialDetail, QuantityGuess, Substitute};
use fosssim_num::bounded::BoundedValue;
use fosssim_student::assignments::t2m2::{
    Inputs, Reading,
    formulas::{Formula, Letter},
    ingredients::{Ingredient, ingredients},
};

/// A quantity that replaces a letter in a formula.
enum LetterReplacement<'a> {
    /// The letter is multiplied by a factor.
    Scaled(f64),
    /// The letter with this index is used instead.
    Letter(usize),
    /// A dot product is used instead, possibly with the wrong sign.
    Dot(&'a Ingredient, &'a Ingredient, f64),
    /// The number 1 is used instead.
    One,
}

impl LetterReplacement<'_> {
    fn value(&self, slot: usize, values: &[BoundedValue], inputs: &Inputs) -> BoundedValue {
        match self {
            Self::Scaled(factor) => *factor * values[slot],
            Self::Letter(other) => values[*other],
            Self::Dot(one, two, sign) => *sign * (one.value)(inputs).dot((two.value)(inputs)),
            Self::One => BoundedValue::from_exact(1.0),
        }
    }

    fn substitute(&self, letters: &[Letter]) -> Substitute {
        match self {
            Self::Scaled(factor) => Substitute::Scaled(*factor),
            Self::Letter(other) => Substitute::Letter(letters[*other].name.into()),
            Self::Dot(one, two, sign) => {
                Substitute::Dot { vectors: [one.name, two.name].map(Into::into), negated: *sign < 0.0 }
            }
            Self::One => Substitute::One,
        }
    }

    fn guess(&self) -> QuantityGuess {
        match self {
            Self::Scaled(factor) if *factor < 0.0 => QuantityGuess::Sign,
            Self::Scaled(0.0) => QuantityGuess::Zero,
            Self::Scaled(_) => QuantityGuess::Factor,
            _ => QuantityGuess::Other,
        }
    }

    fn cost(&self) -> f64 {
        match self {
            Self::Scaled(factor) if *factor == -1.0 => 4.5,
            Self::Scaled(_) => 4.8,
            Self::Letter(_) => 5.0,
            Self::One => 5.5,
            Self::Dot(one, two, sign) => 5.2 + one.cost + two.cost + if *sign < 0.0 { 0.5 } else { 0.0 },
        }
    }
}

/// Returns the guesses with one wrong letter that reproduce at least half of the wrong samples.
pub(super) fn collect_candidates(study: &PolynomialStudy) -> Vec<Candidate> {
    study.formula_readings().flat_map(|(reading, formula)| collect_formula_slips(study, formula, reading)).collect()
}

fn collect_formula_slips(study: &PolynomialStudy, formula: &Formula, reading: Reading) -> Vec<Candidate> {
    let pool = ingredients(study.subject.kind());
    let mut found = Vec::new();
    for (slot, letter) in formula.letters.iter().enumerate() {
        let use_count = formula.terms.iter().filter(|term| term.letters.contains(&slot)).count();
        if use_count == 0 {
            continue;
        }
        let scaled = [-1.0, 0.0, 2.0, 0.5].into_iter().filter(|_| use_count > 1).map(LetterReplacement::Scaled);
        let letters = (0..formula.letters.len()).filter(|&other| other != slot).map(LetterReplacement::Letter);
        let dots = pool.iter().enumerate().flat_map(|(index, one)| {
            pool[index..].iter().flat_map(move |two| [1.0, -1.0].map(|sign| LetterReplacement::Dot(one, two, sign)))
        });
        for trial in scaled.chain(letters).chain(dots).chain([LetterReplacement::One]) {
            let counted = study.count_predicted(|case| {
                let mut values = formula.letter_values(&case.inputs);
                values[slot] = trial.value(slot, &values, &case.inputs);
                formula.evaluate(&values)
            });
            let Some((reproduced, rescaled)) = counted else { continue };
            let stand = trial.substitute(formula.letters);
            found.push(Candidate {
                guess: Guess::Quantity(trial.guess()),
                details: vec![PolynomialDetail::StandsFor { reading, letter: letter.name.into(), stand }],
                forms: Vec::new(),
                cost: trial.cost() + if rescaled { 2.0 } else { 0.0 } + 0.1 * reading.number as f64,
                reproduced,
            });
        }
    }
    found
}
