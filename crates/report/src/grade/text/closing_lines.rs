//! The closing lines of a report on one submission, which give the result. They are few enough for a small terminal and
//! come last, so that they stay visible.
use super::{Text, verdict_style};
use crate::untrusted_text::{strip_control_characters, to_one_line};
use crate::{
    grade::{
        change_lines, describe_likely, describe_speed, describe_worth, describe_wrong_count, detail_likely,
        find_likely_mistakes, format_optional_points, format_points, group_by_cause, likely_heading,
    },
    number::format_count,
    style::TextStyle,
    table::{Align, Cell, Table},
    words,
};
use fosssim_findings::{Grade, GroupGrade, Verdict};
use std::fmt::Write;

/// The maximum number of groups that are listed. If only one more group exists, it is listed as well. Groups that are
/// not accepted come first.
const MAX_GROUPS: usize = 12;

/// Renders the closing lines below the verdict. With `alone`, the report lists no scenes above them.
pub(super) fn render(options: &Text<'_>, grade: &Grade, alone: bool) -> String {
    let style = options.style;
    let mut text = String::new();
    if alone {
        text += &options.render_header(grade);
    }
    text += &render_groups(options, grade);
    for (number, (look, line)) in change_lines(grade).into_iter().enumerate() {
        if number == 0 {
            let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, "Since the earlier grading"));
        }
        let _ = writeln!(text, "  - {}", style.paint(look, &to_one_line(&line)));
    }
    if let Some(located) = &grade.located_failure {
        let heading = style.paint(TextStyle::Strong, "Where it fails");
        let _ = writeln!(text, "{heading}\n  - {}", to_one_line(&words::describe_located(located)));
    }
    // A fault of the whole submission explains what is wrong in all groups.
    let mistakes = if grade.submission_fault().is_some() { Vec::new() } else { find_likely_mistakes(grade) };
    let wrong = describe_wrong_count(grade);
    for (number, (mistake, explained)) in mistakes.iter().enumerate() {
        if number == 0 {
            let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, likely_heading(&mistakes)));
        }
        let verb = if mistake.reports_non_finite_value() || mistake.is_unexplained() { "in" } else { "explains" };
        let what = strip_control_characters(&describe_likely(grade, mistake));
        let worth = describe_worth(grade, mistake).map(|worth| format!("; fixing it is {worth}")).unwrap_or_default();
        let _ = writeln!(text, "  - {what} ({verb} {explained} of {wrong}{worth})");
        if let Some(note) = grade.course_note(mistake) {
            let _ = writeln!(text, "    The course: {}", to_one_line(&note.to_string()));
        }
        for form in detail_likely(grade, mistake) {
            let _ = writeln!(text, "    {}", strip_control_characters(&form));
        }
    }
    if grade.submission_fault().is_some() {
        return text;
    }
    let causes = group_by_cause(grade);
    let wrong = causes.iter().flatten().find(|scene| !scene.verdict.is_accepted()).copied();
    if let Some(scene) = wrong {
        let code = style.paint(verdict_style(scene.verdict), scene.verdict.code());
        let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, "Scene to look at first"));
        let _ = writeln!(text, "  {code} {}: {}", to_one_line(&scene.scene), to_one_line(&words::summarize(scene)));
    }
    for (number, line) in options.advice.map(|closer| closer(grade, wrong)).unwrap_or_default().iter().enumerate() {
        if number == 0 && wrong.is_none() {
            let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, "Next"));
        }
        let _ = writeln!(text, "  {line}");
    }
    text
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
    let all = group.scenes.len();
    let count = |verdict: Verdict| group.scenes.iter().filter(|scene| scene.verdict == verdict).count();
    let (accepted, not_run) = (count(Verdict::Accepted), count(Verdict::NotRun));
    if accepted == all {
        return match all {
            1 => "its only scene accepted".to_owned(),
            2 => "both scenes accepted".to_owned(),
            _ => format!("all {all} scenes accepted"),
        };
    }
    let rest = if not_run > 0 { format!(", {not_run} not run") } else { String::new() };
    format!("{accepted} of {} accepted{rest}", format_count(all as u64, "scene"))
}
