//! Changes of a pair's formulas, as data. The student's program and the explanation of its mistake use the same row.
use super::{
    Inputs, Subject,
    formulas::{product, readings},
};
use fosssim_model::sim::PairKind;
use fosssim_num::bounded::BoundedValue;

/// A change of formulas with a key and a description.
pub struct NamedEdit {
    /// The key of the explanation.
    pub key: &'static str,
    /// The sentence of the explanation, without its full stop.
    pub sentence: &'static str,
    /// The change as it appears in the formulas, such as `dx1 is 0 in the formulas`.
    pub detail: &'static str,
    /// The cost of the guess; cheaper guesses are preferred.
    pub cost: f64,
    /// The kinds of pairs that the change concerns.
    pub(super) kinds: &'static [PairKind],
    /// The change itself.
    pub edit: FormulaEdit,
}

impl NamedEdit {
    /// Returns the changed polynomial, highest power first, or `None` if the change does not concern this polynomial.
    pub fn polynomial(&self, subject: Subject, inputs: &Inputs) -> Option<Vec<BoundedValue>> {
        match self.edit {
            FormulaEdit::OtherInputs(change) if self.kinds.contains(&subject.kind()) => {
                let mut inputs = *inputs;
                change(&mut inputs);
                Some(readings(subject)[0].polynomial(&inputs))
            }
            FormulaEdit::Formula(of, make) if of == subject => Some(make(inputs)),
            _ => None,
        }
    }
}

/// A change of the formulas of one kind of pair.
#[derive(Clone, Copy)]
pub enum FormulaEdit {
    /// The change is one that explanations describe by a sentence of its own.
    Named(&'static NamedEdit),
    /// This function changes the inputs of all formulas.
    OtherInputs(fn(&mut Inputs)),
    /// One term has this additional factor. It is the term of the coefficient of `t^power` (the second field) with
    /// exactly these letters (the third field).
    Weight(Subject, usize, &'static [usize], f64),
    /// This function changes the values of the formula's letters.
    Letters(Subject, fn(&mut [BoundedValue], &Inputs)),
    /// This function computes the polynomial instead of the right formula.
    Formula(Subject, fn(&Inputs) -> Vec<BoundedValue>),
    /// This function changes the coefficients of the polynomial. The highest power is first.
    List(Subject, fn(&mut Vec<f64>)),
    /// This function changes the list of all polynomials of the pair.
    Lists(fn(&mut Vec<Vec<f64>>)),
}

impl FormulaEdit {
    /// Applies the change to `lists`, which are the right polynomials of `subjects`. `approach` is the index of the
    /// reading that the program uses for the approach of a particle and an edge.
    pub fn apply(self, inputs: &Inputs, lists: &mut Vec<Vec<f64>>, subjects: &[Subject], approach: usize) {
        let formula = |subject| &readings(subject)[if subject == Subject::EdgeApproach { approach } else { 0 }];
        let mut replace = |subject: Subject, change: &dyn Fn(&mut Vec<f64>)| {
            subjects.iter().zip(&mut *lists).filter(|(one, _)| **one == subject).for_each(|(_, list)| change(list));
        };
        let values = |list: Vec<BoundedValue>| list.iter().map(|coefficient| coefficient.value).collect::<Vec<f64>>();
        match self {
            Self::Named(named) => named.edit.apply(inputs, lists, subjects, approach),
            Self::OtherInputs(change) => {
                let mut inputs = *inputs;
                change(&mut inputs);
                *lists = subjects.iter().map(|&subject| values(formula(subject).polynomial(&inputs))).collect();
            }
            Self::Weight(subject, power, letters, factor) => replace(subject, &|list| {
                let formula = formula(subject);
                let quantities = formula.letter_values(inputs);
                let terms = formula.terms.iter().filter(|term| term.power == power);
                let weight = |letters_of_term| if letters_of_term == letters { factor } else { 1.0 };
                list[formula.degree - power] = terms
                    .map(|term| weight(term.letters) * term.weight * product(&quantities, term.letters).value)
                    .sum();
            }),
            Self::Letters(subject, change) => replace(subject, &|list| {
                let mut quantities = formula(subject).letter_values(inputs);
                change(&mut quantities, inputs);
                *list = values(formula(subject).evaluate(&quantities));
            }),
            Self::Formula(subject, make) => replace(subject, &|list| *list = values(make(inputs))),
            Self::List(subject, change) => replace(subject, &change),
            Self::Lists(change) => change(lists),
        }
    }
}

#[expect(clippy::ptr_arg, reason = "a change of a list may shorten it")]
pub(super) fn negate_list(list: &mut Vec<f64>) {
    list.iter_mut().for_each(|coefficient| *coefficient = -*coefficient);
}

#[expect(clippy::ptr_arg, reason = "a change of a list may shorten it")]
pub(super) fn negate_at<const PLACE: usize>(list: &mut Vec<f64>) {
    list[PLACE] = -list[PLACE];
}

pub(super) fn keep_last<const COUNT: usize>(list: &mut Vec<f64>) {
    list.drain(..list.len() - COUNT);
}

pub(super) fn replace_by_one(list: &mut Vec<f64>) {
    *list = vec![1.0];
}

/// Omits the first particle's displacement in the overlap.
pub(super) fn omit_first_displacement(letters: &mut [BoundedValue], inputs: &Inputs) {
    (letters[0], letters[1]) = (inputs.d[1].dot(inputs.d[1]), inputs.x21().dot(inputs.d[1]));
}

/// Uses end positions instead of displacements in the overlap.
pub(super) fn use_end_positions(letters: &mut [BoundedValue], inputs: &Inputs) {
    let end = inputs.x21() + inputs.d21();
    (letters[0], letters[1]) = (end.dot(end), inputs.x21().dot(end));
}

/// Omits the second component in the overlap's moving terms.
pub(super) fn omit_second_component(letters: &mut [BoundedValue], inputs: &Inputs) {
    let (x, d) = (inputs.x21().x, inputs.d21().x);
    (letters[0], letters[1]) = (d * d, x * d);
}
