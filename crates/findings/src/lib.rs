//! Data types for the judgment of a submission: findings, the outcome of judging a trace by both rule books,
//! explanations, results of scenes and grades.
//!
//! Every fact has one type, which all crates use: `judge` and `mistakes` create the values, `grading` stores them,
//! `report` and `server` read them. Serialized values are read back bit for bit. The data of an assignment (known
//! mistakes, formulas, letters) are named by their keys.
//!
//! Four types state whether something is accepted, because there are four kinds of results. [`parity::Overall`] has the
//! original's words for a trace, such as `passed`. [`fair::FairVerdict`] has the fair rules' words, such as `rejected`.
//! Published reports contain both, so the words stay different. [`Ruling`] expresses the result of either book in the
//! same words, and distinguishes damage from wrong answers. [`Verdict`] is about a whole run, because a program can
//! also crash or exceed a limit.
//!
//! A finding in words:
//!
//! ```
//! use fosssim_findings::{Finding, FindingDetail, FindingKind};
//!
//! let detail = FindingDetail::Position { particle: 2, expected: [0.5, 1.0], actual: [0.5, 1.25], residual: 0.25 };
//! let finding = Finding { step: 7, frame: 14, detail };
//! assert_eq!(finding.kind(), FindingKind::Position);
//! assert_eq!(finding.to_string(), "step 7: particle 2 ends at (0.5, 1.25), expected (0.5, 1), distance 0.25");
//! ```
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod book_findings;
mod cause;
pub mod changes;
pub mod counts;
pub mod disclosure;
pub mod earlier_grade;
pub mod explanation;
pub mod fair;
pub mod finding;
mod finding_text;
pub mod grade;
mod hints;
pub mod located_failure;
pub mod outcome;
pub mod parity;
pub mod result;
pub mod rules;
pub mod smallest_scene;
pub mod speed;
pub mod timing;
pub mod verdict;

pub use book_findings::BookFindings;
pub use cause::Cause;
pub use counts::FindingCounts;
pub use finding::{
    Finding, FindingDetail, FindingKind, FindingPlace, Part, PolynomialPlace, RecordPart, RescaledCoefficient, Role,
};
pub use finding_text::{MissingResult, PairText, PassText, PowerText, count_whole_passes, is_visible_ascii};
pub use grade::{Build, CourseNote, Grade, GroupGrade, SceneGrade, SkippedEntry, SubmissionFault, Visibility};
pub use hints::Hints;
pub use outcome::{Damage, Outcome, Stop};
pub use parity::{Overall, Residuals};
pub use result::{Reason, SceneResult};
pub use rules::{Book, Rules, Ruling};
pub use verdict::Verdict;
