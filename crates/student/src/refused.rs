//! Correct programs that the explanations are known to get wrong.

/// Correct variants that explanations accuse of something in some scene when called for them; the goal is an empty
/// list.
pub const KNOWN_ACCUSED: &[&str] = &[
    // More round-off than the explanations allow for, and then any formula will do.
    "frame-shifted",
    "frame-comoving",
];
