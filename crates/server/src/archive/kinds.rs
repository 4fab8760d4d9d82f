//! The kinds of archives, told by how they begin, and those of 7-Zip.
use super::{ArchiveError, Walk, damaged, shown};
use bzip2::read::MultiBzDecoder;
use flate2::read::GzDecoder;
use lzma_rust2::XzReader;
use sevenz_rust2::{Archive, ArchiveEntry, BlockDecoder, Password};
use std::{
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
};

/// The archives that are read, in words.
pub const KNOWN: &str = ".zip, .7z, .tar, .tar.gz, .tar.xz, .tar.bz2";

/// The most memory for what a packer looks back on, in KiB: 64 MiB is what the strongest usual settings take.
const WINDOW: usize = 80 * 1024;

/// The most for the list of files of a 7z archive, in KiB: enough for 20,000 of them.
const HEADER: usize = 2 * 1024;

/// How a file begins, as far as kinds are told by it.
pub(super) fn start_of(file: &mut File) -> io::Result<Vec<u8>> {
    let mut start = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.take(512).read_to_end(&mut start)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(start)
}

/// The kind of a file that is no submission, by how it begins.
pub fn described(start: &[u8]) -> String {
    let known: [(&[u8], &str); 12] = [
        (b"MZ", "a program for Windows"),
        (b"\xcf\xfa\xed\xfe", "a program for macOS"),
        (b"\xce\xfa\xed\xfe", "a program for macOS"),
        (b"\xca\xfe\xba\xbe", "a program for macOS, or a Java class"),
        (b"\x7fELF", "a program for Linux"),
        (b"#!", "a script"),
        (b"Rar!", "a RAR archive"),
        (b"\x28\xb5\x2f\xfd", "an archive packed by zstd"),
        (b"!<arch>", "a library, or a Debian package"),
        (b"%PDF", "a PDF document"),
        (b"PK\x05\x06", "an empty zip archive"),
        (b"SQLite", "a database"),
    ];
    if let Some((_, what)) = known.iter().find(|(magic, _)| start.starts_with(magic)) {
        return (*what).to_owned();
    }
    if start.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace() || *byte >= 0x80) {
        return "text".to_owned();
    }
    let bytes: Vec<String> = start.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
    format!("a file that begins with the bytes {}", bytes.join(" "))
}

impl Walk<'_> {
    /// Walks through an archive of any kind.
    pub(super) fn archive(&mut self, mut file: File) -> Result<(), ArchiveError> {
        let start = start_of(&mut file).map_err(ArchiveError::Folder)?;
        match start.as_slice() {
            [b'P', b'K', 3, 4, ..] => self.zip(file),
            [b'7', b'z', 0xbc, 0xaf, 0x27, 0x1c, ..] => self.seven_zip(file),
            [0x1f, 0x8b, ..] => self.tar(GzDecoder::new(BufReader::new(file))),
            [0xfd, b'7', b'z', b'X', b'Z', 0, ..] => {
                let window = u32::try_from(WINDOW).unwrap_or(u32::MAX);
                self.tar(XzReader::new_mem_limit(BufReader::new(file), true, window))
            }
            [b'B', b'Z', b'h', ..] => self.tar(MultiBzDecoder::new(BufReader::new(file))),
            _ if start.get(257..262) == Some(b"ustar") => self.tar(BufReader::new(file)),
            _ => Err(ArchiveError::Unknown(described(&start))),
        }
    }

    fn seven_zip(&mut self, file: File) -> Result<(), ArchiveError> {
        let (mut file, password) = (BufReader::new(file), Password::empty());
        let archive = Archive::read_with_memory_limit(&mut file, &password, HEADER).map_err(damaged)?;
        // An entry without bytes is in no block.
        for entry in archive.files.iter().filter(|entry| !entry.has_stream) {
            self.seven_zip_entry(entry, &mut io::empty())?;
        }
        let mut refused = None;
        for block in 0..archive.blocks.len() {
            let decoder = BlockDecoder::new_with_memory_limit(1, WINDOW, block, &archive, &password, &mut file);
            let walked = decoder.for_each_entries(&mut |entry, bytes| {
                if entry.has_stream {
                    refused = self.seven_zip_entry(entry, bytes).err();
                }
                Ok(refused.is_none())
            });
            // An error of the walk goes before one of the decoder, which concerns the rest.
            match refused.take() {
                Some(refused) => return Err(refused),
                None => walked.map(drop).map_err(damaged)?,
            }
        }
        Ok(())
    }

    fn seven_zip_entry(&mut self, entry: &ArchiveEntry, bytes: &mut dyn Read) -> Result<(), ArchiveError> {
        let name = entry.name.as_bytes();
        // Permissions of Unix stand in the upper half, where there are any.
        let mode = (entry.windows_attributes & 0x8000 != 0).then_some(entry.windows_attributes >> 16);
        let is_plain = mode.is_none_or(|mode| matches!(mode & 0o170_000, 0 | 0o100_000 | 0o040_000));
        if entry.is_anti_item || !is_plain {
            return Err(ArchiveError::Kind(shown(name)));
        }
        if entry.is_directory {
            return self.folder(name);
        }
        let mut bytes = bytes;
        self.file(name, mode.is_some_and(|mode| mode & 0o111 != 0), &mut bytes)
    }
}
