//! Which scene catches which mistake: makes the traces of every wrong sample and every correct variant on every scene
//! of a folder, in memory, and judges them under each rule book. `scripts/mutation-matrix [FOLDER [PART-OF-AN-ID]]`
//! builds and calls it.
//!
//! It prints one matrix per rule book, the mistakes that no scene catches, the variants that are refused, and a small
//! set of scenes that catches all that can be caught. It ends with status 1 when a mistake changes no trace at all
//! (then no rule book could ever see it), when the fair rules miss one, and when they refuse a correct variant that is
//! not on the list of those that they are known to refuse.
#![forbid(unsafe_code)]
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, ensure};
use fosssim_oracle::{
    judge::{FindingKind, Outcome, Overall, fair::FairVerdict, replay::Options},
    scene::{Scene, original},
    student::{self, CATALOGUE, KNOWN_REFUSED, Row, Student},
    suite::scene_files::{self, SceneFile},
};
use rayon::prelude::*;

/// A rule book: what it says of a trace.
type Rules = fn(&Scene, &[u8]) -> Answer;

/// The answer of a rule book to a trace.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Answer {
    /// It is accepted.
    Accepted,
    /// It is refused for nothing but decisions that hang on coefficients which the course's library dropped as too
    /// small: the factor of the polynomials is to blame, and the program really does something else then.
    Lost,
    /// It is refused.
    Refused,
}

/// All rule books.
const RULE_BOOKS: &[(&str, Rules)] = &[("parity", parity), ("fair", fair)];

/// The book that must catch every mistake and accept every correct variant.
const FAIR: usize = 1;

fn parity(scene: &Scene, trace: &[u8]) -> Answer {
    if judge(scene, trace, false).parity.overall == Overall::Passed { Answer::Accepted } else { Answer::Refused }
}

fn fair(scene: &Scene, trace: &[u8]) -> Answer {
    match judge(scene, trace, true).fair {
        Some(fair) if fair.verdict == FairVerdict::Accepted => Answer::Accepted,
        Some(fair)
            if fair.refusal.is_none()
                && fair.findings.counts.get(FindingKind::TrimmedDecision) == fair.findings.counts.total() =>
        {
            Answer::Lost
        }
        _ => Answer::Refused,
    }
}

fn judge(scene: &Scene, trace: &[u8], fair: bool) -> Outcome {
    let options = Options { threads: 1, fair, ..Options::default() };
    fosssim_oracle::judge::replay::judge(scene, trace, &options, &mut ())
}

/// A scene and its correct trace.
struct Case {
    name: String,
    scene: Scene,
    correct: Vec<u8>,
}

/// The result of one sample on one scene.
#[derive(Clone)]
enum MatrixCell {
    /// The trace is the correct one.
    Same,
    /// Another trace; what the rule books say of it.
    Other(Vec<Answer>),
}

fn main() -> anyhow::Result<ExitCode> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("assets"), PathBuf::from);
    let part = std::env::args().nth(2).unwrap_or_default();
    let cases = cases(&folder)?;
    let rows: Vec<&Row> =
        CATALOGUE.iter().filter(|row| row.kind != student::RowKind::Hostile && row.id.contains(&part)).collect();
    let matrix: Vec<Vec<MatrixCell>> =
        rows.par_iter().map(|row| cases.iter().map(|case| cell(row, case)).collect()).collect();
    for (book, (name, _)) in RULE_BOOKS.iter().enumerate() {
        print_book(name, book, &rows, &cases, &matrix);
    }
    let invisible: Vec<&str> = rows
        .iter()
        .zip(&matrix)
        .filter(|(row, cells)| {
            row.kind == student::RowKind::Wrong && cells.iter().all(|cell| matches!(cell, MatrixCell::Same))
        })
        .map(|(row, _)| row.id)
        .collect();
    print_list("mistakes that change no trace (must be none)", &invisible);
    let uncaught = ids(&rows, &matrix, FAIR, student::RowKind::Wrong, false).len();
    let accused = accused(FAIR, &rows, &cases, &matrix).iter().any(|(row, scene)| !is_known(row.id, scene));
    Ok(ExitCode::from(u8::from(!invisible.is_empty() || uncaught > 0 || accused)))
}

/// The rows of a kind that some scene catches under a rule book, or that none does.
fn ids(
    rows: &[&Row],
    matrix: &[Vec<MatrixCell>],
    book: usize,
    kind: student::RowKind,
    caught: bool,
) -> Vec<&'static str> {
    rows.iter()
        .zip(matrix)
        .filter(|(row, cells)| row.kind == kind && caught == cells.iter().any(|cell| refused(cell, book)))
        .map(|(row, _)| row.id)
        .collect()
}

/// The correct variants that a rule book refuses, each with the scene.
fn accused<'a>(
    book: usize,
    rows: &[&'a Row],
    cases: &'a [Case],
    matrix: &[Vec<MatrixCell>],
) -> Vec<(&'a Row, &'a str)> {
    rows.iter()
        .zip(matrix)
        .filter(|(row, _)| row.kind == student::RowKind::Variant)
        .flat_map(|(row, cells)| cases.iter().zip(cells).map(move |(case, cell)| (*row, case, cell)))
        .filter(|(.., cell)| refused(cell, book))
        .map(|(row, case, _)| (row, case.name.as_str()))
        .collect()
}

/// Whether the fair rules are known to refuse this correct variant on this scene.
fn is_known(id: &str, scene: &str) -> bool {
    KNOWN_REFUSED.contains(&(id, scene))
}

fn cases(folder: &Path) -> anyhow::Result<Vec<Case>> {
    let files = scene_files::list(folder, ".xml").with_context(|| format!("{}: can't be read", folder.display()))?;
    ensure!(!files.is_empty(), "{}: no group of this folder holds a scene", folder.display());
    files
        .into_par_iter()
        .map(|SceneFile { name, path, .. }| {
            let scene = original::read(&std::fs::read(&path)?).with_context(|| path.display().to_string())?.scene;
            let correct = trace(&scene, None);
            Ok(Case { name, scene, correct })
        })
        .collect()
}

/// The trace that a program leaves; where the mistake makes it go on for ever, what it has written by then.
fn trace(scene: &Scene, row: Option<&Row>) -> Vec<u8> {
    student::trace(scene, Student::new(row.map(|row| row.mistake))).unwrap_or_else(|(bytes, _)| bytes)
}

fn cell(row: &Row, case: &Case) -> MatrixCell {
    let trace = trace(&case.scene, Some(row));
    if trace == case.correct {
        return MatrixCell::Same;
    }
    MatrixCell::Other(RULE_BOOKS.iter().map(|(_, rules)| rules(&case.scene, &trace)).collect())
}

/// Whether this rule book refuses the trace.
fn refused(cell: &MatrixCell, book: usize) -> bool {
    matches!(cell, MatrixCell::Other(answers) if answers[book] == Answer::Refused)
}

fn print_book(name: &str, book: usize, rows: &[&Row], cases: &[Case], matrix: &[Vec<MatrixCell>]) {
    println!(
        "rules: {name}\n  . the correct trace   - another trace, accepted   X refused   l lost coefficients change a decision\n"
    );
    for (index, case) in cases.iter().enumerate() {
        println!("  {index:3} {}", case.name);
    }
    println!();
    for (row, cells) in rows.iter().zip(matrix) {
        let marks: String = cells
            .iter()
            .map(|cell| match cell {
                MatrixCell::Same => '.',
                MatrixCell::Other(answers) => match answers[book] {
                    Answer::Accepted => '-',
                    Answer::Lost => 'l',
                    Answer::Refused => 'X',
                },
            })
            .collect();
        println!("  {:36} {marks}", row.id);
    }
    println!();
    println!("  {} mistakes caught\n", ids(rows, matrix, book, student::RowKind::Wrong, true).len());
    print_list("mistakes that no scene catches", &ids(rows, matrix, book, student::RowKind::Wrong, false));
    let mut scenes: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (row, scene) in accused(book, rows, cases, matrix) {
        let known = if book == FAIR && is_known(row.id, scene) { " (known)" } else { "" };
        scenes.entry(row.id).or_default().push(format!("{scene}{known}"));
    }
    let accused: Vec<String> = scenes.iter().map(|(id, scenes)| format!("{id}: {}", scenes.join(", "))).collect();
    let accused: Vec<&str> = accused.iter().map(String::as_str).collect();
    print_list("correct variants that a scene refuses", &accused);
    let subset: Vec<&str> =
        sufficient(book, rows, cases.len(), matrix).into_iter().map(|index| cases[index].name.as_str()).collect();
    print_list("scenes that together catch all of these mistakes", &subset);
}

fn print_list(title: &str, names: &[&str]) {
    println!("  {title}: {}", names.len());
    for name in names {
        println!("    {name}");
    }
    println!();
}

/// A small set of scenes that catches every mistake that can be caught: the scene with the most new ones first, then
/// without those that others made superfluous.
fn sufficient(book: usize, rows: &[&Row], scenes: usize, matrix: &[Vec<MatrixCell>]) -> BTreeSet<usize> {
    let caught = |scene: usize| -> BTreeSet<usize> {
        (0..rows.len())
            .filter(|&row| rows[row].kind == student::RowKind::Wrong && refused(&matrix[row][scene], book))
            .collect()
    };
    let caught: Vec<BTreeSet<usize>> = (0..scenes).map(caught).collect();
    let union = |chosen: &BTreeSet<usize>| -> BTreeSet<usize> {
        chosen.iter().flat_map(|&scene| caught[scene].iter().copied()).collect()
    };
    let all = union(&(0..scenes).collect());
    let mut chosen = BTreeSet::new();
    while union(&chosen) != all {
        let known = union(&chosen);
        let best = (0..scenes).rev().max_by_key(|&scene| caught[scene].difference(&known).count());
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
