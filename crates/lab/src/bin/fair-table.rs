//! The verdicts of both rule books on a corpus of submissions, one line each: what `docs/fair.md` summarises.
//!
//! usage: `fair-table CORPUS [--all]`. The folder holds `verdicts.jsonl`, `scenes/` and `submissions/`. Without `--all`
//! only rows where the two differ, and rows of correct kinds that fair refuses, are printed; the summary counts all.
#![forbid(unsafe_code)]
use std::{collections::BTreeMap, path::Path};

use anyhow::Context;
use fosssim_oracle::{
    judge::{
        Overall,
        fair::{FairVerdict, Judgement},
        replay::{self, Options},
    },
    scene::original,
};
use rayon::prelude::*;
use serde::Deserialize;

#[derive(Deserialize)]
struct Row {
    submission: String,
    kind: String,
    scene: String,
    overall: String,
    trace_file: Option<String>,
    trace_equals_reference: Option<bool>,
}

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let corpus = arguments.next().context("usage: fair-table CORPUS [--all]")?;
    let all = arguments.next().is_some();
    let corpus = Path::new(&corpus);
    let text = std::fs::read_to_string(corpus.join("verdicts.jsonl")).context("no verdicts.jsonl there")?;
    let rows: Vec<Row> = text.lines().map(serde_json::from_str).collect::<Result<_, _>>()?;
    let judged: Vec<Option<(Overall, Judgement)>> =
        rows.par_iter().map(|row| judge(corpus, row)).collect::<anyhow::Result<_>>()?;
    let mut summary: BTreeMap<(&str, &str, &str), u32> = BTreeMap::new();
    for (row, judged) in rows.iter().zip(&judged) {
        let Some((overall, fair)) = judged else { continue };
        let parity = match overall {
            Overall::Passed => "passed",
            Overall::Failed => "failed",
            Overall::None => "none",
        };
        anyhow::ensure!(parity == row.overall, "{} {}: parity says {parity}", row.submission, row.scene);
        let verdict = match fair.verdict {
            FairVerdict::Accepted => "accepted",
            FairVerdict::Rejected => "rejected",
            FairVerdict::None => "none",
        };
        *summary.entry((&row.kind, parity, verdict)).or_default() += 1;
        let differ = (parity == "passed") != (verdict == "accepted");
        if all || differ || (row.kind == "a" && verdict != "accepted") {
            let same = if row.trace_equals_reference == Some(true) { " (the reference's bytes)" } else { "" };
            println!(
                "{:<28} {:<8} {:<32} parity {parity:<7} fair {verdict}{same}: {}",
                row.submission,
                row.kind,
                row.scene,
                reason(fair)
            );
        }
    }
    println!();
    for ((kind, parity, fair), count) in summary {
        println!("{kind:<8} parity {parity:<7} fair {fair:<9} {count}");
    }
    Ok(())
}

fn judge(corpus: &Path, row: &Row) -> anyhow::Result<Option<(Overall, Judgement)>> {
    let Some(file) = &row.trace_file else { return Ok(None) };
    let scene = std::fs::read(corpus.join("scenes").join(format!("{}.xml", row.scene)))?;
    let scene = original::read(&scene).with_context(|| row.scene.clone())?.scene;
    let trace = zstd::Decoder::new(std::fs::File::open(corpus.join(file))?)?;
    let options = Options { threads: 1, fair: true, ..Options::default() };
    let outcome = replay::judge(&scene, trace, &options, &mut ());
    Ok(outcome.fair.map(|fair| (outcome.parity.overall, *fair)))
}

fn reason(fair: &Judgement) -> String {
    let mut parts = Vec::new();
    if let Some(refusal) = fair.refusal {
        parts.push(format!("{refusal:?}"));
    }
    if let Some(first) = fair.findings.first_divergence {
        let kinds: Vec<String> = fair
            .findings
            .examples
            .iter()
            .map(|f| format!("{} {}", fair.findings.counts.get(f.kind()), f.kind()))
            .collect();
        parts.push(format!("{first} [{}; {} steps]", kinds.join(", "), fair.findings.wrong_steps));
    }
    if let Some([low, high]) = fair.factor {
        parts.push(format!("factor {low:.3e}..{high:.3e}"));
    }
    if fair.borderline > 0 {
        parts.push(format!("{} borderline", fair.borderline));
    }
    if fair.lost > 0 {
        parts.push(format!("{} lost", fair.lost));
    }
    parts.push(format!("{:?} {:.2?}", fair.form, fair.shares));
    parts.join("; ")
}
