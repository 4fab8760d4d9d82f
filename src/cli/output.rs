//! Output files: they appear whole, by renaming a finished temporary file that lies beside the target, or not at all.
//!
//! An error, SIGINT and SIGTERM remove the temporary file. Standard output and character devices such as `/dev/null`
//! are written directly. Pipes, sockets and block devices are refused: a pipe without a reader would block for ever.
use super::{
    console,
    interrupt::{clean_up_when_interrupted, pending},
};
use crate::{
    files::{Identity, open_for_writing},
    report::grade::one_line,
};
use anyhow::{Context, Result, bail};
use std::{
    ffi::OsStr,
    fs::{self, File, OpenOptions, Permissions},
    io::{self, IoSlice, Write},
    os::unix::fs::{FileTypeExt, PermissionsExt},
    path::{Path, PathBuf},
};
use tempfile::{NamedTempFile, TempPath};

/// An output that is being written.
#[derive(Debug)]
pub(super) enum Output {
    /// Nothing is kept.
    Nowhere,
    /// Standard output (`-`).
    Stdout,
    /// A character device.
    Device(File, PathBuf),
    /// A file, for the moment under another name.
    File { temporary: NamedTempFile, target: PathBuf },
}

impl Output {
    /// Prepares an output. Nothing appears under its name before [`Output::finish`].
    ///
    /// # Errors
    /// When the output can't be written, or is one of `inputs`.
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
                if inputs.contains(&Identity::of(&existing)) {
                    bail!("it is also an input; choose another name");
                } else if kind.is_dir() {
                    bail!("it is a directory; name a file inside");
                } else if kind.is_char_device() {
                    return Ok(Self::Device(open_for_writing(OpenOptions::new().write(true), name)?, target));
                } else if !kind.is_file() {
                    bail!("it is a pipe, socket or block device; use `-` for standard output");
                }
                // The rename would replace a protected file as well: ask first whether it may be written.
                OpenOptions::new().write(true).open(name)?;
                // Replaced is the file that a symbolic link points to, not the link.
                target = name.canonicalize()?;
                mode = Some(existing.permissions().mode() & 0o777);
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                if name.symlink_metadata().is_ok() {
                    bail!("it is a symbolic link to a file that does not exist");
                }
                if name.file_name().is_none() || name.as_os_str().as_encoded_bytes().ends_with(b"/") {
                    bail!("it names a directory; name a file inside");
                }
            }
            Err(error) => return Err(error.into()),
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if folder.symlink_metadata().is_err_and(|error| error.kind() == io::ErrorKind::NotFound) {
            bail!("there is no folder {}; make it first", folder.display());
        }
        let temporary = temporary(folder, mode)?;
        Ok(Self::File { temporary, target })
    }

    /// Whether this is standard output, so that nothing else may be printed there.
    pub(super) const fn is_stdout(&self) -> bool {
        matches!(self, Self::Stdout)
    }

    /// Where the bytes of a file lie before it appears under its name, for a program that writes them.
    pub(super) fn temporary_path(&self) -> Option<&Path> {
        match self {
            Self::File { temporary, .. } => Some(temporary.path()),
            Self::Nowhere | Self::Stdout | Self::Device(..) => None,
        }
    }

    /// Writes everything at once, and lets the file appear under its name.
    ///
    /// # Errors
    /// When it can't be written.
    pub(super) fn finish_with(mut self, bytes: &[u8]) -> Result<()> {
        let name = self.name();
        self.write_all(bytes).with_context(|| format!("cannot write {name}"))?;
        self.finish()
    }

    /// As [`Output::finish_with`]; whoever looks on is told where it went, if that is a file.
    ///
    /// # Errors
    /// When it can't be written.
    pub(super) fn finish_and_tell(self, bytes: &[u8], is_page: bool) -> Result<()> {
        let file = match &self {
            Self::File { target, .. } => Some(target.clone()),
            _ => None,
        };
        self.finish_with(bytes)?;
        if let Some(file) = file {
            say_where(&file, is_page);
        }
        Ok(())
    }

    fn name(&self) -> String {
        match self {
            Self::Nowhere => "nothing".to_owned(),
            Self::Stdout => "to standard output".to_owned(),
            Self::Device(_, name) | Self::File { target: name, .. } => name.display().to_string(),
        }
    }

    /// Lets the file appear under its name.
    ///
    /// # Errors
    /// When the last bytes or the rename fail; the target is then as it was before.
    pub(super) fn finish(mut self) -> Result<()> {
        console::unless_closed(self.flush())?;
        if let Self::File { temporary, target } = self {
            let mut pending = pending();
            let path = temporary.into_temp_path();
            pending.retain(|waiting| waiting.as_path() != <TempPath as AsRef<Path>>::as_ref(&path));
            path.persist(&target)
                .map_err(|error| error.error)
                .with_context(|| format!("cannot write {}", target.display()))?;
        }
        Ok(())
    }
}

/// Says where something was written; a page is for a browser.
pub(super) fn say_where(file: &Path, is_page: bool) {
    let what = if is_page { "to look at" } else { "written" };
    console::remark(format!("{what}: {}\n", one_line(&file.display().to_string())).as_bytes());
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Nowhere => Ok(bytes.len()),
            // A reader that has gone away must not keep the command from finishing.
            Self::Stdout => match io::stdout().write(bytes) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(bytes.len()),
                other => other,
            },
            Self::Device(device, _) => device.write(bytes),
            Self::File { temporary, .. } => temporary.write(bytes),
        }
    }

    fn write_vectored(&mut self, parts: &[IoSlice<'_>]) -> io::Result<usize> {
        match self {
            Self::Nowhere => Ok(parts.iter().map(|part| part.len()).sum()),
            Self::Stdout => match io::stdout().write_vectored(parts) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                    Ok(parts.iter().map(|part| part.len()).sum())
                }
                other => other,
            },
            Self::Device(device, _) => device.write_vectored(parts),
            Self::File { temporary, .. } => temporary.write_vectored(parts),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Nowhere => Ok(()),
            Self::Stdout => console::unless_closed(io::stdout().flush()),
            Self::Device(device, _) => device.flush(),
            Self::File { temporary, .. } => temporary.flush(),
        }
    }
}

/// Writes a whole file by rename.
///
/// # Errors
/// When it can't be written; the old file, if there is one, is unharmed.
pub(super) fn write(name: &Path, inputs: &[Identity], bytes: &[u8]) -> Result<()> {
    Output::create(name, inputs)?.finish_with(bytes)
}

/// A temporary file in a folder, which an interrupt removes.
fn temporary(folder: &Path, mode: Option<u32>) -> Result<NamedTempFile> {
    clean_up_when_interrupted();
    let mut pending = pending();
    let temporary = tempfile::Builder::new()
        .prefix(".fosssim-oracle-")
        .permissions(Permissions::from_mode(mode.unwrap_or(0o666)))
        .tempfile_in(folder)
        // The error itself would name the temporary file, which nobody has asked for.
        .map_err(|error| io::Error::from(error.kind()))
        .with_context(|| format!("no file can be made in {}", folder.display()))?;
    pending.push(temporary.path().to_owned());
    drop(pending);
    if let Some(mode) = mode {
        // The mode of a new file loses what the umask forbids; that of a replaced one must stay as it was.
        temporary.as_file().set_permissions(Permissions::from_mode(mode))?;
    }
    Ok(temporary)
}

/// A folder that many files of our own names are written into, each by rename. What has such a name already is
/// replaced, and links are not followed: whoever prepares a folder can't make us write elsewhere.
#[derive(Debug)]
pub(super) struct Folder(PathBuf);

impl Folder {
    /// An existing folder, or a new one.
    ///
    /// # Errors
    /// When it is none, or can't be made.
    pub(super) fn open(name: &Path) -> Result<Self> {
        match fs::create_dir(name) {
            Ok(()) => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && name.is_dir() => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                bail!("{} is no folder; name one for the pictures", name.display())
            }
            Err(error) => return Err(error).with_context(|| format!("cannot make the folder {}", name.display())),
        }
        Ok(Self(name.to_owned()))
    }

    /// An existing folder.
    pub(super) fn existing(name: &Path) -> Option<Self> {
        name.is_dir().then(|| Self(name.to_owned()))
    }

    /// Its name as typed, fit for printing.
    pub(super) fn name(&self) -> String {
        self.0.display().to_string()
    }

    /// Whether there is a file of this name.
    pub(super) fn holds(&self, name: &str) -> bool {
        self.0.join(name).symlink_metadata().is_ok()
    }

    /// Writes a whole file by rename.
    ///
    /// # Errors
    /// When it can't be written.
    pub(super) fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let target = self.0.join(name);
        let mut output = Output::File { temporary: temporary(&self.0, None)?, target };
        output.write_all(bytes).with_context(|| format!("cannot write {}", self.0.join(name).display()))?;
        output.finish()
    }
}

/// Whether a name has this extension, whatever its case.
pub(super) fn has_extension(name: &Path, extension: &str) -> bool {
    name.extension().and_then(OsStr::to_str).is_some_and(|found| found.eq_ignore_ascii_case(extension))
}
