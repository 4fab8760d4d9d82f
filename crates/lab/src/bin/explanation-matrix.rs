//! How well known mistakes are recognised: makes the traces of all mistakes and correct variants for the scenes of a
//! folder, in memory, has each explained, and counts how often the first explanation is the mistake that was made.
//!
//! `scripts/explanation-matrix [FOLDER [PART-OF-AN-ID]]`. It prints every confusion, and ends with status 1 when a
//! correct variant is accused.
#![forbid(unsafe_code)]
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    time::{Duration, Instant},
};

use anyhow::{Context, ensure};
use fosssim_oracle::{
    diagnose::{Explanation, common, known},
    judge::replay,
    scene::{Scene, original},
    student::{self, CATALOGUE, RowKind, Student},
    suite::scene_files::{self, SceneFile},
};
use rayon::prelude::*;

/// How one trace was explained.
enum Outcome {
    /// The trace is the correct one, bit for bit.
    Same,
    /// The mistake is named first.
    First,
    /// It is among those that this trace can't tell from the first one.
    Among(String),
    /// Something else is named.
    Other(String),
    /// Nothing is named, though the parity rules find wrong steps.
    Nothing(u64),
    /// Nothing is named, and nothing is wrong but for round-off.
    Unseen,
}

fn main() -> anyhow::Result<ExitCode> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("assets"), PathBuf::from);
    let part = std::env::args().nth(2).unwrap_or_default();
    let scenes = scenes(&folder)?;
    let rows: Vec<_> = CATALOGUE.iter().filter(|row| row.kind != RowKind::Hostile && row.id.contains(&part)).collect();
    let results: Vec<Vec<(Outcome, Duration, Vec<Explanation>)>> =
        rows.par_iter().map(|row| scenes.iter().map(|case| explain(case, row)).collect()).collect();
    let mut accused = false;
    let (mut wrong, mut best_first, mut best_among, mut unseen) = (0, 0, 0, 0_usize);
    let (mut traces, mut first, mut among, mut other, mut nothing) = (0_usize, 0_usize, 0_usize, 0_usize, 0_usize);
    for (row, outcomes) in rows.iter().zip(&results) {
        let is_wrong = row.kind == RowKind::Wrong;
        let mut confusions = Vec::new();
        let (mut is_first, mut is_among) = (false, false);
        for ((name, ..), (outcome, ..)) in scenes.iter().zip(outcomes) {
            match outcome {
                Outcome::Same => continue,
                Outcome::First => {
                    (is_first, first) = (true, first + usize::from(is_wrong));
                    accused |= !is_wrong;
                }
                Outcome::Among(key) => {
                    (is_among, among) = (true, among + usize::from(is_wrong));
                    confusions.push(format!("    {name}: like {key}"));
                }
                Outcome::Other(key) => {
                    other += usize::from(is_wrong);
                    accused |= !is_wrong;
                    confusions.push(format!("    {name}: ACCUSED OF {key}"));
                }
                Outcome::Unseen => unseen += usize::from(is_wrong),
                Outcome::Nothing(steps) => {
                    nothing += usize::from(is_wrong);
                    if is_wrong {
                        confusions.push(format!("    {name}: nothing, {steps} wrong steps"));
                    }
                }
            }
            traces += usize::from(is_wrong);
        }
        if is_wrong {
            wrong += 1;
            best_first += usize::from(is_first);
            best_among += usize::from(is_first || is_among);
        }
        if !confusions.is_empty() {
            println!("{}{}", row.id, if is_first || !is_wrong { "" } else { "  NEVER FIRST" });
            confusions.iter().for_each(|line| println!("{line}"));
        }
    }
    let (slowest, row, scene) = rows
        .iter()
        .zip(&results)
        .flat_map(|(row, outcomes)| outcomes.iter().zip(&scenes).map(|((_, time, _), case)| (*time, row.id, &case.0)))
        .max()
        .context("no traces")?;
    println!(
        "\nmistakes: {wrong}; first on their best scene: {best_first}; first or the same as the first: {best_among}"
    );
    println!(
        "traces that differ: {traces}; first: {first}; same as the first: {among}; other: {other}; nothing: {nothing}; \
         round-off only: {unseen}"
    );
    println!("slowest: {row} on {scene}, {slowest:.2?}");
    together(&rows, &results);
    println!("{}", if accused { "a correct variant is accused" } else { "no correct variant is accused" });
    Ok(ExitCode::from(u8::from(accused)))
}

/// The explanation that all traces of a mistake give together.
fn together(rows: &[&student::Row], results: &[Vec<(Outcome, Duration, Vec<Explanation>)>]) {
    let mut confused = Vec::new();
    let wrong = rows.iter().zip(results).filter(|(row, _)| row.kind == RowKind::Wrong);
    for (row, outcomes) in wrong.clone() {
        match common(outcomes.iter().map(|(.., explanations)| explanations.as_slice())) {
            Some(first) if first.key == row.id => {}
            Some(first) if first.same_as.iter().any(|id| id == row.id) => {
                confused.push(format!("    {}: can't be told from {}", row.id, first.key));
            }
            Some(first) => confused.push(format!("    {}: TAKEN FOR {}", row.id, first.key)),
            None => confused.push(format!("    {}: nothing", row.id)),
        }
    }
    let all = wrong.count();
    println!("\nfrom all scenes together: {} of {all} named first; the others:", all - confused.len());
    confused.iter().for_each(|line| println!("{line}"));
}

fn explain(
    (_, scene, correct): &(String, Scene, Vec<u8>),
    row: &student::Row,
) -> (Outcome, Duration, Vec<Explanation>) {
    let trace = student::trace(scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
    if trace == *correct {
        return (Outcome::Same, Duration::ZERO, Vec::new());
    }
    let begin = Instant::now();
    let explanations = known(scene, &trace[..]);
    let time = begin.elapsed();
    let outcome = match explanations.first().cloned() {
        None => {
            let options = replay::Options { threads: 1, ..replay::Options::default() };
            match replay::judge(scene, &trace[..], &options, &mut ()).parity.findings.wrong_steps {
                0 => Outcome::Unseen,
                steps => Outcome::Nothing(steps),
            }
        }
        Some(explanation) if explanation.key == row.id => Outcome::First,
        Some(explanation) if explanation.same_as.iter().any(|id| id == row.id) => Outcome::Among(explanation.key),
        Some(explanation) => {
            let (reproduced, samples) = (explanation.reproduced, explanation.samples);
            Outcome::Other(format!("{} ({reproduced} of {samples} steps)", explanation.key))
        }
    };
    (outcome, time, explanations)
}

/// The scenes of a folder of groups, with their correct traces.
fn scenes(folder: &Path) -> anyhow::Result<Vec<(String, Scene, Vec<u8>)>> {
    let files = scene_files::list(folder, ".xml").with_context(|| format!("{}: can't be read", folder.display()))?;
    ensure!(!files.is_empty(), "{}: no group of this folder holds a scene", folder.display());
    files
        .into_iter()
        .map(|SceneFile { name, path, .. }| {
            let scene = original::read(&std::fs::read(&path)?).with_context(|| path.display().to_string())?.scene;
            let correct = student::trace(&scene, Student::default()).unwrap_or_else(|(bytes, _)| bytes);
            Ok((name, scene, correct))
        })
        .collect()
}
