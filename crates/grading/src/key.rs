//! Under what a result is found again: a digest of everything that it depends on.
use serde::{Deserialize, Serialize};
use std::{fs::File, sync::OnceLock};

/// What a result depends on, digested.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Key(String);

impl Key {
    /// The key of a run: digests of program and scene, and words for everything else that matters (rules, limits, the
    /// command, the way of judging). What judges is always part of it.
    #[must_use]
    pub fn of(program: &blake3::Hash, scene: &[u8], words: &[&str]) -> Self {
        Self::by(this_build(), program, scene, words)
    }

    /// The key of a run that this build judges.
    fn by(judge: &str, program: &blake3::Hash, scene: &[u8], words: &[&str]) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(program.as_bytes());
        hasher.update(blake3::hash(scene).as_bytes());
        for word in words.iter().chain(&[judge]) {
            hasher.update(&(word.len() as u64).to_le_bytes());
            hasher.update(word.as_bytes());
        }
        Self(hasher.finalize().to_hex().as_str()[..32].to_owned())
    }
}

/// The digest of this very program: two builds of one version may judge differently. Its version where that can't be read.
#[must_use]
pub fn this_build() -> &'static str {
    static BUILD: OnceLock<String> = OnceLock::new();
    BUILD.get_or_init(|| {
        let mut hasher = blake3::Hasher::new();
        let digested = File::open("/proc/self/exe").and_then(|file| hasher.update_reader(file).map(|_| ()));
        digested.map_or_else(|_| env!("CARGO_PKG_VERSION").to_owned(), |()| hasher.finalize().to_hex().to_string())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_differ_when_anything_differs() {
        let program = blake3::hash(b"program");
        assert_ne!(Key::of(&program, b"scene", &["ab", "c"]), Key::of(&program, b"scene", &["a", "bc"]));
        assert_ne!(Key::of(&program, b"scene", &[]), Key::of(&program, b"scen", &[]));
        assert_ne!(Key::of(&blake3::hash(b"x"), b"scene", &[]), Key::of(&program, b"scene", &[]));
        // Two builds of one version are two judges.
        assert_ne!(Key::by("one build", &program, b"scene", &[]), Key::by("another", &program, b"scene", &[]));
        assert_eq!(Key::by(this_build(), &program, b"scene", &[]), Key::of(&program, b"scene", &[]));
        assert_eq!(this_build().len(), 64, "a digest, and no version");
    }
}
