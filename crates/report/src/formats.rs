//! The formats of grades, with their names, their contents and their readers.
use crate::{
    grade::{Text, csv_table, github, gradescope, json, junit, list_not_graded, prairielearn},
    page::{Audience, GradePage},
    style::Style,
};
use fosssim_findings::{Grade, SkippedEntry};
use fosssim_mistakes::together::{disclosed_grade, immediate_grade};
use std::borrow::Cow;

/// The warning in a report for students that leaves groups out.
const HIDDEN_GROUPS_WARNING: &str =
    "points, verdict and likely mistakes cover only the groups shown here; other groups are hidden";

/// Declares the formats. Each row has the format's name, whether one document can hold the grades of several
/// submissions, and the function that renders it. That function also receives the skipped entries, which are not
/// submissions.
macro_rules! formats {
    ($($(#[$about:meta])+ $format:ident $name:literal $takes_several:literal $render:expr;)+) => {
        /// The formats, in the order in which help lists them.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Format {
            $($(#[$about])+ $format,)+
        }

        impl Format {
            /// All formats, in the order in which help lists them.
            pub const ALL: &'static [Self] = &[$(Self::$format),+];

            /// Returns the format's name on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$format => $name,)+ }
            }

            /// Returns whether one document can hold the grades of several submissions.
            pub const fn takes_several(self) -> bool {
                match self { $(Self::$format => $takes_several,)+ }
            }

            /// Renders the document like [`Format::render`], and lists the skipped entries in it.
            pub fn render_class(self, grades: &[Grade], skipped: &[SkippedEntry]) -> String {
                let render: fn(&[Grade], &[SkippedEntry]) -> String = match self { $(Self::$format => $render,)+ };
                render(grades, skipped)
            }
        }
    };
}

formats! {
    /// Text for the terminal.
    Text "text" true
        |grades, skipped| {
            Text::default().render(grades) + &list_not_graded(grades, class_entries(grades, skipped), Style::Plain)
        };
    /// JSON in this program's own form, with a version (`schemas/grade.schema.json`).
    Json "json" true |grades, skipped| json::render(grades, class_entries(grades, skipped));
    /// JUnit XML for continuous integration (`schemas/junit.xsd`).
    Junit "junit" true |grades, skipped| junit::render(grades, class_entries(grades, skipped));
    /// The file results.json for Gradescope (`schemas/gradescope.schema.json`).
    Gradescope "gradescope" false |grades, _| render_first(grades, gradescope::render);
    /// The file results.json for PrairieLearn (`schemas/prairielearn.schema.json`).
    Prairielearn "prairielearn" false |grades, _| render_first(grades, prairielearn::render);
    /// Annotations for GitHub Actions.
    Github "github" true
        |grades, skipped| {
            github::render_annotations(grades) + &github::warn_of_skipped(class_entries(grades, skipped))
        };
    /// A summary in Markdown, for example of a step in GitHub Actions.
    Markdown "markdown" true
        |grades, skipped| {
            github::render_summary(grades) + &github::list_skipped(class_entries(grades, skipped))
        };
    /// A CSV table for spreadsheets, with one row per scene.
    Csv "csv" true csv_table::render_scenes;
    /// A page in a single file ([`page::GradePage`](crate::page::GradePage)). This function renders it without
    /// pictures, because these are stored on disk.
    Html "html" false
        |grades, _| {
            render_first(grades, |grade| {
                GradePage { grade, card: &|_| None, class: None, reader: Audience::Staff }.html()
            })
        };
}

/// Renders the first grade, for formats that hold only one.
fn render_first(grades: &[Grade], render: impl Fn(&Grade) -> String) -> String {
    grades.first().map(render).unwrap_or_default()
}

/// Returns the skipped entries for a report on several submissions. A report on one submission does not list them.
fn class_entries<'e>(grades: &[Grade], skipped: &'e [SkippedEntry]) -> &'e [SkippedEntry] {
    if grades.len() > 1 { skipped } else { &[] }
}

impl Format {
    /// Renders the grades as one document. Formats that hold only one grade ([`Format::takes_several`]) render the
    /// first.
    pub fn render(self, grades: &[Grade]) -> String {
        self.render_class(grades, &[])
    }

    /// Returns the format with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.name() == name)
    }

    /// Returns the names of the formats that `select` selects, as a list such as `text, json or csv`.
    pub fn join_names(select: impl Fn(Self) -> bool) -> String {
        let select = Self::ALL.iter().copied().filter(|format| select(*format));
        let names: Vec<&str> = select.map(Self::name).collect();
        match names.split_last() {
            Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
            _ => names.concat(),
        }
    }

    /// Returns the part of a grade that a document for `reader` contains. Reports for students leave out the groups
    /// that students do not see immediately, unless the platform hides these groups itself (`platform_hides`).
    pub fn visible_part(self, grade: &Grade, reader: Audience, platform_hides: bool) -> Cow<'_, Grade> {
        match (self, reader) {
            // These formats are always for students. The platforms and the page hide the hidden groups themselves.
            (Self::Gradescope | Self::Prairielearn, _) | (Self::Html, Audience::Student) => disclosed_grade(grade),
            (_, Audience::Staff) => Cow::Borrowed(grade),
            (_, Audience::Student) if platform_hides => disclosed_grade(grade),
            (_, Audience::Student) => {
                let mut visible_grade = immediate_grade(grade);
                if visible_grade.groups.len() < grade.groups.len() {
                    visible_grade.to_mut().warnings.push(HIDDEN_GROUPS_WARNING.to_owned());
                }
                visible_grade
            }
        }
    }
}

#[cfg(test)]
mod tests;
