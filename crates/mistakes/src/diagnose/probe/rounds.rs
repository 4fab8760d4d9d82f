//! Probe scenes of `hybrid`: what many pairs do within a step, in impulse rounds and zones.
use super::{ball, edge, half_plane, hybrid, post, scene};
use fosssim_model::scene::Scene;

/// Rows and crowds for the impulse rounds of `hybrid`, which five rounds resolve and one does not.
pub(super) fn impulse_rounds(max_iterations: i32) -> Scene {
    Scene {
        edges: vec![edge(4, 5, 0.5)],
        half_planes: vec![half_plane(0.0, -20.0, 1.0, 8.0)],
        ..scene(
            2,
            hybrid(max_iterations),
            vec![
                // A row that is struck at one end.
                ball(0.0, 0.0, 3.0, 0.0, 3.0, 1.0),
                ball(3.0, 0.5, 0.0, 0.0, 2.0, 1.0),
                ball(6.0, 0.0, 0.0, 0.0, 1.0, 1.0),
                ball(9.0, 0.5, 0.0, 0.0, 1.0, 1.0),
                // An edge between two discs.
                ball(30.0, 0.0, 0.0, 0.0, 2.0, 0.5),
                ball(38.0, 1.0, 0.0, 0.0, 3.0, 0.5),
                ball(32.0, 4.0, 0.0, -4.0, 1.0, 1.0),
                ball(36.0, -3.0, 0.0, 3.0, 2.0, 1.0),
                // One disc strikes two at once.
                ball(60.0, 0.0, 4.0, 0.0, 1.0, 1.0),
                ball(64.0, 1.25, 0.0, 0.0, 2.0, 1.0),
                ball(64.0, -1.25, 0.0, 0.0, 1.0, 1.0),
                // Onto the half-plane, and back into the next one.
                ball(0.0, -16.0, 0.0, -4.0, 1.0, 1.0),
                ball(0.5, -13.0, 0.0, -2.0, 4.0, 1.0),
            ],
        )
    }
}

/// The third round would find nothing any more, and there are exactly three; a fast disc overlaps nothing at the end.
pub(super) fn rounds_exactly_enough() -> Scene {
    scene(
        2,
        hybrid(3),
        vec![
            ball(0.0, 0.0, 3.0, 0.0, 1.0, 1.0),
            ball(4.0, 0.0, 0.0, 0.0, 1.0, 1.0),
            ball(6.5, 0.0, 0.0, 0.0, 2.0, 1.0),
            ball(0.0, 20.0, 12.0, 0.0, 1.0, 0.5),
            ball(5.0, 20.5, 0.0, 0.0, 4.0, 0.5),
        ],
    )
}

/// A disc between a post and one that closes in: no number of rounds is enough. Beside it a pair that needs just one.
pub(super) fn rounds_run_out() -> Scene {
    Scene {
        half_planes: vec![half_plane(0.0, -10.0, 0.0, 0.5)],
        ..scene(
            2,
            hybrid(2),
            vec![
                post(0.0, 0.0, 0.0, 0.0, 1.0, 1.0),
                ball(2.5, 0.25, -1.0, 0.0, 1.0, 1.0),
                post(6.0, 0.0, -2.0, 0.0, 1.0, 1.0),
                ball(20.0, 0.0, 3.0, 0.0, 1.0, 1.0),
                ball(24.0, 1.0, 0.0, 0.0, 3.0, 1.0),
                ball(30.0, -8.5, 0.0, -1.0, 1.0, 1.0),
                ball(30.5, -5.0, 0.0, -3.0, 4.0, 1.0),
            ],
        )
    }
}

/// Zones at once, without impulses: free ones that turn, with an edge, with something fixed, at a half-plane.
pub(super) fn zones_of_all_kinds() -> Scene {
    Scene {
        edges: vec![edge(8, 9, 1.0), edge(15, 16, 1.0)],
        half_planes: vec![half_plane(0.0, -20.0, 0.0, 2.0)],
        ..scene(
            2,
            hybrid(0),
            vec![
                ball(15.0, 12.0, 3.0, 0.0, 1.0, 1.5),
                ball(20.0, 14.0, 0.0, -0.25, 8.0, 1.5),
                ball(20.0, 10.5, 0.0, 0.5, 3.0, 1.5),
                ball(40.0, 0.0, 3.0, 1.0, 2.0, 1.0),
                post(44.0, 1.0, 0.0, 0.0, 5.0, 1.0),
                ball(0.0, -16.0, 1.0, -4.0, 1.0, 1.0),
                ball(1.0, -13.0, 0.0, -6.0, 2.0, 1.0),
                ball(8.0, -4.0, 1.0, 2.0, 1.0, 1.0),
                ball(60.0, 0.0, 0.0, 0.0, 2.0, 1.0),
                ball(68.0, 0.0, 1.0, 0.0, 3.0, 1.0),
                ball(63.0, 4.0, 0.0, -4.0, 1.0, 1.0),
                post(80.0, 0.0, 1.0, 0.0, 1.0, 1.0),
                ball(84.0, 0.0, -2.0, 1.0, 3.0, 1.0),
                // Two discs that meet one another and an edge, whose first end only the edge brings in.
                ball(102.0, 4.0, 0.0, -4.0, 1.0, 1.0),
                ball(105.0, 4.0, -2.0, -3.0, 2.0, 1.0),
                ball(98.0, 0.0, 0.0, 0.0, 2.0, 1.0),
                ball(108.0, 1.0, 0.0, 0.0, 3.0, 1.0),
            ],
        )
    }
}

/// Zones that run into more discs, into one another and into a post, round after round.
pub(super) fn zones_that_grow() -> Scene {
    scene(
        1,
        hybrid(0),
        vec![
            // A heavy disc collects a row.
            ball(0.0, 0.0, 3.0, 0.0, 8.0, 1.0),
            ball(3.0, 0.25, 0.0, 0.0, 1.0, 1.0),
            ball(7.5, 0.0, 0.0, 0.0, 1.0, 1.0),
            ball(11.5, 0.25, 0.0, 0.0, 1.0, 1.0),
            // Two zones meet.
            ball(0.0, 20.0, 4.0, 0.0, 8.0, 1.0),
            ball(4.0, 20.5, 0.0, 0.0, 1.0, 1.0),
            ball(11.0, 20.0, 0.0, 0.0, 1.0, 1.0),
            ball(15.0, 20.5, -4.0, 0.0, 8.0, 1.0),
            // A pair is pushed against a post.
            ball(40.0, 0.0, 4.0, 0.0, 6.0, 1.0),
            ball(44.0, 0.5, 0.0, 0.0, 1.0, 1.0),
            post(48.5, 0.0, 0.0, 0.0, 1.0, 1.0),
            // Two zones that stay apart.
            ball(40.0, 20.0, 3.0, 0.0, 1.0, 1.0),
            ball(44.0, 21.0, 0.0, 0.0, 2.0, 1.0),
            ball(40.0, 40.0, 3.0, 0.0, 3.0, 1.0),
            ball(44.0, 41.0, 0.0, 0.0, 1.0, 1.0),
        ],
    )
}

/// Zones that gain the half-plane with their second round, and one whose hits have to be joined twice.
pub(super) fn zones_reach_a_half_plane() -> Scene {
    Scene {
        half_planes: vec![half_plane(0.0, 0.0, 0.0, -4.0)],
        ..scene(
            2,
            hybrid(0),
            vec![
                // Hits in the order of detection: (0, 3), (1, 2), 1 on the half-plane, (2, 3).
                ball(0.25, 11.0, 0.0, -6.0, 1.0, 1.0),
                ball(0.0, 1.5, 0.0, -1.0, 2.0, 1.0),
                ball(0.5, 4.0, 0.0, -2.0, 3.0, 1.0),
                ball(0.0, 7.0, 0.0, -3.5, 4.0, 1.0),
                // A heavy disc carries a light one that rests into the half-plane.
                ball(20.0, 7.0, 0.0, -5.0, 4.0, 1.0),
                ball(20.5, 3.0, 0.0, 0.0, 1.0, 1.0),
                // The flag comes after the zone.
                ball(40.0, 5.0, 0.0, -3.0, 1.0, 1.0),
                ball(40.5, 2.0, 0.0, -1.5, 2.0, 1.0),
                // The flag comes before the last disc.
                ball(60.0, 1.5, 0.0, -1.0, 1.0, 1.0),
                ball(60.5, 4.0, 0.0, -2.0, 2.0, 1.0),
                ball(60.0, 7.0, 0.0, -3.5, 3.0, 1.0),
            ],
        )
    }
}

/// Rows whose masses are fractions, after one impulse round: zones that turn a little, and grow.
pub(super) fn zones_of_fractional_masses() -> Scene {
    scene(
        2,
        hybrid(1),
        vec![
            ball(0.0, 0.0, 3.0, 0.125, 6.5, 1.0),
            ball(3.0, 0.125, 0.0, 0.25, 0.75, 1.0),
            ball(5.5, 0.0, -0.25, 0.0, 1.25, 1.0),
            ball(8.0, 0.125, -1.0, 0.125, 2.5, 1.0),
            // Lighter than one each.
            ball(0.0, 20.0, 2.0, 0.125, 0.25, 1.0),
            ball(2.5, 20.5, 0.25, 0.0, 0.375, 1.0),
            ball(5.0, 20.0, -2.0, 0.25, 0.625, 1.0),
        ],
    )
}
