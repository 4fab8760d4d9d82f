//! Correct programs that the judge or the explanations are known to get wrong.

/// Correct variants that the fair rules refuse, each with the scene, or with `probe/` and the probe scene. Tests and
/// matrices pass over these and over nothing else, and see to it that each is still refused; the goal is an empty list.
pub const KNOWN_REFUSED: &[(&str, &str)] = &[];

/// Correct variants that explanations accuse of something in some scene where they are asked all the same; the goal is
/// an empty list.
pub const KNOWN_ACCUSED: &[&str] = &[
    // More round-off than the explanations allow for, and then any formula will do.
    "frame-shifted",
    "frame-comoving",
];
