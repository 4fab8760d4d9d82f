//! Finds the submissions that the arguments of `grade` mean.
use crate::{
    cli::{console, grading::Grade, input},
    suite::{Submission, config::BuildStep, upload},
};
use anyhow::{Context, Result, bail};
use std::{
    collections::BTreeSet,
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};

/// What a folder of results holds, whatever it is called.
const RESULTS: [&str; 2] = [".lock", "journal.jsonl"];

/// The folders in it.
const OWN: [&str; 5] = ["logs", "faults", "traces", "cards", "reports"];

/// Where submissions are looked for, and what is none.
pub(super) struct Search<'a> {
    arguments: &'a Grade,
    /// How the suite builds.
    build: Option<&'a BuildStep>,
    /// The folder for results.
    output: &'a Path,
}

impl<'a> Search<'a> {
    /// A search among these arguments.
    pub(super) const fn new(arguments: &'a Grade, build: Option<&'a BuildStep>, output: &'a Path) -> Self {
        Self { arguments, build, output }
    }

    /// The submissions, each with a name of its own.
    ///
    /// # Errors
    /// Paths that are not there, folders without any submission.
    pub(super) fn run(&self) -> Result<Vec<Submission>> {
        let mut found = Vec::new();
        for path in &self.arguments.programs {
            let data = fs::metadata(path).with_context(|| format!("no submission at {}", path.display()))?;
            if !data.is_dir() {
                refuse_scene(path)?;
                found.push(Submission { name: name_of(path), path: path.clone(), program: None });
            } else if self.arguments.single {
                found.push(self.folder(path));
            } else if self.arguments.programs.len() > 1 && self.is_results(path) {
                pass_over(path, "it holds the results of a grading");
            } else if self.is_one(path) {
                found.push(self.folder(path));
            } else {
                found.extend(self.entries(path)?);
            }
        }
        if found.is_empty() {
            bail!("there is no submission: neither programs nor folders");
        }
        Ok(with_distinct_names(found))
    }

    /// The submission that a folder is: its sources when they are to be built, else the program inside. A program that
    /// is missing is the submission's fault: its grade says so.
    fn folder(&self, path: &Path) -> Submission {
        let program = self.build.is_none().then(|| self.arguments.program.clone());
        Submission { name: name_of(path), path: path.to_owned(), program }
    }

    /// Whether a folder is a submission itself: it holds the program, or what the suite's build begins with.
    fn is_one(&self, path: &Path) -> bool {
        let holds = |name: &str| fs::symlink_metadata(path.join(name)).is_ok_and(|data| data.is_file());
        let Some(build) = self.build else { return holds(&self.arguments.program) };
        let tool = build.command.first().map(String::as_str).unwrap_or_default();
        let usual: &[&str] = match tool.rsplit('/').next() {
            Some("make" | "gmake") => &["Makefile", "makefile", "GNUmakefile"],
            Some("cmake") => &["CMakeLists.txt"],
            Some("ninja") => &["build.ninja"],
            _ => &[],
        };
        let words = build.command.iter().map(String::as_str).filter(|word| !word.starts_with('/') && *word != ".");
        usual.iter().copied().chain(words).any(holds)
    }

    /// Whether a folder is the one for results, or holds those of an earlier grading.
    fn is_results(&self, path: &Path) -> bool {
        let same = |one: &Path, other: &Path| matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other);
        same(path, self.output) || RESULTS.iter().all(|name| path.join(name).is_file())
    }

    /// One submission per entry, in alphabetical order. With a word about each are passed over hidden entries, what
    /// can't be run, results of gradings, and links: they could lead to another's submission.
    fn entries(&self, folder: &Path) -> Result<Vec<Submission>> {
        let listing = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
        let mut paths: Vec<PathBuf> = listing
            .map(|entry| entry.map(|entry| entry.path()))
            .collect::<Result<_, _>>()
            .with_context(|| format!("cannot read {}", folder.display()))?;
        paths.sort();
        if self.is_results(folder) {
            paths.retain(|path| !OWN.iter().any(|own| path.file_name().is_some_and(|name| name == *own)));
        }
        let mut submissions = Vec::new();
        for path in &paths {
            match fs::symlink_metadata(path) {
                _ if path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b".")) => {
                    pass_over(path, "its name begins with a dot; name it to grade it");
                }
                Ok(data) if data.is_dir() && self.is_results(path) => {
                    pass_over(path, "it holds the results of a grading");
                }
                Ok(data) if data.is_dir() => submissions.push(self.folder(path)),
                Ok(data) if data.is_symlink() => {
                    pass_over(path, "it is a link, which may lead to another's submission; name it to grade it");
                }
                Ok(data) if data.is_file() && data.permissions().mode() & 0o111 != 0 => {
                    submissions.push(entry(folder, path));
                }
                Ok(_) => pass_over(path, "it is not executable"),
                Err(error) => pass_over(path, &error.to_string()),
            }
        }
        if submissions.is_empty() {
            bail!(
                "{} holds no submission: neither programs nor folders, and no {} of its own; with --single the folder \
                 is one all the same",
                folder.display(),
                self.arguments.program
            );
        }
        Ok(submissions)
    }
}

/// A program among others. It is opened beneath the folder, where another name for another's program is refused.
fn entry(folder: &Path, path: &Path) -> Submission {
    match path.file_name().and_then(|name| name.to_str()) {
        Some(name) => Submission { name: name_of(path), path: folder.to_owned(), program: Some(name.to_owned()) },
        None => Submission { name: name_of(path), path: path.to_owned(), program: None },
    }
}

/// A scene in the place of the program is a slip of whoever types.
fn refuse_scene(path: &Path) -> Result<()> {
    if input::is_scene(path) {
        let name = input::shown(path);
        bail!(
            "{name} is a scene, not a program. To run a program on it: fosssim-oracle explain --program FOSSSim {name}; \
             to grade with it, list it in a suite (fosssim-oracle suite init) and give that with --suite"
        );
    }
    Ok(())
}

fn pass_over(path: &Path, why: &str) {
    let name = path.file_name().map_or_else(|| path.display().to_string(), upload::name);
    console::complain(format!("passed over {}: {why}\n", name.escape_debug()).as_bytes());
}

fn name_of(path: &Path) -> String {
    let absolute = path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned());
    let given = path.file_name().map(upload::name);
    given.unwrap_or_else(|| upload::name(absolute.file_name().unwrap_or(absolute.as_os_str())))
}

/// Submissions of one name get their paths as names; where even these look the same, a number.
fn with_distinct_names(mut submissions: Vec<Submission>) -> Vec<Submission> {
    let names: Vec<String> = submissions.iter().map(|submission| submission.name.clone()).collect();
    let mut taken = BTreeSet::new();
    for submission in &mut submissions {
        if names.iter().filter(|name| **name == submission.name).count() > 1 {
            let path = match &submission.program {
                Some(program) if submission.name == *program => submission.path.join(program),
                _ => submission.path.clone(),
            };
            submission.name = upload::name(path.as_os_str());
        }
        let plain = submission.name.clone();
        let mut number = 1;
        while !taken.insert(submission.name.clone()) {
            number += 1;
            submission.name = format!("{plain} ({number})");
        }
    }
    submissions
}
