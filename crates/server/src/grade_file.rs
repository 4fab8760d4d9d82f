//! The parts of a `grade.json` that the service reads (`schemas/grade.schema.json`).
use serde::Deserialize;
use serde_json::Number;

/// The parts of a `grade.json` that this service reads.
#[derive(Debug, Deserialize)]
pub(crate) struct GradeFile {
    pub(crate) schema: u32,
    pub(crate) version: String,
    pub(crate) grades: Vec<GradeInFile>,
}

/// The grade of one submission in a `grade.json`.
#[derive(Debug, Deserialize)]
pub(crate) struct GradeInFile {
    pub(crate) verdict: String,
    pub(crate) code: String,
    pub(crate) points: Option<Number>,
    pub(crate) max_points: Option<Number>,
    /// The reason why the submission as a whole could not be graded, as a sentence.
    pub(crate) unfit: Option<String>,
    /// The mistakes that would explain all wrong scenes, the likeliest first.
    #[serde(default)]
    pub(crate) likely_mistakes: Vec<MistakeInFile>,
    #[serde(default)]
    pub(crate) groups: Vec<GroupInFile>,
}

/// A likely mistake in a `grade.json`, as a sentence.
#[derive(Debug, Deserialize)]
pub(crate) struct MistakeInFile {
    pub(crate) text: String,
}

/// A group of scenes in a `grade.json`.
#[derive(Debug, Deserialize)]
pub(crate) struct GroupInFile {
    #[serde(default)]
    pub(crate) name: String,
    pub(crate) visibility: Option<String>,
    pub(crate) points: Option<f64>,
    pub(crate) max_points: Option<f64>,
    /// Whether the group's points are extra. Then they count in neither the sum nor the maximum.
    #[serde(default)]
    pub(crate) extra: bool,
    pub(crate) scenes: Vec<SceneInFile>,
}

/// A scene in a `grade.json`.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct SceneInFile {
    pub(crate) scene: String,
    pub(crate) code: String,
    pub(crate) verdict: String,
    /// The scene's result as a sentence.
    pub(crate) summary: String,
}

impl GradeInFile {
    /// Returns the scenes of all groups.
    pub(crate) fn scenes(&self) -> Vec<&SceneInFile> {
        self.groups.iter().flat_map(|group| &group.scenes).collect()
    }
}
