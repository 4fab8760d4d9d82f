//! The grader's own files, which no program that it runs may read or execute.
//!
//! They hold the answers: the grader computes the original's traces, and the sample is a right submission. Landlock
//! only ever allows, so that a folder with such a file in it is allowed entry by entry.

use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::OsStr,
    os::unix::{ffi::OsStrExt, fs::MetadataExt},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
};

/// This very program.
const THIS: &str = "/proc/self/exe";
/// How the name of the sample begins.
const SAMPLE: &str = "fosssim-sample";
/// How the names of the grader's programs begin.
const NAMES: [&str; 3] = ["fosssim-oracle", "fosssimoracle", "fosssim-sample"];
/// Where they are usually installed.
const FOLDERS: [&str; 4] = ["/usr/local/bin", "/usr/bin", "/bin", "/opt/fosssim"];

/// Whether the file's name is one of the grader's programs.
pub(super) fn is_name(path: &Path) -> bool {
    path.file_name().is_some_and(is_named)
}

fn is_named(name: &OsStr) -> bool {
    let begins =
        |own: &&str| name.as_bytes().get(..own.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(own.as_bytes()));
    NAMES.iter().any(begins)
}

/// The same as [`files`] for this program and the one that supervises its runs, looked up once for all runs: `/usr/bin`
/// alone may hold thousands.
pub(super) fn known(supervisor: &Path) -> Arc<[PathBuf]> {
    static KNOWN: Mutex<BTreeMap<PathBuf, Arc<[PathBuf]>>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry(supervisor.to_path_buf()).or_insert_with(|| files(&[Path::new(THIS), supervisor]).into()).clone()
}

/// The resolved paths of these programs, of their siblings beside them, and of those that are installed.
fn files(programs: &[&Path]) -> Vec<PathBuf> {
    let programs: Vec<PathBuf> = programs.iter().filter_map(|program| program.canonicalize().ok()).collect();
    let beside = programs.iter().filter_map(|program| program.parent()).map(Path::to_path_buf);
    let installed = FOLDERS.into_iter().map(PathBuf::from).chain(beside);
    // Some of them are links to others, and large.
    let folders: BTreeSet<PathBuf> = installed.filter_map(|folder| folder.canonicalize().ok()).collect();
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten().flatten());
    let named = entries.filter(|entry| is_named(&entry.file_name())).map(|entry| entry.path());
    let mut files: Vec<PathBuf> =
        named.filter_map(|path| path.canonicalize().ok()).chain(programs.iter().cloned()).collect();
    files.sort();
    files.dedup();
    files
}

/// Whether a file of this length and digest is one of the grader's own programs. The sample may be graded where it lies
/// (`itself`), to show that all works; a copy of it, or the grader in any form, is nobody's submission.
#[must_use]
pub fn is_own(length: u64, digest: &blake3::Hash, itself: (u64, u64)) -> bool {
    files(&[Path::new(THIS)]).into_iter().any(|path| {
        let Ok(metadata) = path.metadata() else { return false };
        let sample = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(SAMPLE));
        // Its name matters less than its content: the grader answers to other names, too.
        let shown = sample && (metadata.dev(), metadata.ino()) == itself;
        metadata.len() == length && !shown && digest_of(&path).is_some_and(|own| own == *digest)
    })
}

fn digest_of(path: &Path) -> Option<blake3::Hash> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(std::fs::File::open(path).ok()?).ok()?;
    Some(hasher.finalize())
}

/// A path that may be allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Allowed {
    /// With all that lies beneath it.
    Whole(PathBuf),
    /// A folder that may only be listed, with all beneath it.
    Listing(PathBuf),
}

/// The rules that allow everything at and beneath `path` except the files `own` (resolved paths).
///
/// Links beneath a folder that is split are left out: their targets are allowed in their own places, or not at all.
pub(super) fn around(path: &Path, own: &[PathBuf]) -> Vec<Allowed> {
    let Ok(path) = path.canonicalize() else { return Vec::new() };
    let mut allowed = Vec::new();
    let mut left = vec![path];
    while let Some(path) = left.pop() {
        if own.contains(&path) {
            continue;
        }
        if !own.iter().any(|own| own.starts_with(&path)) {
            allowed.push(Allowed::Whole(path));
            continue;
        }
        let entries = std::fs::read_dir(&path).into_iter().flatten().flatten();
        let real = entries.filter(|entry| entry.file_type().is_ok_and(|kind| !kind.is_symlink()));
        left.extend(real.map(|entry| entry.path()));
        allowed.push(Allowed::Listing(path));
    }
    allowed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_around_the_graders_file_is_allowed_and_not_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        std::fs::create_dir_all(root.join("local/bin")).unwrap();
        std::fs::create_dir_all(root.join("lib/gcc")).unwrap();
        for name in ["local/bin/fosssim-oracle", "local/bin/python3", "lib/gcc/cc1"] {
            std::fs::write(root.join(name), "").unwrap();
        }
        std::os::unix::fs::symlink("fosssim-oracle", root.join("local/bin/innocent")).unwrap();
        let own = [root.join("local/bin/fosssim-oracle")];
        let whole: Vec<PathBuf> = around(&root, &own)
            .into_iter()
            .filter_map(|allowed| match allowed {
                Allowed::Whole(path) => Some(path),
                Allowed::Listing(_) => None,
            })
            .collect();
        assert_eq!(whole.len(), 2, "{whole:?}");
        assert!(whole.contains(&root.join("lib")) && whole.contains(&root.join("local/bin/python3")));
        assert_eq!(around(&own[0], &own), []);
        assert_eq!(around(&root.join("lib"), &own), [Allowed::Whole(root.join("lib"))]);
    }

    #[test]
    fn this_program_is_among_the_graders_files() {
        let this = std::fs::read_link("/proc/self/exe").unwrap().canonicalize().unwrap();
        assert!(files(&[Path::new(THIS)]).contains(&this));
        assert!(is_name(Path::new("/x/FOSSSimOracle2")) && is_name(Path::new("fosssim-sample.pp-no-two")));
        assert!(!is_name(Path::new("/x/FOSSSim")) && !is_name(Path::new("python3")));
    }
}
