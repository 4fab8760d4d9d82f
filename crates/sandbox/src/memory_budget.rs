//! Decides whether the machine has enough memory for a working folder.

use std::{
    path::{Path, PathBuf},
    sync::{Mutex, OnceLock, PoisonError},
    time::{Duration, Instant},
};

use super::machine;

/// Returns whether a folder of `bytes` bytes may be in memory. The machine and the grader's control groups must have
/// space for one folder per simultaneous run, and as much again for the programs.
pub(super) fn has_memory_for(bytes: u64) -> bool {
    static SIMULTANEOUS_RUNS: OnceLock<u64> = OnceLock::new();
    let runs =
        SIMULTANEOUS_RUNS.get_or_init(|| std::thread::available_parallelism().map_or(1, |count| count.get() as u64));
    memory_left().is_some_and(|left| bytes <= left / (2 * runs.max(&2)))
}

/// Returns the memory that is left on the machine and in the grader's control groups. The value may be slightly
/// outdated, because the kernel needs more time to compute it than a small program needs to start.
fn memory_left() -> Option<u64> {
    const CACHE_LIFETIME: Duration = Duration::from_millis(500);
    static LAST_MEASUREMENT: Mutex<Option<(Instant, Option<u64>)>> = Mutex::new(None);
    let mut last = LAST_MEASUREMENT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((when, left)) = *last
        && when.elapsed() < CACHE_LIFETIME
    {
        return left;
    }
    let left = std::iter::once(available_memory())
        .chain(limited_groups().iter().map(LimitedGroup::memory_left))
        .flatten()
        .min();
    *last = Some((Instant::now(), left));
    left
}

/// Returns the memory that the kernel could give to programs.
fn available_memory() -> Option<u64> {
    machine::read_byte_count(&std::fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// A control group of this process that may limit memory.
#[derive(Debug, PartialEq, Eq)]
struct LimitedGroup {
    limit: PathBuf,
    usage: PathBuf,
}

impl LimitedGroup {
    /// Returns the memory that is left in the group; `None` if the group has no limit.
    fn memory_left(&self) -> Option<u64> {
        let number = |path: &Path| std::fs::read_to_string(path).ok()?.trim().parse::<u64>().ok();
        Some(number(&self.limit)?.saturating_sub(number(&self.usage)?))
    }
}

/// Returns the control groups of this process, in both versions of control groups.
fn limited_groups() -> &'static [LimitedGroup] {
    static LIMITED_GROUPS: OnceLock<Vec<LimitedGroup>> = OnceLock::new();
    LIMITED_GROUPS.get_or_init(|| {
        let folders = crate::supervisor::memory_groups();
        let limited = |folder: &PathBuf| {
            let names = [("memory.max", "memory.current"), ("memory.limit_in_bytes", "memory.usage_in_bytes")];
            let (limit, usage) = names.into_iter().find(|(limit, _)| folder.join(limit).exists())?;
            Some(LimitedGroup { limit: folder.join(limit), usage: folder.join(usage) })
        };
        folders.iter().filter_map(limited).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_folder_fits_and_one_larger_than_the_machine_does_not() {
        assert!(has_memory_for(1 << 20));
        assert!(!has_memory_for(1 << 60));
        assert_eq!(
            machine::read_byte_count("MemTotal: 9 kB\nMemAvailable:    1024 kB\n", "MemAvailable:"),
            Some(1 << 20)
        );
    }

    #[test]
    fn possible_points_of_a_group_count() {
        let folder = tempfile::tempdir().unwrap();
        let group =
            LimitedGroup { limit: folder.path().join("memory.max"), usage: folder.path().join("memory.current") };
        assert_eq!(group.memory_left(), None);
        std::fs::write(&group.usage, "300\n").unwrap();
        std::fs::write(&group.limit, "max\n").unwrap();
        assert_eq!(group.memory_left(), None, "it has no limit");
        std::fs::write(&group.limit, "1000\n").unwrap();
        assert_eq!(group.memory_left(), Some(700));
    }
}
