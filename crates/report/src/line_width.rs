//! Breaks lines at blanks, for terminals of a given width.
//!
//! The functions work on finished text, so that the code that renders reports needs no width. The rest of a broken line
//! is indented like its beginning. Color codes have no width. Words that are too long, and lines that the reader copies
//! (they begin with `$ `), are not broken. Every line of a program's output gets a mark (`| `), so that it can't be
//! mistaken for a line of the report.
use unicode_width::UnicodeWidthChar;

/// The minimum width of the last column if the rest of a broken line is to be indented below it.
const MIN_LAST_COLUMN: usize = 30;

/// Breaks lines so that they are no wider than `width`, if their words allow it.
pub fn wrap(text: &str, width: usize) -> String {
    let mut result = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (line, end) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\n"));
        push_wrapped(&mut result, line, width);
        result += end;
    }
    result
}

/// Returns the width of a text in columns. Color codes have no width.
pub fn count_columns(text: &str) -> usize {
    let mut inside_code = false;
    text.chars()
        .map(|c| match c {
            '\x1b' => {
                inside_code = true;
                0
            }
            'm' if inside_code => {
                inside_code = false;
                0
            }
            _ if inside_code => 0,
            c => c.width().unwrap_or(0),
        })
        .sum()
}

fn push_wrapped(result: &mut String, line: &str, width: usize) {
    let body = line.trim_start_matches(' ');
    if count_columns(line) <= width || body.starts_with("$ ") {
        *result += line;
        return;
    }
    let (indent, mark) = find_continuation(line, body, width);
    let mut at = 0;
    let mut fresh = true;
    for piece in line.split_inclusive(' ') {
        let (word, wide) = (piece.trim_end_matches(' '), count_columns(piece));
        // Blanks at the end of a line need no space.
        if !fresh && !word.is_empty() && at + count_columns(word) > width {
            result.truncate(result.trim_end_matches(' ').len());
            result.push('\n');
            *result += &" ".repeat(indent);
            *result += mark;
            at = indent + mark.len();
        }
        *result += piece;
        at += wide;
        fresh = fresh && word.is_empty();
    }
}

/// Returns the prefix for the rest of a broken line: a number of blanks, and the mark of a program's output.
fn find_continuation(line: &str, body: &str, width: usize) -> (usize, &'static str) {
    let lead = line.len() - body.len();
    if body.starts_with("| ") {
        return (lead, "| ");
    }
    if body.starts_with("- ") {
        return (lead + 2, "");
    }
    // A wrapped table row continues below its last column, if there is space.
    let gaps = line.match_indices("  ").map(|(at, _)| at).filter(|at| *at > lead);
    let columns_at = gaps.filter_map(|at| {
        let rest = line[at..].trim_start_matches(' ');
        (!rest.is_empty()).then(|| count_columns(&line[..line.len() - rest.len()]))
    });
    let last = columns_at.take_while(|at| *at < width).last().filter(|at| at + MIN_LAST_COLUMN <= width);
    (last.unwrap_or(lead + 4), "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_broken_at_blanks_and_indented_under_what_they_continue() {
        let text = "short\n  likely mistake: the sum of radii is not squared anywhere\n- one two three four five six\n";
        assert_eq!(
            wrap(text, 24),
            "short\n  likely mistake: the\n      sum of radii is\n      not squared\n      anywhere\n- one two three \
            four\n  five six\n"
        );
    }

    #[test]
    fn rows_go_on_under_their_last_column_when_there_is_room() {
        let row = "  WA  Group/scene   10  forty of a hundred steps are wrong, the first is step three\n";
        assert_eq!(
            wrap(row, 60),
            "  WA  Group/scene   10  forty of a hundred steps are wrong,\n                        the first is step \
            three\n"
        );
        let narrow = wrap(row, 50);
        assert!(narrow.lines().all(|line| line.len() <= 50), "{narrow}");
        assert_eq!(narrow.lines().nth(1).map(|line| line.len() - line.trim_start().len()), Some(6), "{narrow}");
    }

    #[test]
    fn colors_take_no_room_and_wide_letters_take_two_columns() {
        let painted = "\x1b[1;31mone two\x1b[0m three";
        assert_eq!(wrap(painted, 13), painted);
        assert_eq!(wrap(painted, 12), "\x1b[1;31mone two\x1b[0m\n    three");
        assert_eq!(count_columns("学生"), 4);
        assert_eq!(wrap("学生 学生 学生", 9), "学生 学生\n    学生");
    }

    #[test]
    fn commands_and_long_words_stay_whole_and_output_keeps_its_mark() {
        let command = "    $ fosssim-oracle grade ./FOSSSim --scene Group/name --hints full";
        assert_eq!(wrap(command, 30), command);
        assert_eq!(wrap("a-word-that-is-too-long for it", 10), "a-word-that-is-too-long\n    for it");
        assert_eq!(
            wrap("      | error: no such thing here", 20),
            "      | error: no\n      | such thing\n      | here"
        );
        assert_eq!(wrap("", 10), "");
        assert_eq!(wrap("\n\n", 10), "\n\n");
    }
}
