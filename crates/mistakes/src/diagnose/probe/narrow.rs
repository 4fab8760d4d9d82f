//! Probe scenes of narrow decisions: whatever a program adds to the time or to the approach as a margin shows.
use super::{PLASTIC, ball, edge, half_plane, post, scene};
use fosssim_model::scene::Scene;

/// Half a millionth of a step, as a gap of bodies that come closer by 1 per step.
const GAP: f64 = 1.0 / 2_097_152.0;

/// A displacement whose square the course's library keeps, and which closes a gap along 1/8 by less than a millionth.
const CREEP: f64 = 1.0 / 262_144.0;

/// Impacts of each kind of pair half a millionth of a step after its end.
pub(super) fn just_after_the_end() -> Scene {
    Scene {
        edges: vec![edge(2, 3, 0.25), edge(5, 6, 0.25)],
        half_planes: vec![half_plane(40.0, -3.0 - GAP, 0.0, 2.0)],
        ..scene(
            2,
            PLASTIC,
            vec![
                ball(0.0, 0.0, 1.0, 0.0, 1.0, 1.0),
                ball(3.0 + GAP, 0.0, 0.0, 0.0, 2.0, 1.0),
                post(16.0, 0.0, 0.0, 0.0, 1.0, 0.25),
                post(24.0, 0.0, 0.0, 0.0, 1.0, 0.25),
                ball(19.0, 2.0 + GAP, 0.0, -1.0, 1.0, 0.75),
                ball(0.0, 20.0, 0.0, 1.0, 2.0, 0.25),
                ball(8.0, 20.0, 0.0, 1.0, 3.0, 0.25),
                ball(3.0, 22.0 + GAP, 0.0, 0.0, 1.0, 0.75),
                ball(40.0, -1.0, 0.0, -1.0, 1.0, 1.0),
            ],
        )
    }
}

/// Bodies of each kind of pair that overlap already and approach by less than a millionth.
pub(super) fn barely_closing() -> Scene {
    Scene {
        edges: vec![edge(2, 3, 0.0625), edge(5, 6, 0.0625)],
        half_planes: vec![half_plane(0.0, -8.0, 0.0, 1.0)],
        ..scene(
            2,
            PLASTIC,
            vec![
                ball(0.0, 0.0, CREEP, 0.0, 1.0, 0.125),
                ball(0.125, 0.0, 0.0, 0.0, 2.0, 0.0625),
                post(3.0, 0.0, 0.0, 0.0, 1.0, 0.03125),
                post(5.0, 0.0, 0.0, 0.0, 1.0, 0.03125),
                ball(4.0, 0.125, 0.0, -CREEP, 1.0, 0.125),
                ball(7.0, 0.0, 0.0, CREEP, 1.0, 0.03125),
                ball(9.0, 0.0, 0.0, CREEP, 2.0, 0.03125),
                ball(8.0, 0.125, 0.0, 0.0, 4.0, 0.125),
                ball(0.0, -7.875, 0.0, -CREEP, 2.0, 0.1875),
            ],
        )
    }
}
