//! Annotations of GitHub Actions: workflow commands that show a title and a text next to a job.
use crate::untrusted_text::to_one_line;

/// Returns one annotation. The level is `error` or `warning`.
pub(crate) fn render_annotation(level: &str, title: &str, text: &str) -> String {
    join_annotation(level, title, [text])
}

/// Returns one annotation whose text has several lines.
pub(crate) fn join_annotation<'a>(level: &str, title: &str, lines: impl IntoIterator<Item = &'a str>) -> String {
    let lines: Vec<String> = lines.into_iter().map(escape_data).collect();
    let title = escape_data(title).replace(':', "%3A").replace(',', "%2C");
    format!("::{level} title={title}::{}\n", lines.join("%0A"))
}

/// Escapes the text after `::` in a workflow command.
fn escape_data(text: &str) -> String {
    to_one_line(text).replace('%', "%25")
}
