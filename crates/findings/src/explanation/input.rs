//! The inputs of a detection, in the assignment's notation.
use serde::{Deserialize, Serialize};

/// An input of a detection. In JSON, its name is its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Input {
    /// The position of the first body at the start of the step. In a pair of a particle and an edge, this is the
    /// particle.
    X1,
    /// The position of the second body at the start of the step. In a pair of a particle and an edge, this is the
    /// edge's first endpoint.
    X2,
    /// The position of the edge's second endpoint at the start of the step.
    X3,
    /// The displacement of the first body within the step.
    Dx1,
    /// The displacement of the second body within the step.
    Dx2,
    /// The displacement of the edge's second endpoint within the step.
    Dx3,
    /// The radius of the first particle.
    R1,
    /// The radius of the second particle.
    R2,
    /// The radius of the edge.
    Re,
    /// The position of the particle at the start of the step, in a pair with a half-plane.
    X,
    /// The displacement of the particle within the step, in a pair with a half-plane.
    Dx,
    /// A point on the boundary of the half-plane.
    P,
    /// The normal of the half-plane.
    N,
    /// The radius of the particle, in a pair with a half-plane.
    R,
}
