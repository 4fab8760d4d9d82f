//! The exact form of a fault, as values. It may reveal a right formula.
use super::{area::Area, fault::ChangedQuantity, reading::Reading, subject::Subject};
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// One line of the exact form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Detail {
    /// The exact form of a known mistake, given by its id.
    Term(Cow<'static, str>),
    /// A hint to check the code of one area of the assignment.
    Look(Area),
    /// The meanings of the letters in the preceding lines, for pairs of these kinds. Reports omit the line if there are
    /// no letters to explain.
    Letters(Vec<PairKind>),
    /// A fault of polynomials.
    Polynomial(PolynomialDetail),
    /// A fault of a stage.
    Stage(StageDetail),
}

/// The exact form of a fault in polynomials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum PolynomialDetail {
    /// Each detection logs a wrong number of polynomials.
    Logged {
        /// The number of polynomials that the detection logs.
        logged: usize,
        /// The number of polynomials that a detection should log.
        of: usize,
    },
    /// The polynomials are right except for an error, given relative to the size of their terms.
    RightUpTo(#[serde(with = "fosssim_num::written")] f64),
    /// A coefficient differs in some samples.
    Differs {
        /// The polynomial, if the detection has several.
        subject: Option<Subject>,
        /// The power of t that the coefficient belongs to.
        power: usize,
        /// The number of samples in which the coefficient differs.
        count: usize,
        /// The number of compared samples.
        of: usize,
    },
    /// The list contains only this number.
    Holds(#[serde(with = "fosssim_num::written")] f64),
    /// Every coefficient is the same number.
    Every(#[serde(with = "fosssim_num::written")] f64),
    /// Every coefficient is a number of single precision.
    SinglePrecision,
    /// One polynomial is used instead of another.
    InPlaceOf {
        /// The polynomial that is used, although it is wrong.
        stands: Subject,
        /// The polynomial that should be used.
        belongs: Subject,
    },
    /// The coefficients of two powers of t are exchanged.
    Exchanged {
        /// The two powers of t.
        powers: [usize; 2],
    },
    /// Only the last coefficients are logged; the value is their number.
    LastOnly(usize),
    /// Only the first coefficients are logged; the value is their number.
    FirstOnly(usize),
    /// Every displacement is multiplied by a factor.
    Displacements(#[serde(with = "fosssim_num::written")] f64),
    /// A named change of the formula.
    Named {
        /// The key of the change.
        key: Cow<'static, str>,
        /// Whether all pairs are particle-edge pairs, whose radii have their own names.
        of_edges: bool,
    },
    /// A different quantity is used for a letter of a formula.
    StandsFor {
        /// The formula, in one of its forms.
        reading: Reading,
        /// The letter whose value is replaced.
        letter: Cow<'static, str>,
        /// The quantity that is used instead.
        stand: Substitute,
    },
    /// A coefficient is multiplied by a factor.
    Factor {
        /// The power of t that the coefficient belongs to.
        power: usize,
        /// The factor of the coefficient.
        #[serde(with = "fosssim_num::written")]
        factor: f64,
    },
    /// No simple change explains a coefficient.
    Unknown {
        /// The power of t that the coefficient belongs to.
        power: usize,
    },
    /// A product has the wrong weight.
    Weight(Weight),
    /// Weights that would give the same polynomial as the reported ones.
    Alternative(Vec<Weight>),
}

/// The value that is used instead of a letter of a formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Substitute {
    /// The letter itself, multiplied by a factor.
    Scaled(#[serde(with = "fosssim_num::written")] f64),
    /// A different letter of the same formula.
    Letter(Cow<'static, str>),
    /// A dot product of vectors that the detection uses.
    Dot {
        /// The names of the two vectors.
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
    /// The formula, in a form that may lack some of the letters.
    pub reading: Reading,
    /// The power of t that the coefficient belongs to.
    pub power: usize,
    /// The names of the product's letters.
    pub letters: Vec<Cow<'static, str>>,
    /// The right weight of the product.
    #[serde(with = "fosssim_num::written")]
    pub expected: f64,
    /// The weight in the submission.
    #[serde(with = "fosssim_num::written")]
    pub actual: f64,
}

/// The exact form of a fault of a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum StageDetail {
    /// The pairs are checked in the wrong order.
    Order,
    /// All changes are multiplied by a factor.
    Factor(#[serde(with = "fosssim_num::written")] f64),
    /// The range of the times of impact, as fractions of the step.
    Impacts {
        /// Whether the range is that of the right contacts.
        right: bool,
        /// The number of contacts.
        count: usize,
        /// The earliest time of impact.
        #[serde(with = "fosssim_num::written")]
        low: f64,
        /// The latest time of impact.
        #[serde(with = "fosssim_num::written")]
        high: f64,
    },
    /// The ratios of contact vectors to the right ones, measured along the right ones.
    Vectors(Ratios),
    /// The largest error of the contact vectors, relative to their length.
    VectorsOff(#[serde(with = "fosssim_num::written")] f64),
    /// The ratios of times of impact to the expected ones.
    Times(Ratios),
    /// The largest error of the times of impact, in steps.
    TimesOff(#[serde(with = "fosssim_num::written")] f64),
    /// The times of impact are not used correctly.
    TimesUsed,
    /// The number of detection passes in the impulse rounds.
    Passes {
        /// The expected number of passes.
        expected: usize,
        /// The actual number of passes.
        actual: usize,
        /// The number of rounds that the scene allows.
        most: i32,
    },
    /// The changes that isolated contacts cause.
    Change {
        /// The quantity that changes, and its owner.
        changed: ChangedQuantity,
        /// The amount of the change.
        amount: Amount,
        /// Whether the quantity also changes perpendicular to the contact vector.
        across: bool,
        /// The number of contacts that change the quantity wrongly.
        wrong: usize,
        /// The number of compared contacts.
        of: usize,
    },
    /// The number of zones that have the fault.
    OfZones {
        /// The number of zones with the fault.
        count: usize,
        /// The number of zones that could be compared.
        of: usize,
    },
    /// The velocities of zones that must stop, divided by their earlier velocities.
    Stopped(Ratios),
    /// The ratio of the motion of the center of mass to the expected one.
    CenterMoves(Ratios),
    /// The center of mass moves in a wrong direction.
    CenterDirection,
    /// The ratio of the rotation of zones to the expected rotation.
    Turns(Ratios),
    /// The velocities of zones, divided by their displacement over the step size.
    Velocities(Ratios),
}

/// The amount by which a contact changes a quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Amount {
    /// The quantity changes although it should not.
    Unwanted,
    /// The change along the contact vector is right.
    Right,
    /// The ratio to the expected value, along the contact vector.
    Ratio(Ratios),
}

/// Ratios of actual to expected values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Ratios {
    /// All ratios equal one number.
    All(#[serde(with = "fosssim_num::written")] f64),
    /// The ratios are between the first number and the second.
    Between(#[serde(with = "fosssim_num::written")] f64, #[serde(with = "fosssim_num::written")] f64),
}
