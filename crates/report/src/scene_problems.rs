//! Shows the problems of a scene file. Each is below the line that it is about.
use fosssim_model::scene::{Problem, Problems, Severity};

/// The maximum number of characters of a source line that are shown.
const MAX_SHOWN_CHARS: usize = 100;

/// The maximum number of bytes that can be shown on either side of a position. A character has at most four bytes, and
/// lines may be megabytes long.
const MAX_SHOWN_BYTES: usize = 4 * MAX_SHOWN_CHARS + 8;

/// Renders the problems of a rejected scene: a first line, and then each problem with its line of the file.
///
/// `name` is the scene's name in messages, and `source` is the content of its file.
pub fn render_errors(name: &str, source: &[u8], refused: &Problems) -> String {
    let count = refused.list.iter().filter(|problem| problem.severity == Severity::Error).count();
    let plural = if count == 1 { "error" } else { "errors" };
    let mut text = format!("the scene {name} has {count} {plural}\n");
    for problem in &refused.list {
        text += &format!("\n{}", render_problem(name, source, problem));
    }
    if refused.omitted_count > 0 {
        text += &format!("\nand {} more\n", refused.omitted_count);
    }
    text
}

/// Renders the warnings about an accepted scene; empty if there are none.
pub fn render_warnings(name: &str, source: &[u8], list: &[Problem]) -> String {
    list.iter().map(|problem| render_problem(name, source, problem) + "\n").collect()
}

/// Renders one problem with its line of the file:
///
/// ```text
/// scene.xml:3:14: `m` of particle 0 is not a number
///   3 | <particle m="x"/>
///     |              ^ a number such as 0.5
/// ```
fn render_problem(name: &str, source: &[u8], problem: &Problem) -> String {
    let Problem { line, column, span, message, help, .. } = problem;
    let warning = if problem.severity == Severity::Warning { "warning: " } else { "" };
    let mut text = format!("{name}:{line}:{column}: {warning}{message}\n");
    let start = span.start.min(source.len());
    let from = start.saturating_sub(MAX_SHOWN_BYTES);
    let line_start = source[from..start].iter().rposition(|&byte| byte == b'\n').map_or(from, |at| from + at + 1);
    let end = span.end.clamp(start, find_line_end(source, start));
    let before = escape_line(&source[line_start..start]);
    let marked = escape_line(&source[start..end]);
    let after = escape_line(&source[end..find_line_end(source, end)]);
    let advice = help.as_ref().map(|help| format!(" {help}")).unwrap_or_default();
    if before.is_empty() && marked.is_empty() && after.is_empty() {
        // In an empty file or line there is nothing to point at.
        if !advice.is_empty() {
            text += &format!("    = {}\n", advice.trim_start());
        }
        return text;
    }
    // A long line is cut on both sides of the position.
    let cut = before.chars().count().saturating_sub(MAX_SHOWN_CHARS / 2);
    let (dots, indent) = if cut > 0 { ("...", 3) } else { ("", 0) };
    let before: String = before.chars().skip(cut).collect();
    let room = MAX_SHOWN_CHARS.saturating_sub(before.chars().count());
    let marked: String = marked.chars().take(room.max(1)).collect();
    let tail_room = room.saturating_sub(marked.chars().count());
    let more = if after.chars().count() > tail_room { "..." } else { "" };
    let after: String = after.chars().take(tail_room).collect();
    let width = line.to_string().len();
    let blanks = " ".repeat(indent + before.chars().count());
    let carets = "^".repeat(marked.chars().count().max(1));
    text += &format!("  {line} | {dots}{before}{marked}{after}{more}\n");
    text += &format!("  {:width$} | {blanks}{carets}{advice}\n", "");
    text
}

/// Returns the end of the line that contains the position `at`, or the end of the part that can be shown.
fn find_line_end(source: &[u8], at: usize) -> usize {
    let to = source.len().min(at + MAX_SHOWN_BYTES);
    source[at..to].iter().position(|&byte| byte == b'\n').map_or(to, |found| at + found)
}

/// Returns a part of the file in printable form. Each character has one column, and control characters are replaced.
fn escape_line(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text).trim_end_matches('\r');
    text.chars()
        .map(|c| match c {
            '\t' => ' ',
            c if c.is_control() => '\u{fffd}',
            c => c,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(source: &str, at: &str, line: usize, column: usize) -> Problem {
        let start = source.find(at).unwrap();
        Problem {
            severity: Severity::Error,
            line,
            column,
            span: start..start + at.len(),
            element: None,
            attribute: None,
            message: "it is wrong".to_owned(),
            help: Some("do better".to_owned()),
            is_markup: false,
        }
    }

    #[test]
    fn carets_stand_under_the_place_in_characters() {
        let source = "<a>\n\t<ü b=\"x\"/>\r\n</a>";
        let text = render_problem("s.xml", source.as_bytes(), &problem(source, "x", 2, 8));
        assert_eq!(text, "s.xml:2:8: it is wrong\n  2 |  <ü b=\"x\"/>\n    |        ^ do better\n");
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let source = format!("{}HERE{}", "a".repeat(500), "b".repeat(500));
        let text = render_problem("s", source.as_bytes(), &problem(&source, "HERE", 1, 501));
        let lines: Vec<_> = text.lines().collect();
        assert!(lines[1].len() < MAX_SHOWN_CHARS + 15, "{text}");
        assert_eq!(lines[1].find("HERE"), lines[2].find("^^^^"), "{text}");
    }

    #[test]
    fn a_very_long_line_is_cut_like_a_long_one() {
        let around = |count: usize| {
            let source = format!("{}HERE{}", "\u{1f600}".repeat(count), "\u{1f600}".repeat(count));
            render_problem("s", source.as_bytes(), &problem(&source, "HERE", 1, 9))
        };
        assert!(around(200).contains("...") && around(200).lines().nth(1).unwrap().ends_with("..."));
        assert_eq!(around(100_001), around(200));
        let marked = "x".repeat(100_000);
        assert_eq!(
            render_problem("s", marked.as_bytes(), &problem(&marked, &marked, 1, 1)).lines().nth(1).unwrap().len(),
            109
        );
    }

    #[test]
    fn an_empty_source_has_no_line_to_show() {
        let mut empty = problem("x", "x", 1, 1);
        empty.span = 0..0;
        assert_eq!(render_problem("s", b"", &empty), "s:1:1: it is wrong\n    = do better\n");
    }

    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        let source = "a\u{1b}[31mb";
        assert!(!render_problem("s", source.as_bytes(), &problem(source, "b", 1, 7)).contains('\u{1b}'));
    }
}
