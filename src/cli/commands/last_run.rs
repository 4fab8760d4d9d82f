//! The scenes that were not accepted in the last grading of the same submissions, for `grade --failed`.
//!
//! They are stored in the output folder, or in the user's cache if there is no output folder. Errors of the file are
//! ignored.
use crate::{
    cli::output,
    files::FilePlace,
    suite::{Grade, Submission, Verdict},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

/// The name of the file in an output folder.
const LAST_RUN_FILE: &str = "last-run.json";

/// The maximum size of the file, in bytes. It is four times the size for 10,000 submissions of 85 scenes.
const MAX_BYTES: u64 = 256 << 20;

/// For each submission, whether each scene was accepted.
type AcceptedScenes = BTreeMap<String, BTreeMap<String, bool>>;

/// The scenes that the last grading accepted and did not accept.
#[derive(Debug, Default)]
pub(super) struct LastRun {
    file: Option<FilePlace>,
    accepted_scenes: AcceptedScenes,
}

impl LastRun {
    /// Reads which scenes the last grading of these submissions on the same suite accepted.
    pub(super) fn open(folder: Option<&Path>, submissions: &[Submission], suite: &str) -> Self {
        let file = folder.map(|folder| FilePlace::new(folder, LAST_RUN_FILE)).or_else(|| {
            let mut hasher = blake3::Hasher::new();
            for submission in submissions {
                let path = std::path::absolute(&submission.path).unwrap_or_else(|_| submission.path.clone());
                hasher.update(path.as_os_str().as_encoded_bytes()).update(b"\0");
                hasher.update(submission.name.as_bytes()).update(b"\0");
            }
            let name = hasher.update(suite.as_bytes()).finalize().to_hex();
            Some(FilePlace::new(cache_folder()?, format!("last-run/{}.json", &name[..16])))
        });
        let text = file.as_ref().and_then(|file| file.read(MAX_BYTES).ok()).unwrap_or_default();
        Self { file, accepted_scenes: serde_json::from_slice(&text).unwrap_or_default() }
    }

    /// Returns the scenes that were not accepted for at least one submission; `None` if there was no such grading.
    pub(super) fn failed_scenes(&self) -> Option<BTreeSet<String>> {
        let scenes = self.accepted_scenes.values().flatten().filter(|(_, accepted)| !**accepted);
        (!self.accepted_scenes.is_empty()).then(|| scenes.map(|(scene, _)| scene.clone()).collect())
    }

    /// Returns whether a scene of the submission was not accepted, or nothing is known about the submission.
    pub(super) fn has_failed(&self, submission: &str) -> bool {
        self.accepted_scenes.get(submission).is_none_or(|scenes| scenes.values().any(|accepted| !accepted))
    }

    /// Stores which scenes these grades accept. Scenes that were not run keep their earlier state.
    pub(super) fn remember(&mut self, grades: &[Grade]) {
        for grade in grades {
            let scenes = self.accepted_scenes.entry(grade.submission.clone()).or_default();
            for scene in grade.scenes() {
                if scene.verdict == Verdict::NotRun {
                    scenes.entry(scene.scene.clone()).or_insert(false);
                } else {
                    scenes.insert(scene.scene.clone(), scene.verdict.is_accepted());
                }
            }
        }
        let Some(file) = &self.file else { return };
        let text = serde_json::to_vec(&self.accepted_scenes).unwrap_or_default();
        drop(output::write_below(file, &text));
    }
}

/// Returns this program's folder in the user's cache, or `None` if the environment names no folder.
fn cache_folder() -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let cache = set("XDG_CACHE_HOME").or_else(|| set("HOME").map(|home| home.join(".cache")))?;
    Some(cache.join("fosssim-oracle"))
}
