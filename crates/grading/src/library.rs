//! The scenes and recordings that are embedded in the program.
//!
//! Each assignment has a folder. A scene's name is `Group/name` and is unique. The full form `t2m2/Group/name` is
//! accepted as well. Recordings are files that are compressed with zstd. Files with the ending `steps` contain the
//! digests of a recording's steps.
use super::assignments::{GeneratedScene, TIMING_SCENES, find_version};
use fosssim_model::assignments::Assignment;
use glob::Pattern;
use include_dir::{Dir, File, include_dir};
use std::path::Path;

static ASSETS: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/../../assets");
/// The recordings. Only builds that run submissions need them.
#[cfg(target_os = "linux")]
static REFERENCES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/../../references");

/// An example of a wrong trace: the scene's name, and the trace that the sample program writes if it makes the mistake
/// `pe-linear-one-ab`.
pub const FLAWED_TRACE: (&str, &[u8]) = (
    "ContinuousTimeTests/spinning-edge-sweeps-balls",
    include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/traces/flawed.bin")),
);

/// The assignment to which generated scenes belong.
const GENERATED_ASSIGNMENT: Assignment = Assignment::T2M3;

/// Returns the names of all embedded scenes, in alphabetical order.
pub fn scene_names() -> impl Iterator<Item = &'static str> {
    file_stems(&ASSETS, ".xml")
}

/// Returns the names of all built-in scenes. They are embedded, or generated when they are needed; generated scenes
/// have no recordings.
pub fn all_names() -> impl Iterator<Item = &'static str> {
    scene_names().chain(TIMING_SCENES.iter().map(|made| made.name))
}

/// Returns the content of a built-in scene's file; `None` if there is no scene with this name.
pub fn find_scene(name: &str) -> Option<&'static [u8]> {
    find_content(&ASSETS, &format!("{name}.xml")).or_else(|| find_generated(name).map(GeneratedScene::xml))
}

/// Returns the generated scene with this name or full name.
fn find_generated(name: &str) -> Option<&'static GeneratedScene> {
    let short_name =
        name.strip_prefix(GENERATED_ASSIGNMENT.key()).and_then(|rest| rest.strip_prefix('/')).unwrap_or(name);
    TIMING_SCENES.iter().find(|made| made.name == short_name)
}

/// Returns the recording of a scene, compressed with zstd; `None` if there is none.
#[cfg(target_os = "linux")]
pub fn recording(name: &str) -> Option<&'static [u8]> {
    find_content(&REFERENCES, &format!("{name}.bin.zst"))
}

/// Returns `None`, because builds that cannot run programs contain no recordings.
#[cfg(not(target_os = "linux"))]
pub const fn recording(_: &str) -> Option<&'static [u8]> {
    None
}

/// Returns the names of all embedded recordings, in alphabetical order.
#[cfg(target_os = "linux")]
pub fn recordings() -> impl Iterator<Item = &'static str> {
    file_stems(&REFERENCES, ".bin.zst")
}

/// Returns a file from the folder of recordings. Its path is `manifest.txt`, `Group/name.steps` or
/// `Group/name.bin.zst`. Returns `None` if there is no such file.
#[cfg(target_os = "linux")]
pub fn recording_file(path: &str) -> Option<&'static [u8]> {
    find_content(&REFERENCES, path)
}

/// Returns the assignment in whose folder the scene with this name is; `None` if there is no such scene.
pub fn find_assignment(name: &str) -> Option<Assignment> {
    if find_generated(name).is_some() {
        return Some(GENERATED_ASSIGNMENT);
    }
    let path = file(&ASSETS, &format!("{name}.xml"))?.path();
    Assignment::from_key(path.components().next()?.as_os_str().to_str()?)
}

/// Returns whether a pattern matches a scene's name. If the pattern begins with an assignment's folder, as in `t2m2/*`,
/// it matches only scenes in that folder. If a version follows the folder, as in `t2m2@1/*`, it matches only scenes of
/// that version.
pub fn matches_pattern(pattern: &Pattern, name: &str) -> bool {
    let Some((folder, rest)) = pattern.as_str().split_once('/') else { return pattern.matches(name) };
    match find_version(folder) {
        Some((of, version)) => {
            let matches = Pattern::new(rest).is_ok_and(|rest| rest.matches(name));
            matches && version.has_scene(name) && find_assignment(name) == Some(of)
        }
        None => pattern.matches(name),
    }
}

fn file_stems(root: &'static Dir<'static>, extension: &str) -> impl Iterator<Item = &'static str> {
    let files = root.dirs().flat_map(|assignment| {
        let files = assignment.dirs().flat_map(Dir::files);
        files.filter_map(|file| file.path().strip_prefix(assignment.path()).ok())
    });
    let mut names: Vec<_> = files.filter_map(|path| path.to_str()?.strip_suffix(extension)).collect();
    names.sort_unstable();
    names.into_iter()
}

fn find_content(root: &'static Dir<'static>, path: &str) -> Option<&'static [u8]> {
    file(root, path).map(File::contents)
}

/// Returns a file of an assignment. The path is the whole path, or the path within an assignment's folder.
fn file(root: &'static Dir<'static>, path: &str) -> Option<&'static File<'static>> {
    let find_in = |assignment: Assignment| find_below(subfolder(root, assignment.key())?, path);
    Assignment::list_default_first().into_iter().find_map(find_in).or_else(|| find_below(root, path))
}

/// Returns the file at a path below a folder. [`Dir::get_file`] is slower, because it compares the path with that of
/// every entry.
fn find_below(folder: &'static Dir<'static>, path: &str) -> Option<&'static File<'static>> {
    match path.split_once('/') {
        Some((first, rest)) => find_below(subfolder(folder, first)?, rest),
        None => folder.files().find(|file| has_name(file.path(), path)),
    }
}

/// Returns the subfolder `name`.
fn subfolder(folder: &'static Dir<'static>, name: &str) -> Option<&'static Dir<'static>> {
    folder.dirs().find(|inner| has_name(inner.path(), name))
}

/// Returns whether the last component of the path is `name`.
fn has_name(path: &Path, name: &str) -> bool {
    let before = path.as_os_str().as_encoded_bytes().strip_suffix(name.as_bytes());
    before.is_some_and(|before| before.is_empty() || before.ends_with(b"/"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn folders_are_those_of_assignments_and_no_two_scenes_have_the_same_name() {
        for root in [&ASSETS, &REFERENCES] {
            for folder in root.dirs() {
                let key = folder.path().to_str().expect("UTF-8");
                assert!(Assignment::from_key(key).is_some(), "{key} is no assignment's key");
            }
        }
        let all: Vec<&str> = scene_names().collect();
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
        assert_eq!(recordings().collect::<Vec<_>>(), all, "each has its recording");
    }

    #[test]
    fn a_scene_is_found_by_its_name_and_by_its_name_in_full() {
        for name in all_names() {
            let full = format!("{}/{name}", find_assignment(name).expect("an assignment").key());
            assert!(find_scene(name).is_some() && find_scene(name) == find_scene(&full), "{name}");
            assert!(recording(name) == recording(&full), "{name}");
            assert_eq!(find_assignment(&full), find_assignment(name));
        }
        assert!(find_scene("NoSuchTests/none").is_none() && find_scene("t2m2/SimpleTests/one-ball-into-two").is_none());
        assert!(recording_file("manifest.txt").is_some());
    }

    #[test]
    fn patterns_take_names_or_an_assignments_folder() {
        let taken = |pattern: &str| {
            let pattern = Pattern::new(pattern).expect("a pattern");
            scene_names().filter(|name| matches_pattern(&pattern, name)).collect::<Vec<_>>()
        };
        let of = |key: &str| {
            scene_names().filter(|name| find_assignment(name) == Assignment::from_key(key)).collect::<Vec<_>>()
        };
        assert_eq!(taken("t2m2/*"), taken("t2m2@3/*"), "the newest version is meant");
        assert_eq!(taken("t2m1/*"), of("t2m1"));
        assert_eq!(taken("*").len(), scene_names().count());
        assert_eq!(taken("t2m2/GeometricTests/*"), taken("GeometricTests/*"));
        assert_eq!(taken("t2m2@2/*").len(), 116, "what was published");
        assert_eq!(taken("t2m2@1/*").len(), 85, "what was published");
        assert!(taken("t2m2@1/*").iter().all(|name| of("t2m2").contains(name)));
        assert!(taken("t2m2@9/*").is_empty());
        assert!(taken("t2m2/SimpleTests/*").is_empty() && !taken("SimpleTests/*").is_empty());
        assert!(taken("t*").is_empty(), "a pattern without a folder is compared with names alone");
    }
}
