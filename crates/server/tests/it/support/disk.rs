//! A small file system, and the contents of a server's folders.
use super::server::Server;
use fosssim_testing::{Need, skip};
use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// A file system of a few MiB in memory. It is unmounted when this value is dropped.
pub(crate) struct SmallDisk {
    place: PathBuf,
    folder: Option<tempfile::TempDir>,
}

impl SmallDisk {
    /// Mounts a file system of the given size; `None` if this user may not mount.
    pub(crate) fn mount(bytes: u64) -> Option<Self> {
        let folder = tempfile::tempdir().expect("a folder");
        let mut disk = Self::mount_at(folder.path(), bytes)?;
        disk.folder = Some(folder);
        Some(disk)
    }

    /// Mounts the file system at a folder, which is created.
    pub(crate) fn mount_at(folder: &Path, bytes: u64) -> Option<Self> {
        std::fs::create_dir_all(folder).expect("a folder");
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &format!("size={bytes},mode=700"), "tmpfs"])
            .arg(folder)
            .output();
        match mount {
            Ok(output) if output.status.success() => Some(Self { place: folder.to_owned(), folder: None }),
            Ok(output) => {
                skip(Need::Mounts, String::from_utf8_lossy(&output.stderr));
                None
            }
            Err(error) => {
                skip(Need::Mounts, error);
                None
            }
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.place
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        // Unmount lazily, because a server that is about to end may still have a file open.
        drop(Command::new("umount").arg("--lazy").arg(&self.place).status());
        drop(self.folder.take());
    }
}

/// Returns the number of files in a server's store and among its incoming uploads.
pub(crate) fn stored(server: &Server) -> usize {
    fn files(folder: &Path) -> usize {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|entry| if entry.path().is_dir() { files(&entry.path()) } else { 1 }).sum()
    }
    files(&server.folder.join("store")) + files(&server.folder.join("incoming"))
}
