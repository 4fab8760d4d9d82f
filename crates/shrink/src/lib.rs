//! Finds the smallest scene on which a program is still wrong for the same reason.
//!
//! Every step is judged from the submission's own state, so any wrong step is a scene of one step ([`step_starts()`]).
//! From there [`reduce`] removes bodies, edges, half-planes and forces, simplifies features, and takes rounder numbers,
//! as long as the program stays wrong for its [`WrongReason`]. The order of attempts is fixed, and the result is
//! 1-minimal: no single attempt makes it smaller (delta debugging, Zeller and Hildebrandt 2002).
//!
//! This crate runs no program and reads no clock. Its caller runs the program, and decides after each run whether to
//! continue.
//!
//! ```
//! use fosssim_ended::RunEnd;
//! use fosssim_student::{self as student, Mistake, Student};
//! use fosssim_model::{assignments::Assignment, scene};
//! use fosssim_shrink::{Observation, WrongReason, reduce, step_starts};
//!
//! let text = br#"<scene>
//!   <duration time="0.5"/> <integrator type="explicit-euler" dt="0.125"/> <collision type="none"/>
//!   <simplegravity fx="0.3" fy="-9.81"/>
//!   <particle m="2.5" px="0.37" py="1.25" vx="2.7" vy="-0.31" fixed="0"/>
//!   <particle m="1.5" px="-3.1" py="0.5" vx="-1.4" vy="0.62" fixed="0"/>
//! </scene>"#;
//! let scene = scene::read("two balls", text)?.scene;
//! let row = student::find("gravity-no-mass").expect("a row");
//! let run = |scene: &_| {
//!     let trace = student::record_trace(scene, Student::new(Some(row.mistake))).expect("a whole trace");
//!     Observation { trace, ended: RunEnd::Exited(0) }
//! };
//!
//! let reason = WrongReason::first_reason(&scene, &run(&scene)).expect("it is wrong");
//! let begin = step_starts(&scene, &run(&scene).trace, &[1]);
//! let mut is_reproduced = |scene: &_, is_only_reason| Some(reason.is_reproduced(scene, &run(scene), is_only_reason));
//! let found = reduce(&begin, Assignment::T1M1, &mut is_reproduced).expect("a scene");
//! assert_eq!((found.scene.step_count(), found.scene.particles.len()), (1, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod reason;
mod reducer;
mod reductions;
mod size;
mod step_starts;
#[cfg(test)]
mod tests;

pub use reason::{Observation, WrongReason};
pub use reducer::{RunProgram, SmallScene, reduce};
pub use step_starts::step_starts;
