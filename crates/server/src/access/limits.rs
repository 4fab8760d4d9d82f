//! The shares of one account, one course, and all together in the server: transfers at one time, and bytes that are
//! kept.
use super::{
    Member,
    key_limit::{KeyLimit, Permit},
};
use crate::{db::Transaction, problem::Problem, values};
use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

/// Up- and downloads of all accounts at one time: each takes a connection, a file and some 100 KiB.
const TRANSFERS: usize = 3000;

/// A mebibyte.
const MIB: u64 = 1 << 20;

/// The limits, and what is being done at the moment.
#[derive(Debug, Default)]
pub struct TransferLimits {
    /// Up- and downloads, followed submissions included, of one account at one time.
    pub transfers: usize,
    /// Bytes of uploads and their reports that are kept: of one person, of one course, of all. 0 for any number.
    pub student: u64,
    /// Of one course.
    pub course: u64,
    /// Of the server.
    pub server: u64,
    by_account: KeyLimit<i64>,
    of_all: KeyLimit<()>,
    turns: Mutex<HashMap<i64, Arc<tokio::sync::Mutex<()>>>>,
}

/// Leave to transfer something, until it is dropped.
#[derive(Debug)]
pub struct Transfer {
    _of_account: Permit<i64>,
    _of_all: Permit<()>,
}

impl TransferLimits {
    /// Limits of these sizes.
    pub fn new(transfers: usize, student: u64, course: u64, server: u64) -> Self {
        Self { transfers, student, course, server, ..Self::default() }
    }

    fn transfer(&self, account: i64) -> Result<Transfer, Problem> {
        let Some(of_account) = self.by_account.pass(account, self.transfers) else {
            let most = self.transfers;
            return Err(Problem::too_many(format!("an account may have {most} up- and downloads at one time")));
        };
        let Some(of_all) = self.of_all.pass((), TRANSFERS) else {
            return Err(Problem::unavailable("too many up- and downloads are under way"));
        };
        Ok(Transfer { _of_account: of_account, _of_all: of_all })
    }

    /// Waits until nobody else hands in for an account by this server.
    pub(super) async fn turn(&self, account: i64) -> tokio::sync::OwnedMutexGuard<()> {
        let turn = {
            let mut turns = self.turns.lock().unwrap_or_else(PoisonError::into_inner);
            turns.retain(|_, turn| Arc::strong_count(turn) > 1);
            turns.entry(account).or_default().clone()
        };
        turn.lock_owned().await
    }
}

impl Member {
    /// Leave to send or receive a file, or to follow a submission.
    ///
    /// # Errors
    /// When the account, or all together, have as many under way as they may.
    pub fn transfer(&self) -> Result<Transfer, Problem> {
        self.app.limits.transfer(self.account.id)
    }

    /// Whether this many more bytes may be kept.
    pub(super) async fn check_quota(&self, transaction: &mut Transaction, size: u64) -> Result<(), Problem> {
        let limits = &self.app.limits;
        let statement =
            "SELECT CAST(coalesce((SELECT sum(bytes) FROM kept_bytes WHERE account = ?), 0) AS {int}) AS student,
            CAST(coalesce((SELECT sum(bytes) FROM kept_bytes WHERE course = ?), 0) AS {int}) AS course";
        let row = transaction.one(statement, values![self.account.id, self.course]).await?;
        let kept = |column: &str| row.int(column).map(|bytes| u64::try_from(bytes).unwrap_or(0));
        exceeds("all that you handed in, with its reports,", kept("student")?, size, limits.student)?;
        exceeds("all that was handed in in this course, with its reports,", kept("course")?, size, limits.course)?;
        if limits.server > 0 {
            let statement = "SELECT CAST(coalesce(sum(bytes), 0) AS {int}) AS bytes FROM kept_bytes";
            let kept = u64::try_from(transaction.one(statement, values![]).await?.int("bytes")?).unwrap_or(0);
            exceeds("all that was handed in here, with its reports,", kept, size, limits.server)?;
        }
        Ok(())
    }
}

fn exceeds(what: &str, kept: u64, size: u64, most: u64) -> Result<(), Problem> {
    if most == 0 || kept.saturating_add(size) <= most {
        return Ok(());
    }
    let in_mib = |bytes: u64| bytes.div_ceil(MIB);
    Err(Problem::quota(format!(
        "{what} takes {} of {} MiB, and this upload has {} MiB",
        in_mib(kept),
        in_mib(most),
        in_mib(size)
    )))
}
