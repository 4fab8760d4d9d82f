//! Guesses about wrong polynomials, without what would give a formula away
//! ([`PolynomialDetail`](super::PolynomialDetail)).
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A guess about wrong polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Guess {
    /// Something about the whole list of coefficients.
    List(ListGuess),
    /// Another input stands where one belongs: the exchange of this key, which the assignment has words for.
    Exchange(Cow<'static, str>),
    /// A misunderstanding with a formula of its own: the one of this key, which the assignment has words for.
    Special(Cow<'static, str>),
    /// Something about one quantity of the formula.
    Quantity(QuantityGuess),
    /// Something about the coefficients of some powers of t.
    Coefficients {
        /// Those powers, the highest first.
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
        matches!(self, Self::List(_) | Self::Exchange(_) | Self::Special(_))
    }

    /// Returns the explanation's key.
    #[must_use]
    pub fn key(&self) -> &str {
        match self {
            Self::List(guess) => guess.key(),
            Self::Exchange(key) | Self::Special(key) => key,
            Self::Quantity(QuantityGuess::Other) => "letter",
            Self::Quantity(_) => "letter-factor",
            Self::Coefficients { wrong, .. } => wrong.key(),
        }
    }
}

/// Returns a digest of a text, the same on every machine (FNV-1a).
#[must_use]
pub fn digest(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A guess about a whole list of coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ListGuess {
    /// All are zero, or none is there.
    AllZero,
    /// The list holds the same single number everywhere.
    Constant,
    /// All are the same number everywhere.
    AllEqual,
    /// The coefficients are rounded to single precision.
    SinglePrecision,
    /// The coefficients are divided by the leading one, whatever its sign.
    Monic,
    /// There are more of them than there should be.
    TooLong,
    /// The lowest power comes first.
    Reversed,
    /// All have the wrong sign.
    Negated,
    /// The lowest power comes first, and all have the wrong sign.
    ReversedNegated,
    /// Two of them stand in each other's places.
    TwoExchanged,
    /// A zero follows them.
    TrailingZero,
    /// The coefficients are those of another polynomial of the pair.
    OtherPolynomial,
    /// The coefficients are those of another polynomial of the pair, with the wrong sign.
    OtherPolynomialNegated,
    /// Only the constant one is there.
    ConstantOnly,
    /// Leading ones are missing.
    Cut,
    /// The last ones are missing.
    CutEnd,
    /// Every displacement in them carries the same factor.
    DisplacementScale,
}

impl ListGuess {
    const fn key(self) -> &'static str {
        match self {
            Self::AllZero => "all-zero",
            Self::Constant => "constant",
            Self::AllEqual => "all-equal",
            Self::SinglePrecision => "single-precision",
            Self::Monic => "monic",
            Self::TooLong => "too-long",
            Self::Reversed => "reversed",
            Self::Negated => "negated",
            Self::ReversedNegated => "reversed-negated",
            Self::TwoExchanged => "two-exchanged",
            Self::TrailingZero => "trailing-zero",
            Self::OtherPolynomial => "other-polynomial",
            Self::OtherPolynomialNegated => "other-polynomial-negated",
            Self::ConstantOnly | Self::Cut => "cut",
            Self::CutEnd => "cut-end",
            Self::DisplacementScale => "displacement-scale",
        }
    }
}

/// A guess about one quantity of a formula, in all its places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum QuantityGuess {
    /// The sign is wrong.
    Sign,
    /// The quantity is zero.
    Zero,
    /// The quantity carries a factor.
    Factor,
    /// Another one stands there.
    Other,
}

/// A guess about coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CoefficientGuess {
    /// Several are wrong, each for itself.
    Several,
    /// The coefficient is zero.
    Zero,
    /// The sign is wrong.
    Sign,
    /// The coefficient carries a factor.
    Factor,
    /// The coefficient has a term too many.
    TermForeign,
    /// A term is missing.
    TermMissing,
    /// A term's sign.
    TermSign,
    /// A term's factor.
    TermFactor,
    /// Several terms are wrong.
    Terms,
}

impl CoefficientGuess {
    const fn key(self) -> &'static str {
        match self {
            Self::Several => "coefficients",
            Self::Zero => "coefficient-zero",
            Self::Sign => "coefficient-sign",
            Self::Factor => "coefficient-factor",
            Self::TermForeign => "term-foreign",
            Self::TermMissing => "term-missing",
            Self::TermSign => "term-sign",
            Self::TermFactor => "term-factor",
            Self::Terms => "terms",
        }
    }
}
