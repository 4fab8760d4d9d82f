//! The command `restore`, which turns a backup into a data folder. The database is restored last, so that a server that
//! is started too early finds no database rather than an incomplete one.
use super::{
    super::{arguments::RestoreArguments, folders::ServiceFolders},
    manifest::{Artifacts, Manifest},
    postgres,
};
use crate::{
    db::{self, Address, Database},
    store::{Store, digest_of_file},
};
use anyhow::{Context, Result, bail};
use std::{
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};

/// Restores a backup into an empty data folder and, for PostgreSQL, an empty database.
pub(in crate::cli) async fn restore(arguments: &RestoreArguments) -> Result<()> {
    let (storage, from) = (&arguments.storage, arguments.backup.as_path());
    let manifest = Manifest::read(from)?;
    if manifest.tables > db::NEWEST {
        bail!(
            "the backup's tables have version {}, but this program reads versions up to {}: restore it with version {}",
            manifest.tables,
            db::NEWEST,
            manifest.version
        );
    }
    let copy = from.join(&manifest.database.file);
    let found = digest_of_file(&copy).await.with_context(|| copy.display().to_string())?;
    if found.digest != manifest.database.sha256 {
        bail!("{} is damaged: its digest is not the one in the manifest", copy.display());
    }
    if storage.data.exists() && fs::read_dir(&storage.data)?.next().is_some() {
        bail!("{} is not empty; a backup needs an empty data folder", storage.data.display());
    }
    let restored = restore_into(arguments, &manifest, &copy).await;
    if restored.is_err() {
        // The data folder was empty before, and an incomplete one is useless.
        drop(fs::remove_dir_all(&storage.data));
    }
    restored
}

/// Copies the artifacts and the database of a backup into an empty data folder.
async fn restore_into(arguments: &RestoreArguments, manifest: &Manifest, copy: &Path) -> Result<()> {
    let (storage, from) = (&arguments.storage, arguments.backup.as_path());
    let folders = ServiceFolders::open(storage)?;
    let address = folders.database_address(storage);
    let is_dump = manifest.database.file == super::POSTGRES_COPY;
    match (&address, is_dump) {
        (Address::Sqlite(file), false) if file.exists() => bail!("the database {} already exists", file.display()),
        (Address::Postgres(_), true) => {
            let database = Database::open(&address).await.with_context(|| format!("database {address}"))?;
            let version = db::read_version(&database).await?;
            database.close().await;
            if version > 0 {
                bail!("the database {address} is not empty; restore into a new one");
            }
        }
        (Address::Sqlite(_), false) => {}
        (_, true) => bail!("the backup is from PostgreSQL; name an empty database in FOSSSIM_DATABASE"),
        (_, false) => bail!("the backup is from SQLite; leave out the database's address"),
    }
    let store = folders.store(storage)?;
    let restored = put_artifacts(&store, &from.join("store").join("sha256")).await?;
    if restored != manifest.artifacts {
        bail!(
            "the backup is damaged: it has {} artifacts of {} bytes instead of {} of {}",
            restored.count,
            restored.bytes,
            manifest.artifacts.count,
            manifest.artifacts.bytes
        );
    }
    match &address {
        Address::Sqlite(file) => copy_database(copy, file)?,
        Address::Postgres(url) => postgres::load(url, copy).await?,
    }
    let tables = match manifest.tables {
        db::NEWEST => "of this version".to_owned(),
        older => format!("of version {older}; the server updates them to {} when it starts", db::NEWEST),
    };
    println!("{}: the database (tables {tables}) and {} artifacts", storage.data.display(), restored.count);
    Ok(())
}

/// Copies the database to `file` with mode 600, by renaming a temporary file.
fn copy_database(copy: &Path, file: &Path) -> Result<()> {
    let partial = PathBuf::from(format!("{}.partial", file.display()));
    fs::copy(copy, &partial).with_context(|| format!("cannot write {}", partial.display()))?;
    fs::set_permissions(&partial, fs::Permissions::from_mode(0o600))?;
    fs::File::open(&partial)?.sync_all()?;
    Ok(fs::rename(&partial, file)?)
}

/// Stores all files of a folder of artifacts. The digest of each file's bytes must be its name.
async fn put_artifacts(store: &Store, folder: &Path) -> Result<Artifacts> {
    let mut total = Artifacts::default();
    if !folder.exists() {
        return Ok(total);
    }
    for first in fs::read_dir(folder)? {
        let first = first?;
        for rest in fs::read_dir(first.path())? {
            let file = rest?;
            let name = [first.file_name(), file.file_name()].map(|part| part.to_string_lossy().into_owned()).concat();
            let stored = store.put_file(&file.path()).await?;
            if stored.digest.as_str() != name {
                bail!("{} is damaged: its bytes do not match its name", file.path().display());
            }
            total.count += 1;
            total.bytes += stored.size;
        }
    }
    Ok(total)
}
