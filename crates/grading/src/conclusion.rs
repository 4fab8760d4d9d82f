//! Decides the verdict on one scene, from the program's end and the trace.
//!
//! The functions are pure: they use no processes and no files. The worse fault counts. A crash is reported even if the
//! trace is right, and a wrong trace even if the program ended normally.
use super::{
    config::{Hints, RunLimits},
    disclosure::Disclosure,
    result::{BadTrace, Limit, Measurements, ProgramProgress, Reason, RunEnd, SceneResult, WrongTrace},
    task::SceneTask,
    verdict::Verdict,
};
use fosssim_judge::{
    Book, Outcome, Rules, Ruling, Stop,
    fair::{self, FairRejection},
    kept_trace::KeptTrace,
};
use fosssim_mistakes::{
    diagnose::{self, Explanation},
    together::disclosure::limit_result,
};
use fosssim_model::{scene::Scene, trace::Layout};
use std::{
    io::{self, Read},
    sync::atomic::{AtomicU64, Ordering},
};

/// The maximum number of bytes that a report keeps of each output stream.
#[cfg(target_os = "linux")]
const MAX_OUTPUT_BYTES: usize = 4096;

/// The result of a run of a program, its measurements, and its output.
#[derive(Debug, Clone)]
pub struct ProgramRun {
    ended: RunEnd,
    measured: Measurements,
    stdout: String,
    stderr: String,
}

impl ProgramRun {
    /// Returns the run for a trace that no program wrote. It has the values of a program that ended normally.
    pub fn without_program() -> Self {
        let measured = Measurements { memory: Some(0), ..Measurements::default() };
        Self { ended: RunEnd::Exited(0), measured, stdout: String::new(), stderr: String::new() }
    }
}

#[cfg(target_os = "linux")]
impl From<&fosssim_sandbox::RunOutcome> for ProgramRun {
    fn from(program: &fosssim_sandbox::RunOutcome) -> Self {
        let measured = Measurements {
            cpu: program.cpu,
            wall: program.wall,
            memory: Some(program.peak_memory),
            ..Measurements::default()
        };
        let format_stream = |stream: &fosssim_sandbox::CapturedOutput, name: &str| {
            let mut text = truncate(&stream.bytes, MAX_OUTPUT_BYTES);
            if stream.truncated {
                let mebibytes = stream.bytes.len() as f64 / f64::from(1 << 20);
                text.push_str(&format!("\n[{name} was cut after {mebibytes} MiB]"));
            }
            text
        };
        let (stdout, stderr) =
            (format_stream(&program.stdout, "standard output"), format_stream(&program.stderr, "standard error"));
        Self { ended: program.ended.clone(), measured, stdout, stderr }
    }
}

/// The facts about one run of a program.
#[derive(Debug, Clone, Copy)]
pub struct JudgedRun<'a> {
    /// The scene that was run.
    pub task: &'a SceneTask,
    /// The run of the program: its result, its measurements, and its output.
    pub program: &'a ProgramRun,
    /// The outcome of judging the trace.
    pub outcome: &'a Outcome,
    /// The number of bytes of the trace that were read.
    pub trace_bytes: u64,
    /// The rule books. The official one decides the verdict, the findings and the number of right steps.
    pub rules: Rules,
    /// The level of detail for the reader who may see most.
    pub hints: Hints,
    /// The limits that apply to the run.
    pub limits: &'a RunLimits,
}

/// A reader that counts the bytes of a trace from a program or from a compressed file.
pub(super) struct CountedReader<'a, R> {
    pub(super) inner: R,
    pub(super) bytes: &'a AtomicU64,
}

impl<R: Read> Read for CountedReader<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.bytes.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

/// The depth of the search for explanations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchDepth {
    /// Only the first value that is not finite is searched for, which is quick.
    NotFinite,
    /// The search is for the first value that is not finite, and then for likely mistakes.
    Mistakes,
}

impl SearchDepth {
    /// Searches for explanations of a trace.
    pub fn explain(self, scene: &Scene, trace: &KeptTrace) -> Vec<Explanation> {
        match self {
            Self::NotFinite => diagnose::explain_non_finite_value(scene, trace),
            Self::Mistakes => diagnose::explain_kept_trace(scene, trace),
        }
    }
}

/// Returns the result of one scene, with everything that any reader may see. The function `explain` searches for the
/// likely mistake. It is not called if no reader may see the mistake, if the fair rules find no fault, or if the way in
/// which the program ended is the worse fault.
pub fn conclude(run: &JudgedRun<'_>, explain: impl FnOnce(SearchDepth) -> Vec<Explanation>) -> SceneResult {
    let JudgedRun { program, outcome: judged, rules, hints, .. } = *run;
    let program_result = program_verdict(&program.ended, judged);
    let (trace_result, trace_reason) = trace_verdict(run);
    // If a program was stopped, its trace is incomplete. Reporting both would count the same fault twice.
    let trace_is_cut = matches!(trace_result, Verdict::BadTrace | Verdict::NoOutput);
    let blames_program = program_result > Verdict::Accepted && (trace_is_cut || program_result >= trace_result);
    let (verdict, reason) = match blames_program || program_result > trace_result {
        true => (program_result, Reason::Program(find_progress(&program.ended, judged, run.limits))),
        false => (trace_result, trace_reason),
    };
    let difference_cause = fair::find_cause(judged);
    let has_fault = rules == Rules::Fair || difference_cause.is_none();
    let depth = if hints.explains() { SearchDepth::Mistakes } else { SearchDepth::NotFinite };
    let is_explained = hints > Hints::None && has_fault && verdict.is_wrong_trace();
    let mut result = SceneResult {
        scene: run.task.name.clone(),
        verdict,
        reason,
        ended: Some(program.ended.clone()),
        difference_cause,
        disclosure: Some(Disclosure::from_outcome(judged, rules)),
        explanations: if is_explained { explain(depth) } else { Vec::new() },
        right_steps: judged.right_steps(rules.official()),
        steps: judged.steps,
        measured: program.measured,
        timing: None,
        stdout: program.stdout.clone(),
        stderr: program.stderr.clone(),
        card: None,
        card_for_students: None,
    };
    limit_result(hints, &mut result);
    result
}

/// Returns the size of a complete trace of the scene in which all lists are empty; `None` if the reference's lists are
/// empty as well.
fn count_empty_trace_bytes(scene: &Scene) -> Option<u64> {
    let layout = Layout::for_scene(scene);
    let has_pairs = scene.particles.len() > 1 || !(scene.particles.is_empty() || scene.half_planes.is_empty());
    // A record ends with the counts of its impulses and of its polynomials (trace-format.md 2).
    let record = layout.state_bytes() as u64 + 2 * size_of::<i32>() as u64;
    (layout.has_polynomials && layout.steps > 0 && has_pairs).then(|| layout.records() * record)
}

/// Returns the verdict on how the program ended. If a program was stopped because it wrote bytes after the last record,
/// the run counts as successful, because all records were judged.
fn program_verdict(end: &RunEnd, outcome: &Outcome) -> Verdict {
    let had_all = outcome.stop.is_none() && outcome.trailing_bytes;
    match end {
        RunEnd::Exited(0) => Verdict::Accepted,
        RunEnd::TraceLimit if had_all => Verdict::Accepted,
        RunEnd::Canceled => Verdict::NotRun,
        RunEnd::Exited(_) | RunEnd::Signaled(_) => Verdict::RuntimeError,
        RunEnd::CouldNotStart(_) => Verdict::Unusable,
        RunEnd::CpuLimit | RunEnd::WallLimit => Verdict::TimeLimit,
        RunEnd::MemoryLimit => Verdict::MemoryLimit,
        RunEnd::TraceLimit | RunEnd::FolderLimit => Verdict::OutputLimit,
        RunEnd::ProcessLimit | RunEnd::Violation { .. } => Verdict::Violation,
    }
}

/// Returns how far a program's trace reaches, and the limit that stopped the program, if any.
fn find_progress(end: &RunEnd, outcome: &Outcome, limits: &RunLimits) -> ProgramProgress {
    let limit = match end {
        RunEnd::CpuLimit => Some(Limit::Time(limits.cpu)),
        RunEnd::WallLimit => Some(Limit::Time(limits.wall)),
        RunEnd::MemoryLimit => Some(Limit::Memory(limits.memory)),
        _ => None,
    };
    ProgramProgress { limit, steps: outcome.steps_judged }
}

/// Returns the verdict on the trace, and the reason for it. How the program ended does not matter here.
fn trace_verdict(run: &JudgedRun<'_>) -> (Verdict, Reason) {
    let JudgedRun { outcome: judged, rules, trace_bytes, .. } = *run;
    // A step without collision handling may have no result, but the trace is still complete.
    let is_complete = !matches!(judged.stop, Some(Stop::Trace { .. }));
    let is_empty = is_complete && count_empty_trace_bytes(&run.task.scene) == Some(trace_bytes);
    if is_empty && judged.ruling(rules.official()) != Ruling::Accepted {
        return (Verdict::Unwritten, Reason::Wrong(WrongTrace::Nothing));
    }
    match (&judged.stop, judged.ruling(rules.official())) {
        (Some(Stop::Trace { .. }), _) if trace_bytes == 0 => (Verdict::NoOutput, Reason::NoTrace),
        (Some(Stop::Trace { .. }), _) if Layout::for_scene(&run.task.scene).is_states_only(trace_bytes) => {
            (Verdict::BadTrace, Reason::Trace(BadTrace::StatesOnly))
        }
        (Some(Stop::Trace { frame, step, cause, offset, what }), _) => {
            let (frame, step, cause, offset, damage) = (*frame, *step, *cause, *offset, what.clone());
            let unreadable = BadTrace::Unreadable { frame, step, cause, offset, damage };
            (Verdict::BadTrace, Reason::Trace(unreadable))
        }
        (_, Ruling::Accepted) => (Verdict::Accepted, Reason::Right),
        (_, Ruling::WrongAnswer | Ruling::Undecided) => {
            (Verdict::WrongAnswer, Reason::Wrong(find_fault(judged, rules)))
        }
        (_, Ruling::BadTrace) => (Verdict::BadTrace, Reason::Trace(fair_rejection_reason(judged))),
    }
}

fn find_fault(outcome: &Outcome, rules: Rules) -> WrongTrace {
    let account = outcome.findings_by(rules.official());
    if let (Book::Parity, Some(error)) = (rules.official(), outcome.parity.endless_step) {
        return WrongTrace::NoResult(error);
    }
    match account.first_divergence {
        Some(first) if first.step == 0 && account.wrong_steps == 0 => WrongTrace::FirstRecord(first.kind()),
        Some(first) => WrongTrace::Steps { wrong: account.wrong_steps, first: first.step, kind: first.kind() },
        None if outcome.damaged_steps > 0 => WrongTrace::Damaged,
        None if outcome.ruling(rules.official()) == Ruling::Undecided => WrongTrace::Undecided,
        None if outcome.fair.as_ref().is_some_and(|fair| fair.rejection.is_some()) => WrongTrace::Borderline,
        None => WrongTrace::SmallErrors,
    }
}

/// Returns the reason why the fair rules reject a trace as a whole, although the original reads it to its end.
fn fair_rejection_reason(judged: &Outcome) -> BadTrace {
    match judged.fair.as_ref().and_then(|fair| fair.rejection) {
        Some(FairRejection::TrailingBytes) => BadTrace::TrailingBytes,
        _ => BadTrace::Damaged,
    }
}

/// Returns the first `max_bytes` bytes of the output as text. Bytes that are not UTF-8 are replaced.
#[cfg(target_os = "linux")]
pub(super) fn truncate(printed: &[u8], max_bytes: usize) -> String {
    let mut text = String::from_utf8_lossy(&printed[..printed.len().min(max_bytes)]).into_owned();
    if printed.len() > max_bytes {
        text.push_str("\n[cut short]");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_judge::replay;
    use fosssim_model::scene::original;
    use fosssim_student::{self as student, Mistake, Student};
    use fosssim_testing::scenes;

    /// Explaining takes as long as judging many traces, so it is skipped if no reader may see the result.
    #[test]
    fn invisible_explanations_are_not_computed() {
        let scene = original::read(scenes::ALL_KINDS.as_bytes()).expect("a scene").scene;
        let trace = student::record_trace(&scene, Student::new(Some(Mistake::ParticleEdgeEmpty))).expect("a trace");
        let options = replay::Options { uses_fair_rules: true, ..replay::Options::default() };
        let judged = replay::judge(&scene, &trace[..], &options, &mut ());
        let task = &SceneTask { name: "a/b".to_owned(), xml: Vec::new(), scene, recording: None };
        let program = ProgramRun::without_program();
        let limits = &RunLimits::default();
        for (hints, expected) in [
            (Hints::None, None),
            (Hints::Where, Some(SearchDepth::NotFinite)),
            (Hints::What, Some(SearchDepth::Mistakes)),
            (Hints::Full, Some(SearchDepth::Mistakes)),
        ] {
            let (program, judged, trace_bytes, rules) = (&program, &judged, trace.len() as u64, Rules::Fair);
            let run = JudgedRun { task, program, outcome: judged, trace_bytes, rules, hints, limits };
            let mut asked = None;
            let result = conclude(&run, |look| {
                asked = Some(look);
                Vec::new()
            });
            assert_eq!((result.verdict, asked), (Verdict::WrongAnswer, expected), "{hints:?}");
        }
    }
}
