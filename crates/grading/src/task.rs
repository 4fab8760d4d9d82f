//! A scene of a suite that is ready to be run.
use super::{
    library,
    result::{Failure, Reason, SceneResult},
    verdict::Verdict,
};
use fosssim_model::scene::Scene;

/// A scene to be run, with everything that a run needs.
#[derive(Debug, Clone)]
pub struct SceneTask {
    /// The name of the scene, as `Group/name`.
    pub name: String,
    /// The content of the scene's file, as the program receives it.
    pub xml: Vec<u8>,
    /// The parsed scene.
    pub scene: Scene,
    /// The recording of the scene, compressed with zstd, if there is one.
    pub recording: Option<&'static [u8]>,
}

impl SceneTask {
    /// Returns the scene's name in the form that commands accept. For embedded scenes it is `asset:Group/name`.
    pub fn address(&self) -> String {
        let is_embedded = library::find_scene(&self.name).is_some_and(|embedded| embedded == self.xml);
        format!("{}{}", if is_embedded { "asset:" } else { "" }, self.name)
    }

    /// Creates the result of the scene for the case that no run was judged.
    pub fn without_run(&self, verdict: Verdict, reason: Reason) -> SceneResult {
        SceneResult::without_run(&self.name, self.scene.step_count(), verdict, reason)
    }

    /// Creates the result of the scene for the case that the grader or the machine failed.
    pub fn failure_result(&self, failure: Failure) -> SceneResult {
        self.without_run(Verdict::JudgeError, Reason::Failed(failure))
    }
}
