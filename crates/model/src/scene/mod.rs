//! The validated scene and its XML: model, reader, writer, and the original's lenient reader.
//!
//! This module does not use the simulator or the file system. It takes and returns text. The grammar is that of
//! `scene-format.md`.
//!
//! [`read`] is for authors of scenes: it reports all problems, with their positions and advice, and rejects scenes that
//! the original would silently misread. [`original::read`] is for compatibility: it accepts exactly what the original
//! accepts and rejects the rest in the original's words.

mod checks;
mod document;
mod element;
mod fields;
mod forces;
mod grammar;
mod milestones;
mod model;
mod numbers;
pub mod original;
mod problem;
mod reader;
mod rule;
mod tag;
#[cfg(test)]
mod tests;
mod write;
mod xml;

pub use crate::assignments::Integrator;
pub use checks::MAX_IMPLICIT_PARTICLES;
pub use grammar::find_closest;
pub use milestones::{UnknownFeature, UnknownPart};
pub use model::{
    Collision, CollisionDetection, Color, Display, Edge, Force, HalfPlane, Particle, ParticlePath, Scene, Viewport,
};
pub use problem::{MAX_PROBLEMS, Problem, Problems, Severity};
pub use reader::{LoadedScene, MAX_SCENE_BYTES, read};
pub use write::{collision_element, integrator_element, to_xml};
