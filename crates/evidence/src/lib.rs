//! The data that a viewer shows of a judged trace. They contain both motions, the reference's events in each step from
//! the trace's own state, and the detection calls of findings.
//!
//! This crate judges nothing; its caller provides the wrong steps ([`StepRulings`]). It reads the trace again and keeps
//! at most [`MAX_NUMBERS`] numbers, so the length of the trace is not limited. A step starts from the trace's own state
//! (oracle-behavior.md 4.2), uses the trace's mid record, and ends in the state that the reference computes from it.
//!
//! ```
//! use fosssim_evidence::{KeptPart, examine};
//! use fosssim_judge::replay::Options;
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
//! let options = Options { uses_fair_rules: true, ..Options::default() };
//! let examined = examine(&scene, &trace[..], KeptPart::All, &options, &mut ());
//! assert_eq!(examined.outcome.parity.findings.wrong_steps, 0);
//! assert!(examined.explain().is_empty());
//! assert_eq!(examined.trace.bytes(), trace);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod evidence;
mod examined_trace;
mod inspected_pair;
mod inspected_step;
mod polynomial_matching;
mod rulings;
#[cfg(test)]
mod tests;
mod track;

pub use evidence::{Evidence, Focus, Step, StepClass, gather};
pub use examined_trace::{ExaminedTrace, KeptPart, examine};
pub use inspected_pair::{InspectedPair, inspect};
pub use inspected_step::{CallLog, InspectedCall, InspectedPass, InspectedStep, MergedZones};
pub use rulings::{StepRuling, StepRulings};
pub use track::{MAX_NUMBERS, Track, Window};
