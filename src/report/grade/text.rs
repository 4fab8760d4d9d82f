//! Grades for people at a terminal: a table per submission, then what went wrong.
use super::{super::explain, difference, likely_mistake, one_line, plain, points};
use crate::{
    judge::Rules,
    suite::{Grade, Verdict},
};
use std::fmt::Write;

/// Program output is shown up to so many lines.
const SHOWN_LINES: usize = 10;

/// The whole report.
pub(super) fn render(grades: &[Grade]) -> String {
    let mut text = String::new();
    for grade in grades {
        submission(&mut text, grade);
    }
    if grades.len() > 1 {
        text.push_str(&table(grades));
    }
    text
}

fn submission(text: &mut String, grade: &Grade) {
    let reached = match grade.points {
        Some(reached) => format!("{} of {} points", points(reached), points(grade.max_points)),
        None => "no points: the grader failed, which is not the submission's fault".to_owned(),
    };
    let _ = writeln!(text, "{}: {}, {reached}", one_line(&grade.submission), grade.verdict);
    let _ = writeln!(text, "suite {}, rules {}", one_line(&grade.suite), rules(grade));
    for warning in &grade.warnings {
        let _ = writeln!(text, "warning: {}", plain(warning));
    }
    if let Some(line) = likely_mistake(grade) {
        let _ = writeln!(text, "{}", plain(&line));
    }
    if let Some(build) = grade.build.as_ref().filter(|build| !build.succeeded) {
        let _ = writeln!(text, "\n{}\n{}", plain(&build.end), indented(&build.output, usize::MAX));
    }
    let width = grade.scenes().map(|scene| scene.scene.chars().count()).max().unwrap_or(0);
    for group in &grade.groups {
        let _ =
            writeln!(text, "\n{} ({} of {})", one_line(&group.name), points(group.points), points(group.max_points));
        for scene in &group.scenes {
            let _ = writeln!(
                text,
                "  {:<3} {:<width$}  {:>6}  {}",
                scene.verdict.code(),
                one_line(&scene.scene),
                points(scene.points),
                one_line(&scene.summary),
            );
            if let Some(line) = difference(scene) {
                let _ = writeln!(text, "      {line}");
            }
            for detail in &scene.details {
                let _ = writeln!(text, "      {}", one_line(detail));
            }
            for line in explain::lines(&scene.explanations) {
                let _ = writeln!(text, "      {}", one_line(&line));
            }
            if scene.verdict >= Verdict::NoOutput && !scene.stderr.trim().is_empty() {
                let _ = writeln!(text, "      its error output:\n{}", indented(&scene.stderr, SHOWN_LINES));
            }
        }
    }
    text.push('\n');
}

/// The books, and which one counts.
fn rules(grade: &Grade) -> String {
    let (rules, differing) = (grade.rules, grade.differing());
    match (rules, differing) {
        (Rules::Both, 0) => "parity (the fair rules agree)".to_owned(),
        (Rules::Both, 1) => "parity (the fair rules differ in 1 scene)".to_owned(),
        (Rules::Both, many) => format!("parity (the fair rules differ in {many} scenes)"),
        (Rules::Parity | Rules::Fair, _) => rules.name().to_owned(),
    }
}

/// Lines of program output, marked so that they can't be taken for ours.
fn indented(output: &str, most: usize) -> String {
    let output = plain(output);
    let mut lines: Vec<String> = output.lines().take(most).map(|line| format!("      | {line}")).collect();
    if output.lines().count() > most {
        lines.push("      | ...".to_owned());
    }
    lines.join("\n")
}

/// One row per submission: score, worst verdict, verdict per group, time.
#[must_use]
pub fn table(grades: &[Grade]) -> String {
    let width = grades.iter().map(|grade| grade.submission.chars().count()).max().unwrap_or(0).max(10);
    let mut text = String::new();
    let groups: Vec<String> =
        grades.first().map(|grade| grade.groups.iter().map(|group| short(&group.name)).collect()).unwrap_or_default();
    let _ = write!(text, "{:<width$}  {:>8}  {:<17}", "submission", "points", "verdict");
    for group in &groups {
        let _ = write!(text, "  {group:<8}");
    }
    let _ = writeln!(text, "  {:>7}", "seconds");
    for grade in grades {
        let reached = grade.points.map_or_else(|| "-".to_owned(), points);
        let _ = write!(text, "{:<width$}  {reached:>8}  {:<17}", one_line(&grade.submission), grade.verdict);
        for group in &grade.groups {
            let accepted = group.scenes.iter().filter(|scene| scene.verdict.is_accepted()).count();
            let cell = if accepted == group.scenes.len() {
                "AC".to_owned()
            } else {
                format!("{} {accepted}/{}", group.verdict.code(), group.scenes.len())
            };
            let _ = write!(text, "  {cell:<8}");
        }
        let _ = writeln!(text, "  {:>7.2}", grade.wall.as_secs_f64());
    }
    text
}

/// A group's name, cut to the width of its column.
fn short(name: &str) -> String {
    one_line(name).chars().take(8).collect()
}
