//! Data types for the exact form of a fault: the formulas and numbers that describe the fault completely. The exact
//! form may reveal a right formula.
use super::{area::Area, fault::ChangedQuantity, reading::Reading, subject::Subject};
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// One line of the exact form of a fault.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Detail {
    /// The exact form of a known mistake, which is given by its id.
    Term(Cow<'static, str>),
    /// Advice to look at the code of one area of the assignment.
    #[serde(rename = "Look")]
    SearchArea(Area),
    /// The meanings of the letters in the preceding lines, for pairs of these kinds. If no letter needs an explanation,
    /// reports leave the line out.
    Letters(Vec<PairKind>),
    /// A line about polynomials.
    Polynomial(PolynomialDetail),
    /// A line about a stage of a step.
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
    /// The polynomials are right up to an error. The value is the error, relative to the size of their terms.
    RightUpTo(#[serde(with = "fosssim_num::number_serde")] f64),
    /// A coefficient differs in some samples.
    Differs {
        /// The polynomial; `None` if the detection has only one.
        subject: Option<Subject>,
        /// The power of t that the coefficient belongs to.
        power: usize,
        /// The number of samples in which the coefficient is wrong.
        count: usize,
        /// The number of samples that were compared.
        of: usize,
    },
    /// The list of coefficients contains only this number.
    Holds(#[serde(with = "fosssim_num::number_serde")] f64),
    /// Every coefficient is the same number.
    Every(#[serde(with = "fosssim_num::number_serde")] f64),
    /// Every coefficient is rounded to single precision.
    SinglePrecision,
    /// One polynomial of the pair is used instead of another.
    InPlaceOf {
        /// The polynomial that the program uses.
        #[serde(rename = "stands")]
        used: Subject,
        /// The polynomial that the program should use.
        #[serde(rename = "belongs")]
        expected: Subject,
    },
    /// The coefficients of two powers of t are exchanged.
    Exchanged {
        /// The powers of t whose coefficients are exchanged.
        powers: [usize; 2],
    },
    /// Only this number of coefficients is logged, and they are the last ones of the list.
    LastOnly(usize),
    /// Only this number of coefficients is logged, and they are the first ones of the list.
    FirstOnly(usize),
    /// Every displacement is multiplied by this factor.
    Displacements(#[serde(with = "fosssim_num::number_serde")] f64),
    /// A wrong radius is used for a particle and a half-plane, or a wrong sum of radii for two bodies.
    Reach {
        /// The kind of pair.
        kind: PairKind,
        /// The radius or sum in the program.
        #[serde(with = "fosssim_num::number_serde")]
        used: f64,
        /// The right radius or sum.
        #[serde(with = "fosssim_num::number_serde")]
        expected: f64,
    },
    /// The inputs or the formula are changed in a way that the assignment's data describe.
    Named {
        /// The key of the change in the assignment's data.
        key: Cow<'static, str>,
        /// Whether all affected pairs consist of a particle and an edge. Their radii have names of their own.
        #[serde(rename = "of_edges")]
        has_only_edge_pairs: bool,
    },
    /// Another quantity is used instead of a letter of the formula.
    StandsFor {
        /// The form of the formula that contains the letter.
        reading: Reading,
        /// The letter that is replaced by another quantity.
        letter: Cow<'static, str>,
        /// The quantity that is used by mistake.
        stand: Substitute,
    },
    /// A coefficient has a wrong factor.
    Factor {
        /// The power of t that the coefficient belongs to.
        power: usize,
        /// The factor by which the right coefficient is multiplied.
        #[serde(with = "fosssim_num::number_serde")]
        factor: f64,
    },
    /// A coefficient is wrong in a way that no simple change explains.
    Unknown {
        /// The power of t that the coefficient belongs to.
        power: usize,
    },
    /// A product of letters has a wrong weight.
    Weight(Weight),
    /// Other weights that would give the same polynomial as the reported ones.
    Alternative(Vec<Weight>),
}

/// The quantity that is used instead of a letter of a formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Substitute {
    /// The letter itself, multiplied by this factor.
    Scaled(#[serde(with = "fosssim_num::number_serde")] f64),
    /// A different letter of the same formula.
    Letter(Cow<'static, str>),
    /// A dot product of two vectors that the detection uses.
    Dot {
        /// The names of the two vectors.
        vectors: [Cow<'static, str>; 2],
        /// Whether the dot product has the opposite sign.
        negated: bool,
    },
    /// The number 1.
    One,
}

/// A product of letters that is a term of a coefficient, with its right and its wrong weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Weight {
    /// The form of the formula. Some of its letters may be absent from this term.
    pub reading: Reading,
    /// The power of t whose coefficient contains the product.
    pub power: usize,
    /// The names of the product's letters.
    pub letters: Vec<Cow<'static, str>>,
    /// The weight that the product should have.
    #[serde(with = "fosssim_num::number_serde")]
    pub expected: f64,
    /// The weight that the product has in the submission.
    #[serde(with = "fosssim_num::number_serde")]
    pub actual: f64,
}

/// The exact form of a fault in a stage of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum StageDetail {
    /// The pairs are checked in a wrong order.
    Order,
    /// All changes are multiplied by the same factor.
    Factor(#[serde(with = "fosssim_num::number_serde")] f64),
    /// The range of the times of impact, as fractions of the step.
    Impacts {
        /// Whether the contacts in the range are right.
        right: bool,
        /// The number of contacts in the range.
        count: usize,
        /// The earliest time of impact.
        #[serde(with = "fosssim_num::number_serde")]
        low: f64,
        /// The latest time of impact.
        #[serde(with = "fosssim_num::number_serde")]
        high: f64,
    },
    /// The lengths of contact vectors along the right vectors, divided by the lengths of the right ones.
    Vectors(Ratios),
    /// The largest error of a contact vector, relative to its length.
    #[serde(rename = "VectorsOff")]
    VectorError(#[serde(with = "fosssim_num::number_serde")] f64),
    /// The times of impact, divided by the right ones.
    Times(Ratios),
    /// The error that all times of impact have in common, as a fraction of the step.
    #[serde(rename = "TimesOff")]
    TimeError(#[serde(with = "fosssim_num::number_serde")] f64),
    /// The advice to use the root finder's time of impact unchanged.
    #[serde(rename = "TimesUsed")]
    TimeUse,
    /// The number of detection passes in the impulse rounds is wrong.
    Passes {
        /// The number of passes that the step should have.
        expected: usize,
        /// The number of passes that the step has.
        actual: usize,
        /// The number of rounds that the scene allows.
        most: i32,
    },
    /// The changes of a quantity by isolated contacts.
    Change {
        /// The quantity that changes, and the body that it belongs to.
        changed: ChangedQuantity,
        /// The difference between the change and the right one.
        amount: Amount,
        /// Whether the quantity also changes at a right angle to the contact vector.
        across: bool,
        /// The number of contacts that change the quantity by a wrong amount.
        wrong: usize,
        /// The number of contacts that were compared.
        of: usize,
    },
    /// The number of zones that have the fault.
    #[serde(rename = "OfZones")]
    ZoneCount {
        /// The number of zones that have the fault.
        count: usize,
        /// The number of zones that were compared.
        of: usize,
    },
    /// The velocities of zones that should stop, divided by their velocities before the round.
    #[serde(rename = "Stopped")]
    StoppedVelocities(Ratios),
    /// The motion of the center of mass, divided by the right motion.
    #[serde(rename = "CenterMoves")]
    CenterMotion(Ratios),
    /// The center of mass moves in a wrong direction.
    CenterDirection,
    /// The rotation of zones, divided by the right rotation.
    #[serde(rename = "Turns")]
    Rotations(Ratios),
    /// The velocities of zones, divided by their displacements over the time step.
    Velocities(Ratios),
}

/// The change of a quantity by a contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Amount {
    /// The quantity changes, although it should stay the same.
    Unwanted,
    /// The change along the contact vector is right.
    Right,
    /// The change along the contact vector, divided by the right change.
    Ratio(Ratios),
}

/// Ratios of actual values to right ones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Ratios {
    /// All ratios are this number, up to round-off.
    All(#[serde(with = "fosssim_num::number_serde")] f64),
    /// The ratios are between these two numbers.
    Between(#[serde(with = "fosssim_num::number_serde")] f64, #[serde(with = "fosssim_num::number_serde")] f64),
}
