//! Parts of ELF files. Every offset in a file is distrusted.

use std::{
    fs::File,
    io::{Read, Seek, SeekFrom},
    path::{Path, PathBuf},
};

/// How such a file begins.
pub(super) const MAGIC: &[u8] = b"\x7fELF";
/// The kind of the segment that names a loader.
pub(super) const INTERPRETER: u32 = 3;
const PT_LOAD: u32 = 1;
const PT_DYNAMIC: u32 = 2;
const DT_NEEDED: u64 = 1;
const DT_STRTAB: u64 = 5;
const DT_STRSZ: u64 = 10;
const DT_RPATH: u64 = 15;
const DT_RUNPATH: u64 = 29;
/// No table of a sane program is longer than this.
const LONGEST_TABLE: u64 = 16 << 20;

/// The requests of a program or library to the loader.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Dynamic {
    /// Names of libraries.
    pub(super) needed: Vec<String>,
    /// Folders to look in.
    pub(super) folders: Vec<PathBuf>,
}

/// A segment of the program header table.
pub(super) struct Segment {
    pub(super) kind: u32,
    pub(super) offset: u64,
    address: u64,
    pub(super) size: u64,
}

/// The program header table of the file whose first bytes are `start`.
pub(super) fn segments(file: &mut File, start: &[u8]) -> Vec<Segment> {
    let Some(offset) = word(start, 32) else { return Vec::new() };
    let count = start.get(56..58).map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]));
    let table = read_at(file, offset, u64::from(count.min(256)) * 56).unwrap_or_default();
    let segment = |entry: &[u8]| {
        let kind = u32::from_le_bytes(entry.get(..4)?.try_into().ok()?);
        Some(Segment { kind, offset: word(entry, 8)?, address: word(entry, 16)?, size: word(entry, 32)? })
    };
    table.chunks_exact(56).filter_map(segment).collect()
}

/// The requests of the file to the loader; `None` where it is no ELF file, or has no dynamic section.
pub(super) fn dynamic(path: &Path) -> Option<Dynamic> {
    let mut file = File::open(path).ok()?;
    let start = read_at(&mut file, 0, 256).filter(|start| start.starts_with(MAGIC))?;
    let segments = segments(&mut file, &start);
    let (entries, names) = (dynamic_entries(&mut file, &segments)?, dynamic_names(&mut file, &segments)?);
    let mut dynamic = Dynamic::default();
    for entry in entries.chunks_exact(16) {
        let tag = word(entry, 0)?;
        let named = || {
            let from = usize::try_from(word(entry, 8)?).ok()?;
            Some(String::from_utf8_lossy(names.get(from..)?.split(|&byte| byte == 0).next()?).into_owned())
        };
        match tag {
            0 => break,
            DT_NEEDED => dynamic.needed.extend(named()),
            DT_RPATH | DT_RUNPATH => {
                let own = path.canonicalize().ok()?.parent()?.to_string_lossy().into_owned();
                let paths = named().unwrap_or_default().replace("${ORIGIN}", &own).replace("$ORIGIN", &own);
                dynamic.folders.extend(paths.split(':').filter(|folder| folder.starts_with('/')).map(PathBuf::from));
            }
            _ => {}
        }
    }
    Some(dynamic)
}

fn dynamic_entries(file: &mut File, segments: &[Segment]) -> Option<Vec<u8>> {
    let dynamic = segments.iter().find(|segment| segment.kind == PT_DYNAMIC)?;
    read_at(file, dynamic.offset, dynamic.size.min(LONGEST_TABLE))
}

/// The string table of the dynamic section: names of libraries and of symbols that are looked up at run time.
pub(super) fn dynamic_names(file: &mut File, segments: &[Segment]) -> Option<Vec<u8>> {
    let entries = dynamic_entries(file, segments)?;
    let value = |tag: u64| entries.chunks_exact(16).find(|entry| word(entry, 0) == Some(tag)).and_then(|e| word(e, 8));
    let (address, size) = (value(DT_STRTAB)?, value(DT_STRSZ)?);
    let holds = |segment: &&Segment| {
        segment.kind == PT_LOAD && address >= segment.address && address - segment.address < segment.size
    };
    let load = segments.iter().find(holds)?;
    read_at(file, load.offset.checked_add(address - load.address)?, size.min(LONGEST_TABLE))
}

fn word(bytes: &[u8], offset: usize) -> Option<u64> {
    Some(u64::from_le_bytes(bytes.get(offset..offset + 8)?.try_into().ok()?))
}

/// Up to `length` bytes at `offset`; fewer at the end of the file.
pub(super) fn read_at(file: &mut File, offset: u64, length: u64) -> Option<Vec<u8>> {
    file.seek(SeekFrom::Start(offset)).ok()?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}
