//! The key under which a result is found again. It is a digest of everything that the result depends on.
use serde::{Deserialize, Serialize};
use std::{
    fs::File,
    io::{self, Read, Seek},
    sync::OnceLock,
};

/// A key: a digest of everything that a result depends on.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ResultKey(String);

impl ResultKey {
    /// Returns the key of a run. It is computed from the digests of the program and the scene, and from `parts`, which
    /// name everything else that matters, such as the rules, the limits, the command and the kind of judging. The
    /// grader itself is also part of the key.
    pub fn from_program(program: &blake3::Hash, scene: &[u8], parts: &[&str]) -> Self {
        Self::from_parts(running_build(), program, scene, parts)
    }

    /// Returns the key of a run that is judged by the build `judge` of the grader.
    fn from_parts(judge: &str, program: &blake3::Hash, scene: &[u8], parts: &[&str]) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(program.as_bytes());
        hasher.update(blake3::hash(scene).as_bytes());
        for part in parts.iter().chain(&[judge]) {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part.as_bytes());
        }
        Self(hasher.finalize().to_hex().as_str()[..32].to_owned())
    }
}

/// Returns a digest of the running program, because two builds of the same version may judge differently. If the
/// program's file can't be read, returns the version.
///
/// If the file contains a GNU build ID, which is a digest that the linker computes, the ID is used instead. Reading all
/// of the file would take as long as judging ten small scenes.
pub fn running_build() -> &'static str {
    static BUILD_ID: OnceLock<String> = OnceLock::new();
    BUILD_ID.get_or_init(|| {
        let digest = |mut file: File| -> io::Result<blake3::Hash> {
            if let Some(id) = build_id(&mut file) {
                return Ok(blake3::hash(&id));
            }
            file.rewind()?;
            let mut hasher = blake3::Hasher::new();
            hasher.update_reader(file)?;
            Ok(hasher.finalize())
        };
        let digest = File::open("/proc/self/exe").and_then(digest);
        digest.map_or_else(|_| env!("CARGO_PKG_VERSION").to_owned(), |digest| digest.to_hex().to_string())
    })
}

/// Returns the build ID of a 64-bit ELF file. It must be in the file's first bytes and have the length of a digest, as
/// linkers write it.
fn build_id(file: &mut File) -> Option<Vec<u8>> {
    const MAX_NOTES: u32 = 4;
    const BUILD_ID: u32 = 3;
    const SCANNED_BYTES: u64 = 1 << 14;
    const NOTE_OWNER: &[u8] = b"GNU\0";
    const MIN_BUILD_ID_BYTES: usize = 16;
    let mut start = Vec::new();
    file.take(SCANNED_BYTES).read_to_end(&mut start).ok()?;
    let read_u32 = |bytes: &[u8], at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let read_u64 =
        |bytes: &[u8], at: usize| usize::try_from(u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?)).ok();
    // The file must be a 64-bit, little-endian ELF file.
    if !start.starts_with(b"\x7fELF\x02\x01") {
        return None;
    }
    let headers = start.get(read_u64(&start, 32)?..)?;
    let count = usize::from(u16::from_le_bytes(start.get(56..58)?.try_into().ok()?));
    for header in headers.chunks_exact(56).take(count).filter(|header| read_u32(header, 0) == Some(MAX_NOTES)) {
        let (from, length) = (read_u64(header, 8)?, read_u64(header, 32)?);
        let mut notes = start.get(from..from.checked_add(length)?)?;
        while let (Some(owner), Some(length), Some(kind)) = (read_u32(notes, 0), read_u32(notes, 4), read_u32(notes, 8))
        {
            let (owner, length) = (usize::try_from(owner).ok()?, usize::try_from(length).ok()?);
            let body = 12 + owner.next_multiple_of(4);
            let id = notes.get(body..body.checked_add(length)?)?;
            if kind == BUILD_ID && notes.get(12..12 + owner) == Some(NOTE_OWNER) && length >= MIN_BUILD_ID_BYTES {
                return Some(id.to_vec());
            }
            notes = notes.get(body + length.next_multiple_of(4)..)?;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn keys_differ_when_anything_differs() {
        let program = blake3::hash(b"program");
        assert_ne!(
            ResultKey::from_program(&program, b"scene", &["ab", "c"]),
            ResultKey::from_program(&program, b"scene", &["a", "bc"])
        );
        assert_ne!(ResultKey::from_program(&program, b"scene", &[]), ResultKey::from_program(&program, b"scen", &[]));
        assert_ne!(
            ResultKey::from_program(&blake3::hash(b"x"), b"scene", &[]),
            ResultKey::from_program(&program, b"scene", &[])
        );
        // Two builds of one version count as two different judges.
        assert_ne!(
            ResultKey::from_parts("one build", &program, b"scene", &[]),
            ResultKey::from_parts("another", &program, b"scene", &[])
        );
        assert_eq!(
            ResultKey::from_parts(running_build(), &program, b"scene", &[]),
            ResultKey::from_program(&program, b"scene", &[])
        );
        assert_eq!(running_build().len(), 64, "a digest, and no version");
    }

    #[test]
    fn the_linkers_digest_of_a_program_is_found_and_nothing_that_only_looks_like_one() {
        let read = |bytes: &[u8]| {
            let mut file = tempfile::tempfile().expect("a file");
            file.write_all(bytes).and_then(|()| file.rewind()).expect("written");
            build_id(&mut file)
        };
        let mut program = b"\x7fELF\x02\x01".to_vec();
        program.resize(64 + 56, 0);
        (program[32], program[56], program[64]) = (64, 1, 4);
        (program[64 + 8], program[64 + 32]) = (120, 20 + 36);
        // The note of another program comes first, then the build ID.
        program.extend([5, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0].iter().chain(b"none\0\0\0\0"));
        program.extend([4, 0, 0, 0, 20, 0, 0, 0, 3, 0, 0, 0].iter().chain(b"GNU\0").chain(&[7; 20]));
        assert_eq!(read(&program), Some(vec![7; 20]));
        for length in [0, 10, 60, 100, 130, 150, program.len() - 1] {
            assert_eq!(read(&program[..length]), None, "cut at {length}");
        }
        program[64 + 32] = 255;
        assert_eq!(read(&program), None, "notes that end behind the file");
        assert_eq!(read(b"#!/bin/sh\n"), None);
    }
}
