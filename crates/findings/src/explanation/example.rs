//! Small examples of mistakes.
use super::{input::Input, subject::Subject};
use crate::finding::Role;
use fosssim_model::sim::{Pair, PairKind};
use serde::{Deserialize, Serialize};

/// A small example of a mistake: the inputs, the expected result, and the actual one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Example {
    /// The step number, from 1.
    pub step: u32,
    /// The object or the record of the step that the example is about.
    pub place: ExamplePlace,
    /// The values from which the example is computed, in the assignment's notation.
    pub given: Vec<ExampleValue>,
    /// The result that a correct program computes.
    #[serde(with = "fosssim_num::number_serde")]
    pub expected: Vec<f64>,
    /// The result that this program computes.
    #[serde(with = "fosssim_num::number_serde")]
    pub actual: Vec<f64>,
}

/// The object or the record of a step that an example is about. It determines what the numbers mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExamplePlace {
    /// The numbers are the coefficients of a polynomial whose inputs are given.
    Given {
        /// The pair to which the polynomial belongs.
        pair: Pair,
        /// The detection pass within the step, from 0.
        pass: u32,
        /// The polynomial, by its meaning.
        subject: Subject,
    },
    /// The numbers are the coefficients of a polynomial.
    Polynomial {
        /// The pair to which the polynomial belongs.
        pair: Pair,
        /// The detection pass within the step, from 0.
        pass: u32,
        /// The condition that the polynomial describes.
        role: Role,
    },
    /// The numbers are the coefficients of a surplus polynomial. The value is its index in the step's list.
    NumberedPolynomial(usize),
    /// The single number is the count of polynomials that the step logs.
    PolynomialCount,
    /// The numbers are the normal and the time of a contact in the trace.
    Contact {
        /// The kind of pair; `None` if the two objects do not form a pair.
        kind: Option<PairKind>,
        /// The number of the particle, as the trace names it.
        first: i32,
        /// The number of the other object, as the trace names it.
        second: i32,
    },
    /// The single number is the count of contacts that the step logs.
    ContactCount,
    /// The numbers are the position and the velocity of a particle in a record.
    Particle {
        /// The index of the particle.
        particle: usize,
        /// The record of the step that contains the particle.
        record: StepRecord,
    },
    /// The mid record of the reference or of the trace is missing. There are no numbers. The value is the index of a
    /// particle in the record.
    MidParticle(usize),
    /// The lists of the mid record differ. There are no numbers.
    MidLists,
}

/// One of the two records of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StepRecord {
    /// The mid record.
    Mid,
    /// The record at the end of the step.
    End,
}

/// An input of an example, and its value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExampleValue {
    /// The input to which the value belongs.
    #[serde(rename = "name")]
    pub input: Input,
    /// The components of the value: one for a number, two for a vector.
    #[serde(with = "fosssim_num::number_serde")]
    #[schemars(with = "Vec<fosssim_num::number_serde::WrittenNumber>")]
    pub value: Vec<f64>,
}
