//! Finds the submissions that the arguments of `grade` name.
use crate::{
    cli::{arguments::grade::GradeArguments, console, input},
    files::{Folder, Identity},
    suite::{ProgramFile, SkippedEntry, Submission, config::BuildStep, file_names},
};
use anyhow::{Context, Result, bail};
use fosssim_intake::FileKind;
use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::{OsStr, OsString},
    fs,
    io::Read,
    os::unix::fs::{MetadataExt, PermissionsExt},
    path::{Path, PathBuf},
};

/// The files by which a folder with results is recognized.
const RESULT_FILES: [&str; 2] = [".lock", "journal.jsonl"];

/// The names of the subfolders in a folder with results.
const RESULT_FOLDERS: [&str; 5] = ["logs", "faults", "traces", "cards", "reports"];

/// The reason why a folder with results is not a submission.
const RESULT_FOLDER_REASON: &str = "the folder contains the results of a grading";

/// The maximum number of entries in a class's folder.
const MAX_ENTRIES: usize = 100_000;

/// The submissions that the command line names, and the skipped entries, which are not submissions.
pub(super) struct FoundSubmissions {
    pub(super) submissions: Vec<Submission>,
    pub(super) skipped: Vec<SkippedEntry>,
}

/// A submission, before its name is known.
struct Entry {
    /// The path that was named or found.
    path: PathBuf,
    /// The folder of the submission; if it has none, its file.
    folder: PathBuf,
    /// The file name of the program in the folder.
    program: Option<String>,
    /// Whether the folder belongs to this submission alone.
    is_folder: bool,
}

/// A search for submissions. It also collects the skipped entries, which are not submissions.
pub(super) struct Search<'a> {
    arguments: &'a GradeArguments,
    /// The build that the suite prescribes; `None` if there is no build.
    build: Option<&'a BuildStep>,
    /// The folder for results, which is not searched.
    output: &'a Path,
}

impl<'a> Search<'a> {
    /// Creates a search among the command's arguments.
    pub(super) const fn new(arguments: &'a GradeArguments, build: Option<&'a BuildStep>, output: &'a Path) -> Self {
        Self { arguments, build, output }
    }

    /// Returns the submissions, with unique names.
    ///
    /// # Errors
    ///
    /// Fails if a path does not exist, or if a folder has no submissions.
    pub(super) fn run(&self) -> Result<FoundSubmissions> {
        let (mut found, mut skipped) = (Vec::new(), Vec::new());
        for path in &self.arguments.programs {
            let data = fs::metadata(path).with_context(|| format!("no submission at {}", path.display()))?;
            if !data.is_dir() {
                reject_scene(path)?;
                found.push(Entry { path: path.clone(), folder: path.clone(), program: None, is_folder: false });
            } else if self.arguments.single {
                found.push(self.folder_entry(path));
            } else if self.arguments.programs.len() > 1 && self.is_results(path) {
                skip_entry(&mut skipped, path, RESULT_FOLDER_REASON);
            } else if self.is_submission(path) {
                found.push(self.folder_entry(path));
            } else {
                match self.gather_entries(path, &mut found, &mut skipped) {
                    // An empty folder in a class must not stop the others. Its grade says what is missing.
                    Err(_) if self.arguments.programs.len() > 1 => found.push(self.folder_entry(path)),
                    other => other?,
                }
            }
        }
        if found.is_empty() {
            bail!("there is no submission: the folder has neither programs nor folders");
        }
        let paths: Vec<&Path> = found.iter().map(|entry| entry.path.as_path()).collect();
        let names = distinct_names(&paths);
        let files = file_identities(&found, &names);
        let submissions = found.into_iter().zip(names).zip(files);
        let submissions = submissions
            .map(|((entry, name), file)| Submission { name, path: entry.folder, program: entry.program, file })
            .collect();
        Ok(FoundSubmissions { submissions, skipped })
    }

    /// Returns the submission in a folder. If the suite builds submissions, the folder contains sources; otherwise a
    /// program. If the program is missing, the submission is at fault, and its grade says so.
    fn folder_entry(&self, path: &Path) -> Entry {
        let program = self.build.is_none().then(|| self.arguments.program.clone());
        Entry { path: path.to_owned(), folder: path.to_owned(), program, is_folder: true }
    }

    /// Returns whether a folder is a single submission. It then contains the program, or a file with which the suite's
    /// build begins.
    fn is_submission(&self, path: &Path) -> bool {
        let has_file = |name: &str| fs::symlink_metadata(path.join(name)).is_ok_and(|data| data.is_file());
        let Some(build) = self.build else { return has_file(&self.arguments.program) };
        let tool = build.command.first().map(String::as_str).unwrap_or_default();
        let usual: &[&str] = match tool.rsplit('/').next() {
            Some("make" | "gmake") => &["Makefile", "makefile", "GNUmakefile"],
            Some("cmake") => &["CMakeLists.txt"],
            Some("ninja") => &["build.ninja"],
            _ => &[],
        };
        let arguments =
            build.command.iter().map(String::as_str).filter(|argument| !argument.starts_with('/') && *argument != ".");
        usual.iter().copied().chain(arguments).any(has_file)
    }

    /// Returns whether a folder is the one for results, or contains the results of an earlier grading.
    fn is_results(&self, path: &Path) -> bool {
        let is_same_path = |one: &Path, other: &Path| {
            one.canonicalize().ok().zip(other.canonicalize().ok()).is_some_and(|(one, other)| one == other)
        };
        is_same_path(path, self.output) || RESULT_FILES.iter().all(|name| path.join(name).is_file())
    }

    /// Adds one submission per entry, in alphabetical order: folders, programs and archives. Other entries are skipped
    /// and reported. These are hidden entries, results of gradings, and links, which could lead to the submission of
    /// somebody else.
    fn gather_entries(&self, folder: &Path, found: &mut Vec<Entry>, skipped: &mut Vec<SkippedEntry>) -> Result<()> {
        let paths = list_entries(folder, MAX_ENTRIES)?;
        let holds_results = self.is_results(folder);
        let count_before = found.len();
        for path in &paths {
            let is_named = |own: &&str| path.file_name().is_some_and(|name| name == *own);
            let reason = match fs::symlink_metadata(path) {
                _ if holds_results && RESULT_FOLDERS.iter().any(is_named) => RESULT_FOLDER_REASON.to_owned(),
                _ if path.file_name().is_some_and(fosssim_intake::is_generated_name) => {
                    "a file manager or a build tool created it".to_owned()
                }
                _ if path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b".")) => {
                    "the name begins with a dot; name the entry to grade it".to_owned()
                }
                Ok(data) if data.is_dir() && self.is_results(path) => RESULT_FOLDER_REASON.to_owned(),
                Ok(data) if data.is_dir() => {
                    found.push(self.folder_entry(path));
                    continue;
                }
                Ok(data) if data.is_symlink() => {
                    "this is a link, which may lead to another student's submission; name it to grade it".to_owned()
                }
                Ok(data) if data.is_file() => match rejection_reason(folder, path, &data) {
                    Some(reason) => reason,
                    None => {
                        found.push(program_entry(folder, path));
                        continue;
                    }
                },
                Ok(_) => "this is neither a file nor a folder".to_owned(),
                Err(error) => error.to_string(),
            };
            skip_entry(skipped, path, &reason);
        }
        if found.len() == count_before {
            bail!(
                "{} contains no submission: no program, no archive ({}), no folder, and no {}; build sources first, \
                 or take the folder itself as a submission with --single",
                folder.display(),
                fosssim_intake::KNOWN_EXTENSIONS,
                self.arguments.program
            );
        }
        Ok(())
    }
}

/// Returns the paths of the entries in a folder, in alphabetical order.
fn list_entries(folder: &Path, max_entries: usize) -> Result<Vec<PathBuf>> {
    let listing = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = listing
        .take(max_entries + 1)
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()
        .with_context(|| format!("cannot read {}", folder.display()))?;
    if paths.len() > max_entries {
        bail!("{} exceeds the limit of {max_entries} entries: grade it in parts", folder.display());
    }
    paths.sort();
    Ok(paths)
}

/// Returns the reason why a file in a class's folder is not a submission; `None` if it is one. Executable files are
/// submissions. Files that begin like programs or archives are also submissions, because learning platforms do not keep
/// permissions.
fn rejection_reason(folder: &Path, path: &Path, data: &fs::Metadata) -> Option<String> {
    if data.permissions().mode() & 0o111 != 0 {
        return None;
    }
    let mut start = Vec::new();
    let opened = Folder::open_to_write(folder).map_err(|error| error.to_string()).and_then(|folder| {
        folder.open_file(path.file_name().unwrap_or_default(), u64::MAX).map_err(|error| error.to_string())
    });
    let read = opened.and_then(|(file, _)| {
        file.take(fosssim_intake::START_BYTES as u64).read_to_end(&mut start).map_err(|error| error.to_string())
    });
    match (read, FileKind::from_start(&start)) {
        // If the file can't be read, its grade says why.
        (Err(_), _) | (_, FileKind::Program | FileKind::Archive(_)) => None,
        (Ok(_), FileKind::Other) => {
            let found = fosssim_intake::describe(&start);
            Some(format!("this is neither a program nor an archive ({}): {found}", fosssim_intake::KNOWN_EXTENSIONS))
        }
    }
}

/// Returns a submission that is a single program in a class's folder. It is opened below the folder, and no link is
/// followed.
fn program_entry(folder: &Path, path: &Path) -> Entry {
    let program = path.file_name().and_then(OsStr::to_str).map(str::to_owned);
    let folder = if program.is_some() { folder } else { path };
    Entry { path: path.to_owned(), folder: folder.to_owned(), program, is_folder: false }
}

/// Returns an error if a scene was named instead of a program.
fn reject_scene(path: &Path) -> Result<()> {
    if input::is_scene(path) {
        let name = input::printable_name(path);
        bail!(
            "{name} is a scene, not a program. To run a program on it: fosssim-oracle explain --program FOSSSim \
             {name}; to grade with it, list it in a suite (fosssim-oracle suite init) and give that with --suite"
        );
    }
    Ok(())
}

fn skip_entry(skipped: &mut Vec<SkippedEntry>, path: &Path, reason: &str) {
    let name = file_names::to_printable(path.file_name().unwrap_or(path.as_os_str()));
    console::print_error(format!("skipped {name}: {reason}\n"));
    skipped.push(SkippedEntry { name, reason: reason.to_owned() });
}

/// Returns the last part of a path.
fn last_name(path: &Path) -> OsString {
    if let Some(name) = path.file_name() {
        return name.to_owned();
    }
    let absolute = path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned());
    absolute.file_name().unwrap_or(absolute.as_os_str()).to_owned()
}

/// Returns unique names for paths. By default, the name is the last part of the path. If different names look the same,
/// they are written with escapes. If names are equal, as many parent folders as necessary are added. If names still
/// look the same, they get a number.
pub(super) fn distinct_names(paths: &[&Path]) -> Vec<String> {
    let own: Vec<OsString> = paths.iter().map(|path| last_name(path)).collect();
    let mut counts_by_printable: BTreeMap<String, BTreeMap<&OsStr, usize>> = BTreeMap::new();
    for name in &own {
        *counts_by_printable.entry(file_names::to_printable(name)).or_default().entry(name).or_default() += 1;
    }
    let mut used_names = BTreeSet::new();
    let mut name = |(path, own): (&&Path, &OsString)| {
        let printable_name = file_names::to_printable(own);
        let plain = match &counts_by_printable[&printable_name] {
            same if same[own.as_os_str()] > 1 => file_names::to_printable(find_unique_end(path, paths).as_os_str()),
            same if same.len() > 1 => file_names::to_exact(own),
            _ => printable_name,
        };
        let mut name = plain.clone();
        let mut number = 1;
        while !used_names.insert(name.clone()) {
            number += 1;
            name = format!("{plain} ({number})");
        }
        name
    };
    paths.iter().zip(&own).map(&mut name).collect()
}

/// Returns the shortest end of a path that no other path has.
fn find_unique_end<'a>(path: &'a Path, all: &[&Path]) -> &'a Path {
    let mut ends = path.ancestors().skip(1).filter_map(|folder| path.strip_prefix(folder).ok());
    let is_own = |end: &&Path| all.iter().filter(|other| other.ends_with(end)).count() == 1;
    ends.find(is_own).unwrap_or(path)
}

/// Returns the identity of each program's file. If several submissions link to the same file, the file belongs to the
/// submission whose folder has the same owner as the file. In a class, only folders have different owners.
fn file_identities(entries: &[Entry], names: &[String]) -> Vec<Option<ProgramFile>> {
    let file = |entry: &Entry| {
        let program = entry.program.as_ref()?;
        let (identity, owner) = Folder::open_to_write(&entry.folder).ok()?.identity(OsStr::new(program))?;
        let folder = entry.is_folder.then(|| fs::metadata(&entry.folder).ok()).flatten();
        Some((identity, folder.map(|folder| folder.uid() == owner)))
    };
    let files: Vec<Option<(Identity, Option<bool>)>> = entries.iter().map(file).collect();
    let mut owners: BTreeMap<Identity, Vec<usize>> = BTreeMap::new();
    for (number, (identity, _)) in files.iter().enumerate().filter_map(|(number, file)| Some((number, (*file)?))) {
        owners.entry(identity).or_default().push(number);
    }
    for sharers in owners.values().filter(|sharers| sharers.len() > 1) {
        let names: Vec<&str> = sharers.iter().map(|&number| names[number].as_str()).collect();
        console::print_error(format!("one file with several names (hard links): {}\n", names.join(", ")));
    }
    let to_program_file = |(identity, is_owner): (Identity, Option<bool>)| {
        let sharers = &owners[&identity];
        let is_owned = sharers.iter().any(|&other| matches!(files[other], Some((_, Some(true)))));
        ProgramFile { identity, is_shared: sharers.len() > 1, has_other_owner: is_owned && is_owner != Some(true) }
    };
    files.iter().map(|file| file.map(to_program_file)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_class_has_so_many_entries_at_most() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["c", "a", "b"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        assert_eq!(list_entries(folder.path(), 3).unwrap(), ["a", "b", "c"].map(|name| folder.path().join(name)));
        assert!(list_entries(folder.path(), 2).unwrap_err().to_string().contains("the limit of 2 entries"));
    }

    #[test]
    fn every_entry_has_a_name_of_its_own() {
        let names = |paths: &[&str]| distinct_names(&paths.iter().map(Path::new).collect::<Vec<_>>());
        assert_eq!(names(&["c/alice", "c/alice\r", "c/bob"]), ["alice", "alice\\r", "bob"]);
        assert_eq!(names(&["c/\u{e9}", "c/e\u{301}"]), ["\u{e9}", "e\\u{301}"]);
        assert_eq!(names(&["c/e\u{301}"]), ["\u{e9}"]);
        assert_eq!(names(&["one/x", "two/x", "x"]), ["one/x", "two/x", "x"]);
        assert_eq!(names(&["/c/ada/x", "/c/bob/x", "/c/liu/y"]), ["ada/x", "bob/x", "y"]);
        assert_eq!(names(&["x", "x", "x (2)"]), ["x", "x (2)", "x (2) (2)"]);
    }
}
