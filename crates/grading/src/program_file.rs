//! Finds the owner of a file that has several names (hard links). Tools for backups and deduplication create such
//! files, which is allowed. A submission is rejected only if its file demonstrably belongs to another submission.
use fosssim_files::Identity;
use std::{fs::File, io, os::unix::fs::MetadataExt};

/// The identity of a program's file, and whether other submissions share the file. A file may have several names (hard
/// links).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProgramFile {
    /// The identity of the file, by which names of the same file are recognized.
    pub identity: Identity,
    /// Whether the same file is in another submission.
    pub is_shared: bool,
    /// Whether the file belongs to another submission. This is so if the file's owner also owns that submission's
    /// folder, but not this submission's folder.
    pub has_other_owner: bool,
}

/// The message if two submissions contain the same file, and it is unknown to which it belongs. Students read it as
/// well, so it contains no names.
pub(super) const SHARED_FILE: &str =
    "the program is the same file as another submission's (a hard link), and its owner is unknown";

/// The message if the program's file belongs to another submission.
pub(super) const FILE_OF_ANOTHER: &str = "the program is a hard link to another submission's file";

/// Returns whether an open file belongs to another submission. `known` is what was found out about the file when
/// submissions were searched for. Fails if a file with several names is not the one that was found during that search.
pub(super) fn belongs_to_another(file: &File, known: Option<&ProgramFile>) -> io::Result<bool> {
    let metadata = file.metadata()?;
    match known {
        _ if metadata.nlink() == 1 => Ok(false),
        Some(known) if known.identity == Identity::from_metadata(&metadata) => Ok(known.has_other_owner),
        // It is unknown to which submission the file belongs, because the machine failed or the file was replaced. This
        // must not cost points.
        _ => Err(io::Error::other("the file was replaced while submissions were graded; grade again")),
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
        let program_file = |name: &str, has_other_owner| {
            let identity = Identity::from_metadata(&std::fs::metadata(at(name)).expect("data"));
            ProgramFile { identity, is_shared: has_other_owner, has_other_owner }
        };
        assert!(!belongs_to_another(&file, None).expect("known"), "one name is enough");
        std::fs::hard_link(at("one"), at("backup")).expect("a backup");
        assert!(!belongs_to_another(&file, Some(&program_file("one", false))).expect("known"));
        assert!(belongs_to_another(&file, Some(&program_file("one", true))).expect("known"));
        for program_file in [None, Some(program_file("other", false))] {
            assert!(
                belongs_to_another(&file, program_file.as_ref())
                    .expect_err("exchanged")
                    .to_string()
                    .contains("was replaced")
            );
        }
    }
}
