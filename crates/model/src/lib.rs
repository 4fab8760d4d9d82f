//! Assignments, scenes, their simulation and its traces: [`assignments`], [`scene`], [`sim`] and [`trace`], from the
//! lowest module to the highest.
//!
//! A module imports only from modules listed before it. The arithmetic whose bits matter is below, in `fosssim-num`.
//!
//! ```
//! use fosssim_model::{
//!     scene,
//!     sim::{RootSearch, Simulation},
//! };
//!
//! let text = br#"<scene>
//!   <duration time="1"/> <integrator type="symplectic-euler" dt="0.25"/> <collision type="none"/>
//!   <particle m="1" px="0" py="0" vx="2" vy="0" fixed="0"/>
//! </scene>"#;
//! let scene = scene::read("a ball", text)?.scene;
//! let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
//! for _ in 0..scene.step_count() {
//!     simulation.step(&mut ())?;
//! }
//! assert_eq!(simulation.state().positions, [2.0, 0.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

pub mod assignments;

pub mod scene;

pub mod sim;

pub mod trace;
