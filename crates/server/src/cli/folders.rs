//! The folders and files in the data folder.
use super::arguments::StorageArguments;
use crate::{
    db::{Address, Database},
    store::Store,
};
use anyhow::{Context, Error, Result, anyhow, bail};
use std::{
    fs,
    os::unix::fs::{DirBuilderExt, PermissionsExt},
    path::{Path, PathBuf},
    time::Duration,
};

/// The age after which an unfinished upload or job is removed.
const LEFTOVER_AGE: Duration = Duration::from_secs(24 * 3600);

/// The paths of the service's files and folders in the data folder.
#[derive(Debug, Clone)]
pub(super) struct ServiceFolders {
    /// The data folder, which contains the database and the store. Only the server's user can read it.
    pub(super) data: PathBuf,
    pub(super) incoming: PathBuf,
    pub(super) backups: PathBuf,
    /// The file with the example's flawed program.
    pub(super) flawed_program: PathBuf,
}

impl ServiceFolders {
    /// Finds the data folder of an earlier server, without creating one.
    pub(super) fn find(storage: &StorageArguments) -> Result<Self> {
        if !storage.data.exists() {
            return Err(missing_error("data folder", &storage.data));
        }
        Self::find_database(storage)
    }

    /// Finds the folder of the database, for commands that need nothing else from it.
    pub(super) fn find_database(storage: &StorageArguments) -> Result<Self> {
        if storage.database.is_none() && !storage.data.exists() {
            return Err(missing_error("data folder", &storage.data));
        }
        match database_address_in(storage, &storage.data) {
            Address::Sqlite(file) if !file.is_file() => Err(missing_error("database", &file)),
            _ => Self::open(storage),
        }
    }

    /// Creates the data folder, or checks that it can be written. Logs a warning if other users can access it.
    pub(super) fn open(storage: &StorageArguments) -> Result<Self> {
        let data = std::path::absolute(&storage.data)?;
        let data = data.as_path();
        if !data.exists() {
            fs::DirBuilder::new()
                .recursive(true)
                .mode(0o700)
                .create(data)
                .with_context(|| format!("cannot create the folder {}", data.display()))?;
        }
        let metadata = fs::metadata(data).with_context(|| format!("cannot read {}", data.display()))?;
        if !metadata.is_dir() {
            bail!("{} must be a folder; choose the server's folder with --data", data.display());
        }
        tempfile::tempfile_in(data)
            .with_context(|| format!("cannot write in {}; choose the server's folder with --data", data.display()))?;
        let mode = metadata.permissions().mode();
        if mode & 0o077 != 0 {
            tracing::warn!(folder = %data.display(), "other users can read the data folder; run chmod 700 on it");
        }
        Ok(Self {
            incoming: data.join("incoming"),
            backups: data.join("backups"),
            flawed_program: data.join("flawed-program"),
            data: data.to_owned(),
        })
    }

    /// Opens the store that the options name, or the one in the data folder.
    pub(super) fn store(&self, storage: &StorageArguments) -> Result<Store> {
        match &storage.store {
            Some(address) => Store::bucket(address).with_context(|| format!("store {address}")),
            None => Ok(Store::folder(&self.data.join("store"))?),
        }
    }

    /// Creates the folders of uploads and jobs, and removes old leftovers of killed servers and workers.
    pub(super) fn clear(&self) -> Result<()> {
        for folder in [self.incoming.clone(), self.data.join("work")] {
            fs::create_dir_all(&folder).with_context(|| format!("cannot create the folder {}", folder.display()))?;
            for entry in fs::read_dir(&folder)?.flatten() {
                let modified = entry.metadata().and_then(|data| data.modified());
                if modified.is_ok_and(|written| written.elapsed().is_ok_and(|age| age > LEFTOVER_AGE)) {
                    drop(fs::remove_file(entry.path()).or_else(|_| fs::remove_dir_all(entry.path())));
                }
            }
        }
        Ok(())
    }

    pub(super) fn work_folder(&self, worker: &str) -> PathBuf {
        self.data.join("work").join(worker)
    }

    /// Opens the database that the options name, or the one in the data folder.
    pub(super) async fn open_database(&self, storage: &StorageArguments) -> Result<(Database, Address)> {
        let address = self.database_address(storage);
        let database = Database::open(&address).await.with_context(|| format!("database {address}"))?;
        Ok((database, address))
    }

    /// Returns the URL of the database that the options name, or the one in the data folder.
    pub(super) fn database_address(&self, storage: &StorageArguments) -> Address {
        database_address_in(storage, &self.data)
    }
}

fn database_address_in(storage: &StorageArguments, data: &Path) -> Address {
    storage.database.clone().unwrap_or_else(|| Address::Sqlite(data.join("fosssim.db")))
}

fn missing_error(what: &str, path: &Path) -> Error {
    anyhow!("there is no {what} {}; start the server once, or choose its folder with --data", path.display())
}
