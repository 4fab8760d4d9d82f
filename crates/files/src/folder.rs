//! Accesses files below a folder that others may have filled, or may be filling at the same time.
use super::{
    Identity,
    error::{FileError, escape, require_regular_file},
};
use rustix::{
    fs::{AtFlags, CWD, Dir, FileType, Mode, OFlags, mkdirat, openat, statat, unlinkat},
    io::Errno,
};
use std::{
    ffi::{OsStr, OsString},
    fs::{File, OpenOptions},
    io::{self, Read},
    os::{
        fd::{AsFd, AsRawFd, BorrowedFd, OwnedFd},
        unix::{ffi::OsStrExt, fs::MetadataExt, fs::OpenOptionsExt},
    },
    path::{Component, Path, PathBuf},
    sync::Arc,
};

/// The flags with which files are opened. A link is never followed, opening never waits, and child processes do not
/// inherit the file.
const SAFE_FLAGS: OFlags = OFlags::NOFOLLOW.union(OFlags::NONBLOCK).union(OFlags::CLOEXEC);

/// The permission bits of a new folder, before the process's mask is applied.
const FOLDER_MODE: u32 = 0o777;

/// An open folder. Its entries are accessed only relative to the open folder, so that no link and no replaced path
/// leads out of it.
#[derive(Debug, Clone)]
pub struct Folder {
    fd: Arc<OwnedFd>,
    /// The path by which the folder was opened, for messages.
    display_path: PathBuf,
}

/// An entry of a [`Folder`].
#[derive(Debug)]
pub enum FolderEntry {
    /// An open regular file.
    File(File),
    /// A subfolder, which is open.
    Folder(Folder),
    /// Anything else: a link, a pipe, a socket or a device.
    Other,
}

impl From<OwnedFd> for Folder {
    fn from(folder: OwnedFd) -> Self {
        Self { fd: Arc::new(folder), display_path: PathBuf::new() }
    }
}

impl Folder {
    /// Opens the folder at `path`, to read its entries. The path itself may contain links.
    ///
    /// # Errors
    /// Fails if the folder does not exist, or access is denied.
    pub fn open(path: &Path) -> io::Result<Self> {
        let folder = OpenOptions::new().read(true).custom_flags(libc::O_DIRECTORY | libc::O_NONBLOCK).open(path)?;
        Ok(Self { fd: Arc::new(folder.into()), display_path: path.to_owned() })
    }

    /// Opens a folder in order to write files into it. The folder need not be readable.
    ///
    /// # Errors
    /// Fails if the folder does not exist, or access is denied.
    pub fn open_to_write(path: &Path) -> io::Result<Self> {
        let flags = OFlags::PATH | OFlags::DIRECTORY | OFlags::CLOEXEC;
        Ok(Self { fd: Arc::new(openat(CWD, path, flags, Mode::empty())?), display_path: path.to_owned() })
    }

    /// Opens a folder as [`Folder::open_to_write`] does. Missing folders on the path are created.
    ///
    /// # Errors
    /// Fails if a folder cannot be created or opened.
    pub fn create(path: &Path) -> io::Result<Self> {
        std::fs::create_dir_all(path)?;
        Self::open_to_write(path)
    }

    /// Returns the path by which the folder was opened.
    pub fn given_path(&self) -> &Path {
        &self.display_path
    }

    /// Returns the names of all entries of the folder.
    ///
    /// # Errors
    /// Fails if the folder cannot be read.
    pub fn list_names(&self) -> io::Result<Vec<OsString>> {
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | SAFE_FLAGS;
        let mut names = Vec::new();
        for entry in Dir::new(openat(&*self.fd, ".", flags, Mode::empty())?)? {
            let entry = entry?;
            let name = entry.file_name().to_bytes();
            if !matches!(name, b"." | b"..") {
                names.push(OsStr::from_bytes(name).to_owned());
            }
        }
        Ok(names)
    }

    /// Opens an entry of the folder.
    ///
    /// # Errors
    /// Fails if the entry cannot be opened. The error is [`io::ErrorKind::NotFound`] if it was removed.
    pub fn entry(&self, name: &OsStr) -> io::Result<FolderEntry> {
        let file = match openat(&*self.fd, check_single_component(name)?, OFlags::RDONLY | SAFE_FLAGS, Mode::empty()) {
            Ok(fd) => File::from(fd),
            Err(Errno::LOOP | Errno::NXIO | Errno::NODEV) => return Ok(FolderEntry::Other),
            Err(error) => return Err(error.into()),
        };
        let kind = file.metadata()?.file_type();
        Ok(match () {
            () if kind.is_file() => FolderEntry::File(file),
            () if kind.is_dir() => FolderEntry::Folder(self.inner(file.into(), name)),
            () => FolderEntry::Other,
        })
    }

    /// Opens the subfolder `name`, in order to write into it.
    ///
    /// # Errors
    /// Fails if the subfolder does not exist, or is a link.
    pub fn open_folder(&self, name: &OsStr) -> io::Result<Self> {
        let inner =
            open_component(self.as_fd(), check_single_component(name)?).map_err(|error| match error.raw_os_error() {
                Some(libc::ELOOP) => io::Error::other("this is a link, which is not followed; remove it"),
                _ => error,
            });
        Ok(self.inner(inner?, name))
    }

    /// Opens a subfolder as [`Folder::open_folder`] does. It is created if it does not exist.
    ///
    /// # Errors
    /// Fails if the subfolder cannot be created, or if an entry of another kind has its name.
    pub fn create_folder(&self, name: &OsStr) -> io::Result<Self> {
        match mkdirat(&*self.fd, check_single_component(name)?, Mode::from_raw_mode(FOLDER_MODE)) {
            Ok(()) | Err(Errno::EXIST) => self.open_folder(name),
            Err(error) => Err(error.into()),
        }
    }

    /// Opens the regular file `name`, and returns its length in bytes. The name may contain `/`, but must not lead out
    /// of the folder.
    ///
    /// # Errors
    /// Fails if the file does not exist, is not a regular file, is reached through a link, or is longer than
    /// `max_bytes`.
    pub fn open_file(&self, name: &OsStr, max_bytes: u64) -> Result<(File, u64), FileError> {
        let printable_name = || escape(name);
        let file = self.open_beneath(name).map_err(|error| FileError::from_open_error(printable_name(), error))?;
        let length = require_regular_file(&file, printable_name)?.len();
        if length > max_bytes {
            return Err(FileError::TooLong { name: printable_name(), length, limit: max_bytes });
        }
        Ok((file, length))
    }

    /// Opens a file as [`Folder::open_file`] does. The file must have only one hard link.
    ///
    /// # Errors
    /// Fails like [`Folder::open_file`]. Also fails if the file has several hard links.
    pub fn regular_file(&self, name: &str, max_bytes: u64) -> Result<(File, u64), FileError> {
        let (file, length) = self.open_file(OsStr::new(name), max_bytes)?;
        let links = require_regular_file(&file, || escape(OsStr::new(name)))?.nlink();
        if links != 1 {
            return Err(FileError::Linked { name: escape(OsStr::new(name)), links });
        }
        Ok((file, length))
    }

    /// Reads the contents of a regular file.
    ///
    /// # Errors
    /// Fails like [`Folder::open_file`]. Also fails if the file becomes longer than `max_bytes` while it is read.
    pub fn read(&self, name: &OsStr, max_bytes: u64) -> Result<Vec<u8>, FileError> {
        let (file, length) = self.open_file(name, max_bytes)?;
        let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or_default() + 1);
        file.take(max_bytes + 1)
            .read_to_end(&mut bytes)
            .map_err(|source| FileError::System { name: escape(name), source })?;
        match bytes.len() as u64 {
            length if length > max_bytes => Err(FileError::TooLong { name: escape(name), length, limit: max_bytes }),
            _ => Ok(bytes),
        }
    }

    /// Opens a file of the grader for reading and writing. It is created if it does not exist.
    ///
    /// # Errors
    /// Fails if an entry of another kind has its name.
    pub fn own_file(&self, name: &str) -> Result<File, FileError> {
        let flags = OFlags::RDWR | OFlags::CREATE | SAFE_FLAGS;
        let opened = openat(&*self.fd, name, flags, Mode::from_raw_mode(0o666));
        let file = opened.map_err(|error| FileError::from_open_error(name.to_owned(), error.into()))?;
        let file = File::from(file);
        require_regular_file(&file, || name.to_owned())?;
        Ok(file)
    }

    /// Removes a file or a link. If it does not exist, nothing is done.
    ///
    /// # Errors
    /// Fails if the entry cannot be removed.
    pub fn remove(&self, name: &OsStr) -> io::Result<()> {
        match unlinkat(&*self.fd, check_single_component(name)?, AtFlags::empty()) {
            Ok(()) | Err(Errno::NOENT) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    /// Returns whether the folder has an entry named `name`.
    pub fn contains(&self, name: &OsStr) -> bool {
        statat(&*self.fd, name, AtFlags::SYMLINK_NOFOLLOW).is_ok()
    }

    /// Returns the identity of a regular file and the user ID of its owner, without opening it. Returns `None` for
    /// links and for anything else.
    pub fn identity(&self, name: &OsStr) -> Option<(Identity, u32)> {
        let (folder, last) = self.split_parent(Path::new(name)).ok()?;
        let stat = statat(&*folder, last, AtFlags::SYMLINK_NOFOLLOW).ok();
        let stat = stat.filter(|stat| FileType::from_raw_mode(stat.st_mode) == FileType::RegularFile)?;
        Some((Identity::new(stat.st_dev, stat.st_ino), stat.st_uid))
    }

    /// Returns a path that leads to this folder while it is open, even if the folder is moved.
    pub fn path(&self) -> PathBuf {
        PathBuf::from(format!("/proc/self/fd/{}", self.fd.as_raw_fd()))
    }

    /// Opens the folder at a path of names, in order to read it or to write into it.
    pub(crate) fn open_path(&self, path: &Path) -> Result<Self, FileError> {
        let open = || -> io::Result<Self> {
            let (above, Some(last)) = self.split_path(path)? else { return Ok(self.clone()) };
            Ok(self.inner(open_component(above.as_fd(), last)?, path.as_os_str()))
        };
        open().map_err(|error| FileError::from_open_error(escape(path.as_os_str()), error))
    }

    fn inner(&self, fd: OwnedFd, name: &OsStr) -> Self {
        Self { fd: Arc::new(fd), display_path: self.display_path.join(name) }
    }

    /// Opens the entry at a path of names. Each name is looked up in the folder before it.
    fn open_beneath(&self, name: &OsStr) -> io::Result<File> {
        let (above, last) = self.split_parent(Path::new(name))?;
        Ok(openat(&*above, last, OFlags::RDONLY | SAFE_FLAGS, Mode::empty())?.into())
    }

    /// Returns the folder that contains the last name of a path, and this last name.
    fn split_parent<'a>(&self, path: &'a Path) -> io::Result<(Arc<OwnedFd>, &'a OsStr)> {
        let (folder, last) = self.split_path(path)?;
        Ok((folder, last.ok_or_else(|| io::Error::from_raw_os_error(libc::EISDIR))?))
    }

    /// Returns the same parts as [`Folder::split_parent`]. If the path has no last name, it is `None`.
    fn split_path<'a>(&self, path: &'a Path) -> io::Result<(Arc<OwnedFd>, Option<&'a OsStr>)> {
        let mut names = Vec::new();
        for component in path.components() {
            match component {
                Component::Normal(name) => names.push(name),
                Component::CurDir => {}
                _ => return Err(io::Error::from_raw_os_error(libc::EXDEV)),
            }
        }
        let last = names.pop();
        let mut folder = self.fd.clone();
        for name in names {
            folder = Arc::new(open_component(folder.as_fd(), name)?);
        }
        Ok((folder, last))
    }
}

impl AsFd for Folder {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.fd.as_fd()
    }
}

/// Opens the subfolder `name` of `above`. If it is a link, the error is `ELOOP`.
fn open_component(above: BorrowedFd<'_>, name: &OsStr) -> io::Result<OwnedFd> {
    openat(above, name, OFlags::PATH | OFlags::DIRECTORY | SAFE_FLAGS, Mode::empty()).map_err(|error| {
        let is_link = statat(above, name, AtFlags::SYMLINK_NOFOLLOW)
            .is_ok_and(|stat| FileType::from_raw_mode(stat.st_mode) == FileType::Symlink);
        if is_link { io::Error::from_raw_os_error(libc::ELOOP) } else { error.into() }
    })
}

/// Checks that a name is a single component, so that it does not lead out of its folder.
pub(super) fn check_single_component(name: &OsStr) -> io::Result<&OsStr> {
    let mut components = Path::new(name).components();
    match (components.next(), components.next()) {
        (Some(Component::Normal(only)), None) if only == name => Ok(name),
        _ => Err(io::Error::from_raw_os_error(libc::EXDEV)),
    }
}

/// Opens the regular file at `path`, and returns its length. Opening never waits. If the path ends with a link, it is
/// followed only with `follow`. The file may have several hard links.
///
/// # Errors
/// Fails if the file does not exist, is not a regular file, or cannot be accessed.
pub fn open_file(path: &Path, follow: bool) -> Result<(File, u64), FileError> {
    let escape_path = || escape(path.as_os_str());
    let no_link = if follow { 0 } else { libc::O_NOFOLLOW };
    let file = OpenOptions::new().read(true).custom_flags(libc::O_NONBLOCK | no_link).open(path);
    let file = file.map_err(|error| FileError::from_open_error(escape_path(), error))?;
    let length = require_regular_file(&file, escape_path)?.len();
    Ok((file, length))
}

#[cfg(test)]
mod tests;
