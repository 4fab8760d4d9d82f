//! Code that is bound to an assignment of the course, one folder each: the catalogue of mistakes, formulas as data,
//! probe scenes.
pub mod all;
pub mod rows;
pub mod states;
pub mod t2m2;

use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};

/// Returns the probe scenes of an assignment, each with a name that can be a file's. They make every part of a
/// program's work visible, together with the scenes of its suite.
///
/// # Panics
/// When a scene is not sound; a test reads them all.
#[must_use]
pub fn probe_scenes(assignment: Assignment) -> Vec<(String, Scene)> {
    let read = |&(name, text): &(&str, &str)| {
        let loaded = scene::read(name, text.as_bytes()).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        (name.to_owned(), loaded.scene)
    };
    let probes = match assignment {
        Assignment::T2M2 => t2m2::probes::PROBES,
        _ => states::probes::probes_for(assignment),
    };
    probes.iter().map(read).collect()
}
