//! The judgment of a trace by the original's rules, which compare it step by step with the reference
//! (oracle-behavior.md 4 to 6).
use super::book_findings::BookFindings;
use fosssim_model::sim::StepError;
use fosssim_num::tolerances::{PARITY_ACCUMULATED_RESIDUAL, PARITY_MAX_RESIDUAL};
use serde::{Deserialize, Serialize};

/// The original's verdict on the whole trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Overall {
    /// All five conditions of the original are met.
    Passed,
    /// A residual is too large, or the original printed a message about a fault.
    Failed,
    /// Judging stopped early, so there is no verdict.
    #[default]
    None,
}

/// The four residuals (oracle-behavior.md 6.3), in the scene's units of length and velocity.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Residuals {
    /// The sum of the position residuals of all steps.
    #[serde(rename = "accumulated_position_residual", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub accumulated_position: f64,
    /// The sum of the velocity residuals of all steps.
    #[serde(rename = "accumulated_velocity_residual", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub accumulated_velocity: f64,
    /// The largest position residual of all steps. NaN is ignored.
    #[serde(rename = "maximum_position_residual", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub maximum_position: f64,
    /// The largest velocity residual of all steps. NaN is ignored.
    #[serde(rename = "maximum_velocity_residual", with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub maximum_velocity: f64,
}

impl Residuals {
    /// Returns each residual and its bound, in the original's order: accumulated position, accumulated velocity,
    /// maximum position, maximum velocity. A residual passes if it is strictly smaller than its bound, so NaN fails.
    pub const fn with_bounds(&self) -> [(f64, f64); 4] {
        [
            (self.accumulated_position, PARITY_ACCUMULATED_RESIDUAL),
            (self.accumulated_velocity, PARITY_ACCUMULATED_RESIDUAL),
            (self.maximum_position, PARITY_MAX_RESIDUAL),
            (self.maximum_velocity, PARITY_MAX_RESIDUAL),
        ]
    }
}

/// The judgment of a trace by the original's rules.
#[derive(Debug, Clone, Default)]
pub struct Judgment {
    /// The original's verdict. It is `None` if judging stopped early.
    pub overall: Overall,
    /// The residuals. They also exist if judging stopped early.
    pub residuals: Residuals,
    /// Whether the original's verdict on collisions and polynomials is "passed"; `None` without a verdict.
    pub collisions_passed: Option<bool>,
    /// The findings by the original's rules.
    pub findings: BookFindings,
    /// The first step that has no result, because the original does not terminate or gives up; `None` if all steps have
    /// one. Later steps are not judged.
    pub endless_step: Option<StepError>,
}

impl Judgment {
    /// Sets the verdict (oracle-behavior.md 6). If judging stopped early, there is none.
    pub fn conclude(&mut self, is_stopped: bool, is_complete: bool) {
        self.findings.conclude();
        if is_stopped || self.endless_step.is_some() {
            return;
        }
        let passed = self.findings.counts.collisions() == 0;
        self.collisions_passed = Some(passed);
        // The comparison is strict, so NaN fails.
        let residuals_pass = self.residuals.with_bounds().iter().all(|(residual, bound)| residual < bound);
        self.overall = if passed && residuals_pass && is_complete { Overall::Passed } else { Overall::Failed };
    }
}
