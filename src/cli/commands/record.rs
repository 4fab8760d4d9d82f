//! `record`: the recordings of a folder of scenes.
use crate::{
    cli::{arguments::Record, console, exit, output},
    report::number::counted,
    suite::{
        library,
        recording::{self, Recording},
    },
};
use anyhow::{Context, Result, bail};
use std::{
    fs, io,
    path::{Path, PathBuf},
};

pub(super) fn run(arguments: &Record) -> Result<u8> {
    // Whoever names a folder means that folder.
    let defaults = arguments.assets == Path::new("assets") && arguments.references == Path::new("references");
    let embedded = arguments.check && defaults && !arguments.assets.is_dir();
    let scenes = if embedded {
        library::names().filter_map(|name| Some((name.to_owned(), library::scene(name)?.to_vec()))).collect()
    } else {
        scenes(&arguments.assets)?
    };
    let mut recordings = Vec::new();
    for (name, xml) in scenes {
        recordings.push(Recording::of(&name, &xml).with_context(|| format!("cannot record {name}"))?);
    }
    let old: Box<dyn Old> = if embedded { Box::new(Embedded) } else { Box::new(Folder(arguments.references.clone())) };
    if arguments.check { check(&recordings, old.as_ref()) } else { write(&recordings, &arguments.references) }
}

/// The scenes of a folder by name, in alphabetical order.
fn scenes(folder: &Path) -> Result<Vec<(String, Vec<u8>)>> {
    let mut scenes = Vec::new();
    let shown = folder.display();
    let groups = fs::read_dir(folder).with_context(|| {
        format!("cannot read the scenes in {shown}; run this in the checkout, or name a folder with --assets")
    })?;
    for group in groups {
        let group = group?.path();
        if !group.is_dir() {
            continue;
        }
        for file in fs::read_dir(&group)? {
            let file = file?.path();
            let name = file.strip_prefix(folder).ok().and_then(Path::to_str).and_then(|name| name.strip_suffix(".xml"));
            if let Some(name) = name {
                let xml = fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
                scenes.push((name.to_owned(), xml));
            }
        }
    }
    if scenes.is_empty() {
        bail!("there is no scene in {shown}; scenes are called {shown}/<Group>/<name>.xml");
    }
    scenes.sort();
    Ok(scenes)
}

/// What was recorded before.
trait Old {
    fn file(&self, name: &str) -> io::Result<Option<Vec<u8>>>;
    fn names(&self) -> Vec<String>;
}

struct Embedded;

impl Old for Embedded {
    fn file(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
        Ok(library::reference(name).map(<[u8]>::to_vec))
    }

    fn names(&self) -> Vec<String> {
        library::recordings().map(str::to_owned).collect()
    }
}

struct Folder(PathBuf);

impl Old for Folder {
    fn file(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
        match fs::read(self.0.join(name)) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn names(&self) -> Vec<String> {
        let groups = fs::read_dir(&self.0).into_iter().flatten().flatten();
        let files = groups.filter_map(|group| fs::read_dir(group.path()).ok()).flatten().flatten();
        let mut names: Vec<_> = files
            .filter_map(|file| {
                Some(file.path().strip_prefix(&self.0).ok()?.to_str()?.strip_suffix(".bin.zst")?.to_owned())
            })
            .collect();
        names.sort();
        names
    }
}

/// Compares with what was recorded before, byte for byte.
fn check(recordings: &[Recording], old: &dyn Old) -> Result<u8> {
    let mut text = String::new();
    for recording in recordings {
        let name = &recording.name;
        let (packed, steps) = (old.file(&format!("{name}.bin.zst"))?, old.file(&format!("{name}.steps"))?);
        text += &recording.difference(packed.as_deref(), steps.as_deref()).unwrap_or_default();
    }
    for name in old.names() {
        if !recordings.iter().any(|recording| recording.name == name) {
            text += &format!("{name}: there is a recording, but no scene\n");
        }
    }
    let manifest = old.file("manifest.txt")?.unwrap_or_default();
    text += &recording::diff("manifest.txt", &String::from_utf8_lossy(&manifest), &recording::manifest(recordings));
    if text.is_empty() {
        let steps = recordings.iter().map(|recording| u64::from(recording.steps)).sum();
        let (recordings, steps) = (counted(recordings.len() as u64, "recording"), counted(steps, "step"));
        console::print(format!("{recordings}, {steps}: all the same\n").as_bytes())?;
        return Ok(exit::ACCEPTED);
    }
    console::print(text.as_bytes())?;
    console::remark(b"the recordings differ; if that is meant, run `fosssim-oracle record` and look at the change\n");
    Ok(exit::NOT_ACCEPTED)
}

/// Writes all files; each appears whole. Recordings that are the same already are left alone, those without a scene are
/// removed.
fn write(recordings: &[Recording], folder: &Path) -> Result<u8> {
    let mut bytes = 0;
    for recording in recordings {
        let path = |extension: &str| folder.join(format!("{}.{extension}", recording.name));
        let packed = recording.packed().with_context(|| format!("cannot compress {}", recording.name))?;
        bytes += packed.len() as u64;
        if let Some(parent) = path("steps").parent() {
            fs::create_dir_all(parent).with_context(|| format!("cannot make the folder {}", parent.display()))?;
        }
        replace(&path("bin.zst"), &packed)?;
        replace(&path("steps"), recording.digests.as_bytes())?;
    }
    // The folder holds what the scenes give and nothing else.
    for name in Folder(folder.to_owned()).names() {
        if !recordings.iter().any(|recording| recording.name == name) {
            for extension in ["bin.zst", "steps"] {
                drop(fs::remove_file(folder.join(format!("{name}.{extension}"))));
            }
        }
    }
    replace(&folder.join("manifest.txt"), recording::manifest(recordings).as_bytes())?;
    let (recordings, bytes) = (counted(recordings.len() as u64, "recording"), counted(bytes, "byte"));
    let line = format!("{recordings}, {bytes}, in {}\n", folder.display());
    console::print(line.as_bytes())?;
    Ok(exit::ACCEPTED)
}

fn replace(path: &Path, bytes: &[u8]) -> Result<()> {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    output::write(path, &[], bytes)
}
