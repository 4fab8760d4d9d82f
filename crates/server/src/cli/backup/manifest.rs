//! The list of a backup's contents.
use crate::store::Digest;
use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use std::{fs, path::Path};

/// The version of the format of backups.
pub(super) const SCHEMA: u32 = 1;

/// The name of the manifest's file in a backup's folder.
const MANIFEST_FILE: &str = "backup.json";

/// The manifest: the versions that a backup needs, and the files that it contains.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Manifest {
    /// The version of the backup's format.
    pub(super) schema: u32,
    /// The version of fosssim-server that made the backup.
    pub(super) version: String,
    /// The version of the database's tables.
    pub(super) tables: i64,
    pub(super) database: DatabaseCopy,
    pub(super) artifacts: Artifacts,
}

/// The copy of the database, as one file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct DatabaseCopy {
    /// The name of the copy's file in the backup's folder.
    pub(super) file: String,
    pub(super) sha256: Digest,
    pub(super) bytes: u64,
}

/// The files of the store. The name of each file is its digest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Artifacts {
    pub(super) count: u64,
    pub(super) bytes: u64,
}

impl Manifest {
    /// Writes the manifest into a backup's folder.
    pub(super) fn write(&self, folder: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self)? + "\n";
        fs::write(folder.join(MANIFEST_FILE), text).context("cannot write the backup's manifest")
    }

    /// Reads the manifest of a backup.
    ///
    /// # Errors
    ///
    /// Fails if the folder is not a backup, or was made by a newer program.
    pub(super) fn read(folder: &Path) -> Result<Self> {
        let file = folder.join(MANIFEST_FILE);
        let text = fs::read_to_string(&file)
            .with_context(|| format!("{} is not a complete backup: it has no {MANIFEST_FILE}", folder.display()))?;
        let json: serde_json::Value = serde_json::from_str(&text).with_context(|| file.display().to_string())?;
        let schema = json["schema"].as_u64().unwrap_or_default();
        if schema > u64::from(SCHEMA) {
            let version = json["version"].as_str().unwrap_or("unknown");
            bail!("the backup has format {schema}, but this program reads up to {SCHEMA}: use version {version}");
        }
        serde_json::from_value(json).with_context(|| format!("{} is not a valid manifest", file.display()))
    }
}
