//! Paths in a folder of results. A user chooses the folder, and the grader chooses the names of everything in it.
use super::{FileError, Folder, Replacement, error::escape};
use std::{
    ffi::OsStr,
    fs::File,
    io,
    path::{Path, PathBuf},
};

/// A file or a folder below a folder that a user named. The path to the folder may contain links; below it no link is
/// followed, no matter who created it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FilePlace {
    folder: PathBuf,
    relative_path: PathBuf,
}

impl FilePlace {
    /// Creates the place `below`, a path of names, in a folder. An empty folder means the working folder.
    pub fn new(folder: impl Into<PathBuf>, below: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), relative_path: below.into() }
    }

    /// Returns a place below this one.
    pub fn join(&self, name: impl AsRef<Path>) -> Self {
        Self { folder: self.folder.clone(), relative_path: self.relative_path.join(name) }
    }

    /// Returns the whole path, for messages and for other programs.
    pub fn path(&self) -> PathBuf {
        if self.relative_path.as_os_str().is_empty() {
            self.folder.clone()
        } else {
            self.folder.join(&self.relative_path)
        }
    }

    /// Opens the regular file at this place, and returns its length.
    ///
    /// # Errors
    /// Fails like [`Folder::open_file`].
    pub fn open_file(&self, max_bytes: u64) -> Result<(File, u64), FileError> {
        self.base().and_then(|folder| folder.open_file(self.relative_path.as_os_str(), max_bytes))
    }

    /// Returns the contents of the regular file at this place.
    ///
    /// # Errors
    /// Fails like [`Folder::read`].
    pub fn read(&self, max_bytes: u64) -> Result<Vec<u8>, FileError> {
        self.base().and_then(|folder| folder.read(self.relative_path.as_os_str(), max_bytes))
    }

    /// Returns whether there is a regular file at this place.
    pub fn is_file(&self) -> bool {
        self.base().is_ok_and(|folder| folder.identity(self.relative_path.as_os_str()).is_some())
    }

    /// Opens the folder at this place. Missing folders on the path, and the folder itself, are created.
    ///
    /// # Errors
    /// Fails if a folder cannot be created, or if an entry of another kind (such as a link) has its name.
    pub fn make_folder(&self) -> io::Result<Folder> {
        self.relative_path.iter().try_fold(Folder::create(self.start())?, |folder, name| {
            let inner = folder.create_folder(name);
            inner.map_err(|error| with_name(&folder.given_path().join(name), &error))
        })
    }

    /// Begins a file that appears at this place when it is finished. Missing folders on the path are created.
    ///
    /// # Errors
    /// Fails like [`FilePlace::make_folder`]. Also fails if no file can be created there.
    pub fn replacement(&self) -> io::Result<Replacement> {
        let above = Self::new(&self.folder, self.relative_path.parent().unwrap_or(Path::new("")));
        above.make_folder()?.replacement(self.relative_path.file_name().unwrap_or_default(), None)
    }

    /// Writes a file. It appears only when it is complete. Missing folders on the path are created.
    ///
    /// # Errors
    /// Fails like [`FilePlace::replacement`]. Also fails if the file cannot be written.
    pub fn write(&self, bytes: &[u8]) -> io::Result<()> {
        let mut file = self.replacement()?;
        io::Write::write_all(&mut file, bytes)?;
        file.finish()
    }

    /// Removes the file or the link at this place. If it does not exist, nothing is done.
    ///
    /// # Errors
    /// Fails if the entry cannot be removed.
    pub fn remove(&self) -> io::Result<()> {
        let above = self.relative_path.parent().unwrap_or(Path::new(""));
        match self.base().and_then(|folder| folder.open_path(above)) {
            Ok(folder) => folder.remove(self.relative_path.file_name().unwrap_or_default()),
            Err(FileError::Missing { .. }) => Ok(()),
            Err(error) => Err(io::Error::other(error)),
        }
    }

    /// Returns the names of the entries in the folder at this place; empty if the folder does not exist.
    ///
    /// # Errors
    /// Fails if the folder cannot be read, or is reached by a link.
    pub fn list_names(&self) -> io::Result<Vec<std::ffi::OsString>> {
        match self.open_folder() {
            Ok(folder) => folder.list_names(),
            Err(FileError::Missing { .. }) => Ok(Vec::new()),
            Err(error) => Err(io::Error::other(error)),
        }
    }

    /// Opens the folder at this place.
    ///
    /// # Errors
    /// Fails if the folder does not exist, or is reached by a link.
    pub fn open_folder(&self) -> Result<Folder, FileError> {
        self.base().and_then(|folder| folder.open_path(&self.relative_path))
    }

    fn start(&self) -> &Path {
        if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder }
    }

    fn base(&self) -> Result<Folder, FileError> {
        Folder::open_to_write(self.start())
            .map_err(|error| FileError::from_open_error(escape(self.folder.as_os_str()), error))
    }
}

fn with_name(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", escape(OsStr::new(path))))
}
