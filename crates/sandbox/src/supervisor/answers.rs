//! Calls that the supervisor answers in the kernel's place, because the kernel's own answer would tell of other runs,
//! or let them have a hand in it.

use std::{
    fs::File,
    os::{fd::BorrowedFd, unix::fs::FileExt},
    time::{Duration, Instant},
};

use crate::{
    machine,
    sys::{self, Announced, CallAnswer},
};

/// Tells the thread how much memory the machine has and how long it has been up, and nothing of what is in use: the C
/// library sorts long arrays by it. A kernel whose other walls keep us from the memory answers itself.
pub(super) fn about_machine(announced: &Announced, user: Option<u32>) -> CallAnswer {
    let told = machine::without_others();
    let path = format!("/proc/{}/mem", announced.thread);
    match sys::with_files_of(user, || File::options().write(true).open(path)) {
        Err(_) => CallAnswer::GoOn,
        Ok(memory) if memory.write_all_at(&told, announced.arguments[0]).is_ok() => CallAnswer::Done,
        Ok(_) => CallAnswer::Refused(libc::EFAULT),
    }
}

/// Whether the process may wait for children with their counters, among which are page faults. The driver of clang
/// does so; it is that driver as the system has it, with no code of anybody else's.
pub(super) fn may_count_children(announced: &Announced, user: Option<u32>) -> bool {
    const SYSTEMS: [&str; 4] = ["/usr/", "/lib/", "/lib64/", "/bin/"];
    let process = |name: &str| format!("/proc/{}/{name}", announced.thread);
    let is_systems = |path: &str| SYSTEMS.iter().any(|folder| path.starts_with(folder));
    let look = || Some((std::fs::read_link(process("exe")).ok()?, std::fs::read_to_string(process("maps")).ok()?));
    let Some((program, maps)) = sys::with_files_of(user, look) else { return false };
    let is_clang = program.file_name().is_some_and(|name| name.to_string_lossy().starts_with("clang"));
    let foreign = |line: &str| {
        let mut words = line.split_ascii_whitespace();
        let executable = words.nth(1).is_some_and(|rights| rights.contains('x'));
        // The kernel's own pages have a name in brackets.
        executable && !words.nth(3).is_some_and(|path| path.starts_with("[v") || is_systems(path))
    };
    is_clang && program.to_str().is_some_and(is_systems) && !maps.lines().any(foreign)
}

/// Threads that wait for a word that other processes might share, as the C library waits for the end of a thread.
///
/// The kernel finds such words by the file in whose pages they are, and wakes the threads that wait there when a thread
/// ends that names the same word: in a library's pages that would be another run's. So nobody waits in the kernel.
/// After a pause the thread is told to look at its word again, which it must do after every wait; the pauses double.
#[derive(Debug, Default)]
pub(super) struct SharedWaits {
    /// The announcements, with the time of their answer and whether they have a limit of time.
    waiting: Vec<(u64, Instant, bool)>,
    /// The last one's word and what it holds as long as the wait goes on, and how long it was told to wait.
    last: Option<([u64; 2], Duration)>,
}

impl SharedWaits {
    const SHORTEST: Duration = Duration::from_micros(50);
    const LONGEST: Duration = Duration::from_millis(2);

    /// Has the thread wait.
    pub(super) fn add(&mut self, announced: &Announced, now: Instant) {
        let [word, _, value, limit, ..] = announced.arguments;
        let before = self.last.filter(|(last, _)| *last == [word, value]);
        let pause = before.map_or(Self::SHORTEST, |(_, pause)| (2 * pause).min(Self::LONGEST));
        self.last = Some(([word, value], pause));
        self.waiting.push((announced.id, now + pause, limit != 0));
    }

    /// When the next one is to be answered.
    pub(super) fn next(&self) -> Option<Instant> {
        self.waiting.iter().map(|(_, due, _)| *due).min()
    }

    /// Answers those whose pause is over.
    pub(super) fn answer(&mut self, listener: BorrowedFd<'_>, now: Instant) {
        self.waiting.retain(|(id, due, limited)| {
            if *due > now {
                return true;
            }
            // A thread that waits with a limit of time looks at its word after that, too. A thread that is gone needs
            // no answer.
            let answer = if *limited { CallAnswer::Refused(libc::ETIMEDOUT) } else { CallAnswer::Done };
            let _ = sys::answer(listener, *id, answer);
            false
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_double_while_a_thread_waits_for_the_same() {
        let (mut waits, now) = (SharedWaits::default(), Instant::now());
        let mut pause = |value| {
            let announced = Announced { id: 1, thread: 2, call: libc::SYS_futex, arguments: [8, 0, value, 0, 0, 0] };
            waits.add(&announced, now);
            let due = waits.next().unwrap();
            waits.waiting.clear();
            (due - now).as_micros()
        };
        let pauses: Vec<u128> = [7, 7, 7, 7, 7, 7, 7, 7, 9, 9].map(&mut pause).into();
        assert_eq!(pauses, [50, 100, 200, 400, 800, 1600, 2000, 2000, 50, 100]);
    }
}
