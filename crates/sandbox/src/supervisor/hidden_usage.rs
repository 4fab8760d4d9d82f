//! Measures the files and the memory of processes that are counted neither in the folder nor as resident memory. These
//! are files without a name that are open, mapped or executed, and mapped memory that is not resident for any process.

use std::{
    collections::BTreeSet,
    fs::{Metadata, read_dir},
    os::unix::{ffi::OsStrExt, fs::MetadataExt},
    path::Path,
};

use super::folder::BLOCK_BYTES;
use crate::machine;

/// The suffix with which the kernel marks a file that no longer has a name.
const DELETED_SUFFIX: &[u8] = b" (deleted)";
/// The names of shared memory that is not in a folder.
const SHARED_MEMORY: [&[u8]; 3] = [b"/dev/zero", b"/memfd:", b"/SYSV"];

/// The files and the memory that several processes hold together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct HiddenUsage {
    /// The number of bytes of files without a name.
    pub(super) nameless_bytes: u64,
    /// The number of bytes of memory that may be resident for no process.
    pub(super) memory: u64,
}

/// Returns the memory and files that `members` hold. Each member is a process and one of its threads. `root` is the
/// working folder, the only place in which they can create files. With `executed`, files that they execute are
/// included. With `page_tables`, the kernel's tables for their memory are included, which matter if address space is
/// not limited.
pub(super) fn measure(members: &[(i32, i32)], root: &Path, executed: bool, page_tables: bool) -> HiddenUsage {
    let mut holdings = HiddenUsage::default();
    let mut counted_inodes = BTreeSet::new();
    let mut mapped = Vec::new();
    for (pid, thread) in members {
        let task = format!("/proc/{pid}/task/{thread}");
        let mut count = |metadata: &Metadata| {
            if metadata.is_file() && metadata.nlink() == 0 && counted_inodes.insert(metadata.ino()) {
                holdings.nameless_bytes += metadata.blocks() * BLOCK_BYTES;
            }
        };
        for entry in read_dir(format!("{task}/fd")).into_iter().flatten().flatten() {
            std::fs::metadata(entry.path()).iter().for_each(&mut count);
        }
        let exe = format!("{task}/exe");
        if executed && std::fs::read_link(&exe).is_ok_and(|exe| exe.starts_with(root)) {
            std::fs::metadata(&exe).iter().for_each(&mut count);
        }
        let maps = std::fs::read(format!("{task}/maps")).unwrap_or_default();
        mapped.extend(maps.split(|byte| *byte == b'\n').filter_map(Mapping::parse));
        if page_tables {
            let status = std::fs::read_to_string(format!("{task}/status")).unwrap_or_default();
            holdings.memory += machine::read_byte_count(&status, "VmPTE:").unwrap_or(0);
        }
    }
    let root_in_maps = path_in_maps(root);
    // Only root can find out how much of a mapped file is on disk, so the size of the whole mapping counts.
    mapped.sort_unstable_by_key(|mapping| (mapping.inode, std::cmp::Reverse(mapping.end)));
    for mapping in mapped {
        let memory = mapping.is_shared && SHARED_MEMORY.iter().any(|name| mapping.name.starts_with(name));
        let file = mapping.name.starts_with(&root_in_maps);
        if (memory || file) && counted_inodes.insert(mapping.inode) {
            *(if memory { &mut holdings.memory } else { &mut holdings.nameless_bytes }) += mapping.end;
        }
    }
    holdings
}

/// Returns a path as it is written in `maps`, where a newline in a name would be ambiguous.
fn path_in_maps(path: &Path) -> Vec<u8> {
    let lines: Vec<&[u8]> = path.as_os_str().as_bytes().split(|byte| *byte == b'\n').collect();
    lines.join(&b"\\012"[..])
}

/// A mapping of a file that no longer has a name.
struct Mapping {
    is_shared: bool,
    /// The offset in the file at which the mapping ends.
    end: u64,
    inode: u64,
    name: Vec<u8>,
}

impl Mapping {
    /// Parses a line of `maps`, such as `7f00-7f10 rw-s 00000000 00:01 1042  /dev/zero (deleted)`.
    fn parse(line: &[u8]) -> Option<Self> {
        let line = line.strip_suffix(DELETED_SUFFIX)?;
        let start = line.iter().position(|byte| *byte == b'/')?;
        let mut fields = std::str::from_utf8(&line[..start]).ok()?.split_ascii_whitespace();
        let (from, to) = fields.next()?.split_once('-')?;
        let number = |text: &str| u64::from_str_radix(text, 16).ok();
        let shared = fields.next()?.ends_with('s');
        let end = number(fields.next()?)?.saturating_add(number(to)?.saturating_sub(number(from)?));
        let inode = fields.nth(1)?.parse().ok()?;
        Some(Self { is_shared: shared, end, inode, name: line[start..].to_vec() })
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn a_removed_file_that_is_still_open_counts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gone");
        let mut file = std::fs::File::create(&path).unwrap();
        file.write_all(&vec![1; 1 << 20]).unwrap();
        file.sync_all().unwrap();
        std::fs::remove_file(&path).unwrap();
        let own = std::process::id() as i32;
        assert!(measure(&[(own, own)], folder.path(), false, false).nameless_bytes >= 1 << 20);
    }

    #[test]
    fn mappings_are_read_to_their_end_in_the_file() {
        let parse = |line: &str| Mapping::parse(line.as_bytes());
        let mapping = parse("7f0000001000-7f0000003000 rw-s 00004000 00:01 1042                /dev/zero (deleted)");
        let mapping = mapping.unwrap();
        assert!(mapping.is_shared && mapping.end == 0x6000 && mapping.inode == 1042 && mapping.name == b"/dev/zero");
        assert!(parse("7f0000001000-7f0000003000 r--p 00000000 fe:00 7  /x/a (deleted)").is_some_and(|m| !m.is_shared));
        assert!(parse("7f0000001000-7f0000003000 r--p 00000000 fe:00 7  /x/a").is_none());
        assert!(parse("7f0000001000-7f0000003000 rw-p 00000000 00:00 0").is_none());
    }

    #[test]
    fn a_newline_in_the_path_hides_no_mapped_file() {
        assert_eq!(path_in_maps(Path::new("/a\nb/\n")), b"/a\\012b/\\012");
        assert_eq!(path_in_maps(Path::new("/a/b")), b"/a/b");
    }

    #[test]
    fn page_tables_are_memory_where_they_are_asked_for() {
        let own = std::process::id() as i32;
        assert!(measure(&[(own, own)], Path::new("/nowhere"), false, true).memory > 0);
    }
}
