//! Scenes, traces and detections as pictures: SVG, PNG, animated PNG, GIF, plots, and small plots for terminals.
//!
//! Everything is a pure function from states and findings to bytes, or an encoder that is fed picture by picture:
//! nothing here opens a file, starts a process or reads a clock, and no more than two pictures are held at a time. The
//! same input gives the same bytes on every run: no fonts of the machine, no threads, no vector instructions chosen at
//! run time.
//!
//! A motion goes `Painter` (positions to [`shape::Shape`]s) to `svg` or `raster`, and from there to a `film`. Plots are
//! SVG made of numbers; they tell series apart by dash and marker and not by colour alone, and need no script.
#![forbid(unsafe_code)]

mod clip;
pub mod colour;
pub mod detection;
pub mod film;
mod font;
pub mod number;
pub mod painter;
pub mod plot;
pub mod raster;
pub mod shape;
pub mod size;
pub mod svg;
pub mod terminal;
pub mod view;

pub use painter::{Painter, PictureOptions};
pub use raster::Raster;
pub use size::Size;
pub use view::{Extent, View};
