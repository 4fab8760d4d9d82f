//! Writes output files. A file is first written under a temporary name in the same folder, and renamed when it is
//! complete.
//!
//! If there is an error, or after SIGINT or SIGTERM, the temporary file is removed. Standard output and character
//! devices such as `/dev/null` are written directly. Pipes, sockets and block devices are rejected: a pipe without a
//! reader would block forever.
//!
//! If a file that the user names is a link, its target is replaced. In a folder for many files, an existing entry with
//! the same name is replaced, even if it is a link.
use super::{
    console,
    interrupt::{clean_up_when_interrupted, lock_pending_files, record_activity},
};
use crate::{
    files::{self, FilePlace, Identity, Replacement, open_for_writing},
    report::untrusted_text::to_one_line,
};
use anyhow::{Context, Result, bail};
use std::{
    ffi::OsStr,
    fs::{self, File, OpenOptions},
    io::{self, IoSlice, Write},
    os::unix::fs::{FileTypeExt, PermissionsExt},
    path::{Path, PathBuf},
};

/// An output that is being written.
#[derive(Debug)]
pub(super) enum Output {
    /// The output is discarded.
    Discarded,
    /// The output is standard output (`-`).
    Stdout,
    /// The output is a character device.
    Device(File, PathBuf),
    /// The output is a file, which has a temporary name until it is complete.
    File(Replacement),
}

impl Output {
    /// Prepares an output. The file does not appear under its name before [`Output::finish`] is called.
    ///
    /// # Errors
    ///
    /// Fails if the output can't be written, or is one of `inputs`.
    pub(super) fn create(name: &Path, inputs: &[Identity]) -> Result<Self> {
        if ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].into_iter().any(|own| name == Path::new(own)) {
            return Ok(Self::Stdout);
        }
        Self::create_file(name, inputs).with_context(|| format!("cannot write {}", name.display()))
    }

    fn create_file(name: &Path, inputs: &[Identity]) -> Result<Self> {
        let mut target = name.to_owned();
        let mut mode = None;
        match fs::metadata(name) {
            Ok(existing) => {
                let kind = existing.file_type();
                if inputs.contains(&Identity::from_metadata(&existing)) {
                    bail!("this is also an input; choose another output");
                } else if kind.is_dir() {
                    bail!("this is a folder; name a file in it");
                } else if kind.is_char_device() {
                    return Ok(Self::Device(open_for_writing(OpenOptions::new().write(true), name)?, target));
                } else if !kind.is_file() {
                    bail!("this is a pipe, socket or block device; use `-` for standard output");
                }
                // Renaming would replace even a protected file, so it is checked first whether the file may be written.
                OpenOptions::new().write(true).open(name)?;
                // The target of a symbolic link is replaced, and not the link.
                target = name.canonicalize()?;
                mode = Some(existing.permissions().mode() & 0o777);
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                if name.symlink_metadata().is_ok() {
                    bail!("this is a symbolic link to a file that does not exist");
                }
                if name.file_name().is_none() || name.as_os_str().as_encoded_bytes().ends_with(b"/") {
                    bail!("this is the name of a folder; name a file in it");
                }
            }
            Err(error) => return Err(error.into()),
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if folder.symlink_metadata().is_err_and(|error| error.kind() == io::ErrorKind::NotFound) {
            bail!("there is no folder {}; create it first", folder.display());
        }
        let name = target.file_name().context("this is the name of a folder; name a file in it")?;
        let begin = || files::Folder::open_to_write(folder)?.replacement(name, mode);
        Ok(Self::File(begin_file(begin).with_context(|| format!("cannot create a file in {}", folder.display()))?))
    }

    /// Returns whether the output is standard output. Nothing else may then be printed there.
    pub(super) const fn is_stdout(&self) -> bool {
        matches!(self, Self::Stdout)
    }

    /// Returns the path of the temporary file, for a program that writes it; `None` if the output is not a file.
    pub(super) fn temporary_path(&self) -> Option<PathBuf> {
        match self {
            Self::File(file) => Some(file.unfinished_path()),
            Self::Discarded | Self::Stdout | Self::Device(..) => None,
        }
    }

    /// Writes all bytes, and gives the file its final name.
    ///
    /// # Errors
    ///
    /// Fails if the output can't be written.
    pub(super) fn finish_with(mut self, bytes: &[u8]) -> Result<()> {
        let name = self.name();
        self.write_all(bytes).with_context(|| format!("cannot write {name}"))?;
        self.finish()
    }

    /// Finishes the output as [`Output::finish_with`] does, and prints the file's name.
    ///
    /// # Errors
    ///
    /// Fails if the output can't be written.
    pub(super) fn finish_and_print(self, bytes: &[u8], is_page: bool) -> Result<()> {
        let file = match &self {
            Self::File(file) => Some(file.target()),
            _ => None,
        };
        self.finish_with(bytes)?;
        if let Some(file) = file {
            print_path(&file, is_page);
        }
        Ok(())
    }

    fn name(&self) -> String {
        match self {
            Self::Discarded => "nothing".to_owned(),
            Self::Stdout => "to standard output".to_owned(),
            Self::Device(_, name) => name.display().to_string(),
            Self::File(file) => file.target().display().to_string(),
        }
    }

    /// Gives the file its final name.
    ///
    /// # Errors
    ///
    /// Fails if the last bytes can't be written, or if the file can't be renamed. An existing file is then unchanged.
    pub(super) fn finish(mut self) -> Result<()> {
        console::ignore_closed_pipe(self.flush())?;
        match self {
            Self::File(file) => {
                let target = file.target();
                finish_file(file).with_context(|| format!("cannot write {}", target.display()))
            }
            _ => Ok(()),
        }
    }
}

/// Prints the path of an output. If it is a page, the text says to open it in a browser.
pub(super) fn print_path(file: &Path, is_page: bool) {
    let heading = if is_page { "open in a browser" } else { "written" };
    console::print_remark(format!("{heading}: {}\n", to_one_line(&file.display().to_string())));
}

impl Output {
    /// Calls `act` with the writer. If the reader has closed the pipe, returns `value_if_closed` instead of an error,
    /// so that the command can finish.
    fn write_until_closed<T>(
        &mut self,
        value_if_closed: T,
        act: impl FnOnce(&mut dyn Write) -> io::Result<T>,
    ) -> io::Result<T> {
        match self {
            Self::Discarded => Ok(value_if_closed),
            Self::Stdout => match act(&mut io::stdout()) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(value_if_closed),
                other => other,
            },
            Self::Device(device, _) => act(device),
            Self::File(file) => act(file),
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_until_closed(bytes.len(), |out| out.write(bytes))
    }

    fn write_vectored(&mut self, parts: &[IoSlice<'_>]) -> io::Result<usize> {
        self.write_until_closed(parts.iter().map(|part| part.len()).sum(), |out| out.write_vectored(parts))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.write_until_closed((), |out| out.flush())
    }
}

/// Writes a file. It appears only when it is complete.
///
/// # Errors
///
/// Fails if the file can't be written. An existing file is then unchanged.
pub(super) fn write(name: &Path, bytes: &[u8]) -> Result<()> {
    Output::create(name, &[])?.finish_with(bytes)
}

/// Writes a file below a folder for results. It appears only when it is complete. Missing folders are created, and no
/// link is followed.
///
/// # Errors
///
/// Fails if the file can't be written. An existing file is then unchanged.
pub(super) fn write_below(place: &FilePlace, bytes: &[u8]) -> Result<()> {
    write_whole(|| place.replacement(), |file| file.write_all(bytes))
        .with_context(|| format!("cannot write {}", place.path().display()))
}

/// Writes everything that a reader returns into a file, as [`write_below`] does.
///
/// # Errors
///
/// Fails like [`write_below`]. Also fails if the reader fails.
pub(super) fn copy_below(place: &FilePlace, from: &mut impl io::Read) -> io::Result<()> {
    write_whole(|| place.replacement(), |file| io::copy(from, file).map(drop))
}

/// Writes a whole file. An existing file is replaced when the new one is complete.
fn write_whole(
    begin: impl FnOnce() -> io::Result<Replacement>,
    fill: impl FnOnce(&mut Replacement) -> io::Result<()>,
) -> io::Result<()> {
    let mut file = begin_file(begin)?;
    fill(&mut file)?;
    finish_file(file)
}

/// Begins to write a file. If the user interrupts the program, the file is removed.
fn begin_file(begin: impl FnOnce() -> io::Result<Replacement>) -> io::Result<Replacement> {
    clean_up_when_interrupted();
    record_activity();
    let mut pending = lock_pending_files();
    let file = begin()?;
    pending.push(file.unfinished_path());
    Ok(file)
}

/// Gives a complete file its final name.
fn finish_file(file: Replacement) -> io::Result<()> {
    let mut pending = lock_pending_files();
    let path = file.unfinished_path();
    let finished = file.finish();
    pending.retain(|waiting| *waiting != path);
    record_activity();
    finished
}

/// A folder for many files. Each file appears only when it is complete. Existing files with the same names are
/// replaced, and links are not followed, so that nobody can redirect the output by preparing the folder.
#[derive(Debug)]
pub(super) struct Folder(files::Folder);

impl Folder {
    /// Opens an existing folder, or creates a new one.
    ///
    /// # Errors
    ///
    /// Fails if the path is not a folder, or the folder can't be created.
    pub(super) fn open(name: &Path) -> Result<Self> {
        match fs::create_dir(name) {
            Ok(()) => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && name.is_dir() => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                bail!("{} is not a folder; choose one for the pictures", name.display())
            }
            Err(error) => return Err(error).with_context(|| format!("cannot create the folder {}", name.display())),
        }
        let opened = files::Folder::open_to_write(name).with_context(|| format!("cannot open {}", name.display()))?;
        Ok(Self(opened))
    }

    /// Opens an existing folder; `None` if it does not exist or cannot be opened.
    pub(super) fn open_existing(name: &Path) -> Option<Self> {
        files::Folder::open_to_write(name).ok().map(Self)
    }

    /// Returns the name of the output as the user typed it, in printable form.
    pub(super) fn name(&self) -> String {
        self.0.given_path().display().to_string()
    }

    /// Returns whether the folder has a file with this name.
    pub(super) fn contains(&self, name: &str) -> bool {
        self.0.contains(OsStr::new(name))
    }

    /// Writes a file in the folder. It appears only when it is complete.
    ///
    /// # Errors
    ///
    /// Fails if the file can't be written.
    pub(super) fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        write_whole(|| self.0.replacement(OsStr::new(name), None), |file| file.write_all(bytes))
            .with_context(|| format!("cannot write {}", self.0.given_path().join(name).display()))
    }
}

/// Returns whether a file name has this ending. Upper and lower case are the same.
pub(super) fn has_extension(name: &Path, extension: &str) -> bool {
    name.extension().and_then(OsStr::to_str).is_some_and(|found| found.eq_ignore_ascii_case(extension))
}
