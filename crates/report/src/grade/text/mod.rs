//! Renders grades as text for the terminal. Faults come first and the result comes last, because a terminal shows the
//! last lines.

mod closing_lines;
mod scenes;
mod table;

pub use table::{render_table, shorten_name};

use super::{super::style::Style, describe_missing_points, format_score};
use crate::untrusted_text::{clean_output, strip_control_characters, to_one_line};
use crate::{number::format_count, smallest, style::TextStyle, words};
use fosssim_findings::{Grade, SceneGrade, SubmissionFault, Verdict};
use fosssim_judge::Rules;
use std::fmt::Write;

/// The maximum number of lines of a program's output in the report.
const MAX_SHOWN_LINES: usize = 10;

/// The amount of detail in the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum TextDetail {
    /// One line per submission.
    Line,
    /// A table with one row per submission. If there is only one submission, its result.
    Table,
    /// The summary and every scene that is not accepted.
    #[default]
    Wrong,
    /// The summary and every scene.
    All,
}

/// A function that returns lines of advice about a wrong scene, or about an accepted submission. Lines that begin with
/// `$ ` are commands.
pub type Advice<'a> = &'a dyn Fn(&Grade, Option<&SceneGrade>) -> Vec<String>;

/// Renders grades as text, with these options.
#[derive(Clone, Copy, Default)]
pub struct Text<'a> {
    /// The style of terminal text.
    pub style: Style,
    /// The amount of detail for each submission.
    pub detail: TextDetail,
    /// The maximum width of tables in columns; `None` for no limit.
    pub width: Option<usize>,
    /// The function that suggests commands with which the reader sees more of the first wrong scene.
    pub advice: Option<Advice<'a>>,
    /// Whether only scenes that failed in the last grading were graded. Their points are not a grade.
    pub is_retry: bool,
}

impl Text<'_> {
    /// Renders the report on all grades.
    pub fn render(&self, grades: &[Grade]) -> String {
        let mut text = String::new();
        if self.detail == TextDetail::Table && grades.len() > 1 {
            let unfit = |grade: &Grade| {
                let fault = self.describe_submission_fault(grade)?;
                Some(format!("{}: {fault}\n", table::shorten_name(&to_one_line(&grade.submission))))
            };
            return render_table(grades, self.width, self.style) + &grades.iter().filter_map(unfit).collect::<String>();
        }
        for grade in grades {
            if self.detail == TextDetail::Line {
                let fault = self.describe_submission_fault(grade).map(|unfit| format!(": {unfit}")).unwrap_or_default();
                let _ = writeln!(text, "{}{fault}", self.verdict(grade));
            } else {
                self.write_submission(&mut text, grade, grades.len() > 1);
            }
        }
        if grades.len() > 1 && self.detail > TextDetail::Line {
            text += &render_table(grades, self.width, self.style);
        }
        text
    }

    /// Writes one submission. Its verdict is above its scenes. If it is the only submission, the verdict is repeated
    /// below the scenes, where a terminal still shows it.
    fn write_submission(&self, text: &mut String, grade: &Grade, is_one_of_several: bool) {
        let details = scenes::render(self, grade);
        if !details.is_empty() {
            let _ = writeln!(text, "{}", self.verdict(grade));
            *text += &self.render_header(grade);
            *text += &details;
            text.push('\n');
        }
        if !is_one_of_several || details.is_empty() {
            let _ = writeln!(text, "{}", self.verdict(grade));
        }
        *text += &closing_lines::render(self, grade, details.is_empty());
        text.extend(grade.smallest.iter().map(|small| format!("\n{}", smallest::render_text(small, self.style))));
        text.push('\n');
    }

    /// Renders one line with the submission's name, its verdict and its points.
    fn verdict(&self, grade: &Grade) -> String {
        let look = if grade.verdict.is_accepted() { TextStyle::Right } else { TextStyle::Wrong };
        let (name, verdict) = (to_one_line(&grade.submission), grade.verdict.name());
        let reached = match grade.points {
            _ if self.is_retry => describe_retry(grade),
            Some(reached) => format_score(reached, grade.max_points) + &describe_extra_points(grade),
            None => describe_missing_points(grade).unwrap_or_default(),
        };
        format!("{}: {}, {reached}", self.style.paint(TextStyle::Strong, &name), self.style.paint(look, verdict))
    }

    /// Describes the fault of the whole submission; `None` if there is none. If the reader runs the command, the text
    /// also names the option that helps.
    fn describe_submission_fault(&self, grade: &Grade) -> Option<String> {
        let option = match (grade.submission_fault(), self.advice) {
            (Some(SubmissionFault::Milestone(other)), Some(_)) => {
                format!(": grade it with --suite {}", other.definition().key)
            }
            _ => String::new(),
        };
        words::describe_unfit(grade).map(|unfit| to_one_line(&unfit) + &option)
    }

    /// Renders the lines above the scenes: the suite, the weaknesses of the sandbox, and a failed build.
    fn render_header(&self, grade: &Grade) -> String {
        let mut text = format!("suite {}{}\n", to_one_line(&grade.suite), describe_rules(grade));
        let mark = self.style.paint(TextStyle::Notice, "warning");
        let warnings = grade.warnings.iter();
        text.extend(warnings.map(|warning| format!("{mark}: {}\n", strip_control_characters(warning))));
        let build = grade.failed_build();
        if let (Some(unfit), None) = (self.describe_submission_fault(grade), build) {
            let _ = writeln!(text, "{unfit}");
        }
        if let Some(build) = build {
            let max_lines = if self.detail < TextDetail::Wrong { MAX_SHOWN_LINES } else { usize::MAX };
            let end = strip_control_characters(&words::build(&build.end));
            let _ = writeln!(text, "\n{end}\n{}", quote_output(&build.output, max_lines));
        }
        text
    }
}

/// Describes extra points, such as `, 15 of 20 extra points`; empty if the suite has no extra points.
pub fn describe_extra_points(grade: &Grade) -> String {
    let score = |(reached, max_points)| format_score(reached, max_points).replace("point", "extra point");
    grade.extra_points().map_or_else(String::new, |points| format!(", {}", score(points)))
}

/// Describes the result of scenes that failed in the last grading.
fn describe_retry(grade: &Grade) -> String {
    let (right, all) = (grade.count_verdict(Verdict::Accepted), grade.scenes().count());
    format!("{right} of {} that failed before became right; no other scenes ran", format_count(all as u64, "scene"))
}

/// Names the rule book that gives the verdict. The text is empty if the fair rules were used and both books agree.
fn describe_rules(grade: &Grade) -> String {
    match (grade.rules, grade.count_differing() as u64) {
        (Rules::Parity, _) => ", by the original's rules".to_owned(),
        (Rules::Fair | Rules::Both, 0) => String::new(),
        (Rules::Fair, differing) => {
            format!(", by the fair rules (the original's rules differ in {})", format_count(differing, "scene"))
        }
        (Rules::Both, differing) => {
            format!(", by the original's rules (the fair rules differ in {})", format_count(differing, "scene"))
        }
    }
}

/// Returns the style in which a scene's verdict is shown.
const fn verdict_style(verdict: Verdict) -> TextStyle {
    match verdict {
        Verdict::Accepted => TextStyle::Right,
        Verdict::NotRun => TextStyle::Notice,
        _ => TextStyle::Wrong,
    }
}

/// Returns lines of a program's output. Each has a mark, so that it cannot be mistaken for a line of the report.
fn quote_output(output: &str, max_lines: usize) -> String {
    let output = clean_output(output);
    let mut lines: Vec<String> = output.lines().take(max_lines).map(|line| format!("      | {line}")).collect();
    if output.lines().count() > max_lines {
        lines.push("      | ...".to_owned());
    }
    lines.join("\n")
}
