//! The difference of two texts, for every place that shows one.
//!
//! It stands in a crate of its own so that the algorithms are compiled once, and not with every change of what calls
//! them.
//!
//! ```
//! let shown = fosssim_textdiff::unified(("then", "a\nb\n"), ("now", "a\nc\n"));
//! assert_eq!(shown, "--- then\n+++ now\n@@ -1,2 +1,2 @@\n a\n-b\n+c\n");
//! ```
#![forbid(unsafe_code)]

use similar::TextDiff;

/// A unified diff from `old` to `new`, line by line with one line of context, under the names of the two; empty when
/// they are the same.
#[must_use]
pub fn unified(old: (&str, &str), new: (&str, &str)) -> String {
    let ((old_name, old), (new_name, new)) = (old, new);
    TextDiff::from_lines(old, new).unified_diff().context_radius(1).header(old_name, new_name).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_differs_is_shown_with_its_neighbours() {
        let shown = unified(("then", "a\nb\nc\nd\ne\n"), ("now", "a\nb\nc\nD\ne\n"));
        assert_eq!(shown, "--- then\n+++ now\n@@ -3,3 +3,3 @@\n c\n-d\n+D\n e\n");
    }

    #[test]
    fn a_last_line_without_an_end_is_told_apart() {
        let shown = unified(("then", "a\nb\n"), ("now", "a\nb"));
        assert_eq!(shown, "--- then\n+++ now\n@@ -1,2 +1,2 @@\n a\n-b\n+b\n\\ No newline at end of file\n");
    }

    #[test]
    fn equal_texts_have_no_difference() {
        assert_eq!(unified(("then", "a\n"), ("now", "a\n")), "");
    }
}
