//! The verdict on one trace: the original's rules (`parity`), the fair ones (`fair`), findings, and the first
//! difference between the trace and the reference.
//!
//! The crate uses neither processes nor reports: it takes a scene and a reader, and returns findings. The rules
//! are those of `oracle-behavior.md`, sections 4 to 6.
//!
//! ```
//! use fosssim_judge::{Book, Ruling, replay};
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
//! let outcome = replay::judge(&scene, &trace[..], &replay::Options::default(), &mut ());
//! assert_eq!(outcome.ruling(Book::Parity), Ruling::Accepted);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

pub mod budget;
mod contacts;
pub mod fair;
pub mod kept_trace;
mod options;
pub mod overlap;
mod progress;
pub mod recording;
pub mod replay;
#[cfg(test)]
mod samples;
pub mod study;
mod tally;
mod wrong_coefficients;

pub use fosssim_findings::{
    Book, BookFindings, Damage, Finding, FindingCounts, FindingDetail, FindingKind, MissingResult, Outcome, Overall,
    PairText, Part, PassText, PolynomialPlace, PowerText, RecordPart, RescaledCoefficient, Residuals, Role, Rules,
    Ruling, Stop, count_whole_passes, parity,
};
use fosssim_findings::{counts, finding, outcome, rules};
pub use fosssim_model::trace::ReadFailure;
pub use wrong_coefficients::{find_differing_powers, find_factor};
