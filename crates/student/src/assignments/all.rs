//! All rows of all tables of mistakes.
use super::{
    states::{EDIT_ROWS, STEPS},
    t2m2::{CATALOG, Mistake, Row},
};
use std::sync::LazyLock;

/// The rows that are shared by all milestones: mistakes in forces, integrators and simple collisions.
static SHARED_ROWS: LazyLock<Vec<Row>> =
    LazyLock::new(|| EDIT_ROWS.iter().chain(STEPS).map(|row| row.with_mistake(Mistake::Step(row.mistake))).collect());

/// Returns all rows, in the order of the assignments, with forces and integrators first.
pub fn all_rows() -> impl Iterator<Item = &'static Row> {
    SHARED_ROWS.iter().chain(CATALOG)
}

/// Returns the row with the given id, or `None` if there is none.
pub fn find(id: &str) -> Option<&'static Row> {
    all_rows().find(|row| row.id == id)
}

#[cfg(test)]
mod tests;
