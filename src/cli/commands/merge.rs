//! `merge`: puts the shards of a grading together.
use super::{
    ending::exit_code,
    last_run::LastRun,
    pages::Pages,
    results::{Results, reports},
    shard::Part,
};
use crate::{
    cli::{console, grading::Merge},
    report::{
        grade::{self, Text, TextDetail},
        number::counted,
    },
    suite::{
        Grade,
        results::{FolderResults, Results as _, read_line},
    },
};
use anyhow::{Context, Result, bail};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Folders of a grading whose files have names of their own, or of their submission's.
const FOLDERS: [&str; 4] = ["cards", "logs", "traces", "faults"];

/// Folders within folders are followed so far.
const DEEPEST: usize = 4;

pub(super) fn run(arguments: &Merge) -> Result<u8> {
    let reports = reports(&arguments.format)?;
    let parts = find(&arguments.folders)?;
    let (first, output) = complete(&parts, arguments)?;
    let names = &first.common.submissions;
    if names.len() > 1
        && let Some(report) = reports.iter().find(|report| !report.format.takes_several())
    {
        bail!("--format {} holds one submission, and there are {}", report.name, names.len());
    }
    fs::create_dir_all(&output).with_context(|| format!("cannot make {}", output.display()))?;
    // Held to the end: nobody else works in this folder.
    let kept = FolderResults::open(&output, true)?;
    for (folder, _) in &parts {
        for name in FOLDERS {
            copy(&folder.join(name), &output.join(name), DEEPEST)?;
        }
        keep_results(folder, &kept)?;
    }
    let suite = first.common.suite.clone();
    let order = names.clone();
    let mut grades: Vec<Grade> = parts.into_iter().flat_map(|(_, part)| part.grades).collect();
    let place = |grade: &Grade| order.iter().position(|name| *name == grade.submission);
    grades.sort_by_key(place);
    let pages = Pages::new(Some(&output))?;
    LastRun::open(Some(&output), &[], &suite).remember(&grades);
    let reader = arguments.reader.into();
    let results = Results { folder: Some(&output), pages: Some(&pages), reader, is_part: false, grades: &grades };
    results.write(&reports, || text(&grades, arguments.quiet))?;
    Ok(exit_code(&grades))
}

/// The shards in these folders, or in their folders.
fn find(folders: &[PathBuf]) -> Result<Vec<(PathBuf, Part)>> {
    let mut parts: Vec<(PathBuf, Part)> = Vec::new();
    for folder in folders {
        let listing = fs::read_dir(folder).with_context(|| format!("no folder {}", folder.display()))?;
        let mut places: Vec<PathBuf> =
            listing.flatten().map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
        places.sort();
        places.insert(0, folder.clone());
        let before = parts.len();
        for place in places {
            if let Some(part) = Part::read(&place)? {
                parts.push((place, part));
            }
        }
        if parts.len() == before {
            bail!("{} holds no shard that is done: grade --shard leaves shard.json when it ends", folder.display());
        }
    }
    Ok(parts)
}

/// Checks that all shards of one grading are there, each once; one of them, and where the results go.
fn complete<'a>(parts: &'a [(PathBuf, Part)], arguments: &Merge) -> Result<(&'a Part, PathBuf)> {
    let (place, first) = parts.first().context("there is no shard")?;
    for (other, part) in parts {
        if let Some(what) = first.common.difference(&part.common) {
            bail!("{} and {} belong to different gradings: {what}", place.display(), other.display());
        }
    }
    let of = first.common.of;
    let mut missing = Vec::new();
    for number in 1..=of {
        let found: Vec<String> = parts
            .iter()
            .filter(|(_, part)| part.number == number)
            .map(|(place, _)| place.display().to_string())
            .collect();
        match found.len() {
            0 => missing.push(number.to_string()),
            1 => {}
            _ => bail!("shard {number} of {of} is there more than once: {}", found.join(" and ")),
        }
    }
    if !missing.is_empty() {
        let (are, them) = if missing.len() == 1 { ("is", "it") } else { ("are", "them") };
        bail!(
            "{} of {of} {are} missing, or not done: {}; grade {them} with --shard, and merge again",
            counted(missing.len() as u64, "shard"),
            missing.join(", ")
        );
    }
    let output = match (&arguments.output, arguments.folders.as_slice()) {
        (Some(output), _) => output.clone(),
        (None, [folder]) if parts.iter().all(|(place, _)| place != folder) => folder.clone(),
        _ => bail!("say where the results go: --output DIR"),
    };
    if parts.iter().any(|(place, _)| *place == output) {
        bail!("{} is a shard's own folder: give another --output", output.display());
    }
    Ok((first, output))
}

/// Keeps a shard's results in the merged folder, so that a grading in one go finds them there.
fn keep_results(folder: &Path, kept: &FolderResults) -> Result<()> {
    let file = folder.join("journal.jsonl");
    let text = match fs::read(&file) {
        Ok(text) => text,
        // A shard without submissions has none.
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error).with_context(|| format!("cannot read {}", file.display())),
    };
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        // What somebody damaged is graded again, as in any folder.
        if let Some(entry) = read_line(line) {
            kept.keep(&entry.key, &entry.submission, &entry.result)?;
        }
    }
    Ok(())
}

/// Copies the files of a folder that are not there yet. Links are not followed.
fn copy(from: &Path, to: &Path, depth: usize) -> Result<()> {
    let Ok(listing) = fs::read_dir(from) else { return Ok(()) };
    fs::create_dir_all(to).with_context(|| format!("cannot make {}", to.display()))?;
    for entry in listing.flatten() {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        match entry.file_type() {
            Ok(kind) if kind.is_dir() && depth > 0 => copy(&from, &to, depth - 1)?,
            Ok(kind) if kind.is_file() => {
                fs::copy(&from, &to).with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// The report for people who look at it now.
fn text(grades: &[Grade], quiet: bool) -> String {
    let shown = if quiet { TextDetail::Line } else { TextDetail::Table };
    let (style, width) = (console::style(), console::width());
    let text = Text { style, shown, width, again: None, closer: None }.render(grades);
    if quiet || grades.len() < 2 { text } else { text + "\n" + &grade::class(grades, usize::MAX, style) }
}
