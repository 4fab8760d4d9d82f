//! A working folder in memory. It is a file system, and the kernel limits its size and its number of files.
//!
//! Its files are removed at the end of the run, unless the grader still has them open. Their pages do not belong to a
//! process, so they count as a program's resident memory only while the program maps them. The limit of a control group
//! is large enough for all of them.

use std::{
    fs::{File, Permissions},
    io,
    os::unix::fs::{FileExt, MetadataExt, PermissionsExt},
    path::Path,
};

use rustix::io::Errno;

use crate::wire::{self, RawBytes, RunOrder};

/// The number of bytes that the folder may have beyond its limit, so that the supervisor notices that a program exceeds
/// it.
const SPARE_BYTES: u64 = 1 << 20;
const SPARE_FILES: u64 = 64;
/// The number of bytes that are copied at a time.
const BYTES_PER_COPY: usize = 1 << 16;

/// Returns the mount options for the folder of an order.
pub(super) fn format_mount_options(order: &RunOrder) -> String {
    let bytes = order.folder_bytes().saturating_add(SPARE_BYTES);
    let files = order.limits.folder_files.saturating_add(SPARE_FILES);
    format!("mode=700,size={bytes},nr_inodes={files}")
}

/// Copies files and folders with their permission bits. Holes in files remain holes. Links and special files are not
/// copied.
pub(super) fn copy_contents(from: &Path, to: &Path) -> io::Result<()> {
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let (metadata, target) = (entry.metadata()?, to.join(entry.file_name()));
        if metadata.is_dir() {
            std::fs::create_dir(&target)?;
            copy_contents(&entry.path(), &target)?;
        } else if metadata.is_file() {
            copy_blocks(&File::open(entry.path())?, &mut File::create_new(&target)?, u64::MAX)?;
        } else {
            continue;
        }
        std::fs::set_permissions(&target, Permissions::from_mode(metadata.mode() & 0o777))?;
    }
    Ok(())
}

/// Writes files into the folder.
///
/// # Errors
///
/// Fails if a name leads out of the folder, or if writing fails.
pub(super) fn add_files(folder: &Path, files: &[(RawBytes, Vec<u8>)]) -> io::Result<()> {
    for (name, content) in files {
        let plain = wire::entry_name(name).ok_or(io::ErrorKind::InvalidInput)?;
        std::fs::write(folder.join(plain), content)?;
    }
    Ok(())
}

/// Copies the blocks of a file that contain data. Holes between them remain holes.
///
/// # Errors
///
/// Fails with `OutOfMemory` if the blocks take more than `max_bytes` bytes.
pub(super) fn copy_blocks(from: &File, to: &mut File, max_bytes: u64) -> io::Result<()> {
    let mut buffer = vec![0; BYTES_PER_COPY];
    let (mut at, mut copied) = (0, 0);
    loop {
        // If the file system cannot report holes, the whole file is read. Blocks of zeros are skipped below.
        at = match rustix::fs::seek(from, rustix::fs::SeekFrom::Data(at)) {
            Err(Errno::NXIO) => break,
            Err(Errno::INVAL) => at,
            data => data?,
        };
        let read = match from.read_at(&mut buffer, at) {
            Ok(0) => break,
            Ok(read) => &buffer[..read],
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        if read.iter().any(|byte| *byte != 0) {
            copied += read.len() as u64;
            if copied > max_bytes {
                return Err(io::Error::from_raw_os_error(libc::ENOMEM));
            }
            to.write_all_at(read, at)?;
        }
        at += read.len() as u64;
    }
    to.set_len(from.metadata()?.len().max(at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_added_under_plain_names_only() {
        let folder = tempfile::tempdir().unwrap();
        let add = |name: &[u8]| add_files(folder.path(), &[(name.to_vec(), b"text".to_vec())]);
        add(b"scene.xml").unwrap();
        assert_eq!(std::fs::read(folder.path().join("scene.xml")).unwrap(), b"text");
        for name in [&b""[..], b".", b"..", b"../other", b"/other", b"a\0b"] {
            assert!(add(name).is_err(), "{name:?}");
        }
    }

    #[test]
    fn files_and_folders_are_copied_with_their_bits_and_holes() {
        let folder = tempfile::tempdir().unwrap();
        let (from, to) = (folder.path().join("from"), folder.path().join("to"));
        std::fs::create_dir_all(from.join("inner")).unwrap();
        std::fs::create_dir(&to).unwrap();
        std::fs::write(from.join("inner/run.sh"), "text").unwrap();
        std::fs::set_permissions(from.join("inner/run.sh"), Permissions::from_mode(0o755)).unwrap();
        File::create(from.join("sparse")).unwrap().set_len(50 << 20).unwrap();
        std::os::unix::fs::symlink("/etc/passwd", from.join("link")).unwrap();
        copy_contents(&from, &to).unwrap();
        assert_eq!(std::fs::read(to.join("inner/run.sh")).unwrap(), b"text");
        assert_eq!(to.join("inner/run.sh").metadata().unwrap().mode() & 0o777, 0o755);
        let sparse = to.join("sparse").metadata().unwrap();
        assert!(sparse.len() == 50 << 20 && sparse.blocks() < 100);
        assert!(to.join("link").symlink_metadata().is_err());
    }

    #[test]
    fn holes_of_any_size_are_passed_over_and_blocks_are_limited() {
        let folder = tempfile::tempdir().unwrap();
        let from = File::create_new(folder.path().join("from")).unwrap();
        from.set_len(1 << 40).unwrap();
        from.write_all_at(&[7; 4096], 1 << 39).unwrap();
        let from = File::open(folder.path().join("from")).unwrap();
        let mut to = File::create_new(folder.path().join("to")).unwrap();
        assert_eq!(copy_blocks(&from, &mut to, 4095).unwrap_err().kind(), io::ErrorKind::OutOfMemory);
        copy_blocks(&from, &mut to, BYTES_PER_COPY as u64).unwrap();
        let metadata = folder.path().join("to").metadata().unwrap();
        assert!(metadata.len() == 1 << 40 && metadata.blocks() < 1000, "{metadata:?}");
    }
}
