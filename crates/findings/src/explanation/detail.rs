//! The exact form of a fault, as values. It may give a right formula away.
use super::{area::Area, fault::ChangedQuantity, reading::Reading, subject::Subject};
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// One line of the exact form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Detail {
    /// The exact form of the catalogue's mistake with this key.
    Term(Cow<'static, str>),
    /// The place to check for mistakes of this part of the assignment.
    Look(Area),
    /// The meanings of the letters in the lines before, which speak of pairs of these kinds. There is none if no letter
    /// needs it.
    Letters(Vec<PairKind>),
    /// A fault of polynomials.
    Polynomial(PolynomialDetail),
    /// A fault of a stage.
    Stage(StageDetail),
}

/// The exact form of a fault of polynomials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum PolynomialDetail {
    /// Each detection logs another number of polynomials than it should.
    Logged {
        /// The number that it logs.
        logged: usize,
        /// The expected number.
        of: usize,
    },
    /// The polynomials are right up to this error, relative to the size of their terms.
    RightUpTo(#[serde(with = "fosssim_num::written")] f64),
    /// A coefficient differs in some samples.
    Differs {
        /// The polynomial, where there are several.
        subject: Option<Subject>,
        /// The coefficient's power of t.
        power: usize,
        /// The number of samples.
        count: usize,
        /// The number of all.
        of: usize,
    },
    /// The list holds this number alone.
    Holds(#[serde(with = "fosssim_num::written")] f64),
    /// Every coefficient is this number.
    Every(#[serde(with = "fosssim_num::written")] f64),
    /// Every coefficient is a number of single precision.
    SinglePrecision,
    /// One polynomial is used instead of another.
    InPlaceOf {
        /// The polynomial that is used.
        stands: Subject,
        /// The polynomial that must be used.
        belongs: Subject,
    },
    /// The coefficients of two powers of t are exchanged.
    Exchanged {
        /// The powers.
        powers: [usize; 2],
    },
    /// Only the last coefficients are there, this number of them.
    LastOnly(usize),
    /// Only the first coefficients are there, this number of them.
    FirstOnly(usize),
    /// Every displacement carries this factor.
    Displacements(#[serde(with = "fosssim_num::written")] f64),
    /// The exact form of the change with this key.
    Named {
        /// The key.
        key: Cow<'static, str>,
        /// Whether all these pairs are a particle's and an edge's, whose radii have names of their own.
        of_edges: bool,
    },
    /// Another quantity is used for a letter of a formula.
    StandsFor {
        /// The formula.
        reading: Reading,
        /// The letter.
        letter: Cow<'static, str>,
        /// The thing in its place.
        stand: Substitute,
    },
    /// A coefficient carries a factor.
    Factor {
        /// The coefficient's power of t.
        power: usize,
        /// The factor.
        #[serde(with = "fosssim_num::written")]
        factor: f64,
    },
    /// No simple change explains a coefficient.
    Unknown {
        /// The coefficient's power of t.
        power: usize,
    },
    /// A product has the wrong weight.
    Weight(Weight),
    /// These weights together would have the same effect.
    Alternative(Vec<Weight>),
}

/// The value in place of a letter of a formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Substitute {
    /// The letter itself with this factor.
    Scaled(#[serde(with = "fosssim_num::written")] f64),
    /// Another letter of the formula.
    Letter(Cow<'static, str>),
    /// A dot product of vectors that a detection has at hand.
    Dot {
        /// The vectors' names.
        vectors: [Cow<'static, str>; 2],
        /// Whether its sign is wrong.
        negated: bool,
    },
    /// The number 1.
    One,
}

/// A product of letters in a coefficient, with a wrong weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Weight {
    /// The formula whose letters it takes, besides some that do not belong there.
    pub reading: Reading,
    /// The coefficient's power of t.
    pub power: usize,
    /// The names of its letters.
    pub letters: Vec<Cow<'static, str>>,
    /// The weight that it should have.
    #[serde(with = "fosssim_num::written")]
    pub expected: f64,
    /// The weight that it has.
    #[serde(with = "fosssim_num::written")]
    pub actual: f64,
}

/// The exact form of a fault of a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum StageDetail {
    /// The order of the pairs.
    Order,
    /// The factor of all changes.
    Factor(#[serde(with = "fosssim_num::written")] f64),
    /// Between which fractions of the step contacts have their times of impact.
    Impacts {
        /// Whether these are the contacts that are right.
        right: bool,
        /// The number of contacts.
        count: usize,
        /// The first time.
        #[serde(with = "fosssim_num::written")]
        low: f64,
        /// The number of the last.
        #[serde(with = "fosssim_num::written")]
        high: f64,
    },
    /// The ratios of contact vectors to the right ones, along these.
    Vectors(Ratios),
    /// By how much of their length contact vectors are off at most.
    VectorsOff(#[serde(with = "fosssim_num::written")] f64),
    /// The ratios of times of impact to the expected ones.
    Times(Ratios),
    /// By how much times of impact are off, in steps.
    TimesOff(#[serde(with = "fosssim_num::written")] f64),
    /// The use of times of impact.
    TimesUsed,
    /// Detection passes of impulse rounds.
    Passes {
        /// The number that is expected.
        expected: usize,
        /// The number of them.
        actual: usize,
        /// The number of rounds that the scene allows.
        most: i32,
    },
    /// The changes by isolated contacts.
    Change {
        /// The quantity, and its owner.
        changed: ChangedQuantity,
        /// By how much.
        amount: Amount,
        /// Whether across the contact vector, too.
        across: bool,
        /// The number of them in which it is wrong.
        wrong: usize,
        /// The number of all.
        of: usize,
    },
    /// The number of zones to which it applies.
    OfZones {
        /// The number.
        count: usize,
        /// The number of zones that could be compared.
        of: usize,
    },
    /// Velocities of zones that must stop, divided by those before.
    Stopped(Ratios),
    /// The ratio of the motion of the center of mass to the expected one.
    CenterMoves(Ratios),
    /// The direction of the center's motion.
    CenterDirection,
    /// The ratio of the rotation of zones to the expected one.
    Turns(Ratios),
    /// Velocities of zones over their motion per step size.
    Velocities(Ratios),
}

/// By how much a contact changes something.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Amount {
    /// The quantity should not change.
    Unwanted,
    /// As it should along the contact vector.
    Right,
    /// The ratio to the expected value along the contact vector.
    Ratio(Ratios),
}

/// Ratios of actual to expected values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Ratios {
    /// All ratios are this number.
    All(#[serde(with = "fosssim_num::written")] f64),
    /// The ratios are between the first number and the second.
    Between(#[serde(with = "fosssim_num::written")] f64, #[serde(with = "fosssim_num::written")] f64),
}
