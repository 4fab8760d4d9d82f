//! A scene of a suite, ready to be run.
use super::{
    library,
    result::{Failure, Reason, SceneResult},
    verdict::Verdict,
};
use fosssim_model::scene::Scene;

/// A scene to run.
#[derive(Debug, Clone)]
pub struct SceneTask {
    /// The scene's name, `Group/name`.
    pub name: String,
    /// The scene's XML, as passed to the program.
    pub xml: Vec<u8>,
    /// The parsed scene.
    pub scene: Scene,
    /// The scene's recorded trace, compressed with zstd, if there is one.
    pub recording: Option<&'static [u8]>,
}

impl SceneTask {
    /// Returns the scene's name as commands accept it: `asset:Group/name` if it is embedded.
    #[must_use]
    pub fn address(&self) -> String {
        let is_embedded = library::scene(&self.name).is_some_and(|embedded| embedded == self.xml);
        format!("{}{}", if is_embedded { "asset:" } else { "" }, self.name)
    }

    /// Creates the result of a scene that has no judged run.
    #[must_use]
    pub fn without_run(&self, verdict: Verdict, why: Reason) -> SceneResult {
        SceneResult::without_run(&self.name, self.scene.step_count(), verdict, why)
    }

    /// Returns the result of a scene on which the grader or the machine failed.
    #[must_use]
    pub fn failure_result(&self, failure: Failure) -> SceneResult {
        self.without_run(Verdict::JudgeError, Reason::Failed(failure))
    }
}
