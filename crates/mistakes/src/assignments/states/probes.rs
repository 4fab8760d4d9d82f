//! Probe scenes of the milestones that log states: they show what the scenes of their suites leave open.
use fosssim_model::{
    assignments::Assignment,
    scene::{Scene, original},
};

/// Names and texts, with the milestone of each.
const PROBES: [(Assignment, &str, &str); 4] = [
    (Assignment::T1M3, "linear-with-drag", include_str!("probes/linear-with-drag.xml")),
    (Assignment::T2M1, "exact-touches", include_str!("probes/exact-touches.xml")),
    (Assignment::T2M1, "layers-of-half-planes", include_str!("probes/layers-of-half-planes.xml")),
    (Assignment::T2M3, "contest-of-corners", include_str!("probes/contest-of-corners.xml")),
];

/// The scenes of a milestone.
///
/// # Panics
/// When one is not sound; a test reads them all.
pub(in crate::assignments) fn scenes(assignment: Assignment) -> Vec<(String, Scene)> {
    let read = |(_, name, text): (Assignment, &str, &str)| {
        let loaded = original::read(text.as_bytes()).unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
        (name.to_owned(), loaded.scene)
    };
    PROBES.into_iter().filter(|(of, ..)| *of == assignment).map(read).collect()
}
