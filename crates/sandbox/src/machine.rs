//! Reads from the kernel how much memory the machine has and how much is in use.

#![expect(unsafe_code, reason = "these calls have no safe wrapper among the dependencies")]

/// Returns what the kernel reports in `sysinfo`.
fn read_sysinfo() -> libc::sysinfo {
    // SAFETY: an all-zero structure is valid and outlives the call, which fills it or leaves it unchanged.
    unsafe {
        let mut about: libc::sysinfo = std::mem::zeroed();
        libc::sysinfo(&raw mut about);
        about
    }
}

/// Returns the number of bytes in the line of a kernel report that begins with `label`. The report gives it in kB.
/// Returns `None` if there is no such line.
pub(super) fn read_byte_count(text: &str, label: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(label)?.strip_suffix(" kB"))?;
    line.trim().parse::<u64>().ok().map(|kib| kib << 10)
}

/// Returns whether memory may be swapped to disk. Swapped memory is not resident for any process.
pub(super) fn has_swap() -> bool {
    read_sysinfo().totalswap > 0
}
