//! Stops a grading from outside.
use fosssim_sandbox::Canceler;
use std::sync::{
    Mutex, MutexGuard, PoisonError,
    atomic::{AtomicBool, AtomicU64, Ordering},
};

/// A switch that stops a grading from outside, for example when the user presses Ctrl-C. No new run begins then, and
/// all active runs are killed.
#[derive(Debug, Default)]
pub struct Cancellation {
    canceled: AtomicBool,
    next_number: AtomicU64,
    running_programs: Mutex<Vec<(u64, Canceler)>>,
}

impl Cancellation {
    /// Stops all present and future runs.
    pub fn cancel(&self) {
        self.canceled.store(true, Ordering::SeqCst);
        for (_, canceler) in self.lock().iter() {
            canceler.cancel();
        }
    }

    /// Returns whether the grading has been stopped.
    pub fn is_canceled(&self) -> bool {
        self.canceled.load(Ordering::SeqCst)
    }

    /// Registers a run, until the returned value is dropped. If the grading has already been stopped, the run is killed
    /// immediately.
    pub(super) fn register(&self, canceler: Canceler) -> impl Drop + '_ {
        let number = self.next_number.fetch_add(1, Ordering::Relaxed);
        self.lock().push((number, canceler.clone()));
        if self.is_canceled() {
            canceler.cancel();
        }
        Registration { cancellation: self, number }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(u64, Canceler)>> {
        self.running_programs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct Registration<'a> {
    cancellation: &'a Cancellation,
    number: u64,
}

impl Drop for Registration<'_> {
    fn drop(&mut self) {
        self.cancellation.lock().retain(|(number, _)| *number != self.number);
    }
}
