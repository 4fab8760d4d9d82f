//! Shows the progress bars on standard error, and removes them.
use indicatif::{MultiProgress, ProgressDrawTarget};
use std::{
    io::{self, Write},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// The progress bars that are visible.
static VISIBLE_BARS: Mutex<Option<MultiProgress>> = Mutex::new(None);

pub(super) fn lock_visible_bars() -> MutexGuard<'static, Option<MultiProgress>> {
    VISIBLE_BARS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes to standard error, above the progress bars. Its own errors cannot be reported.
pub(super) fn write_above_bars(text: &[u8]) {
    let write = || drop(io::stderr().lock().write_all(text));
    match &*lock_visible_bars() {
        Some(bars) => bars.suspend(write),
        None => write(),
    }
}

/// Removes the progress bars.
pub(super) fn clear_bars() {
    if let Some(bars) = lock_visible_bars().take() {
        drop(bars.clear());
        // Another thread may have drawn the bars in the meantime. From here on, no thread can draw, and what was drawn
        // last is removed.
        bars.set_draw_target(ProgressDrawTarget::hidden());
        drop(io::stderr().lock().write_all(b"\r\x1b[2K"));
    }
}
