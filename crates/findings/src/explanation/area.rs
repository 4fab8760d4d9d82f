//! The parts of the assignment.
use serde::{Deserialize, Serialize};

/// The part of the assignment to which a mistake belongs. Listings have its name in JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Area {
    /// The forces that act on particles.
    Forces,
    /// Derivatives of forces by positions and velocities, for implicit integrators.
    Jacobians,
    /// How forces change velocities, and velocities positions.
    Integrator,
    /// The force between near bodies.
    Penalty,
    /// Which pairs reach the force between near bodies.
    NearPairs,
    /// Polynomials of two particles.
    ParticleParticle,
    /// Polynomials of a particle and an edge.
    ParticleEdge,
    /// Polynomials of a particle and a half-plane.
    ParticleHalfPlane,
    /// The common part of all three detections: how polynomials reach the root finder.
    Handover,
    /// The vector between the objects at the time of impact.
    ContactVector,
    /// Which times count, and which pairs are looked at.
    Decision,
    /// When bodies that overlap at the end of a step collide, and the vector between them.
    SimpleDetection,
    /// The impulse of one contact.
    Response,
    /// The single pass of `continuous-time`.
    ContinuousTime,
    /// The impulse rounds of `hybrid`.
    ImpulseLoop,
    /// Impact zones and their growth.
    ImpactZones,
    /// The rigid motion of one zone.
    Failsafe,
    /// The trace that is written.
    Trace,
    /// How the program behaves as a process.
    Process,
}
