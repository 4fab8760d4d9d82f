//! Sentences about a grade that appear in several formats.
use super::clearest_scene;
use crate::{
    explain, number::format_count, style::Style, untrusted_text::to_one_line, words, words::explanation::capitalize,
};
use fosssim_findings::{FindingKind, Grade, SceneGrade, Verdict, disclosure::DisclosedFinding};
pub use fosssim_mistakes::together::find_likely_mistakes;
use fosssim_mistakes::{diagnose::Explanation, together};

/// The text that a skipped entry has instead of a verdict.
pub(super) const NOT_GRADED: &str = "not graded";

/// Returns the first lines of a report, above all scenes. They name the fault of the whole submission, or the scenes in
/// which the program fails and the likely mistakes.
pub fn head_lines(grade: &Grade) -> Vec<String> {
    if let Some(unfit) = words::describe_unfit(grade) {
        return vec![unfit];
    }
    let wrong = describe_wrong_count(grade);
    let mut rank = "most likely mistake";
    let line = |(mistake, explained): (Explanation, usize)| {
        let what = describe_likely(grade, &mistake) + &describe_note(grade, &mistake);
        if mistake.reports_non_finite_value() || mistake.is_unexplained() {
            return format!("{what} (in {explained} of {wrong})");
        }
        let worth = describe_worth(grade, &mistake).map(|worth| format!("; fixing it is {worth}")).unwrap_or_default();
        format!("{}: {what} (explains {explained} of {wrong}{worth})", std::mem::replace(&mut rank, "also likely"))
    };
    let located = grade.located_failure.as_ref().map(words::describe_located);
    let likely = find_likely_mistakes(grade);
    let shared = describe_shared_worth(grade, &likely);
    located.into_iter().chain(likely.into_iter().map(line)).chain(shared).collect()
}

/// Returns the heading above likely mistakes. If none of them is a known mistake, the heading is `What differs`.
pub(crate) fn likely_heading(likely: &[(Explanation, usize)]) -> &'static str {
    match likely {
        _ if likely.iter().all(|(mistake, _)| mistake.is_unexplained()) => "What differs",
        [_] => "Likely mistake",
        _ => "Likely mistakes",
    }
}

/// Describes a likely mistake of a submission. Polynomials that no known mistake explains may follow from a state that
/// was wrong before them; the text then names the state, and where to look.
pub fn describe_likely(grade: &Grade, mistake: &Explanation) -> String {
    let scene = mistake.is_unexplained().then(|| clearest_scene(grade, mistake)).flatten();
    let state = scene.and_then(describe_wrong_state);
    state.unwrap_or_else(|| words::explanation::describe_with_alternatives(mistake))
}

/// Describes the first wrong state of a scene, for polynomials that no mistake explains. Returns `None` if the first
/// difference is not a wrong state.
pub(crate) fn describe_wrong_state(scene: &SceneGrade) -> Option<String> {
    let first = find_wrong_state(scene)?;
    let is_official = scene.disclosure.as_ref()?.official().first_divergence.as_ref() == Some(first);
    let begin = if is_official { "The first" } else { "By the fair rules, the first" };
    Some(format!(
        "{begin} difference is a {}, which no known mistake explains. Look at the integrator, the forces, or the \
         response.",
        first.kind()
    ))
}

/// Describes an explanation of a scene in one sentence. If no mistake explains the polynomials, the sentence is about
/// the first wrong state, if there is one.
pub fn describe_in_scene(scene: &SceneGrade, mistake: &Explanation) -> String {
    let state = mistake.is_unexplained().then(|| describe_wrong_state(scene)).flatten();
    state.unwrap_or_else(|| words::explanation::describe(mistake))
}

/// Returns the sentence about a scene's likeliest mistake, for formats with a single line; `None` if no mistake is
/// likely.
pub fn scene_sentence(scene: &SceneGrade) -> Option<String> {
    let first = scene.corrected_explanations.first()?;
    if first.is_unexplained() {
        return Some(describe_in_scene(scene, first));
    }
    explain::render_sentence(&scene.corrected_explanations)
}

/// Returns the lines of a report about a scene's likely mistakes. If no mistake explains the polynomials, the line is
/// about the first wrong state, if there is one.
pub fn scene_lines(scene: &SceneGrade, style: Style) -> Vec<String> {
    let lines = |mistake: &Explanation| match mistake.is_unexplained().then(|| describe_wrong_state(scene)).flatten() {
        Some(state) => vec![state],
        None => explain::explanation_texts(std::slice::from_ref(mistake), style),
    };
    scene.corrected_explanations.iter().flat_map(lines).collect()
}

/// Returns lines about the exact form of a likely mistake. If no mistake explains the polynomials, the line is about
/// the first wrong state, if there is one.
pub(crate) fn detail_likely(grade: &Grade, mistake: &Explanation) -> Vec<String> {
    let scene = mistake.is_unexplained().then(|| clearest_scene(grade, mistake)).flatten();
    match scene.and_then(find_wrong_state) {
        Some(first) => {
            let line = words::describe_first_difference(first);
            vec![capitalize(line.trim_start_matches("first difference: "))]
        }
        None => {
            let forms = words::explanation::list_exact_forms(mistake);
            forms.iter().map(|form| capitalize(form.trim_end_matches('.')) + ".").collect()
        }
    }
}

/// Returns the first difference by the official rules if it is a wrong position or velocity; otherwise the first one by
/// the fair rules if it is. The original's rules may reject an earlier polynomial only because of round-off.
fn find_wrong_state(scene: &SceneGrade) -> Option<&DisclosedFinding> {
    let disclosure = scene.disclosure.as_ref()?;
    let firsts = [Some(disclosure.official()), disclosure.fair.as_ref()].into_iter().flatten();
    let is_state = |first: &&DisclosedFinding| matches!(first.kind(), FindingKind::Position | FindingKind::Velocity);
    firsts.filter_map(|book| book.first_divergence.as_ref()).find(is_state)
}

/// Describes the points that fixing a mistake would give, such as `worth 21.4 of 100 points`; `None` if no scene is
/// wrong only because of this mistake, or the grade has no points.
pub fn describe_worth(grade: &Grade, mistake: &Explanation) -> Option<String> {
    grade.points?;
    if together::is_only_extra(grade, mistake) {
        return Some("worth only extra points".to_owned());
    }
    let lost_points = together::mistake_points(grade, mistake);
    (lost_points > 0.0).then(|| format!("worth {}", format_score(lost_points, grade.max_points)))
}

/// Describes the points that only fixing several mistakes gives; `None` if there are none.
pub(crate) fn describe_shared_worth(grade: &Grade, likely: &[(Explanation, usize)]) -> Option<String> {
    grade.points?;
    let mistakes: Vec<Explanation> = likely.iter().map(|(mistake, _)| mistake.clone()).collect();
    let points = format_points(together::shared_points(grade, &mistakes));
    let which = if mistakes.len() == 2 { "both mistakes" } else { "several of these mistakes" };
    (points != "0").then(|| format!("Fixing {which} is worth another {points} points."))
}

/// Returns the course's note on a mistake, in a form that follows the report's sentence; empty if there is no note.
pub(crate) fn describe_note(grade: &Grade, mistake: &Explanation) -> String {
    grade.course_note(mistake).map(|note| format!(" (The course: {note})")).unwrap_or_default()
}

/// Returns the number of scenes with wrong traces as text, such as `12 wrong scenes`.
pub(crate) fn describe_wrong_count(grade: &Grade) -> String {
    let wrong = grade.scenes().filter(|scene| scene.verdict.is_wrong_trace());
    format_count(wrong.count() as u64, "wrong scene")
}

/// Returns the text for a scene whose verdict has a reason that the report has already given for the whole submission.
pub(super) const fn describe_repeated_reason(scene: &SceneGrade) -> &'static str {
    match scene.result.verdict {
        Verdict::Unwritten => "see above",
        _ => "not run, see above",
    }
}

/// Returns a sentence about a scene that the two rule books judge differently; `None` if they agree.
pub fn describe_difference(scene: &SceneGrade) -> Option<String> {
    scene.difference_cause.map(|cause| {
        let verdicts = if cause.is_original_too_strict() {
            "the original rejects it, but the fair rules accept it"
        } else {
            "the original accepts it, but the fair rules reject it"
        };
        format!("the rule books differ: {verdicts}: {cause}")
    })
}

/// Joins the first names into a list, such as `a, b, c and 2 more`.
pub(super) fn list_first(names: &[impl AsRef<str>], max_names: usize) -> String {
    let first_names: Vec<_> = names.iter().take(max_names).map(|name| to_one_line(name.as_ref())).collect();
    let more = if names.len() > max_names { format!(" and {} more", names.len() - max_names) } else { String::new() };
    first_names.join(", ") + &more
}

/// Formats points without trailing zeros, such as `12.5` or `10`. Halves of a hundredth are rounded up.
pub fn format_points(value: f64) -> String {
    let text = format!("{:.2}", (value * 100.0).round() / 100.0);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Formats a score, such as `12.5 of 20 points`.
pub fn format_score(reached: f64, max_points: f64) -> String {
    let plural = if format_points(max_points) == "1" { "" } else { "s" };
    format!("{} of {} point{plural}", format_points(reached), format_points(max_points))
}

/// Formats points that may be missing. They are missing if the grader failed, which does not give zero points.
pub fn format_optional_points(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), format_points)
}

/// Returns the reason why a grade has no points; `None` if it has points.
pub fn describe_missing_points(grade: &Grade) -> Option<String> {
    if grade.points.is_some() {
        None
    } else if grade.is_grader_fault() {
        Some("no points: the grader failed, which is not the submission's fault".to_owned())
    } else {
        let (missing, all) = (grade.count_verdict(Verdict::NotRun), grade.scenes().count());
        if missing == 0 {
            return Some("no points yet: the time of the program could not be measured".to_owned());
        }
        Some(format!("no points yet: {missing} of {} not run", format_count(all as u64, "scene")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_have_no_needless_digits() {
        assert_eq!(
            (format_points(10.0), format_points(2.5), format_points(0.0)),
            ("10".into(), "2.5".into(), "0".into())
        );
        // The server's databases round halves up, too.
        assert_eq!([51.125, 5.625].map(format_points), ["51.13", "5.63"]);
    }
}
