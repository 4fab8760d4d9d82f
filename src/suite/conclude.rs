//! From how a program ended and what its trace holds to the verdict on one scene.
//!
//! Pure functions: no process, no file. The worst of the two sides wins: a right trace does not excuse a crash, and a
//! clean exit does not excuse a wrong trace.
use super::{config::Hints, grade::SceneGrade, verdict::Verdict};
use crate::{
    judge::{
        Account, Counts, Kind, Outcome, Rules, Ruling, Stop, Unreadable,
        fair::{self, Refusal},
    },
    sandbox::{self, Ended},
};

/// What a report keeps of each of the program's streams.
const KEPT_OUTPUT: usize = 4096;

/// The verdict on one scene.
///
/// `trace_bytes` is what arrived of the trace; `cut_short` says that the grader itself stopped the program, because
/// the trace could no longer be right. Explanations of what is wrong are for the caller to add. The official one of the `rules` gives verdict, findings and right steps.
#[must_use]
pub fn conclude(
    scene: &str,
    program: &sandbox::Outcome,
    judged: &Outcome,
    trace_bytes: u64,
    cut_short: bool,
    rules: Rules,
    hints: Hints,
) -> SceneGrade {
    let (of_program, program_says) = verdict_of_program(&program.ended, cut_short);
    let (of_trace, trace_says) = verdict_of_trace(judged, rules, trace_bytes);
    let account = judged.account(rules.official());
    // A program that was stopped has a trace without end; saying so too would blame it twice.
    let trace_is_cut = matches!(of_trace, Verdict::BadTrace | Verdict::NoOutput);
    let (verdict, summary) = if of_program > Verdict::Accepted && (trace_is_cut || of_program >= of_trace) {
        (of_program, program_says)
    } else if of_trace >= of_program {
        (of_trace, trace_says)
    } else {
        (of_program, program_says)
    };
    let is_wrong = verdict == Verdict::WrongAnswer;
    let summary = if hints == Hints::None && is_wrong { "the trace is wrong".to_owned() } else { summary };
    let mut details = Vec::new();
    if hints > Hints::None {
        details.extend(account.first_divergence.and_then(|first| hints.first_divergence(first)));
        details.extend(counts(account.counts));
        if let Some(damage) = &judged.damage {
            details.push(format!("damaged at byte {} (frame {}): {}", damage.offset, damage.frame, damage.message));
        }
        if judged.trailing_bytes {
            details.push("bytes follow the last record".to_owned());
        }
    }
    SceneGrade {
        scene: scene.to_owned(),
        verdict,
        summary,
        differs: fair::cause(judged),
        details,
        explanations: Vec::new(),
        points: 0.0,
        max_points: 0.0,
        right_steps: judged
            .steps_judged
            .saturating_sub(u32::try_from(account.wrong_steps).unwrap_or(judged.steps_judged)),
        steps: judged.steps,
        cpu: program.cpu,
        wall: program.wall,
        memory: Some(program.peak_memory),
        stdout: kept(&program.stdout),
        stderr: kept(&program.stderr),
        cached: false,
    }
}

/// What the program's end alone says.
fn verdict_of_program(ended: &Ended, cut_short: bool) -> (Verdict, String) {
    let verdict = match ended {
        Ended::Exited(0) => Verdict::Accepted,
        Ended::Cancelled if cut_short => Verdict::Accepted,
        Ended::Cancelled => Verdict::NotRun,
        Ended::Exited(_) | Ended::Signalled(_) | Ended::CouldNotStart(_) => Verdict::RuntimeError,
        Ended::CpuLimit | Ended::WallLimit => Verdict::TimeLimit,
        Ended::MemoryLimit => Verdict::MemoryLimit,
        Ended::OutputLimit(_) | Ended::FolderLimit => Verdict::OutputLimit,
        Ended::ProcessLimit | Ended::Violation { .. } => Verdict::Violation,
    };
    (verdict, format!("the program {ended}"))
}

/// What the trace alone says.
fn verdict_of_trace(judged: &Outcome, rules: Rules, trace_bytes: u64) -> (Verdict, String) {
    match (&judged.stop, judged.ruling(rules.official())) {
        (Some(Stop::Trace { .. }), _) if trace_bytes == 0 => {
            (Verdict::NoOutput, "the program wrote no trace; it has to write the file that -o names".to_owned())
        }
        (Some(Stop::Trace { frame, step, cause, offset, message }), _) => {
            let what = match cause {
                Unreadable::State | Unreadable::Impulses => "the trace ends too early",
                Unreadable::Memory => "the trace holds a count that it can not satisfy",
                Unreadable::Io => "the trace could not be read",
            };
            (Verdict::BadTrace, format!("{what}: frame {frame} (step {step}), byte {offset}: {message}"))
        }
        (Some(Stop::Step(error)), _) => (Verdict::BadTrace, format!("the trace's own states lead nowhere: {error}")),
        (None, Ruling::Accepted) => (Verdict::Accepted, format!("all {} steps are right", judged.steps)),
        (None, Ruling::WrongAnswer) => (Verdict::WrongAnswer, wrong(judged.account(rules.official()), judged.steps)),
        (None, Ruling::BadTrace) => (Verdict::BadTrace, refusal(judged)),
    }
}

fn wrong(account: Account<'_>, steps: u32) -> String {
    match account.first_divergence {
        Some(first) if first.step == 0 && account.wrong_steps == 0 => {
            format!("the first record is wrong: {}", first.kind())
        }
        Some(first) => {
            let verb = if account.wrong_steps == 1 { "is" } else { "are" };
            let share = format!("{} of {steps} steps {verb} wrong", account.wrong_steps);
            format!("{share}, first step {}: {}", first.step, first.kind())
        }
        None => "small errors add up beyond the tolerance".to_owned(),
    }
}

/// Why the fair rules refuse a trace that the original reads to its end.
fn refusal(judged: &Outcome) -> String {
    match judged.fair.as_ref().and_then(|fair| fair.refusal) {
        Some(Refusal::Damaged) => "the trace is damaged".to_owned(),
        Some(Refusal::TrailingBytes) => "bytes follow the trace's last record".to_owned(),
        Some(Refusal::Stopped) => "the trace's own polynomials lead into a search without end".to_owned(),
        None => "the trace was not judged to its end".to_owned(),
    }
}

/// `12 wrong coefficients, 3 missed collisions`, when there is more than the first finding tells.
fn counts(counts: &Counts) -> Option<String> {
    let list: Vec<String> = Kind::ALL
        .into_iter()
        .filter(|&kind| counts.get(kind) > 0)
        .map(|kind| format!("{kind}: {}", counts.get(kind)))
        .collect();
    (counts.total() > 1).then(|| format!("counts: {}", list.join(", ")))
}

/// The first bytes of a stream as text; what is not UTF-8 is replaced.
fn kept(captured: &sandbox::Captured) -> String {
    let bytes = &captured.bytes[..captured.bytes.len().min(KEPT_OUTPUT)];
    let mut text = String::from_utf8_lossy(bytes).into_owned();
    if captured.truncated || captured.bytes.len() > KEPT_OUTPUT {
        text.push_str("\n[cut short]");
    }
    text
}
