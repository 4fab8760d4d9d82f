//! The rows made from quantities and slips: each slip in each quantity that it fits.
use super::{
    slips::Slip,
    steps::StepMistake,
    terms::{Edit, TERMS, TermRow},
};
use crate::assignments::rows::{MistakeRow, RowKind};
use std::sync::LazyLock;

impl From<Edit> for StepMistake {
    fn from(edit: Edit) -> Self {
        Self::Edit(edit)
    }
}

fn new_row(term_row: &'static TermRow, slip: Slip) -> MistakeRow<StepMistake> {
    let leak = |text: String| -> &'static str { Box::leak(text.into_boxed_str()) };
    MistakeRow {
        mistake: StepMistake::Edit(Edit { term: term_row.term, slip }),
        id: leak(format!("{}-{}", term_row.id, slip.id())),
        kind: RowKind::Wrong,
        area: term_row.area(),
        summary: leak(format!("{} {}.", term_row.subject, slip.predicate(term_row))),
        term: leak(slip.exact_form(term_row)),
    }
}

/// The catalog rows that edit one term of a formula. Rows for functions that the student left empty come first.
pub static EDIT_ROWS: LazyLock<Vec<MistakeRow<StepMistake>>> = LazyLock::new(|| {
    let of = |row: &'static TermRow| row.slips.iter().copied().flatten().map(move |slip| (row, *slip));
    let mut all: Vec<(&TermRow, Slip)> = TERMS.iter().flat_map(of).collect();
    all.sort_by_key(|(row, slip)| !(row.is_function && *slip == Slip::Missing));
    all.into_iter().map(|(of, slip)| new_row(of, slip)).collect()
});
