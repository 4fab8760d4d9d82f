//! Writes the original's closing text about residuals, and the text of `residual.txt` (oracle-behavior.md 6).
use crate::messages::{PINK, RESET};
use fosssim_judge::{Outcome, Overall, Residuals};
use fosssim_model::assignments::Definition;
use fosssim_num::number_format::format_g;

/// The original's names of the residuals, in its order.
const RESIDUAL_NAMES: [&str; 4] = [
    "Accumulated Position Residual",
    "Accumulated Velocity Residual",
    "Maximum Position Residual",
    "Maximum Velocity Residual",
];

/// Returns the lines after the file has been closed, with a verdict, or without one if grading did not finish.
/// `collisions` is the assignment's name for the verdict on collisions.
pub(crate) fn render_verdict(outcome: &Outcome, collisions: &str) -> String {
    if outcome.parity.overall == Overall::None {
        return describe_incomplete(&outcome.parity.residuals);
    }
    let mut text = String::new();
    for (name, (value, bound)) in RESIDUAL_NAMES.into_iter().zip(outcome.parity.residuals.with_bounds()) {
        text += &format!("{name}: {}   {}\n", format_g(value), describe_passed(value < bound));
    }
    let passed_collisions = if outcome.parity.collisions_passed == Some(true) { "Yes." } else { "No." };
    text += &format!("{collisions}: {passed_collisions}\n");
    text += &format!("Overall success: {}\n", describe_passed(outcome.parity.overall == Overall::Passed));
    text += &format!("{PINK}FOSSSim message: {RESET}Saved residual to residual.txt.\n");
    text
}

/// Returns the lines of a run that ended early.
pub(crate) fn describe_incomplete(residuals: &Residuals) -> String {
    let mut text = String::new();
    for (name, (value, _)) in RESIDUAL_NAMES.into_iter().zip(residuals.with_bounds()) {
        text += &format!("{name}: {}\n", format_g(value));
    }
    text += &format!(
        "{PINK}FOSSSim message: {RESET}Simulation did not run to completion. No pass/fail status will be reported.\n"
    );
    text
}

/// Returns the text of `residual.txt`. Each residual has a line with `1` or `0`, three spaces, and the value; in the
/// contest, a line about collisions follows. If grading did not finish, the result is `None`, and the file is not
/// written.
pub(crate) fn residual_file(outcome: &Outcome, assignment: &Definition) -> Option<String> {
    if outcome.parity.overall == Overall::None {
        return None;
    }
    let line = |(value, bound): (f64, f64)| format!("{}   {}\n", u8::from(value < bound), format_g(value));
    let mut text: String = outcome.parity.residuals.with_bounds().into_iter().map(line).collect();
    if assignment.prints_times {
        text += &format!("{}\n", u8::from(outcome.parity.collisions_passed == Some(true)));
    }
    Some(text)
}

const fn describe_passed(yes: bool) -> &'static str {
    if yes { "Passed." } else { "Failed." }
}
