//! Output for GitHub Actions: one annotation for each cause of scenes that are not accepted, and a summary in Markdown.
use super::{
    change_lines, describe_difference, describe_missing_points, format_optional_points, format_points, group_by_cause,
    head_lines, is_listed,
    phrases::{NOT_GRADED, list_first},
    scene_sentence,
};
use crate::annotation::{join_annotation, render_annotation};
use crate::untrusted_text::{clean_output, to_one_line};
use crate::{number::format_count, words};
use fosssim_findings::{Grade, SceneGrade, SkippedEntry, Verdict};
use std::fmt::Write;

/// The maximum number of scenes with the same cause that an annotation names.
const MAX_NAMED: usize = 3;

/// Renders annotations. Text in them is escaped for workflow commands.
pub(crate) fn render_annotations(grades: &[Grade]) -> String {
    let mut text = String::new();
    for grade in grades {
        for warning in &grade.warnings {
            text += &render_annotation("warning", &grade.submission, warning);
        }
        if let Some(build) = grade.failed_build() {
            let title = format!("{}: {}", grade.submission, words::build(&build.end));
            let output: String = clean_output(&build.output).chars().take(4000).collect();
            text += &join_annotation("error", &title, output.lines());
        }
        // GitHub shows only ten annotations, so the most important ones come first and nothing is repeated.
        let head = head_lines(grade);
        if !head.is_empty() && grade.failed_build().is_none() {
            let title = format!("{}: {}, {}", grade.submission, grade.verdict, format_score(grade));
            text += &join_annotation("error", &title, head.iter().map(String::as_str));
        }
        let wrong = grade.scenes().filter(|scene| !scene.verdict.is_accepted() && grade.submission_fault().is_none());
        for scene in wrong {
            let level = if scene.verdict == Verdict::NotRun { "warning" } else { "error" };
            let title = format!("{}: {} {}", grade.submission, scene.scene, scene.verdict);
            let parts: Vec<String> = std::iter::once(words::summarize(scene)).chain(scene_sentence(scene)).collect();
            text += &render_annotation(level, &title, &parts.join("; "));
        }
        for scene in grade.scenes() {
            let Some(difference) = describe_difference(scene) else { continue };
            text += &render_annotation("warning", &format!("{}: {}", grade.submission, scene.scene), &difference);
        }
    }
    text
}

/// Renders one warning for each skipped entry.
pub(crate) fn warn_of_skipped(entries: &[SkippedEntry]) -> String {
    let warning =
        |entry: &SkippedEntry| render_annotation("warning", &format!("{}: {NOT_GRADED}", entry.name), &entry.reason);
    entries.iter().map(warning).collect()
}

/// Renders a Markdown list of the skipped entries.
pub(crate) fn list_skipped(entries: &[SkippedEntry]) -> String {
    if entries.is_empty() {
        return String::new();
    }
    let item = |entry: &SkippedEntry| format!("- {}: {}\n", escape_cell(&entry.name), escape_cell(&entry.reason));
    format!("### Not graded\n\n{}\n", entries.iter().map(item).collect::<String>())
}

/// Renders a Markdown table for each submission.
pub(crate) fn render_summary(grades: &[Grade]) -> String {
    let mut text = String::new();
    for grade in grades {
        let _ = writeln!(
            text,
            "### {}: {} ({})\n",
            escape_cell(&grade.submission),
            grade.verdict,
            escape_cell(&format_score(grade))
        );
        for line in head_lines(grade) {
            let _ = writeln!(text, "{}\n", escape_cell(&line));
        }
        let changes: Vec<String> = change_lines(grade).into_iter().map(|(_, line)| escape_cell(&line)).collect();
        if !changes.is_empty() {
            let _ = writeln!(text, "Since the earlier grading: {}\n", changes.join("; "));
        }
        for warning in &grade.warnings {
            let _ = writeln!(text, "**Warning:** {}\n", escape_cell(warning));
        }
        if let Some(build) = grade.failed_build() {
            if grade.submission_fault().is_none() {
                let _ = writeln!(text, "{}\n", escape_cell(&words::build(&build.end)));
            }
            for line in clean_output(&build.output).lines().take(40) {
                let _ = writeln!(text, "    {}", to_one_line(line));
            }
            text.push('\n');
        }
        if grade.submission_fault().is_some() {
            continue;
        }
        let _ = writeln!(text, "| scenes | verdict | points | reason |\n|---|---|---:|---|");
        let sum = |scenes: &[&SceneGrade]| format_optional_points(scenes.iter().map(|scene| scene.points).sum());
        for alike in group_by_cause(grade) {
            let names: Vec<&str> = alike.iter().map(|scene| scene.scene.as_str()).collect();
            let scene = alike[0];
            let words: Vec<String> = std::iter::once(words::summarize(scene))
                .chain(scene_sentence(scene))
                .chain(describe_difference(scene))
                .map(|words| escape_cell(&words))
                .collect();
            let (names, words) = (escape_cell(&list_first(&names, MAX_NAMED)), words.join("; "));
            let _ = writeln!(text, "| {names} | {} | {} | {words} |", scene.verdict, sum(&alike));
        }
        for verdict in [Verdict::Accepted, Verdict::NotRun] {
            let rest: Vec<_> = grade.scenes().filter(|scene| !is_listed(scene) && scene.verdict == verdict).collect();
            if !rest.is_empty() {
                let count = format_count(rest.len() as u64, "scene");
                let _ = writeln!(text, "| {count} | {verdict} | {} | |", sum(&rest));
            }
        }
        text.push('\n');
    }
    text
}

/// Formats the score, such as `12.5 of 20`, or the reason why there are no points.
fn format_score(grade: &Grade) -> String {
    let reached =
        grade.points.map(|reached| format!("{} of {}", format_points(reached), format_points(grade.max_points)));
    reached.or_else(|| describe_missing_points(grade)).unwrap_or_default()
}

/// Escapes the characters in a text that have a meaning in Markdown or HTML.
fn escape_cell(text: &str) -> String {
    let mut cell = String::new();
    for c in to_one_line(text).chars() {
        match c {
            '<' => cell.push_str("&lt;"),
            '>' => cell.push_str("&gt;"),
            '&' => cell.push_str("&amp;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '#' | '!' | '~' | '@' => {
                cell.push('\\');
                cell.push(c);
            }
            c => cell.push(c),
        }
    }
    cell
}
