//! Grades by traces that are there already. Nothing is run: how long a program took, and that it ended well, nobody
//! knows.
use super::{
    conclude::{Look, Ran, Run, bytes_of_nothing, conclude},
    config::Marking,
    grade::Grade,
    plan::Plan,
    result::{Measurements, SceneResult},
    score,
    task::SceneTask,
    verdict::Verdict,
};
use fosssim_evidence::{Examined, Keep, examine};
use fosssim_judge::replay::{Options, Progress};
use fosssim_mistakes::{diagnose, together::settle};
use std::{
    io::{self, Read},
    time::Duration,
};

/// The result of one scene by a trace, as if a program had ended well after it wrote it, and what judging has seen.
pub fn judged<'a, R: Read + Send>(
    plan: &Plan,
    task: &'a SceneTask,
    trace: R,
    progress: &mut dyn Progress,
) -> (SceneResult, Examined<'a>) {
    let options =
        Options { stop_by: plan.rules.official(), threads: 1, fair: plan.rules.ask_fair(), ..Options::default() };
    let mut counted = CountedTrace { trace, bytes: 0 };
    let examined = examine(&task.scene, &mut counted, Keep::All, &options, progress);
    let run = Run {
        scene: &task.name,
        program: &Ran::well(),
        judged: &examined.outcome,
        trace_bytes: counted.bytes,
        nothing: bytes_of_nothing(&task.scene),
        rules: plan.rules,
        hints: plan.staff_hints,
        limits: &plan.limits,
    };
    let explained = conclude(&run, |look| match look {
        Look::NotFinite => diagnose::not_finite(&examined.trace),
        Look::Mistakes => examined.explain(),
    });
    (SceneResult { ended: None, measured: Measurements::default(), ..explained }, examined)
}

/// Counts the bytes of a trace, which may come out of a packed file.
struct CountedTrace<R> {
    trace: R,
    bytes: u64,
}

impl<R: Read> Read for CountedTrace<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.trace.read(into)?;
        self.bytes += count as u64;
        Ok(count)
    }
}

/// The grade of the results of all scenes, in the plan's order.
#[must_use]
pub fn grade(plan: &Plan, submission: String, results: Vec<SceneResult>, warnings: Vec<String>) -> Grade {
    let mut results = results.into_iter();
    let groups: Vec<_> = plan
        .groups
        .iter()
        .map(|group| {
            let own = results.by_ref().take(group.scenes.len()).map(|result| (result, false)).collect();
            // Nobody knows how long it took to write them.
            score::group(&group.name, Marking { speed: None, ..group.marking }, own)
        })
        .collect();
    let refuted = score::refuted(plan, &groups);
    let mut grade = Grade {
        submission,
        suite: plan.name.clone(),
        rules: plan.rules,
        verdict: groups.iter().map(|group| group.verdict).max().unwrap_or(Verdict::NotRun),
        points: groups.iter().map(|group| group.points).sum(),
        max_points: groups.iter().map(|group| group.max_points).sum(),
        // No program was run that could tell of a hidden scene.
        shows_output: true,
        groups,
        build: None,
        warnings,
        layers: Vec::new(),
        wall: Duration::ZERO,
        refuted,
        located: None,
    };
    settle(&mut grade);
    grade
}
