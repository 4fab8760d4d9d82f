//! What explanations of polynomials are made of: the inputs of one detection and what the submission logged for it.
use fosssim_model::sim::{Pair, PairMotion};

/// One detection of a submission: what went in, and the polynomials that it handed to the root finder.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The step, from 1.
    pub step: u32,
    /// The detection pass within the step, from 0.
    pub pass: u32,
    /// Who was looked at. Its kind is that of `motion`.
    pub pair: Pair,
    /// The inputs, from the submission's own states.
    pub motion: PairMotion,
    /// What was logged, one list per polynomial of the kind in the trace's order
    /// (2 or 4); each highest power first and without the small
    /// leading coefficients that the course's library drops. Fewer lists: the last polynomials are missing.
    pub polynomials: Vec<Vec<f64>>,
}
