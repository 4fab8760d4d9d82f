//! What is cleared up when the user ends the program.
use super::{exit, screen};
use std::{
    fs,
    path::PathBuf,
    sync::{Mutex, OnceLock, PoisonError},
};

/// Temporary files that an interrupt has to remove.
pub(super) fn pending() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    static PENDING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on SIGINT and SIGTERM remove the temporary files and the bars, and end the program. A command that handles
/// them itself has said so before, and then this does nothing.
pub(super) fn clean_up_when_interrupted() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        let installed = ctrlc::set_handler(|| {
            // Held until the end: no rename and no new file in between.
            let pending = pending();
            for path in pending.iter() {
                drop(fs::remove_file(path));
            }
            screen::clear_bars();
            std::process::exit(exit::INTERRUPTED.into());
        });
        // Without a handler an interrupt leaves a hidden file behind, which is better than not working at all.
        drop(installed);
    });
}
