//! Code that depends on an assignment of the course, one folder each: the catalog of mistakes, formulas as data,
//! probe scenes.
pub mod all;
pub mod rows;
pub mod states;
pub mod t2m2;

use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};

/// Returns the probe scenes of an assignment, each with a name that is valid for a file. Together with the scenes of
/// the suite they show every part of a program's work.
///
/// # Panics
/// Panics if a scene is not valid; a test reads all of them.
pub fn probe_scenes(assignment: Assignment) -> Vec<(String, Scene)> {
    let read = |&(name, text): &(&str, &str)| {
        let loaded = scene::read(name, text.as_bytes()).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        (name.to_owned(), loaded.scene)
    };
    let probes = match assignment {
        Assignment::T2M2 => t2m2::probes::PROBE_SCENES,
        _ => states::probes::probes_for(assignment),
    };
    probes.iter().map(read).collect()
}
