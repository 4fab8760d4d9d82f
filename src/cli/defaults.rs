//! The defaults for the options of `grade`. They are in the file `fosssim.toml` in the working folder, or in the
//! nearest folder above it.
use crate::files::{FileError, FilePlace};
use anyhow::{Context, Result};
use clap::Command;
use serde::Deserialize;
use std::{fs, os::unix::fs::MetadataExt, path::Path};

const DEFAULTS_FILE: &str = "fosssim.toml";

/// The maximum size of the file, in bytes.
const MAX_BYTES: u64 = 1 << 16;

/// The contents of the file. Paths in it are relative to the file's folder.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Defaults {
    suite: Option<String>,
    output: Option<String>,
    hints: Option<String>,
    jobs: Option<u16>,
}

/// Sets the defaults of `grade` to those that the file for a working folder contains. Options that the user types have
/// precedence.
///
/// # Errors
///
/// Fails if the file can't be read, or if its contents are invalid.
pub(super) fn add_defaults(command: Command, working: &Path) -> Result<Command> {
    for folder in working.ancestors() {
        let text = match FilePlace::new(folder, DEFAULTS_FILE).read(MAX_BYTES) {
            Ok(text) => text,
            Err(FileError::Missing { .. }) => continue,
            Err(error) => {
                return Err(error).with_context(|| format!("cannot read {}", folder.join(DEFAULTS_FILE).display()));
            }
        };
        if !is_trusted(&folder.join(DEFAULTS_FILE)) {
            continue;
        }
        let context =
            || format!("{} may contain only suite, output, hints and jobs", folder.join(DEFAULTS_FILE).display());
        let read: Defaults = toml::from_str(&String::from_utf8_lossy(&text)).with_context(context)?;
        let below = |name: &String| {
            let path = if folder == working { name.into() } else { folder.join(name) };
            path.to_string_lossy().into_owned()
        };
        let is_file = |suite: &String| folder.join(suite).is_file();
        let suite = read.suite.map(|suite| if is_file(&suite) { below(&suite) } else { suite });
        let jobs = read.jobs.map(|jobs| jobs.to_string());
        let output = read.output.as_ref().map(below);
        let all = [("suite", suite), ("output", output), ("hints", read.hints), ("jobs", jobs)];
        return Ok(command.mut_subcommand("grade", |grade| {
            let settings = all.into_iter().filter_map(|(name, value)| Some((name, value?)));
            // The value is never freed, because help texts must exist as long as the program runs.
            settings.fold(grade, |grade, (name, value)| grade.mut_arg(name, |arg| arg.default_value(&*value.leak())))
        }));
    }
    Ok(command)
}

/// Returns whether a file belongs to this user or to the system. In a folder into which all users may write, another
/// user may have written it.
fn is_trusted(file: &Path) -> bool {
    let owner = |path: &Path| fs::metadata(path).map(|data| data.uid()).ok();
    let found = owner(file);
    found.is_some() && (found == Some(0) || found == owner(Path::new("/proc/self")))
}
