//! Measures the working folder for the supervisor, and changes the owner of its contents.
//!
//! The program changes the folder while the supervisor reads it. Therefore folders are opened by descriptor, without
//! following links. It is not an error if an entry disappears.

use std::{
    ffi::CString,
    fs::{Metadata, Permissions},
    io,
    os::{
        fd::{AsFd, AsRawFd, BorrowedFd},
        unix::{
            ffi::OsStrExt,
            fs::{MetadataExt, PermissionsExt},
        },
    },
    path::{Path, PathBuf},
};

use crate::{
    mounts,
    sys::{self, OFlags},
};

/// The maximum depth of folders. It is more than programs need.
const MAX_DEPTH: u32 = 32;
/// The size of the blocks that `stat` counts, in bytes.
pub(super) const BLOCK_BYTES: u64 = 512;

/// The numbers of bytes and files in a folder.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct FolderUsage {
    /// The number of bytes on disk.
    pub(super) bytes: u64,
    /// The number of files and folders.
    pub(super) files: u64,
    /// The number of folders; 0 if they were not counted.
    pub(super) folders: u64,
    /// Whether a part could not be counted, because it is too deep, cannot be entered, or is beyond the limits.
    pub(super) exceeds_limit: bool,
}

impl FolderUsage {
    /// Returns the larger value of each field.
    pub(super) fn field_maximum(self, other: Self) -> Self {
        Self {
            bytes: self.bytes.max(other.bytes),
            files: self.files.max(other.files),
            folders: self.folders.max(other.folders),
            exceeds_limit: self.exceeds_limit || other.exceeds_limit,
        }
    }
}

/// Returns the bytes and files in the file system whose root is `folder`, as the kernel counts them. This includes
/// removed files that are still in use.
pub(super) fn file_system_usage(folder: BorrowedFd<'_>) -> FolderUsage {
    let (bytes, files) = mounts::file_system_usage(folder).unwrap_or_default();
    // The root folder is counted as a file, so it is subtracted.
    FolderUsage { bytes, files: files.saturating_sub(1), ..FolderUsage::default() }
}

/// Counts the bytes and files in a folder. Counting stops as soon as a limit is exceeded.
pub(super) fn measure(folder: BorrowedFd<'_>, most_bytes: u64, most_files: u64) -> FolderUsage {
    let mut contents = FolderUsage::default();
    let is_complete = walk(folder, 0, &mut |_, metadata| {
        contents.bytes += metadata.blocks() * BLOCK_BYTES;
        contents.files += 1;
        contents.folders += u64::from(metadata.is_dir());
        contents.bytes <= most_bytes && contents.files <= most_files
    });
    contents.exceeds_limit = !is_complete;
    contents
}

/// Changes the owner and the group of the folder and its contents. Files with several hard links are skipped, because
/// another link may be outside the folder. This must be called only when no process of the program is alive.
pub(super) fn change_owner(folder: BorrowedFd<'_>, user: u32, group: u32) -> io::Result<()> {
    walk(folder, 0, &mut |path, metadata| {
        let kind = metadata.file_type();
        if kind.is_dir() || (kind.is_file() && metadata.nlink() == 1) {
            // If the owner of an entry cannot be changed, the program cannot change this entry.
            let _ = std::os::unix::fs::lchown(path, Some(user), Some(group));
        }
        true
    });
    sys::change_owner(folder, user, group)
}

/// Sets the permissions of all folders so that their owner can read and remove them, at any depth. Entries deeper than
/// [`MAX_DEPTH`] are moved up into `folder`, because the process that removes it would run out of descriptors. Returns
/// true if no entry was that deep. This must be called only when no process of the program is alive.
pub(crate) fn open_closed_folders(folder: BorrowedFd<'_>) -> bool {
    let mut moved: Vec<CString> = Vec::new();
    open_folder_level(folder, folder, 0, &mut moved);
    let mut next = 0;
    while let Some(name) = moved.get(next) {
        next += 1;
        if let Ok(inner) = sys::open_beneath(folder, name, OFlags::RDONLY | OFlags::DIRECTORY) {
            open_folder_level(folder, inner.as_fd(), 1, &mut moved);
        }
    }
    moved.is_empty()
}

/// Sets the permissions of the folders below a folder that is at `depth`. Records the new names of those that were too
/// deep.
fn open_folder_level(root: BorrowedFd<'_>, folder: BorrowedFd<'_>, depth: u32, moved: &mut Vec<CString>) {
    let Ok(entries) = std::fs::read_dir(read_descriptor_path(folder)) else { return };
    for entry in entries.flatten().filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir())) {
        let Ok(name) = CString::new(entry.file_name().as_bytes()) else { continue };
        let Ok(opened) = sys::open_beneath(folder, &name, OFlags::PATH | OFlags::DIRECTORY) else { continue };
        let Ok(mode) =
            std::fs::metadata(read_descriptor_path(opened.as_fd())).map(|metadata| metadata.permissions().mode())
        else {
            continue;
        };
        if mode & 0o700 != 0o700 {
            // If a folder still cannot be read, the next measurement reports it as beyond the limit.
            let _ =
                std::fs::set_permissions(read_descriptor_path(opened.as_fd()), Permissions::from_mode(mode | 0o700));
        }
        drop(opened);
        if depth < MAX_DEPTH {
            if let Ok(inner) = sys::open_beneath(folder, &name, OFlags::RDONLY | OFlags::DIRECTORY) {
                open_folder_level(root, inner.as_fd(), depth + 1, moved);
            }
        } else if let Some(name) = find_free_name(root, moved.len())
            && std::fs::rename(entry.path(), read_descriptor_path(root).join(&name)).is_ok()
        {
            moved.extend(CString::new(name));
        }
    }
}

/// Returns a name that no entry of the folder has.
fn find_free_name(folder: BorrowedFd<'_>, from: usize) -> Option<String> {
    const MAX_TRIES: usize = 100_000;
    let names = (from..from + MAX_TRIES).map(|number| format!(".too-deep-{number}"));
    { names }.find(|name| read_descriptor_path(folder).join(name).symlink_metadata().is_err())
}

/// Returns the path of an open folder.
fn read_descriptor_path(folder: BorrowedFd<'_>) -> PathBuf {
    PathBuf::from(format!("/proc/self/fd/{}", folder.as_raw_fd()))
}

/// Visits everything below the folder until the visitor stops it. Returns whether everything was visited. The paths
/// that the visitor receives begin with `/proc/self/fd`, and are valid only during the visit.
fn walk(folder: BorrowedFd<'_>, depth: u32, visit: &mut dyn FnMut(&Path, &Metadata) -> bool) -> bool {
    let Ok(entries) = std::fs::read_dir(format!("/proc/self/fd/{}", folder.as_raw_fd())) else { return false };
    for entry in entries {
        let Ok(entry) = entry else { return false };
        let path = entry.path();
        let Ok(metadata) = path.symlink_metadata() else { continue };
        if !visit(&path, &metadata) {
            return false;
        }
        if !metadata.is_dir() {
            continue;
        }
        let Ok(name) = CString::new(entry.file_name().as_bytes()) else { return false };
        let inner = match sys::open_beneath(folder, &name, OFlags::RDONLY | OFlags::DIRECTORY) {
            Ok(inner) => inner,
            Err(error) if matches!(error.raw_os_error(), Some(libc::ENOENT | libc::ENOTDIR | libc::ELOOP)) => continue,
            Err(_) => return false,
        };
        if depth == MAX_DEPTH || !walk(inner.as_fd(), depth + 1, visit) {
            return false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(folder: &tempfile::TempDir) -> std::fs::File {
        std::fs::File::open(folder.path()).unwrap()
    }

    #[test]
    fn bytes_on_disk_and_entries_are_counted_at_every_depth() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("a/b")).unwrap();
        std::fs::write(folder.path().join("a/b/file"), vec![1; 100_000]).unwrap();
        std::os::unix::fs::symlink("/usr", folder.path().join("link")).unwrap();
        let contents = measure(opened(&folder).as_fd(), 1 << 30, 100);
        assert_eq!(contents.files, 4, "two folders, a file, a link that is not followed");
        assert!(!contents.exceeds_limit);
        let contents = measure(opened(&folder).as_fd(), 1 << 30, 3);
        assert!(contents.exceeds_limit && contents.files == 4);
    }

    #[test]
    fn holes_do_not_count_and_depth_has_an_end() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::File::create(folder.path().join("sparse")).unwrap().set_len(1 << 40).unwrap();
        assert!(!measure(opened(&folder).as_fd(), 1 << 20, 100).exceeds_limit);
        std::fs::create_dir_all(folder.path().join("x/".repeat(40))).unwrap();
        assert!(measure(opened(&folder).as_fd(), 1 << 20, 100).exceeds_limit);
    }

    #[test]
    fn closed_folders_are_opened_at_any_depth_and_can_then_be_removed() {
        let folder = tempfile::tempdir().unwrap();
        // Folders are created from the inside out, so that a user without privileges can do it as well.
        let deep = folder.path().join("d/".repeat(300));
        std::fs::create_dir_all(&deep).unwrap();
        let mut closed = deep.components().as_path();
        while closed != folder.path() {
            std::fs::set_permissions(closed, Permissions::from_mode(0o000)).unwrap();
            closed = closed.parent().unwrap();
        }
        assert!(!open_closed_folders(opened(&folder).as_fd()), "it says that something lay too deep");
        let mut folders = 0;
        let whole = walk(opened(&folder).as_fd(), 0, &mut |_, metadata| {
            folders += 1;
            metadata.permissions().mode() & 0o700 == 0o700
        });
        assert!(whole && folders == 300, "{folders} folders");
        assert!(open_closed_folders(opened(&folder).as_fd()));
        folder.close().unwrap();
    }
}
