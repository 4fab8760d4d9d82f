//! The machine's memory and its use, as the kernel reports them.

#![expect(unsafe_code, reason = "these calls have no safe wrapper among the dependencies")]

/// Returns the kernel's answer to `sysinfo`.
fn read_sysinfo() -> libc::sysinfo {
    // SAFETY: an all-zero structure is valid and outlives the call, which fills it or leaves it.
    unsafe {
        let mut about: libc::sysinfo = std::mem::zeroed();
        libc::sysinfo(&raw mut about);
        about
    }
}

/// Returns the bytes in a line of the kernel's report after this word, in kB.
pub(super) fn bytes_of(text: &str, word: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(word)?.strip_suffix(" kB"))?;
    line.trim().parse::<u64>().ok().map(|kib| kib << 10)
}

/// Returns whether memory may be moved to a disk, where it counts as resident for no process.
pub(super) fn has_swap() -> bool {
    read_sysinfo().totalswap > 0
}

/// Returns the answer to `sysinfo` of a machine on which nothing is in use and no other process runs, in the kernel's
/// form.
pub(super) fn without_others() -> Vec<u8> {
    let about = read_sysinfo();
    // SAFETY: an all-zero structure is valid. It is made of integers only; the bytes between them are zero as well, and
    // all bytes are read while it lives.
    unsafe {
        let mut told: libc::sysinfo = std::mem::zeroed();
        (told.uptime, told.mem_unit, told.procs) = (about.uptime, about.mem_unit, 1);
        (told.totalram, told.freeram) = (about.totalram, about.totalram);
        std::slice::from_raw_parts((&raw const told).cast::<u8>(), size_of_val(&told)).to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_machine_is_told_and_its_use_is_not() {
        let told = without_others();
        let word = |index: usize| u64::from_ne_bytes(told[8 * index..8 * index + 8].try_into().unwrap());
        // Uptime, three loads, memory in all and free.
        assert!(word(0) > 0 && word(4) > 0 && word(4) == word(5), "{told:?}");
        assert_eq!([word(1), word(2), word(3), word(6), word(7)], [0; 5]);
    }
}
