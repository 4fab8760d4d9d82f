//! Whose a file is that has several names. Backups and tools that save room make such files, and nobody loses points
//! for that; only a submission that was seen to have another's file has none of its own.
use fosssim_files::Identity;
use std::{fs::File, io, os::unix::fs::MetadataExt};

/// Which file a program is, and which other submissions are the same file: a file may have several names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OneFile {
    /// The file.
    pub identity: Identity,
    /// Whether another submission has the same file.
    pub is_shared: bool,
    /// Whether it is another's: the owner of that one's folder owns the file, and the owner of this one's does not.
    pub is_anothers: bool,
}

/// The message for two submissions with one file whose owner nobody can tell. It names nobody: students read it, too.
pub(super) const SHARED: &str =
    "the program is one file with another submission's (a hard link); the machine can't tell whose it is";

/// The message for a program that is another submission's.
pub(super) const ANOTHERS: &str = "it is another submission's file under a second name (a hard link)";

/// The owner of an open file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Whose {
    Own,
    Anothers,
}

/// The owner of an open file, by the notes from the search for submissions.
pub(super) fn whose(file: &File, noted: Option<&OneFile>) -> io::Result<Whose> {
    let metadata = file.metadata()?;
    match noted {
        _ if metadata.nlink() == 1 => Ok(Whose::Own),
        Some(noted) if noted.identity == Identity::of(&metadata) => {
            Ok(if noted.is_anothers { Whose::Anothers } else { Whose::Own })
        }
        // Nobody has looked whose it is: the machine's fault or a trick, and no reason for a zero.
        _ => Err(io::Error::other("the file was exchanged while submissions were graded; grade again")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_with_several_names_is_the_one_that_was_seen() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        for name in ["one", "other"] {
            std::fs::write(at(name), name).expect("written");
        }
        let file = File::open(at("one")).expect("a file");
        let noted = |name: &str, is_anothers| {
            let identity = Identity::of(&std::fs::metadata(at(name)).expect("data"));
            OneFile { identity, is_shared: is_anothers, is_anothers }
        };
        assert_eq!(whose(&file, None).expect("known"), Whose::Own, "one name is enough");
        std::fs::hard_link(at("one"), at("backup")).expect("a backup");
        assert_eq!(whose(&file, Some(&noted("one", false))).expect("known"), Whose::Own);
        assert_eq!(whose(&file, Some(&noted("one", true))).expect("known"), Whose::Anothers);
        for noted in [None, Some(noted("other", false))] {
            assert!(whose(&file, noted.as_ref()).expect_err("exchanged").to_string().contains("exchanged"));
        }
    }
}
