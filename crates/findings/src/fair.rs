//! The fair rule book's judgement of a trace (numerics.md 2).
use super::book_findings::BookFindings;
use fosssim_model::sim::{Pair, Pass};
use serde::{Deserialize, Serialize};

/// The verdict of the fair rules on a trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FairVerdict {
    /// The trace meets all rules.
    Accepted,
    /// The trace breaks a rule.
    Rejected,
    /// Judging stopped early, and had found no fault.
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
    /// Most decisions of the trace are borderline and differ from the reference's, so the trace cannot be judged.
    Undecided,
}

/// The form of the particle-edge approach polynomial in a trace. Two forms are accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// No finding distinguishes the forms.
    #[default]
    Either,
    /// The course's formula, which has a slip in t^3.
    Course,
    /// The formula that follows from the definition.
    Right,
}

/// A decision about a pair that round-off may change, and that differs from the reference's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Borderline {
    /// The step, from 1.
    pub step: u32,
    /// The detection pass.
    pub pass: Pass,
    /// The pair whose decision is borderline.
    pub pair: Pair,
    /// Whether the trace reports a collision.
    pub collides: bool,
}

/// The largest differences of right values, as shares of their tolerances from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Shares {
    /// The share of polynomial coefficients.
    #[serde(rename = "coefficients", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub coefficient: f64,
    /// The share of contact normals.
    #[serde(rename = "normals", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub normal: f64,
    /// The share of positions.
    #[serde(rename = "positions", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub position: f64,
    /// The share of velocities.
    #[serde(rename = "velocities", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub velocity: f64,
}

impl Shares {
    /// Raises each share to that of `other`, if that is larger.
    pub fn max_with(&mut self, other: &Self) {
        self.coefficient = self.coefficient.max(other.coefficient);
        self.normal = self.normal.max(other.normal);
        self.position = self.position.max(other.position);
        self.velocity = self.velocity.max(other.velocity);
    }
}

/// The result of the fair rules for a trace.
#[derive(Debug, Clone, Default)]
pub struct Judgement {
    /// The verdict of the fair rules.
    pub verdict: FairVerdict,
    /// The reason why the whole trace is rejected, independent of its steps.
    pub refusal: Option<FairRefusal>,
    /// The findings by the fair rules.
    pub findings: BookFindings,
    /// The first step that was not judged, because it would take too much work or the scene has no result there.
    pub given_up: Option<u32>,
    /// The number of decisions about pairs in the trace, in all steps and passes.
    pub decisions: u64,
    /// The number of borderline decisions that differ from the reference's.
    pub borderline: u64,
    /// The first differing borderline decisions.
    pub borderline_examples: Vec<Borderline>,
    /// The interval of the common factor of all polynomials; `None` if the factor is 1.
    pub factor: Option<[f64; 2]>,
    /// The form of the approach polynomial.
    pub form: Form,
    /// The number of polynomials without small coefficients that the reference has, or with small ones that it lacks.
    pub lost: u64,
    /// The used shares of the tolerances.
    pub shares: Shares,
}
