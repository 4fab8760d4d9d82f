//! Compares judging by the shortcuts (bytes first, right at once) with the full way, on the traces of all samples on
//! all scenes that come with the program, and on those of a corpus: outcomes have to be the same to the last field.
use anyhow::{Context, Result};
use fosssim_lab::{
    corpus,
    runs::{options, trace},
};
use fosssim_oracle::{
    judge::{
        Outcome,
        replay::{self, Options},
    },
    scene::{Scene, original},
    student::{CATALOGUE, Student},
    suite::library,
};
use rayon::prelude::*;
use std::{path::Path, process::ExitCode};

/// Judges all samples whose ids hold `part`; or, if that is a corpus's folder, all its traces.
pub fn run(part: &str) -> Result<ExitCode> {
    let corpus = Path::new(part);
    let (count, found): (usize, Result<Vec<Vec<String>>>) = if corpus.join("verdicts.jsonl").exists() {
        let rows = corpus::rows(corpus)?;
        let compared = rows.par_iter().map(|row| {
            let Some((scene, trace)) = row.read(corpus)? else { return Ok(Vec::new()) };
            Ok(differing(&format!("{} {}", row.submission, row.scene), &scene, &trace))
        });
        (rows.len(), compared.collect())
    } else {
        let rows = CATALOGUE.iter().filter(|row| row.id.contains(part));
        let cases: Vec<_> = rows.flat_map(|row| library::names().map(move |name| (row, name))).collect();
        let compared = cases.par_iter().map(|(row, name)| {
            let scene = original::read(library::scene(name).context("a scene")?)?.scene;
            let trace = trace(&scene, Student::new(Some(row.mistake)));
            Ok(differing(&format!("{} {name}", row.id), &scene, &trace))
        });
        (cases.len(), compared.collect())
    };
    let found = found?.concat();
    println!("{count} traces, {} outcomes differ", found.len());
    if let Some(first) = found.first() {
        println!("{first}");
    }
    Ok(ExitCode::from(u8::from(!found.is_empty())))
}

/// How the outcomes of a trace differ.
fn differing(name: &str, scene: &Scene, trace: &[u8]) -> Vec<String> {
    let compare = |fair: bool| {
        let [one, other] = both_ways(scene, trace, fair).map(|outcome| format!("{outcome:?}"));
        (one != other).then(|| format!("{name}, fair {fair}:\n  {one}\n  {other}"))
    };
    [false, true].into_iter().filter_map(compare).collect()
}

/// The outcomes by the shortcuts and the full way.
pub(super) fn both_ways(scene: &Scene, trace: &[u8], fair: bool) -> [Outcome; 2] {
    [false, true].map(|one_by_one| replay::judge(scene, trace, &Options { one_by_one, ..options(fair) }, &mut ()))
}
