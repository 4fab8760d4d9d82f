//! Grades traces that exist already. No program is run, so its duration and its exit status are unknown.
use super::{
    conclusion::{CountedReader, JudgedRun, ProgramRun, conclude},
    grade::Grade,
    plan::Plan,
    result::{Measurements, SceneResult},
    score,
    task::SceneTask,
};
use fosssim_evidence::{ExaminedTrace, KeptPart, examine};
use fosssim_judge::replay::{Options, Progress};
use fosssim_mistakes::together::reconcile_explanations;
use std::{
    io::Read,
    sync::atomic::{AtomicU64, Ordering},
};

/// Judges a trace of a scene as if a program had written it and ended normally. Returns the result of the scene, and
/// the outcome of judging.
pub fn judge_trace<'a, R: Read + Send>(
    plan: &Plan,
    task: &'a SceneTask,
    trace: R,
    progress: &mut dyn Progress,
) -> (SceneResult, ExaminedTrace<'a>) {
    let options = Options {
        stopping_book: plan.rules.official(),
        threads: 1,
        uses_fair_rules: plan.rules.includes_fair(),
        ..Options::default()
    };
    let bytes = AtomicU64::new(0);
    let counting_reader = CountedReader { inner: trace, bytes: &bytes };
    let examined = examine(&task.scene, counting_reader, KeptPart::All, &options, progress);
    let run = JudgedRun {
        task,
        program: &ProgramRun::without_program(),
        outcome: &examined.outcome,
        trace_bytes: bytes.load(Ordering::Relaxed),
        rules: plan.rules,
        hints: plan.staff_hints,
        limits: &plan.limits,
    };
    let explained = conclude(&run, |depth| depth.explain(&task.scene, &examined.trace));
    (SceneResult { ended: None, measured: Measurements::default(), ..explained }, examined)
}

/// Computes the grade from the results of all scenes, in the order of the plan.
pub fn grade(plan: &Plan, submission: String, results: Vec<SceneResult>, warnings: Vec<String>) -> Grade {
    let results = results.into_iter().map(|result| (result, false)).collect();
    // The times of the runs are unknown, because the traces existed already.
    let mut grade = Grade { warnings, ..score::build_grade(plan, submission, false, results) };
    reconcile_explanations(&mut grade);
    grade
}
