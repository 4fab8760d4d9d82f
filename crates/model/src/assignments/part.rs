//! The parts of an assignment that a student writes. The starter library does the rest.
use super::{ForceKind, Integrator, PairKind};
use serde::{Deserialize, Serialize};

/// A part of a student's work: a function, or a few related functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Part {
    /// The kinetic energy, which traces do not contain.
    KineticEnergy,
    /// The step of an integrator.
    Integrator(Integrator),
    /// The gradient of a force.
    Force(ForceKind),
    /// The second derivatives of a force, with respect to positions and velocities.
    Jacobians(ForceKind),
    /// The detection at the end of a step.
    SimpleDetection(PairKind),
    /// The response to the detected overlaps.
    SimpleResponse(PairKind),
    /// The gradient of the penalty force.
    Penalty(PairKind),
    /// Continuous-time detection.
    Detection(PairKind),
    /// The loop of impulses.
    Impulses,
    /// The loop that moves impact zones.
    Zones,
    /// The rigid motion of one zone.
    Failsafe,
    /// The contest's search for nearby pairs.
    NearPairs,
}

impl Part {
    /// Returns the file in which the student submits the part.
    pub const fn file(self) -> &'static str {
        match self {
            Self::KineticEnergy => "TwoDScene.cpp",
            Self::Integrator(Integrator::ExplicitEuler) => "ExplicitEuler.cpp",
            Self::Integrator(Integrator::SymplecticEuler | Integrator::ForwardBackwardEuler) => "SymplecticEuler.cpp",
            Self::Integrator(Integrator::ImplicitEuler) => "ImplicitEuler.cpp",
            Self::Integrator(Integrator::LinearizedImplicitEuler) => "LinearizedImplicitEuler.cpp",
            Self::Force(kind) | Self::Jacobians(kind) => match kind {
                ForceKind::Spring => "SpringForce.cpp",
                ForceKind::SimpleGravity => "SimpleGravityForce.cpp",
                ForceKind::Gravitation => "GravitationalForce.cpp",
                ForceKind::Constant => "ConstantForce.cpp",
                ForceKind::Drag => "DragDampingForce.cpp",
                ForceKind::Vortex => "VortexForce.cpp",
            },
            Self::SimpleDetection(_) | Self::SimpleResponse(_) => "SimpleCollisionHandler.cpp",
            Self::Penalty(_) => "PenaltyForce.cpp",
            Self::Detection(_) => "ContinuousTimeCollisionHandler.cpp",
            Self::Impulses | Self::Zones | Self::Failsafe => "HybridCollisionHandler.cpp",
            Self::NearPairs => "ContestDetector.cpp",
        }
    }
}
