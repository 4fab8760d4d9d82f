//! Formats values as text or HTML for pages.
pub(super) use crate::visible_grade::verdict;
use crate::{
    calendar,
    domain::{RegradeState, Submission},
    lti::score::PENDING,
    problem,
    task::format_points,
};

/// Formats a time as HTML. The text is in UTC, and a script converts it to the reader's time zone.
pub(super) fn format_time(milliseconds: &i64) -> String {
    let (exact, minute) = (calendar::format_iso(*milliseconds), calendar::format_minute(*milliseconds));
    let second = exact.replace('T', " ");
    format!("<time datetime=\"{exact}\" title=\"{} UTC\">{minute} UTC</time>", &second[..19])
}

/// Formats a time in UTC for a form field, such as `2026-11-22T08:45`.
pub(super) fn field(milliseconds: &Option<i64>) -> String {
    milliseconds.map(|at| calendar::format_minute(at).replace(' ', "T")).unwrap_or_default()
}

/// Formats points and the maximum with at most two decimals, like reports. Without points, the text is a dash.
pub(super) fn points(points: &Option<String>, max_points: &Option<String>) -> String {
    match (points, max_points) {
        (Some(points), Some(max_points)) => format!("{} of {}", format_points(points), format_points(max_points)),
        (Some(points), None) => format_points(points),
        _ => "\u{2013}".to_owned(),
    }
}

/// Returns the likely mistake that a submission's summary names, or the reason why the submission was not run. Long
/// texts are cut.
pub(super) fn short_mistake(summary: &str) -> String {
    shorten(summary.split_once("; ").map_or("", |(_, mistake)| mistake))
}

/// Cuts a text that is too long for a cell of a table.
pub(super) fn shorten(text: &str) -> String {
    let beginning: String = text.chars().take(180).collect();
    let words = beginning.rsplit_once(' ').map_or(beginning.as_str(), |(words, _)| words);
    if beginning.len() < text.len() { format!("{words} ...") } else { beginning }
}

/// Formats the difference of two numbers of points, such as `+2.5`; empty if one of them is missing.
pub(super) fn difference(old: &Option<String>, new: &Option<String>) -> String {
    let read = |points: &Option<String>| points.as_ref()?.parse::<f64>().ok();
    let Some((old, new)) = read(old).zip(read(new)) else { return String::new() };
    match format_points((new - old).abs()) {
        none if none == "0" => none,
        points => format!("{}{points}", if new < old { '\u{2212}' } else { '+' }),
    }
}

/// Formats a verdict's code, the points and, if it is known, the maximum.
pub(super) fn result(code: &str, reached: &Option<String>, max_points: &Option<String>) -> String {
    let verdict = verdict(code);
    if reached.is_none() { verdict.to_owned() } else { format!("{verdict}, {} points", points(reached, max_points)) }
}

/// Describes the state of a regrade.
pub(super) fn describe_regrade(state: &RegradeState) -> &'static str {
    match state {
        RegradeState::Open => "open",
        RegradeState::Applied => "applied",
        RegradeState::Discarded => "discarded",
    }
}

/// Describes a score that a learning platform receives.
pub(super) fn describe_score(score: &serde_json::Value) -> String {
    match (score["scoreGiven"].as_f64(), score["scoreMaximum"].as_f64()) {
        (Some(points), Some(max_points)) => format!("{} / {}", format_points(points), format_points(max_points)),
        _ if score["gradingProgress"] == PENDING => "being graded".to_owned(),
        _ => "staff must check the submission".to_owned(),
    }
}

/// Returns the first digits of a digest.
pub(super) fn short_digest(digest: &str) -> &str {
    digest.get(..12).unwrap_or(digest)
}

/// Returns the CSS class for the label that shows a submission's state.
pub(super) fn chip_class(submission: &Submission) -> &'static str {
    match (submission.state.as_str(), &submission.grade) {
        ("waiting" | "running", _) => "warn",
        (_, Some(grade)) if grade.verdict == "accepted" => "good",
        _ => "bad",
    }
}

/// Returns the text of the label that shows a submission's state: the verdict, or the state before there is a verdict.
pub(super) fn outcome(submission: &Submission) -> &str {
    match (submission.state.as_str(), &submission.grade) {
        ("waiting" | "running", _) | (_, None) => describe_state(&submission.state),
        (_, Some(grade)) => &grade.verdict,
    }
}

/// Returns whether there is a submission and it is accepted.
pub(super) fn is_accepted(submission: &Option<Submission>) -> bool {
    submission.as_ref().is_some_and(|submission| chip_class(submission) == "good")
}

/// Formats a number of bytes with a short unit, such as `1.5 MiB`.
pub(super) fn format_size(bytes: &(impl Copy + TryInto<u64>)) -> String {
    problem::format_size((*bytes).try_into().unwrap_or(0))
}

/// Formats the points of a grade; a dash if there are no points. Points that staff set are points of the whole grade,
/// so the maximum of the groups that the reader sees is left out.
pub(super) fn format_grade_points(submission: &Submission) -> String {
    let staff_points = submission.mark.as_ref().and_then(|mark| mark.points.as_ref());
    if let (true, Some(staff_points)) = (submission.is_withheld, staff_points) {
        return staff_points.clone();
    }
    submission.grade.as_ref().map_or_else(|| points(&None, &None), |grade| points(&grade.points, &grade.max_points))
}

/// Describes a kind of events in the log.
pub(super) fn describe_event(kind: &str) -> &str {
    match kind {
        "failed try" => "grading failed, tried again",
        "buried" => "grading failed permanently",
        "late answer" => "result arrived too late",
        _ => kind,
    }
}

/// Describes the state of a submission, such as `waiting`.
pub(super) fn describe_state(state: &str) -> &'static str {
    match state {
        "waiting" => "waiting",
        "running" => "being graded",
        "done" => "graded",
        "buried" => "the grader failed; this is not your fault, and staff are informed",
        _ => "taken out of the queue",
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn points_have_two_digits_at_most() {
        let points = |points: &str, max: &str| super::points(&Some(points.to_owned()), &Some(max.to_owned()));
        assert_eq!(points("68.08974358974359", "100.0"), "68.09 of 100");
        assert_eq!(points("0", "7.5"), "0 of 7.5");
        assert_eq!(points("51.125", "5.625"), "51.13 of 5.63");
        assert_eq!(super::points(&None, &None), "\u{2013}");
        let difference = |old: &str, new: &str| super::difference(&Some(old.to_owned()), &Some(new.to_owned()));
        assert_eq!(difference("81.25", "77.4"), "\u{2212}3.85");
        assert_eq!([difference("40", "42.5"), difference("1", "1.001")], ["+2.5", "0"]);
    }

    #[test]
    fn scores_without_points_say_who_must_act() {
        let states = ["Pending", "PendingManual"];
        let texts = states.map(|state| super::describe_score(&serde_json::json!({"gradingProgress": state})));
        assert_eq!(texts, ["being graded", "staff must check the submission"]);
    }
}
