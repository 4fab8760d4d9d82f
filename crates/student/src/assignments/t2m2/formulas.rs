//! The formulas of collisions.md 2 as data: each coefficient is a sum of weighted products of letters.
//!
//! The fair rules' formulas (`judge::fair::formulas`) define the right polynomials, and a test compares the tables with
//! them. The formulas are data so that they can be changed: a term can be dropped, or a letter exchanged. The letters
//! are those of the assignment, and those of the quintic that the course supplies. The quintic's sums `k` to `o` are
//! multiplied out here, and its `p` and `q` are called `b` and `c`.
use super::{Inputs, Subject};
use fosssim_num::bounded::BoundedValue;

/// A symbol in a formula, such as `r1` or `x21.d21`.
pub struct Letter {
    /// The symbol in messages.
    pub name: &'static str,
    /// The symbol's meaning, in the assignment's notation. The text is empty if the symbol explains itself.
    pub meaning: &'static str,
    /// The symbol's degree in the displacements.
    pub order: u8,
    /// The symbol's value.
    pub value: fn(&Inputs) -> BoundedValue,
}

/// A term of a formula. It is the product of `letters` (indices into the formula's letters) with the factor `weight`,
/// in the coefficient of `t^power`.
pub struct Term {
    /// The power of t.
    pub power: usize,
    /// The factor of the product.
    pub weight: f64,
    /// The indices of the letters, ascending.
    pub letters: &'static [usize],
}

/// One way to write a polynomial.
pub struct Formula {
    /// The symbols in the formula, such as `r1` or `x21.d21`.
    pub letters: &'static [Letter],
    /// The formula's terms.
    pub terms: &'static [Term],
    /// The degree in t.
    pub degree: usize,
}

impl Formula {
    /// Returns the values of the formula's letters for these inputs.
    pub fn letter_values(&self, inputs: &Inputs) -> Vec<BoundedValue> {
        self.letters.iter().map(|letter| (letter.value)(inputs)).collect()
    }

    /// Returns the coefficients for these values of the letters. The highest power is first, and leading zeros are
    /// kept.
    pub fn evaluate(&self, values: &[BoundedValue]) -> Vec<BoundedValue> {
        let mut coefficients = vec![BoundedValue::default(); self.degree + 1];
        for term in self.terms {
            let slot = &mut coefficients[self.degree - term.power];
            *slot = *slot + term.weight * product(values, term.letters);
        }
        coefficients
    }

    /// Returns the coefficients for these inputs, like [`Formula::evaluate`].
    pub fn polynomial(&self, inputs: &Inputs) -> Vec<BoundedValue> {
        self.evaluate(&self.letter_values(inputs))
    }
}

/// Returns the product of the `values` at the indices `letters`, or 1 if there are no indices.
pub fn product(values: &[BoundedValue], letters: &[usize]) -> BoundedValue {
    match letters {
        [] => BoundedValue::from_exact(1.0),
        [first, rest @ ..] => rest.iter().fold(values[*first], |product, &letter| product * values[letter]),
    }
}

/// Returns the readings of one polynomial, which are the formulas that count as right. The assignment's reading is
/// first.
pub fn readings(subject: Subject) -> &'static [Formula] {
    match subject {
        Subject::ParticleOverlap => PARTICLE_OVERLAP_FORMULAS,
        Subject::ParticleApproach => PARTICLE_APPROACH_FORMULAS,
        Subject::EdgeOverlap => QUARTIC_FORMULAS,
        Subject::AlphaLow => ALPHA_LOW_FORMULAS,
        Subject::AlphaHigh => ALPHA_HIGH_FORMULAS,
        Subject::EdgeApproach => &QUINTIC_FORMULAS,
        Subject::HalfPlaneOverlap => HALF_PLANE_OVERLAP_FORMULAS,
        Subject::HalfPlaneApproach => HALF_PLANE_APPROACH_FORMULAS,
    }
}

const fn letter(name: &'static str, meaning: &'static str, order: u8, value: fn(&Inputs) -> BoundedValue) -> Letter {
    Letter { name, meaning, order, value }
}

const fn term(power: usize, weight: f64, letters: &'static [usize]) -> Term {
    Term { power, weight, letters }
}

const PARTICLE_LETTERS: [Letter; 4] = [
    letter("d21.d21", "", 2, |inputs| inputs.d21().dot(inputs.d21())),
    letter("x21.d21", "", 1, |inputs| inputs.x21().dot(inputs.d21())),
    letter("x21.x21", "", 0, |inputs| inputs.x21().dot(inputs.x21())),
    letter("R^2", "", 0, |inputs| inputs.square),
];

const PARTICLE_OVERLAP_FORMULAS: &[Formula] = &[Formula {
    letters: &PARTICLE_LETTERS,
    terms: &[term(2, -1.0, &[0]), term(1, -2.0, &[1]), term(0, 1.0, &[3]), term(0, -1.0, &[2])],
    degree: 2,
}];

const PARTICLE_APPROACH_FORMULAS: &[Formula] =
    &[Formula { letters: &PARTICLE_LETTERS, terms: &[term(1, -1.0, &[0]), term(0, -1.0, &[1])], degree: 1 }];

const HALF_PLANE_LETTERS: [Letter; 4] = [
    letter("(dx.n)", "", 1, |inputs| inputs.d[0].dot(inputs.normal())),
    letter("((p-x).n)", "", 0, |inputs| inputs.x21().dot(inputs.normal())),
    letter("(n.n)", "", 0, |inputs| inputs.normal_square),
    letter("r^2", "", 0, |inputs| inputs.square),
];

const HALF_PLANE_OVERLAP_FORMULAS: &[Formula] = &[Formula {
    letters: &HALF_PLANE_LETTERS,
    terms: &[term(2, -1.0, &[0, 0]), term(1, 2.0, &[0, 1]), term(0, -1.0, &[1, 1]), term(0, 1.0, &[2, 3])],
    degree: 2,
}];

const HALF_PLANE_APPROACH_FORMULAS: &[Formula] =
    &[Formula { letters: &HALF_PLANE_LETTERS, terms: &[term(1, -1.0, &[0, 0]), term(0, 1.0, &[0, 1])], degree: 1 }];

/// The letters `a..i` of the quartic, and the squared sum of the radii.
const EDGE_LETTERS: [Letter; 10] = [
    letter("a", "x12.x32", 0, |inputs| inputs.x12().dot(inputs.x32())),
    letter("b", "x12.d32 + d12.x32", 1, |inputs| inputs.x12().dot(inputs.d32()) + inputs.d12().dot(inputs.x32())),
    letter("c", "d12.d32", 2, |inputs| inputs.d12().dot(inputs.d32())),
    letter("d", "x21.x21", 0, |inputs| inputs.x21().dot(inputs.x21())),
    letter("e", "d21.x21", 1, |inputs| inputs.d21().dot(inputs.x21())),
    letter("f", "d21.d21", 2, |inputs| inputs.d21().dot(inputs.d21())),
    letter("g", "x32.x32", 0, |inputs| inputs.x32().dot(inputs.x32())),
    letter("h", "d32.x32", 1, |inputs| inputs.d32().dot(inputs.x32())),
    letter("i", "d32.d32", 2, |inputs| inputs.d32().dot(inputs.d32())),
    letter("R^2", "", 0, |inputs| inputs.square),
];

const QUARTIC_FORMULAS: &[Formula] = &[Formula {
    letters: &EDGE_LETTERS,
    terms: &[
        term(4, 1.0, &[2, 2]),
        term(4, -1.0, &[5, 8]),
        term(3, 2.0, &[1, 2]),
        term(3, -2.0, &[4, 8]),
        term(3, -2.0, &[5, 7]),
        term(2, 2.0, &[0, 2]),
        term(2, 1.0, &[1, 1]),
        term(2, -1.0, &[3, 8]),
        term(2, -1.0, &[5, 6]),
        term(2, -4.0, &[4, 7]),
        term(2, 1.0, &[8, 9]),
        term(1, 2.0, &[0, 1]),
        term(1, -2.0, &[3, 7]),
        term(1, -2.0, &[4, 6]),
        term(1, 2.0, &[7, 9]),
        term(0, 1.0, &[0, 0]),
        term(0, -1.0, &[3, 6]),
        term(0, 1.0, &[6, 9]),
    ],
    degree: 4,
}];

const ALPHA_LOW_FORMULAS: &[Formula] = &[Formula {
    letters: &[
        letter("x12.x32", "", 0, |inputs| inputs.x12().dot(inputs.x32())),
        letter("x12.d32", "", 1, |inputs| inputs.x12().dot(inputs.d32())),
        letter("d12.x32", "", 1, |inputs| inputs.d12().dot(inputs.x32())),
        letter("d12.d32", "", 2, |inputs| inputs.d12().dot(inputs.d32())),
    ],
    terms: &[term(2, 1.0, &[3]), term(1, 1.0, &[1]), term(1, 1.0, &[2]), term(0, 1.0, &[0])],
    degree: 2,
}];

const ALPHA_HIGH_FORMULAS: &[Formula] = &[
    Formula {
        letters: &[
            letter("x13.x23", "", 0, |inputs| inputs.x13().dot(inputs.x23())),
            letter("x13.d23", "", 1, |inputs| inputs.x13().dot(inputs.d23())),
            letter("d13.x23", "", 1, |inputs| inputs.d13().dot(inputs.x23())),
            letter("d13.d23", "", 2, |inputs| inputs.d13().dot(inputs.d23())),
        ],
        terms: &[term(2, 1.0, &[3]), term(1, 1.0, &[1]), term(1, 1.0, &[2]), term(0, 1.0, &[0])],
        degree: 2,
    },
    Formula {
        letters: &EDGE_LETTERS,
        terms: &[
            term(2, 1.0, &[8]),
            term(2, -1.0, &[2]),
            term(1, 2.0, &[7]),
            term(1, -1.0, &[1]),
            term(0, 1.0, &[6]),
            term(0, -1.0, &[0]),
        ],
        degree: 2,
    },
];

/// The letters `a..j` of the supplied quintic.
const SUPPLIED_LETTERS: [Letter; 10] = [
    letter("a", "x32.x32", 0, |inputs| inputs.x32().dot(inputs.x32())),
    letter("b", "x32.d32", 1, |inputs| inputs.x32().dot(inputs.d32())),
    letter("c", "d32.d32", 2, |inputs| inputs.d32().dot(inputs.d32())),
    letter("d", "d21.d21", 2, |inputs| inputs.d21().dot(inputs.d21())),
    letter("e", "d21.x21", 1, |inputs| inputs.d21().dot(inputs.x21())),
    letter("f", "x12.x32", 0, |inputs| inputs.x12().dot(inputs.x32())),
    letter("g", "x12.d32 + d12.x32", 1, |inputs| inputs.x12().dot(inputs.d32()) + inputs.d12().dot(inputs.x32())),
    letter("h", "d12.d32", 2, |inputs| inputs.d12().dot(inputs.d32())),
    letter("i", "d32.x21 + d21.x32", 1, |inputs| inputs.d32().dot(inputs.x21()) + inputs.d21().dot(inputs.x32())),
    letter("j", "d32.d21", 2, |inputs| inputs.d32().dot(inputs.d21())),
];

/// Expands to the quintic. The argument is the second term of t³, which has two versions.
macro_rules! quintic {
    ($slip:expr) => {
        Formula {
            letters: &SUPPLIED_LETTERS,
            terms: &[
                term(5, -1.0, &[2, 7, 7]),
                term(5, -1.0, &[2, 2, 3]),
                term(5, -2.0, &[2, 7, 9]),
                term(4, -1.0, &[1, 7, 7]),
                term(4, -2.0, &[2, 6, 7]),
                term(4, -4.0, &[1, 2, 3]),
                term(4, -1.0, &[2, 2, 4]),
                term(4, -1.0, &[2, 7, 8]),
                term(4, -2.0, &[2, 6, 9]),
                term(4, -4.0, &[1, 7, 9]),
                term(3, -2.0, &[1, 6, 7]),
                $slip,
                term(3, -1.0, &[2, 6, 6]),
                term(3, -2.0, &[0, 2, 3]),
                term(3, -4.0, &[1, 1, 3]),
                term(3, -4.0, &[1, 2, 4]),
                term(3, -1.0, &[2, 6, 8]),
                term(3, -2.0, &[1, 7, 8]),
                term(3, -2.0, &[0, 7, 9]),
                term(3, -4.0, &[1, 6, 9]),
                term(3, -2.0, &[2, 5, 9]),
                term(2, -2.0, &[1, 5, 7]),
                term(2, -1.0, &[1, 6, 6]),
                term(2, -2.0, &[2, 5, 6]),
                term(2, -4.0, &[0, 1, 3]),
                term(2, -2.0, &[0, 2, 4]),
                term(2, -4.0, &[1, 1, 4]),
                term(2, -1.0, &[0, 7, 8]),
                term(2, -2.0, &[1, 6, 8]),
                term(2, -1.0, &[2, 5, 8]),
                term(2, -2.0, &[0, 6, 9]),
                term(2, -4.0, &[1, 5, 9]),
                term(1, -2.0, &[1, 5, 6]),
                term(1, -1.0, &[2, 5, 5]),
                term(1, -1.0, &[0, 0, 3]),
                term(1, -4.0, &[0, 1, 4]),
                term(1, -1.0, &[0, 6, 8]),
                term(1, -2.0, &[1, 5, 8]),
                term(1, -2.0, &[0, 5, 9]),
                term(0, -1.0, &[1, 5, 5]),
                term(0, -1.0, &[0, 0, 4]),
                term(0, -1.0, &[0, 5, 8]),
            ],
            degree: 5,
        }
    };
}

/// The quintic as supplied, and with the right letter in t³.
const QUINTIC_FORMULAS: [Formula; 2] = [quintic!(term(3, -2.0, &[2, 5, 6])), quintic!(term(3, -2.0, &[2, 5, 7]))];
