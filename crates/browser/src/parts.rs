//! Encodes a list of byte strings as one byte string. The length of each string precedes it, as four bytes with the
//! lowest first.
use serde_json::Value;

/// An answer: a value that becomes JSON, and the byte strings that follow it.
pub(crate) type PageAnswer = Result<(Value, Vec<Vec<u8>>), String>;

/// Joins a list of byte strings into one byte string.
///
/// # Panics
/// Panics if a part has 4 GiB or more, which the memory of a browser page cannot contain.
pub fn join_parts(parts: &[&[u8]]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(parts.iter().map(|part| part.len() + 4).sum());
    for part in parts {
        let length = u32::try_from(part.len()).expect("a part that memory holds");
        bytes.extend(length.to_le_bytes());
        bytes.extend(*part);
    }
    bytes
}

/// Returns the byte strings in a joined list; `None` if bytes are missing at the end.
pub fn split(mut bytes: &[u8]) -> Option<Vec<&[u8]>> {
    let mut parts = Vec::new();
    while !bytes.is_empty() {
        let (length, rest) = bytes.split_first_chunk()?;
        let (part, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        parts.push(part);
        bytes = rest;
    }
    Some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_is_split_again_and_cut_bytes_are_noticed() {
        let parts: [&[u8]; 3] = [b"{}", b"", b"abc"];
        let bytes = join_parts(&parts);
        assert_eq!(split(&bytes).as_deref(), Some(&parts[..]));
        assert_eq!(split(&bytes[..bytes.len() - 1]), None);
        assert_eq!(split(&bytes[..3]), None);
    }
}
