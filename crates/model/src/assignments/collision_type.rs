//! The collision types that scenes name (scene-format.md 2).

/// A collision type, without its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CollisionType {
    /// No handling.
    None,
    /// Impulses on overlap at the end of the step.
    Simple,
    /// A repelling force.
    Penalty,
    /// Continuous-time detection, one pass.
    ContinuousTime,
    /// Impulses, impact zones, rigid failsafe, and the penalty force.
    Hybrid,
}

impl CollisionType {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::None, Self::Simple, Self::Penalty, Self::ContinuousTime, Self::Hybrid];

    /// Returns the type's name in scenes: `continuous-time`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Simple => "simple",
            Self::Penalty => "penalty",
            Self::ContinuousTime => "continuous-time",
            Self::Hybrid => "hybrid",
        }
    }
}
