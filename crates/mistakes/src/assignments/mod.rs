//! What is bound to an assignment of the course, one folder each: the catalogue of mistakes, formulas as data, probe
//! scenes.
pub mod t2m2;

use fosssim_model::{assignments::Assignment, scene::Scene};
use t2m2::{Row, probes};

/// The mistakes and variants of an assignment's programs. Programs of the earlier milestones are parts of the later
/// ones', and so are their mistakes.
#[must_use]
pub const fn catalogue(assignment: Assignment) -> &'static [Row] {
    match assignment {
        Assignment::T1M1
        | Assignment::T1M2
        | Assignment::T1M3
        | Assignment::T2M1
        | Assignment::T2M2
        | Assignment::T2M3 => t2m2::CATALOGUE,
    }
}

/// The probe scenes of an assignment, each with a name that can be a file's. They make every part of a program's work
/// visible; the other milestones have none, since they log nothing of what goes on within a step.
#[must_use]
pub fn probe_scenes(assignment: Assignment) -> Vec<(String, Scene)> {
    match assignment {
        Assignment::T1M1 | Assignment::T1M2 | Assignment::T1M3 | Assignment::T2M1 | Assignment::T2M3 => Vec::new(),
        Assignment::T2M2 => probes::scenes(),
    }
}
