//! The table of a class, with one row per submission.
use crate::untrusted_text::to_one_line;
use crate::{
    grade::format_optional_points,
    line_width::count_columns,
    style::{Style, TextStyle},
};
use fosssim_findings::{Grade, GroupGrade, changes::GradeChanges};

/// A column of the table: its cells, of which the first is the heading, and their alignment.
struct TextColumn {
    cells: Vec<String>,
    is_right_aligned: bool,
}

/// Renders one row per submission with the points, the worst verdict, the scenes of each group, and the time. If the
/// table is too wide, columns are left out: first the time, then the groups, which are replaced by the total number of
/// accepted scenes.
pub fn render_table(grades: &[Grade], width: Option<usize>, style: Style) -> String {
    let column = |heading: &str, right: bool, cell: &dyn Fn(&Grade) -> String| {
        let cells = std::iter::once(heading.to_owned()).chain(grades.iter().map(cell)).collect();
        TextColumn { cells, is_right_aligned: right }
    };
    let name = column("submission", false, &|grade| shorten_name(&to_one_line(&grade.submission)));
    let score = column("points", true, &|grade| format_optional_points(grade.points));
    let verdict = column("verdict", false, &|grade| grade.verdict.name().to_owned());
    let seconds = column("seconds", true, &|grade| format!("{:.2}", grade.wall.as_secs_f64()));
    let since = |heading: &str, cell: &dyn Fn(GradeChanges<'_>) -> String| {
        column(heading, true, &|grade| grade.changes().map(cell).unwrap_or_default())
    };
    let before = since("before", &|changes| format_optional_points(changes.earlier_points));
    let right = since("right", &|changes| format!("+{}", changes.newly_right.len()));
    let broke = since("broke", &|changes| format!("-{}", changes.newly_wrong.len()));
    let names: Vec<&str> =
        grades.first().iter().flat_map(|grade| &grade.groups).map(|group| group.name.as_str()).collect();
    let is_tests = names.iter().all(|name| name.len() > GROUP_SUFFIX.len() && name.ends_with(GROUP_SUFFIX));
    let groups: Vec<TextColumn> = (0..names.len())
        .map(|number| {
            let name = if is_tests { names[number].trim_end_matches(GROUP_SUFFIX) } else { names[number] };
            column(&shorten_name(&to_one_line(name)), false, &|grade| {
                grade.groups.get(number).map_or_else(String::new, group_cell)
            })
        })
        .collect();
    let scenes = column("scenes", true, &|grade| {
        let accepted_count = grade.scenes().filter(|scene| scene.verdict.is_accepted()).count();
        format!("{accepted_count}/{}", grade.scenes().count())
    });
    let mut base = vec![&name, &score, &verdict];
    if grades.iter().any(|grade| grade.earlier_grade.is_some()) {
        base.extend([&before, &right, &broke]);
    }
    let base = || base.iter().copied();
    let full: Vec<&TextColumn> = base().chain(&groups).chain([&seconds]).collect();
    let without_time: Vec<&TextColumn> = base().chain(&groups).collect();
    let shortest: Vec<&TextColumn> = base().chain([&scenes]).collect();
    let total = |columns: &[&TextColumn]| columns.iter().map(|column| column_width(column) + 2).sum::<usize>();
    let fits = |columns: &[&TextColumn]| width.is_none_or(|width| total(columns) <= width + 2);
    let chosen = [full, without_time].into_iter().find(|columns| fits(columns)).unwrap_or(shortest);
    render_rows(&chosen, grades, style)
}

/// The last word of the course's group names. It is left out in headings.
const GROUP_SUFFIX: &str = "Tests";

/// The maximum width of a name, in columns. From the middle of a longer name, letters are left out.
const MAX_NAME_WIDTH: usize = 40;

/// Shortens a name to the width of the table's column.
pub fn shorten_name(name: &str) -> String {
    const END_WIDTH: usize = MAX_NAME_WIDTH / 2 - 2;
    if count_columns(name) <= MAX_NAME_WIDTH {
        return name.to_owned();
    }
    let letters: Vec<char> = name.chars().collect();
    // A wide letter takes two columns.
    let take_fitting_letters = |letters: &mut dyn Iterator<Item = &char>| -> Vec<char> {
        let mut room = END_WIDTH;
        letters
            .take_while(|letter| {
                let wide = count_columns(&letter.to_string());
                let is_within = wide <= room;
                room = room.saturating_sub(wide);
                is_within
            })
            .copied()
            .collect()
    };
    let start: String = take_fitting_letters(&mut letters.iter()).into_iter().collect();
    let end: String = take_fitting_letters(&mut letters.iter().rev()).into_iter().rev().collect();
    format!("{start}...{end}")
}

fn column_width(column: &TextColumn) -> usize {
    column.cells.iter().map(|cell| count_columns(cell)).max().unwrap_or(0)
}

fn render_rows(columns_of: &[&TextColumn], grades: &[Grade], style: Style) -> String {
    let mut text = String::new();
    for row in 0..=grades.len() {
        let mut line = String::new();
        for (number, column) in columns_of.iter().enumerate() {
            let cell = &column.cells[row];
            let blanks = " ".repeat(column_width(column) - count_columns(cell));
            let look = match row.checked_sub(1) {
                None => Some(TextStyle::Faint),
                // Column 2 contains the verdict.
                Some(grade) if number == 2 => Some(super::verdict_style(grades[grade].verdict)),
                Some(_) => None,
            };
            let cell = look.map_or_else(|| cell.clone(), |look| style.paint(look, cell));
            line += &if column.is_right_aligned { format!("{blanks}{cell}  ") } else { format!("{cell}{blanks}  ") };
        }
        text += line.trim_end();
        text += "\n";
    }
    text
}

/// Returns the text of a cell: `AC`, or the worst verdict and the number of accepted scenes.
fn group_cell(group: &GroupGrade) -> String {
    let accepted_count = group.scenes.iter().filter(|scene| scene.verdict.is_accepted()).count();
    if accepted_count == group.scenes.len() {
        "AC".to_owned()
    } else {
        format!("{} {accepted_count}/{}", group.verdict.code(), group.scenes.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_widens_no_table() {
        assert_eq!(shorten_name("a short name"), "a short name");
        let long = format!("team-{}-17", "x".repeat(180));
        let shown = shorten_name(&long);
        assert!(
            count_columns(&shown) <= MAX_NAME_WIDTH && shown.starts_with("team-x") && shown.ends_with("x-17"),
            "{shown}"
        );
        let wide = shorten_name(&"界".repeat(90));
        assert!(count_columns(&wide) <= MAX_NAME_WIDTH && wide.contains("..."), "{wide}");
    }
}
