//! Guesses about wrong polynomials, without the parts that would give a formula away
//! ([`PolynomialDetail`](super::PolynomialDetail)).
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A guess about wrong polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Guess {
    /// A guess about the whole list of coefficients.
    List(ListGuess),
    /// Other inputs or another formula are used: the change of this key, for which the assignment has words.
    Named(Cow<'static, str>),
    /// A guess about one quantity of the formula.
    Quantity(QuantityGuess),
    /// A guess about the coefficients of some powers of t.
    Coefficients {
        /// The powers of these coefficients, the highest first.
        powers: Vec<usize>,
        /// The guess about them.
        wrong: CoefficientGuess,
    },
}

impl Guess {
    /// Returns the guess's key as claims have it, which may be the name of a formula: a digest.
    #[must_use]
    pub fn word(&self) -> String {
        format!("{:08x}", digest(self.key()) >> 32)
    }

    /// Returns whether it may be made of several polynomials, as one mistake.
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
            Self::Quantity(QuantityGuess::Other) => "letter",
            Self::Quantity(_) => "letter-factor",
            Self::Coefficients { wrong, .. } => wrong.name(),
        }
    }
}

/// Returns a digest of a text, the same on every machine (FNV-1a).
#[must_use]
pub fn digest(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fosssim_num::closed_set! {
    /// A guess about a whole list of coefficients.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ListGuess {
        /// All coefficients are zero, or there are none.
        AllZero = "all-zero", "All coefficients are zero, or none is logged";
        /// The list holds the same single number everywhere.
        Constant = "constant", "A constant is used instead of the polynomial";
        /// All coefficients are the same number everywhere.
        AllEqual = "all-equal", "All coefficients are the same constant";
        /// The coefficients are rounded to single precision.
        SinglePrecision = "single-precision", "The coefficients have single precision only";
        /// The coefficients are divided by the leading coefficient, whatever its sign.
        Monic = "monic", "The polynomial is divided by its leading coefficient, whose sign gets lost";
        /// There are more of them than there should be.
        TooLong = "too-long", "The polynomial has too high a degree";
        /// The lowest power comes first.
        Reversed = "reversed", "The coefficients are in the wrong order, lowest power first";
        /// All coefficients have the wrong sign.
        Negated = "negated", "The whole polynomial has the wrong sign";
        /// The lowest power comes first, and all coefficients have the wrong sign.
        ReversedNegated = "reversed-negated", "The coefficients are in the wrong order and have the wrong sign";
        /// Two coefficients are exchanged.
        TwoExchanged = "two-exchanged", "Two coefficients are exchanged";
        /// A zero follows them.
        TrailingZero = "trailing-zero", "A zero is appended, which raises the degree by one";
        /// The coefficients are those of another polynomial of the pair.
        OtherPolynomial = "other-polynomial", "Polynomials of a pair are exchanged";
        /// The coefficients are those of another polynomial of the pair, with the wrong sign.
        OtherPolynomialNegated = "other-polynomial-negated",
            "A polynomial of the pair is used instead of another one, with the wrong sign";
        /// Only the constant coefficient is there.
        ConstantOnly = "cut",
            "The polynomial is cut to its constant coefficient: it is tested at the start of the step only";
        /// The leading coefficients are missing.
        Cut = "cut", "The polynomial is cut: leading coefficients are missing";
        /// The last coefficients are missing.
        CutEnd = "cut-end", "The polynomial is cut: its last coefficients are missing";
        /// Every displacement in them carries the same factor.
        DisplacementScale = "displacement-scale",
            "All displacements carry the same factor, as velocities or those of another time step do";
    }
    /// Returns the guess in words.
    words
}

fosssim_num::closed_set! {
    /// A guess about one quantity of a formula, in all its places.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum QuantityGuess {
        /// The sign is wrong.
        Sign = "A dot product of the formula has the wrong sign",
        /// The quantity is zero.
        Zero = "A quantity of the formula is zero",
        /// The quantity carries a factor.
        Factor = "A quantity of the formula has a wrong factor",
        /// The coefficient is another number.
        Other = "Another quantity is used instead of a dot product of the formula",
    }
}

fosssim_num::closed_set! {
    /// A guess about coefficients.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum CoefficientGuess {
        /// Several are wrong, each for itself.
        Several = "coefficients", "Several coefficients are wrong ({})";
        /// The coefficient is zero.
        Zero = "coefficient-zero", "The {} coefficient is zero";
        /// The sign is wrong.
        Sign = "coefficient-sign", "The {} coefficient has the wrong sign";
        /// The coefficient carries a factor.
        Factor = "coefficient-factor", "The {} coefficient has a wrong factor";
        /// The coefficient has a term too many.
        TermForeign = "term-foreign", "The {} coefficient has a term too many";
        /// A term is missing.
        TermMissing = "term-missing", "A term of the {} coefficient is missing";
        /// A term's sign.
        TermSign = "term-sign", "A term of the {} coefficient has the wrong sign";
        /// A term's factor.
        TermFactor = "term-factor", "A term of the {} coefficient has a wrong factor";
        /// Several terms are wrong.
        Terms = "terms", "Several terms of the {} coefficient are wrong";
    }
    /// Returns the guess in words, with braces for the names of the powers.
    words
}
