//! The verdicts of the rule books, a line each; the tables behind them are shown on request.
use super::{Check, fair, follows};
use crate::{
    number::counted,
    style::{Look, Style},
};
use fosssim_judge::{Overall, fair::cause};

/// The section; nothing where the headline has said all.
pub(super) fn render(check: &Check<'_>, style: Style) -> Option<String> {
    let outcome = check.outcome;
    let judgement = outcome.fair.as_deref()?;
    let (look, word) = match outcome.parity.overall {
        Overall::Passed => (Look::Good, "passed"),
        Overall::Failed => (Look::Bad, "failed"),
        Overall::None => (Look::Notice, "no verdict"),
    };
    let counts = &outcome.parity.findings.counts;
    let mut found = match counts.total() {
        0 => String::new(),
        many => format!(": {}", counted(many, "finding")),
    };
    let follow = follows::count(outcome);
    if follow > 0 {
        found += &format!(", among them {}", follows::words(follow));
    }
    let mut text = format!("{}\n", style.paint(Look::Strong, "Rule books"));
    text += &format!("  the original's rules: {}{found}\n", style.paint(look, word));
    let (look, word) = fair::verdict(judgement);
    text += &format!("  the fair rules: {}: {}\n", style.paint(look, word), fair::summary(judgement, outcome));
    if let Some(cause) = cause(outcome) {
        text += &format!("  {} {cause}\n", style.paint(Look::Notice, "They differ:"));
    }
    Some(text)
}
