//! A control group for one run, if the grader may create one.
//!
//! The kernel then counts memory and threads at all times, kills a run that uses too much, and kills all its processes
//! by a single command. The group is created below the group of this process, or below one of that group's parents. No
//! controller is enabled and no other process is moved. The supervisor's own counts still decide, so that a verdict
//! does not depend on whether a host offers groups.
//!
//! Version 2 is preferred. If it has no controller for memory, version 1 limits memory, but cannot kill a run.

use std::{
    ffi::CStr,
    fs::File,
    io::{self, Read, Write},
    os::fd::AsFd,
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use crate::{
    sys::{self, OFlags},
    wire::RunOrder,
};

/// The prefix of the names of control groups.
const GROUP_PREFIX: &str = "fosssim-oracle-";
/// Memory that is added to the limit, for pipe buffers, page tables and other data of the kernel that are counted as
/// well.
const SPARE_MEMORY_BYTES: u64 = 64 << 20;
const SPARE_PROCESSES: u32 = 16;

/// The hierarchy to which a control group belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum HierarchyKind {
    /// The single hierarchy of control groups in version 2.
    Unified,
    /// The hierarchy of version 1 that limits memory.
    Memory,
}

/// A control group for one run. If the host's files are visible when the value is dropped, the group is removed as soon
/// as it has no processes.
pub(super) struct Group {
    parts: Vec<GroupPart>,
}

/// The control group in one hierarchy. Its folder is locked while it is in use.
struct GroupPart {
    kind: HierarchyKind,
    path: PathBuf,
    folder: File,
    /// The names of the quantities that the kernel limits, because their controllers are available.
    limits: Vec<&'static str>,
}

impl Group {
    /// Creates a control group with the limits of the order.
    ///
    /// # Errors
    ///
    /// Fails if the grader may not create a group in any hierarchy. Also fails if it may create one only in version 2,
    /// and the kernel is older than 5.14, so that it cannot kill a group.
    pub(super) fn create(order: &RunOrder) -> io::Result<Self> {
        let mounts = std::fs::read_to_string("/proc/self/mountinfo")?;
        let groups = std::fs::read_to_string("/proc/self/cgroup")?;
        let mut problem = io::Error::other("no control groups are mounted");
        let mut parts: Vec<GroupPart> = Vec::new();
        for kind in [HierarchyKind::Unified, HierarchyKind::Memory] {
            if parts.iter().flat_map(|part| &part.limits).any(|held| kind.limits().iter().any(|(name, _)| name == held))
            {
                continue;
            }
            match GroupPart::create(kind, &list_group_places(&mounts, &groups, kind)) {
                Ok(Some(part)) => parts.push(part),
                Ok(None) => {}
                Err(error) => problem = error,
            }
        }
        let group = Self { parts };
        if group.parts.is_empty() {
            return Err(problem);
        }
        group.set_limits(order)?;
        Ok(group)
    }

    /// Returns the names of the quantities that the kernel limits.
    pub(super) fn controls(&self) -> Vec<&'static str> {
        let mut limits: Vec<&str> = self.parts.iter().flat_map(|part| part.limits.iter().copied()).collect();
        limits.sort_unstable();
        limits
    }

    /// Opens the files by which a process enters the group. The process writes a zero to each of them.
    pub(super) fn open_entry_files(&self) -> io::Result<Vec<File>> {
        self.parts.iter().map(GroupPart::open_entry_file).collect()
    }

    /// Returns whether all processes of the group can be killed by a single command.
    pub(super) fn can_kill(&self) -> bool {
        self.unified_part().is_some()
    }

    /// Kills all processes of the group, if that is possible.
    pub(super) fn kill(&self) -> io::Result<()> {
        self.unified_part().map_or(Ok(()), |part| part.open(c"cgroup.kill", OFlags::WRONLY)?.write_all(b"1"))
    }

    /// Returns whether the kernel killed a process because the group had no memory left.
    pub(super) fn was_out_of_memory(&self) -> bool {
        self.parts.iter().any(|part| {
            let file = if part.kind == HierarchyKind::Memory { c"memory.oom_control" } else { c"memory.events" };
            part.read_number(file, "oom_kill").is_some_and(|count| count > 0)
        })
    }

    /// Returns the processor time of all processes that are or were in the group.
    pub(super) fn cpu(&self) -> Duration {
        Duration::from_micros(
            self.unified_part().and_then(|part| part.read_number(c"cpu.stat", "usage_usec")).unwrap_or(0),
        )
    }

    fn unified_part(&self) -> Option<&GroupPart> {
        self.parts.iter().find(|part| part.kind == HierarchyKind::Unified)
    }

    fn set_limits(&self, order: &RunOrder) -> io::Result<()> {
        // The group also counts files, mainly those in the working folder, and buffers of other files. The program's
        // own limit counts neither.
        let limits = &order.limits;
        let memory = limits.memory.saturating_add(order.folder_bytes()).saturating_add(SPARE_MEMORY_BYTES);
        let processes = limits.processes.saturating_add(SPARE_PROCESSES);
        for part in &self.parts {
            let values: &[(&CStr, String)] = match part.kind {
                HierarchyKind::Unified => &[
                    (c"memory.max", memory.to_string()),
                    (c"memory.swap.max", "0".into()),
                    (c"memory.oom.group", "1".into()),
                    (c"pids.max", processes.to_string()),
                ],
                HierarchyKind::Memory => &[
                    (c"memory.limit_in_bytes", memory.to_string()),
                    (c"memory.memsw.limit_in_bytes", memory.to_string()),
                ],
            };
            for (file, value) in values {
                match part.open(file, OFlags::WRONLY) {
                    Ok(mut file) => file.write_all(value.as_bytes())?,
                    // It is not an error if a controller is missing; `controls` reports it.
                    Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(())
    }
}

/// A quantity that the kernel can limit for a group, and the file in which the limit is set.
type GroupLimit = (&'static str, &'static CStr);

impl HierarchyKind {
    /// Returns the limits that this version of control groups offers.
    fn limits(self) -> &'static [GroupLimit] {
        match self {
            Self::Unified => &[("memory", c"memory.max"), ("threads and processes", c"pids.max")],
            Self::Memory => &[("memory", c"memory.limit_in_bytes")],
        }
    }
}

impl GroupPart {
    /// Creates a group in the first of the places in which all limits work. If there is no such place, uses the first
    /// one in which a group can be created.
    fn create(kind: HierarchyKind, parents: &[PathBuf]) -> io::Result<Option<Self>> {
        let (mut weaker, mut problem) = (None, None);
        for parent in parents {
            remove_abandoned_groups(parent);
            match Self::create_in(kind, parent) {
                Ok(part) if part.limits.len() == kind.limits().len() => return Ok(Some(part)),
                // A group of version 1 without the limit is useless.
                Ok(part) if weaker.is_none() && kind == HierarchyKind::Unified => weaker = Some(part),
                Ok(_) => {}
                Err(error) => problem = Some(error),
            }
        }
        match (weaker, problem) {
            (None, Some(problem)) => Err(problem),
            (weaker, _) => Ok(weaker),
        }
    }

    fn create_in(kind: HierarchyKind, parent: &Path) -> io::Result<Self> {
        const MAX_TRIES: u32 = 10;
        let mut tries = 0;
        loop {
            match Self::create_once(kind, parent) {
                // A cleanup by another supervisor may have removed the group before it was locked.
                Err(error) if error.kind() == io::ErrorKind::NotFound && tries < MAX_TRIES && parent.is_dir() => {
                    tries += 1
                }
                done => return done,
            }
        }
    }

    fn create_once(kind: HierarchyKind, parent: &Path) -> io::Result<Self> {
        let (path, folder) = create_locked_group(parent)?;
        let mut part = Self { kind, path, folder, limits: Vec::new() };
        // A group is useful only if it can be entered and, in version 2, can be killed.
        if kind == HierarchyKind::Unified {
            part.open(c"cgroup.kill", OFlags::WRONLY)?;
        }
        part.open_entry_file()?;
        part.find_limits();
        Ok(part)
    }

    fn find_limits(&mut self) {
        let find_writable = |(name, file): &GroupLimit| self.open(file, OFlags::WRONLY).is_ok().then_some(*name);
        self.limits = self.kind.limits().iter().filter_map(find_writable).collect();
    }

    fn open_entry_file(&self) -> io::Result<File> {
        self.open(c"cgroup.procs", OFlags::WRONLY)
    }

    fn open(&self, name: &CStr, flags: OFlags) -> io::Result<File> {
        sys::open_beneath(self.folder.as_fd(), name, flags).map(File::from)
    }

    fn read_number(&self, file: &CStr, key: &str) -> Option<u64> {
        let mut text = String::new();
        self.open(file, OFlags::RDONLY).ok()?.read_to_string(&mut text).ok()?;
        find_value(&text, key)
    }
}

impl Drop for GroupPart {
    fn drop(&mut self) {
        const MAX_ATTEMPTS: u32 = 200;
        for _ in 0..MAX_ATTEMPTS {
            // Processes leave the group shortly after they were reaped. If the group cannot be removed yet, the next
            // run removes it.
            match std::fs::remove_dir(&self.path) {
                Err(error) if error.raw_os_error() == Some(libc::EBUSY) => {
                    std::thread::sleep(Duration::from_millis(1));
                }
                _ => return,
            }
        }
    }
}

/// Returns the number after `key` in a file that consists of lines of the form `key number`.
fn find_value(text: &str, key: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(' ')?.trim().parse().ok())
}

/// Creates the folder of a control group and locks it, so that no cleanup removes it.
///
/// # Errors
///
/// Fails with `NotFound` if the group was removed before it was locked.
fn create_locked_group(parent: &Path) -> io::Result<(PathBuf, File)> {
    // In another process namespace, a process may have the same number.
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
    let path = parent.join(format!("{GROUP_PREFIX}{}-{now}", std::process::id()));
    std::fs::create_dir(&path)?;
    let folder = File::open(&path)?;
    folder.try_lock().map_err(|_| io::ErrorKind::NotFound)?;
    // A process that removes a group holds its lock, so this group is not removed.
    path.symlink_metadata()?;
    Ok((path, folder))
}

/// Removes empty groups of killed supervisors. Each is locked while it is removed.
fn remove_abandoned_groups(parent: &Path) {
    for entry in std::fs::read_dir(parent).into_iter().flatten().flatten() {
        let ours = entry.file_name().to_str().is_some_and(|name| name.starts_with(GROUP_PREFIX));
        let Some(folder) = ours.then(|| File::open(entry.path()).ok()).flatten() else { continue };
        if folder.try_lock().is_ok() {
            // This fails if the group still has a process.
            let _ = std::fs::remove_dir(entry.path());
        }
    }
}

/// Returns the control groups that limit the memory of this process. The innermost group comes first.
pub(crate) fn memory_groups() -> Vec<PathBuf> {
    let read = |path| std::fs::read_to_string(path).unwrap_or_default();
    let (mounts, groups) = (read("/proc/self/mountinfo"), read("/proc/self/cgroup"));
    [HierarchyKind::Unified, HierarchyKind::Memory]
        .into_iter()
        .flat_map(|kind| list_group_places(&mounts, &groups, kind))
        .collect()
}

/// Returns the places in which a new group can be created: in the group of this process, and then in its parents, up to
/// the mounted root.
fn list_group_places(mounts: &str, groups: &str, kind: HierarchyKind) -> Vec<PathBuf> {
    let limits_memory = |list: &str| list.split(',').any(|word| word == "memory");
    let own = groups.lines().find_map(|line| match kind {
        HierarchyKind::Unified => line.strip_prefix("0::"),
        HierarchyKind::Memory => {
            line.split_once(':')?.1.split_once(':').filter(|(list, _)| limits_memory(list)).map(|(_, path)| path)
        }
    });
    let Some(own) = own else { return Vec::new() };
    let mounted = mounts.lines().find_map(|line| {
        let (before, after) = line.split_once(" - ")?;
        let mut fields = before.split(' ').skip(3);
        let is_hierarchy = match kind {
            HierarchyKind::Unified => after.starts_with("cgroup2 "),
            HierarchyKind::Memory => {
                after.starts_with("cgroup ") && after.rsplit(' ').next().is_some_and(limits_memory)
            }
        };
        is_hierarchy.then_some((fields.next()?, fields.next()?))
    });
    let Some((root, top)) = mounted else { return Vec::new() };
    let top = Path::new(top);
    // A group outside of the mounted part cannot be named in this namespace.
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
        let places_in = |mounts, groups| list_group_places(mounts, groups, HierarchyKind::Unified);
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
    fn the_memory_of_version_1_is_found_by_its_controller() {
        let mounts = "32 31 0:28 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n\
                      33 31 0:29 / /sys/fs/cgroup/memory rw shared:9 - cgroup cgroup rw,memory\n\
                      34 31 0:30 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n";
        let groups = "5:memory:/a/b\n4:cpu,cpuacct:/c\n3:pids:/p\n0::/u\n";
        let memory = ["/sys/fs/cgroup/memory/a/b", "/sys/fs/cgroup/memory/a", "/sys/fs/cgroup/memory"];
        assert_eq!(list_group_places(mounts, groups, HierarchyKind::Memory), memory.map(PathBuf::from));
        assert!(
            list_group_places(&mounts.replace("memory", "pids"), groups, HierarchyKind::Memory).is_empty(),
            "not mounted"
        );
        assert_eq!(list_group_places(mounts, groups, HierarchyKind::Unified)[0], Path::new("/sys/fs/cgroup/unified/u"));
        assert!(list_group_places(mounts, "0::/u\n", HierarchyKind::Memory).is_empty());
    }

    #[test]
    fn groups_that_nobody_holds_are_swept_away() {
        let place = tempfile::tempdir().unwrap();
        let held = GroupPart::create_once(HierarchyKind::Memory, place.path());
        assert!(held.is_err(), "an ordinary folder is no group");
        let at = |name: &str| place.path().join(name);
        for name in ["fosssim-oracle-1-1", "fosssim-oracle-2-2", "other"] {
            std::fs::create_dir(at(name)).unwrap();
        }
        let living = File::open(at("fosssim-oracle-2-2")).unwrap();
        living.try_lock().unwrap();
        remove_abandoned_groups(place.path());
        let mut names: Vec<_> = std::fs::read_dir(place.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["fosssim-oracle-2-2", "other"]);
    }

    #[test]
    fn a_sweeper_never_takes_a_claimed_folder() {
        const CLAIMS: usize = 4000;
        let place = tempfile::tempdir().unwrap();
        let done = std::sync::atomic::AtomicBool::new(false);
        let (mut held, mut lost) = (Vec::new(), 0);
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    while !done.load(std::sync::atomic::Ordering::Relaxed) {
                        remove_abandoned_groups(place.path());
                    }
                });
            }
            for _ in 0..CLAIMS {
                match create_locked_group(place.path()) {
                    Ok((path, folder)) => held.push((path, folder)),
                    Err(error) => assert_eq!(error.kind(), io::ErrorKind::NotFound, "{error}"),
                }
                if held.len() == 8 {
                    lost += held.drain(..).filter(|(path, _)| std::fs::remove_dir(path).is_err()).count();
                }
            }
            done.store(true, std::sync::atomic::Ordering::Relaxed);
        });
        assert_eq!(lost, 0);
    }

    #[test]
    fn limits_are_set_where_there_are_controllers_and_the_end_is_read_back() {
        let (unified, memory) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let part = |kind, folder: &tempfile::TempDir| {
            let path = folder.path().to_path_buf();
            GroupPart { kind, folder: File::open(&path).unwrap(), path, limits: Vec::new() }
        };
        let mut group =
            Group { parts: vec![part(HierarchyKind::Unified, &unified), part(HierarchyKind::Memory, &memory)] };
        let limits = crate::Limits { memory: 1 << 20, folder_bytes: 1 << 10, processes: 4, ..crate::Limits::default() };
        let order = RunOrder { limits, ..RunOrder::default() };
        group.set_limits(&order).unwrap();
        assert!(group.controls().is_empty() && !group.was_out_of_memory() && group.cpu().is_zero());
        std::fs::write(unified.path().join("pids.max"), "").unwrap();
        for name in ["memory.limit_in_bytes", "memory.memsw.limit_in_bytes"] {
            std::fs::write(memory.path().join(name), "").unwrap();
        }
        group.set_limits(&order).unwrap();
        group.parts.iter_mut().for_each(GroupPart::find_limits);
        assert_eq!(group.controls(), ["memory", "threads and processes"]);
        let read = |path: PathBuf| std::fs::read_to_string(path).unwrap();
        let limit = ((65 << 20) + (1 << 10)).to_string();
        assert_eq!(read(memory.path().join("memory.limit_in_bytes")), limit);
        assert_eq!(read(memory.path().join("memory.memsw.limit_in_bytes")), limit);
        assert_eq!(read(unified.path().join("pids.max")), "20");
        std::fs::write(unified.path().join("memory.max"), "").unwrap();
        group.set_limits(&order).unwrap();
        assert_eq!(read(unified.path().join("memory.max")), limit);
        std::fs::write(unified.path().join("cpu.stat"), "usage_usec 1500\nuser_usec 1000\n").unwrap();
        assert_eq!(group.cpu(), Duration::from_micros(1500));
        std::fs::write(memory.path().join("memory.oom_control"), "under_oom 0\noom_kill 1\n").unwrap();
        assert!(group.was_out_of_memory());
    }

    #[test]
    fn the_kernels_counts_are_read_by_their_whole_name() {
        let text = "oom 3\noom_kill 2\noom_group_kill 1\n";
        assert_eq!(find_value(text, "oom_kill"), Some(2));
        assert_eq!(find_value(text, "oom"), Some(3));
        assert_eq!(find_value(text, "max"), None);
    }
}
