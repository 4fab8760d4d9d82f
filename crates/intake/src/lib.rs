//! Checks files that the command line and the service receive. It recognizes kinds of files, and unpacks archives of
//! sources and of suites.
//!
//! Archives are rejected if they contain entries that usual packers do not create, such as paths that leave the folder,
//! links, devices, or two files with the same name. They are also rejected if they contain more bytes than allowed.
//! Files that file managers and build tools create automatically are skipped.
//!
//! ```
//! use fosssim_intake::{FileKind, describe};
//!
//! assert_eq!(FileKind::from_start(b"#!/bin/sh"), FileKind::Program);
//! assert_eq!(describe(b"MZ\x90"), "a program for Windows");
//! ```
#![forbid(unsafe_code)]

mod kinds;
mod meter;

pub use kinds::{ArchiveKind, FileKind, KNOWN_EXTENSIONS, START_BYTES, describe};

use flate2::read::GzDecoder;
use meter::Meter;
use std::{
    collections::BTreeSet,
    ffi::OsStr,
    fs::{self, File},
    io::{self, BufReader, Read, Seek, SeekFrom, Write},
    os::unix::fs::PermissionsExt,
    path::{Component, Path, PathBuf},
};
use thiserror::Error;

/// The limits on what an archive may contain.
#[derive(Debug, Clone, Copy)]
pub struct ArchiveLimits {
    /// The maximum total number of bytes of all files.
    pub bytes: u64,
    /// The maximum number of files and folders.
    pub entries: usize,
}

/// The maximum depth to which folders may be nested.
const MAX_DEPTH: usize = 64;

/// The maximum size of an archive's list of files, in bytes. A list of 20,000 usual names has 4 MiB.
const MAX_LIST_BYTES: u64 = 16 << 20;
/// The maximum size of the header data for one file, in bytes.
const MAX_HEADER_BYTES: u64 = 1 << 20;

/// The number of bytes that may be read for a file in addition to its contents. They are headers, padding, and data
/// that are read ahead.
const READ_OVERHEAD_BYTES: u64 = 64 << 10;

impl ArchiveLimits {
    /// The usual limits. They are large enough for a suite with all its scenes, and for a student's sources with a
    /// library.
    pub const DEFAULT: Self = Self { bytes: 1 << 30, entries: 20_000 };

    /// Returns the limits for an archive of `packed` bytes. Unless an archive is small, it must not unpack to more than
    /// 200 times its size.
    fn for_size(self, packed: u64) -> Self {
        Self { bytes: self.bytes.min(packed.saturating_mul(200).max(50 << 20)), ..self }
    }
}

/// The reason why an archive is rejected.
#[derive(Debug, Error)]
pub enum ArchiveError {
    /// The file is not an archive that can be unpacked.
    #[error("expected an archive ({KNOWN_EXTENSIONS}), but found {0}")]
    Unknown(String),
    /// The archive cannot be read to its end.
    #[error("the archive is damaged: {0}")]
    Damaged(String),
    /// A name leads out of the folder, or is invalid.
    #[error("the archive has a file with a forbidden name: {0}")]
    Name(String),
    /// An entry is neither a file nor a folder.
    #[error("the archive has {0}, which is neither a file nor a folder; links and devices are not allowed")]
    Kind(String),
    /// Two files in the archive have the same name.
    #[error("the archive contains {0} twice")]
    Duplicate(String),
    /// The archive has too many entries.
    #[error("the archive has more than {0} files")]
    Entries(usize),
    /// The files in the archive have too many bytes.
    #[error("the unpacked archive has more than {0} bytes")]
    Bytes(u64),
    /// The folders in the archive are nested too deeply.
    #[error("the archive has folders nested more than {MAX_DEPTH} levels deep: {0}")]
    Depth(String),
    /// The archive's file cannot be read. The archive itself is not at fault.
    #[error("cannot read the archive: {0}")]
    Read(io::Error),
    /// The folder into which the archive is unpacked cannot be written.
    #[error("cannot unpack: {0}")]
    Folder(io::Error),
}

/// Reads an archive to its end and returns the paths of its files.
///
/// # Errors
/// Fails if the archive is rejected. The error is the reason.
pub fn list_archive(archive: File, limits: ArchiveLimits) -> Result<Vec<PathBuf>, ArchiveError> {
    walk(archive, limits, None)
}

/// Unpacks an archive into an empty folder, and returns the paths of its files. Files that begin like programs become
/// executable, even without permission bits, because archives from Windows and from many web pages do not contain
/// these.
///
/// # Errors
/// Fails if the archive is rejected. The error is the first reason. The folder may then contain a part of the archive.
pub fn unpack(archive: File, folder: &Path, limits: ArchiveLimits) -> Result<Vec<PathBuf>, ArchiveError> {
    walk(archive, limits, Some(folder))
}

/// Returns the folder of an unpacked archive that contains the submission. Many archives have a single folder at their
/// top; if so, it is that folder.
pub fn top_folder(folder: &Path, files: &[PathBuf]) -> PathBuf {
    let mut tops = files.iter().map(|file| file.components().next().filter(|_| file.components().count() > 1));
    match tops.next().flatten() {
        Some(top) if tops.all(|other| other == Some(top)) => folder.join(top),
        _ => folder.to_owned(),
    }
}

/// Returns whether file managers or build tools create files or folders with this name automatically. These are
/// attributes and window settings of Finder, picture caches of Explorer, and CMake's cache of a build on another
/// machine, which would prevent a build here.
pub fn is_generated_name(name: &OsStr) -> bool {
    let name = name.as_encoded_bytes();
    const NAMES: [&[u8]; 6] =
        [b"__MACOSX", b".DS_Store", b"Thumbs.db", b"desktop.ini", b"CMakeCache.txt", b"CMakeFiles"];
    NAMES.contains(&name) || name.starts_with(b"._")
}

/// The state while the entries of an archive are read.
struct ArchiveReader<'a> {
    limits: ArchiveLimits,
    /// The folder into which the files are unpacked; `None` if the archive is only checked.
    folder: Option<&'a Path>,
    entries: usize,
    bytes: u64,
    seen_paths: BTreeSet<PathBuf>,
    folders: BTreeSet<PathBuf>,
    files: Vec<PathBuf>,
}

fn walk(file: File, limits: ArchiveLimits, folder: Option<&Path>) -> Result<Vec<PathBuf>, ArchiveError> {
    let packed_size = file.metadata().map_err(ArchiveError::Read)?.len();
    let mut walk = ArchiveReader {
        limits: limits.for_size(packed_size),
        folder,
        entries: 0,
        bytes: 0,
        seen_paths: BTreeSet::new(),
        folders: BTreeSet::new(),
        files: Vec::new(),
    };
    walk.walk_archive(file)?;
    Ok(walk.files)
}

fn describe_damage(error: impl std::fmt::Display) -> ArchiveError {
    ArchiveError::Damaged(error.to_string())
}

/// Returns the number of entries that a zip archive announces. It is in the archive's end record (APPNOTE 4.3.16), or
/// in the end record for large archives (4.3.14) if there is one. Returns `None` if the archive has no end record.
fn count_announced(file: &mut File) -> io::Result<Option<u64>> {
    /// The size of both records, the pointer between them, and the longest comment that may follow them.
    const MAX_END_BYTES: u64 = 56 + 20 + 22 + 0xffff;
    let size = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(size.saturating_sub(MAX_END_BYTES)))?;
    let mut end = Vec::new();
    file.take(MAX_END_BYTES).read_to_end(&mut end)?;
    file.seek(SeekFrom::Start(0))?;
    let last = |magic: &[u8; 4], size: usize| end.windows(size).rfind(|record| record.starts_with(magic));
    let Some(record) = last(b"PK\x05\x06", 22) else { return Ok(None) };
    let entries = u16::from_le_bytes([record[10], record[11]]);
    let zip64_entries = last(b"PK\x06\x06", 56).filter(|_| entries == u16::MAX);
    let zip64_entries = zip64_entries.and_then(|record| Some(u64::from_le_bytes(record[32..40].try_into().ok()?)));
    Ok(Some(zip64_entries.unwrap_or(entries.into())))
}

/// Returns the first bytes of a file, and rewinds it.
fn read_start(file: &mut File) -> io::Result<Vec<u8>> {
    let mut start = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.take(START_BYTES as u64).read_to_end(&mut start)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(start)
}

/// Reads a header that describes the next file of an archive.
fn read_header(entry: &mut impl Read) -> Result<Vec<u8>, ArchiveError> {
    let mut header = Vec::new();
    entry.take(MAX_HEADER_BYTES + 1).read_to_end(&mut header).map_err(describe_damage)?;
    if header.len() as u64 > MAX_HEADER_BYTES { Err(describe_damage("a header is too long")) } else { Ok(header) }
}

/// Returns a name for messages, in which unusual characters are replaced by escapes.
fn escape_name(name: &[u8]) -> String {
    String::from_utf8_lossy(name).chars().take(200).flat_map(char::escape_default).collect()
}

impl ArchiveReader<'_> {
    /// Reads all entries of an archive of any kind.
    fn walk_archive(&mut self, mut file: File) -> Result<(), ArchiveError> {
        let start = read_start(&mut file).map_err(ArchiveError::Read)?;
        match FileKind::from_start(&start) {
            FileKind::Archive(ArchiveKind::Zip) => self.walk_zip(file),
            FileKind::Archive(ArchiveKind::TarGz) => self.walk_tar(GzDecoder::new(BufReader::new(file))),
            FileKind::Archive(ArchiveKind::Tar) => self.walk_tar(BufReader::new(file)),
            FileKind::Program | FileKind::Other => Err(ArchiveError::Unknown(describe(&start))),
        }
    }

    fn walk_zip(&mut self, mut file: File) -> Result<(), ArchiveError> {
        let announced = count_announced(&mut file).map_err(ArchiveError::Read)?;
        // The library reads the whole list of files before it returns the first file.
        if announced.is_some_and(|announced| announced > self.limits.entries as u64) {
            return Err(ArchiveError::Entries(self.limits.entries));
        }
        let packed_size = file.metadata().map_err(ArchiveError::Read)?.len();
        let meter = Meter::new(MAX_LIST_BYTES);
        let mut archive = zip::ZipArchive::new(BufReader::new(meter.reader(file))).map_err(describe_damage)?;
        // Entries of an archive may overlap, and may compress to almost nothing, so their sizes prove nothing.
        meter.set(packed_size.saturating_mul(2).saturating_add(READ_OVERHEAD_BYTES * archive.len() as u64));
        // If several entries have the same name, the library keeps only one, which may be the wrong one.
        if announced.is_some_and(|announced| announced > archive.len() as u64) {
            return Err(ArchiveError::Duplicate("a name".to_owned()));
        }
        for index in 0..archive.len() {
            let mut entry = archive.by_index(index).map_err(describe_damage)?;
            let name = entry.name_raw().to_vec();
            let mode = entry.unix_mode();
            // In Unix permissions, the type of the entry must be missing, or mean a file or a folder.
            if mode.is_some_and(|mode| !matches!(mode & 0o170_000, 0 | 0o100_000 | 0o040_000)) {
                return Err(ArchiveError::Kind(escape_name(&name)));
            }
            if entry.is_dir() {
                self.record_folder(&name)?;
            } else {
                self.unpack_file(&name, mode.is_some_and(|mode| mode & 0o111 != 0), &mut entry)?;
            }
        }
        Ok(())
    }

    fn walk_tar(&mut self, input: impl Read) -> Result<(), ArchiveError> {
        let meter = Meter::new(self.limits.bytes.saturating_add(READ_OVERHEAD_BYTES * self.limits.entries as u64));
        let mut archive = tar::Archive::new(meter.reader(input));
        // The name of the next file, if a header states it. The library would read such a header whatever its length.
        let mut long_name = None;
        for entry in archive.entries().map_err(describe_damage)?.raw(true) {
            let mut entry = entry.map_err(describe_damage)?;
            let kind = entry.header().entry_type();
            if kind == tar::EntryType::GNULongName {
                let mut name = read_header(&mut entry)?;
                name.truncate(name.iter().position(|byte| *byte == 0).unwrap_or(name.len()));
                long_name = Some(name);
                continue;
            }
            if kind == tar::EntryType::XHeader {
                let header = read_header(&mut entry)?;
                for extension in tar::PaxExtensions::new(&header) {
                    let extension = extension.map_err(describe_damage)?;
                    match extension.key_bytes() {
                        b"path" => long_name = Some(extension.value_bytes().to_vec()),
                        // Only files that are larger than allowed have this field.
                        b"size" => return Err(ArchiveError::Bytes(self.limits.bytes)),
                        _ => {}
                    }
                }
                continue;
            }
            let name = long_name.take().unwrap_or_else(|| entry.path_bytes().into_owned());
            match kind {
                tar::EntryType::Directory => self.record_folder(&name)?,
                tar::EntryType::Regular | tar::EntryType::Continuous => {
                    let executable = entry.header().mode().is_ok_and(|mode| mode & 0o111 != 0);
                    self.unpack_file(&name, executable, &mut entry)?;
                }
                // This header describes the archive as a whole, and not an entry.
                tar::EntryType::XGlobalHeader => {}
                _ => return Err(ArchiveError::Kind(escape_name(&name))),
            }
        }
        Ok(())
    }

    /// Returns the path of an entry. Fails if it leads out of the folder.
    fn check_path(&mut self, name: &[u8]) -> Result<PathBuf, ArchiveError> {
        self.entries += 1;
        if self.entries > self.limits.entries {
            return Err(ArchiveError::Entries(self.limits.entries));
        }
        let refused = || ArchiveError::Name(escape_name(name));
        let text = std::str::from_utf8(name).map_err(|_| refused())?;
        // For some programs a backslash separates names; for others it is a part of a name.
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
        if path.components().count() > MAX_DEPTH {
            return Err(ArchiveError::Depth(escape_name(name)));
        }
        Ok(path)
    }

    /// Records the folders that contain a file. Fails if one of them is a file.
    fn record_folders_above(&mut self, path: &Path, name: &[u8]) -> Result<(), ArchiveError> {
        for folder in path.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty()) {
            if self.seen_paths.contains(folder) {
                return Err(ArchiveError::Duplicate(escape_name(name)));
            }
            self.folders.insert(folder.to_owned());
        }
        Ok(())
    }

    fn record_folder(&mut self, name: &[u8]) -> Result<(), ArchiveError> {
        let path = self.check_path(name)?;
        if path.iter().any(is_generated_name) {
            return Ok(());
        }
        self.record_folders_above(&path.join("a file"), name)?;
        if let Some(folder) = self.folder {
            fs::create_dir_all(folder.join(path)).map_err(ArchiveError::Folder)?;
        }
        Ok(())
    }

    fn unpack_file(&mut self, name: &[u8], executable: bool, input: &mut impl Read) -> Result<(), ArchiveError> {
        let path = self.check_path(name)?;
        if path.iter().any(is_generated_name) {
            return self.copy_file(input, &mut io::sink()).map(drop);
        }
        self.record_folders_above(&path, name)?;
        if path.as_os_str().is_empty() || self.folders.contains(&path) || !self.seen_paths.insert(path.clone()) {
            return Err(ArchiveError::Duplicate(escape_name(name)));
        }
        match self.folder {
            None => drop(self.copy_file(input, &mut io::sink())?),
            Some(folder) => {
                let target = folder.join(&path);
                if let Some(parent) = target.parent() {
                    fs::create_dir_all(parent).map_err(ArchiveError::Folder)?;
                }
                let mut output = File::create_new(&target).map_err(ArchiveError::Folder)?;
                let is_program = self.copy_file(input, &mut output)? == FileKind::Program;
                let mode = if executable || is_program { 0o755 } else { 0o644 };
                fs::set_permissions(&target, fs::Permissions::from_mode(mode)).map_err(ArchiveError::Folder)?;
            }
        }
        self.files.push(path);
        Ok(())
    }

    /// Copies a file, and returns its kind. The unpacked bytes are counted, because the sizes that an archive states
    /// may be wrong.
    fn copy_file(&mut self, input: &mut impl Read, output: &mut impl Write) -> Result<FileKind, ArchiveError> {
        const CHUNK_BYTES: u64 = 64 << 10;
        let mut chunk = Vec::new();
        input.by_ref().take(START_BYTES as u64).read_to_end(&mut chunk).map_err(describe_damage)?;
        let kind = FileKind::from_start(&chunk);
        while !chunk.is_empty() {
            self.bytes += chunk.len() as u64;
            if self.bytes > self.limits.bytes {
                return Err(ArchiveError::Bytes(self.limits.bytes));
            }
            output.write_all(&chunk).map_err(ArchiveError::Folder)?;
            chunk.clear();
            input.by_ref().take(CHUNK_BYTES).read_to_end(&mut chunk).map_err(describe_damage)?;
        }
        Ok(kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn zip(files: &[(&str, Option<u32>, &[u8])]) -> File {
        let mut bytes = Cursor::new(Vec::new());
        let mut writer = zip::ZipWriter::new(&mut bytes);
        for (name, mode, content) in files {
            let options = zip::write::SimpleFileOptions::default();
            writer.start_file(*name, mode.map_or(options, |mode| options.unix_permissions(mode))).unwrap();
            writer.write_all(content).unwrap();
        }
        writer.finish().unwrap();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(bytes.get_ref()).unwrap();
        file
    }

    #[test]
    fn programs_are_executable_and_litter_stays_behind() {
        let archive = zip(&[
            ("hw/FOSSSim", None, b"\x7fELF..."),
            ("hw/run.sh", Some(0o644), b"#!/bin/sh\n"),
            ("hw/tool", Some(0o755), b"text"),
            ("hw/main.cpp", None, b"int main() {}"),
            ("hw/build/CMakeCache.txt", None, b"of another machine"),
            ("__MACOSX/hw/._FOSSSim", None, b"attributes"),
        ]);
        let folder = tempfile::tempdir().unwrap();
        let files = unpack(archive, folder.path(), ArchiveLimits::DEFAULT).unwrap();
        let names: Vec<_> = files.iter().map(|file| file.to_str().unwrap()).collect();
        assert_eq!(names, ["hw/FOSSSim", "hw/run.sh", "hw/tool", "hw/main.cpp"]);
        assert_eq!(top_folder(folder.path(), &files), folder.path().join("hw"));
        let executable = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode() & 0o111 != 0;
        assert_eq!(names.into_iter().map(executable).collect::<Vec<_>>(), [true, true, true, false]);
        assert!(!folder.path().join("hw/build").exists() && !folder.path().join("__MACOSX").exists());
    }

    #[test]
    fn only_a_folder_that_holds_everything_is_the_top() {
        let folder = Path::new("f");
        let top = |files: &[&str]| top_folder(folder, &files.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(top(&["hw/a", "hw/b/c"]), Path::new("f/hw"));
        for files in [&["a"][..], &["hw/a", "b"], &["hw/a", "other/b"], &[]] {
            assert_eq!(top(files), folder, "{files:?}");
        }
    }

    #[test]
    fn a_bomb_is_recognized_by_its_ratio() {
        let bomb = || zip(&[("zeros", None, &vec![0; (50 << 20) + 1])]);
        let told = list_archive(bomb(), ArchiveLimits::DEFAULT).unwrap_err().to_string();
        assert!(told.contains("more than 52428800 bytes"), "{told}");
        let deep = zip(&[(&"d/".repeat(MAX_DEPTH + 1), None, b"")]);
        assert!(matches!(list_archive(deep, ArchiveLimits::DEFAULT), Err(ArchiveError::Depth(_))));
    }

    /// Returns an archive with an entry of the given kind and size, followed by a file.
    fn tar(kind: tar::EntryType, size: usize, path: &str) -> File {
        let mut builder = tar::Builder::new(Vec::new());
        let mut header = tar::Header::new_gnu();
        header.set_entry_type(kind);
        header.set_size(size as u64);
        builder.append_data(&mut header, "entry", io::repeat(b'n').take(size as u64)).unwrap();
        builder.append_pax_extensions([("mtime", b"1.5".as_slice()), ("path", path.as_bytes())]).unwrap();
        let mut header = tar::Header::new_gnu();
        header.set_size(0);
        builder.append_data(&mut header, "short", io::empty()).unwrap();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&builder.into_inner().unwrap()).unwrap();
        file
    }

    #[test]
    fn headers_of_tar_archives_name_files_and_are_limited() {
        let long = format!("{}FOSSSim", "folder/".repeat(40));
        let look = |kind, size, path: &str| list_archive(tar(kind, size, path), ArchiveLimits::DEFAULT);
        let files = look(tar::EntryType::Regular, 7, &long).unwrap();
        assert_eq!(files, [Path::new("entry"), Path::new(&long)]);
        for kind in [tar::EntryType::GNULongName, tar::EntryType::XHeader] {
            let told = look(kind, (1 << 20) + 1, &long).unwrap_err().to_string();
            assert!(told.contains("a header is too long"), "{told}");
        }
        assert!(matches!(look(tar::EntryType::GNUSparse, 0, &long), Err(ArchiveError::Kind(_))));
        let passed_over = ArchiveLimits { bytes: 1 << 20, entries: 2 };
        let told = list_archive(tar(tar::EntryType::XGlobalHeader, 2 << 20, &long), passed_over).unwrap_err();
        assert!(told.to_string().contains("may be an archive bomb"), "{told}");
    }

    #[test]
    fn files_that_lie_in_one_another_are_read_so_often_only() {
        const FILES: u16 = 200;
        // The content is one mebibyte of empty blocks.
        let content = [&[0, 0, 0, 0xff, 0xff].repeat(200_000)[..], &[3, 0]].concat();
        let fields = |numbers: &[(u64, usize)]| -> Vec<u8> {
            numbers.iter().flat_map(|(number, size)| number.to_le_bytes()[..*size].to_vec()).collect()
        };
        let sizes = [(8, 2), (0, 4), (0, 4), (content.len() as u64, 4), (0, 4), (4, 2), (0, 2)];
        let mut bytes = [b"PK\x03\x04", &fields(&[(20, 2), (0, 2)])[..], &fields(&sizes), b"0000", &content].concat();
        let directory = bytes.len() as u64;
        for file in 0..FILES {
            let beside = fields(&[(0, 2), (0, 2), (0, 2), (0, 4), (0, 4)]);
            let name = format!("{file:04}");
            bytes.extend([b"PK\x01\x02", &fields(&[(20, 2), (20, 2), (0, 2)])[..], &fields(&sizes)].concat());
            bytes.extend([&beside, name.as_bytes()].concat());
        }
        let (count, size) = (u64::from(FILES), bytes.len() as u64 - directory);
        let end = fields(&[(0, 2), (0, 2), (count, 2), (count, 2), (size, 4), (directory, 4), (0, 2)]);
        bytes.extend([b"PK\x05\x06", &end[..]].concat());
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&bytes).unwrap();
        let told = list_archive(file, ArchiveLimits::DEFAULT).unwrap_err().to_string();
        assert!(told.contains("may be an archive bomb"), "{told}");
    }
}
