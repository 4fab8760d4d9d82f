//! Selects the finding that a check shows first.
use super::{Check, consequences::is_in_later_pass};
use fosssim_judge::Finding;
use fosssim_mistakes::diagnose::Explanation;

/// Returns whether the trace belongs to another scene, so that differences are not mistakes.
pub(crate) fn is_other_scene(check: &Check<'_>) -> bool {
    check.explanations.iter().any(Explanation::is_other_scene)
}

/// Returns the finding that the check shows first: the official book's first finding, or the other book's if the
/// official book has none. There is one exception. If the first fault is a formula in a later pass, and the fair rules
/// find another fault in its step, that other fault is returned. Because the fair rules start from the trace's own
/// positions, they can distinguish a wrong formula from wrong positions. Returns `None` if there is no finding, or if
/// the trace belongs to another scene.
pub(crate) fn find_first<'a>(check: &Check<'a>) -> Option<&'a Finding> {
    let fair = check.outcome.fair.as_ref().and_then(|fair| fair.findings.first_divergence.as_ref());
    let first = check.outcome.findings_by(check.book()).first_divergence.as_ref().or(fair)?;
    let cause = fair.filter(|fair| fair.step == first.step && is_in_later_pass(first));
    Some(cause.unwrap_or(first)).filter(|_| !is_other_scene(check))
}
