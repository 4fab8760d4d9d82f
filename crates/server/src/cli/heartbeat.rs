//! Signs of life for monitors of this process: systemd (`Type=notify` with `WatchdogSec`), and probes that read a file
//! in the data folder.
use sd_notify::NotifyState;
use std::{
    fs,
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

/// The file that is touched, in the data folder.
const FILE: &str = "alive";

/// The time between two signs, unless the watchdog wants them sooner.
const EVERY: Duration = Duration::from_secs(10);

/// The longest time that a check of the process itself may take.
const PATIENCE: Duration = Duration::from_secs(10);

/// A process that has been silent for this time counts as dead.
const SILENCE: Duration = Duration::from_secs(60);

/// Reports that the process has begun its work.
pub(super) fn say_ready() {
    tell(&[NotifyState::Ready]);
}

/// Reports that the process ends.
pub(super) fn say_stopping() {
    tell(&[NotifyState::Stopping]);
}

fn tell(state: &[NotifyState<'_>]) {
    if let Err(error) = sd_notify::notify(state) {
        tracing::warn!(%error, "systemd can't be told");
    }
}

/// Gives signs forever, whenever a check finds that all is well.
pub(super) async fn beat(data: PathBuf, is_well: impl AsyncFn() -> bool) {
    let watchdog = sd_notify::watchdog_enabled();
    let every = watchdog.map_or(EVERY, |watchdog| (watchdog / 3).min(EVERY));
    loop {
        match tokio::time::timeout(PATIENCE, is_well()).await {
            Ok(true) => {
                if watchdog.is_some() {
                    tell(&[NotifyState::Watchdog]);
                }
                // A disk that is full is no reason to be started again.
                drop(fs::write(data.join(FILE), b""));
            }
            _ => tracing::warn!("no sign of life: the database does not answer"),
        }
        tokio::time::sleep(every).await;
    }
}

/// Returns whether a process with this data folder has given a sign lately.
pub(super) fn is_alive(data: &Path) -> bool {
    let touched = fs::metadata(data.join(FILE)).and_then(|data| data.modified());
    touched.is_ok_and(|touched| SystemTime::now().duration_since(touched).is_ok_and(|age| age < SILENCE))
}
