//! The closing lines of a report on one submission, which give the result. They are few enough for a small terminal and
//! come last, so that they stay visible.
use super::{Text, verdict_style};
use crate::untrusted_text::{strip_control_characters, to_one_line};
use crate::{
    grade::{
        change_lines, describe_likely, describe_shared_worth, describe_speed, describe_worth, describe_wrong_count,
        detail_likely, find_likely_mistakes, format_optional_points, format_points, group_by_cause, likely_heading,
    },
    number::format_count,
    style::{Style, TextStyle},
    table::{Align, Cell, Table},
    words,
};
use fosssim_findings::{Grade, GroupGrade, Verdict};
use fosssim_mistakes::diagnose::Explanation;
use std::fmt::Write;

/// The maximum number of groups that are listed. If only one more group exists, it is listed as well. Groups that are
/// not accepted come first.
const MAX_GROUPS: usize = 12;

/// Renders the closing lines below the verdict. With `alone`, the report lists no scenes above them.
pub(super) fn render(options: &Text<'_>, grade: &Grade, alone: bool) -> String {
    let style = options.style;
    let mut text = if alone { options.render_header(grade) } else { String::new() };
    text += &render_groups(options, grade);
    let changes = change_lines(grade).into_iter();
    let changes = changes.map(|(look, line)| format!("- {}", style.paint(look, &to_one_line(&line))));
    text += &render_list(style, "Since the earlier grading", changes);
    let located = grade.located_failure.iter().map(words::describe_located);
    text += &render_list(style, "Where it fails", located.map(|found| format!("- {}", to_one_line(&found))));
    // A fault of the whole submission explains what is wrong in all groups.
    if grade.submission_fault().is_some() {
        return text;
    }
    let (mistakes, wrong) = (find_likely_mistakes(grade), describe_wrong_count(grade));
    let describe_mistake = |(mistake, explained): &(Explanation, usize)| {
        let verb = if mistake.reports_non_finite_value() || mistake.is_unexplained() { "in" } else { "explains" };
        let what = strip_control_characters(&describe_likely(grade, mistake));
        let worth = describe_worth(grade, mistake).filter(|_| !options.is_retry);
        let worth = worth.map(|worth| format!("; fixing it is {worth}")).unwrap_or_default();
        let note = grade.course_note(mistake).map(|note| format!("  The course: {}", to_one_line(&note.to_string())));
        let forms =
            detail_likely(grade, mistake).into_iter().map(|form| format!("  {}", strip_control_characters(&form)));
        let first = format!("- {what} ({verb} {explained} of {wrong}{worth})");
        std::iter::once(first).chain(note).chain(forms).collect::<Vec<_>>()
    };
    let shared = describe_shared_worth(grade, &mistakes).filter(|_| !options.is_retry);
    let lines = mistakes.iter().flat_map(describe_mistake).chain(shared.map(|shared| format!("- {shared}")));
    text += &render_list(style, likely_heading(&mistakes), lines);
    let causes = group_by_cause(grade);
    let wrong = causes.iter().flatten().find(|scene| !scene.verdict.is_accepted()).copied();
    let scene = wrong.map(|scene| {
        let code = style.paint(verdict_style(scene.verdict), scene.verdict.code());
        format!("{code} {}: {}", to_one_line(&scene.scene), to_one_line(&words::summarize(scene)))
    });
    let advice = options.advice.map(|closer| closer(grade, wrong)).unwrap_or_default();
    let heading = if wrong.is_some() { "Scene to look at first" } else { "Next" };
    text + &render_list(style, heading, scene.into_iter().chain(advice))
}

/// Renders lines below a heading. Without lines, there is no heading.
fn render_list(style: Style, heading: &str, lines: impl Iterator<Item = String>) -> String {
    let lines: String = lines.map(|line| format!("  {line}\n")).collect();
    if lines.is_empty() { lines } else { style.paint(TextStyle::Strong, heading) + "\n" + &lines }
}

/// Renders one row per group, with the points and the number of accepted scenes.
fn render_groups(options: &Text<'_>, grade: &Grade) -> String {
    let mut table = Table::new([Align::Left, Align::Right, Align::Left, Align::Left]);
    let mut listed: Vec<&GroupGrade> = grade.groups.iter().collect();
    let row_count = if listed.len() > MAX_GROUPS + 1 { MAX_GROUPS } else { listed.len() };
    if row_count < listed.len() {
        listed.sort_by_key(|group| group.verdict.is_accepted());
    }
    for group in listed.iter().take(row_count) {
        let name = to_one_line(&group.name);
        let extra = if group.extra { " extra" } else { "" };
        let score = format!("{} of {}{extra}", format_optional_points(group.points), format_points(group.max_points));
        let score = if options.is_retry { String::new() } else { score };
        table.add_row([
            name.into(),
            score.into(),
            Cell::with_style(verdict_style(group.verdict), group.verdict.code()),
            describe_share(group).into(),
        ]);
    }
    let mut text = table.render(options.style);
    for (group, speed) in grade.groups.iter().filter_map(|group| Some((group, group.speed.as_ref()?))) {
        let _ = writeln!(text, "  {}: {}", to_one_line(&group.name), describe_speed(speed));
    }
    if row_count < listed.len() {
        let _ = writeln!(text, "  and {}", format_count((listed.len() - row_count) as u64, "more group"));
    }
    text
}

/// Describes how many scenes of a group are accepted, such as `all 12 scenes` or `8 of 12 scenes, 2 not run`.
fn describe_share(group: &GroupGrade) -> String {
    let scene_count = group.scenes.len();
    let count = |verdict: Verdict| group.scenes.iter().filter(|scene| scene.verdict == verdict).count();
    let (accepted, not_run) = (count(Verdict::Accepted), count(Verdict::NotRun));
    if accepted == scene_count {
        return match scene_count {
            1 => "its only scene accepted".to_owned(),
            2 => "both scenes accepted".to_owned(),
            _ => format!("all {scene_count} scenes accepted"),
        };
    }
    let rest = if not_run > 0 { format!(", {not_run} not run") } else { String::new() };
    format!("{accepted} of {} accepted{rest}", format_count(scene_count as u64, "scene"))
}
