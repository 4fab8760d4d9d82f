//! Finds the scenes that catch each mistake. Creates the traces of every wrong sample and every correct variant on
//! every scene of a folder, in memory, and judges them by each rule book. `scripts/mutation-matrix [FOLDER
//! [PART-OF-AN-ID]]` builds and calls it.
//!
//! It prints one matrix per rule book, the uncaught mistakes, the rejected variants, and a small set of scenes that
//! catches every catchable mistake. It exits with status 1 if the fair rules miss a mistake or reject a correct
//! variant, or if a mistake changes no trace, so that no rule book could find it.
#![forbid(unsafe_code)]
use fosssim_lab::runs::{WatchedScene, is_accepted, judge_trace, record_trace};
use fosssim_oracle::{
    judge::{FindingKind, Outcome, Overall},
    student::{CATALOG, Row, RowKind, Student},
};
use rayon::prelude::*;
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Display,
    path::PathBuf,
    process::ExitCode,
};

/// The result of a wrong sample or a variant on a scene, by one rule book.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Answer {
    /// The trace is right.
    Same,
    /// The trace differs from the reference's and is accepted.
    Accepted,
    /// The trace is rejected only because the course's library dropped coefficients as too small. The scale of the
    /// program's polynomials causes this.
    Lost,
    /// The trace is rejected.
    Rejected,
}

/// The names of all rule books.
const RULE_BOOKS: [&str; 2] = ["parity", "fair"];

/// The index of the rule book that must catch every mistake and accept every correct variant.
const FAIR_BOOK: usize = 1;

/// The answers of all rule books.
type MatrixCell = [Answer; RULE_BOOKS.len()];

fn parity_answer(outcome: &Outcome) -> Answer {
    if outcome.parity.overall == Overall::Passed { Answer::Accepted } else { Answer::Rejected }
}

fn fair_answer(outcome: &Outcome) -> Answer {
    match &outcome.fair {
        _ if is_accepted(outcome) => Answer::Accepted,
        Some(fair)
            if fair.rejection.is_none()
                && fair.findings.counts.get(FindingKind::TrimmedDecision) == fair.findings.counts.total() =>
        {
            Answer::Lost
        }
        _ => Answer::Rejected,
    }
}

fn main() -> anyhow::Result<ExitCode> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("assets"), PathBuf::from);
    let part = std::env::args().nth(2).unwrap_or_default();
    let cases = WatchedScene::from_folder(&folder)?;
    let rows: Vec<&Row> = CATALOG.iter().filter(|row| row.id.contains(&part)).collect();
    let matrix: Vec<Vec<MatrixCell>> =
        rows.par_iter().map(|row| cases.iter().map(|case| compute_cell(case, row)).collect()).collect();
    for (book, name) in RULE_BOOKS.iter().enumerate() {
        print_book(name, book, &rows, &cases, &matrix);
    }
    let invisible: Vec<&str> = rows
        .iter()
        .zip(&matrix)
        .filter(|(row, cells)| row.kind == RowKind::Wrong && cells.iter().all(|cell| cell[FAIR_BOOK] == Answer::Same))
        .map(|(row, _)| row.id)
        .collect();
    print_list("mistakes that change no trace (must be none)", &invisible);
    let uncaught_count = list_mistakes(&rows, &matrix, FAIR_BOOK, false).len();
    let accuses = !find_rejected(FAIR_BOOK, &rows, &cases, &matrix).is_empty();
    Ok(ExitCode::from(u8::from(!invisible.is_empty() || uncaught_count > 0 || accuses)))
}

/// Returns the mistakes that at least one scene catches under a rule book, or those that none catches.
fn list_mistakes(rows: &[&Row], matrix: &[Vec<MatrixCell>], book: usize, caught: bool) -> Vec<&'static str> {
    rows.iter()
        .zip(matrix)
        .filter(|(row, cells)| row.kind == RowKind::Wrong && caught == cells.iter().any(|cell| is_rejected(cell, book)))
        .map(|(row, _)| row.id)
        .collect()
}

/// Returns the correct variants that a rule book rejects, each with the scene.
fn find_rejected<'a>(
    book: usize,
    rows: &[&'a Row],
    cases: &'a [WatchedScene],
    matrix: &[Vec<MatrixCell>],
) -> Vec<(&'a Row, &'a str)> {
    rows.iter()
        .zip(matrix)
        .filter(|(row, _)| row.kind == RowKind::Variant)
        .flat_map(|(row, cells)| cases.iter().zip(cells).map(move |(case, cell)| (*row, case, cell)))
        .filter(|(.., cell)| is_rejected(cell, book))
        .map(|(row, case, _)| (row, case.name.as_str()))
        .collect()
}

fn compute_cell(case: &WatchedScene, row: &Row) -> MatrixCell {
    let trace = record_trace(&case.scene, Student::new(Some(row.mistake)));
    if trace == case.right {
        return [Answer::Same; RULE_BOOKS.len()];
    }
    let outcome = judge_trace(&case.scene, &trace);
    [parity_answer(&outcome), fair_answer(&outcome)]
}

/// Returns whether a rule book rejects the trace.
fn is_rejected(cell: &MatrixCell, book: usize) -> bool {
    cell[book] == Answer::Rejected
}

fn print_book(name: &str, book: usize, rows: &[&Row], cases: &[WatchedScene], matrix: &[Vec<MatrixCell>]) {
    println!(
        "rules: {name}\n  . the correct trace   - another trace, accepted   X rejected   \
         l lost coefficients change a decision\n"
    );
    for (index, case) in cases.iter().enumerate() {
        println!("  {index:3} {}", case.name);
    }
    println!();
    for (row, cells) in rows.iter().zip(matrix) {
        let marks: String = cells
            .iter()
            .map(|cell| match cell[book] {
                Answer::Same => '.',
                Answer::Accepted => '-',
                Answer::Lost => 'l',
                Answer::Rejected => 'X',
            })
            .collect();
        println!("  {:36} {marks}", row.id);
    }
    println!();
    println!("  {} mistakes caught\n", list_mistakes(rows, matrix, book, true).len());
    print_list("mistakes that no scene catches", &list_mistakes(rows, matrix, book, false));
    let mut scenes: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (row, scene) in find_rejected(book, rows, cases, matrix) {
        scenes.entry(row.id).or_default().push(scene);
    }
    let accused: Vec<String> = scenes.iter().map(|(id, scenes)| format!("{id}: {}", scenes.join(", "))).collect();
    print_list("correct variants that a scene rejects", &accused);
    let subset: Vec<&str> = sufficient_scenes(book, rows, cases.len(), matrix)
        .into_iter()
        .map(|index| cases[index].name.as_str())
        .collect();
    print_list("scenes that together catch all of these mistakes", &subset);
}

fn print_list(title: &str, names: &[impl Display]) {
    println!("  {title}: {}", names.len());
    for name in names {
        println!("    {name}");
    }
    println!();
}

/// Returns a small set of scenes that catches every catchable mistake. Scenes with the most new mistakes are added
/// first; superfluous scenes are removed at the end.
fn sufficient_scenes(book: usize, rows: &[&Row], scenes: usize, matrix: &[Vec<MatrixCell>]) -> BTreeSet<usize> {
    let caught = |scene: usize| -> BTreeSet<usize> {
        (0..rows.len())
            .filter(|&row| rows[row].kind == RowKind::Wrong && is_rejected(&matrix[row][scene], book))
            .collect()
    };
    let caught: Vec<BTreeSet<usize>> = (0..scenes).map(caught).collect();
    let union = |chosen: &BTreeSet<usize>| -> BTreeSet<usize> {
        chosen.iter().flat_map(|&scene| caught[scene].iter().copied()).collect()
    };
    let all = union(&(0..scenes).collect());
    let mut chosen = BTreeSet::new();
    while union(&chosen) != all {
        let caught_mistakes = union(&chosen);
        let best = (0..scenes).rev().max_by_key(|&scene| caught[scene].difference(&caught_mistakes).count());
        chosen.extend(best);
    }
    for scene in chosen.clone() {
        let mut without = chosen.clone();
        without.remove(&scene);
        if union(&without) == all {
            chosen = without;
        }
    }
    chosen
}
