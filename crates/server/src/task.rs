//! The task that a worker receives, and the outcome that it returns. Both have the same form in the queue, over HTTP
//! and in the database.
use crate::{
    schema::{Code, Decimal, ReportName},
    store::{Artifact, Digest},
};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The complete description of one grading. The description and the artifacts that it names are enough to repeat the
/// grading.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Task {
    /// The uploaded file.
    pub submission: Input,
    /// The suite with which the submission is graded.
    pub suite: Suite,
    /// The rule books: `parity`, `fair` or `both`. If missing, the suite decides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rules: Option<String>,
    /// The level of detail in reports for students: `none`, `where`, `what` or `full`. If missing, the suite decides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hints: Option<String>,
    /// Whether reports show the smallest scenes on which a program is still wrong.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub smallest: bool,
    /// The name of the executable that a submission of sources builds.
    pub program: String,
    /// The number of seconds after which the grading is stopped. The results until then count.
    pub seconds: u64,
}

/// An uploaded file, which is graded.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Input {
    /// The form of the submission: a program, sources or traces.
    pub form: Form,
    /// The file's name, without dangerous characters.
    pub name: String,
    /// The digest and the size of the file in the store.
    #[serde(flatten)]
    pub artifact: Artifact,
}

/// Declares the forms of submissions. Each row has a form, the form's name in tables and messages, and a description of
/// what is uploaded.
macro_rules! forms {
    ($($(#[$about:meta])+ $form:ident $name:literal $what:literal;)+) => {
        /// The form in which a submission is uploaded.
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

            /// Returns a description of what is uploaded.
            pub fn describe(self) -> &'static str {
                match self { $(Self::$form => $what,)+ }
            }
        }
    };
}

forms! {
    /// A program that can be run.
    Program "program" "a program for Linux";
    /// An archive of source files. The suite contains the commands that build it.
    Sources "sources" "an archive of sources";
    /// An archive of traces, one for each scene.
    Traces "traces" "an archive of traces";
}

impl Form {
    /// Returns the form that is called `name` in tables and messages.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.name() == name)
    }
}

/// The suite with which a submission is graded.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Suite {
    /// A suite of the grader, given by its name.
    Named(String),
    /// An archive that contains a `suite.toml` and its scenes, given by its digest.
    Archive(Digest),
}

/// The codes of verdicts without a run, because the submission was unusable or could not be built.
pub const NEVER_RAN: [&str; 2] = ["US", "CE"];

/// The result of a grading. The grader writes it, a worker reports it, and the service shows it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Outcome {
    /// The verdict as text.
    #[schema(max_length = 200)]
    pub verdict: String,
    /// The code of the verdict, such as AC or WA. JE means that the grader failed; the submission then has no points,
    /// not zero points.
    #[schema(value_type = Code)]
    pub code: String,
    /// The points, with exactly the digits that the grader wrote; `None` if the grader failed.
    #[schema(value_type = Option<Decimal>)]
    pub points: Option<String>,
    /// The maximum number of points.
    #[schema(value_type = Option<Decimal>)]
    pub max_points: Option<String>,
    /// The result in one line.
    pub summary: String,
    /// The grader's version.
    pub version: String,
    /// The SHA-256 digest of the grader; empty if it is unknown.
    #[schema(pattern = "^([0-9a-f]{64})?$")]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub grader: String,
    /// The duration of the grading in seconds; missing while groups are withheld.
    #[schema(value_type = Decimal)]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub seconds: String,
    /// The reports and logs; empty in lists of submissions.
    pub files: Vec<OutputFile>,
    /// The part that students see while groups are withheld, in the form of
    /// [`VisibleGrade`](crate::visible_grade::VisibleGrade); `None` before it is computed.
    #[serde(skip)]
    pub shown: Option<String>,
    /// The scenes that are not accepted, one per line after the verdict's code; `None` before they are computed.
    #[serde(skip)]
    pub failed: Option<String>,
    /// The points of groups and the likely mistakes, in the form of [`GradeParts`](crate::visible_grade::GradeParts);
    /// `None` before they are computed.
    #[serde(skip)]
    pub parts: Option<String>,
}

impl Outcome {
    /// Returns whether a program ran, or traces were compared.
    pub fn has_run(&self) -> bool {
        !NEVER_RAN.contains(&self.code.as_str())
    }

    /// Returns the outcome of a job that was tried too often. Because the service is at fault, the outcome has no
    /// points, not zero points. The reason is stored with the job, and only staff see it.
    pub fn judge_error() -> Self {
        Self {
            verdict: "judge error".to_owned(),
            code: JUDGE_ERROR.to_owned(),
            summary: "the grader failed, which is not the submission's fault; staff are informed".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            seconds: "0".to_owned(),
            shown: Some(String::new()),
            ..Self::default()
        }
    }
}

/// Formats a number of points with at most two decimals.
pub fn format_points(number: impl ToString) -> String {
    let number = number.to_string();
    let Ok(value) = number.parse::<f64>() else { return number };
    // Databases round halves away from zero, too.
    let text = format!("{:.2}", (value * 100.0).round() / 100.0);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The verdict's code if the grader failed. The submission then has no points, not zero points.
pub const JUDGE_ERROR: &str = "JE";

/// A file that a grading produced: a report or a log.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct OutputFile {
    /// The file's name, such as `grade.json`.
    #[schema(value_type = ReportName)]
    pub name: String,
    /// The file's media type.
    pub media_type: String,
    /// The digest and the size of the file in the store.
    #[serde(flatten)]
    pub artifact: Artifact,
}
