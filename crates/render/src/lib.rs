//! Draws scenes, traces and detections: SVG, PNG, GIF and plots.
//!
//! The functions turn states and findings into bytes, or encode picture by picture. They open no file, start no process
//! and read no clock, and keep at most two pictures in memory. The same input gives the same bytes on every run,
//! because there are no fonts of the machine, no threads, and no vector instructions chosen at run time.
//!
//! `Painter` turns the positions of a motion into [`shape::Shape`]s, `svg` or `raster` draws the shapes, and `film`
//! joins the pictures. Plots are SVG drawn from numbers. They distinguish series by dash and marker as well as by
//! color, and need no script.
//!
//! ```
//! use fosssim_render::{Extent, Painter, PictureOptions, Size, svg};
//! # use fosssim_model::{scene, sim::State};
//! # let text = br#"<scene>
//! #   <duration time="1"/> <integrator type="symplectic-euler" dt="0.25"/> <collision type="none"/>
//! #   <particle m="1" px="0" py="0" vx="2" vy="0" fixed="0"/>
//! # </scene>"#;
//! # let scene = scene::read("a ball", text)?.scene;
//! # let positions = [0.0, 0.0];
//! let (extent, size) = (Extent::for_scene(&scene, &positions), Size::new(320, 240)?);
//! let mut painter = Painter::new(&scene, &extent, PictureOptions { size, label: false });
//! let shapes = painter.picture(0, &positions, None);
//! assert!(svg::render_document(size, painter.background(), "a ball", &shapes).contains("<circle"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod clip;
pub mod color;
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
pub mod view;

pub use painter::{Painter, PictureOptions};
pub use raster::Raster;
pub use size::Size;
pub use view::{Extent, View};
