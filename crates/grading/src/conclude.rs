//! From how a program ended and what its trace holds to the verdict on one scene.
//!
//! Pure functions: no process, no file. The worst of the two sides wins: a right trace does not excuse a crash, and a
//! clean exit does not excuse a wrong trace.
use super::{
    config::{Hints, RunLimits},
    grade::SceneResult,
    verdict::Verdict,
};
use fosssim_judge::{
    Account, Kind, Outcome, Rules, Ruling, Stop, Unreadable,
    fair::{self, Refusal},
    share,
};
use fosssim_sandbox::{self as sandbox, Ended, Stream};

/// What a report keeps of each of the program's streams.
const KEPT_OUTPUT: usize = 4096;

/// The exit code of shells and loaders that did not find what they were to run.
const NOT_FOUND: i32 = 127;

/// What is known of one run.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// How the program ended.
    pub program: &'a sandbox::Outcome,
    /// What its trace holds.
    pub judged: &'a Outcome,
    /// Bytes of the trace that arrived.
    pub trace_bytes: u64,
    /// The rule books; the official one gives verdict, findings and right steps.
    pub rules: Rules,
    /// How much may be told.
    pub hints: Hints,
    /// The limits that it had.
    pub limits: &'a RunLimits,
}

/// The verdict on one scene. Explanations of what is wrong are for the caller to add.
#[must_use]
pub fn conclude(run: &Run<'_>) -> SceneResult {
    let Run { program, judged, rules, hints, .. } = *run;
    let (of_program, program_says) = verdict_of_program(&program.ended, judged, run.limits);
    let (of_trace, trace_says) = verdict_of_trace(judged, rules, run.trace_bytes);
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
    if program.ended == Ended::Exited(NOT_FOUND) {
        details.push(
            "exit code 127 usually means that something was not found: the program is alone when it runs, and files \
             that lie beside it are not there"
                .to_owned(),
        );
    }
    if hints > Hints::None {
        details.extend(account.first_divergence.and_then(|first| hints.first_divergence(first)));
        details.extend(counts(account));
        if let Some(damage) = &judged.damage {
            details.push(format!("damaged at byte {} (frame {}): {}", damage.offset, damage.frame, damage.message));
        }
        if judged.trailing_bytes {
            details.push("bytes follow the last record".to_owned());
        }
    }
    SceneResult {
        scene: run.scene.to_owned(),
        verdict,
        summary,
        differs: fair::cause(judged),
        details,
        explanations: Vec::new(),
        right_steps: judged.right_steps(rules.official()),
        steps: judged.steps,
        cpu: program.cpu,
        wall: program.wall,
        memory: Some(program.peak_memory),
        stdout: kept(&program.stdout),
        stderr: kept(&program.stderr),
        card: None,
    }
}

/// What the program's end alone says. Bytes behind the last record mean the same however many they are: a program that is
/// stopped because of them ended when the judge had what it came for.
fn verdict_of_program(ended: &Ended, judged: &Outcome, limits: &RunLimits) -> (Verdict, String) {
    let had_all = judged.stop.is_none() && judged.trailing_bytes;
    let verdict = match ended {
        Ended::Exited(0) => Verdict::Accepted,
        Ended::OutputLimit(Stream::Trace) if had_all => Verdict::Accepted,
        Ended::Cancelled => Verdict::NotRun,
        Ended::Exited(_) | Ended::Signalled(_) => Verdict::RuntimeError,
        Ended::CouldNotStart(_) => Verdict::Unusable,
        Ended::CpuLimit | Ended::WallLimit => Verdict::TimeLimit,
        Ended::MemoryLimit => Verdict::MemoryLimit,
        Ended::OutputLimit(_) | Ended::FolderLimit => Verdict::OutputLimit,
        Ended::ProcessLimit | Ended::Violation { .. } => Verdict::Violation,
    };
    let limit = match ended {
        Ended::CpuLimit => format!(" ({} s){}", limits.cpu.as_secs_f64(), reached(judged)),
        Ended::WallLimit => format!(" ({} s){}", limits.wall.as_secs_f64(), reached(judged)),
        Ended::MemoryLimit => format!(" ({} MiB){}", limits.memory >> 20, reached(judged)),
        _ => String::new(),
    };
    (verdict, format!("the program {ended}{limit}"))
}

/// How far the trace of a program that was stopped came.
fn reached(judged: &Outcome) -> String {
    match judged.steps_judged {
        done if done == judged.steps => " after its last step".to_owned(),
        done => format!(" at step {} of {}", done + 1, judged.steps),
    }
}

fn number(count: u64) -> String {
    count.to_string()
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
                Unreadable::Limit => "the trace is beyond a limit of this grader",
                Unreadable::Io => "the trace could not be read",
            };
            (Verdict::BadTrace, format!("{what}: frame {frame} (step {step}), byte {offset}: {message}"))
        }
        (Some(Stop::Step(error)), _) => (Verdict::BadTrace, format!("the trace's own states lead nowhere: {error}")),
        (None, Ruling::Accepted) => (Verdict::Accepted, share::right(judged.steps, number)),
        (None, Ruling::WrongAnswer) => (Verdict::WrongAnswer, wrong(judged, rules)),
        (None, Ruling::BadTrace) => (Verdict::BadTrace, refusal(judged)),
    }
}

fn wrong(judged: &Outcome, rules: Rules) -> String {
    let (account, steps) = (judged.account(rules.official()), judged.steps);
    match account.first_divergence {
        Some(first) if first.step == 0 && account.wrong_steps == 0 => {
            format!("the first record is wrong: {}", first.kind())
        }
        Some(first) => {
            let share = share::wrong(account.wrong_steps, steps, number);
            format!("{share}, first step {}: {}", first.step, first.kind())
        }
        None if judged.damaged_steps > 0 => "the trace is damaged".to_owned(),
        None => "small errors add up beyond the tolerance".to_owned(),
    }
}

/// Why the fair rules refuse a trace that the original reads to its end.
fn refusal(judged: &Outcome) -> String {
    match judged.fair.as_ref().and_then(|fair| fair.refusal) {
        Some(Refusal::Damaged) => "the trace is damaged".to_owned(),
        Some(Refusal::TrailingBytes) => "bytes follow the trace's last record".to_owned(),
        Some(Refusal::Stopped) => "the trace's own polynomials lead into a search without end".to_owned(),
        Some(Refusal::Undecided) => {
            "most of the trace's decisions are not the reference's, though round-off may flip them".to_owned()
        }
        None => "the trace was not judged to its end".to_owned(),
    }
}

/// `12 wrong coefficients, 3 missed collisions`, when there is more than the first finding tells.
fn counts(account: Account<'_>) -> Option<String> {
    let counts = account.counts;
    // What is found in damaged records alone has no example, and says nothing about the program.
    let has_example = |kind: Kind| account.examples.iter().any(|example| example.kind() == kind);
    let list: Vec<String> = Kind::ALL
        .into_iter()
        .filter(|&kind| counts.get(kind) > 0 && has_example(kind))
        .map(|kind| format!("{kind}: {}", counts.get(kind)))
        .collect();
    (counts.total() > 1 && !list.is_empty()).then(|| format!("counts: {}", list.join(", ")))
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
