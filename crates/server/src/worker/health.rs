//! Whether a worker can grade. One whose grader is broken fails at once and is free again at once: it would eat the
//! queue.
//!
//! So a worker proves itself before its first claim, and again after every fault. While it can't, it claims nothing,
//! and what it holds goes to another worker without having cost a try.
use super::Grader;
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};
use tokio::sync::Mutex;
use tokio_util::sync::CancellationToken;

/// The wait after a failed proof; it doubles up to the longest.
const FIRST_WAIT: Duration = Duration::from_secs(1);
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// The health of a worker. Cloning it is cheap, and all slots share it.
#[derive(Debug, Clone)]
pub(super) struct Health<G> {
    grader: G,
    folder: PathBuf,
    is_proven: Arc<AtomicBool>,
    /// Held by the slot that proves; the others wait for what it finds.
    proving: Arc<Mutex<()>>,
}

impl<G: Grader> Health<G> {
    /// The health of a worker with this grader, which may make folders in this one.
    pub(super) fn new(grader: G, folder: PathBuf) -> Self {
        Self { grader, folder, is_proven: Arc::default(), proving: Arc::default() }
    }

    /// Whether the worker may claim.
    pub(super) fn is_proven(&self) -> bool {
        self.is_proven.load(Ordering::Acquire)
    }

    /// Waits until the worker can grade; false when it is to stop before.
    pub(super) async fn well(&self, stop: &CancellationToken) -> bool {
        let mut wait = FIRST_WAIT;
        while !stop.is_cancelled() {
            if self.is_proven() || self.prove(stop).await {
                return true;
            }
            tokio::select! {
                () = tokio::time::sleep(wait) => {}
                () = stop.cancelled() => {}
            }
            wait = (wait * 2).min(LONGEST_WAIT);
        }
        false
    }

    /// After a fault: whether the worker can still grade, so that the fault may be the job's.
    pub(super) async fn survives(&self, stop: &CancellationToken) -> bool {
        self.is_proven.store(false, Ordering::Release);
        self.prove(stop).await
    }

    async fn prove(&self, stop: &CancellationToken) -> bool {
        let _proving = self.proving.lock().await;
        if self.is_proven() {
            return true;
        }
        let proof = match job_folder(&self.folder) {
            Err(error) => Err(format!("no folder to work in: {error}")),
            Ok(folder) => self.grader.prove(folder.path(), stop.child_token()).await,
        };
        match proof {
            Ok(()) => self.is_proven.store(true, Ordering::Release),
            Err(_) if stop.is_cancelled() => {}
            Err(error) => tracing::error!(error, "this worker can't grade, and takes no jobs until it can"),
        }
        self.is_proven()
    }
}

/// A new folder within a worker's, for a job or a proof.
pub(super) fn job_folder(folder: &Path) -> std::io::Result<tempfile::TempDir> {
    std::fs::create_dir_all(folder)?;
    tempfile::Builder::new().prefix("job-").tempdir_in(folder)
}
