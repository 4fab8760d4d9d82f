//! Reads suites and scenes from files.
use super::{MatchingScenes, Plan, built_in_names, find_built_in_suite, load_with, suggest};
use crate::config::SuiteError;
use fosssim_files::{open_file, read_limited, read_text};
use fosssim_model::scene;
use std::{io, path::Path};

/// The maximum size of a suite file, in bytes.
pub const MAX_SUITE_BYTES: u64 = 1 << 20;

/// The maximum number of scenes in a suite.
pub const MAX_SCENES: usize = 10_000;
/// The maximum size of all scenes of a suite together, in bytes.
pub const MAX_SCENE_BYTES: u64 = 256 << 20;

/// The reason why a suite cannot be used. It does not exist, a file cannot be read, or the suite has errors.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct FindError {
    message: String,
    /// The reason why a file can't be read; `None` if something else is wrong.
    #[source]
    cause: Option<io::Error>,
}

impl From<String> for FindError {
    fn from(message: String) -> Self {
        Self { message, cause: None }
    }
}

/// Returns the message about an invalid suite. Each problem has its own line.
fn describe_errors(name: &str, SuiteError { problems }: &SuiteError) -> String {
    let lines: String = problems.iter().map(|(at, text)| format!("\n{name}:{at}: {text}")).collect();
    let plural = if problems.len() == 1 { "" } else { "s" };
    format!("the suite has {} problem{plural}:{lines}", problems.len())
}

/// Finds a suite. It is a built-in suite that is given by its name, or a file. Paths in the file are relative to the
/// file's folder.
///
/// # Errors
///
/// Fails if there is no such suite. If the suite is invalid, the error contains all problems.
pub fn find_suite(name: &str) -> Result<Plan, FindError> {
    let path = Path::new(name);
    let suite_folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let loaded = match find_built_in_suite(name) {
        Some(text) => load_suite(text, Path::new(".")),
        None => {
            let text = read_text(path, MAX_SUITE_BYTES).map_err(|error| match error.kind() {
                io::ErrorKind::NotFound => {
                    let suite_names = built_in_names().collect::<Vec<_>>().join(", ");
                    format!("there is no suite {name}: it is neither a file nor one of {suite_names}{}", suggest(name))
                        .into()
                }
                _ => FindError { message: format!("cannot read the suite {name}"), cause: Some(error) },
            })?;
            if ["<?xml", "<scene"].iter().any(|start| text.starts_with(start)) {
                let advice = "a group of a suite lists it in its `scenes`";
                return Err(format!("{name} is a scene, not a suite: {advice}").into());
            }
            load_suite(&text, suite_folder)
        }
    };
    loaded.map_err(|error| describe_errors(name, &error).into())
}

/// Reads and validates a suite, and finds its scenes. Paths in it are relative to `folder`.
///
/// # Errors
///
/// Fails like [`load_with`].
pub fn load_suite(text: &str, folder: &Path) -> Result<Plan, SuiteError> {
    let mut room = FileBudget { scenes: MAX_SCENES, bytes: MAX_SCENE_BYTES };
    load_with(text, &mut |pattern| find_files(pattern, folder, &mut room))
}

/// The numbers of files and bytes that the scenes of a suite may still have.
struct FileBudget {
    scenes: usize,
    bytes: u64,
}

fn find_files(pattern: &str, folder: &Path, room: &mut FileBudget) -> Result<MatchingScenes, String> {
    let path = folder.join(pattern);
    let text = path.to_str().ok_or_else(|| format!("{}: the folder's name is not UTF-8", folder.display()))?;
    let paths = glob::glob(text).map_err(|error| format!("pattern {pattern}: {error}"))?;
    let mut found = MatchingScenes::new();
    for path in paths {
        let path = path.map_err(|error| format!("{}: {}", error.path().display(), error.error()))?;
        let relative = path.strip_prefix(folder).unwrap_or(&path);
        let name = relative.with_extension("").to_string_lossy().into_owned();
        let xml = scene_file(&path)?;
        room.scenes = room
            .scenes
            .checked_sub(1)
            .ok_or_else(|| format!("with pattern {pattern} the suite exceeds the limit of {MAX_SCENES} scenes"))?;
        room.bytes = room.bytes.checked_sub(xml.len() as u64).ok_or_else(|| {
            format!(
                "with pattern {pattern} the suite's scenes have more than {MAX_SCENE_BYTES} bytes, which is the \
                limit"
            )
        })?;
        found.push((name, xml));
    }
    if found.is_empty() {
        return Err(format!("no scene file matches {pattern} (paths are relative to the suite's folder)"));
    }
    Ok(found)
}

/// Returns the content of a scene file. It must be a regular file, because reading anything else might never end.
fn scene_file(path: &Path) -> Result<Vec<u8>, String> {
    const MAX_BYTES: u64 = scene::MAX_SCENE_BYTES as u64;
    let (file, size) = open_file(path, true).map_err(|error| error.to_string())?;
    if size > MAX_BYTES {
        return Err(format!("{} is too large for a scene ({size} bytes, the limit is {MAX_BYTES})", path.display()));
    }
    let read = file.metadata().and_then(|metadata| read_limited(file, &metadata, MAX_BYTES));
    read.map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_a_suite_are_regular_and_limited() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["a.xml", "b.xml", "c.xml"] {
            std::fs::write(folder.path().join(name), "<scene/>").expect("written");
        }
        let found = |pattern: &str, scenes, bytes| {
            let found = find_files(pattern, folder.path(), &mut FileBudget { scenes, bytes });
            found.map(|found| found.len())
        };
        assert_eq!(found("*.xml", 3, 24), Ok(3));
        assert!(found("*.xml", 2, 24).expect_err("one too many").contains("the limit of 10000 scenes"));
        assert!(found("*.xml", 3, 23).expect_err("too large").contains("more than 268435456 bytes"));
        std::fs::File::create(folder.path().join("hole")).expect("a file").set_len(1 << 40).expect("a hole");
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero")).expect("a link");
        assert!(found("hole", 3, 24).expect_err("a hole").contains("too large for a scene"));
        assert!(found("zero", 3, 24).expect_err("a device").contains("a device"));
    }
}
