//! A worker's task and its result, with the same form in the queue, over HTTP and in the database.
use crate::{
    schema::{Code, Decimal, ReportName},
    store::{Artifact, Digest},
};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The complete description of one grading. With the artifacts that it refers to, the grading can be repeated.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Task {
    /// The uploaded file, as stored.
    pub submission: Input,
    /// The suite for the grading.
    pub suite: Suite,
    /// The rule books, unless the suite decides: `parity`, `fair` or `both`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rules: Option<String>,
    /// The level of detail in reports, unless the suite decides: `none`, `where`, `what` or `full`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hints: Option<String>,
    /// The name of the program in a folder of sources.
    pub program: String,
    /// The number of seconds after which the grading is stopped; its results so far count.
    pub seconds: u64,
}

/// An uploaded file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Input {
    /// The upload's form.
    pub form: Form,
    /// The file's name, without dangerous characters.
    pub name: String,
    /// The upload's bytes.
    #[serde(flatten)]
    pub artifact: Artifact,
}

/// Declares the forms of submissions. A row has a form, its name in tables and messages, and a description of the
/// upload.
macro_rules! forms {
    ($($(#[$about:meta])+ $form:ident $name:literal $what:literal;)+) => {
        /// The forms of submissions.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
        #[serde(rename_all = "lowercase")]
        pub enum Form { $($(#[$about])+ $form,)+ }

        impl Form {
            /// All forms, in the order of declaration.
            pub const ALL: [Self; [$(Self::$form),+].len()] = [$(Self::$form),+];

            /// Returns the form's name in tables and messages.
            pub fn name(self) -> &'static str {
                match self { $(Self::$form => $name,)+ }
            }

            /// Returns a description of the upload.
            pub fn describe(self) -> &'static str {
                match self { $(Self::$form => $what,)+ }
            }
        }
    };
}

forms! {
    /// A program that can be run.
    Program "program" "a program for Linux";
    /// An archive of sources; the suite contains the commands to build it.
    Sources "sources" "an archive of sources";
    /// An archive of traces, one for each scene.
    Traces "traces" "an archive of traces";
}

impl Form {
    /// Returns the form with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.name() == name)
    }
}

/// A suite for grading a submission.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Suite {
    /// A suite of the grader, by name.
    Named(String),
    /// An archive with a `suite.toml` and its scenes, by digest.
    Archive(Digest),
}

impl Suite {
    /// Returns the suite's name, or the beginning of its digest.
    pub fn short(&self) -> String {
        match self {
            Self::Named(name) => name.clone(),
            Self::Archive(digest) => digest.short().to_owned(),
        }
    }
}

/// The result of a grading: the grader writes it, a worker reports it, and the service shows it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Outcome {
    /// The verdict as text.
    #[schema(max_length = 200)]
    pub verdict: String,
    /// The verdict's code: AC, WA, ...; JE means that the grader failed, and gives no points instead of zero.
    #[schema(value_type = Code)]
    pub code: String,
    /// The points, with exactly the grader's digits; `None` after a judge error.
    #[schema(value_type = Option<Decimal>)]
    pub points: Option<String>,
    /// The maximum number of points.
    #[schema(value_type = Option<Decimal>)]
    pub max_points: Option<String>,
    /// One line about the result.
    pub summary: String,
    /// The grader's version.
    pub version: String,
    /// The SHA-256 of the grader, if it is known.
    #[schema(pattern = "^([0-9a-f]{64})?$")]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub grader: String,
    /// The duration of the grading in seconds; missing while groups are withheld.
    #[schema(value_type = Decimal)]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub seconds: String,
    /// The reports and logs; empty in lists.
    pub files: Vec<OutputFile>,
    /// The part that students see while groups are withheld, in the form of [`ShownGrade`](crate::shown::ShownGrade);
    /// `None` until it was computed.
    #[serde(skip)]
    pub shown: Option<String>,
    /// The scenes that are not accepted, one line each with the verdict's code; `None` until they were computed.
    #[serde(skip)]
    pub failed: Option<String>,
    /// The points of groups and the likely mistakes, in the form of [`GradeParts`](crate::shown::GradeParts); `None`
    /// until they were computed.
    #[serde(skip)]
    pub parts: Option<String>,
}

impl Outcome {
    /// Returns the outcome of a job that was tried too often. The service is at fault, so the outcome has no points
    /// instead of zero. Only staff see the reason, which is in the job.
    pub fn judge_error() -> Self {
        Self {
            verdict: "judge error".to_owned(),
            code: JUDGE_ERROR.to_owned(),
            summary: "the grader failed, which is not the submission's fault; staff is informed".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            seconds: "0".to_owned(),
            shown: Some(String::new()),
            ..Self::default()
        }
    }
}

/// Returns a number of points with at most two decimals, for people.
pub fn round_points(number: impl ToString) -> String {
    let number = number.to_string();
    let Ok(value) = number.parse::<f64>() else { return number };
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The code of the verdict for failures of the grader, which gives no points instead of zero.
pub const JUDGE_ERROR: &str = "JE";

/// A file that the grader wrote: a report or a log.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct OutputFile {
    /// The file's name, such as `grade.json`.
    #[schema(value_type = ReportName)]
    pub name: String,
    /// The file's media type.
    pub media_type: String,
    /// The file's bytes, as stored.
    #[serde(flatten)]
    pub artifact: Artifact,
}
