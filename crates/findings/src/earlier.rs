//! Reads earlier grades, with which a later one is compared.
use serde::{Deserialize, Serialize};

/// The parts of an earlier grade that a later one is compared with. They are read from `grade --format json` of any
/// version.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EarlierGrade {
    /// The submission's name.
    pub submission: String,
    /// The groups, in the suite's order.
    pub groups: Vec<EarlierGroup>,
}

/// A group of an earlier grade.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EarlierGroup {
    pub(crate) name: String,
    pub(crate) points: Option<f64>,
    pub(crate) max_points: f64,
    #[serde(default)]
    pub(crate) extra: bool,
    pub(crate) scenes: Vec<EarlierScene>,
}

/// A scene of an earlier grade.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EarlierScene {
    pub(crate) scene: String,
    /// The verdict's code.
    pub(crate) code: String,
}
