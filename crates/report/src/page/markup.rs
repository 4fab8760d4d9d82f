//! Writes untrusted text into HTML, with escapes.
use crate::number::{format_count, format_g, format_pair};
use crate::untrusted_text::is_invisible;
use fosssim_findings::CourseNote;
use std::fmt::Write;

/// Replaces characters that are invisible, or that change the direction of writing, by their code points.
pub(super) fn replace_invisible_characters(raw: &str) -> String {
    let mut out = String::with_capacity(raw.len());
    for c in raw.chars() {
        if c.is_control() && !matches!(c, '\n' | '\t') || is_invisible(c) {
            let _ = write!(out, "\\u{{{:x}}}", u32::from(c));
        } else {
            out.push(c);
        }
    }
    out
}

/// Escapes visible text for an element or a quoted attribute.
pub(super) fn escape(raw: &str) -> String {
    let mut out = String::with_capacity(raw.len());
    for c in replace_invisible_characters(raw).chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c => out.push(c),
        }
    }
    out
}

/// The escaper for templates. It also makes invisible characters visible.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PageText;

impl askama::filters::Escaper for PageText {
    fn write_escaped_str<W: Write>(&self, mut out: W, raw: &str) -> std::fmt::Result {
        out.write_str(&escape(raw))
    }
}

/// Formats a number of scenes, such as `3 scenes`.
pub(super) fn format_scene_count(count: usize) -> String {
    format_count(count as u64, "scene")
}

/// Renders a course's note. Its text is the link, if there are both.
pub(super) fn render_note(note: Option<&CourseNote>) -> String {
    let Some(CourseNote { text, link, points }) = note else { return String::new() };
    let label = text.as_ref().or(link.as_ref()).map(|words| escape(words.trim_end_matches('.')));
    let link = link.as_ref().map(|address| format!("<a href=\"{}\" rel=\"noopener\">", escape(address)));
    let label = label.map(|label| link.map_or_else(|| label.clone(), |link| format!("{link}{label}</a>")));
    let points = points.map(|points| format!("rubric points: {points}"));
    let parts: Vec<String> = label.into_iter().chain(points).collect();
    format!(" <span class=\"hint\">The course: {}.</span> ", parts.join("; "))
}

/// Escapes a line for HTML, and writes the indices of letters in its formulas as subscripts.
pub(super) fn render_formula(line: &str) -> String {
    let set = |line: String, index| line.replace(&format!("_{index}"), &format!("<sub>{index}</sub>"));
    ["cm", "a", "b", "i"].into_iter().fold(escape(line), set)
}

/// Writes JSON for a data block. Nothing in it can end the block's element.
pub(super) fn render_data(value: &serde_json::Value) -> String {
    value.to_string().replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

/// Formats a number for a table.
pub(super) fn render_number(value: f64) -> String {
    escape(&format_g(value))
}

/// Formats two numbers as HTML, and marks the digits of the second that differ from the first. If the numbers count as
/// equal, digits that differ only because of rounding are left out.
pub(super) fn mark_difference(expected: f64, actual: f64, differs: bool) -> (String, String) {
    if !differs {
        return (render_number(expected), render_number(actual));
    }
    let (expected, actual, place) = format_pair(expected, actual);
    let marked = match place {
        Some(place) => format!("{}<mark>{}</mark>", escape(&actual[..place]), escape(&actual[place..])),
        None => escape(&actual),
    };
    (escape(&expected), marked)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_of_rounding_are_shown_of_nothing_that_counts_as_the_same() {
        let (one, other) = (8.926_142_429_220e-5, 8.926_142_429_196e-5);
        assert_eq!(mark_difference(one, other, false), ("8.92614e-05".to_owned(), "8.92614e-05".to_owned()));
        assert_eq!(
            mark_difference(-0.017_034, -0.2725, true),
            ("-0.017034".to_owned(), "-0.<mark>272500</mark>".to_owned())
        );
    }

    #[test]
    fn hostile_text_stays_text() {
        assert_eq!(escape("<b a='1'>&\"x\"\n"), "&lt;b a=&#39;1&#39;&gt;&amp;&quot;x&quot;\n");
        assert_eq!(escape("a\u{202e}b\u{0}c\u{1b}[1m\u{feff}"), "a\\u{202e}b\\u{0}c\\u{1b}[1m\\u{feff}");
        assert_eq!(render_data(&serde_json::json!("</script><!--")), r#""\u003c/script>\u003c!--""#);
    }
}
