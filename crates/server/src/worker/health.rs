//! Checks whether a worker can grade. A worker with a broken grader would fail on each job immediately, and would thus
//! take all jobs from the queue.
//!
//! Therefore a worker runs a check before its first claim, and again after every fault. Until the check succeeds it
//! claims nothing, and its jobs move to another worker without counting a failure.
use super::Grader;
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};
use tokio::sync::{Mutex, Notify};
use tokio_util::sync::CancellationToken;

/// The wait after the first failed check. It doubles after each further one, up to a maximum.
const FIRST_WAIT: Duration = Duration::from_secs(1);
const MAX_WAIT: Duration = Duration::from_secs(60);

/// The health of a worker. Clones are cheap and share the same state, so all slots have the same health.
#[derive(Debug, Clone)]
pub(super) struct Health<G> {
    pub(super) grader: G,
    /// The folder in which the folders for jobs and checks are created.
    pub(super) folder: PathBuf,
    can_grade: Arc<AtomicBool>,
    /// The lock of the slot that repeats checks until one succeeds. Other slots wait for this lock.
    retry_lock: Arc<Mutex<()>>,
    /// The lock that is held during a check.
    check_lock: Arc<Mutex<()>>,
    /// The reason why the last check failed; `None` if it succeeded.
    fault: Arc<std::sync::Mutex<Option<String>>>,
    /// Notifies waiting tasks when the worker becomes able or unable to grade.
    pub(super) change: Arc<Notify>,
}

impl<G: Grader> Health<G> {
    /// Creates the health of a worker that uses this grader. Folders for checks are created in `folder`.
    pub(super) fn new(grader: G, folder: PathBuf) -> Self {
        Self {
            grader,
            folder,
            can_grade: Arc::default(),
            retry_lock: Arc::default(),
            check_lock: Arc::default(),
            fault: Arc::default(),
            change: Arc::default(),
        }
    }

    /// Returns whether the last check succeeded, so that the worker may claim jobs.
    pub(super) fn is_proven(&self) -> bool {
        self.can_grade.load(Ordering::Acquire)
    }

    /// Returns the reason why the last check failed; `None` if it succeeded.
    pub(super) fn fault(&self) -> Option<String> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Waits until the worker can grade. Returns false if the worker must stop before that.
    pub(super) async fn wait_until_able(&self, stop: &CancellationToken) -> bool {
        let mut wait = FIRST_WAIT;
        if self.is_proven() {
            return !stop.is_cancelled();
        }
        // One slot repeats checks, and the others wait.
        let guard = tokio::select! {
            asking = self.retry_lock.lock() => asking,
            () = stop.cancelled() => return false,
        };
        while !stop.is_cancelled() {
            if self.is_proven() || self.check(stop).await {
                drop(guard);
                return true;
            }
            tokio::select! {
                () = tokio::time::sleep(wait) => {}
                () = stop.cancelled() => {}
            }
            wait = (wait * 2).min(MAX_WAIT);
        }
        false
    }

    /// Checks after a fault whether the worker can still grade. If it can, the job may be the cause of the fault.
    pub(super) async fn recheck_after_fault(&self, stop: &CancellationToken) -> bool {
        self.can_grade.store(false, Ordering::Release);
        self.check(stop).await
    }

    async fn check(&self, stop: &CancellationToken) -> bool {
        let _proving = self.check_lock.lock().await;
        if self.is_proven() {
            return true;
        }
        let result = match job_folder(&self.folder) {
            Err(error) => Err(format!("the working folder can't be created: {error}")),
            Ok(folder) => self.grader.check_ability(folder.path(), stop.child_token()).await,
        };
        if result.is_err() && stop.is_cancelled() {
            return false;
        }
        if let Err(error) = &result {
            tracing::error!(error, "this worker can't grade, and takes no jobs until it can");
        }
        self.can_grade.store(result.is_ok(), Ordering::Release);
        *self.fault.lock().unwrap_or_else(PoisonError::into_inner) = result.err();
        self.change.notify_one();
        self.is_proven()
    }
}

/// Creates a new folder in the worker's folder, for a job or a check.
pub(super) fn job_folder(folder: &Path) -> std::io::Result<tempfile::TempDir> {
    std::fs::create_dir_all(folder)?;
    tempfile::Builder::new().prefix("job-").tempdir_in(folder)
}
