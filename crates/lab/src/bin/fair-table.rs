//! Prints the verdicts of both rule books on a corpus of submissions, one line each; `docs/rules/measurements.md`
//! summarizes them.
//!
//! usage: `fair-table CORPUS [--all]`. The folder contains `verdicts.jsonl`, `scenes/` and `submissions/`. Without
//! `--all` only rows with different verdicts, and rows of correct kinds that fair rejects, are printed. The summary
//! counts all rows.
#![forbid(unsafe_code)]
use anyhow::Context;
use fosssim_lab::{
    corpus::{self, CorpusRow},
    runs,
};
use fosssim_oracle::judge::{Overall, fair::Judgment};
use rayon::prelude::*;
use std::{collections::BTreeMap, path::Path};

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let corpus = arguments.next().context("usage: fair-table CORPUS [--all]")?;
    let (corpus, all) = (Path::new(&corpus), arguments.next().is_some());
    let rows = corpus::read_rows(corpus)?;
    let judged: Vec<Option<(Overall, Judgment)>> =
        rows.par_iter().map(|row| judge_row(corpus, row)).collect::<anyhow::Result<_>>()?;
    let mut summary: BTreeMap<(&str, String, String), u32> = BTreeMap::new();
    for (row, judged) in rows.iter().zip(&judged) {
        let Some((overall, fair)) = judged else { continue };
        let [parity, verdict] = [format!("{overall:?}"), format!("{:?}", fair.verdict)].map(|name| name.to_lowercase());
        anyhow::ensure!(parity == row.overall, "{} {}: parity says {parity}", row.submission, row.scene);
        let differ = (parity == "passed") != (verdict == "accepted");
        if all || differ || (row.kind == "a" && verdict != "accepted") {
            let bytes_note = if row.trace_equals_reference == Some(true) { " (the reference's bytes)" } else { "" };
            println!(
                "{:<28} {:<8} {:<32} parity {parity:<7} fair {verdict}{bytes_note}: {}",
                row.submission,
                row.kind,
                row.scene,
                describe_reason(fair)
            );
        }
        *summary.entry((row.kind.as_str(), parity, verdict)).or_default() += 1;
    }
    println!();
    for ((kind, parity, fair), count) in summary {
        println!("{kind:<8} parity {parity:<7} fair {fair:<9} {count}");
    }
    Ok(())
}

fn judge_row(corpus: &Path, row: &CorpusRow) -> anyhow::Result<Option<(Overall, Judgment)>> {
    let Some((scene, trace)) = row.read(corpus)? else { return Ok(None) };
    let outcome = runs::judge_trace(&scene, &trace);
    Ok(outcome.fair.map(|fair| (outcome.parity.overall, *fair)))
}

fn describe_reason(judgment: &Judgment) -> String {
    let mut parts = Vec::new();
    if let Some(rejection) = judgment.rejection {
        parts.push(format!("{rejection:?}"));
    }
    if let Some(first) = judgment.findings.first_divergence {
        let kinds: Vec<String> = judgment
            .findings
            .examples
            .iter()
            .map(|f| format!("{} {}", judgment.findings.counts.get(f.kind()), f.kind()))
            .collect();
        parts.push(format!("{first} [{}; {} steps]", kinds.join(", "), judgment.findings.wrong_steps));
    }
    if let Some([low, high]) = judgment.factor {
        parts.push(format!("factor {low:.3e}..{high:.3e}"));
    }
    if judgment.borderline > 0 {
        parts.push(format!("{} borderline", judgment.borderline));
    }
    if judgment.lost_decisions > 0 {
        parts.push(format!("{} lost", judgment.lost_decisions));
    }
    parts.push(format!("{:?} {:.2?}", judgment.form, judgment.shares));
    parts.join("; ")
}
