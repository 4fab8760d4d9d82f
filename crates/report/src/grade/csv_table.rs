//! CSV tables for spreadsheets. A cell that a spreadsheet would read as a formula gets an apostrophe at its beginning.
use super::{describe_likely, describe_missing_points, find_likely_mistakes, format_points, phrases::NOT_GRADED};
use crate::untrusted_text::to_one_line;
use crate::{view::to_key, words};
use fosssim_findings::{Grade, SkippedEntry, speed::SpeedSource};
use fosssim_mistakes::together::mistake_points;

/// Renders a table with one row per scene.
pub(crate) fn render_scenes(grades: &[Grade], skipped_entries: &[SkippedEntry]) -> String {
    let head = "submission,group,scene,verdict,points,max_points,right_steps,steps,cpu_seconds,wall_seconds,summary,\
                rules_differ,likely_mistake_key";
    let rows = grades.iter().flat_map(|grade| {
        grade.groups.iter().flat_map(move |group| {
            group.scenes.iter().map(move |scene| {
                let likeliest = scene.corrected_explanations.first();
                vec![
                    escape_formula(&grade.submission),
                    escape_formula(&group.name),
                    escape_formula(&scene.scene),
                    scene.verdict.code().to_owned(),
                    scene.points.map(format_points).unwrap_or_default(),
                    format_points(scene.max_points),
                    scene.right_steps.to_string(),
                    scene.steps.to_string(),
                    format!("{:.3}", scene.measured.cpu.as_secs_f64()),
                    format!("{:.3}", scene.measured.wall.as_secs_f64()),
                    escape_formula(&words::summarize(scene)),
                    scene.difference_cause.map(|cause| to_key(&cause)).unwrap_or_default(),
                    likeliest.map(|likeliest| escape_formula(&likeliest.key)).unwrap_or_default(),
                ]
            })
        })
    });
    let head: Vec<String> = head.split(',').map(str::to_owned).collect();
    let rest = render_skipped_entries(skipped_entries, &head, "summary");
    render_table(head, rows.chain(rest))
}

/// Renders a table with one row per submission and one column per group. `rules_differ` counts the scenes that the rule
/// books judge differently. Points are empty if the grader failed or was stopped. `reason` is a sentence about why a
/// submission is not accepted everywhere. `same_program` names the other submissions with the same program. `worth` is
/// the number of points that fixing the first likely mistake would give. If grades are compared with earlier ones, the
/// points before and their change follow. Skipped entries have rows with nothing but the
/// reason.
pub fn render_submissions(grades: &[Grade], skipped_entries: &[SkippedEntry]) -> String {
    let head = "submission,verdict,points,max_points,accepted_scenes,scenes,wall_seconds,rules_differ,likely_mistake,\
                reason,same_program,worth";
    let is_compared = grades.iter().any(|grade| grade.earlier_grade.is_some());
    let head = if is_compared { format!("{head},points_before,points_change") } else { head.to_owned() };
    let mut head: Vec<String> = head.split(',').map(str::to_owned).collect();
    if let Some(first) = grades.first() {
        head.extend(first.groups.iter().map(|group| escape_formula(&group.name)));
        let timed = first.groups.iter().filter(|group| group.speed.is_some());
        head.extend(timed.map(|group| escape_formula(&format!("{}: times the reference", group.name))));
    }
    let rows = grades.iter().map(|grade| {
        let likely = find_likely_mistakes(grade);
        let mistakes = likely.iter().map(|(mistake, _)| describe_likely(grade, mistake));
        let mistakes: Vec<String> = grade.located_failure.iter().map(words::describe_located).chain(mistakes).collect();
        let mut row = vec![
            escape_formula(&grade.submission),
            grade.verdict.name().to_owned(),
            grade.points.map(format_points).unwrap_or_default(),
            format_points(grade.max_points),
            grade.scenes().filter(|scene| scene.verdict.is_accepted()).count().to_string(),
            grade.scenes().count().to_string(),
            format!("{:.3}", grade.wall.as_secs_f64()),
            grade.count_differing().to_string(),
            escape_formula(&mistakes.join(" ")),
            escape_formula(
                &describe_missing_points(grade).or_else(|| words::describe_reason(grade)).unwrap_or_default(),
            ),
            escape_formula(&grade.same_program.join(", ")),
            likely.first().map(|(first, _)| format_points(mistake_points(grade, first))).unwrap_or_default(),
        ];
        if is_compared {
            let before = grade.changes().and_then(|changes| changes.earlier_points);
            let change = grade.points.zip(before).map(|(now, before)| now - before);
            row.extend([before, change].map(|points| points.map(format_points).unwrap_or_default()));
        }
        row.extend(grade.groups.iter().map(|group| group.points.map(format_points).unwrap_or_default()));
        row.extend(grade.groups.iter().filter_map(|group| group.speed.as_ref()).map(|speed| match &speed.source {
            SpeedSource::Measured(measured) => format!("{:.3}", measured.ratio),
            _ => String::new(),
        }));
        row
    });
    let rest = render_skipped_entries(skipped_entries, &head, "reason");
    render_table(head, rows.chain(rest))
}

/// Returns rows for skipped entries. The column `reasons` has the reason why each was skipped.
fn render_skipped_entries(skipped_entries: &[SkippedEntry], head: &[String], reasons: &str) -> Vec<Vec<String>> {
    let cell = |entry: &SkippedEntry, column: &str| match column {
        "submission" => escape_formula(&entry.name),
        "verdict" => NOT_GRADED.to_owned(),
        column if column == reasons => escape_formula(&entry.reason),
        _ => String::new(),
    };
    // A group may have the same name as one of these columns. The columns of groups stay empty.
    let own = head.iter().position(|column| column == reasons).unwrap_or_default();
    let column = |number: usize| if number <= own { head[number].as_str() } else { "" };
    skipped_entries.iter().map(|entry| (0..head.len()).map(|number| cell(entry, column(number))).collect()).collect()
}

fn render_table(head: Vec<String>, rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in std::iter::once(head).chain(rows) {
        // Writing to memory fails only if rows differ in length. These rows have the same length.
        let _ = writer.write_record(&row);
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// Escapes text so that no spreadsheet reads it as a formula. Text that begins like an escaped formula is escaped
/// again, so that different texts have different cells.
fn escape_formula(text: &str) -> String {
    const FORMULA_STARTS: [char; 10] = ['=', '+', '-', '@', '|', '%', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}'];
    let text = to_one_line(text);
    let is_skipped = |c: char| c == '\'' || c.is_whitespace();
    if text.trim_start_matches(is_skipped).starts_with(FORMULA_STARTS) { format!("'{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::{super::samples, *};

    #[test]
    fn a_comparison_has_the_points_before_and_their_change() {
        let then = samples::accepted_grade();
        let mut now = samples::accepted_grade();
        now.points = Some(12.5);
        assert!(!render_submissions(&[now.clone()], &[]).contains("points_before"));
        now.earlier_grade = Some((&then).into());
        let table = render_submissions(&[now], &[]);
        assert!(table.contains(",worth,points_before,points_change,") && table.contains(",20,-7.5,"), "{table}");
    }

    #[test]
    fn formulas_are_defused() {
        assert_eq!(escape_formula("=HYPERLINK(\"x\")"), "'=HYPERLINK(\"x\")");
        assert_eq!(escape_formula(" @SUM(A1)"), "' @SUM(A1)");
        assert_eq!(escape_formula("a=b"), "a=b");
        assert_eq!(escape_formula("\u{ff1d}cmd"), "'\u{ff1d}cmd");
        assert_eq!(
            (escape_formula("'=cmd").as_str(), escape_formula("'").as_str(), escape_formula("O'-x").as_str()),
            ("''=cmd", "'", "O'-x")
        );
    }
}
