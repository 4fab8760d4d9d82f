//! The finding that a check looks at first.
use super::Check;
use fosssim_judge::Finding;
use fosssim_mistakes::diagnose::Explanation;

/// Where the trace is another scene's, nothing that differs is a mistake.
pub(super) fn is_other_scene(check: &Check<'_>) -> bool {
    check.explanations.iter().any(Explanation::is_other_scene)
}

/// The first finding that is worth a look: of the official book, or of the other one where the official has nothing.
pub(crate) fn first<'a>(check: &Check<'a>) -> Option<&'a Finding> {
    let other = check.outcome.fair.as_ref().and_then(|fair| fair.findings.first_divergence.as_ref());
    let first = check.outcome.findings_by(check.book()).first_divergence.as_ref().or(other);
    first.filter(|_| !is_other_scene(check))
}
