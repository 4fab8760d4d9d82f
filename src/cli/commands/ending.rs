//! What the commands that grade have in common at their end: exit code and file names.
use crate::{cli::exit, suite::Grade};

/// How a grading ends that nobody stopped.
pub(super) fn exit_code(grades: &[Grade]) -> u8 {
    if grades.iter().any(Grade::is_our_fault) {
        exit::FAULT
    } else if grades.iter().all(|grade| grade.verdict.is_accepted()) {
        exit::ACCEPTED
    } else {
        exit::NOT_ACCEPTED
    }
}

/// A name as a file name: no separators, no leading dot, not too long, and another for every other name.
pub(super) fn file_name(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ') { c } else { '_' };
    let plain: String = name.replace('/', "_").chars().map(safe).take(100).collect();
    let plain = plain.trim_start_matches('.').trim();
    if !plain.is_empty() && plain == name.replace('/', "_") {
        return plain.to_owned();
    }
    format!("{plain}-{}", &blake3::hash(name.as_bytes()).to_hex()[..8])
}
