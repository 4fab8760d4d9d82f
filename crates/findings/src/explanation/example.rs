//! A small example of a mistake.
use super::{input::Input, subject::Subject};
use crate::finding::Role;
use fosssim_model::sim::{Pair, PairKind};
use serde::{Deserialize, Serialize};

/// A small instance of a mistake.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Example {
    /// The step number, from 1.
    pub step: u32,
    /// The place in the step.
    pub place: ExamplePlace,
    /// The inputs of the computation, in the assignment's notation.
    pub given: Vec<ExampleValue>,
    /// The expected result.
    #[serde(with = "fosssim_num::written")]
    pub expected: Vec<f64>,
    /// The actual result.
    #[serde(with = "fosssim_num::written")]
    pub actual: Vec<f64>,
}

/// The place of an example in its step. It determines the meaning of the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExamplePlace {
    /// The numbers are the coefficients of a polynomial whose inputs are given.
    Given {
        /// The pair that the polynomial belongs to.
        pair: Pair,
        /// The detection pass within the step, from 0.
        pass: u32,
        /// The polynomial of the pair.
        subject: Subject,
    },
    /// The numbers are the coefficients of a polynomial.
    Polynomial {
        /// The pair that the polynomial belongs to.
        pair: Pair,
        /// The detection pass within the step, from 0.
        pass: u32,
        /// The role of the polynomial.
        role: Role,
    },
    /// A surplus polynomial of the step's list, given by its index.
    NumberedPolynomial(usize),
    /// The number is that of the polynomials in the step.
    PolynomialCount,
    /// The numbers are the normal and the time of a contact of the trace.
    Contact {
        /// The kind of the pair, if the objects form one.
        kind: Option<PairKind>,
        /// The particle's number in the trace.
        first: i32,
        /// The other object's number in the trace.
        second: i32,
    },
    /// The number is that of the contacts in the step.
    ContactCount,
    /// The numbers are the position and the velocity of a particle in a record.
    Particle {
        /// The particle's index.
        particle: usize,
        /// The record of the step.
        record: StepRecord,
    },
    /// A particle of the mid record, given by its index; only the mid record of the trace is known.
    MidParticle(usize),
    /// The polynomial and impulse lists of the mid record.
    MidLists,
}

/// A record of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StepRecord {
    /// The mid record.
    Mid,
    /// The record at the end of the step.
    End,
}

/// An input of an example.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExampleValue {
    /// The input that has the value.
    #[serde(rename = "name")]
    pub input: Input,
    /// The components of the value.
    #[serde(with = "fosssim_num::written")]
    #[schemars(with = "Vec<fosssim_num::written::Number>")]
    pub value: Vec<f64>,
}
