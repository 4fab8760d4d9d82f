//! All rows of all tables.
use super::{
    states::{EDITS, STEPS},
    t2m2::{CATALOGUE, Mistake, Row},
};
use std::sync::LazyLock;

/// The rows that the milestones before collisions share with later ones.
static STATES: LazyLock<Vec<Row>> =
    LazyLock::new(|| EDITS.iter().chain(STEPS).map(|row| row.with_mistake(Mistake::Step(row.mistake))).collect());

/// Returns all rows, in the order of the assignments: forces and integrators come first.
pub fn all_rows() -> impl Iterator<Item = &'static Row> {
    STATES.iter().chain(CATALOGUE)
}

/// Finds the row with this id.
#[must_use]
pub fn find(id: &str) -> Option<&'static Row> {
    all_rows().find(|row| row.id == id)
}

#[cfg(test)]
mod tests;
