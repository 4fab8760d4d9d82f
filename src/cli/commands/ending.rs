//! What the commands that grade have in common at their end: exit code, file names, and how much is shown.
use crate::{
    cli::{exit, grading::Grade as Arguments},
    report::{
        grade::{self, TextDetail},
        style::Style,
    },
    suite::Grade,
};

/// So many scenes and mistakes of a class are shown; class.txt has all.
const HARDEST: usize = 5;

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

/// How much is shown of each submission.
pub(super) const fn shown(arguments: &Arguments, is_class: bool) -> TextDetail {
    match (arguments.quiet, arguments.verbose) {
        (true, _) => TextDetail::Line,
        (_, true) => TextDetail::All,
        _ if is_class => TextDetail::Table,
        _ => TextDetail::Wrong,
    }
}

/// The report on several submissions ends with what the class comes to.
pub(super) fn with_class(text: String, grades: &[Grade], shown: TextDetail, style: Style) -> String {
    match grades.len() > 1 && shown > TextDetail::Line {
        true => text + "\n" + &grade::class(grades, HARDEST, style),
        false => text,
    }
}
