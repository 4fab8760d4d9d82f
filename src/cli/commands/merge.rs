//! The command `merge`, which joins the shards of a grading.
use super::{
    grade_ending::{exit_code, render_text},
    last_run::LastRun,
    pages::Pages,
    results::{Results, read_reports, reject_several},
    shard::ShardResult,
};
use crate::{
    cli::{arguments::grade::MergeArguments, console, input, interrupt::clean_up_when_interrupted, output},
    files::{FileError, FilePlace, Folder, FolderEntry},
    report::{
        grade::{self, TextDetail},
        number::format_count,
    },
    suite::{
        Grade,
        results::{FolderResults, JOURNAL_NAME, MAX_JOURNAL_BYTES, Results as _, for_each_line, read_line},
    },
};
use anyhow::{Context, Result, bail};
use std::{
    fs::{self, File},
    io::{self, BufReader, Read},
    path::{Path, PathBuf},
};

/// The folders of a grading whose files have unique names, or the names of submissions.
const COPIED_FOLDERS: [&str; 4] = ["cards", "logs", "traces", "faults"];

/// The maximum depth to which folders are copied.
const MAX_DEPTH: usize = 4;

/// The maximum size of a file that a grading writes, in bytes.
const MAX_FILE_BYTES: u64 = 2 << 30;

pub(super) fn run(arguments: &MergeArguments) -> Result<u8> {
    let reports = read_reports(&arguments.format)?;
    clean_up_when_interrupted();
    let parts = find(&arguments.folders)?;
    let (first, output) = require_complete(&parts, arguments)?;
    let names = &first.common.submissions;
    reject_several(&reports, names.len(), "")?;
    Folder::create(&output).with_context(|| format!("cannot create the folder {}", output.display()))?;
    // The lock is held until the end, so that no other process uses the folder.
    let merged_results = FolderResults::open(&output, true)?;
    for (folder, _) in &parts {
        for name in COPIED_FOLDERS {
            let source = FilePlace::new(folder, name);
            match source.open_folder() {
                Ok(from) => copy_folder(&from, &FilePlace::new(&output, name), MAX_DEPTH)?,
                Err(FileError::Missing { .. }) => {}
                Err(error) => {
                    return Err(error).with_context(|| format!("cannot read {}", source.path().display()));
                }
            }
        }
        keep_results(folder, &merged_results)?;
    }
    let (suite, skipped) = (first.common.suite.clone(), first.skipped_entries.clone());
    let order = names.clone();
    let mut grades: Vec<Grade> = parts.into_iter().flat_map(|(_, part)| part.grades).collect();
    let position = |grade: &Grade| order.iter().position(|name| *name == grade.submission);
    grades.sort_by_key(position);
    Grade::record_same_programs(&mut grades);
    grade::add_warnings(&mut grades, &skipped);
    let pages = Pages::new(Some(&output), false)?;
    LastRun::open(Some(&output), &[], &suite).remember(&grades);
    let reader = arguments.reader;
    let results = Results {
        folder: Some(&output),
        pages: Some(&pages),
        reader,
        platform_hides: false,
        staff_page: None,
        published_page: None,
        is_part: false,
        grades: &grades,
        skipped: &skipped,
    };
    let detail = if arguments.quiet { TextDetail::Line } else { TextDetail::Table };
    results.write(&reports, |grades| render_text(grades, &skipped, detail, usize::MAX, None, false))?;
    Ok(exit_code(&grades))
}

/// Finds shards in the given folders and in their subfolders.
fn find(folders: &[PathBuf]) -> Result<Vec<(PathBuf, ShardResult)>> {
    let mut parts: Vec<(PathBuf, ShardResult)> = Vec::new();
    for folder in folders {
        let listing = fs::read_dir(folder).with_context(|| format!("cannot read the folder {}", folder.display()))?;
        let mut candidates: Vec<PathBuf> =
            listing.flatten().map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
        candidates.sort();
        candidates.insert(0, folder.clone());
        let count_before = parts.len();
        for folder in candidates {
            if let Some(part) = ShardResult::read(&folder)? {
                parts.push((folder, part));
            }
        }
        if parts.len() == count_before {
            bail!("{} has no complete shard: grade --shard writes shard.json at its end", folder.display());
        }
    }
    Ok(parts)
}

/// Checks that each shard of the same grading exists exactly once. Returns one of them, and the folder for the results.
fn require_complete<'a>(
    parts: &'a [(PathBuf, ShardResult)],
    arguments: &MergeArguments,
) -> Result<(&'a ShardResult, PathBuf)> {
    let (folder, first) = parts.first().context("the folders contain no shard")?;
    for (other, part) in parts {
        if let Some(what) = first.common.describe_difference(&part.common) {
            bail!("{} and {} belong to different gradings: {what}", folder.display(), other.display());
        }
    }
    let mut grades = parts.iter().flat_map(|(folder, part)| part.grades.iter().map(move |grade| (folder, grade)));
    if let Some((_, one)) = grades.next()
        && let Some((other, grade)) = grades.find(|(_, grade)| !one.has_same_suite(grade))
    {
        bail!(
            "{} grades {} by a different suite from the others: grade this shard again",
            other.display(),
            grade.submission
        );
    }
    let total = first.common.total;
    let mut missing = Vec::new();
    for number in 1..=total {
        let found: Vec<String> = parts
            .iter()
            .filter(|(_, part)| part.number == number)
            .map(|(folder, _)| folder.display().to_string())
            .collect();
        match found.len() {
            0 => missing.push(number.to_string()),
            1 => {}
            _ => bail!("shard {number} of {total} exists more than once: {}", found.join(" and ")),
        }
    }
    if !missing.is_empty() {
        let (are, them) = if missing.len() == 1 { ("is", "it") } else { ("are", "them") };
        bail!(
            "{} of {total} {are} missing, or not done: {}; grade {them} with --shard, and merge again",
            format_count(missing.len() as u64, "shard"),
            missing.join(", ")
        );
    }
    let output = match (&arguments.output, arguments.folders.as_slice()) {
        (Some(output), _) => output.clone(),
        (None, [folder]) if parts.iter().all(|(part, _)| part != folder) => folder.clone(),
        _ => bail!("choose a folder for the results with --output DIR"),
    };
    if parts.iter().any(|(folder, _)| *folder == output) {
        bail!("{} is a shard's folder; choose another --output", output.display());
    }
    Ok((first, output))
}

/// Stores the results of a shard in the merged folder. A later grading without shards then finds them.
fn keep_results(folder: &Path, merged_results: &FolderResults) -> Result<()> {
    let place = FilePlace::new(folder, JOURNAL_NAME);
    let (file, length) = match place.open_file(MAX_JOURNAL_BYTES) {
        Ok(opened) => opened,
        // If a shard has no submissions, it has no journal.
        Err(FileError::Missing { .. }) => return Ok(()),
        Err(error) => return Err(error).with_context(|| format!("cannot read {}", place.path().display())),
    };
    for_each_line(BufReader::new(file.take(length)), |line| -> Result<()> {
        // A damaged entry is skipped, so a later grading runs its scene again.
        if let Some(entry) = read_line(line) {
            merged_results.store(&entry.key, &entry.submission, &entry.result)?;
        }
        Ok(())
    })
    .with_context(|| format!("cannot read {}", place.path().display()))
}

/// Copies the files of a folder. Links are followed neither in the folder nor at the destination.
fn copy_folder(from: &Folder, to: &FilePlace, depth: usize) -> Result<()> {
    for name in from.list_names().with_context(|| format!("cannot read {}", from.given_path().display()))? {
        let (source, target) = (from.given_path().join(&name), to.join(&name));
        match from.entry(&name) {
            Ok(FolderEntry::Folder(inner)) if depth > 0 => copy_folder(&inner, &target, depth - 1)?,
            Ok(FolderEntry::File(file)) => {
                let copy = || copy_file(file, &target);
                copy().with_context(|| format!("cannot copy {} to {}", source.display(), target.path().display()))?;
            }
            Ok(FolderEntry::Folder(_) | FolderEntry::Other) => {
                console::print_error(format!("skipped {}, which is not a file\n", input::printable_name(&source)));
            }
            Err(error) => return Err(error).with_context(|| format!("cannot read {}", source.display())),
        }
    }
    Ok(())
}

fn copy_file(file: File, target: &FilePlace) -> io::Result<()> {
    let length = file.metadata()?.len();
    if length > MAX_FILE_BYTES {
        return Err(io::Error::other(format!("the file has {length} bytes, the limit is {MAX_FILE_BYTES}")));
    }
    // Only the length that was read before is copied, even if the file grows.
    output::copy_below(target, &mut file.take(length))
}
