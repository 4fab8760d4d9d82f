//! The entries of a class's folder that are no submissions, in every format: a list says who is missing in it.
use super::{Format, Text, csv_table, github, gradescope, json, junit, one_line, prairielearn, shortened};
use crate::{
    page::{Audience, GradePage},
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
        let first = |render: &dyn Fn(&Grade) -> String| grades.first().map(render).unwrap_or_default();
        let others = if grades.len() > 1 { passed_over } else { &[] };
        match self {
            Self::Text => Text::default().render(grades) + &not_graded(grades, others, Style::Plain),
            Self::Json => json::render(grades, others),
            Self::Junit => junit::render(grades, others),
            Self::Gradescope => first(&gradescope::render),
            Self::Prairielearn => first(&prairielearn::render),
            Self::Github => github::annotations(grades) + &github::passed_over(others),
            Self::Markdown => github::summary(grades) + &github::list_of_passed_over(others),
            Self::Csv => csv_table::scenes(grades, passed_over),
            Self::Html => {
                first(&|grade| GradePage { grade, card: &|_| None, class: None, reader: Audience::Staff }.html())
            }
        }
    }
}
