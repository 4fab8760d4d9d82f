//! The inputs of a detection, as the assignment's notation calls them.
use serde::{Deserialize, Serialize};

/// An input of a detection; its name in JSON is its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Input {
    /// The position of the first body at the start of the step; for an edge and a particle, the particle's.
    X1,
    /// The position of the second body; for an edge and a particle, that of the edge's first endpoint.
    X2,
    /// The position of the edge's second endpoint.
    X3,
    /// The motion of the first body within the step.
    Dx1,
    /// The motion of the second body.
    Dx2,
    /// The motion of the edge's second endpoint.
    Dx3,
    /// The first particle's radius.
    R1,
    /// The second particle's radius.
    R2,
    /// The edge's radius.
    Re,
    /// The position of the particle near a half-plane at the start of the step.
    X,
    /// The motion of the particle within the step.
    Dx,
    /// A point on the half-plane's boundary.
    P,
    /// The half-plane's normal.
    N,
    /// The radius of the particle near the half-plane.
    R,
}
