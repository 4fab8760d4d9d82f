//! The option `grade --compare`, which reads an earlier grading and compares its grades with the new ones.
use crate::{
    cli::{console, input},
    files::FilePlace,
    report::untrusted_text::strip_control_characters,
    suite::{EarlierGrade, Grade, SkippedEntry},
};
use anyhow::{Context, Result, bail};
use serde::Deserialize;
use std::{collections::BTreeSet, path::Path};

/// The name of the file of grades in a folder for results.
const FILE_NAME: &str = "grades.jsonl";

/// The maximum size of the file, in bytes. 10,000 submissions of 120 wrong scenes need less than this.
const MAX_BYTES: u64 = 4 << 30;

/// The document that `--format json` writes.
#[derive(Deserialize)]
struct GradesFile {
    grades: Vec<EarlierGrade>,
}

/// Reads the grades of an earlier grading, from its folder or from a file of grades.
///
/// # Errors
///
/// Fails if the file can't be read, or contains no grade.
pub(super) fn read(path: &Path) -> Result<Vec<EarlierGrade>> {
    let file = if path.is_dir() { FilePlace::new(path, FILE_NAME) } else { FilePlace::new("", path) };
    let name = input::printable_name(&file.path()).to_string();
    let text = file.read(MAX_BYTES).with_context(|| format!("cannot read the earlier grading {name}"))?;
    let grades = match serde_json::from_slice(&text) {
        Ok(GradesFile { grades }) => grades,
        // A line without groups is about an entry that is not a submission.
        Err(_) => text.split(|&byte| byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok()).collect(),
    };
    if grades.is_empty() {
        bail!(
            "{name} contains no grades: give --compare an output folder, its {FILE_NAME}, or the output of --format \
             json"
        );
    }
    Ok(grades)
}

/// Adds to each grade the earlier grade of the submission with the same name. If there is only one of each, the names
/// do not matter.
pub(super) fn add_earlier_grades(earlier: &[EarlierGrade], grades: &mut [Grade]) {
    if let ([before], [grade]) = (earlier, &mut *grades) {
        grade.earlier_grade = Some(before.clone());
        return;
    }
    for grade in &mut *grades {
        let name = strip_control_characters(&grade.submission);
        grade.earlier_grade = earlier.iter().find(|before| before.submission == name).cloned();
    }
    if let ([Grade { submission, earlier_grade: None, .. }], [_, ..]) = (&*grades, earlier) {
        let name = strip_control_characters(submission);
        console::print_remark(format!("the earlier grading does not contain {name}\n"));
    }
}

/// Returns an entry for each submission that only the earlier grading contains; none if a single submission is graded.
pub(super) fn list_missing<'n>(
    earlier: &[EarlierGrade],
    names: impl ExactSizeIterator<Item = &'n str>,
) -> Vec<SkippedEntry> {
    if names.len() < 2 {
        return Vec::new();
    }
    let names: BTreeSet<String> = names.map(strip_control_characters).collect();
    let missing = earlier.iter().filter(|before| !names.contains(&before.submission));
    let entry = |before: &EarlierGrade| SkippedEntry {
        name: before.submission.clone(),
        reason: "only the earlier grading contains it".to_owned(),
    };
    missing.map(entry).collect()
}
