//! Answers some system calls instead of the kernel. The kernel's answers would reveal other runs, or would let runs
//! interfere.

use std::{
    fs::File,
    io,
    os::{fd::BorrowedFd, unix::fs::FileExt},
    time::{Duration, Instant},
};

use crate::sys::{self, CallAnswer, PendingCall};

/// Opens the memory of the thread that waits for an answer. Fails if other layers prevent this; the kernel then answers
/// the call.
fn open_memory(announced: &PendingCall, user: Option<u32>) -> io::Result<File> {
    let path = format!("/proc/{}/mem", announced.thread);
    sys::with_file_permissions_of(user, || File::options().read(true).write(true).open(path))
}

/// Threads that wait until a futex word changes. The word might be shared with other processes. The C library waits in
/// this way for the end of a thread.
///
/// The kernel identifies shared words by their position in a file. If a word is in the pages of a library, it is shared
/// with other runs, and their threads could wake the waiting thread. Therefore no thread waits in the kernel. Instead,
/// the supervisor checks the word until it has changed or the time limit has passed. Each pause between two checks is
/// twice as long as the one before.
#[derive(Debug, Default)]
pub(super) struct SharedWaits(Vec<SharedWait>);

#[derive(Debug)]
struct SharedWait {
    id: u64,
    memory: File,
    /// The address of the futex word.
    word: u64,
    /// The value that the word has as long as the thread must wait.
    value: u32,
    /// The time at which the thread stops waiting, if there is one.
    limit: Option<Instant>,
    pause: Duration,
    /// The time at which the word is checked next.
    due: Instant,
}

impl SharedWaits {
    const MIN_WAIT: Duration = Duration::from_micros(50);
    const MAX_PAUSE: Duration = Duration::from_millis(2);

    /// Adds a thread that waits. If it does not need to wait, returns the answer.
    pub(super) fn add(&mut self, announced: &PendingCall, user: Option<u32>, now: Instant) -> Option<CallAnswer> {
        let Ok(memory) = open_memory(announced, user) else { return Some(CallAnswer::Continue) };
        let [word, _, value, ..] = announced.arguments;
        let limit = match apply_limit(announced, &memory, now) {
            Ok(limit) => limit,
            Err(errno) => return Some(CallAnswer::Error(errno)),
        };
        let (pause, value) = (Self::MIN_WAIT, value as u32);
        let wait = SharedWait { id: announced.id, memory, word, value, limit, pause, due: now + pause };
        match wait.answer(now) {
            Some(CallAnswer::Done) => Some(CallAnswer::Error(libc::EAGAIN)),
            None => {
                self.0.push(wait);
                None
            }
            answer => answer,
        }
    }

    /// Returns the time at which the next word must be checked; `None` if no thread waits.
    pub(super) fn next(&self) -> Option<Instant> {
        self.0.iter().map(|wait| wait.due).min()
    }

    /// Answers the threads whose words have changed, or whose time limits have passed.
    pub(super) fn answer(&mut self, listener: BorrowedFd<'_>, now: Instant) {
        self.0.retain_mut(|wait| {
            if wait.due > now {
                return true;
            }
            wait.pause = (2 * wait.pause).min(Self::MAX_PAUSE);
            wait.due = now + wait.pause;
            match wait.answer(now) {
                // A signal may already have ended the wait.
                None => sys::is_waiting(listener, wait.id),
                Some(answer) => {
                    // This fails if the thread has ended, which does not matter.
                    let _ = sys::answer(listener, wait.id, answer);
                    false
                }
            }
        });
    }
}

impl SharedWait {
    /// Returns the answer if the wait is over.
    fn answer(&self, now: Instant) -> Option<CallAnswer> {
        let mut word = [0; 4];
        match self.memory.read_exact_at(&mut word, self.word) {
            Err(_) => Some(CallAnswer::Error(libc::EFAULT)),
            Ok(()) if u32::from_ne_bytes(word) != self.value => Some(CallAnswer::Done),
            Ok(()) => self.limit.is_some_and(|limit| limit <= now).then_some(CallAnswer::Error(libc::ETIMEDOUT)),
        }
    }
}

/// Returns the time until which the thread waits. In the call it is relative to now (`FUTEX_WAIT`), or a time of a
/// clock (`FUTEX_WAIT_BITSET`).
fn apply_limit(announced: &PendingCall, memory: &File, now: Instant) -> Result<Option<Instant>, i32> {
    let [_, operation, _, timeout_address, ..] = announced.arguments;
    if timeout_address == 0 {
        return Ok(None);
    }
    let mut bytes = [0; 16];
    memory.read_exact_at(&mut bytes, timeout_address).map_err(|_| libc::EFAULT)?;
    let [seconds, nanoseconds] = [0, 8].map(|at| i64::from_ne_bytes(std::array::from_fn(|index| bytes[at + index])));
    let (Ok(seconds), Ok(nanoseconds @ 0..1_000_000_000)) = (u64::try_from(seconds), u32::try_from(nanoseconds)) else {
        return Err(libc::EINVAL);
    };
    let operation = operation as i32;
    let passed = match operation & !libc::FUTEX_CLOCK_REALTIME {
        libc::FUTEX_WAIT => Duration::ZERO,
        _ => sys::clock_time(operation & libc::FUTEX_CLOCK_REALTIME != 0),
    };
    // If the time is beyond the range of the clock, there is no limit.
    Ok(now.checked_add(Duration::new(seconds, nanoseconds).saturating_sub(passed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a wait of this process for `word`, with the address of `limit`.
    fn announced(operation: i32, word: &u32, value: u32, limit: Option<&[i64; 2]>) -> PendingCall {
        let limit = limit.map_or(0, |limit| (&raw const *limit) as u64);
        let arguments = [(&raw const *word) as u64, operation as u64, value.into(), limit, 0, 0];
        PendingCall { id: 1, thread: std::process::id(), call: libc::SYS_futex, arguments }
    }

    #[test]
    fn a_wait_lasts_until_the_word_changes_or_its_time_is_over() {
        let (mut waits, now, word) = (SharedWaits::default(), Instant::now(), 7);
        let changed = waits.add(&announced(libc::FUTEX_WAIT, &word, 8, None), None, now);
        assert_eq!(changed, Some(CallAnswer::Error(libc::EAGAIN)));
        assert_eq!(waits.add(&announced(libc::FUTEX_WAIT, &word, 7, None), None, now), None);
        assert_eq!(waits.0[0].answer(now + Duration::from_secs(3600)), None, "it has no limit");
        let later = announced(libc::FUTEX_WAIT, &word, 7, Some(&[5, 0]));
        assert_eq!(waits.add(&later, None, now), None);
        assert_eq!(waits.0[1].answer(now + Duration::from_millis(4900)), None);
        assert_eq!(waits.0[1].answer(now + Duration::from_secs(5)), Some(CallAnswer::Error(libc::ETIMEDOUT)));
        let mut other = announced(libc::FUTEX_WAIT, &word, 7, None);
        other.arguments[0] = 8;
        assert_eq!(waits.add(&other, None, now), Some(CallAnswer::Error(libc::EFAULT)));
    }

    #[test]
    fn a_limit_is_by_the_clock_that_the_call_names() {
        let (word, now) = (7, Instant::now());
        let memory = File::open("/proc/self/mem").unwrap();
        let limit = |operation, time: [i64; 2]| {
            apply_limit(&announced(operation, &word, 7, Some(&time)), &memory, now).map(|limit| limit.unwrap() - now)
        };
        for (flag, real) in [(0, false), (libc::FUTEX_CLOCK_REALTIME, true)] {
            let soon = sys::clock_time(real).as_secs() as i64 + 100;
            let left = limit(libc::FUTEX_WAIT_BITSET | flag, [soon, 0]).unwrap();
            assert!(left > Duration::from_secs(98) && left <= Duration::from_secs(100), "{left:?}");
            assert_eq!(limit(libc::FUTEX_WAIT_BITSET | flag, [1, 0]), Ok(Duration::ZERO), "it has passed");
            assert_eq!(limit(libc::FUTEX_WAIT | flag, [1, 5]), Ok(Duration::new(1, 5)));
        }
        for wrong in [[-1, 0], [0, -1], [0, 1_000_000_000]] {
            assert_eq!(limit(libc::FUTEX_WAIT, wrong), Err(libc::EINVAL));
        }
    }
}
