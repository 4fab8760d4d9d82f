//! The finding that a check shows first.
use super::{Check, follows::is_of_later_pass};
use fosssim_judge::Finding;
use fosssim_mistakes::diagnose::Explanation;

/// Returns whether the trace belongs to another scene, so that differences are not mistakes.
pub(crate) fn is_other_scene(check: &Check<'_>) -> bool {
    check.explanations.iter().any(Explanation::is_other_scene)
}

/// Returns the finding to show first: the official book's, or the other book's if the official book has none. A formula
/// of a later pass does not count as the first fault if the fair rules find another fault in its step. The fair rules
/// use the trace's own positions, and so distinguish a wrong formula from wrong positions.
pub(crate) fn find_first<'a>(check: &Check<'a>) -> Option<&'a Finding> {
    let fair = check.outcome.fair.as_ref().and_then(|fair| fair.findings.first_divergence.as_ref());
    let first = check.outcome.findings_by(check.book()).first_divergence.as_ref().or(fair)?;
    let cause = fair.filter(|fair| fair.step == first.step && is_of_later_pass(first));
    Some(cause.unwrap_or(first)).filter(|_| !is_other_scene(check))
}
