//! The entries of a class's folder that are no submissions, in every format: a list says who is missing in it.
use super::{Format, csv_table, github, json, junit, one_line, shortened};
use crate::{
    style::{Look, Style},
    table::{Align, Table},
};
use fosssim_findings::{Grade, PassedOver};

/// A grading of one submission has no list of others: its grade says what was passed over beside it.
pub fn warn_of(grades: &mut [Grade], passed_over: &[PassedOver]) {
    if let [grade] = grades {
        let words = |entry: &PassedOver| format!("passed over {}: {}", entry.name, entry.why);
        grade.warnings.extend(passed_over.iter().map(words));
    }
}

/// The list below a class, for people.
#[must_use]
pub fn not_graded(grades: &[Grade], passed_over: &[PassedOver], style: Style) -> String {
    if passed_over.is_empty() || grades.len() < 2 {
        return String::new();
    }
    let mut table = Table::new([Align::Left, Align::Left]);
    for PassedOver { name, why } in passed_over {
        table.row([shortened(&one_line(name)).into(), one_line(why).into()]);
    }
    format!("{}\n{}", style.paint(Look::Strong, "Not graded"), table.render(style))
}

impl Format {
    /// As [`Format::render`], with the entries that are no submissions.
    #[must_use]
    pub fn render_class(self, grades: &[Grade], passed_over: &[PassedOver]) -> String {
        let is_class = grades.len() > 1 && !passed_over.is_empty();
        match self {
            Self::Csv => csv_table::scenes(grades, passed_over),
            Self::Text if is_class => self.render(grades) + &not_graded(grades, passed_over, Style::Plain),
            Self::Json if is_class => json::render(grades, passed_over),
            Self::Junit if is_class => junit::render(grades, passed_over),
            Self::Github if is_class => github::annotations(grades) + &github::passed_over(passed_over),
            Self::Markdown if is_class => github::summary(grades) + &github::list_of_passed_over(passed_over),
            _ => self.render(grades),
        }
    }
}
