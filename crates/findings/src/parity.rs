//! The original's rule book on a trace: lock-step comparison (oracle-behavior.md 4 to 6).
use super::book_findings::BookFindings;
use fosssim_model::sim::StepError;
use fosssim_num::tolerances::{PARITY_ACCUMULATED, PARITY_MAXIMUM};
use serde::{Deserialize, Serialize};

/// The original's overall verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Overall {
    /// All five conditions of the original are met.
    Passed,
    /// A residual is too large, or a message was written.
    Failed,
    /// Grading stopped early, so there is no verdict.
    #[default]
    None,
}

/// The four residuals (oracle-behavior.md 6.3), in scene units.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Residuals {
    /// The sum of all position residuals.
    #[serde(rename = "accumulated_position_residual", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub accumulated_position: f64,
    /// The sum of all velocity residuals.
    #[serde(rename = "accumulated_velocity_residual", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub accumulated_velocity: f64,
    /// The largest position residual, ignoring NaN.
    #[serde(rename = "maximum_position_residual", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub maximum_position: f64,
    /// The largest velocity residual, ignoring NaN.
    #[serde(rename = "maximum_velocity_residual", with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub maximum_velocity: f64,
}

impl Residuals {
    /// Returns the residuals with their bounds, in the original's order: accumulated position and velocity, maximum
    /// position and velocity. A residual passes if it is strictly below its bound; NaN fails.
    #[must_use]
    pub const fn with_bounds(&self) -> [(f64, f64); 4] {
        [
            (self.accumulated_position, PARITY_ACCUMULATED),
            (self.accumulated_velocity, PARITY_ACCUMULATED),
            (self.maximum_position, PARITY_MAXIMUM),
            (self.maximum_velocity, PARITY_MAXIMUM),
        ]
    }
}

/// The result of the original's rules for a trace.
#[derive(Debug, Clone, Default)]
pub struct Judgement {
    /// The original's verdict; `None` if judging stopped early.
    pub overall: Overall,
    /// The residuals, which exist even if judging stopped early.
    pub residuals: Residuals,
    /// Whether collisions passed, including polynomials; `None` without a verdict.
    pub collisions_passed: Option<bool>,
    /// The findings by the original's rules.
    pub findings: BookFindings,
    /// The first step without a result, because the original does not terminate or gives up; later steps are not
    /// judged.
    pub endless: Option<StepError>,
}

impl Judgement {
    /// Sets the verdict, unless judging stopped early (oracle-behavior.md 6).
    pub fn conclude(&mut self, is_stopped: bool, is_complete: bool) {
        self.findings.conclude();
        if is_stopped || self.endless.is_some() {
            return;
        }
        let passed = self.findings.counts.collisions() == 0;
        self.collisions_passed = Some(passed);
        // The comparison is strict, so NaN fails.
        let residuals_pass = self.residuals.with_bounds().iter().all(|(residual, bound)| residual < bound);
        self.overall = if passed && residuals_pass && is_complete { Overall::Passed } else { Overall::Failed };
    }
}
