//! The scenes and recordings that come with the program, embedded so that they are there wherever it runs.
//!
//! A scene's name is `Group/name`. Recordings are zstd files; `steps` are the digests of a recording's steps.
use include_dir::{Dir, include_dir};

static ASSETS: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/../../assets");
static REFERENCES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/../../references");

/// The names of all embedded scenes, in alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    stems(&ASSETS, ".xml")
}

/// The XML of a scene.
#[must_use]
pub fn scene(name: &str) -> Option<&'static [u8]> {
    file(&ASSETS, name, "xml")
}

/// The recording of a scene, compressed with zstd.
#[must_use]
pub fn recording(name: &str) -> Option<&'static [u8]> {
    file(&REFERENCES, name, "bin.zst")
}

/// The names of all embedded recordings, in alphabetical order.
pub fn recordings() -> impl Iterator<Item = &'static str> {
    stems(&REFERENCES, ".bin.zst")
}

/// A file of the folder of recordings: `manifest.txt`, `Group/name.steps` or `Group/name.bin.zst`.
#[must_use]
pub fn reference(path: &str) -> Option<&'static [u8]> {
    REFERENCES.get_file(path).map(|file| file.contents())
}

fn stems(dir: &'static Dir<'static>, extension: &str) -> impl Iterator<Item = &'static str> {
    let files = dir.dirs().flat_map(Dir::files);
    let mut names: Vec<_> = files.filter_map(|file| file.path().to_str()?.strip_suffix(extension)).collect();
    names.sort_unstable();
    names.into_iter()
}

fn file(dir: &'static Dir<'static>, name: &str, extension: &str) -> Option<&'static [u8]> {
    dir.get_file(format!("{name}.{extension}")).map(|file| file.contents())
}
