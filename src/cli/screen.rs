//! The progress bars on standard error, and their removal.
use indicatif::{MultiProgress, ProgressDrawTarget};
use std::{
    io::{self, Write},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// The visible progress bars.
static ON_SCREEN: Mutex<Option<MultiProgress>> = Mutex::new(None);

pub(super) fn on_screen() -> MutexGuard<'static, Option<MultiProgress>> {
    ON_SCREEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes to standard error, above the bars; its own errors cannot be reported.
pub(super) fn write_above_bars(text: &[u8]) {
    let write = || drop(io::stderr().lock().write_all(text));
    match &*on_screen() {
        Some(bars) => bars.suspend(write),
        None => write(),
    }
}

/// Removes the progress bars.
pub(super) fn clear_bars() {
    if let Some(bars) = on_screen().take() {
        drop(bars.clear());
        // Another thread may have drawn in the meantime. From here on none can, and the last drawing is removed.
        bars.set_draw_target(ProgressDrawTarget::hidden());
        drop(io::stderr().lock().write_all(b"\r\x1b[2K"));
    }
}
