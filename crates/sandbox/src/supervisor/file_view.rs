//! Builds what a run can see of the file system: a new root folder, which contains the files of the order under their
//! usual paths.
//!
//! The places that Landlock allows (see `file_rules.rs`) are visible. Except for the working folder, they are
//! read-only. Other files of the host, and their names, are invisible. Folders in memory such as `/tmp` and `/dev/shm`
//! cannot be written, because files there would not count toward the memory of any process.

use std::{
    collections::VecDeque,
    ffi::{CString, OsString},
    fs::File,
    io,
    os::{
        fd::{AsFd, AsRawFd, BorrowedFd, OwnedFd},
        unix::{ffi::OsStrExt, fs::symlink},
    },
    path::{Component, Path, PathBuf},
};

use super::{file_rules, memory_folder};
use crate::{
    mounts::{self, NO_DEVICES, NO_SET_USER, READ_ONLY},
    sys,
    wire::{self, Failure, RawBytes, RunOrder, failure_at},
};

/// The folder in which the new root is built. Every Linux has it. It becomes visible again after the root was replaced.
const BUILD_ROOT: &str = "/proc";
/// The temporary name of the old root below the new root.
const OLD_ROOT_NAME: &str = "/.host";
/// The folder in which the prepared root of a user without privileges shows processes. Without it, copies of this root
/// may not show processes.
const PROC_PLACEHOLDER: &str = "/.processes";
/// The maximum number of links on a path. The kernel has the same limit.
const MAX_LINKS: u32 = 40;
/// Mount options that allow enough space for the folders, the links, and the empty files below mounts.
const ROOT_OPTIONS: &str = "mode=755,size=4m,nr_inodes=20k";

/// The access that a run has to a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Access {
    Read,
    Device,
    Write,
}

/// Replaces the root folder of this process, which must be the only one in its mount namespace.
///
/// # Errors
///
/// Fails with the name of the step that failed. The process then has an incomplete root and must end.
pub(super) fn build(order: &RunOrder) -> Result<(), Failure> {
    let view = new_root(order)?;
    let folder = wire::to_path(&order.folder);
    if order.is_in_memory {
        let laid = view.resolve(&folder).and_then(|real| {
            let real = real.ok_or(io::ErrorKind::NotFound)?;
            mount_copy(&real, &host_path(&real), order)
        });
        laid.map_err(failure_at("copy the working folder into memory"))?;
    }
    hide_own_files(order, Path::new("/"))?;
    add_processes(order)?;
    detach_host_files()?;
    close_root()
}

/// Builds the root without the run's working folder and processes. [`complete_view`] adds them to a copy.
///
/// # Errors
///
/// Fails like [`build`].
pub(super) fn prepare(order: &RunOrder) -> Result<(), Failure> {
    new_root(order)?;
    hide_own_files(order, Path::new("/"))?;
    if sys::user_id() != 0 {
        // The kernel allows a user without privileges to show processes only if processes are already visible
        // elsewhere.
        std::fs::create_dir(PROC_PLACEHOLDER).map_err(failure_at("make /proc"))?;
        mounts::mount(c"proc", &to_c_string(Path::new(PROC_PLACEHOLDER))?, c"", false)
            .map_err(failure_at("mount /proc"))?;
    }
    detach_host_files()
}

/// Adds the run's parts to a copy of a prepared root: a working folder with the contents of `folder` and `files`, and
/// the run's processes. The mount point of the folder must exist.
///
/// # Errors
///
/// Fails like [`build`].
pub(super) fn complete_view(
    order: &RunOrder,
    folder: BorrowedFd<'_>,
    files: &[(RawBytes, Vec<u8>)],
) -> Result<(), Failure> {
    add_processes(order)?;
    if sys::user_id() != 0 {
        mounts::detach(&to_c_string(Path::new(PROC_PLACEHOLDER))?).map_err(failure_at("leave other processes"))?;
    }
    let real = wire::to_path(&order.folder);
    let from = PathBuf::from(format!("/proc/self/fd/{}", folder.as_raw_fd()));
    mount_copy(&real, &from, order)
        .and_then(|()| memory_folder::add_files(&real, files))
        .map_err(failure_at("copy the working folder into memory"))?;
    hide_own_files(order, &real)?;
    close_root()
}

/// Returns a new root with all visible files outside of the working folder. It also contains the working folder, unless
/// that is in memory.
fn new_root(order: &RunOrder) -> Result<FileView, Failure> {
    sys::set_file_mask(0o022);
    mounts::make_mounts_private().map_err(failure_at("make the mounts private"))?;
    let (site, room) = (to_c_string(Path::new(BUILD_ROOT))?, to_c_string(Path::new(ROOT_OPTIONS))?);
    mounts::mount(c"tmpfs", &site, &room, false).map_err(failure_at("make a root folder"))?;
    let old = PathBuf::from(format!("{BUILD_ROOT}{OLD_ROOT_NAME}"));
    std::fs::create_dir(&old).map_err(failure_at("make a root folder"))?;
    mounts::change_root(&site, &to_c_string(&old)?).map_err(failure_at("change the root folder"))?;
    let mut view = FileView { mounted_places: Vec::new() };
    let mut readable = file_rules::list_visible_paths(order);
    readable.sort_by_key(|path| path.as_os_str().len());
    for (path, access) in readable
        .into_iter()
        .map(|path| (path, Access::Read))
        .chain(file_rules::DEVICE_FILES.map(|path| (path.into(), Access::Device)))
        .chain((!order.is_in_memory).then(|| (wire::to_path(&order.folder), Access::Write)))
    {
        view.mount_place(&path, access)
            .map_err(|error| Failure::new(format!("make {} visible", path.display()), &error))?;
    }
    let folders = file_rules::LIBRARY_FOLDERS.map(PathBuf::from);
    for path in folders.into_iter().chain(order.named_paths.iter().map(wire::to_path)) {
        // Only the links on the path are created. The targets of links are among the executable files, or were
        // replaced.
        view.resolve(&path).map_err(|error| Failure::new(format!("make {} visible", path.display()), &error))?;
    }
    for (name, number) in [("/dev/fd", ""), ("/dev/stdin", "/0"), ("/dev/stdout", "/1"), ("/dev/stderr", "/2")] {
        symlink(format!("/proc/self/fd{number}"), name).map_err(failure_at("make /dev"))?;
    }
    std::fs::create_dir_all("/proc").map_err(failure_at("make /proc"))?;
    Ok(view)
}

/// Covers those of the grader's own files and folders that are visible below `beneath` with empty ones.
fn hide_own_files(order: &RunOrder, beneath: &Path) -> Result<(), Failure> {
    let own: Vec<PathBuf> =
        order.own_files.iter().map(wire::to_path).filter(|path| path.starts_with(beneath)).collect();
    if own.is_empty() {
        return Ok(());
    }
    // The sample program may be graded at its own path, to demonstrate grading.
    let program = wire::to_path(&order.program).canonicalize().map_err(failure_at("examine the program"))?;
    for path in own.iter().filter(|path| **path != program) {
        hide(path).map_err(failure_at("hide the grader's own files"))?;
    }
    Ok(())
}

/// Covers a visible file or folder with an empty one.
fn hide(path: &Path) -> io::Result<()> {
    let Ok(metadata) = path.symlink_metadata() else { return Ok(()) };
    if metadata.is_dir() {
        return mounts::mount(c"tmpfs", &c_string(path)?, c"mode=0,size=4k,nr_inodes=1", false);
    }
    let nothing = mounts::copy_mounts(c"/dev/null")?;
    mounts::restrict(nothing.as_fd(), READ_ONLY | NO_SET_USER | NO_DEVICES)?;
    mounts::attach(nothing.as_fd(), &c_string(path)?)
}

/// Makes the processes of the run visible.
fn add_processes(order: &RunOrder) -> Result<(), Failure> {
    let options = if order.allows_tools { c"" } else { c"subset=pid" };
    mounts::mount(c"proc", c"/proc", options, false).map_err(failure_at("mount /proc"))
}

/// Hides `/proc` from this process, except for the process's own entry. The entry is in an ordinary folder, because the
/// link count of the real `/proc` reveals the number of processes. If no file rules protect the entry, only some of its
/// files are visible. Otherwise the program could name `/proc/self/exe`, which is the grader at first, as its loader.
pub(super) fn hide_other_processes(order: &RunOrder) -> Result<(), Failure> {
    let own = std::process::id().to_string();
    let process_folder = Path::new("/proc").join(&own);
    let leave = || -> io::Result<()> {
        mounts::unshare(libc::CLONE_NEWNS)?;
        let copy = |path: PathBuf| Ok((mounts::copy_mounts(&c_string(&path)?)?, path));
        let parts: Vec<(OwnedFd, PathBuf)> = match order.layers.landlock {
            true => vec![copy(process_folder.clone())?],
            false => file_rules::visible_entry_parts()
                .map(|name| copy(process_folder.join(name)))
                .collect::<io::Result<_>>()?,
        };
        mounts::mount(c"tmpfs", c"/proc", c"mode=555,size=4k,nr_inodes=20", false)?;
        std::fs::create_dir(&process_folder)?;
        symlink(&own, "/proc/self")?;
        for (part, path) in parts {
            if path.ends_with("fd") {
                std::fs::create_dir(&path)?;
            } else if path != process_folder {
                File::create(&path)?;
            }
            mounts::attach(part.as_fd(), &c_string(&path)?)?;
        }
        mounts::restrict_at(c"/proc", READ_ONLY)
    };
    leave().map_err(failure_at("leave other processes"))
}

fn detach_host_files() -> Result<(), Failure> {
    mounts::detach(&to_c_string(Path::new(OLD_ROOT_NAME))?).map_err(failure_at("detach the host's files"))?;
    std::fs::remove_dir(OLD_ROOT_NAME).map_err(failure_at("detach the host's files"))
}

fn close_root() -> Result<(), Failure> {
    mounts::restrict_at(c"/", READ_ONLY).map_err(failure_at("close the root folder"))
}

/// Mounts a file system in memory at the path `folder`, and copies the contents of another folder into it.
fn mount_copy(folder: &Path, from: &Path, order: &RunOrder) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let options = CString::new(memory_folder::format_mount_options(order)).map_err(io::Error::other)?;
    mounts::mount(c"tmpfs", &c_string(folder)?, &options, order.allows_tools)?;
    memory_folder::copy_contents(from, folder)
}

fn to_c_string(path: &Path) -> Result<CString, Failure> {
    c_string(path).map_err(failure_at("read a path"))
}

fn c_string(path: &Path) -> io::Result<CString> {
    CString::new(path.as_os_str().as_bytes()).map_err(io::Error::other)
}

/// Returns the path by which a file of the host is reached while the new root is built.
fn host_path(path: &Path) -> PathBuf {
    let mut host = OsString::from(OLD_ROOT_NAME);
    host.push(path);
    host.into()
}

/// The root directory for the submission, which is still being assembled.
struct FileView {
    mounted_places: Vec<(PathBuf, Access)>,
}

impl FileView {
    /// Makes the file or folder at the path visible under the same path. If the host has no such path, nothing is done.
    /// `/proc` is also left out, because it is created separately.
    fn mount_place(&mut self, path: &Path, access: Access) -> io::Result<()> {
        let Some(real) = self.resolve(path)? else { return Ok(()) };
        if real == Path::new("/") {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        if real.starts_with("/proc") || self.is_visible(&real, access) {
            return Ok(());
        }
        let source = host_path(&real);
        if source.is_dir() {
            std::fs::create_dir_all(&real)?;
        } else {
            std::fs::create_dir_all(real.parent().unwrap_or(Path::new("/")))?;
            // If a folder above the file is mounted, the file already exists.
            if !real.exists() {
                File::create(&real)?;
            }
        }
        let tree = mounts::copy_mounts(&c_string(&source)?)?;
        let attributes = match access {
            Access::Read => READ_ONLY | NO_SET_USER | NO_DEVICES,
            Access::Device => READ_ONLY | NO_SET_USER,
            Access::Write => NO_SET_USER | NO_DEVICES,
        };
        mounts::restrict(tree.as_fd(), attributes)?;
        mounts::attach(tree.as_fd(), &c_string(&real)?)?;
        self.mounted_places.push((real, access));
        Ok(())
    }

    /// Returns whether the path is already visible, and with the same access.
    fn is_visible(&self, path: &Path, access: Access) -> bool {
        self.mounted_places.iter().any(|(shown, granted)| path.starts_with(shown) && *granted == access)
    }

    /// Returns the path without links. Each link on the path is also created in the new root. Returns `None` if the
    /// host has no accessible file at the path.
    fn resolve(&self, path: &Path) -> io::Result<Option<PathBuf>> {
        let mut real = PathBuf::from("/");
        let mut remaining_parts: VecDeque<OsString> = path_components(path);
        let mut links = 0;
        while let Some(name) = remaining_parts.pop_front() {
            if name == ".." {
                real.pop();
                continue;
            }
            let next = real.join(&name);
            let Ok(metadata) = host_path(&next).symlink_metadata() else { return Ok(None) };
            if !metadata.is_symlink() {
                real = next;
                continue;
            }
            links += 1;
            let Ok(target) = std::fs::read_link(host_path(&next)) else { return Ok(None) };
            if links > MAX_LINKS {
                return Ok(None);
            }
            if next.symlink_metadata().is_err() {
                std::fs::create_dir_all(&real)?;
                symlink(&target, &next)?;
            }
            if target.is_absolute() {
                real = PathBuf::from("/");
            }
            for name in path_components(&target).into_iter().rev() {
                remaining_parts.push_front(name);
            }
        }
        Ok(Some(real))
    }
}

/// Returns the components of a path. Empty components and `.` are left out.
fn path_components(path: &Path) -> VecDeque<OsString> {
    path.components()
        .filter_map(|part| match part {
            Component::Normal(name) => Some(name.into()),
            Component::ParentDir => Some("..".into()),
            _ => None,
        })
        .collect()
}
