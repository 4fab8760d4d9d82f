//! Reads scenes as inputs. The reader is strict, and reports all problems together.
use super::{asset_name, describe_missing_asset, open, printable_name, trace::ZSTD_MAGIC};
use crate::files::{Identity, read_limited};
use crate::{
    cli::console,
    report::scene_problems,
    scene::{self, LoadedScene, MAX_SCENE_BYTES},
    suite::library,
};
use anyhow::{Context, Result, bail};
use std::path::Path;

/// A scene that has been read.
#[derive(Debug)]
pub(in crate::cli) struct SceneInput {
    /// The name of the scene as the user typed it, in printable form.
    pub(in crate::cli) name: String,
    /// The scene that was read.
    pub(in crate::cli) scene: scene::Scene,
    /// The identity of the scene's file; `None` if it is not a file.
    pub(in crate::cli) identity: Option<Identity>,
}

/// Reads a scene, and prints warnings about it.
///
/// # Errors
///
/// Fails if the scene can't be read or has errors. The message lists all errors with their positions.
pub(in crate::cli) fn read_scene(name: &Path) -> Result<SceneInput> {
    let display_name = printable_name(name);
    if name == Path::new("-") {
        bail!("a scene is read from a file; only a trace may come from standard input");
    }
    let (bytes, identity) = match asset_name(name) {
        Some(asset) => {
            let scene = library::find_scene(asset).with_context(|| describe_missing_asset("scene", asset))?;
            (scene.to_vec(), None)
        }
        None => read_scene_file(name).with_context(|| format!("cannot read the scene {display_name}"))?,
    };
    if is_binary(&bytes) {
        bail!("{display_name} is not a scene but a trace, or other binary data: SCENE comes first, then TRACE");
    }
    match scene::read(&display_name, &bytes) {
        Ok(LoadedScene { scene, warnings, .. }) => {
            // Warnings about embedded scenes would not help the user.
            if identity.is_some() {
                console::print_remark(scene_problems::render_warnings(&display_name, &bytes, &warnings));
            }
            Ok(SceneInput { name: display_name, scene, identity })
        }
        Err(errors) => bail!("{}", scene_problems::render_errors(&display_name, &bytes, &errors)),
    }
}

/// Returns whether the bytes are not text, so that the reader's messages would not help. XML in UTF-8 contains no NUL
/// bytes. XML in UTF-16 does, but it begins with a byte order mark, and the reader has a message of its own about it.
fn is_binary(bytes: &[u8]) -> bool {
    let is_utf_16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
    bytes.starts_with(&ZSTD_MAGIC) || (!is_utf_16 && !bytes.starts_with(b"<") && bytes.contains(&0))
}

/// Returns the content of a scene file. Its size is limited generously.
fn read_scene_file(name: &Path) -> Result<(Vec<u8>, Option<Identity>)> {
    let (file, metadata) = open(name)?;
    let bytes = read_limited(file, &metadata, MAX_SCENE_BYTES as u64)?;
    Ok((bytes, Some(Identity::from_metadata(&metadata))))
}
