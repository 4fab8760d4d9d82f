//! The inputs of a detection, as the assignment's notation calls them.
use serde::{Deserialize, Serialize};

/// An input of a detection; its name in JSON is its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Input {
    /// Where the first body is at the start of the step; of an edge and a particle, the particle.
    X1,
    /// Where the second body is; of an edge and a particle, the edge's first endpoint.
    X2,
    /// Where the edge's second endpoint is.
    X3,
    /// How far the first body goes within the step.
    Dx1,
    /// How far the second body goes.
    Dx2,
    /// How far the edge's second endpoint goes.
    Dx3,
    /// The first particle's radius.
    R1,
    /// The second particle's radius.
    R2,
    /// The edge's radius.
    Re,
    /// Where the particle beside a half-plane is at the start of the step.
    X,
    /// How far it goes within the step.
    Dx,
    /// A point on the half-plane's boundary.
    P,
    /// The half-plane's normal.
    N,
    /// The radius of the particle beside it.
    R,
}
