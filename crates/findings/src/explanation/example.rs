//! A small example of a mistake.
use super::{input::Input, subject::Subject};
use crate::finding::Role;
use fosssim_model::sim::{Pair, PairKind};
use serde::{Deserialize, Serialize};

/// A small instance of the mistake.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Example {
    /// Step, from 1.
    pub step: u32,
    /// The place in the step.
    pub place: ExamplePlace,
    /// The inputs, in the assignment's notation.
    pub given: Vec<ExampleValue>,
    /// The expected result.
    #[serde(with = "fosssim_num::written")]
    pub expected: Vec<f64>,
    /// The actual result.
    #[serde(with = "fosssim_num::written")]
    pub actual: Vec<f64>,
}

/// The place of an example in its step, which decides what its numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExamplePlace {
    /// A polynomial whose inputs are given: its coefficients.
    Given {
        /// The pair.
        pair: Pair,
        /// The detection pass within the step, from 0.
        pass: u32,
        /// Which of its polynomials.
        subject: Subject,
    },
    /// A polynomial: its coefficients.
    Polynomial {
        /// The pair.
        pair: Pair,
        /// The detection pass within the step, from 0.
        pass: u32,
        /// Which of its polynomials.
        role: Role,
    },
    /// The polynomial with this number in the step's list, of which the reference has none.
    NumberedPolynomial(usize),
    /// The number of polynomials.
    PolynomialCount,
    /// A contact, as the trace names it: normal and time.
    Contact {
        /// The kind of its pair, if there is such a kind.
        kind: Option<PairKind>,
        /// The particle.
        first: i32,
        /// The other object.
        second: i32,
    },
    /// The number of contacts.
    ContactCount,
    /// A particle in a record: position and velocity.
    Particle {
        /// Which.
        particle: usize,
        /// In which record of the step.
        record: StepRecord,
    },
    /// A particle in the mid record, of which nothing is known.
    MidParticle(usize),
    /// The lists of the mid record.
    MidLists,
}

/// A record of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StepRecord {
    /// The mid record.
    Mid,
    /// The one at the end.
    End,
}

/// An input of an example.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExampleValue {
    /// Which.
    #[serde(rename = "name")]
    pub input: Input,
    /// The value's components.
    #[serde(with = "fosssim_num::written")]
    #[schemars(with = "Vec<fosssim_num::written::Number>")]
    pub value: Vec<f64>,
}
