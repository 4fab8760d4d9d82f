//! The commands `backup` and `restore`, which copy all data of the server into a folder with a manifest, and back from
//! it. The database is copied first, because an artifact is in the store before the database refers to it.
mod manifest;
mod postgres;
mod restore;

pub(super) use restore::restore;

use super::{arguments::BackupArguments, folders::ServiceFolders};
use crate::{
    db::{self, Address, Database},
    store::{Store, digest_of_file},
};
use anyhow::{Context, Result, bail};
use futures_util::TryStreamExt;
use manifest::{Artifacts, DatabaseCopy, Manifest};
use std::{
    fs,
    os::unix::fs::DirBuilderExt,
    path::{Path, PathBuf},
};

/// The name of a SQLite database's copy.
const SQLITE_COPY: &str = "fosssim.db";
const POSTGRES_COPY: &str = "fosssim.dump";

/// Copies all data into a new folder, while the server runs.
pub(super) async fn backup(arguments: &BackupArguments) -> Result<()> {
    let (folders, output) = (ServiceFolders::find(&arguments.storage)?, &arguments.output);
    if output.exists() {
        bail!("{} already exists; choose a new folder", output.display());
    }
    let (database, address) = folders.open_database(&arguments.storage).await?;
    let store = folders.store(&arguments.storage)?;
    // The folder gets its final name when it is complete.
    let partial = PathBuf::from(format!("{}.partial-{}", output.display(), std::process::id()));
    let error = || format!("cannot create the folder {}", partial.display());
    fs::DirBuilder::new().mode(0o700).create(&partial).with_context(error)?;
    let manifest = write_backup(&partial, &database, &store, &address).await;
    database.close().await;
    let manifest = manifest.inspect_err(|_| drop(fs::remove_dir_all(&partial)))?;
    fs::rename(&partial, output).with_context(|| format!("cannot rename {}", partial.display()))?;
    let Artifacts { count, bytes } = manifest.artifacts;
    let tables = manifest.tables;
    let (path, size) = (output.display(), crate::problem::format_size(bytes));
    println!("{path}: the database (tables of version {tables}) and {count} artifacts ({size})");
    Ok(())
}

async fn write_backup(folder: &Path, database: &Database, store: &Store, address: &Address) -> Result<Manifest> {
    let tables = db::read_version(database).await?;
    if tables == 0 {
        bail!("the database {address} is empty");
    }
    let name = match address {
        Address::Sqlite(_) => SQLITE_COPY,
        Address::Postgres(_) => POSTGRES_COPY,
    };
    let file = folder.join(name);
    match address {
        Address::Sqlite(_) => database.copy_to(&file).await.context("cannot copy the database")?,
        Address::Postgres(url) => postgres::dump(url, &file).await?,
    }
    let artifacts = copy_artifacts(store, &folder.join("store")).await?;
    let copy = digest_of_file(&file).await?;
    let manifest = Manifest {
        schema: manifest::SCHEMA,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        tables,
        database: DatabaseCopy { file: name.to_owned(), sha256: copy.digest, bytes: copy.size },
        artifacts,
    };
    // All files are written to the disk before the manifest.
    rustix::fs::syncfs(fs::File::open(folder)?)?;
    manifest.write(folder)?;
    rustix::fs::syncfs(fs::File::open(folder)?)?;
    Ok(manifest)
}

/// Copies all artifacts of the store into the backup's `store` folder, which has the layout of a store.
async fn copy_artifacts(store: &Store, folder: &Path) -> Result<Artifacts> {
    let mut total = Artifacts::default();
    fs::create_dir_all(folder)?;
    let mut digests = store.digests();
    while let Some(digest) = digests.try_next().await? {
        let (first, rest) = digest.as_str().split_at(2);
        let subfolder = folder.join("sha256").join(first);
        fs::create_dir_all(&subfolder)?;
        let file = subfolder.join(rest);
        match store.fetch(&digest, &file).await {
            Ok(()) => {}
            // Nothing refers to this artifact: it was removed in the meantime, or was listed twice because a cleanup
            // moved it to the trash.
            Err(crate::store::StoreError::Missing(_)) => continue,
            Err(_) if file.exists() => continue,
            Err(error) => return Err(error.into()),
        }
        total.count += 1;
        total.bytes += fs::metadata(&file)?.len();
    }
    Ok(total)
}
