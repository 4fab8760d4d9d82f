//! Arithmetic whose bits matter. The crate contains polynomials, the Jenkins-Traub root finder and first satisfaction
//! times. Certificates make a root search unnecessary, and decisions are valid with any rounding. Further modules
//! contain the linear solver of the implicit integrators, sparse least squares, elementary functions, and numbers as
//! C++ prints them.
//!
//! This crate uses no other crate of the project. It does not print, and uses no files or processes. Functions that run
//! per pair do not allocate, except for the integers of [`decision::exact`], which is the last resort. The mathematics
//! is that of `root-finder.md` (Jenkins and Traub, SIAM J. Numer. Anal. 7, 1970; Jenkins, Algorithm 493, ACM TOMS 1,
//! 1975), evaluated in the original's order.
//!
//! ```
//! use fosssim_num::{first_time::first_time, polynomial::Polynomial};
//!
//! // When are both t - 1/4 and 1 - t positive for the first time?
//! let both = [Polynomial::trimmed(&[1.0, -0.25]), Polynomial::trimmed(&[-1.0, 1.0])];
//! assert_eq!(first_time(&both).expect("a search that ends"), 0.25);
//! ```
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

pub mod bounded;
pub mod certificate;
mod closed_set;
pub mod decision;
pub mod elementary;
pub mod first_time;
pub mod interval;
pub mod lanes;
pub mod linear;
pub mod number_format;
pub mod number_serde;
pub mod polynomial;
pub mod rpoly;
pub mod sparse;
pub mod tolerances;
pub mod vector;
