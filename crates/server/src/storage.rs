//! Checks whether the server can still write, and whether it has space for more.
//!
//! A database that answers reads may be unable to write, for example because the disk is full or a folder became
//! read-only. Therefore [`Storage::check_writable`] writes to the database and to the store, and
//! [`Storage::ensure_disk_space`] rejects uploads before the disk is full, so that accepted ones can still be graded.
use crate::{
    db::{self, Database, DbError},
    problem::Problem,
    store::Store,
    values,
};
use rustix::fs::statvfs;
use std::{
    path::PathBuf,
    time::{Duration, Instant},
};
use tokio::sync::Mutex;

/// The time for which the result of a check is reused, so that frequent requests of monitors cost only one write.
const CHECK_LIFETIME: Duration = Duration::from_secs(2);

/// The maximum duration of a check. Monitors wait for five seconds.
const CHECK_TIMEOUT: Duration = Duration::from_secs(3);

/// The database, the store and the disk, with checks that they can be written.
#[derive(Debug)]
pub struct Storage {
    database: Database,
    store: Store,
    /// The folder of incoming uploads, on the disk whose free space is checked.
    incoming: PathBuf,
    /// The number of free bytes on the disk below which uploads are rejected.
    low_water: u64,
    /// The time of the last check, and the part that could not be written; `None` if all could be written.
    last: Mutex<Option<(Instant, Option<&'static str>)>>,
}

impl Storage {
    /// Creates storage that rejects uploads if fewer than `low_water` bytes are free.
    pub fn new(database: Database, store: Store, incoming: PathBuf, low_water: u64) -> Self {
        Self { database, store, incoming, low_water, last: Mutex::default() }
    }

    /// Checks that the database and the store can be written, by writing to both.
    ///
    /// # Errors
    ///
    /// Fails with status 503 if one of them can't be written. The message names it.
    pub async fn check_writable(&self) -> Result<(), Problem> {
        let checked = tokio::time::timeout(CHECK_TIMEOUT, self.check_writable_now()).await;
        checked.unwrap_or_else(|_| Err(Problem::unavailable("the database or the store did not answer in time")))
    }

    async fn check_writable_now(&self) -> Result<(), Problem> {
        let mut last = self.last.lock().await;
        let recent = last.filter(|(at, _)| at.elapsed() < CHECK_LIFETIME);
        let fault = match recent {
            Some((_, fault)) => fault,
            None => {
                let fault = self.find_fault().await;
                *last = Some((Instant::now(), fault));
                fault
            }
        };
        fault.map_or(Ok(()), |fault| Err(Problem::unavailable(fault)))
    }

    async fn find_fault(&self) -> Option<&'static str> {
        match db::read_version(&self.database).await {
            Ok(db::NEWEST) => {}
            Ok(_) => return Some("the tables belong to another version"),
            Err(error) => {
                tracing::error!(%error, "the database does not answer");
                return Some("the database does not answer");
            }
        }
        if let Err(error) = self.write_to_database().await {
            tracing::error!(%error, "the database can't be written");
            return Some("the database can't be written");
        }
        if let Err(error) = self.store.check_writable().await {
            tracing::error!(%error, "the store of files can't be written");
            return Some("the store of files can't be written");
        }
        None
    }

    async fn write_to_database(&self) -> Result<(), DbError> {
        let mut transaction = self.database.begin().await?;
        // The row gets the value that it already has, but the commit must still write it.
        transaction.execute("UPDATE pulse SET beat_at = beat_at WHERE id = 1", values![]).await?;
        transaction.commit().await
    }

    /// Returns the free bytes and the size of the disk with the data folder; `None` if the disk does not report them.
    pub fn disk_space(&self) -> Option<(u64, u64)> {
        let disk = statvfs(&self.incoming).ok()?;
        Some((disk.f_bavail.saturating_mul(disk.f_frsize), disk.f_blocks.saturating_mul(disk.f_frsize)))
    }

    /// Checks that the disk has space for an upload.
    ///
    /// # Errors
    ///
    /// Fails with status 507 if fewer bytes are free than the low-water mark requires.
    pub fn ensure_disk_space(&self) -> Result<(), Problem> {
        // If a disk does not report its free space, uploads are accepted.
        if self.disk_space().is_some_and(|(free, _)| free < self.low_water) {
            tracing::error!(low_water = self.low_water, "uploads are rejected: the disk is nearly full");
            return Err(Problem::no_room());
        }
        Ok(())
    }
}
