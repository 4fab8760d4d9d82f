//! Handles scenes on which the grader failed. The verdict is a judge error, and the trace is saved for the developer
//! who repairs the grader.
use super::{
    guard::CaughtPanic,
    result::{Activity, Failure, SavedTrace, SceneResult},
    task::SceneTask,
};
use fosssim_files::FilePlace;
use std::{
    io,
    path::{Path, PathBuf},
};

/// Returns the result of a scene on which the grader failed, with the beginning of its trace.
pub(super) fn fault_result(
    task: &SceneTask,
    folder: &FilePlace,
    stage: Activity,
    fault: &CaughtPanic,
    trace: &[u8],
) -> SceneResult {
    let saved_trace = match save_trace(folder, task, trace) {
        Ok(path) => SavedTrace::In(path),
        Err(error) => SavedTrace::Lost { folder: folder.path(), error: error.to_string() },
    };
    task.failure_result(Failure::Panic { stage: Some(stage), fault: fault.to_string(), trace: Some(saved_trace) })
}

/// Writes a trace into the folder. The file's name contains the scene's name and the trace's digest.
fn save_trace(folder: &FilePlace, task: &SceneTask, trace: &[u8]) -> io::Result<PathBuf> {
    let scene: String =
        task.name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    let digest = blake3::hash(trace).to_hex();
    let path = folder.join(format!("{}-{}.bin", scene.trim_start_matches('.'), &digest[..8]));
    path.write(trace)?;
    Ok(path.path())
}

/// Makes the grader fail in tests: a program with this name causes a panic in this activity.
#[cfg(test)]
pub(super) fn inject_panic(stage: Activity, program: &Path) {
    let name = program.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let word = format!("{stage:?}").to_lowercase();
    assert!(name != format!("fault-while-{word}"), "injected grader failure");
}

#[cfg(not(test))]
pub(super) const fn inject_panic(_: Activity, _: &Path) {}
