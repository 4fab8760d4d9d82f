//! The state of all particles, and the pairs, contacts and impact zones of a step.
use fosssim_num::vector::Vec2;
use std::collections::BTreeSet;

/// The positions and velocities, each in the order `x0, y0, x1, y1, ...`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// The positions of all particles.
    pub x: Vec<f64>,
    /// The velocities of all particles.
    pub v: Vec<f64>,
}

/// A particle and an object with which it may collide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// The particle's index.
    pub particle: usize,
    /// The other object.
    pub object: Object,
}

/// An object that a particle may collide with, by its index among its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Object {
    /// The object is a second particle.
    Particle(usize),
    /// The object is an edge.
    Edge(usize),
    /// The object is a half-plane.
    HalfPlane(usize),
}

impl Object {
    /// Returns the number of the object's kind, as in traces, and its index.
    pub const fn numbers(self) -> (usize, usize) {
        match self {
            Self::Particle(index) => (0, index),
            Self::Edge(index) => (1, index),
            Self::HalfPlane(index) => (2, index),
        }
    }
}

/// A contact that detection found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// The particle and the object.
    pub pair: Pair,
    /// The shortest vector from the particle to the object at the time of impact, not normalized.
    pub n: Vec2,
    /// The time of impact as a fraction of the step.
    pub time: f64,
}

/// Particles that move together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Zone {
    /// The particles' indices.
    pub particles: BTreeSet<usize>,
    /// Whether a particle of the zone hits a half-plane.
    pub has_half_plane: bool,
}
