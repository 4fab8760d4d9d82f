//! A scene of a suite, ready to be run.
use fosssim_model::scene::Scene;

/// A scene to run.
#[derive(Debug, Clone)]
pub struct SceneTask {
    /// Its name, `Group/name`.
    pub name: String,
    /// Its XML, as the program gets it.
    pub xml: Vec<u8>,
    /// The scene itself.
    pub scene: Scene,
    /// Its recorded trace, compressed with zstd, when there is one.
    pub recording: Option<&'static [u8]>,
}
