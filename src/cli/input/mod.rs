//! Reads inputs: scenes and traces from files, from standard input, or from the embedded library.
//!
//! No function waits forever: a named pipe without a writer is rejected. Scenes are read completely, and their size is
//! limited. Traces are streams, which are decompressed while they are read.

pub(super) mod pair;
mod scene;
mod trace;

pub(super) use scene::{SceneInput, read_scene};
pub(super) use trace::{TraceInput, is_scene, open_trace, unpack};

use crate::files::open_for_reading;
use crate::{
    report::untrusted_text::to_one_line,
    suite::{library, suggestions},
};
use anyhow::{Result, bail};
use std::{
    fs::{File, Metadata},
    io,
    path::Path,
};

/// Returns the name of a file as the user typed it, in printable form. A file of somebody else may have terminal codes
/// in its name.
pub(super) fn printable_name(name: &Path) -> String {
    to_one_line(&name.display().to_string())
}

/// Returns the part of a name after `asset:`, if the name begins with that.
pub(super) fn asset_name(name: &Path) -> Option<&str> {
    name.to_str()?.strip_prefix("asset:")
}

pub(super) fn describe_missing_asset(what: &str, name: &str) -> String {
    let nearest =
        suggestions::find_nearest(name.strip_suffix(".xml").unwrap_or(name), library::all_names(), 3).join(", ");
    let name = to_one_line(name);
    format!("no embedded {what} is called `{name}`; the nearest are {nearest} (`fosssim-oracle scene list` lists all)")
}

/// Returns the error for a file that does not exist. If an embedded file has this name, the message suggests `asset:`.
fn suggest_asset(name: &Path, error: io::Error) -> anyhow::Error {
    let built_in = name.to_str().map(|name| name.strip_suffix(".xml").unwrap_or(name));
    match built_in.filter(|built_in| {
        error.kind() == io::ErrorKind::NotFound && library::all_names().any(|name| name == *built_in)
    }) {
        Some(built_in) => anyhow::anyhow!("there is no such file; the built-in scene is asset:{built_in}"),
        None => error.into(),
    }
}

/// Opens a file. If it is a pipe, its other end is not waited for. Folders are rejected.
pub(super) fn open(name: &Path) -> Result<(File, Metadata)> {
    let (file, metadata) = open_for_reading(name).map_err(|error| suggest_asset(name, error))?;
    if metadata.is_dir() {
        bail!("this is a folder; name a file in it");
    }
    Ok((file, metadata))
}
