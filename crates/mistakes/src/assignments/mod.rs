//! Code that is bound to an assignment of the course, one folder each: the catalogue of mistakes, formulas as data,
//! probe scenes.
pub mod all;
pub mod rows;
pub mod states;
pub mod t2m2;

use fosssim_model::{assignments::Assignment, scene::Scene};
use t2m2::probes;

/// The probe scenes of an assignment, each with a name that can be a file's. They make every part of a program's work
/// visible, together with the scenes of its suite.
#[must_use]
pub fn probe_scenes(assignment: Assignment) -> Vec<(String, Scene)> {
    if assignment == Assignment::T2M2 { probes::scenes() } else { states::probes::scenes(assignment) }
}
