//! The validated scene and its XML: model, reader, writer, and the original's lenient reader.
//!
//! Knows nothing of the simulator and never touches the file system: it takes and gives text. The grammar is that of
//! `scene-format.md`.

mod model;
pub mod original;

pub use model::{
    Collision, Color, Display, Edge, Force, HalfPlane, Integrator, Particle, ParticlePath, Scene, Viewport,
};
