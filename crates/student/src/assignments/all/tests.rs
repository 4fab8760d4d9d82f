//! The rows are well formed, and their sentences reveal nothing.
use std::collections::BTreeSet;

use super::*;
use crate::formula_detector::find_formula;

#[test]
fn ids_are_unique_and_kebab_case() {
    let ids: BTreeSet<&str> = all_rows().map(|row| row.id).collect();
    assert_eq!(ids.len(), all_rows().count());
    for id in ids {
        assert!(id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{id}");
        assert_eq!(find(id).map(|row| row.id), Some(id));
    }
}

#[test]
fn every_sentence_is_one_and_no_two_rows_are_the_same() {
    for (index, row) in all_rows().enumerate() {
        assert!(row.summary.ends_with('.') && !row.summary.contains(". "), "{}: {}", row.id, row.summary);
        assert!(!row.term.is_empty(), "{}", row.id);
        let twin = all_rows()
            .take(index)
            .find(|other| (other.sentence(), other.term) == (row.sentence(), row.term) && other.kind == row.kind);
        assert!(twin.is_none(), "{} explains the same as {}", row.id, twin.map_or("", |row| row.id));
    }
}

#[test]
fn mistakes_are_described_without_a_formula() {
    let telling: Vec<String> = all_rows()
        .filter_map(|row| Some(format!("{}: {} in {}", row.id, find_formula(row.summary)?, row.summary)))
        .collect();
    assert!(telling.is_empty(), "{telling:#?}");
}
