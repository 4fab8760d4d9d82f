//! A control group (version 2) of its own for one run, where the grader may make one.
//!
//! The kernel then counts memory and threads without gaps between two looks, ends a run that takes too much, and ends
//! everybody in it at one word. Only what is ours already is used: a group beneath the one that this process is in, or
//! beneath one of that group's parents; no controller is switched on and nobody else is moved. What the supervisor
//! counts by itself stays the rule, so that a verdict does not depend on the groups of a host.

use std::ffi::CStr;
use std::fs::File;
use std::io::{self, Read, Write};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::sys;
use crate::wire::Order;

/// How the names of our groups begin.
const PREFIX: &str = "fosssim-oracle-";
/// Pipe buffers, page tables and the kernel's other books count as well.
const SPARE_MEMORY: u64 = 64 << 20;
const SPARE_PROCESSES: u32 = 16;
/// No run lasts so long: an empty group of that age was left by a supervisor that was killed.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);

/// A group. It is removed when this is dropped in sight of the host's files, once nobody is in it.
pub(super) struct Group {
    path: PathBuf,
    folder: File,
}

impl Group {
    /// Makes a group with the limits of the order, if there is a place for one.
    ///
    /// # Errors
    ///
    /// No version 2 hierarchy, no permission for any place in it, or a kernel before 5.14, which cannot end a group.
    pub(super) fn make(order: &Order) -> io::Result<Self> {
        let mut problem = io::Error::other("no control groups of version 2 are mounted");
        let mut weaker = None;
        for place in places()? {
            sweep(&place);
            match Self::make_in(&place) {
                Ok(group) if group.controls().len() == CONTROLS.len() => {
                    group.set_limits(order)?;
                    return Ok(group);
                }
                Ok(group) if weaker.is_none() => weaker = Some(group),
                Ok(_) => {}
                Err(error) => problem = error,
            }
        }
        let group = weaker.ok_or(problem)?;
        group.set_limits(order)?;
        Ok(group)
    }

    fn make_in(place: &Path) -> io::Result<Self> {
        // In process namespaces, others may have our number.
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
        let path = place.join(format!("{PREFIX}{}-{now}", std::process::id()));
        std::fs::create_dir(&path)?;
        let group = File::open(&path).map(|folder| Self { path, folder })?;
        // Only a group that can be ended and entered is of use.
        group.open(c"cgroup.kill", libc::O_WRONLY)?;
        group.entrance()?;
        Ok(group)
    }

    /// What is limited by the kernel.
    pub(super) fn controls(&self) -> Vec<&'static str> {
        CONTROLS.into_iter().filter(|(file, _)| self.open(file, libc::O_WRONLY).is_ok()).map(|(_, name)| name).collect()
    }

    /// Through this file a process enters the group, by writing a zero.
    pub(super) fn entrance(&self) -> io::Result<File> {
        self.open(c"cgroup.procs", libc::O_WRONLY)
    }

    /// Ends everybody in the group.
    pub(super) fn kill(&self) -> io::Result<()> {
        self.open(c"cgroup.kill", libc::O_WRONLY)?.write_all(b"1")
    }

    /// Whether the kernel ended somebody because the group had no memory left.
    pub(super) fn was_out_of_memory(&self) -> bool {
        self.number(c"memory.events", "oom_kill").is_some_and(|count| count > 0)
    }

    /// Processor time of everybody who is or was in the group.
    pub(super) fn cpu(&self) -> Duration {
        Duration::from_micros(self.number(c"cpu.stat", "usage_usec").unwrap_or(0))
    }

    fn set_limits(&self, order: &Order) -> io::Result<()> {
        // Files in memory and the buffers of others count here, but not for the program's own limit.
        let memory = order.memory.saturating_add(order.folder_bytes).saturating_add(SPARE_MEMORY);
        let processes = order.processes.saturating_add(SPARE_PROCESSES);
        for (file, value) in [
            (c"memory.max", memory.to_string()),
            (c"memory.swap.max", "0".into()),
            (c"memory.oom.group", "1".into()),
            (c"pids.max", processes.to_string()),
        ] {
            match self.open(file, libc::O_WRONLY) {
                Ok(mut file) => file.write_all(value.as_bytes())?,
                // The controller is not there; `controls` says so.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn open(&self, name: &CStr, flags: i32) -> io::Result<File> {
        sys::open_beneath(self.folder.as_fd(), name, flags).map(File::from)
    }

    fn number(&self, file: &CStr, key: &str) -> Option<u64> {
        let mut text = String::new();
        self.open(file, libc::O_RDONLY).ok()?.read_to_string(&mut text).ok()?;
        value_of(&text, key)
    }
}

/// The files without which a limit is not set, and what they limit.
const CONTROLS: [(&CStr, &str); 2] = [(c"memory.max", "memory"), (c"pids.max", "threads and processes")];

impl Drop for Group {
    fn drop(&mut self) {
        const ROUNDS: u32 = 200;
        for _ in 0..ROUNDS {
            // Processes leave it a moment after they were reaped. A group that stays is swept away another day.
            match std::fs::remove_dir(&self.path) {
                Err(error) if error.raw_os_error() == Some(libc::EBUSY) => {
                    std::thread::sleep(Duration::from_millis(1));
                }
                _ => return,
            }
        }
    }
}

/// The number behind the key in a file of lines `key number`.
fn value_of(text: &str, key: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(' ')?.trim().parse().ok())
}

/// Removes empty groups that were left long ago.
fn sweep(place: &Path) {
    for entry in std::fs::read_dir(place).into_iter().flatten().flatten() {
        let ours = entry.file_name().to_str().is_some_and(|name| name.starts_with(PREFIX));
        let made = || entry.metadata().and_then(|metadata| metadata.modified()).ok()?.elapsed().ok();
        if ours && made().is_some_and(|age| age > ABANDONED) {
            // One with somebody in it stays.
            let _ = std::fs::remove_dir(entry.path());
        }
    }
}

/// Where a group might be made: in our own group, then in its parents up to the root of what is mounted here.
fn places() -> io::Result<Vec<PathBuf>> {
    let mounts = std::fs::read_to_string("/proc/self/mountinfo")?;
    let groups = std::fs::read_to_string("/proc/self/cgroup")?;
    Ok(places_in(&mounts, &groups))
}

fn places_in(mounts: &str, groups: &str) -> Vec<PathBuf> {
    let Some(own) = groups.lines().find_map(|line| line.strip_prefix("0::")) else { return Vec::new() };
    let mounted = mounts.lines().find_map(|line| {
        let (before, after) = line.split_once(" - ")?;
        let mut fields = before.split(' ').skip(3);
        after.starts_with("cgroup2 ").then_some((fields.next()?, fields.next()?))
    });
    let Some((root, top)) = mounted else { return Vec::new() };
    let top = Path::new(top);
    // A group outside what is mounted cannot be named here.
    let Ok(inside) = Path::new(own).strip_prefix(root) else { return vec![top.into()] };
    inside.ancestors().map(|part| if part.as_os_str().is_empty() { top.into() } else { top.join(part) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_looked_for_from_our_own_upwards() {
        let mounts =
            "24 1 0:22 / /proc rw - proc proc rw\n31 23 0:27 / /sys/fs/cgroup rw,nosuid - cgroup2 cgroup2 rw\n";
        let own = "12:pids:/old\n0::/user.slice/app.scope\n";
        let places = places_in(mounts, own);
        let expected = ["/sys/fs/cgroup/user.slice/app.scope", "/sys/fs/cgroup/user.slice", "/sys/fs/cgroup"];
        assert_eq!(places, expected.map(PathBuf::from));
        assert_eq!(places_in(mounts, "0::/\n"), [PathBuf::from("/sys/fs/cgroup")]);
        assert!(places_in(mounts, "12:pids:/old\n").is_empty());
        assert!(places_in("24 1 0:22 / /proc rw - proc proc rw\n", own).is_empty());
        let part = "31 23 0:27 /docker/7 /sys/fs/cgroup rw shared:3 - cgroup2 cgroup rw\n";
        assert_eq!(places_in(part, "0::/docker/7/x\n")[0], Path::new("/sys/fs/cgroup/x"));
        assert_eq!(places_in(part, "0::/elsewhere\n"), [PathBuf::from("/sys/fs/cgroup")]);
    }

    #[test]
    fn limits_are_set_where_there_are_controllers_and_the_end_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_path_buf();
        let group = Group { folder: File::open(&path).unwrap(), path };
        let order = Order { memory: 1 << 20, folder_bytes: 1 << 10, processes: 4, ..Order::default() };
        group.set_limits(&order).unwrap();
        assert!(group.controls().is_empty() && !group.was_out_of_memory() && group.cpu().is_zero());
        for name in ["memory.max", "pids.max"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        group.set_limits(&order).unwrap();
        assert_eq!(group.controls(), ["memory", "threads and processes"]);
        let read = |name| std::fs::read_to_string(folder.path().join(name)).unwrap();
        assert_eq!(read("memory.max"), ((65 << 20) + (1 << 10)).to_string());
        assert_eq!(read("pids.max"), "20");
        std::fs::write(folder.path().join("memory.events"), "max 9\noom_kill 1\n").unwrap();
        std::fs::write(folder.path().join("cpu.stat"), "usage_usec 1500\nuser_usec 1000\n").unwrap();
        assert!(group.was_out_of_memory());
        assert_eq!(group.cpu(), Duration::from_micros(1500));
    }

    #[test]
    fn the_kernels_counts_are_read_by_their_whole_name() {
        let text = "oom 3\noom_kill 2\noom_group_kill 1\n";
        assert_eq!(value_of(text, "oom_kill"), Some(2));
        assert_eq!(value_of(text, "oom"), Some(3));
        assert_eq!(value_of(text, "max"), None);
    }
}
