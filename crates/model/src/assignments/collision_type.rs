//! The collision types of scenes (scene-format.md 2).

fosssim_num::closed_set! {
    /// A collision type, without its numbers.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum CollisionType {
        /// No collision handling.
        None = "none",
        /// Impulses on overlap at the end of the step.
        Simple = "simple",
        /// A repulsive force between bodies that are close to each other.
        Penalty = "penalty",
        /// Continuous-time detection, one pass.
        ContinuousTime = "continuous-time",
        /// Impulses, impact zones, rigid failsafe, and the penalty force.
        Hybrid = "hybrid",
    }
}
