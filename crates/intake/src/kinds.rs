//! Recognizes the kind of a file by its first bytes.

/// The kind of a file, according to its first bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// A program for Linux: an ELF file, or a script that names its interpreter.
    Program,
    /// An archive of a kind that can be unpacked.
    Archive(ArchiveKind),
    /// A file of any other kind.
    Other,
}

/// The kind of an archive that can be unpacked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArchiveKind {
    /// A zip file.
    Zip,
    /// A tar file.
    Tar,
    /// A tar file that is compressed with gzip.
    TarGz,
}

/// A list, for messages, of the file name endings of archives that can be unpacked.
pub const KNOWN_EXTENSIONS: &str = ".zip, .tar.gz, .tar";

/// The number of bytes from which the kind of a file is recognized.
pub const START_BYTES: usize = 512;

impl FileKind {
    /// Returns the kind of a file that begins with `start`. At most [`START_BYTES`] bytes are used.
    pub fn from_start(start: &[u8]) -> Self {
        match start {
            [0x7f, b'E', b'L', b'F', ..] | [b'#', b'!', ..] => Self::Program,
            [b'P', b'K', 3, 4, ..] => Self::Archive(ArchiveKind::Zip),
            [0x1f, 0x8b, ..] => Self::Archive(ArchiveKind::TarGz),
            _ if start.get(257..262) == Some(b"ustar") => Self::Archive(ArchiveKind::Tar),
            _ => Self::Other,
        }
    }
}

/// Returns a description of a file that begins with `start`, for messages.
pub fn describe(start: &[u8]) -> String {
    let kinds_by_start: [(&[u8], &str); 17] = [
        (b"MZ", "a program for Windows"),
        (b"\xcf\xfa\xed\xfe", "a program for macOS"),
        (b"\xce\xfa\xed\xfe", "a program for macOS"),
        (b"\xca\xfe\xba\xbe", "a program for macOS, or a Java class"),
        (b"\x7fELF", "a program for Linux"),
        (b"#!", "a script"),
        (b"PK\x03\x04", "a zip archive"),
        (b"\x1f\x8b", "a file compressed by gzip"),
        (b"Rar!", "a RAR archive"),
        (b"7z\xbc\xaf\x27\x1c", "a 7z archive"),
        (b"\xfd7zXZ\0", "a file compressed by xz"),
        (b"BZh", "a file compressed by bzip2"),
        (b"\x28\xb5\x2f\xfd", "a file compressed by zstd"),
        (b"!<arch>", "a library, or a Debian package"),
        (b"%PDF", "a PDF document"),
        (b"PK\x05\x06", "an empty zip archive"),
        (b"SQLite", "a database"),
    ];
    if let Some((_, what)) = kinds_by_start.iter().find(|(magic, _)| start.starts_with(magic)) {
        return (*what).to_owned();
    }
    if start.is_empty() {
        return "an empty file".to_owned();
    }
    if start.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace() || *byte >= 0x80) {
        return "text".to_owned();
    }
    let bytes: Vec<String> = start.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
    format!("a file that begins with the bytes {}", bytes.join(" "))
}
