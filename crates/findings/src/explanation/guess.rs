//! Guesses about wrong polynomials, without the values that would reveal a formula
//! ([`PolynomialDetail`](super::PolynomialDetail)).
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A guess about wrong polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Guess {
    /// A guess about the whole list of coefficients.
    List(ListGuess),
    /// Other inputs or another formula are used; the value is the key of a change that the assignment describes.
    Named(Cow<'static, str>),
    /// A guess about one quantity of the formula.
    Quantity(QuantityGuess),
    /// A guess about the coefficients of some powers of t.
    Coefficients {
        /// The powers of these coefficients, the highest first.
        powers: Vec<usize>,
        /// The guess about the coefficients.
        wrong: CoefficientGuess,
    },
}

impl Guess {
    /// Returns the key of the guess as claims contain it: a digest, because the key may name a formula.
    #[must_use]
    pub fn word(&self) -> String {
        format!("{:08x}", digest(self.key()) >> 32)
    }

    /// Returns whether the guess can apply to several polynomials as one mistake.
    #[must_use]
    pub const fn is_general(&self) -> bool {
        matches!(self, Self::List(_) | Self::Named(_))
    }

    /// Returns the explanation's key.
    #[must_use]
    pub fn key(&self) -> &str {
        match self {
            Self::List(guess) => guess.name(),
            Self::Named(key) => key,
            Self::Quantity(guess) => guess.name(),
            Self::Coefficients { wrong, .. } => wrong.name(),
        }
    }
}

/// Returns a digest of a text (FNV-1a), which is the same on every machine.
#[must_use]
pub fn digest(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fosssim_num::closed_set! {
    /// A guess about a whole list of coefficients.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ListGuess {
        /// All coefficients are zero or missing.
        AllZero = "all-zero", "All coefficients are zero, or none is logged";
        /// The list consists of one number, the same in every sample.
        Constant = "constant", "A constant is used instead of the polynomial";
        /// All coefficients are the same number in every sample.
        AllEqual = "all-equal", "All coefficients are the same constant";
        /// The coefficients are rounded to single precision.
        SinglePrecision = "single-precision", "The coefficients have only single precision";
        /// The coefficients are divided by the leading coefficient, even if it is negative.
        Monic = "monic", "The polynomial is divided by its leading coefficient, which loses its sign";
        /// There are too many coefficients.
        TooLong = "too-long", "The polynomial has too high a degree";
        /// The lowest power comes first.
        Reversed = "reversed", "The coefficients are in the wrong order, lowest power first";
        /// All coefficients have the wrong sign.
        Negated = "negated", "The whole polynomial has the wrong sign";
        /// The lowest power comes first, and all coefficients have the wrong sign.
        ReversedNegated = "reversed-negated", "The coefficients are in the wrong order and have the wrong sign";
        /// Two coefficients are exchanged.
        TwoExchanged = "two-exchanged", "Two coefficients are exchanged";
        /// A zero follows the coefficients.
        TrailingZero = "trailing-zero", "A zero is appended, which raises the degree by one";
        /// The coefficients are those of another polynomial of the pair.
        OtherPolynomial = "other-polynomial", "Polynomials of a pair are exchanged";
        /// The coefficients are those of another polynomial of the pair, with the wrong sign.
        OtherPolynomialNegated = "other-polynomial-negated",
            "A polynomial of the pair is used instead of another one, with the wrong sign";
        /// All coefficients except the constant one are missing.
        ConstantOnly = "cut",
            "The polynomial is cut to its constant coefficient, so it is tested only at the start of the step";
        /// The leading coefficients are missing.
        Cut = "cut", "The polynomial is cut: leading coefficients are missing";
        /// The last coefficients are missing.
        CutEnd = "cut-end", "The polynomial is cut: its last coefficients are missing";
        /// Every displacement is multiplied by the same factor.
        DisplacementScale = "displacement-scale",
            "All displacements have the same factor, as if they were velocities or had another time step";
    }
    /// Returns the text of the guess.
    words
}

fosssim_num::closed_set! {
    /// A guess about one quantity of a formula, in all its occurrences.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum QuantityGuess {
        /// The sign of the quantity is wrong.
        Sign = "letter-factor", "A dot product of the formula has the wrong sign";
        /// The quantity is zero.
        Zero = "letter-factor", "A quantity of the formula is zero";
        /// The quantity is multiplied by a factor.
        Factor = "letter-factor", "A quantity of the formula has a wrong factor";
        /// A quantity that is not in the formula is used.
        Other = "letter", "Another quantity is used instead of a dot product of the formula";
    }
    /// Returns the text of the guess.
    words
}

fosssim_num::closed_set! {
    /// A guess about coefficients.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum CoefficientGuess {
        /// Several coefficients are wrong, without a common cause.
        Several = "coefficients", "Several coefficients are wrong ({})";
        /// The coefficient is zero.
        Zero = "coefficient-zero", "The {} coefficient is zero";
        /// The sign of the coefficient is wrong.
        Sign = "coefficient-sign", "The {} coefficient has the wrong sign";
        /// The coefficient is multiplied by a factor.
        Factor = "coefficient-factor", "The {} coefficient has a wrong factor";
        /// The coefficient has a surplus term.
        TermForeign = "term-foreign", "The {} coefficient has a term too many";
        /// The coefficient lacks a term.
        TermMissing = "term-missing", "A term of the {} coefficient is missing";
        /// The sign of a term is wrong.
        TermSign = "term-sign", "A term of the {} coefficient has the wrong sign";
        /// The factor of a term is wrong.
        TermFactor = "term-factor", "A term of the {} coefficient has a wrong factor";
        /// Several terms are wrong.
        Terms = "terms", "Several terms of the {} coefficient are wrong";
    }
    /// Returns the text of the guess, with braces for the names of the powers.
    words
}
