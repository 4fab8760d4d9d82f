//! Guesses about wrong polynomials. They do not contain values that would reveal a formula
//! ([`PolynomialDetail`](super::PolynomialDetail)).
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A guess about what is wrong with polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Guess {
    /// A guess that concerns the whole list of coefficients.
    List(ListGuess),
    /// A change of the inputs or of the formula that the assignment's data describe. The value is its key.
    Named(Cow<'static, str>),
    /// A guess that concerns one quantity in the formula.
    Quantity(QuantityGuess),
    /// A guess that concerns the coefficients of some powers of t.
    Coefficients {
        /// The powers of these coefficients, the highest first.
        powers: Vec<usize>,
        /// The fault of these coefficients.
        wrong: CoefficientGuess,
    },
}

impl Guess {
    /// Returns the key of the guess as [`Explanation::claims`](super::Explanation::claims) contain it. It is a digest,
    /// because the key itself may name a formula.
    pub fn claim_key(&self) -> String {
        format!("{:08x}", hash_key(self.key()) >> 32)
    }

    /// Returns whether the guess can be the same mistake in several polynomials.
    pub const fn is_general(&self) -> bool {
        matches!(self, Self::List(_) | Self::Named(_) | Self::Quantity(QuantityGuess::Radius))
    }

    /// Returns the key of an explanation with this guess.
    pub fn key(&self) -> &str {
        match self {
            Self::List(guess) => guess.name(),
            Self::Named(key) => key,
            Self::Quantity(guess) => guess.name(),
            Self::Coefficients { wrong, .. } => wrong.name(),
        }
    }
}

/// Returns the FNV-1a digest of a string, which is the same on every machine.
pub fn hash_key(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fosssim_num::closed_set! {
    /// A guess that concerns a whole list of coefficients.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ListGuess {
        /// All coefficients are zero, or there are no coefficients.
        AllZero = "all-zero", "All coefficients are zero, or none is logged";
        /// The list consists of one number. It is the same number in every sample.
        Constant = "constant", "A constant is used instead of the polynomial";
        /// All coefficients are the same number. It is the same number in every sample.
        AllEqual = "all-equal", "All coefficients are the same constant";
        /// The coefficients are rounded to single precision.
        SinglePrecision = "single-precision", "The coefficients have only single precision";
        /// All coefficients are divided by the leading one, even if it is negative.
        Monic = "monic", "The polynomial is divided by its leading coefficient, which loses its sign";
        /// There are too many coefficients.
        TooLong = "too-long", "The degree of the polynomial is too high";
        /// The coefficients are in the opposite order, with the lowest power first.
        Reversed = "reversed", "The coefficients are in the wrong order, lowest power first";
        /// All coefficients have the wrong sign.
        Negated = "negated", "The whole polynomial has the wrong sign";
        /// The coefficients are in the opposite order, and all have the wrong sign.
        ReversedNegated = "reversed-negated", "The coefficients are in the wrong order and have the wrong sign";
        /// Two coefficients are exchanged.
        TwoExchanged = "two-exchanged", "Two coefficients are exchanged";
        /// An additional zero follows the coefficients.
        TrailingZero = "trailing-zero", "A zero is appended, which raises the degree by one";
        /// The coefficients belong to another polynomial of the pair.
        OtherPolynomial = "other-polynomial", "Polynomials of a pair are exchanged";
        /// The coefficients belong to another polynomial of the pair, and have the wrong sign.
        OtherPolynomialNegated = "other-polynomial-negated",
            "A polynomial of the pair is used instead of another one, with the wrong sign";
        /// Only the constant coefficient is there.
        ConstantOnly = "cut",
            "The polynomial has only its constant coefficient, so it is tested only at the start of the step";
        /// The leading coefficients are missing.
        Cut = "cut", "Leading coefficients of the polynomial are missing";
        /// The last coefficients are missing.
        CutEnd = "cut-end", "The last coefficients of the polynomial are missing";
        /// Every displacement is multiplied by the same factor.
        DisplacementScale = "displacement-scale",
            "All displacements have the same factor, as if they were velocities or had another time step";
    }
    /// Returns the sentence for the guess.
    words
}

fosssim_num::closed_set! {
    /// A guess that concerns one quantity, wherever it occurs in a formula.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum QuantityGuess {
        /// The sign of the quantity is wrong.
        Sign = "letter-factor", "A dot product of the formula has the wrong sign";
        /// The quantity is zero.
        Zero = "letter-factor", "A quantity of the formula is zero";
        /// The quantity is multiplied by a factor.
        Factor = "letter-factor", "A quantity of the formula has a wrong factor";
        /// The radii are wrong.
        Radius = "other-radius", "The radii in the formula have wrong values";
        /// Another quantity is used instead of this one.
        Other = "letter", "Another quantity is used instead of a dot product of the formula";
    }
    /// Returns the sentence for the guess.
    words
}

fosssim_num::closed_set! {
    /// A guess that concerns one or several coefficients.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum CoefficientGuess {
        /// Several coefficients are wrong, and no common cause is known.
        Several = "coefficients", "Several coefficients are wrong ({})";
        /// The coefficient is zero.
        Zero = "coefficient-zero", "The {} coefficient is zero";
        /// The sign of the coefficient is wrong.
        Sign = "coefficient-sign", "The {} coefficient has the wrong sign";
        /// The coefficient is multiplied by a factor.
        Factor = "coefficient-factor", "The {} coefficient has a wrong factor";
        /// The coefficient has an extra term.
        TermForeign = "term-foreign", "The {} coefficient has an extra term";
        /// A term of the coefficient is missing.
        TermMissing = "term-missing", "A term of the {} coefficient is missing";
        /// The sign of a term is wrong.
        TermSign = "term-sign", "A term of the {} coefficient has the wrong sign";
        /// The factor of a term is wrong.
        TermFactor = "term-factor", "A term of the {} coefficient has a wrong factor";
        /// Several terms of the coefficient are wrong.
        Terms = "terms", "Several terms of the {} coefficient are wrong";
    }
    /// Returns the sentence for the guess. Braces stand for the names of the powers.
    words
}
