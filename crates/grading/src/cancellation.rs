//! Stops a grading from outside.
use fosssim_sandbox::Canceller;
use std::sync::{
    Mutex, MutexGuard, PoisonError,
    atomic::{AtomicBool, AtomicU64, Ordering},
};

/// A switch that stops a grading from outside, for example when the user presses Ctrl-C. No new run begins then, and
/// all active runs are killed.
#[derive(Debug, Default)]
pub struct Cancellation {
    cancelled: AtomicBool,
    next_number: AtomicU64,
    running_programs: Mutex<Vec<(u64, Canceller)>>,
}

impl Cancellation {
    /// Stops all present and future runs.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::SeqCst);
        for (_, canceller) in self.lock().iter() {
            canceller.cancel();
        }
    }

    /// Returns whether the grading has been stopped.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::SeqCst)
    }

    /// Registers a run, until the returned value is dropped. If the grading has already been stopped, the run is killed
    /// immediately.
    pub(super) fn register(&self, canceller: Canceller) -> impl Drop + '_ {
        let number = self.next_number.fetch_add(1, Ordering::Relaxed);
        self.lock().push((number, canceller.clone()));
        if self.is_cancelled() {
            canceller.cancel();
        }
        Registration { cancellation: self, number }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(u64, Canceller)>> {
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
