//! Archives that strangers send: sources and suites. Nothing is taken over from one that its own program would not
//! make: no way out of the folder, no links, no devices, no two files of one name, no more bytes than allowed when
//! unpacked.
mod kinds;

pub use kinds::{KNOWN, described};

use std::{
    collections::BTreeSet,
    fs::{self, File},
    io::{self, BufReader, Read, Seek, SeekFrom, Write},
    os::unix::fs::PermissionsExt,
    path::{Component, Path, PathBuf},
};
use thiserror::Error;

/// How large what is unpacked may be.
#[derive(Debug, Clone, Copy)]
pub struct ArchiveLimits {
    /// Bytes in all.
    pub bytes: u64,
    /// Files and folders.
    pub entries: usize,
}

impl ArchiveLimits {
    /// Enough for a suite with all its scenes, and for a student's sources with a library in them.
    pub const USUAL: Self = Self { bytes: 1 << 30, entries: 20_000 };

    /// The same for an archive of this size: what unpacks to 200 times as much is a bomb, unless it is small.
    fn of_size(self, packed: u64) -> Self {
        Self { bytes: self.bytes.min(packed.saturating_mul(200).max(50 << 20)), ..self }
    }
}

/// Why an archive is not unpacked.
#[derive(Debug, Error)]
pub enum ArchiveError {
    /// No archive of a kind that is read.
    #[error("looked for an archive ({KNOWN}), and found {0}")]
    Unknown(String),
    /// It can't be read to its end.
    #[error("the archive is damaged: {0}")]
    Damaged(String),
    /// A name leads out of the folder, or is none.
    #[error("the archive has a file of a name that is not allowed: {0}")]
    Name(String),
    /// Something that is neither file nor folder.
    #[error("the archive has {0}, which is neither a file nor a folder; links and devices are not allowed")]
    Kind(String),
    /// Two files of one name.
    #[error("the archive has {0} twice")]
    Twice(String),
    /// Too many entries.
    #[error("the archive has more than {0} files")]
    Entries(usize),
    /// Too many bytes.
    #[error("the archive holds more than {0} bytes when it is unpacked")]
    Bytes(u64),
    /// The folder can't be written.
    #[error("cannot unpack: {0}")]
    Folder(io::Error),
}

/// Looks an archive through to its end and returns the paths of its files.
///
/// # Errors
/// Its fault.
pub fn look_through(archive: &Path, limits: ArchiveLimits) -> Result<Vec<PathBuf>, ArchiveError> {
    walk(archive, limits, None)
}

/// Unpacks an archive into a folder that is there and empty.
///
/// # Errors
/// The first thing that is wrong with it; the folder may hold a part of it then.
pub fn unpack(archive: &Path, folder: &Path, limits: ArchiveLimits) -> Result<Vec<PathBuf>, ArchiveError> {
    walk(archive, limits, Some(folder))
}

/// An archive being walked through.
struct Walk<'a> {
    limits: ArchiveLimits,
    /// Where what is in the archive goes; nowhere where it is only looked at.
    folder: Option<&'a Path>,
    entries: usize,
    bytes: u64,
    seen: BTreeSet<PathBuf>,
    folders: BTreeSet<PathBuf>,
    files: Vec<PathBuf>,
}

fn walk(archive: &Path, limits: ArchiveLimits, folder: Option<&Path>) -> Result<Vec<PathBuf>, ArchiveError> {
    let file = File::open(archive).map_err(ArchiveError::Folder)?;
    let packed = file.metadata().map_err(ArchiveError::Folder)?.len();
    let mut walk = Walk {
        limits: limits.of_size(packed),
        folder,
        entries: 0,
        bytes: 0,
        seen: BTreeSet::new(),
        folders: BTreeSet::new(),
        files: Vec::new(),
    };
    walk.archive(file)?;
    Ok(walk.files)
}

fn damaged(error: impl std::fmt::Display) -> ArchiveError {
    ArchiveError::Damaged(error.to_string())
}

/// Whether a file manager put this into the archive by itself, and not the person who packed it: Finder's folder of
/// attributes and its notes on windows, Explorer's on pictures.
fn is_of_a_system(path: &Path) -> bool {
    path.iter().any(|part| {
        let part = part.as_encoded_bytes();
        part == b"__MACOSX" || part.starts_with(b"._") || matches!(part, b".DS_Store" | b"Thumbs.db" | b"desktop.ini")
    })
}

/// How many entries a zip archive says that it has, by its end record (APPNOTE 4.3.16), or the one of large archives
/// (4.3.14) where that says so.
fn announced(file: &mut File) -> io::Result<Option<u64>> {
    /// Both records, the pointer between them, and the longest comment behind them.
    const LONGEST: u64 = 56 + 20 + 22 + 0xffff;
    let size = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(size.saturating_sub(LONGEST)))?;
    let mut end = Vec::new();
    file.take(LONGEST).read_to_end(&mut end)?;
    file.seek(SeekFrom::Start(0))?;
    let last = |magic: &[u8; 4], size: usize| end.windows(size).rfind(|record| record.starts_with(magic));
    let Some(record) = last(b"PK\x05\x06", 22) else { return Ok(None) };
    let entries = u16::from_le_bytes([record[10], record[11]]);
    let of_large = last(b"PK\x06\x06", 56).filter(|_| entries == u16::MAX);
    let of_large = of_large.and_then(|record| Some(u64::from_le_bytes(record[32..40].try_into().ok()?)));
    Ok(Some(of_large.unwrap_or(entries.into())))
}

/// A name for a message.
fn shown(name: &[u8]) -> String {
    String::from_utf8_lossy(name).chars().take(200).flat_map(char::escape_default).collect()
}

impl Walk<'_> {
    fn zip(&mut self, mut file: File) -> Result<(), ArchiveError> {
        let announced = announced(&mut file).map_err(ArchiveError::Folder)?;
        // The library reads the list of all before it shows one.
        if announced.is_some_and(|announced| announced > self.limits.entries as u64) {
            return Err(ArchiveError::Entries(self.limits.entries));
        }
        let mut archive = zip::ZipArchive::new(BufReader::new(file)).map_err(damaged)?;
        // The library keeps one entry of each name, and nobody could tell which one was meant.
        if announced.is_some_and(|announced| announced > archive.len() as u64) {
            return Err(ArchiveError::Twice("a name".to_owned()));
        }
        for index in 0..archive.len() {
            let mut entry = archive.by_index(index).map_err(damaged)?;
            let name = entry.name_raw().to_vec();
            let mode = entry.unix_mode();
            // The file type in Unix permissions: none given, a file or a folder.
            if mode.is_some_and(|mode| !matches!(mode & 0o170_000, 0 | 0o100_000 | 0o040_000)) {
                return Err(ArchiveError::Kind(shown(&name)));
            }
            if entry.is_dir() {
                self.folder(&name)?;
            } else {
                self.file(&name, mode.is_some_and(|mode| mode & 0o111 != 0), &mut entry)?;
            }
        }
        Ok(())
    }

    fn tar(&mut self, input: impl Read) -> Result<(), ArchiveError> {
        let mut archive = tar::Archive::new(input);
        for entry in archive.entries().map_err(damaged)? {
            let mut entry = entry.map_err(damaged)?;
            let name = entry.path_bytes().into_owned();
            match entry.header().entry_type() {
                tar::EntryType::Directory => self.folder(&name)?,
                tar::EntryType::Regular | tar::EntryType::Continuous => {
                    let executable = entry.header().mode().is_ok_and(|mode| mode & 0o111 != 0);
                    self.file(&name, executable, &mut entry)?;
                }
                // Says something about the archive, and is no entry of it.
                tar::EntryType::XGlobalHeader => {}
                _ => return Err(ArchiveError::Kind(shown(&name))),
            }
        }
        Ok(())
    }

    /// The path of an entry, if it stays within the folder.
    fn path(&mut self, name: &[u8]) -> Result<PathBuf, ArchiveError> {
        self.entries += 1;
        if self.entries > self.limits.entries {
            return Err(ArchiveError::Entries(self.limits.entries));
        }
        let refused = || ArchiveError::Name(shown(name));
        let text = std::str::from_utf8(name).map_err(|_| refused())?;
        // A backslash is a separator to some programs and part of a name to others.
        if text.is_empty() || text.len() > 1000 || text.contains(['\\', ':']) || text.chars().any(char::is_control) {
            return Err(refused());
        }
        let mut path = PathBuf::new();
        for component in Path::new(text).components() {
            match component {
                Component::Normal(part) if part.len() <= 200 => path.push(part),
                Component::CurDir => {}
                _ => return Err(refused()),
            }
        }
        Ok(path)
    }

    /// Notes the folders above a file; none of them may be a file.
    fn within_folders(&mut self, path: &Path, name: &[u8]) -> Result<(), ArchiveError> {
        for folder in path.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty()) {
            if self.seen.contains(folder) {
                return Err(ArchiveError::Twice(shown(name)));
            }
            self.folders.insert(folder.to_owned());
        }
        Ok(())
    }

    fn folder(&mut self, name: &[u8]) -> Result<(), ArchiveError> {
        let path = self.path(name)?;
        if is_of_a_system(&path) {
            return Ok(());
        }
        self.within_folders(&path.join("a file"), name)?;
        if let Some(folder) = self.folder {
            fs::create_dir_all(folder.join(path)).map_err(ArchiveError::Folder)?;
        }
        Ok(())
    }

    fn file(&mut self, name: &[u8], executable: bool, input: &mut impl Read) -> Result<(), ArchiveError> {
        let path = self.path(name)?;
        if is_of_a_system(&path) {
            return self.copy(input, &mut io::sink());
        }
        self.within_folders(&path, name)?;
        if path.as_os_str().is_empty() || self.folders.contains(&path) || !self.seen.insert(path.clone()) {
            return Err(ArchiveError::Twice(shown(name)));
        }
        match self.folder {
            None => self.copy(input, &mut io::sink())?,
            Some(folder) => {
                let place = folder.join(&path);
                if let Some(parent) = place.parent() {
                    fs::create_dir_all(parent).map_err(ArchiveError::Folder)?;
                }
                let mut output = File::create_new(&place).map_err(ArchiveError::Folder)?;
                self.copy(input, &mut output)?;
                let mode = if executable { 0o755 } else { 0o644 };
                fs::set_permissions(&place, fs::Permissions::from_mode(mode)).map_err(ArchiveError::Folder)?;
            }
        }
        self.files.push(path);
        Ok(())
    }

    /// Counts what really comes out: what an archive says about its sizes is nobody's word.
    fn copy(&mut self, input: &mut impl Read, output: &mut impl Write) -> Result<(), ArchiveError> {
        let mut chunk = vec![0; 64 * 1024];
        loop {
            let read = input.read(&mut chunk).map_err(damaged)?;
            if read == 0 {
                return Ok(());
            }
            self.bytes += read as u64;
            if self.bytes > self.limits.bytes {
                return Err(ArchiveError::Bytes(self.limits.bytes));
            }
            output.write_all(&chunk[..read]).map_err(ArchiveError::Folder)?;
        }
    }
}
