//! Cleans up after the user interrupts the program, and ensures that it ends.
//!
//! After the first signal a grading finishes: programs are ended, and known results are written. After a few seconds
//! without progress, the program ends anyway.
use super::{exit, screen};
use crate::suite::Cancellation;
use std::{
    fs,
    path::PathBuf,
    sync::{
        Arc, Mutex, OnceLock, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

/// The maximum time without progress after the first signal.
const IDLE_LIMIT: Duration = Duration::from_secs(5);

/// Returns the temporary files that an interrupt has to remove.
pub(super) fn pending() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    static PENDING_FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    PENDING_FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files and the bars, and ends the program, on SIGINT and SIGTERM. Does nothing if a command
/// handles these signals itself.
pub(super) fn clean_up_when_interrupted() {
    static HANDLER_INSTALLED: OnceLock<()> = OnceLock::new();
    HANDLER_INSTALLED.get_or_init(|| {
        // Without a handler, an interrupt only leaves a temporary file behind, so the error is ignored.
        drop(ctrlc::set_handler(|| end()));
    });
}

/// Ends the program, and removes incomplete outputs.
fn end() -> ! {
    // The following code could block as well: on a lock, or on a reader of the output.
    thread::spawn(|| {
        thread::sleep(Duration::from_secs(1));
        std::process::exit(exit::INTERRUPTED.into());
    });
    // The lock is held until the end, so that no file is renamed or created in between.
    let pending = pending();
    for path in pending.iter() {
        drop(fs::remove_file(path));
    }
    screen::clear_bars();
    std::process::exit(exit::INTERRUPTED.into());
}

/// The number of signs of progress.
static ACTIVITY_COUNT: AtomicU64 = AtomicU64::new(0);

/// Records progress, so that the wait continues.
pub(super) fn show_activity() {
    ACTIVITY_COUNT.fetch_add(1, Ordering::Relaxed);
}

/// Returns a cancellation that SIGINT and SIGTERM trigger. A second signal ends the program immediately, and so does a
/// grading that does not finish.
pub(super) fn cancelled_by_signals() -> Arc<Cancellation> {
    static CANCELLATION: OnceLock<Arc<Cancellation>> = OnceLock::new();
    CANCELLATION
        .get_or_init(|| {
            let cancellation = Arc::new(Cancellation::default());
            let signalled = cancellation.clone();
            let mut first = None;
            // Without a handler a signal ends the program, and the sandbox ends with it.
            drop(ctrlc::set_handler(move || {
                // `timeout` and a terminal may send one signal twice.
                let first = *first.get_or_insert_with(Instant::now);
                if signalled.is_cancelled() {
                    if first.elapsed() > Duration::from_secs(1) {
                        end();
                    }
                    return;
                }
                // Start this thread first, because the following calls could block, too.
                thread::spawn(end_when_nothing_moves);
                signalled.cancel();
                screen::write_above_bars(b"\nstopping (press Ctrl-C again to stop immediately)\n");
            }));
            cancellation
        })
        .clone()
}

fn end_when_nothing_moves() {
    let (mut moves, mut since) = (ACTIVITY_COUNT.load(Ordering::Relaxed), Instant::now());
    while since.elapsed() < IDLE_LIMIT {
        thread::sleep(Duration::from_millis(100));
        let now = ACTIVITY_COUNT.load(Ordering::Relaxed);
        if now != moves {
            (moves, since) = (now, Instant::now());
        }
    }
    end();
}
