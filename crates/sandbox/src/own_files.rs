//! Finds the grader's own files, which no submission may read or execute.
//!
//! The files contain the answers: the grader and its Python module compute the original's traces, and the sample is a
//! correct submission. Landlock can only allow files, not forbid them. Therefore, if a folder contains such a file, its
//! other entries are allowed one by one.

use memchr::memmem::Finder;
use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::OsStr,
    fs::{DirEntry, File},
    io::{self, Read},
    os::unix::{ffi::OsStrExt, fs::MetadataExt},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
};

/// The path of the current program.
const CURRENT_PROGRAM: &str = "/proc/self/exe";
/// The prefix of the sample program's file name.
const SAMPLE_PREFIX: &str = "fosssim-sample";
/// The prefixes of the file names of the grader's programs.
const PROGRAM_PREFIXES: [&str; 3] = ["fosssim-oracle", "fosssimoracle", "fosssim-sample"];
/// The folders in which the programs are usually installed.
const PROGRAM_FOLDERS: [&str; 4] = ["/usr/local/bin", "/usr/bin", "/bin", "/opt/fosssim"];
/// The mark before the place for a mistake's id, in every build of the grader and of its sample. It is stored backwards
/// here, so that only the place itself has it in the right order. A program with an empty place makes no mistake.
pub const MARK_BACKWARDS: [u8; 32] = *b" di ekatsim htiw ,elpmas-misssof";
/// The number of bytes that are searched for the mark at a time.
const MARK_WINDOW: u64 = 1 << 20;
/// The prefix of the Python module's name, and of the folder that `pip` creates next to the module.
const MODULE_PREFIX: &str = "fosssim";
/// The folders that contain Python installations.
const PYTHON_FOLDERS: [&str; 4] = ["/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/local/lib64"];
/// The folders of modules within a Python installation.
const MODULE_FOLDERS: [&str; 2] = ["dist-packages", "site-packages"];

/// Returns whether a file is called like one of the grader's programs.
pub(super) fn is_program_name(path: &Path) -> bool {
    path.file_name().is_some_and(has_program_name)
}

fn has_program_name(name: &OsStr) -> bool {
    PROGRAM_PREFIXES.iter().any(|own| begins_with(name, own))
}

fn begins_with(name: &OsStr, own: &str) -> bool {
    name.as_bytes().get(..own.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(own.as_bytes()))
}

/// Returns the entries of a folder. If the folder cannot be read, there are none.
fn list_entries(folder: &Path) -> impl Iterator<Item = DirEntry> {
    std::fs::read_dir(folder).into_iter().flatten().flatten()
}

/// Returns the files and folders of the Python module, wherever `pip` has put them below the folders `pythons`.
fn list_modules(pythons: &[PathBuf]) -> Vec<PathBuf> {
    let is_python = |entry: &DirEntry| ["python", "pypy"].iter().any(|kind| begins_with(&entry.file_name(), kind));
    let pythons = pythons.iter().flat_map(|folder| list_entries(folder).filter(is_python));
    let folders = pythons.flat_map(|python| MODULE_FOLDERS.map(|name| python.path().join(name)));
    let modules = folders.flat_map(|folder| {
        list_entries(&folder).filter(|entry| begins_with(&entry.file_name(), MODULE_PREFIX)).collect::<Vec<_>>()
    });
    modules.map(|entry| entry.path()).collect()
}

/// Returns the result of [`list_files`] for the current program and its supervisor. It is computed only once for all
/// runs, because `/usr/bin` alone may contain thousands of files.
pub(super) fn known_files(supervisor: &Path) -> Arc<[PathBuf]> {
    static KNOWN_FILES: Mutex<BTreeMap<PathBuf, Arc<[PathBuf]>>> = Mutex::new(BTreeMap::new());
    let mut files_by_supervisor = KNOWN_FILES.lock().unwrap_or_else(PoisonError::into_inner);
    files_by_supervisor
        .entry(supervisor.to_path_buf())
        .or_insert_with(|| list_files(&[Path::new(CURRENT_PROGRAM), supervisor]).into())
        .clone()
}

/// Returns the resolved paths of `programs`, of the grader's other programs next to them, and of the installed ones.
fn list_files(programs: &[&Path]) -> Vec<PathBuf> {
    let programs: Vec<PathBuf> = programs.iter().filter_map(|program| program.canonicalize().ok()).collect();
    let program_folders = programs.iter().filter_map(|program| program.parent()).map(Path::to_path_buf);
    let installed = PROGRAM_FOLDERS.into_iter().map(PathBuf::from).chain(program_folders);
    // Some of these files are large, and some are links to others.
    let folders: BTreeSet<PathBuf> = installed.filter_map(|folder| folder.canonicalize().ok()).collect();
    let entries = folders.iter().flat_map(|folder| list_entries(folder));
    let named_paths = entries.filter(|entry| has_program_name(&entry.file_name())).map(|entry| entry.path());
    let named_paths = named_paths.chain(list_modules(&PYTHON_FOLDERS.map(PathBuf::from)));
    let mut files: Vec<PathBuf> =
        named_paths.filter_map(|path| path.canonicalize().ok()).chain(programs.iter().cloned()).collect();
    files.sort();
    files.dedup();
    files
}

/// Returns whether a file is the grader or its sample, of this build or any other, with an empty place for a mistake.
/// The sample may be graded at its own path (`itself`), to demonstrate grading; a copy of it is not a submission.
///
/// # Errors
///
/// Fails if the file cannot be read.
pub fn is_own_file(program: &Path, itself: (u64, u64)) -> io::Result<bool> {
    let is_shown = |path: &PathBuf| {
        path.file_name().is_some_and(|name| begins_with(name, SAMPLE_PREFIX))
            && path.metadata().is_ok_and(|metadata| (metadata.dev(), metadata.ino()) == itself)
    };
    Ok(has_mark(File::open(program)?)? && !list_files(&[Path::new(CURRENT_PROGRAM)]).iter().any(is_shown))
}

/// Returns whether bytes contain the mark with an empty place after it.
fn has_mark(mut bytes: impl Read) -> io::Result<bool> {
    // The program that searches must not contain what it searches for.
    let mut mark = std::hint::black_box(MARK_BACKWARDS).to_vec();
    mark.reverse();
    mark.push(0);
    let mark = Finder::new(&mark);
    let mut window = Vec::new();
    while bytes.by_ref().take(MARK_WINDOW).read_to_end(&mut window)? > 0 {
        if mark.find(&window).is_some() {
            return Ok(true);
        }
        // The mark may begin in one window and end in the next.
        window.drain(..window.len().saturating_sub(mark.needle().len()));
    }
    Ok(false)
}

/// A path to which rules may allow access.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum AllowedPath {
    /// The path, and everything below it.
    Whole(PathBuf),
    /// A folder that may be listed, and everything below it, but whose files may not be read.
    Listing(PathBuf),
}

/// Returns the rules that allow everything at and below `path`, except for the files `own`, whose paths must be
/// resolved.
///
/// If the entries of a folder are allowed one by one, links are left out. The targets of links are allowed at their own
/// paths, or not at all.
pub(super) fn allow_all_except(path: &Path, own: &[PathBuf]) -> Vec<AllowedPath> {
    let Ok(path) = path.canonicalize() else { return Vec::new() };
    let mut allowed = Vec::new();
    let mut pending_paths = vec![path];
    while let Some(path) = pending_paths.pop() {
        if own.contains(&path) {
            continue;
        }
        if !own.iter().any(|own| own.starts_with(&path)) {
            allowed.push(AllowedPath::Whole(path));
            continue;
        }
        let real = list_entries(&path).filter(|entry| entry.file_type().is_ok_and(|kind| !kind.is_symlink()));
        pending_paths.extend(real.map(|entry| entry.path()));
        allowed.push(AllowedPath::Listing(path));
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
        let whole: Vec<PathBuf> = allow_all_except(&root, &own)
            .into_iter()
            .filter_map(|allowed| match allowed {
                AllowedPath::Whole(path) => Some(path),
                AllowedPath::Listing(_) => None,
            })
            .collect();
        assert_eq!(whole.len(), 2, "{whole:?}");
        assert!(whole.contains(&root.join("lib")) && whole.contains(&root.join("local/bin/python3")));
        assert_eq!(allow_all_except(&own[0], &own), []);
        assert_eq!(allow_all_except(&root.join("lib"), &own), [AllowedPath::Whole(root.join("lib"))]);
    }

    #[test]
    fn the_module_for_python_is_found_wherever_pip_puts_it() {
        let folder = tempfile::tempdir().unwrap();
        let pythons = [folder.path().to_path_buf()];
        for place in ["python3/dist-packages/fosssim", "python3.12/site-packages/FOSSSim_oracle-1.2.dist-info"] {
            std::fs::create_dir_all(folder.path().join(place)).unwrap();
        }
        for other in ["python3/dist-packages/numpy", "perl5/site-packages/fosssim", "python3.12/fosssim"] {
            std::fs::create_dir_all(folder.path().join(other)).unwrap();
        }
        let mut found = list_modules(&pythons);
        found.sort();
        let names: Vec<_> = found.iter().map(|path| path.strip_prefix(folder.path()).unwrap()).collect();
        assert_eq!(names.len(), 2, "{names:?}");
        assert!(names[0].ends_with("dist-packages/fosssim") && names[1].ends_with("FOSSSim_oracle-1.2.dist-info"));
    }

    #[test]
    fn the_mark_is_found_wherever_it_is_unless_a_mistake_follows() {
        let mark: Vec<u8> = MARK_BACKWARDS.into_iter().rev().collect();
        let window = usize::try_from(MARK_WINDOW).unwrap();
        for before in [0, 1, window - 40, window - 32, window - 1, window, 2 * window - 5] {
            for (after, expected) in [(&b"\0"[..], true), (b"pe-linear\0", false), (b"", false)] {
                let program = [&vec![b'f'; before][..], &mark, after].concat();
                assert_eq!(has_mark(&program[..]).unwrap(), expected, "{before} bytes before");
            }
        }
        assert!(!has_mark(&[&MARK_BACKWARDS[..], b"\0"].concat()[..]).unwrap());
    }

    #[test]
    fn this_program_is_among_the_graders_files() {
        let this = std::fs::read_link("/proc/self/exe").unwrap().canonicalize().unwrap();
        assert!(list_files(&[Path::new(CURRENT_PROGRAM)]).contains(&this));
        assert!(
            is_program_name(Path::new("/x/FOSSSimOracle2")) && is_program_name(Path::new("fosssim-sample.pp-no-two"))
        );
        assert!(!is_program_name(Path::new("/x/FOSSSim")) && !is_program_name(Path::new("python3")));
    }
}
