//! Checks the sentences about stages against the facts: programs with each mistake of the catalogue, with each mutant,
//! and with pairs of mistakes, on all probe scenes. Prints what an independent reader of the traces denies, and how
//! often each sort of sentence was said. Ends with status 1 when a sentence is false.
//!
//! usage: `truth-table [EVERY]`: of the pairs of mistakes every EVERY-th (50 by default).
#![forbid(unsafe_code)]
use std::{collections::BTreeMap, process::ExitCode};

use fosssim_lab::{mutants::mutants, witness::checked};
use fosssim_oracle::{
    assignments::Assignment,
    diagnose::probe_scenes,
    report::words::explanation::what,
    student::{Area, CATALOGUE, Row, RowKind, Student},
};
use rayon::prelude::*;

fn main() -> ExitCode {
    let every: usize = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(50).max(1);
    let scenes = probe_scenes(Assignment::T2M2);
    let programs = programs(every);
    let found: Vec<(String, Option<String>)> = programs
        .par_iter()
        .flat_map_iter(|(id, student)| scenes.iter().map(move |scene| (id, student, scene)))
        .filter_map(|(id, student, (name, scene))| {
            let (sort, lie) = checked(scene, *student)?;
            Some((sort, lie.map(|lie| format!("{id} on {name}: {}", what(&lie)))))
        })
        .collect();
    let mut sorts: BTreeMap<&str, usize> = BTreeMap::new();
    for (sort, _) in &found {
        *sorts.entry(sort).or_default() += 1;
    }
    sorts.iter().for_each(|(sort, count)| println!("{count:>7}  {sort}"));
    let lies: Vec<&String> = found.iter().filter_map(|(_, lie)| lie.as_ref()).collect();
    lies.iter().for_each(|lie| println!("FALSE: {lie}"));
    println!("\n{} programs; {} sentences of {} sorts, {} false", programs.len(), found.len(), sorts.len(), lies.len());
    ExitCode::from(u8::from(!lies.is_empty()))
}

/// Programs with one mistake, with one that the catalogue does not have, and with two.
fn programs(every: usize) -> Vec<(String, Student)> {
    let is_asked = |row: &&Row| row.kind == RowKind::Wrong && row.area < Area::Trace;
    let rows: Vec<&Row> = CATALOGUE.iter().filter(is_asked).collect();
    let one = rows.iter().map(|row| (row.id.to_owned(), Student::new(Some(row.mistake))));
    let others = mutants().map(|mutant| (mutant.id.to_owned(), Student::default().with_change(&mutant.change)));
    let pairs = rows.iter().enumerate().flat_map(|(number, one)| rows[number + 1..].iter().map(move |two| (one, two)));
    let two = pairs.step_by(every).map(|(one, two)| {
        (format!("{} and {}", one.id, two.id), Student::new(Some(one.mistake)).and(Some(two.mistake)))
    });
    one.chain(others).chain(two).collect()
}
