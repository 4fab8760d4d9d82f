//! Reads earlier grades, with which a later one is compared.
use serde::{Deserialize, Serialize};

/// An earlier grade, with which a later one is compared. It contains what the comparison needs, and is read from `grade
/// --format json` of any version.
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
    /// The code of the scene's verdict, such as `AC`.
    pub(crate) code: String,
}
