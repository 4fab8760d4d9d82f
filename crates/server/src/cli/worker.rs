//! The command `worker`, which grades the jobs of the queue.
use super::{
    arguments::{WorkerArguments, WorkloadArguments},
    cancel_on_signal,
    folders::ServiceFolders,
    heartbeat,
};
use crate::{
    db::{self, Database},
    queue::{Notifier, QueuePolicy},
    secret,
    store::Store,
    worker::{self, LocalSource, Program, RemoteSource},
};
use anyhow::{Context, Result, bail};
use std::{
    num::NonZeroUsize,
    path::{Path, PathBuf},
    time::Duration,
};
use tokio_util::sync::CancellationToken;

pub(super) async fn run(arguments: &WorkerArguments) -> Result<()> {
    let stop = cancel_on_signal()?;
    if let Some(server) = &arguments.server {
        let Some(file) = &arguments.token_file else {
            bail!("a worker for {server} needs its token: --token-file FILE");
        };
        return run_http(server, file, arguments, stop).await;
    }
    let folders = ServiceFolders::find_database(&arguments.storage)?;
    let (database, address) = folders.open_database(&arguments.storage).await?;
    if db::read_version(&database).await? != db::NEWEST {
        bail!("the tables of {address} have another version; start the server first, which updates them");
    }
    let store = folders.store(&arguments.storage)?;
    let notifier = Notifier::default();
    let local = LocalWorkers {
        folders,
        database: database.clone(),
        store,
        notifier,
        policy: queue_policy(&arguments.work),
        grader: find_grader(arguments.work.grader.as_deref())?,
    };
    heartbeat::notify_ready();
    let monitored = database.clone();
    tokio::spawn(heartbeat::send_heartbeats(local.folders.data.clone(), async move || monitored.is_healthy().await));
    local.work(&arguments.work, arguments.slots, arguments.name.as_deref(), stop).await?;
    database.close().await;
    Ok(())
}

/// Grades jobs of a server on another machine, over HTTP.
async fn run_http(server: &str, token_file: &Path, arguments: &WorkerArguments, stop: CancellationToken) -> Result<()> {
    let token = std::fs::read_to_string(token_file)
        .with_context(|| format!("cannot read the token in {}", token_file.display()))?;
    let token = token.trim();
    // The file's text is not repeated in the message, because it may be another secret.
    if !token.starts_with("fsw_") || !token.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_') {
        bail!("{} must contain a worker's token (fsw_...)", token_file.display());
    }
    let grader = find_grader(arguments.work.grader.as_deref())?;
    let folders = ServiceFolders::open(&arguments.storage)?;
    let name = unique_name(arguments.name.as_deref());
    folders.clear()?;
    let source = RemoteSource::new(server, token, &name);
    let folder = folders.work_folder(&name);
    heartbeat::notify_ready();
    // A worker that can't reach its server is healthy: it keeps trying, and keeps its jobs.
    tokio::spawn(heartbeat::send_heartbeats(folders.data.clone(), async || true));
    let slots = slot_count(arguments.slots);
    tracing::info!(worker = name, server, slots, grader = %grader.display(), "working");
    let program = Program::new(grader, arguments.work.threads.get());
    let worked = worker::work(source, program, slots, folder.clone(), stop).await;
    drop(std::fs::remove_dir_all(folder));
    worked.with_context(|| server.to_owned())?;
    tracing::info!(worker = name, "stopped");
    Ok(())
}

/// Makes a worker's name unique, by adding the process ID.
fn unique_name(name: Option<&str>) -> String {
    let name = strip_controls(name.map_or_else(host_name, str::to_owned).as_str());
    format!("{name}.{}.{}", std::process::id(), &secret::random_hex()[..6])
}

/// Returns the requested number of slots, or the number of cores.
fn slot_count(slots: Option<NonZeroUsize>) -> usize {
    slots.or(std::thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get)
}

/// Returns the queue's policy that the arguments describe.
pub(super) fn queue_policy(work: &WorkloadArguments) -> QueuePolicy {
    let lease = Duration::from_secs(work.lease);
    QueuePolicy { lease, max_failures: work.tries, first_wait: lease / 30, longest_wait: lease * 4 }
}

/// Returns the given grader, or the one in the folder of this program.
pub(super) fn find_grader(grader: Option<&Path>) -> Result<PathBuf> {
    let path = match grader {
        Some(path) => path.to_owned(),
        None => std::env::current_exe()?.with_file_name("fosssim-oracle"),
    };
    if !path.is_file() {
        bail!("there is no grader at {}; build fosssim-oracle, or choose it with --grader", path.display());
    }
    std::path::absolute(&path).context("cannot find the grader's absolute path")
}

/// The server's own workers, which access the database directly.
pub(super) struct LocalWorkers {
    pub(super) folders: ServiceFolders,
    pub(super) database: Database,
    pub(super) store: Store,
    pub(super) notifier: Notifier,
    pub(super) policy: QueuePolicy,
    pub(super) grader: PathBuf,
}

impl LocalWorkers {
    /// Grades jobs until `stop` is canceled.
    pub(super) async fn work(
        &self,
        work: &WorkloadArguments,
        slots: Option<NonZeroUsize>,
        name: Option<&str>,
        stop: CancellationToken,
    ) -> Result<()> {
        let name = unique_name(name);
        self.folders.clear()?;
        let slots = self::slot_count(slots);
        tracing::info!(worker = name, slots, grader = %self.grader.display(), "working");
        let source = LocalSource::new(
            self.database.with_priority(),
            self.store.clone(),
            self.notifier.clone(),
            self.policy,
            name.clone(),
        );
        let folder = self.folders.work_folder(&name);
        let program = Program::new(self.grader.clone(), work.threads.get());
        worker::work(source, program, slots, folder.clone(), stop).await?;
        drop(std::fs::remove_dir_all(folder));
        tracing::info!(worker = name, "stopped");
        Ok(())
    }
}

fn host_name() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default().trim().to_owned()
}

/// Returns a name without control characters, for use as a file name.
fn strip_controls(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let plain: String = name.chars().map(safe).take(60).collect();
    if plain.is_empty() { "worker".to_owned() } else { plain }
}
