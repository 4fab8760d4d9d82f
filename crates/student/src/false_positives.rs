//! Correct programs for which explanations are known to report mistakes.

/// Correct variants for which explanations report a mistake in some scene. Remove an entry when its
/// explanations are right.
pub const FALSE_POSITIVES: &[&str] = &[
    // More round-off than the explanations allow for, so that any formula fits.
    "frame-shifted",
    "frame-comoving",
];
