//! Finds the submissions that the arguments of `grade` mean.
use crate::{
    cli::{console, grading::Grade},
    suite::batch::Submission,
};
use anyhow::{Context, Result, bail};
use std::{
    collections::BTreeMap,
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};

/// The submissions, each with a name of its own.
///
/// # Errors
/// Paths that are not there, folders without any submission.
pub(super) fn find(arguments: &Grade, builds: bool) -> Result<Vec<Submission>> {
    let mut found = Vec::new();
    for path in &arguments.programs {
        let data = fs::metadata(path).with_context(|| format!("no submission at {}", path.display()))?;
        if !data.is_dir() {
            found.push(Submission { name: name_of(path), path: path.clone(), program: None });
        } else if arguments.single {
            found.push(folder(path, arguments, builds));
        } else {
            found.extend(entries(path, arguments, builds)?);
        }
    }
    Ok(with_distinct_names(found))
}

fn name_of(path: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    absolute.file_name().unwrap_or(absolute.as_os_str()).to_string_lossy().into_owned()
}

/// The submission that a folder is: its sources when they are to be built, else the program inside. A program that is
/// missing is the submission's fault: its grade says so.
fn folder(path: &Path, arguments: &Grade, builds: bool) -> Submission {
    let program = (!builds).then(|| arguments.program.clone());
    Submission { name: name_of(path), path: path.to_owned(), program }
}

/// One submission per entry, in alphabetical order. Hidden entries are passed over, and files that can't be run, with a
/// word about each.
fn entries(folder: &Path, arguments: &Grade, builds: bool) -> Result<Vec<Submission>> {
    let listing = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = listing
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()
        .with_context(|| format!("cannot read {}", folder.display()))?;
    paths.retain(|path| path.file_name().is_some_and(|name| !name.as_encoded_bytes().starts_with(b".")));
    paths.sort();
    let mut submissions = Vec::new();
    for path in &paths {
        match fs::metadata(path) {
            Ok(data) if data.is_dir() => submissions.push(self::folder(path, arguments, builds)),
            Ok(data) if data.is_file() && data.permissions().mode() & 0o111 != 0 => {
                submissions.push(Submission { name: name_of(path), path: path.clone(), program: None });
            }
            Ok(_) => console::complain(format!("passed over {}: it is not executable\n", path.display()).as_bytes()),
            Err(error) => console::complain(format!("passed over {}: {error}\n", path.display()).as_bytes()),
        }
    }
    if submissions.is_empty() {
        bail!("{} holds no submission: neither programs nor folders", folder.display());
    }
    Ok(submissions)
}

/// Submissions of one name get their paths as names.
fn with_distinct_names(mut submissions: Vec<Submission>) -> Vec<Submission> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for submission in &submissions {
        *counts.entry(submission.name.clone()).or_default() += 1;
    }
    for submission in &mut submissions {
        if counts[&submission.name] > 1 {
            submission.name = submission.path.to_string_lossy().into_owned();
        }
    }
    submissions
}
