//! Recognizes files that are not traces.

/// The number of bytes at the start of a file that are read to recognize its kind.
pub const SNIFFED_BYTES: u64 = 512;

/// Returns a phrase about the kind of a file that begins with `start`, such as `is empty`. Returns `None` if the file
/// may be a trace, because traces begin with the bits of a position.
pub fn detect_file_kind(start: &[u8]) -> Option<&'static str> {
    const FILE_SIGNATURES: [(&[u8], &str); 8] = [
        (b"\x7fELF", "looks like a program (ELF)"),
        (b"PK\x03\x04", "looks like a zip archive"),
        (b"\x1f\x8b", "looks like a gzip file; unpack it first"),
        (b"\xfd7zXZ", "looks like an xz file; unpack it first"),
        (b"%PDF", "looks like a PDF"),
        (b"\x89PNG", "looks like a picture (PNG)"),
        (b"\xff\xd8\xff", "looks like a picture (JPEG)"),
        (b"GIF8", "looks like a picture (GIF)"),
    ];
    if start.is_empty() {
        return Some("is empty");
    }
    if let Some((_, what)) = FILE_SIGNATURES.iter().find(|(mark, _)| start.starts_with(mark)) {
        return Some(what);
    }
    let is_text = |byte: &u8| matches!(byte, b'\t' | b'\n' | b'\r' | 0x1b | 0x20..=0x7e);
    let text = std::str::from_utf8(start).map_or_else(|error| &start[..error.valid_up_to()], str::as_bytes);
    if text.len() + 3 < start.len() || !text.iter().all(|byte| is_text(byte) || *byte >= 0x80) {
        return None;
    }
    let text = text.trim_ascii_start().to_ascii_lowercase();
    let begins_with = |marks: &[&[u8]]| marks.iter().any(|mark| text.starts_with(mark));
    Some(if begins_with(&[b"<!doctype html", b"<html"]) {
        "looks like HTML"
    } else if begins_with(&[b"<?xml", b"<scene"]) {
        "looks like a scene or other XML; SCENE comes first, then TRACE"
    } else if begins_with(&[b"{", b"["]) {
        "looks like JSON"
    } else {
        "looks like text"
    })
}
