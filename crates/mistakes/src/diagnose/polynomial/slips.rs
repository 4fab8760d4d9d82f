//! Right formulas with one wrong letter: scaled, of the wrong sign, or another dot product.
use super::study::{Candidate, Study};
use crate::assignments::t2m2::{
    Inputs,
    formulas::{Formula, Letter},
    ingredients::{Ingredient, ingredients},
};
use fosssim_num::bounded::Bounded;

/// What stands for a letter.
enum Stand<'a> {
    /// The letter itself, multiplied.
    Scaled(f64),
    /// Another letter.
    Letter(usize),
    /// A dot product, perhaps with the wrong sign.
    Dot(&'a Ingredient, &'a Ingredient, f64),
    /// The number 1.
    One,
}

impl Stand<'_> {
    fn value(&self, slot: usize, values: &[Bounded], inputs: &Inputs) -> Bounded {
        match self {
            Self::Scaled(factor) => *factor * values[slot],
            Self::Letter(other) => values[*other],
            Self::Dot(one, two, sign) => *sign * (one.value)(inputs).dot((two.value)(inputs)),
            Self::One => Bounded::exact(1.0),
        }
    }

    fn words(&self, letter: &Letter, letters: &[Letter]) -> String {
        let sign = |sign: f64| if sign < 0.0 { "-" } else { "" };
        match self {
            Self::Scaled(factor) => format!("{factor} {}", letter.name),
            Self::Letter(other) => described(&letters[*other]),
            Self::Dot(one, two, factor) => format!("{}{}.{}", sign(*factor), one.name, two.name),
            Self::One => "1".to_owned(),
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

/// A letter with what it stands for.
pub(super) fn described(letter: &Letter) -> String {
    if letter.meaning.is_empty() { letter.name.to_owned() } else { format!("{} = {}", letter.name, letter.meaning) }
}

/// One-letter slips that reproduce at least half of the wrong samples.
pub(super) fn candidates(study: &Study) -> Vec<Candidate> {
    study.formulas().iter().enumerate().flat_map(|(index, formula)| in_formula(study, formula, index)).collect()
}

fn in_formula(study: &Study, formula: &Formula, reading: usize) -> Vec<Candidate> {
    let pool = ingredients(study.subject.kind());
    let mut found = Vec::new();
    for (slot, letter) in formula.letters.iter().enumerate() {
        let uses = formula.terms.iter().filter(|term| term.letters.contains(&slot)).count();
        if uses == 0 {
            continue;
        }
        let scaled = [-1.0, 0.0, 2.0, 0.5].into_iter().filter(|_| uses > 1).map(Stand::Scaled);
        let letters = (0..formula.letters.len()).filter(|&other| other != slot).map(Stand::Letter);
        let dots = pool.iter().enumerate().flat_map(|(index, one)| {
            pool[index..].iter().flat_map(move |two| [1.0, -1.0].map(|sign| Stand::Dot(one, two, sign)))
        });
        for stand in scaled.chain(letters).chain(dots).chain([Stand::One]) {
            let counted = study.count(|case| {
                let mut values = formula.values(&case.inputs);
                values[slot] = stand.value(slot, &values, &case.inputs);
                formula.evaluate(&values)
            });
            let Some((reproduced, rescaled)) = counted else { continue };
            let words = stand.words(letter, formula.letters);
            let detail = match letter.meaning {
                "" => format!("{words} stands for {}", letter.name),
                meaning => format!("{}: {words} stands for {meaning}", letter.name),
            };
            let sentence = match stand {
                Stand::Scaled(factor) if factor < 0.0 => "A dot product of the formula has the wrong sign",
                Stand::Scaled(0.0) => "A quantity of the formula is zero",
                Stand::Scaled(_) => "A quantity of the formula has a wrong factor",
                _ => "Another quantity stands where a dot product of the formula belongs",
            };
            found.push(Candidate {
                key: if matches!(stand, Stand::Scaled(_)) { "letter-factor" } else { "letter" }.to_owned(),
                sentence: sentence.to_owned(),
                details: vec![detail],
                cost: stand.cost() + if rescaled { 2.0 } else { 0.0 } + 0.1 * reading as f64,
                reproduced,
                general: false,
            });
        }
    }
    found
}
