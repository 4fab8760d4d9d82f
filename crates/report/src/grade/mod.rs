//! Grades in every format that courses use: pure functions from [`Grade`] to text.
//!
//! Names and program output are somebody else's words. Each format has [`plain`] or [`one_line`] take control
//! characters out of them, and escapes what its own syntax gives a meaning; a test sends hostile words through every
//! format.

mod class;
mod csv_table;
mod github;
mod gradescope;
mod json;
pub(crate) use json::GradeDocument;
mod junit;
mod passed_over;
mod phrases;
mod prairielearn;
mod speed;
mod text;
mod told;

use crate::page::{Audience, GradePage};
use fosssim_findings::{Grade, GroupGrade, Hints, Rules, SceneGrade, SceneResult, Visibility, result::Measurements};
use std::sync::{Mutex, PoisonError};

/// Whether a format's document holds the grades of several submissions, and how it comes about then.
macro_rules! takes {
    (several) => {
        true
    };
    (one) => {
        false
    };
    (several $render:expr, $grades:expr) => {
        $render($grades)
    };
    (one $render:expr, $grades:expr) => {
        $grades.first().map($render).unwrap_or_default()
    };
}

/// The formats, one line each: name on the command line, whether one document takes several grades, and who writes it.
macro_rules! formats {
    ($($(#[$doc:meta])* $format:ident, $name:literal, $takes:ident $render:expr;)*) => {
        /// The formats, in the order in which help lists them.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Format {
            $($(#[$doc])* $format,)*
        }

        impl Format {
            /// All formats.
            pub const ALL: &'static [Self] = &[$(Self::$format,)*];

            /// The name under which the command line knows it.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$format => $name,)*
                }
            }

            /// Whether one document holds the grades of several submissions.
            #[must_use]
            pub const fn takes_several(self) -> bool {
                match self {
                    $(Self::$format => takes!($takes),)*
                }
            }

            /// The document. Formats for one submission ([`Format::takes_several`]) show the first.
            #[must_use]
            pub fn render(self, grades: &[Grade]) -> String {
                match self {
                    $(Self::$format => takes!($takes $render, grades),)*
                }
            }
        }
    };
}

formats! {
    /// For people.
    Text, "text", several without_colours;
    /// Our own, versioned (`schemas/grade.schema.json`).
    Json, "json", several |grades| json::render(grades, &[]);
    /// JUnit XML (`schemas/junit.xsd`).
    Junit, "junit", several |grades| junit::render(grades, &[]);
    /// Gradescope's results.json (`schemas/gradescope.schema.json`).
    Gradescope, "gradescope", one gradescope::render;
    /// PrairieLearn's results.json (`schemas/prairielearn.schema.json`).
    Prairielearn, "prairielearn", one prairielearn::render;
    /// GitHub Actions annotations.
    Github, "github", several github::annotations;
    /// A Markdown summary, for GitHub's step summary.
    Markdown, "markdown", several github::summary;
    /// One row per scene, for spreadsheets.
    Csv, "csv", several |grades| csv_table::scenes(grades, &[]);
    /// One file to look at ([`page::GradePage`](crate::page::GradePage)); without cards here, because these lie on a
    /// disk.
    Html, "html", one page;
}

/// The document for programs ([`Format::Json`]), alone: without what the other formats need.
#[must_use]
pub fn json(grades: &[Grade]) -> String {
    json::render(grades, &[])
}

impl Format {
    /// The format with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.name() == name)
    }

    /// The names of these formats, as a sentence lists them: `text, json or csv`.
    #[must_use]
    pub fn names(wanted: impl Fn(Self) -> bool) -> String {
        let wanted = Self::ALL.iter().copied().filter(|format| wanted(*format));
        let names: Vec<&str> = wanted.map(Self::name).collect();
        match names.split_last() {
            Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
            _ => names.concat(),
        }
    }
}

/// Lines for people, without colours.
fn without_colours(grades: &[Grade]) -> String {
    text::Text::default().render(grades)
}

/// A submission's page.
fn page(grade: &Grade) -> String {
    GradePage { grade, card: &|_| None, class: None, reader: Audience::Staff }.html()
}

pub use class::class;
pub(crate) use class::hardest;
pub use csv_table::submissions as csv_of_submissions;
pub(crate) use github::annotation;
pub use json::lines as json_lines;
pub use passed_over::{not_graded, warn_of};
pub(crate) use phrases::without_codes;
pub use phrases::{difference, head_lines, likely_mistakes, no_points, one_line, plain, points, printed, reached};
use phrases::{see_above, wrong_first};
pub(crate) use speed::speed_words;
pub use text::{Advice, Text, TextDetail, changes, score, shortened, table as text_table};

/// Renders a result in every format and throws that away: what fails here fails while the result's trace is still at
/// hand, and not when a whole class's reports are written. One that differs from the last one in nothing that could
/// fail is passed over: of a right submission, only the first scene is rehearsed.
pub fn rehearse(result: &SceneResult) {
    static LAST: Mutex<Option<SceneResult>> = Mutex::new(None);
    let kind = without_the_harmless(result);
    let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if last().as_ref() == Some(&kind) {
        return;
    }
    render_in_every_format(result);
    // Only what has not failed.
    *last() = Some(kind);
}

/// The result without what no renderer can stumble over: what was measured, numbers of steps that are all right, and
/// plain text.
fn without_the_harmless(result: &SceneResult) -> SceneResult {
    let mut kind = result.clone();
    kind.measured = Measurements { memory: kind.measured.memory.map(|_| 0), ..Measurements::default() };
    if kind.right_steps == kind.steps {
        (kind.right_steps, kind.steps) = (kind.steps.min(1), kind.steps.min(1));
    }
    for text in [&mut kind.scene, &mut kind.stdout, &mut kind.stderr] {
        let is_plain = |byte: &u8| byte.is_ascii_alphanumeric() || b" \n/-_.,:".contains(byte);
        if text.as_bytes().iter().all(is_plain) {
            text.truncate(1);
            *text = text.replace(|_| true, "x");
        }
    }
    kind
}

fn render_in_every_format(result: &SceneResult) {
    let scene = SceneGrade {
        settled: result.explanations.clone(),
        result: result.clone(),
        points: Some(0.0),
        max_points: 1.0,
        cached: false,
        agreed: 0,
    };
    let group = GroupGrade {
        hints: Hints::Full,
        speed: None,
        name: "group".to_owned(),
        visibility: Visibility::Visible,
        points: Some(0.0),
        max_points: 1.0,
        verdict: result.verdict,
        scenes: vec![scene],
    };
    let grade = Grade {
        submission: "submission".to_owned(),
        suite: "suite".to_owned(),
        rules: Rules::Both,
        verdict: result.verdict,
        points: group.points,
        max_points: group.max_points,
        groups: vec![group],
        refuted: Vec::new(),
        located: None,
        shows_output: true,
        build: None,
        warnings: Vec::new(),
        layers: Vec::new(),
        wall: result.measured.wall,
    };
    let grades = [grade];
    for format in Format::ALL {
        drop(format.render(&grades));
    }
    drop(csv_of_submissions(&grades, &[]));
}

#[cfg(test)]
mod formats;
#[cfg(test)]
pub(crate) mod samples;
