//! The judge against the original's own verdicts.
use crate::corpus;
use fosssim_oracle::{
    judge::{
        FindingKind, Outcome, Overall,
        replay::{self, Options, Progress, Remark},
    },
    scene,
    sim::RootSearch,
};

/// Records the reports of a judge, step by step.
#[derive(Debug, Default, PartialEq)]
struct Heard(Vec<(u32, Vec<Remark>)>);

impl Progress for Heard {
    fn observe_step_begin(&mut self, step: u32) {
        self.0.push((step, Vec::new()));
    }

    fn observe_step_end(&mut self, step: u32, remarks: &[Remark]) {
        let last = self.0.last_mut().expect("a step begins before it is judged");
        assert_eq!(last.0, step);
        last.1.extend_from_slice(remarks);
    }
}

fn judge(
    scene: &fosssim_oracle::scene::Scene,
    trace: &[u8],
    threads: usize,
    root_search: RootSearch,
) -> (Outcome, String) {
    let mut heard = Heard::default();
    let options = Options { threads, root_search, stop_at_first: false, ..Options::default() };
    let outcome = replay::judge(scene, trace, &options, &mut heard);
    // NaN is not equal to itself, so the remarks are compared as text.
    (outcome, format!("{heard:?}"))
}

fn told(outcome: &Outcome) -> String {
    format!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?} {} {}",
        outcome.parity.overall,
        outcome.parity.residuals,
        outcome.parity.findings.counts,
        outcome.parity.findings.examples,
        outcome.parity.findings.first_divergence,
        outcome.stop,
        outcome.damage,
        outcome.parity.findings.wrong_steps,
        outcome.trailing_bytes,
    )
}

#[test]
fn verdicts_and_counts_are_those_of_the_original_on_any_number_of_threads() {
    let Some(folder) = corpus::folder() else { return };
    let rows = std::fs::read_to_string(folder.join("verdicts.jsonl")).expect("verdicts");
    let mut cases = 0;
    for row in rows.lines() {
        let row: serde_json::Value = serde_json::from_str(row).expect("a row");
        let Some(file) = row["trace_file"].as_str() else { continue };
        let name = format!("{} {}", row["submission"], row["scene"]);
        let xml = std::fs::read(folder.join("scenes").join(format!("{}.xml", row["scene"].as_str().expect("scene"))));
        let scene = scene::original::read(&xml.expect("a scene")).expect("a scene").scene;
        let trace = corpus::unpack(&folder.join(file));
        let (outcome, heard) = judge(&scene, &trace, 1, RootSearch::OnDemand);
        let expected = match row["overall"].as_str().expect("overall") {
            "passed" => Overall::Passed,
            "failed" => Overall::Failed,
            _ => Overall::None,
        };
        assert_eq!(outcome.parity.overall, expected, "{name}");
        if row["oracle_end"] == "exit 0" {
            for kind in FindingKind::ALL {
                let Some(message) = kind.original_message() else { continue };
                let count = row["messages"][message].as_u64().unwrap_or(0);
                assert_eq!(outcome.parity.findings.counts.get(kind), count, "{name}: {message}");
            }
            assert_eq!(outcome.parity.collisions_passed, Some(row["collisions_passed"] == "Yes"), "{name}");
        }
        for (threads, root_search) in [(4, RootSearch::OnDemand), (2, RootSearch::Audit)] {
            let (other, other_heard) = judge(&scene, &trace, threads, root_search);
            assert_eq!(told(&outcome), told(&other), "{name}: {threads} threads");
            assert_eq!(heard, other_heard, "{name}: {threads} threads");
        }
        cases += 1;
    }
    corpus::ran("parity", cases);
}
