//! Reports skipped entries of a class's folder in every format, so that no submission is missing without notice.
use super::shorten_name;
use crate::{
    style::{Style, TextStyle},
    table::{Align, Table},
    untrusted_text::to_one_line,
};
use fosssim_findings::{Grade, SkippedEntry};

/// Adds a warning about each skipped entry to the grade if there is only one grade. A report on one submission has no
/// list of skipped entries.
pub fn add_warnings(grades: &mut [Grade], skipped_entries: &[SkippedEntry]) {
    if let [grade] = grades {
        let warning = |entry: &SkippedEntry| format!("skipped {}: {}", entry.name, entry.reason);
        grade.warnings.extend(skipped_entries.iter().map(warning));
    }
}

/// Returns the list of skipped entries that follows a class's table in the text report. A report on one submission has
/// no such list, so the text is empty.
pub fn list_not_graded(grades: &[Grade], skipped_entries: &[SkippedEntry], style: Style) -> String {
    if skipped_entries.is_empty() || grades.len() < 2 {
        return String::new();
    }
    let mut table = Table::new([Align::Left, Align::Left]);
    for SkippedEntry { name, reason: why } in skipped_entries {
        table.add_row([shorten_name(&to_one_line(name)).into(), to_one_line(why).into()]);
    }
    format!("{}\n{}", style.paint(TextStyle::Strong, "Not graded"), table.render(style))
}
