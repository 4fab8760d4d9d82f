//! `backup` and `restore`: everything that the server keeps, in a folder that says what it holds. The database is
//! copied first: what it names lies in the store before it is named.
mod manifest;
mod postgres;
mod restore;

pub(super) use restore::restore;

use super::{arguments::Backup, folders::ServiceFolders};
use crate::{
    db::{self, Address, Database},
    store::{Digest, Store, digest_of_file},
    values,
};
use anyhow::{Context, Result, bail};
use futures_util::TryStreamExt;
use manifest::{Artefacts, Copy, Manifest};
use std::{
    fs,
    os::unix::fs::DirBuilderExt,
    path::{Path, PathBuf},
};

/// The name of the database's copy, by engine.
const SQLITE: &str = "fosssim.db";
const POSTGRES: &str = "fosssim.dump";

/// Rows that are looked at at one time.
const PAGE: i64 = 5000;

/// Copies everything into a new folder, while the server runs.
pub(super) async fn backup(arguments: &Backup) -> Result<bool> {
    let folders = ServiceFolders::find(&arguments.place)?;
    let address = folders.database(&arguments.place);
    let made = make(&folders.store(&arguments.place)?, &address, &arguments.output).await?;
    let Artefacts { count, bytes } = made.0.artefacts;
    println!(
        "{}: the database (tables of version {}) and {count} artefacts of {bytes} bytes",
        arguments.output.display(),
        made.0.tables
    );
    tell_missing(&made.1);
    Ok(made.1.is_empty())
}

/// Says which artefacts are named and not there.
fn tell_missing(missing: &[Digest]) {
    for digest in missing.iter().take(10) {
        eprintln!("missing: the database names the artefact {digest}, and the store has none");
    }
    if missing.len() > 10 {
        eprintln!("missing: {} artefacts in all", missing.len());
    }
}

/// Makes a backup, and returns what it holds, and what the database names that the store has not.
pub(super) async fn make(store: &Store, address: &Address, output: &Path) -> Result<(Manifest, Vec<Digest>)> {
    if let Address::Sqlite(file) = address
        && !file.is_file()
    {
        bail!("there is no database {}", file.display());
    }
    if output.exists() {
        bail!("{} is there already: a backup is a new folder", output.display());
    }
    let database = Database::open(address).await.with_context(|| format!("database {address}"))?;
    let tables = db::version(&database).await?;
    if tables == 0 {
        bail!("the database {address} is empty");
    }
    // It has its name when it is complete.
    let partial = PathBuf::from(format!("{}.partial-{}", output.display(), std::process::id()));
    fs::DirBuilder::new().mode(0o700).create(&partial).with_context(|| format!("cannot make {}", partial.display()))?;
    let made = fill(&partial, &database, store, address, tables).await;
    database.close().await;
    let made = match made {
        Ok(made) => made,
        Err(error) => {
            drop(fs::remove_dir_all(&partial));
            return Err(error);
        }
    };
    fs::rename(&partial, output).with_context(|| format!("cannot rename {}", partial.display()))?;
    Ok(made)
}

async fn fill(
    folder: &Path,
    database: &Database,
    store: &Store,
    address: &Address,
    tables: i64,
) -> Result<(Manifest, Vec<Digest>)> {
    let name = match address {
        Address::Sqlite(_) => SQLITE,
        Address::Postgres(_) => POSTGRES,
    };
    let file = folder.join(name);
    match address {
        Address::Sqlite(_) => database.copy_to(&file).await.context("the copy of the database")?,
        Address::Postgres(url) => postgres::dump(url, &file).await?,
    }
    let artefacts = copy_artefacts(store, &folder.join("store")).await?;
    let missing = match address {
        // The copy is a database of its own; another engine's is looked at when it is restored.
        Address::Sqlite(_) => {
            let copied = Database::open(&Address::Sqlite(file.clone())).await?;
            let missing = missing(&copied, &Store::folder(&folder.join("store"))?).await?;
            copied.close().await;
            missing
        }
        Address::Postgres(_) => Vec::new(),
    };
    // Opened, a copy of SQLite's is not the same bytes any more.
    let copy = digest_of_file(&file).await?;
    let manifest = Manifest {
        schema: manifest::SCHEMA,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        tables,
        database: Copy { file: name.to_owned(), sha256: copy.digest, bytes: copy.size },
        artefacts,
    };
    // Everything is on the disk before the manifest says so.
    rustix::fs::syncfs(fs::File::open(folder)?)?;
    manifest.write(folder)?;
    rustix::fs::syncfs(fs::File::open(folder)?)?;
    Ok((manifest, missing))
}

/// Copies the store's artefacts into a folder that is a store of its own.
async fn copy_artefacts(store: &Store, folder: &Path) -> Result<Artefacts> {
    let mut copied = Artefacts::default();
    fs::create_dir_all(folder)?;
    let mut digests = store.digests();
    while let Some(digest) = digests.try_next().await? {
        let (first, rest) = digest.as_str().split_at(2);
        let place = folder.join("sha256").join(first);
        fs::create_dir_all(&place)?;
        let file = place.join(rest);
        match store.fetch(&digest, &file).await {
            Ok(()) => {}
            // Given up meanwhile: nothing names it. Or it is there twice, as what is put aside may be.
            Err(crate::store::StoreError::Missing(_)) => continue,
            Err(_) if file.exists() => continue,
            Err(error) => return Err(error.into()),
        }
        copied.count += 1;
        copied.bytes += fs::metadata(&file)?.len();
    }
    Ok(copied)
}

/// The artefacts that a database names and a store has not.
async fn missing(database: &Database, store: &Store) -> Result<Vec<Digest>> {
    let mut missing = Vec::new();
    for (most, statement) in [
        (
            "SELECT coalesce(max(id), 0) AS n FROM submission",
            "SELECT digest FROM submission WHERE removed_at IS NULL AND id > ? AND id <= ?",
        ),
        (
            "SELECT coalesce(max(result), 0) AS n FROM result_file",
            "SELECT result_file.digest FROM result_file JOIN result ON result.id = result_file.result
             JOIN submission ON submission.id = result.submission
             WHERE submission.removed_at IS NULL AND result_file.result > ? AND result_file.result <= ?",
        ),
    ] {
        let mut transaction = database.read().await?;
        let most = transaction.one(most, values![]).await?.int("n")?;
        let mut after = 0;
        while after < most {
            for row in transaction.rows(statement, values![after, after + PAGE]).await? {
                let text = row.text("digest")?;
                if let Ok(digest) = text.parse::<Digest>()
                    && !store.has(&digest).await?
                {
                    missing.push(digest);
                }
            }
            after += PAGE;
        }
    }
    Ok(missing)
}
