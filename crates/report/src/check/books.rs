//! The verdicts of both rule books, one line for each.
use super::{Check, consequences, fair};
use crate::{
    number::{format_count, group_digits},
    style::{Style, TextStyle},
};
use fosssim_judge::{Overall, fair::find_cause};

/// The verdict of one rule book: the book's name, the style and the text of the verdict, and the reason for it.
pub(crate) type BookVerdict = (&'static str, TextStyle, &'static str, String);

/// Returns the verdicts of both books; `None` if the headline already contains them.
pub(crate) fn verdicts(check: &Check<'_>) -> Option<[BookVerdict; 2]> {
    let outcome = check.outcome;
    let judgment = outcome.fair.as_deref()?;
    let (look, verdict) = match outcome.parity.overall {
        Overall::Passed => (TextStyle::Right, "passed"),
        Overall::Failed if check.is_accepted() => (TextStyle::Notice, "failed"),
        Overall::Failed => (TextStyle::Wrong, "failed"),
        Overall::None => (TextStyle::Notice, "no verdict"),
    };
    let mut found: Vec<String> = Vec::new();
    let total = outcome.parity.findings.counts.total();
    found.extend((total > 0).then(|| format_count(total, "finding")));
    let follow = consequences::count_consequences(outcome);
    let describe =
        || format!("among them polynomials that are wrong only because of wrong positions: {}", group_digits(follow));
    found.extend((follow > 0).then(describe));
    let parity = ("the original's rules", look, verdict, found.join(", "));
    let (look, verdict) = fair::verdict(judgment);
    Some([parity, ("the fair rules", look, verdict, fair::summarize(judgment, outcome))])
}

/// Renders the section about the rule books; `None` if the headline already contains the verdicts.
pub(super) fn render(check: &Check<'_>, style: Style) -> Option<String> {
    let mut text = format!("{}\n", style.paint(TextStyle::Strong, "Rule books"));
    for (name, look, verdict, grounds) in verdicts(check)? {
        let grounds = if grounds.is_empty() { grounds } else { format!(": {grounds}") };
        text += &format!("  {name}: {}{grounds}\n", style.paint(look, verdict));
    }
    if let Some(cause) = find_cause(check.outcome) {
        text += &format!("  {} {cause}\n", style.paint(TextStyle::Notice, "They differ:"));
    }
    Some(text)
}
