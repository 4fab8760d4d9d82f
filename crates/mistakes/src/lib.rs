//! Finds the likely mistake behind a wrong trace. [`diagnose`] names a mistake that a program of [`fosssim_student`]
//! makes, and [`together`] combines the scenes of one submission.
//!
//! ```
//! use fosssim_mistakes::diagnose;
//! # use fosssim_model::{scene, sim::{RootSearch, Simulation}, trace::{Layout, Recorder}};
//! # let text = br#"<scene>
//! #   <duration time="1"/> <integrator type="symplectic-euler" dt="0.25"/> <collision type="none"/>
//! #   <particle m="1" px="0" py="0" vx="2" vy="0" fixed="0"/>
//! # </scene>"#;
//! # let scene = scene::read("a ball", text)?.scene;
//! # let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
//! # let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(&scene), simulation.state());
//! # for _ in 0..scene.step_count() {
//! #     simulation.step(&mut recorder)?;
//! # }
//! # let (trace, _) = recorder.finish()?;
//!
//! // There is nothing to explain about a correct trace.
//! assert!(diagnose::explain(&scene, &trace).is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

pub mod diagnose;
pub mod together;
