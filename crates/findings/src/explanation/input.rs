//! The inputs of a detection, in the assignment's notation.
use serde::{Deserialize, Serialize};

/// An input of a detection; its name in JSON is its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Input {
    /// The position of the first body at the start of the step; in a particle-edge pair, the particle's.
    X1,
    /// The position of the second body; in a particle-edge pair, the edge's first endpoint.
    X2,
    /// The position of the edge's second endpoint.
    X3,
    /// The displacement of the first body within the step.
    Dx1,
    /// The displacement of the second body.
    Dx2,
    /// The displacement of the edge's second endpoint.
    Dx3,
    /// The first particle's radius.
    R1,
    /// The second particle's radius.
    R2,
    /// The edge's radius.
    Re,
    /// The position of the particle near a half-plane at the start of the step.
    X,
    /// The displacement of the particle within the step.
    Dx,
    /// A point on the half-plane's boundary.
    P,
    /// The half-plane's normal.
    N,
    /// The radius of the particle near the half-plane.
    R,
}
