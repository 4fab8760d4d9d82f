//! Heartbeats, by which monitors detect that this process hangs. The monitors are systemd (`Type=notify` with
//! `WatchdogSec`), and probes that read a file in the data folder.
use sd_notify::NotifyState;
use std::{
    fs,
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

/// The name of the heartbeat file in the data folder.
const HEARTBEAT_FILE: &str = "alive";

/// The maximum time between two heartbeats. A watchdog may require a shorter one.
const BEAT_INTERVAL: Duration = Duration::from_secs(10);

/// The maximum duration of a health check of the process.
const CHECK_TIMEOUT: Duration = Duration::from_secs(10);

/// The time without a heartbeat after which a process counts as dead.
const MAX_SILENCE: Duration = Duration::from_secs(60);

/// Reports to systemd that the process is ready.
pub(super) fn notify_ready() {
    notify_systemd(&[NotifyState::Ready]);
}

/// Reports to systemd that the process is about to end.
pub(super) fn notify_stopping() {
    notify_systemd(&[NotifyState::Stopping]);
}

fn notify_systemd(state: &[NotifyState<'_>]) {
    if let Err(error) = sd_notify::notify(state) {
        tracing::warn!(%error, "systemd can't be notified");
    }
}

/// Sends a heartbeat whenever a health check succeeds, forever.
pub(super) async fn send_heartbeats(data: PathBuf, is_well: impl AsyncFn() -> bool) {
    let watchdog = sd_notify::watchdog_enabled();
    let interval = watchdog.map_or(BEAT_INTERVAL, |watchdog| (watchdog / 3).min(BEAT_INTERVAL));
    loop {
        match tokio::time::timeout(CHECK_TIMEOUT, is_well()).await {
            Ok(true) => {
                if watchdog.is_some() {
                    notify_systemd(&[NotifyState::Watchdog]);
                }
                // A full disk must not cause a restart.
                drop(fs::write(data.join(HEARTBEAT_FILE), b""));
            }
            _ => tracing::warn!("no heartbeat is sent, because the database does not answer"),
        }
        tokio::time::sleep(interval).await;
    }
}

/// Returns whether a process with this data folder has sent a heartbeat recently.
pub(super) fn is_alive(data: &Path) -> bool {
    let modified = fs::metadata(data.join(HEARTBEAT_FILE)).and_then(|data| data.modified());
    modified.is_ok_and(|touched| SystemTime::now().duration_since(touched).is_ok_and(|age| age < MAX_SILENCE))
}
