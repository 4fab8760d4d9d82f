//! The verdict of the fair rules in the text of the check report.
use super::super::{number::group_digits, step_share, style::TextStyle};
use fosssim_findings::Cause;
use fosssim_judge::{
    Outcome,
    fair::{FairRejection, FairVerdict, Judgment},
};

/// Returns the text of the verdict and its style.
pub(super) const fn verdict(judgment: &Judgment) -> (TextStyle, &'static str) {
    match judgment.verdict {
        FairVerdict::Accepted => (TextStyle::Right, "accepted"),
        FairVerdict::Rejected => (TextStyle::Wrong, "rejected"),
        FairVerdict::None => (TextStyle::Notice, "undecided"),
    }
}

/// Returns the reason for the fair verdict, in one line.
pub(super) fn summarize(judgment: &Judgment, outcome: &Outcome) -> String {
    let rejection = match judgment.rejection {
        Some(FairRejection::Stopped) => Some("the trace can't be read to its end"),
        Some(FairRejection::Damaged) => Some("the trace is damaged"),
        Some(FairRejection::TrailingBytes) => Some("bytes follow the last record"),
        Some(FairRejection::Undecided) => {
            Some("most of its decisions differ from the reference's, though only round-off could change them")
        }
        None => None,
    };
    let found = judgment.findings.first_divergence.as_ref().map(|first| {
        let wrong = match judgment.findings.wrong_steps {
            0 => "the first record is wrong".to_owned(),
            many => step_share::describe_wrong(many, outcome.steps, group_digits),
        };
        let first = match first.step {
            0 if judgment.findings.wrong_steps == 0 => String::new(),
            0 => ", and the first record is also wrong".to_owned(),
            _ if outcome.steps == 1 => String::new(),
            step => format!(", the first is step {step}"),
        };
        wrong + &first
    });
    let given_up = judgment.first_unjudged_step.map(|step| format!("judging would take too long from step {step} on"));
    let nothing = (judgment.verdict == FairVerdict::None).then(|| "nothing is wrong so far".to_owned());
    let parts = [rejection.map(str::to_owned), found.or(nothing), given_up];
    match parts.into_iter().flatten().collect::<Vec<_>>() {
        parts if parts.is_empty() => step_share::describe_right_steps(outcome.steps, group_digits),
        parts => parts.join("; "),
    }
}

/// Returns a sentence about which rule book accepts the trace, and which one rejects it.
pub(crate) const fn describe_acceptance(cause: Cause) -> &'static str {
    if cause.is_original_too_strict() {
        "the original rejects this trace, but the fair rules accept it"
    } else {
        "the original accepts this trace, but the fair rules reject it"
    }
}
