//! Measures how well known mistakes are recognized. Creates the traces of all mistakes and correct variants for the
//! scenes of a folder, in memory, explains each, and counts how often the first explanation is the actual mistake.
//!
//! `scripts/explanation-matrix [FOLDER [PART-OF-AN-ID]]`. It prints every confusion, and exits with status 1 if an
//! explanation reports a mistake of a correct variant.
#![forbid(unsafe_code)]
use anyhow::Context;
use fosssim_lab::runs::{WatchedScene, judge_trace, record_trace};
use fosssim_oracle::{
    diagnose::{Explanation, explain_together, find_known},
    student::{CATALOG, Row, RowKind, Student},
};
use rayon::prelude::*;
use std::{
    path::PathBuf,
    process::ExitCode,
    time::{Duration, Instant},
};

/// The explanation of one trace.
enum Outcome {
    /// The trace is right, and identical to the reference's.
    Same,
    /// The mistake is the first one that is named.
    First,
    /// The mistake is one that this trace cannot distinguish from the first one.
    Among(String),
    /// A mistake is named, but not the one that was made. The value is the name of the reported one.
    Other(String),
    /// No mistake is named, although the parity rules find wrong steps.
    Nothing(u64),
    /// No mistake is named, because nothing is wrong except round-off.
    Unseen,
}

/// The explanation of a trace, the time that it took, and all explanations of the trace.
type ExplainedTrace = (Outcome, Duration, Vec<Explanation>);

fn main() -> anyhow::Result<ExitCode> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("assets"), PathBuf::from);
    let part = std::env::args().nth(2).unwrap_or_default();
    let scenes = WatchedScene::from_folder(&folder)?;
    let rows: Vec<_> = CATALOG.iter().filter(|row| row.id.contains(&part)).collect();
    let results: Vec<Vec<ExplainedTrace>> =
        rows.par_iter().map(|row| scenes.iter().map(|scene| explain_row(scene, row)).collect()).collect();
    let mut accused = false;
    for (row, outcomes) in rows.iter().zip(&results) {
        let is_wrong = row.kind == RowKind::Wrong;
        let is_first = outcomes.iter().any(|outcome| matches!(outcome.0, Outcome::First));
        let is_other = outcomes.iter().any(|outcome| matches!(outcome.0, Outcome::Other(_)));
        accused |= !is_wrong && (is_first || is_other);
        let confusions: Vec<String> = scenes
            .iter()
            .zip(outcomes)
            .filter_map(|(scene, (outcome, ..))| match outcome {
                Outcome::Among(key) => Some(format!("    {}: like {key}", scene.name)),
                Outcome::Other(key) => Some(format!("    {}: ACCUSED OF {key}", scene.name)),
                Outcome::Nothing(steps) if is_wrong => {
                    Some(format!("    {}: nothing, {steps} wrong steps", scene.name))
                }
                _ => None,
            })
            .collect();
        if !confusions.is_empty() {
            println!("{}{}", row.id, if is_first || !is_wrong { "" } else { "  NEVER FIRST" });
            confusions.iter().for_each(|line| println!("{line}"));
        }
    }
    let (slowest, row, scene) = rows
        .iter()
        .zip(&results)
        .flat_map(|(row, outcomes)| {
            outcomes.iter().zip(&scenes).map(|(outcome, scene)| (outcome.1, row.id, &scene.name))
        })
        .max()
        .context("no traces")?;
    let wrong: Vec<_> = rows.into_iter().zip(&results).filter(|(row, _)| row.kind == RowKind::Wrong).collect();
    count_recognized(&wrong);
    println!("slowest: {row} on {scene}, {slowest:.2?}");
    count_together(&wrong);
    println!("{} correct variant is reported as wrong", if accused { "a" } else { "no" });
    Ok(ExitCode::from(u8::from(accused)))
}

/// Prints how many mistakes are recognized, and on how many traces.
fn count_recognized(wrong: &[(&Row, &Vec<ExplainedTrace>)]) {
    let best = |is_counted: fn(&Outcome) -> bool| {
        wrong.iter().filter(|(_, all)| all.iter().any(|outcome| is_counted(&outcome.0))).count()
    };
    let all = |is_counted: fn(&Outcome) -> bool| {
        wrong.iter().flat_map(|(_, all)| *all).filter(|outcome| is_counted(&outcome.0)).count()
    };
    println!(
        "\nmistakes: {}; first on their best scene: {}; first or the same as the first: {}",
        wrong.len(),
        best(|outcome| matches!(outcome, Outcome::First)),
        best(|outcome| matches!(outcome, Outcome::First | Outcome::Among(_)))
    );
    println!(
        "traces that differ: {}; first: {}; same as the first: {}; other: {}; nothing: {}; round-off only: {}",
        all(|outcome| !matches!(outcome, Outcome::Same)),
        all(|outcome| matches!(outcome, Outcome::First)),
        all(|outcome| matches!(outcome, Outcome::Among(_))),
        all(|outcome| matches!(outcome, Outcome::Other(_))),
        all(|outcome| matches!(outcome, Outcome::Nothing(_))),
        all(|outcome| matches!(outcome, Outcome::Unseen))
    );
}

/// Prints how many mistakes are recognized from all their traces together, and the names of the others.
fn count_together(wrong: &[(&Row, &Vec<ExplainedTrace>)]) {
    let mut confused = Vec::new();
    for (row, outcomes) in wrong {
        let traces = outcomes.iter().map(|(.., explanations)| explanations.as_slice());
        match explain_together(traces, &[]).into_iter().next() {
            Some(first) if first.key == row.id => {}
            Some(first) if first.same_as.iter().any(|id| id == row.id) => {
                confused.push(format!("    {}: can't be distinguished from {}", row.id, first.key));
            }
            Some(first) => confused.push(format!("    {}: TAKEN FOR {}", row.id, first.key)),
            None => confused.push(format!("    {}: nothing", row.id)),
        }
    }
    let total_count = wrong.len();
    println!(
        "\nexplained by all scenes together: {} of {total_count} are named as the likeliest; the others:",
        total_count - confused.len()
    );
    confused.iter().for_each(|line| println!("{line}"));
}

fn explain_row(watched: &WatchedScene, row: &Row) -> ExplainedTrace {
    let trace = record_trace(&watched.scene, Student::new(Some(row.mistake)));
    if trace == watched.right {
        return (Outcome::Same, Duration::ZERO, Vec::new());
    }
    let begin = Instant::now();
    let explanations = find_known(&watched.scene, &trace[..]);
    let time = begin.elapsed();
    let outcome = match explanations.first().cloned() {
        None => match judge_trace(&watched.scene, &trace).parity.findings.wrong_steps {
            0 => Outcome::Unseen,
            steps => Outcome::Nothing(steps),
        },
        Some(explanation) if explanation.key == row.id => Outcome::First,
        Some(explanation) if explanation.same_as.iter().any(|id| id == row.id) => Outcome::Among(explanation.key),
        Some(explanation) => {
            let (reproduced, samples) = (explanation.reproduced, explanation.samples);
            Outcome::Other(format!("{} ({reproduced} of {samples} steps)", explanation.key))
        }
    };
    (outcome, time, explanations)
}
