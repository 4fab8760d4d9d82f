//! Probe scenes, which are small scenes that show every part of a program's work.
//!
//! Ordinary scenes hide mistakes: edges do not move, normals have length 1, nothing touches at the very end of a step.
//! A program can be run on the probe scenes instead. Each is about one part of the assignment. Independent groups of
//! bodies are far apart in one scene, so that few runs show much.
//!
//! Starts and displacements of particles are integers or small dyadic fractions. The step is half a second, in the
//! large scenes a quarter. In three scenes the step is not a power of two, which distinguishes velocities from
//! displacements. The first step's polynomials therefore have coefficients that can be checked by hand. In the `drift`
//! scenes this holds for every step, because moving fixed particles are never diverted (simulation.md 1). In the narrow
//! scenes, gaps are half a millionth and displacements are about four millionths. Any margin that a program adds to a
//! time or to the approach therefore shows.
//!
//! This module runs nothing and never judges. The scenes are the same every time.
/// Names and texts of the scenes: polynomials first, then contacts and responses, the impulse rounds, and zones. Each
/// is valid for the course's reader of scenes and for ours, and stays the same if it is read and written.
pub const PROBE_SCENES: &[(&str, &str)] = &[
    ("drift-of-particles", include_str!("probes/drift-of-particles.xml")),
    ("drift-of-edges", include_str!("probes/drift-of-edges.xml")),
    ("slanted-half-planes", include_str!("probes/slanted-half-planes.xml")),
    ("half-planes-all-around", include_str!("probes/half-planes-all-around.xml")),
    ("particles-meet", include_str!("probes/particles-meet.xml")),
    ("edges-struck", include_str!("probes/edges-struck.xml")),
    ("struck-while-falling", include_str!("probes/struck-while-falling.xml")),
    ("ends-of-edges", include_str!("probes/ends-of-edges.xml")),
    ("contact-at-start-and-end", include_str!("probes/contact-at-start-and-end.xml")),
    ("just-after-the-end", include_str!("probes/just-after-the-end.xml")),
    ("barely-closing", include_str!("probes/barely-closing.xml")),
    ("rounds-enough", include_str!("probes/rounds-enough.xml")),
    ("rounds-exactly-enough", include_str!("probes/rounds-exactly-enough.xml")),
    ("rounds-run-out", include_str!("probes/rounds-run-out.xml")),
    ("rounds-run-out-on-one", include_str!("probes/rounds-run-out-on-one.xml")),
    ("one-round-only", include_str!("probes/one-round-only.xml")),
    ("rounds-of-equal-number", include_str!("probes/rounds-of-equal-number.xml")),
    ("rounds-under-a-constant-force", include_str!("probes/rounds-under-a-constant-force.xml")),
    ("tiny-edges", include_str!("probes/tiny-edges.xml")),
    ("zones-of-all-kinds", include_str!("probes/zones-of-all-kinds.xml")),
    ("zones-that-grow", include_str!("probes/zones-that-grow.xml")),
    ("zones-reach-a-half-plane", include_str!("probes/zones-reach-a-half-plane.xml")),
    ("zones-of-fractional-masses", include_str!("probes/zones-of-fractional-masses.xml")),
    ("zones-collect-rows", include_str!("probes/zones-collect-rows.xml")),
    ("zones-of-long-edges", include_str!("probes/zones-of-long-edges.xml")),
    ("zones-turn-little-and-far", include_str!("probes/zones-turn-little-and-far.xml")),
    ("zones-in-other-steps", include_str!("probes/zones-in-other-steps.xml")),
    ("zones-under-drag", include_str!("probes/zones-under-drag.xml")),
];
