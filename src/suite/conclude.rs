//! From how a program ended and what its trace holds to the verdict on one scene.
//!
//! Pure functions: no process, no file. The worst of the two sides wins: a right trace does not excuse a crash, and a
//! clean exit does not excuse a wrong trace.
use super::{config::Hints, grade::SceneGrade, verdict::Verdict};
use crate::{
    judge::{Counts, Detail, Finding, Kind, Outcome, Overall, PairWords, Stop, Unreadable},
    sandbox::{self, Ended},
};

/// What a report keeps of each of the program's streams.
const KEPT_OUTPUT: usize = 4096;

/// The verdict on one scene.
///
/// `trace_bytes` is what arrived of the trace; `cut_short` says that the grader itself stopped the program, because
/// the trace could no longer be right.
#[must_use]
pub fn conclude(
    scene: &str,
    program: &sandbox::Outcome,
    judged: &Outcome,
    trace_bytes: u64,
    cut_short: bool,
    hints: Hints,
) -> SceneGrade {
    let (of_program, program_says) = verdict_of_program(&program.ended, cut_short);
    let (of_trace, trace_says) = verdict_of_trace(judged, trace_bytes);
    // A program that was stopped has a trace without end; saying so too would blame it twice.
    let trace_is_cut = matches!(of_trace, Verdict::BadTrace | Verdict::NoOutput);
    let (verdict, summary) = if of_program > Verdict::Accepted && (trace_is_cut || of_program >= of_trace) {
        (of_program, program_says)
    } else if of_trace >= of_program {
        (of_trace, trace_says)
    } else {
        (of_program, program_says)
    };
    let mut details = Vec::new();
    if hints > Hints::None {
        details.extend(judged.first_divergence.as_ref().map(|first| first_divergence(first, hints)));
        details.extend(counts(&judged.counts));
        if let Some(damage) = &judged.damage {
            details.push(format!("damaged at byte {} (frame {}): {}", damage.offset, damage.frame, damage.message));
        }
        if judged.trailing_bytes {
            details.push("bytes follow the last record; they were not looked at".to_owned());
        }
    }
    SceneGrade {
        scene: scene.to_owned(),
        verdict,
        summary,
        details,
        points: 0.0,
        max_points: 0.0,
        right_steps: judged.steps_judged - u32::try_from(judged.wrong_steps).unwrap_or(judged.steps_judged),
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
fn verdict_of_trace(judged: &Outcome, trace_bytes: u64) -> (Verdict, String) {
    match (&judged.stop, judged.overall) {
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
        (None, Overall::Passed) => (Verdict::Accepted, format!("all {} steps are right", judged.steps)),
        (None, _) => (Verdict::WrongAnswer, wrong(judged)),
    }
}

fn wrong(judged: &Outcome) -> String {
    match &judged.first_divergence {
        Some(first) => {
            let share = format!("{} of {} steps are wrong", judged.wrong_steps, judged.steps);
            format!("{share}, first step {}: {}", first.step, first.kind())
        }
        None => "small errors add up beyond the tolerance".to_owned(),
    }
}

/// Where, and with [`Hints::What`] also what, the first divergence is.
fn first_divergence(first: &Finding, hints: Hints) -> String {
    if hints >= Hints::What {
        return format!("first divergence: {first}");
    }
    let place = match &first.detail {
        Detail::MissedCollision { expected } | Detail::WrongNormal { expected, .. } => {
            format!(", {}", PairWords(expected.pair))
        }
        Detail::PolynomialDegree { place, .. }
        | Detail::VanishingPolynomial { place, .. }
        | Detail::Coefficient { place, .. }
        | Detail::PassPositions { place }
        | Detail::TrimmedDecision { place, .. }
        | Detail::MixedForms { place } => format!(", {place}"),
        Detail::Position { particle, .. } | Detail::Velocity { particle, .. } => format!(", particle {particle}"),
        Detail::SuperfluousCollision { actual }
        | Detail::RepeatedCollision { actual }
        | Detail::ContactTime { actual, .. } => format!(", objects {} and {}", actual.first, actual.second),
        Detail::PolynomialCount { .. }
        | Detail::PassCount { .. }
        | Detail::RecordsDiffer { .. }
        | Detail::ImpossibleLog => String::new(),
    };
    format!("first divergence: step {}{place}: {}", first.step, first.kind())
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
