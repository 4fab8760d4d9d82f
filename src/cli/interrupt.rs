//! Cleans up when the user interrupts the program, and makes sure that the program ends.
//!
//! After the first signal, a grading kills its programs and writes the results that are known. If there is no progress
//! for a few seconds, the program ends anyway.
use super::{exit, progress_bars};
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

/// The time without progress after the first signal after which the program ends.
const IDLE_LIMIT: Duration = Duration::from_secs(5);

/// Locks and returns the list of the temporary files that an interrupt has to remove.
pub(super) fn lock_pending_files() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    static PENDING_FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    PENDING_FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files and the progress bars on SIGINT and SIGTERM, and ends the program. Does nothing if a
/// command handles these signals itself.
pub(super) fn clean_up_when_interrupted() {
    static HANDLER_INSTALLED: OnceLock<()> = OnceLock::new();
    HANDLER_INSTALLED.get_or_init(|| {
        // Without a handler, an interrupt only leaves a temporary file behind, so this error is ignored.
        drop(ctrlc::set_handler(|| end_program()));
    });
}

/// Removes incomplete outputs, and ends the program.
fn end_program() -> ! {
    // The code below may block, on a lock or on a reader of the output. The program then ends after a second.
    thread::spawn(|| {
        thread::sleep(Duration::from_secs(1));
        std::process::exit(exit::INTERRUPTED.into());
    });
    // The lock is held until the end, so that in the meantime no file is renamed or created.
    let pending = lock_pending_files();
    for path in pending.iter() {
        drop(fs::remove_file(path));
    }
    progress_bars::clear_bars();
    std::process::exit(exit::INTERRUPTED.into());
}

/// The number of times that progress was recorded.
static ACTIVITY_COUNT: AtomicU64 = AtomicU64::new(0);

/// Records that there is progress, so that the program continues to run.
pub(super) fn record_activity() {
    ACTIVITY_COUNT.fetch_add(1, Ordering::Relaxed);
}

/// Returns a cancellation that SIGINT and SIGTERM trigger. The program ends immediately after a second signal, and also
/// if a grading does not finish.
pub(super) fn cancellation_by_signals() -> Arc<Cancellation> {
    static CANCELLATION: OnceLock<Arc<Cancellation>> = OnceLock::new();
    CANCELLATION
        .get_or_init(|| {
            let cancellation = Arc::new(Cancellation::default());
            let signaled = cancellation.clone();
            let mut first = None;
            // Without a handler, a signal ends the program, and the sandbox with it.
            drop(ctrlc::set_handler(move || {
                // `timeout` and a terminal may each send the same signal.
                let first = *first.get_or_insert_with(Instant::now);
                if signaled.is_canceled() {
                    if first.elapsed() > Duration::from_secs(1) {
                        end_program();
                    }
                    return;
                }
                // This thread is started first, because the calls below could block as well.
                thread::spawn(end_when_idle);
                signaled.cancel();
                progress_bars::write_above_bars(b"\nstopping (press Ctrl-C again to stop immediately)\n");
            }));
            cancellation
        })
        .clone()
}

fn end_when_idle() {
    let (mut moves, mut since) = (ACTIVITY_COUNT.load(Ordering::Relaxed), Instant::now());
    while since.elapsed() < IDLE_LIMIT {
        thread::sleep(Duration::from_millis(100));
        let now = ACTIVITY_COUNT.load(Ordering::Relaxed);
        if now != moves {
            (moves, since) = (now, Instant::now());
        }
    }
    end_program();
}
