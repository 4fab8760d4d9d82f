//! Finds the processes below this one in `/proc`, and kills them.

use std::{
    collections::BTreeSet,
    path::Path,
    time::{Duration, Instant},
};

use crate::{machine, sys};

/// The fields of a line in `/proc/PID/stat` that are used here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ProcessStat {
    pid: i32,
    state: u8,
    parent: i32,
    session: i32,
    /// The processor time of the process and of its reaped children, in ticks of 10 ms.
    ticks: u64,
    threads: u64,
    resident_pages: u64,
}

impl ProcessStat {
    /// Returns whether any thread of the process can still run. A process whose main thread has ended is shown as dead
    /// (state Z) while its other threads continue.
    fn is_alive(&self) -> bool {
        self.threads > 1 || !matches!(self.state, b'Z' | b'X')
    }

    /// Returns the resident memory in pages. A main thread that has ended has no memory, but other threads share the
    /// same memory.
    fn resident_pages(&self) -> u64 {
        if self.state != b'Z' || !self.is_alive() {
            return self.resident_pages;
        }
        let threads = list_threads(self.pid).filter_map(|thread| read_thread(self.pid, thread));
        threads.map(|stat| stat.resident_pages).max().unwrap_or(0)
    }
}

/// The resources that a group of processes uses together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Usage {
    /// The processor time of processes that are alive, and of their reaped children.
    pub(super) cpu: Duration,
    /// The resident memory in bytes, including memory that was swapped out.
    pub(super) memory: u64,
    /// The number of threads.
    pub(super) threads: u64,
}

/// Returns what the process `pid` uses. With `tree`, the result includes what all other descendants of this process
/// use. On every Linux, `/proc` counts time in hundredths of a second.
pub(super) fn measure_usage(pid: i32, tree: bool) -> Usage {
    let mut usage = Usage::default();
    let page = sys::page_size();
    let swap = machine::has_swap();
    let mut add = |stat: &ProcessStat| {
        usage.cpu += Duration::from_millis(10 * stat.ticks);
        usage.memory += stat.resident_pages() * page + if swap { read_swapped(stat.pid) } else { 0 };
        usage.threads += stat.threads;
    };
    if tree {
        list_descendants().iter().for_each(&mut add);
    } else if let Some(stat) = read_process(pid) {
        add(&stat);
    }
    usage
}

/// Returns how many bytes of a process were swapped out. If the main thread has ended, another thread reports it.
fn read_swapped(pid: i32) -> u64 {
    let swapped_bytes = |thread: i32| {
        machine::read_byte_count(&std::fs::read_to_string(format!("/proc/{pid}/task/{thread}/status")).ok()?, "VmSwap:")
    };
    swapped_bytes(pid).or_else(|| list_threads(pid).find_map(swapped_bytes)).unwrap_or(0)
}

/// Returns the process `pid`, and with `tree` all other descendants of this process that are alive. Each is paired with
/// its threads. If all threads of a process share their descriptors and memory, one thread is enough. A main thread
/// that has ended no longer shares anything.
pub(super) fn group_members(pid: i32, tree: bool) -> Vec<(i32, i32)> {
    let stats = if tree { list_descendants() } else { read_process(pid).into_iter().collect() };
    let living = |stat: &ProcessStat| {
        if stat.state != b'Z' {
            return Some((stat.pid, stat.pid));
        }
        let is_living = |stat: ProcessStat| !matches!(stat.state, b'Z' | b'X');
        let alive = |thread: &i32| read_thread(stat.pid, *thread).is_some_and(is_living);
        list_threads(stat.pid).find(alive).map(|thread| (stat.pid, thread))
    };
    stats.iter().filter_map(living).collect()
}

/// Returns the IDs of a process's threads.
pub(crate) fn list_threads(pid: i32) -> impl Iterator<Item = i32> {
    list_numbers(format!("/proc/{pid}/task"))
}

/// Returns the processes of a user. They are recognized by the owners of entries in `/proc`.
pub(super) fn find_by_user(user: u32) -> Vec<i32> {
    use std::os::unix::fs::MetadataExt;
    let owned = |pid: &i32| std::fs::metadata(format!("/proc/{pid}")).is_ok_and(|metadata| metadata.uid() == user);
    list_all().filter(owned).collect()
}

/// Returns the number of threads of a user, as the kernel counts them for its limit.
pub(super) fn threads_of_user(user: u32) -> u64 {
    find_by_user(user).into_iter().filter_map(read_process).map(|stat| stat.threads).sum()
}

/// The processes that did not end, although they were killed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct RemainingProcesses {
    /// The number of these processes.
    pub(super) count: u32,
    /// Whether the kernel itself blocks all of them (state D). A program cannot cause this.
    pub(super) blocked: bool,
}

/// Kills all descendants of this process and all processes of `user`, and reaps them. With `alone`, this process is the
/// first one in a process namespace that contains only processes of the run.
///
/// All processes are stopped before any is killed, because a fork bomb would otherwise start a new process for each
/// that has ended. `reaped` is called for every process that was reaped.
pub(super) fn kill_all(
    user: Option<u32>,
    alone: bool,
    mut reaped: impl FnMut(sys::ReapedProcess),
) -> RemainingProcesses {
    // Only a process that the kernel itself blocks (state D) takes longer than this to end.
    const MAX_WAIT: Duration = Duration::from_secs(20);
    let start = Instant::now();
    loop {
        if alone {
            // A single command kills all processes in any state. If no child is left, there are no other processes.
            if sys::kill_namespace() && reap_all(&mut reaped) {
                return RemainingProcesses::default();
            }
        }
        let victims = stop_then_kill(|| {
            let mut victims: Vec<i32> = list_descendants().iter().map(|stat| stat.pid).collect();
            victims.extend(user.into_iter().flat_map(find_by_user));
            victims
        });
        // No child is left, not even one that has ended and was not reaped.
        if reap_all(&mut reaped) && user.is_none_or(|user| find_by_user(user).is_empty()) {
            return RemainingProcesses::default();
        }
        if start.elapsed() > MAX_WAIT {
            let blocked = victims.iter().filter_map(|pid| read_process(*pid)).all(|stat| stat.state == b'D');
            return RemainingProcesses { count: u32::try_from(victims.len()).unwrap_or(u32::MAX).max(1), blocked };
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Reaps the children that have ended. Returns true if no child is left.
fn reap_all(reaped: &mut impl FnMut(sys::ReapedProcess)) -> bool {
    loop {
        match sys::reap() {
            Ok(Some(process)) => reaped(process),
            Ok(None) => return false,
            Err(_) => return true,
        }
    }
}

/// Returns the processes of a session that are alive.
pub(super) fn find_by_session(session: i32) -> Vec<i32> {
    let members = list_all().filter_map(read_process).filter(|stat| stat.session == session && stat.is_alive());
    members.map(|stat| stat.pid).collect()
}

/// Stops the processes that `victims` finds, until it finds no new ones. Then kills all of them and returns them.
pub(super) fn stop_then_kill(victims: impl Fn() -> Vec<i32>) -> Vec<i32> {
    const MAX_ATTEMPTS: u32 = 100;
    let mut stopped = BTreeSet::new();
    for _ in 0..MAX_ATTEMPTS {
        let fresh: Vec<i32> = victims().into_iter().filter(|pid| !stopped.contains(pid)).collect();
        if fresh.is_empty() {
            break;
        }
        for pid in fresh {
            // This fails if the process has ended, which the next round shows.
            let _ = sys::kill(pid, libc::SIGSTOP);
            stopped.insert(pid);
        }
    }
    for &pid in &stopped {
        // This fails if the process has ended, which does not matter.
        let _ = sys::kill(pid, libc::SIGKILL);
    }
    stopped.into_iter().collect()
}

/// Returns all descendants of this process that are alive. This process is their reaper, so it is an ancestor even of
/// processes whose parents have ended.
fn list_descendants() -> Vec<ProcessStat> {
    let mut stats: Vec<ProcessStat> = list_all().filter_map(read_process).collect();
    let mut family = vec![std::process::id() as i32];
    let mut found = Vec::new();
    // Parents may have larger IDs than their children, so this is repeated until no process is added.
    loop {
        let (mut mine, rest): (Vec<ProcessStat>, Vec<ProcessStat>) =
            stats.iter().partition(|stat| family.contains(&stat.parent));
        if mine.is_empty() {
            break;
        }
        family = mine.iter().map(|stat| stat.pid).collect();
        mine.retain(ProcessStat::is_alive);
        found.extend(mine);
        stats = rest;
    }
    found
}

/// Returns the IDs of all processes.
pub(crate) fn list_all() -> impl Iterator<Item = i32> {
    list_numbers("/proc")
}

/// Returns the entries of a folder that are numbers.
fn list_numbers(folder: impl AsRef<Path>) -> impl Iterator<Item = i32> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok())
}

fn read_thread(pid: i32, thread: i32) -> Option<ProcessStat> {
    parse(&std::fs::read(format!("/proc/{pid}/task/{thread}/stat")).ok()?)
}

fn read_process(pid: i32) -> Option<ProcessStat> {
    parse(&std::fs::read(format!("/proc/{pid}/stat")).ok()?)
}

/// Parses the line. The name in parentheses may contain anything, including parentheses and newlines, so the fields are
/// counted from the last closing parenthesis.
fn parse(line: &[u8]) -> Option<ProcessStat> {
    let end = line.iter().rposition(|&byte| byte == b')')?;
    let pid = std::str::from_utf8(line.split(|&byte| byte == b' ').next()?).ok()?.parse().ok()?;
    let fields: Vec<&str> = std::str::from_utf8(&line[end + 1..]).ok()?.split_ascii_whitespace().collect();
    let number = |index: usize| fields.get(index).and_then(|field| field.parse::<u64>().ok());
    Some(ProcessStat {
        pid,
        state: *fields.first()?.as_bytes().first()?,
        parent: fields.get(1)?.parse().ok()?,
        session: fields.get(3)?.parse().ok()?,
        ticks: number(11)? + number(12)? + number(13)? + number(14)?,
        threads: number(17)?,
        resident_pages: number(21)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_forge_the_fields() {
        let line = b"42 (a) Z 1 (x\n) S 7 42 43 0 -1 4194304 90 0 0 0 3 4 5 6 20 0 2 0 100 8192000 512 184 rest";
        let stat = parse(line).unwrap();
        assert_eq!(
            stat,
            ProcessStat { pid: 42, state: b'S', parent: 7, session: 43, ticks: 18, threads: 2, resident_pages: 512 }
        );
    }

    #[test]
    fn the_threads_of_this_user_are_counted() {
        assert!(threads_of_user(sys::user_id()) >= measure_usage(std::process::id() as i32, false).threads.min(1));
        assert_eq!(threads_of_user(u32::MAX - 7), 0);
    }

    #[test]
    fn everybody_found_is_stopped_and_killed_until_nobody_new_appears() {
        let children: Vec<_> =
            (0..3).map(|_| std::process::Command::new("/bin/sleep").arg("1000").spawn().unwrap()).collect();
        let pids: Vec<i32> = children.iter().map(|child| child.id() as i32).collect();
        // Each check finds another process, as if it had just been forked.
        let looks = std::cell::Cell::new(0);
        let found = stop_then_kill(|| {
            looks.set((looks.get() + 1).min(pids.len()));
            pids[..looks.get()].to_vec()
        });
        assert_eq!(found.len(), 3);
        for mut child in children {
            assert!(!child.wait().unwrap().success());
        }
    }

    #[test]
    fn a_process_is_dead_only_when_no_thread_is_left() {
        let stat = |line: &[u8]| parse(line).unwrap();
        let left = stat(b"42 (a) Z 7 42 43 0 -1 4194304 90 0 0 0 3 4 5 6 20 0 2 0 100 0 0 184 rest");
        assert!(left.is_alive(), "another thread goes on");
        let dead = stat(b"42 (a) Z 7 42 43 0 -1 4194304 90 0 0 0 3 4 5 6 20 0 1 0 100 0 0 184 rest");
        assert!(!dead.is_alive());
    }

    #[test]
    fn this_process_is_seen_to_use_memory() {
        let usage = measure_usage(std::process::id() as i32, false);
        assert!(usage.memory > 100_000 && usage.threads >= 1);
    }
}
