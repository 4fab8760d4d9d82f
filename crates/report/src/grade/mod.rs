//! Renders grades in every format that courses use. All functions are pure, from [`Grade`] to text.
//!
//! Names and program output are untrusted text. Each format removes control characters with `strip_control_characters`
//! or `to_one_line` of `untrusted_text`, and escapes the characters that have a meaning in its syntax. A test sends
//! hostile text through every format.

mod causes;
mod changes;
mod class;
pub(crate) mod csv_table;
pub(crate) mod github;
pub(crate) mod gradescope;
pub(crate) mod json;
pub(crate) mod junit;
mod phrases;
pub(crate) mod prairielearn;
mod skipped_entries;
mod speed;
mod text;

use fosssim_findings::Grade;

/// Renders only the JSON document. The data for other formats are not computed.
pub fn json(grades: &[Grade]) -> String {
    json::render(grades, &[])
}

pub use causes::{AlikeScenes, clearest_scene, group_by_cause};
pub(crate) use causes::{is_listed, rank};
pub(crate) use changes::change_lines;
pub use class::render_class;
pub(crate) use class::{
    ClassFigures, SharedMistake, find_frequent, find_hardest, group_by_change, group_same_programs, has_never_run,
};
pub use csv_table::render_submissions as csv_of_submissions;
pub(crate) use json::GradeDocument;
pub use json::render_lines as json_lines;
use phrases::describe_repeated_reason;
pub use phrases::{
    describe_difference, describe_in_scene, describe_likely, describe_missing_points, describe_worth,
    find_likely_mistakes, format_optional_points, format_points, format_score, head_lines, scene_lines, scene_sentence,
};
pub(crate) use phrases::{
    describe_shared_worth, describe_wrong_count, describe_wrong_state, detail_likely, likely_heading,
};
pub use skipped_entries::{add_warnings, list_not_graded};
pub(crate) use speed::describe_speed;
pub use text::{Advice, Text, TextDetail, describe_extra_points, render_table as text_table, shorten_name};

#[cfg(test)]
pub(crate) mod samples;
