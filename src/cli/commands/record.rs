//! The command `record`, which records the reference's traces for a folder of scenes.
use crate::{
    cli::{arguments::RecordArguments, console, exit, output},
    files::{self, FileError, FilePlace},
    report::number::format_count,
    scene::MAX_SCENE_BYTES,
    suite::{
        library,
        recording::{self, Recording},
        scene_files::{self, SceneFile},
    },
};
use anyhow::{Context, Result, bail};
use std::{io, path::Path};

/// The maximum size of a recording, in bytes.
const MAX_RECORDING_BYTES: u64 = 1 << 30;

pub(super) fn run(arguments: &RecordArguments) -> Result<u8> {
    // A folder that the user names is used, even if it does not exist yet.
    let defaults = arguments.assets == Path::new("assets") && arguments.references == Path::new("references");
    let embedded = arguments.check && defaults && !arguments.assets.is_dir();
    let scenes = if embedded { list_bundled() } else { find_scenes(&arguments.assets)? };
    let mut recordings = Vec::new();
    for RecordedScene { name, stem, xml } in scenes {
        recordings.push((stem, Recording::for_scene(&name, &xml).with_context(|| format!("cannot record {name}"))?));
    }
    if !arguments.check {
        return write(&recordings, &arguments.references);
    }
    check(&recordings, &EarlierRecordings((!embedded).then_some(&arguments.references)))
}

/// A scene that is to be recorded.
struct RecordedScene {
    name: String,
    /// The path of the recording in the folder of recordings, without the ending.
    stem: String,
    xml: Vec<u8>,
}

/// Returns the embedded scenes. Their recordings are found by name.
fn list_bundled() -> Vec<RecordedScene> {
    let input = |name: &str| {
        Some(RecordedScene { name: name.to_owned(), stem: name.to_owned(), xml: library::find_scene(name)?.into() })
    };
    library::scene_names().filter_map(input).collect()
}

/// Returns the scenes of a folder, in alphabetical order.
fn find_scenes(folder: &Path) -> Result<Vec<RecordedScene>> {
    let path = folder.display();
    let files = scene_files::list_files(folder, ".xml").with_context(|| {
        format!("cannot read the scenes in {path}; run this command in the checkout, or choose a folder with --assets")
    })?;
    if files.is_empty() {
        bail!("there is no scene in {path}; scenes are called {path}/<Group>/<name>.xml");
    }
    for pair in files.windows(2) {
        if pair[0].name == pair[1].name {
            let (one, other) = (pair[0].path.display(), pair[1].path.display());
            bail!("{one} and {other} would both be called {}; rename one of them", pair[0].name);
        }
    }
    let read = |SceneFile { name, stem, path }: SceneFile| {
        let xml =
            files::read(&path, MAX_SCENE_BYTES as u64).with_context(|| format!("cannot read {}", path.display()))?;
        Ok(RecordedScene { name, stem, xml })
    };
    files.into_iter().map(read).collect()
}

/// The recordings that existed before: those in a folder, or the embedded ones.
struct EarlierRecordings<'a>(Option<&'a Path>);

impl EarlierRecordings<'_> {
    fn file(&self, path: &str) -> io::Result<Option<Vec<u8>>> {
        let Some(folder) = self.0 else { return Ok(library::recording_file(path).map(<[u8]>::to_vec)) };
        match FilePlace::new(folder, path).read(MAX_RECORDING_BYTES) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(FileError::Missing { .. }) => Ok(None),
            Err(error) => Err(io::Error::other(error)),
        }
    }

    /// Returns the paths of the recordings, without their endings.
    fn stems(&self) -> Vec<String> {
        let Some(folder) = self.0 else { return library::recordings().map(str::to_owned).collect() };
        // If the folder does not exist, it has no recordings.
        let files = scene_files::list_files(folder, ".bin.zst").unwrap_or_default();
        files.into_iter().map(|file| file.stem).collect()
    }
}

/// Compares the new recordings with the earlier ones, byte for byte.
fn check(recordings: &[(String, Recording)], old: &EarlierRecordings<'_>) -> Result<u8> {
    let mut text = String::new();
    for (stem, recording) in recordings {
        let (packed, steps) = (old.file(&format!("{stem}.bin.zst"))?, old.file(&format!("{stem}.steps"))?);
        text += &recording.describe_difference(packed.as_deref(), steps.as_deref()).unwrap_or_default();
    }
    for stem in old.stems() {
        if !recordings.iter().any(|(known, _)| *known == stem) {
            text += &format!("{stem}: there is a recording, but no scene\n");
        }
    }
    let before = old.file("manifest.txt")?.unwrap_or_default();
    text += &recording::render_diff("manifest.txt", &String::from_utf8_lossy(&before), &render_manifest(recordings));
    if text.is_empty() {
        let steps = recordings.iter().map(|(_, recording)| u64::from(recording.steps)).sum();
        let (recordings, steps) = (format_count(recordings.len() as u64, "recording"), format_count(steps, "step"));
        console::print(format!("{recordings}, {steps}: all the same\n"))?;
        return Ok(exit::ACCEPTED);
    }
    console::print(&text)?;
    console::print_remark(
        "the recordings differ; if this is intended, run `fosssim-oracle record` and check the change\n",
    );
    Ok(exit::NOT_ACCEPTED)
}

/// Writes all files, each completely or not at all. Unchanged recordings are not written. Recordings that have no scene
/// are removed.
fn write(recordings: &[(String, Recording)], folder: &Path) -> Result<u8> {
    let mut bytes = 0;
    for (stem, recording) in recordings {
        let place = |extension: &str| FilePlace::new(folder, format!("{stem}.{extension}"));
        let packed = recording.pack().with_context(|| format!("cannot compress {}", recording.name))?;
        bytes += packed.len() as u64;
        replace(&place("bin.zst"), &packed)?;
        replace(&place("steps"), recording.digests.as_bytes())?;
    }
    // All files in the folder belong to scenes, so other recordings are outdated.
    for stem in EarlierRecordings(Some(folder)).stems() {
        if !recordings.iter().any(|(known, _)| *known == stem) {
            for extension in ["bin.zst", "steps"] {
                drop(FilePlace::new(folder, format!("{stem}.{extension}")).remove());
            }
        }
    }
    replace(&FilePlace::new(folder, "manifest.txt"), render_manifest(recordings).as_bytes())?;
    let (recordings, bytes) = (format_count(recordings.len() as u64, "recording"), format_count(bytes, "byte"));
    console::print(format!("{recordings}, {bytes}, in {}\n", folder.display()))?;
    Ok(exit::ACCEPTED)
}

/// Returns the text of `manifest.txt`: a line for each recording with its name, steps, bytes and digest.
fn render_manifest(recordings: &[(String, Recording)]) -> String {
    recording::render_manifest(recordings.iter().map(|(_, recording)| recording))
}

fn replace(place: &FilePlace, bytes: &[u8]) -> Result<()> {
    if place.read(bytes.len() as u64).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    output::write_below(place, bytes)
}
