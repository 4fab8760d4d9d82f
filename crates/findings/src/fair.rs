//! The fair rule book's judgement of a trace (numerics.md 2).
use super::book_findings::BookFindings;
use fosssim_model::sim::{Pair, Pass};
use serde::{Deserialize, Serialize};

/// The verdict of the fair rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FairVerdict {
    /// All rules are met.
    Accepted,
    /// A rule is not met.
    Rejected,
    /// Undecided: judging was given up before its end, and nothing was wrong so far.
    #[default]
    None,
}

/// The reason why a trace is rejected as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FairRefusal {
    /// The trace can't be read to its end.
    Stopped,
    /// The trace can be read only as the original reads damaged files.
    Damaged,
    /// Bytes follow the last record.
    TrailingBytes,
    /// Most of its decisions are such that round-off may flip them, and differ from the reference's: it shows nothing.
    Undecided,
}

/// Which of the two accepted forms of the particle-edge approach polynomial a trace uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Both are possible: no finding distinguishes them.
    #[default]
    Either,
    /// The course's formula, with its slip in t^3.
    Course,
    /// The answer that the definition gives.
    Right,
}

/// A decision that round-off may flip, and that the trace has the other way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Borderline {
    /// The step, from 1.
    pub step: u32,
    /// The detection pass.
    pub pass: Pass,
    /// The pair.
    pub pair: Pair,
    /// Whether the trace takes it for a collision.
    pub collides: bool,
}

/// The largest shares of their tolerances that right values used, 0 to 1; 0 where nothing differed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Shares {
    /// Polynomial coefficients.
    #[serde(rename = "coefficients", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub coefficient: f64,
    /// Contact normals.
    #[serde(rename = "normals", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub normal: f64,
    /// Positions.
    #[serde(rename = "positions", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub position: f64,
    /// Velocities.
    #[serde(rename = "velocities", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub velocity: f64,
}

impl Shares {
    /// Takes the larger share of each.
    pub fn widen(&mut self, other: &Self) {
        self.coefficient = self.coefficient.max(other.coefficient);
        self.normal = self.normal.max(other.normal);
        self.position = self.position.max(other.position);
        self.velocity = self.velocity.max(other.velocity);
    }
}

/// The result of the fair rules for a trace.
#[derive(Debug, Clone, Default)]
pub struct Judgement {
    /// The verdict.
    pub verdict: FairVerdict,
    /// The reason why the trace is rejected as a whole, whatever its steps hold.
    pub refusal: Option<FairRefusal>,
    /// The findings by the fair rules.
    pub findings: BookFindings,
    /// The first step that was not judged any more, because that would have taken too much work, or because the scene
    /// itself has no result there.
    pub given_up: Option<u32>,
    /// The number of decisions about pairs in the trace, in all steps and passes.
    pub decisions: u64,
    /// The number of borderline decisions that the trace has the other way.
    pub borderline: u64,
    /// The first of these decisions.
    pub borderline_examples: Vec<Borderline>,
    /// The factor of all polynomials of all kinds as an interval, where it is not 1.
    pub factor: Option<[f64; 2]>,
    /// The form of the approach polynomial.
    pub form: Form,
    /// The number of polynomials that lack other small coefficients than the reference's.
    pub lost: u64,
    /// Used shares of the tolerances.
    pub shares: Shares,
}
