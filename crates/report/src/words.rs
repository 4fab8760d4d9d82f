//! Describes results of scenes in sentences. All reports take their sentences from here.
pub mod explanation;

mod located;

use crate::{describe::describe_step_error, number::format_count, step_share};
pub use located::describe_located;

use fosssim_findings::{
    FindingPlace, Grade, SubmissionFault, Verdict,
    disclosure::{DisclosedBook, DisclosedFinding},
    result::{
        BadTrace, BuildEnd, Failure, FolderContents, Limit, NotRunReason, ProgramProgress, Reason, RunEnd, SavedTrace,
        SceneResult, UnusableReason, WrongTrace,
    },
};
use fosssim_judge::{FindingKind, PairText, ReadFailure};
use fosssim_mistakes::together::find_likely_mistakes;

/// The text about a trace that lacks the lists that its scene requires.
pub const STATES_ONLY: &str =
    "the trace contains only positions and velocities, like the trace of a program without collisions";

/// The exit code of a shell or a loader that cannot find its program.
const NOT_FOUND_CODE: i32 = 127;

/// Describes the result of a scene in one sentence.
pub fn summarize(result: &SceneResult) -> String {
    match &result.reason {
        Reason::Right => step_share::describe_right_steps(result.steps, |count| count.to_string()),
        Reason::Wrong(wrong) => describe_wrong(wrong, result.steps),
        Reason::Trace(bad) => describe_bad_trace(bad),
        // Traces that were handed in have no program that ended.
        Reason::NoTrace if result.ended.is_none() => {
            "there is no trace of this scene: the file Group/name.bin is missing or empty".to_owned()
        }
        Reason::NoTrace => "the program wrote no trace; it must write the file that -o names".to_owned(),
        Reason::Program(reached) => describe_ending(result) + &describe_progress(*reached, result.steps),
        Reason::Skipped(why) => describe_left_out(*why),
        Reason::Stopped => "grading was stopped".to_owned(),
        Reason::Withheld => "details of single scenes are not shown, because the suite has hidden groups".to_owned(),
        Reason::DoesNotBuild => "the sources cannot be built".to_owned(),
        Reason::Unusable(why) => describe_unusable(why),
        Reason::Failed(failure) => describe_failure(failure),
    }
}

/// Describes how the program ended, and at which limit. The progress is left out, so that the text is the same for many
/// scenes.
pub(crate) fn describe_ending(result: &SceneResult) -> String {
    let Reason::Program(reached) = result.reason else { return summarize(result) };
    let ended = result.ended.as_ref().map(RunEnd::to_string).unwrap_or_default();
    let limit = match reached.limit {
        Some(Limit::Time(time)) => format!(" ({} s)", time.as_secs_f64()),
        Some(Limit::Memory(bytes)) => format!(" ({} MiB)", bytes >> 20),
        None => String::new(),
    };
    format!("the program {ended}{limit}")
}

/// The explanation for programs that end as [`is_file_missing`] describes.
pub(crate) const MISSING_FILE: &str =
    "exit code 127 usually means that a file was not found: the program runs alone, without the files next to it";

/// Returns whether the program ended as shells and loaders do if they do not find a file.
pub(crate) fn is_file_missing(result: &SceneResult) -> bool {
    result.ended == Some(RunEnd::Exited(NOT_FOUND_CODE))
}

/// Returns further lines about a scene: the first difference, the counts of findings, any damage, and the file of the
/// trace.
pub fn list_details(result: &SceneResult) -> Vec<String> {
    let mut lines = Vec::new();
    if is_file_missing(result) {
        lines.push(MISSING_FILE.to_owned());
    }
    if let Some(disclosure) = &result.disclosure {
        lines.extend(disclosure.official().first_divergence.as_ref().map(describe_first_difference));
        lines.extend(describe_counts(disclosure.official()));
        if let Some(damage) = &disclosure.damage {
            lines.push(format!("damaged at byte {} (frame {}): {}", damage.offset, damage.frame, damage.what));
        }
        if disclosure.trailing_bytes {
            lines.push("bytes follow the last record".to_owned());
        }
    }
    if let Reason::Failed(Failure::Panic { trace: Some(trace), .. }) = &result.reason {
        lines.push(match trace {
            SavedTrace::In(path) => {
                format!("the trace is kept in {}; please report this with the scene and the trace", path.display())
            }
            SavedTrace::Lost { folder, error } => {
                format!("the trace could not be kept in {}: {error}", folder.display())
            }
        });
    }
    lines
}

/// Describes why the whole submission could not be graded as usual, which applies to each of its scenes; `None` if it
/// could.
pub fn describe_unfit(grade: &Grade) -> Option<String> {
    grade.submission_fault().map(|unfit| match unfit {
        SubmissionFault::Build(end) => build(end),
        SubmissionFault::Milestone(other) => {
            let title = other.definition().title;
            format!("it looks like a program of {title}, which is not the milestone of this suite")
        }
        SubmissionFault::Scene(result) if result.verdict == Verdict::Unwritten => describe_unwritten(grade),
        SubmissionFault::Scene(result) => summarize(result),
    })
}

/// Describes a submission that logs nothing in any scene. If the hints allow it, the text names the parts that are not
/// written.
fn describe_unwritten(grade: &Grade) -> String {
    let scenes = format_count(grade.scenes().count() as u64, "scene");
    let missing = match find_likely_mistakes(grade).first() {
        Some((likely, _)) if likely.is_unfinished() => explanation::describe(likely),
        _ => "Not written yet: the detection.".to_owned(),
    };
    format!("{missing} The traces of {scenes} contain no polynomials and no collisions.")
}

/// Describes in one sentence why a grade is not fully accepted. Returns `None` if everything is accepted.
pub fn describe_reason(grade: &Grade) -> Option<String> {
    if let Some(unfit) = describe_unfit(grade) {
        return Some(unfit);
    }
    let Some(first) = grade.scenes().find(|scene| !matches!(scene.verdict, Verdict::Accepted | Verdict::NotRun)) else {
        return grade.is_incomplete().then(|| format!("{} scenes were not run", grade.count_verdict(Verdict::NotRun)));
    };
    let (all, accepted) = (grade.scenes().count(), grade.count_verdict(Verdict::Accepted));
    Some(format!("{accepted} of {all} scenes accepted; first {}: {}", first.scene, summarize(first)))
}

/// Describes how a build ended.
pub fn build(end: &BuildEnd) -> String {
    match end {
        BuildEnd::Success => "the build succeeded".to_owned(),
        BuildEnd::Failure(ended) => format!("the build {ended}"),
        BuildEnd::MissingProgram(program) => format!("the build did not create {program}"),
        BuildEnd::UnusableProgram(why) => format!("the built program can't be used: {why}"),
        BuildEnd::UnusableSources(why) => format!("the submission can't be built: {why}"),
        BuildEnd::MissingScript(command) => format!("the submission lacks {command}, which builds it"),
    }
}

fn describe_wrong(wrong: &WrongTrace, steps: u32) -> String {
    match wrong {
        WrongTrace::Undisclosed => "the trace is wrong".to_owned(),
        WrongTrace::Nothing => "the trace contains no polynomials and no collisions, so no pair is tested".to_owned(),
        WrongTrace::FirstRecord(kind) => format!("the first record is wrong: {kind}"),
        WrongTrace::Steps { wrong, first, kind } => {
            let share = step_share::describe_wrong(*wrong, steps, |count| count.to_string());
            format!("{share}, first step {first}: {kind}")
        }
        WrongTrace::Damaged => "the trace is damaged".to_owned(),
        WrongTrace::SmallErrors => "small errors add up beyond the tolerance".to_owned(),
        WrongTrace::NoResult(error) => describe_step_error(error),
        WrongTrace::Borderline => {
            "most of the trace's decisions differ from the reference's, although only round-off could change them"
                .to_owned()
        }
        WrongTrace::Undecided => "no fault was found before judging stopped, because it would take too long".to_owned(),
    }
}

fn describe_bad_trace(bad: &BadTrace) -> String {
    match bad {
        BadTrace::Unreadable { frame, step, cause, offset, damage } => {
            let what = match cause {
                ReadFailure::State | ReadFailure::Impulses => "the trace ends too early",
                ReadFailure::Memory => "a list in the trace declares more entries than the file contains",
                ReadFailure::Limit => "the trace is beyond a limit of this grader",
                ReadFailure::Io => "the trace could not be read",
            };
            format!("{what}: frame {frame} (step {step}), byte {offset}: {damage}")
        }
        BadTrace::StatesOnly => STATES_ONLY.to_owned(),
        BadTrace::Damaged => "the trace is damaged".to_owned(),
        BadTrace::TrailingBytes => "bytes follow the trace's last record".to_owned(),
    }
}

/// Describes how far a program's trace reaches. The number of records that a crash lost is unknown, because some may
/// have been in a buffer.
fn describe_progress(reached: ProgramProgress, steps: u32) -> String {
    match (reached.limit, reached.steps) {
        (_, done) if done == steps => " after its last step".to_owned(),
        (Some(_), done) => format!(" at step {} of {steps}", done + 1),
        (None, 0) => String::new(),
        (None, done) => format!("; the last complete record belongs to step {done} of {steps}"),
    }
}

fn describe_left_out(reason: NotRunReason) -> String {
    match reason {
        NotRunReason::Limits { scenes: 1, .. } => {
            "not run: the preceding scene exceeded a limit of time, memory or output".to_owned()
        }
        NotRunReason::Limits { scenes, .. } => {
            format!("not run: {scenes} preceding scenes exceeded a limit of time, memory or output")
        }
        NotRunReason::Total(total) => {
            let seconds = total.as_secs_f64();
            format!("not run: the preceding scenes took {seconds} s, the limit for a submission")
        }
        NotRunReason::FailFast => "not run: a preceding scene is not accepted (--fail-fast)".to_owned(),
    }
}

fn describe_unusable(reason: &UnusableReason) -> String {
    match reason {
        UnusableReason::CouldNotStart(problem) => format!("the program {}", RunEnd::CouldNotStart(problem.clone())),
        UnusableReason::Unreadable(reason) => format!("the program can't be used: {reason}"),
        UnusableReason::NoProgram { sought, found } => {
            let sought = format!("the upload has no program called {sought}");
            match found {
                FolderContents::Unreadable(error) => format!("{sought}: it can't be read: {error}"),
                FolderContents::Nothing => format!("{sought}; it is empty"),
                FolderContents::Others { names, more, elsewhere } => {
                    let more = if *more > 0 { format!(" and {more} more") } else { String::new() };
                    let elsewhere = elsewhere.as_ref().map(|path| format!("; {path} is not in the expected folder"));
                    format!("{sought}; it contains {}{more}{}", names.join(", "), elsewhere.unwrap_or_default())
                }
            }
        }
    }
}

fn describe_failure(failure: &Failure) -> String {
    match failure {
        Failure::Machine(words) => words.clone(),
        Failure::Panic { stage: None, fault, .. } => format!("the grader failed: {fault}; please report this"),
        Failure::Panic { stage: Some(stage), fault, .. } => {
            let doing = stage.name();
            format!("the grader failed while {doing} this scene: {fault}")
        }
    }
}

/// Describes where a trace first differs from the reference, if the hints allow it.
pub(crate) fn describe_first_difference(first: &DisclosedFinding) -> String {
    match first {
        DisclosedFinding::Full(finding) => format!("first difference: {finding}"),
        DisclosedFinding::Place { step, kind, place } => {
            let place = match place {
                FindingPlace::Step => String::new(),
                FindingPlace::Pair(pair) => format!(", {}", PairText(*pair)),
                FindingPlace::Polynomial(place) => format!(", {place}"),
                FindingPlace::Particle(particle) => format!(", particle {particle}"),
                FindingPlace::Objects(first, second) => format!(", objects {first} and {second}"),
            };
            format!("first difference: step {step}{place}: {kind}")
        }
    }
}

/// Describes how many findings of each kind there are, such as `counts: wrong coefficient (12), missed collision (3)`;
/// `None` if there is only the first finding.
fn describe_counts(account: &DisclosedBook) -> Option<String> {
    let counts = &account.counts;
    // If a kind of finding has no example, it occurs only in damaged records, so it proves nothing about the program.
    let has_example = |kind: FindingKind| account.examples.iter().any(|example| example.kind() == kind);
    let list: Vec<String> = FindingKind::ALL
        .into_iter()
        .filter(|&kind| counts.get(kind) > 0 && has_example(kind))
        .map(|kind| format!("{kind} ({})", counts.get(kind)))
        .collect();
    (counts.total() > 1 && !list.is_empty()).then(|| format!("counts: {}", list.join(", ")))
}

#[cfg(test)]
mod tests;
