//! The parts of the assignment.
use serde::{Deserialize, Serialize};

/// The part of the assignment to which a mistake belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Area {
    /// Polynomials of two particles.
    ParticleParticle,
    /// Polynomials of a particle and an edge.
    ParticleEdge,
    /// Polynomials of a particle and a half-plane.
    ParticleHalfPlane,
    /// What all three detections have in common: how polynomials reach the root finder.
    Handover,
    /// The vector between the objects at the time of impact.
    ContactVector,
    /// Which times count, and which pairs are looked at.
    Decision,
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
    /// What is written to the trace.
    Trace,
    /// How the program behaves as a process.
    Process,
}

impl Area {
    /// Its name in listings.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ParticleParticle => "particle-particle",
            Self::ParticleEdge => "particle-edge",
            Self::ParticleHalfPlane => "particle-half-plane",
            Self::Handover => "handover",
            Self::ContactVector => "contact-vector",
            Self::Decision => "decision",
            Self::Response => "response",
            Self::ContinuousTime => "continuous-time",
            Self::ImpulseLoop => "impulse-loop",
            Self::ImpactZones => "impact-zones",
            Self::Failsafe => "failsafe",
            Self::Trace => "trace",
            Self::Process => "process",
        }
    }
}
