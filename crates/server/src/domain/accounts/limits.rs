//! The limits on parallel transfers and on stored bytes: for an account, for a course, and for the whole server.
use crate::domain::{Member, Throttle};
use crate::{
    db::Transaction,
    problem::{self, Problem, ensure},
    values,
};
use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};
use tokio::sync::{OwnedMutexGuard, OwnedSemaphorePermit, Semaphore, SemaphorePermit};

/// The number of transfers that may run in parallel, for all accounts. Each needs a connection, a file and about 100
/// KiB.
static ALL_TRANSFERS: Semaphore = Semaphore::const_new(3000);

/// The maximum time that an upload waits for other uploads of the same account.
const TURN_TIMEOUT: Duration = Duration::from_secs(30);

/// The archives that may be checked in parallel, in the order of their arrival. Each may need about 100 MiB, and a
/// whole processor for seconds.
static ARCHIVE_CHECKS: Semaphore = Semaphore::const_new(2);

/// The maximum time that an archive waits for a turn.
const ARCHIVE_TIMEOUT: Duration = Duration::from_secs(60);

/// The maximum number of rejected archives of an account per minute.
const MAX_REJECTED_PER_MINUTE: u32 = 30;

/// The limits on transfers and stored bytes, and the transfers that are running.
#[derive(Debug, Default)]
pub struct TransferLimits {
    /// The maximum number of parallel transfers of one account.
    pub transfers: usize,
    /// The maximum number of bytes that are stored for one person: uploads and their reports. With 0 there is no limit.
    pub student: u64,
    /// The maximum number of bytes that are stored for one course. With 0 there is no limit.
    pub course: u64,
    /// The maximum number of bytes that the server stores. With 0 there is no limit.
    pub server: u64,
    by_account: Mutex<HashMap<i64, Arc<Semaphore>>>,
    turns: AccountLocks,
    archive_turns: AccountLocks,
    rejected_archives: Throttle,
}

/// A lock for each account that uses one.
type AccountLocks = Mutex<HashMap<i64, Arc<tokio::sync::Mutex<()>>>>;

/// The permission to check an archive, which ends when this value is dropped. An account has one at a time, so that no
/// account has to wait for more than one archive of another.
#[derive(Debug)]
pub struct ArchiveTurn {
    _account_guard: OwnedMutexGuard<()>,
    _server_permit: SemaphorePermit<'static>,
}

/// The permission for a transfer, which ends when this value is dropped.
#[derive(Debug)]
pub struct Transfer {
    _account_permit: OwnedSemaphorePermit,
    _server_permit: SemaphorePermit<'static>,
}

impl TransferLimits {
    /// Creates the limits. The last three are numbers of bytes.
    pub fn new(transfers: usize, student: u64, course: u64, server: u64) -> Self {
        Self { transfers, student, course, server, ..Self::default() }
    }

    fn transfer(&self, account: i64) -> Result<Transfer, Problem> {
        let limit = self.transfers;
        let account_permit = find_shared(&self.by_account, account, || Semaphore::new(limit)).try_acquire_owned();
        let too_many = |_| Problem::too_many(format!("at most {limit} simultaneous transfers are allowed per account"));
        let account_permit = account_permit.map_err(too_many)?;
        let permit = ALL_TRANSFERS.try_acquire();
        let permit = permit.map_err(|_| Problem::unavailable("too many uploads and downloads are running"))?;
        Ok(Transfer { _account_permit: account_permit, _server_permit: permit })
    }

    /// Waits until this server handles no other upload of the account.
    pub(in crate::domain) async fn wait(&self, account: i64) -> Result<OwnedMutexGuard<()>, Problem> {
        let turn = find_shared(&self.turns, account, Default::default);
        let turn = tokio::time::timeout(TURN_TIMEOUT, turn.lock_owned()).await;
        turn.map_err(|_| Problem::unavailable("your other uploads are still being stored"))
    }
}

/// Returns the value that all tasks of an account share, while at least one task uses it.
fn find_shared<T>(all: &Mutex<HashMap<i64, Arc<T>>>, account: i64, new: impl FnOnce() -> T) -> Arc<T> {
    let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
    all.retain(|_, mutex| Arc::strong_count(mutex) > 1);
    all.entry(account).or_insert_with(|| Arc::new(new())).clone()
}

impl Member {
    /// Begins a transfer of the account.
    ///
    /// # Errors
    ///
    /// Fails if the account or the server reaches its limit of transfers.
    pub fn transfer(&self) -> Result<Transfer, Problem> {
        self.app.limits.transfer(self.account.id)
    }

    /// Waits until an archive of the account may be checked. The archive counts as rejected until
    /// [`Self::accept_archive`] is called.
    ///
    /// # Errors
    ///
    /// Fails if too many archives wait, or too many of the account's archives were rejected.
    pub async fn archive_turn(&self) -> Result<ArchiveTurn, Problem> {
        let account_lock = find_shared(&self.app.limits.archive_turns, self.account.id, Default::default);
        let turn = async {
            let (guard, permit) = (account_lock.lock_owned().await, ARCHIVE_CHECKS.acquire().await);
            permit.map(|permit| ArchiveTurn { _account_guard: guard, _server_permit: permit }).ok()
        };
        let turn = tokio::time::timeout(ARCHIVE_TIMEOUT, turn).await.ok().flatten();
        let turn = turn.ok_or_else(|| Problem::unavailable("too many archives are being checked"))?;
        ensure(
            self.app.limits.rejected_archives.try_acquire(self.account.id, MAX_REJECTED_PER_MINUTE, Instant::now()),
            Problem::too_many(format!(
                "more than {MAX_REJECTED_PER_MINUTE} of your archives were rejected in a minute"
            )),
        )?;
        Ok(turn)
    }

    /// Records that the archive was accepted.
    pub fn accept_archive(&self) {
        self.app.limits.rejected_archives.return_token(self.account.id);
    }

    /// Returns the stored bytes of the person, of the course and of the server, and the limit for each.
    async fn measure_storage(&self, transaction: &mut Transaction) -> Result<[StorageUsage; 3], Problem> {
        let limits = &self.app.limits;
        let statement =
            "SELECT CAST(coalesce((SELECT sum(bytes) FROM kept_bytes WHERE account = ?), 0) AS {int}) AS student,
            CAST(coalesce((SELECT sum(bytes) FROM kept_bytes WHERE course = ?), 0) AS {int}) AS course,
            CAST(coalesce((SELECT sum(bytes) FROM kept_bytes WHERE ? > 0), 0) AS {int}) AS server";
        let server = i64::try_from(limits.server).unwrap_or(i64::MAX);
        let row = transaction.one(statement, values![self.account.id, self.course, server]).await?;
        let usage = |column: &str, limit| {
            row.int(column).map(|bytes| StorageUsage { bytes: u64::try_from(bytes).unwrap_or(0), limit })
        };
        Ok([usage("student", limits.student)?, usage("course", limits.course)?, usage("server", limits.server)?])
    }

    /// Describes the space for uploads in sentences. Staff always read about their course, and everyone reads about a
    /// limit that is nearly reached.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn describe_storage(&self) -> Result<Vec<String>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let [student, course, server] = self.measure_storage(&mut transaction).await?;
        let shares = [("you", student, false), ("this course", course, self.is_staff), ("this server", server, false)];
        let reported = shares.into_iter().filter(|(_, kept, always)| kept.is_nearly_full() || *always);
        Ok(reported.map(|(whose, kept, _)| kept.describe(whose)).collect())
    }

    /// Checks that `size` further bytes may be stored.
    pub(in crate::domain) async fn check_quota(&self, transaction: &mut Transaction, size: u64) -> Result<(), Problem> {
        let [student, course, server] = self.measure_storage(transaction).await?;
        ensure_storage("your uploads and reports", student, size)?;
        ensure_storage("the uploads and reports of this course", course, size)?;
        ensure_storage("the uploads and reports on this server", server, size)
    }
}

/// A number of stored bytes, and its limit. A limit of 0 means that there is no limit.
#[derive(Debug, Clone, Copy)]
struct StorageUsage {
    bytes: u64,
    limit: u64,
}

impl StorageUsage {
    /// Returns whether at least four fifths of the limit are used.
    fn is_nearly_full(self) -> bool {
        self.limit > 0 && self.bytes >= self.limit / 5 * 4
    }

    fn describe(self, whose: &str) -> String {
        let stored = format!("Stored uploads and reports of {whose}: {}", problem::format_size(self.bytes));
        let limit = problem::format_size(self.limit);
        match self.limit {
            0 => stored + ".",
            _ if self.is_nearly_full() => {
                format!("{stored} of {limit}. When the space is used up, uploads are rejected. Ask the administrator.")
            }
            _ => format!("{stored} of {limit}."),
        }
    }
}

fn ensure_storage(what: &str, StorageUsage { bytes, limit }: StorageUsage, size: u64) -> Result<(), Problem> {
    if limit == 0 || bytes.saturating_add(size) <= limit {
        return Ok(());
    }
    let [bytes, limit, size] = [bytes, limit, size].map(problem::format_size);
    Err(Problem::quota(format!("{what} use {bytes} of {limit}, and this upload has {size}")))
}
