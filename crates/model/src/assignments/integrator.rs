//! The time integrators that scenes name (scene-format.md 4).

/// A time integrator (simulation.md 4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Integrator {
    /// `explicit-euler`
    ExplicitEuler,
    /// `forward-backward-euler`
    ForwardBackwardEuler,
    /// `symplectic-euler`: the same arithmetic and printed name as [`Integrator::ForwardBackwardEuler`].
    SymplecticEuler,
    /// `implicit-euler`, by Newton's method.
    ImplicitEuler,
    /// `linearized-implicit-euler`
    LinearizedImplicitEuler,
}

impl Integrator {
    /// All of them, in their order, with their names in scenes.
    pub const NAMED: [(&'static str, Self); 5] = [
        ("explicit-euler", Self::ExplicitEuler),
        ("forward-backward-euler", Self::ForwardBackwardEuler),
        ("symplectic-euler", Self::SymplecticEuler),
        ("implicit-euler", Self::ImplicitEuler),
        ("linearized-implicit-euler", Self::LinearizedImplicitEuler),
    ];

    /// Returns the integrator's name in scenes.
    #[must_use]
    pub const fn name(self) -> &'static str {
        Self::NAMED[self as usize].0
    }

    /// Returns whether it solves a system of equations in every step.
    #[must_use]
    pub const fn is_implicit(self) -> bool {
        match self {
            Self::ImplicitEuler | Self::LinearizedImplicitEuler => true,
            Self::ExplicitEuler | Self::ForwardBackwardEuler | Self::SymplecticEuler => false,
        }
    }
}
