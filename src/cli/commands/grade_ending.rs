//! The common end of the commands that grade: exit codes, file names, and the amount of detail.
use crate::{
    cli::{arguments::grade::GradeArguments as Arguments, console, exit},
    report::grade::{self, Advice, Text, TextDetail},
    suite::{Grade, SkippedEntry},
};

/// The maximum number of scenes and mistakes that are shown for a class. The file class.txt lists all of them.
pub(super) const MAX_HARDEST: usize = 5;

/// Returns the exit code of a grading that was not interrupted.
pub(super) fn exit_code(grades: &[Grade]) -> u8 {
    if grades.iter().any(Grade::is_grader_fault) {
        exit::FAULT
    } else if grades.iter().all(|grade| grade.verdict.is_accepted()) {
        exit::ACCEPTED
    } else {
        exit::NOT_ACCEPTED
    }
}

/// Returns the file name for a scene.
pub(super) fn scene_file_name(name: &str) -> String {
    to_file_name(&name.replace('/', "_"))
}

/// Returns the file name for any name. It has no separators and no leading dot, it is not too long, and different names
/// have different file names.
pub(super) fn to_file_name(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ') { c } else { '_' };
    let plain: String = name.chars().map(safe).take(100).collect();
    // Names that look like an option, or that Windows reserves, are changed.
    let plain = plain.trim_start_matches(['.', '-']).trim().trim_end_matches('.');
    if !plain.is_empty() && plain == name && !is_device(plain) {
        return plain.to_owned();
    }
    let digest = &blake3::hash(name.as_bytes()).to_hex()[..8];
    // This mark is not allowed in names that are used unchanged. Otherwise two submissions could have the same file.
    format!("{}{plain}~{digest}", if is_device(plain) { "_" } else { "" })
}

/// Returns whether Windows reserves a name for a device. The part after a dot does not matter.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_lowercase();
    let numbered = |device: &str| stem.strip_prefix(device).is_some_and(|number| "0123456789".contains(number));
    matches!(stem.as_str(), "con" | "prn" | "aux" | "nul") || numbered("com") || numbered("lpt")
}

/// Returns the amount of detail in the text about each submission.
pub(super) const fn text_detail(arguments: &Arguments, is_class: bool) -> TextDetail {
    match (arguments.quiet, arguments.verbose) {
        (true, _) => TextDetail::Line,
        (_, true) => TextDetail::All,
        _ if is_class => TextDetail::Table,
        _ => TextDetail::Wrong,
    }
}

/// Renders the report for a terminal. For several submissions, it ends with a summary of the class (at most
/// `max_hardest` scenes and mistakes) and a list of the skipped entries.
pub(super) fn render_text(
    grades: &[Grade],
    skipped_entries: &[SkippedEntry],
    detail: TextDetail,
    max_hardest: usize,
    closer: Option<Advice<'_>>,
    is_retry: bool,
) -> String {
    let (style, width) = (console::style(), console::width());
    let mut text = Text { style, detail, width, advice: closer, is_retry }.render(grades);
    if grades.len() > 1 && detail > TextDetail::Line {
        text += "\n";
        text += &grade::render_class(grades, max_hardest, style);
    }
    if is_retry && grades.len() > 1 {
        text += "Only scenes that failed in the last grading ran, so these points are no grades.\n";
    }
    text + &grade::list_not_graded(grades, skipped_entries, style)
}

#[cfg(test)]
mod tests {
    use super::{scene_file_name, to_file_name};
    use std::collections::BTreeSet;

    #[test]
    fn a_file_has_a_name_that_every_system_takes_and_no_other_has() {
        assert_eq!(to_file_name("smith-12345678"), "smith-12345678");
        assert_eq!(scene_file_name("Group/scene 1"), "Group_scene 1");
        let names = [
            "alice",
            "alice\\r",
            "-rf",
            "rf",
            "=cmd",
            "a,b",
            "a\"b",
            "..",
            ".",
            "...",
            "con",
            "CON",
            "con.",
            "nul.txt",
            "com1",
            "common",
            "alice.",
            "alice\\u{20}",
            "\u{e9}",
            "e\\u{301}",
            "Zo\u{eb}",
            &to_file_name("Zo\u{eb}"),
            "a/b",
            "a_b",
            "~",
            "",
        ]
        .map(str::to_owned);
        let long = ["x".repeat(255), "\u{754c}".repeat(180), "x".repeat(101)];
        let files: BTreeSet<String> = names.iter().chain(&long).map(|name| to_file_name(name)).collect();
        assert_eq!(files.len(), names.len() + long.len(), "{files:?}");
        for file in &files {
            assert!(file.len() < 120 && !file.starts_with(['-', '.']) && !file.ends_with(['.', ' ']), "{file}");
            let stem = file.split('.').next().unwrap_or_default().to_ascii_lowercase();
            assert!(!["con", "nul", "com1"].contains(&stem.as_str()), "{file}");
        }
    }
}
