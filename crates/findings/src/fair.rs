//! The judgment of a trace by the fair rules (numerics.md 2).
use super::book_findings::BookFindings;
use fosssim_model::sim::{Pair, Pass};
use serde::{Deserialize, Serialize};

/// The verdict on a trace by the fair rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FairVerdict {
    /// The trace meets all rules.
    Accepted,
    /// The trace breaks a rule.
    Rejected,
    /// Judging stopped early, before a fault was found.
    #[default]
    None,
}

/// The reason why a trace is rejected as a whole, and not because of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "FairRefusal")]
pub enum FairRejection {
    /// The trace can't be read to its end.
    Stopped,
    /// The trace is damaged. The original reads it, because it skips damage.
    Damaged,
    /// Bytes follow the last record.
    TrailingBytes,
    /// The trace cannot be judged, because most of its decisions are borderline and differ from the reference's.
    Undecided,
}

/// The form of the particle-edge approach polynomial that a trace uses. Both forms are accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// The trace does not show which form it uses.
    #[default]
    Either,
    /// The course's formula, which has a slip in the coefficient of t^3.
    Course,
    /// The formula that follows from the definition of the approach.
    Right,
}

/// A decision about a pair that differs from the reference's. Because round-off may explain it, it is not a finding.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Borderline {
    /// The number of the step, from 1.
    pub step: u32,
    /// The detection pass in which the decision was made.
    pub pass: Pass,
    /// The pair that the decision is about.
    pub pair: Pair,
    /// Whether the trace decides that the pair collides.
    pub collides: bool,
}

/// The largest differences of values that are still accepted, as shares of their tolerances from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Shares {
    /// The largest share for the coefficients of polynomials.
    #[serde(rename = "coefficients", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub coefficient: f64,
    /// The largest share for contact normals.
    #[serde(rename = "normals", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub normal: f64,
    /// The largest share for positions.
    #[serde(rename = "positions", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub position: f64,
    /// The largest share for velocities.
    #[serde(rename = "velocities", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
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

/// The judgment of a trace by the fair rules.
#[derive(Debug, Clone, Default)]
pub struct Judgment {
    /// The verdict by the fair rules.
    pub verdict: FairVerdict,
    /// The reason why the whole trace is rejected, if there is one.
    pub rejection: Option<FairRejection>,
    /// The findings by the fair rules.
    pub findings: BookFindings,
    /// The first step that was not judged, because it would take too much work, or because the scene has no result
    /// there; `None` if all steps were judged.
    pub first_unjudged_step: Option<u32>,
    /// The number of decisions about pairs in the trace, over all steps and passes.
    pub decisions: u64,
    /// The number of borderline decisions that differ from the reference's.
    pub borderline: u64,
    /// The first borderline decisions that differ from the reference's.
    pub borderline_examples: Vec<Borderline>,
    /// The interval that contains the factor between the trace's polynomials and the reference's; `None` if the factor
    /// is 1.
    pub factor: Option<[f64; 2]>,
    /// The form of the approach polynomial that the trace uses.
    pub form: Form,
    /// The number of calls with right polynomials in which small coefficients are present on one side and dropped on
    /// the other.
    pub lost_decisions: u64,
    /// The shares of the tolerances that accepted values use.
    pub shares: Shares,
}
