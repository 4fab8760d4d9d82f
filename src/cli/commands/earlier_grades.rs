//! The option `grade --compare`, which reads an earlier grading and compares its grades with the new ones.
use crate::{
    cli::{console, input},
    files::FilePlace,
    report::{number::format_count, untrusted_text::strip_control_characters},
    suite::{EarlierGrade, Grade},
};
use anyhow::{Context, Result, bail};
use serde::Deserialize;
use std::path::Path;

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
    let shown = input::printable_name(&file.path()).to_string();
    let text = file.read(MAX_BYTES).with_context(|| format!("cannot read the earlier grading {shown}"))?;
    let grades = match serde_json::from_slice(&text) {
        Ok(GradesFile { grades }) => grades,
        // A line without groups is about an entry that is not a submission.
        Err(_) => text.split(|&byte| byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok()).collect(),
    };
    if grades.is_empty() {
        bail!(
            "{shown} contains no grades: give --compare an output folder, its {FILE_NAME}, or the output of --format \
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
    let new: Vec<&str> =
        grades.iter().filter(|grade| grade.earlier_grade.is_none()).map(|grade| grade.submission.as_str()).collect();
    if let (false, [first, ..]) = (earlier.is_empty(), &new[..]) {
        let new = format_count(new.len() as u64, "submission");
        console::print_remark(format!(
            "{new} have no earlier grade, for example {}\n",
            strip_control_characters(first)
        ));
    }
}
