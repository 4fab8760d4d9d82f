//! `upgrade`: what a newer program would change in the tables, and that change with a backup before. Starting the
//! server does the same, but for PostgreSQL's backup.
use super::{arguments::Upgrade, backup, folders::ServiceFolders};
use crate::db;
use anyhow::{Context, Result, bail};
use std::time::{SystemTime, UNIX_EPOCH};

/// Whether the tables are up to date (now).
pub(super) async fn run(arguments: &Upgrade) -> Result<bool> {
    let folders = ServiceFolders::find_database(&arguments.place)?;
    let (database, address) = folders.open_database(&arguments.place).await?;
    let version = db::version(&database).await?;
    if version > db::LATEST {
        bail!(
            "the tables of {address} have version {version}, this program knows versions up to {}: use the newer \
            program",
            db::LATEST
        );
    }
    let missing = db::changes_after(version);
    if missing.is_empty() {
        println!("the tables of {address} are of this version, {version}: nothing to do");
        database.close().await;
        return Ok(true);
    }
    println!("the tables of {address} have version {version}, this program's have {}; to come:", db::LATEST);
    for (number, name) in missing {
        println!("  {number} {name}");
    }
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |now| now.as_secs());
    let copy = folders.backups.join(format!("version-{version}-{now}"));
    if arguments.check {
        println!("`fosssim-server upgrade` copies everything to {} before", copy.display());
        database.close().await;
        return Ok(false);
    }
    if version > 0 {
        std::fs::create_dir_all(folders.backups.clone())?;
        backup::make(&folders.store(&arguments.place)?, &address, &copy).await.context("the backup before")?;
        println!("copied to {}", copy.display());
    }
    db::migrate(&database).await?;
    database.close().await;
    println!("the tables are of version {}", db::LATEST);
    Ok(true)
}
