//! The collision types of scenes (scene-format.md 2).

fosssim_num::closed_set! {
    /// A collision type, without its numbers.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum CollisionType {
        /// Collisions are not handled.
        None = "none",
        /// Impulses act on bodies that overlap at the end of the step.
        Simple = "simple",
        /// A repulsive force acts between bodies that are close to each other.
        Penalty = "penalty",
        /// One detection pass in continuous time responds to each impact.
        ContinuousTime = "continuous-time",
        /// Impulses, impact zones, the rigid failsafe and the penalty force handle collisions together.
        Hybrid = "hybrid",
    }
}
