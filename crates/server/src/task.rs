//! A worker's task and its answer: the same words in the queue, over HTTP and in the database.
use crate::{
    schema::{Code, Decimal, ReportName},
    store::{Artifact, Digest},
};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// One grading, complete: with this and the artifacts that it names it can be repeated.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Task {
    /// The upload.
    pub submission: Input,
    /// The suite that it is graded by.
    pub suite: Suite,
    /// The rule books, when the suite is not to decide: `parity`, `fair` or `both`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rules: Option<String>,
    /// The detail that the reports show, unless the suite decides: `none`, `where`, `what` or `full`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hints: Option<String>,
    /// The program's name within a folder of sources.
    pub program: String,
    /// The seconds after which the grading is stopped; its results so far count.
    pub seconds: u64,
}

/// The upload.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Input {
    /// The upload's form.
    pub form: Form,
    /// The file's name, made harmless.
    pub name: String,
    /// The upload's bytes.
    #[serde(flatten)]
    pub artifact: Artifact,
}

/// A row has a kind, its name in tables and messages, and what to hand in.
macro_rules! forms {
    ($($(#[$about:meta])+ $form:ident $name:literal $what:literal;)+) => {
        /// The kinds of submissions.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
        #[serde(rename_all = "lowercase")]
        pub enum Form { $($(#[$about])+ $form,)+ }

        impl Form {
            /// All submissions.
            pub const ALL: [Self; [$(Self::$form),+].len()] = [$(Self::$form),+];

            /// Returns the name in tables and messages.
            pub fn name(self) -> &'static str {
                match self { $(Self::$form => $name,)+ }
            }

            /// Returns the thing to hand in, in words.
            pub fn describe(self) -> &'static str {
                match self { $(Self::$form => $what,)+ }
            }
        }
    };
}

forms! {
    /// A program, ready to run.
    Program "program" "a program for Linux";
    /// An archive of sources, for which the suite has the build.
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

/// The suite that a submission is graded by.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Suite {
    /// A suite that comes with the program.
    Named(String),
    /// An archive with a `suite.toml` and its scenes.
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

/// The result of a grading: the grader makes it, a worker reports it and the service shows it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Outcome {
    /// The verdict in words.
    #[schema(max_length = 200)]
    pub verdict: String,
    /// The verdict in short: AC, WA, ...; JE is the grader's fault and no zero.
    #[schema(value_type = Code)]
    pub code: String,
    /// Points, digit for digit as the grader wrote them; none after a judge error.
    #[schema(value_type = Option<Decimal>)]
    pub points: Option<String>,
    /// The most that could be had.
    #[schema(value_type = Option<Decimal>)]
    pub max_points: Option<String>,
    /// One line about the result.
    pub summary: String,
    /// The grader's version.
    pub version: String,
    /// The SHA-256 of the grader, where it is known.
    #[schema(pattern = "^([0-9a-f]{64})?$")]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub grader: String,
    /// The time that it took, in seconds; missing while groups are withheld.
    #[schema(value_type = Decimal)]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub seconds: String,
    /// Reports and logs; empty in lists.
    pub files: Vec<OutputFile>,
    /// The part that students see while groups are withheld, as [`ShownGrade`](crate::shown::ShownGrade) keeps it;
    /// `None` until it was computed.
    #[serde(skip)]
    pub shown: Option<String>,
    /// The scenes that are not accepted, a line each with the verdict in short; `None` until they were computed.
    #[serde(skip)]
    pub failed: Option<String>,
    /// Points of groups and likely mistakes, as [`GradeParts`](crate::shown::GradeParts); `None` until they were
    /// computed.
    #[serde(skip)]
    pub parts: Option<String>,
}

impl Outcome {
    /// Returns the outcome of a job that was tried too often: the service's fault, and no zero. Only staff reads the
    /// reason, in the job.
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

/// Returns a number of points with two digits at most, for people.
pub fn round_points(number: impl ToString) -> String {
    let number = number.to_string();
    let Ok(value) = number.parse::<f64>() else { return number };
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The verdict that is no zero for the student.
pub const JUDGE_ERROR: &str = "JE";

/// A report or log.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct OutputFile {
    /// The file's name, `grade.json` for example.
    #[schema(value_type = ReportName)]
    pub name: String,
    /// The file's media type.
    pub media_type: String,
    /// The upload's bytes.
    #[serde(flatten)]
    pub artifact: Artifact,
}
