//! Commands with which a reader sees more of the first fault.
use super::{Check, first_finding};
use crate::{describe::pair_key, untrusted_text::quote};

/// The advice for a trace that is right.
const NEXT_IF_RIGHT: &str =
    "Check a trace of another scene, or run the program on a whole suite: fosssim-oracle grade ./FOSSSim";

/// Returns advice for a trace that both rule books accept; `None` for other traces.
pub(crate) fn suggest_next(check: &Check<'_>) -> Option<&'static str> {
    (check.is_accepted() && check.difference().is_none()).then_some(NEXT_IF_RIGHT)
}

/// Returns the commands in a form that can be typed. There are none if the trace is right, or if it came from standard
/// input and can't be read again.
pub(super) fn list_commands(check: &Check<'_>) -> Vec<String> {
    let Some(first) = first_finding::find_first(check).filter(|_| check.trace != "-") else { return Vec::new() };
    let (scene, trace, step) = (quote(check.scene), quote(check.trace), first.step);
    let mut commands = Vec::new();
    if let (Some(pair), 1..) = (first.detail.pair().map(pair_key), step) {
        let pass = match first.detail.pass().map_or(0, |pass| pass.index) {
            0 => String::new(),
            index => format!(" --pass {}", index + 1),
        };
        commands
            .push(format!("fosssim-oracle detect --scene {scene} --trace {trace} --step {step} --pair {pair}{pass}"));
    }
    commands.push(format!("fosssim-oracle trace show {scene} {trace} --step {step}"));
    if step > 0 {
        commands.push(format!("fosssim-oracle render {scene} {trace} --step {step} --output step{step}.svg"));
    }
    commands
}
