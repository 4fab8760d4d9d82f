//! Reads a corpus of submissions that the original has judged: `verdicts.jsonl`, `scenes/` and `submissions/`.
use anyhow::Context;
use fosssim_oracle::scene::{Scene, original};
use serde::Deserialize;
use std::path::Path;

/// A submission's trace of a scene.
#[derive(Debug, Deserialize)]
pub struct CorpusRow {
    /// The submission's name.
    pub submission: String,
    /// The kind of the trace. The kind `a` is a correct trace.
    pub kind: String,
    /// The scene's name.
    pub scene: String,
    /// The original's verdict.
    pub overall: String,
    trace_file: Option<String>,
    /// Whether the trace is identical to the reference's.
    pub trace_equals_reference: Option<bool>,
}

/// Returns all rows of a corpus.
///
/// # Errors
/// Fails if the folder is not a corpus.
pub fn read_rows(corpus: &Path) -> anyhow::Result<Vec<CorpusRow>> {
    let text = std::fs::read_to_string(corpus.join("verdicts.jsonl")).context("the folder has no verdicts.jsonl")?;
    Ok(text.lines().map(serde_json::from_str).collect::<Result<_, _>>()?)
}

impl CorpusRow {
    /// Reads the scene and the trace, if the trace exists.
    ///
    /// # Errors
    /// Fails if one of them cannot be read.
    pub fn read(&self, corpus: &Path) -> anyhow::Result<Option<(Scene, Vec<u8>)>> {
        let Some(file) = &self.trace_file else { return Ok(None) };
        let scene = std::fs::read(corpus.join("scenes").join(format!("{}.xml", self.scene)))?;
        let scene = original::read(&scene).with_context(|| self.scene.clone())?.scene;
        Ok(Some((scene, zstd::decode_all(std::fs::File::open(corpus.join(file))?)?)))
    }
}
