//! The validated scene and its XML: model, reader, writer, and the original's lenient reader.
//!
//! Knows nothing of the simulator and never touches the file system: it takes and gives text. The grammar is that of
//! `scene-format.md`.
//!
//! [`read`] is for people: it reports everything that is wrong, with places and advice, and rejects what the original
//! would silently take for something else. [`original::read`] is for compatibility: it accepts exactly what the
//! original accepts and rejects the rest in the original's words.

mod checks;
mod document;
mod element;
mod fields;
mod forces;
mod grammar;
mod known;
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
pub use checks::LARGEST_IMPLICIT;
pub use grammar::closest;
pub use known::{UnknownFeature, UnknownPart};
pub use model::{
    Collision, CollisionDetection, Color, Display, Edge, Force, HalfPlane, Particle, ParticlePath, Scene, Viewport,
};
pub use problem::{MOST_PROBLEMS, Problem, Problems, Severity};
pub use reader::{LARGEST_SCENE, LoadedScene, read};
pub use write::{collision_element, integrator_element, write};
