//! What is bound to an assignment of the course: its suite, and the template of suites. One folder each.
use fosssim_model::assignments::Assignment;

/// The commented suite to start from.
pub const TEMPLATE: &str = include_str!("t2m2/template.toml");

/// The text of an assignment's suite.
#[must_use]
pub const fn suite(assignment: Assignment) -> &'static str {
    match assignment {
        Assignment::Earlier => include_str!("earlier/suite.toml"),
        Assignment::T2M2 => include_str!("t2m2/suite.toml"),
    }
}
