//! Probe scenes of `continuous-time`: what one pair does within a step.
use super::{PLASTIC, ball, edge, half_plane, post, scene};
use fosssim_model::scene::{Force, Scene};
use fosssim_num::vector::Vec2;

/// Eight discs of many sizes that pass through one another.
pub(super) fn drift_of_particles() -> Scene {
    scene(
        3,
        PLASTIC,
        vec![
            post(-7.0, 2.0, 3.0, 1.0, 1.0, 1.0),
            post(6.0, 5.0, -2.0, -1.0, 2.0, 2.0),
            post(1.0, -6.0, 1.0, 3.0, 3.0, 1.0),
            post(4.0, 9.0, -1.0, -4.0, 1.0, 3.0),
            post(-3.0, -8.0, 2.0, 3.0, 5.0, 2.0),
            post(11.0, -4.0, -5.0, 2.0, 1.0, 1.0),
            post(-9.0, 10.0, 4.0, -3.0, 2.0, 2.0),
            post(12.0, 13.0, -3.0, -5.0, 4.0, 1.0),
        ],
    )
}

/// Five edges that turn, stretch, shrink, slide and stand, and five discs among them.
pub(super) fn drift_of_edges() -> Scene {
    Scene {
        edges: vec![edge(0, 1, 1.0), edge(2, 3, 2.0), edge(4, 5, 1.0), edge(6, 7, 1.0), edge(8, 9, 1.0)],
        ..scene(
            3,
            PLASTIC,
            vec![
                post(-4.0, 1.0, 1.0, 2.0, 1.0, 1.0),
                post(5.0, -1.0, 2.0, -3.0, 1.0, 1.0),
                post(3.0, 7.0, -1.0, -2.0, 2.0, 2.0),
                post(9.0, 12.0, -3.0, -4.0, 1.0, 2.0),
                post(-10.0, -3.0, 4.0, 1.0, 1.0, 1.0),
                post(-2.0, -9.0, 1.0, 3.0, 3.0, 1.0),
                post(8.0, -8.0, -2.0, 3.0, 1.0, 1.0),
                post(13.0, -3.0, -2.0, 3.0, 1.0, 1.0),
                post(-12.0, 8.0, 0.0, 0.0, 1.0, 1.0),
                post(-5.0, 11.0, 0.0, 0.0, 1.0, 1.0),
                post(1.0, 5.0, 1.0, -3.0, 1.0, 1.0),
                post(-8.0, 6.0, 3.0, 2.0, 1.0, 2.0),
                post(6.0, -5.0, -4.0, 1.0, 1.0, 1.0),
                post(2.0, -11.0, 1.0, 5.0, 1.0, 2.0),
                post(-6.0, 3.0, 5.0, -1.0, 1.0, 1.0),
            ],
        )
    }
}

/// Three half-planes with normals of length 5, 2 and the root of 10, none through the origin, reached from either side.
pub(super) fn slanted_half_planes() -> Scene {
    Scene {
        half_planes: vec![
            half_plane(2.0, -6.0, 3.0, 4.0),
            half_plane(-20.0, 3.0, -2.0, 0.0),
            half_plane(3.0, 30.0, 1.0, -3.0),
        ],
        ..scene(
            2,
            PLASTIC,
            vec![
                ball(1.0, 1.0, -2.0, -6.0, 1.0, 1.0),
                ball(9.0, -20.0, 1.0, 9.0, 2.0, 2.0),
                ball(-14.0, 14.0, -5.0, 2.0, 3.0, 1.0),
                ball(-26.0, 16.0, 7.0, 1.0, 1.0, 2.0),
                post(-15.0, 4.0, -6.0, 1.0, 2.0, 1.0),
                ball(12.0, 25.0, 2.0, 9.0, 1.0, 2.0),
                ball(20.0, 44.0, -1.0, -9.0, 2.0, 1.0),
                ball(40.0, 20.0, 3.0, 1.0, 1.0, 1.0),
            ],
        )
    }
}

/// Collisions of two and three discs: unequal, oblique, with a fixed one, fast, overlapping from the start, parting.
pub(super) fn particles_meet() -> Scene {
    scene(
        2,
        PLASTIC,
        vec![
            ball(0.0, 0.0, 4.0, 0.0, 1.0, 1.0),
            ball(5.0, 1.0, -2.0, 0.0, 2.0, 1.0),
            // Against a post that stands, and one that comes along.
            ball(40.0, 0.0, 3.0, 0.0, 4.0, 1.0),
            post(44.0, 1.0, 0.0, 0.0, 1.0, 1.0),
            post(0.0, 80.0, 4.0, 0.0, 5.0, 1.0),
            ball(5.0, 81.0, -1.0, 0.0, 2.0, 2.0),
            // A row, each struck by the one before within the step.
            ball(0.0, 40.0, 5.0, 0.0, 1.0, 1.0),
            ball(4.0, 41.0, 0.0, 0.0, 2.0, 1.0),
            ball(7.0, 40.0, 0.0, 0.0, 3.0, 1.0),
            // Too fast to overlap at the end.
            ball(40.0, 40.0, 8.0, 1.0, 1.0, 0.5),
            ball(44.0, 40.0, 0.0, 0.0, 3.0, 0.25),
            // Parting, apart and overlapping; overlapping and approaching; approaching too slowly.
            ball(40.0, 80.0, -1.0, 0.0, 1.0, 1.0),
            ball(43.0, 80.0, 2.0, 0.0, 1.0, 1.0),
            ball(80.0, 0.0, -1.0, 0.0, 1.0, 1.0),
            ball(81.0, 0.0, 1.0, 0.0, 1.0, 1.0),
            ball(80.0, 40.0, 1.0, 0.0, 1.0, 1.0),
            ball(81.0, 41.0, -1.0, 0.0, 2.0, 1.0),
            ball(80.0, 80.0, 1.0, 0.0, 1.0, 1.0),
            ball(86.0, 80.0, -1.0, 1.0, 2.0, 1.0),
        ],
    )
}

/// Discs against edges that slide, turn and stretch, shrink about a fixed end, stand, and against a fixed disc.
pub(super) fn edges_struck() -> Scene {
    let edges = (0..6).map(|index| edge(3 * index, 3 * index + 1, [0.5, 0.25][index % 2])).collect();
    Scene {
        edges,
        ..scene(
            2,
            PLASTIC,
            vec![
                ball(0.0, 0.0, 0.0, 1.0, 2.0, 1.0),
                ball(8.0, 0.0, 0.0, 1.0, 3.0, 1.0),
                ball(2.0, 5.0, 1.0, -4.0, 1.0, 1.0),
                ball(40.0, 0.0, 1.0, -1.0, 4.0, 1.0),
                ball(48.0, 0.0, 3.0, 2.0, 1.0, 1.0),
                ball(46.0, 6.0, -1.0, -5.0, 2.0, 1.0),
                post(0.0, 40.0, 0.0, 0.0, 1.0, 1.0),
                ball(8.0, 40.0, -3.0, 1.0, 2.0, 1.0),
                ball(3.0, 36.0, 0.0, 4.0, 1.0, 0.5),
                post(40.0, 40.0, 0.0, 0.0, 1.0, 1.0),
                post(48.0, 44.0, 0.0, 0.0, 3.0, 1.0),
                ball(43.0, 47.0, 0.0, -5.0, 2.0, 1.0),
                ball(0.0, 80.0, 0.0, 5.0, 1.0, 0.5),
                ball(8.0, 80.0, 1.0, 3.0, 2.0, 0.5),
                post(3.0, 84.0, 0.0, 0.0, 3.0, 1.0),
                // Through and out again within the step.
                ball(40.0, 80.0, -1.0, 0.0, 3.0, 0.5),
                ball(47.0, 82.0, 0.0, 1.0, 2.0, 0.5),
                ball(45.0, 86.0, -2.0, -12.0, 1.0, 0.5),
            ],
        )
    }
}

/// Gravity changes the velocity within the step, after explicit Euler has moved everything with the old one: the mean
/// velocity of the motion, which responses go by, is not the one at the end.
pub(super) fn struck_while_falling() -> Scene {
    Scene {
        edges: vec![edge(2, 3, 0.5)],
        half_planes: vec![half_plane(0.0, -12.0, 0.0, 2.0)],
        forces: vec![Force::SimpleGravity { acceleration: Vec2::new(1.0, -4.0) }],
        ..scene(
            2,
            PLASTIC,
            vec![
                ball(0.0, 4.0, 1.0, -4.0, 1.0, 1.0),
                ball(0.5, 0.0, 0.0, 1.0, 2.0, 1.0),
                ball(20.0, 0.0, 0.0, 0.0, 2.0, 1.0),
                ball(28.0, 1.0, 0.0, 1.0, 1.0, 1.0),
                ball(23.0, 5.0, 1.0, -5.0, 3.0, 1.0),
                ball(40.0, -9.0, 2.0, -4.0, 1.0, 1.0),
            ],
        )
    }
}

/// Discs about the ends of edges: past them, in and out between start and end of the step, and within the edge's thickness
/// while they come round its end. The ends are smaller than the edges are thick, so that they do not get in the way.
pub(super) fn ends_of_edges() -> Scene {
    Scene {
        edges: vec![
            edge(0, 1, 0.25),
            edge(4, 5, 0.25),
            edge(8, 9, 2.0),
            edge(12, 13, 2.0),
            edge(16, 17, 2.0),
            edge(20, 21, 0.25),
        ],
        ..scene(
            1,
            PLASTIC,
            vec![
                // Past the first and past the second end.
                post(0.0, 0.0, 0.0, 0.0, 1.0, 0.25),
                post(8.0, 0.0, 0.0, 0.0, 1.0, 0.25),
                ball(-3.0, 4.0, 0.0, -8.0, 1.0, 1.0),
                ball(11.0, -4.0, 0.0, 8.0, 2.0, 1.0),
                // From outside to inside, and from inside to outside.
                post(40.0, 0.0, 0.0, 0.0, 1.0, 0.25),
                post(48.0, 0.0, 0.0, 0.0, 1.0, 0.25),
                ball(38.0, 3.0, 8.0, -4.0, 1.0, 1.0),
                ball(46.0, -3.0, 5.0, 5.0, 2.0, 1.0),
                // Close to the line already when it comes round the first end ...
                post(0.0, 40.0, 0.0, 0.0, 1.0, 0.125),
                post(8.0, 41.0, 0.0, 0.0, 1.0, 0.125),
                ball(-1.0, 41.5, 3.0, -0.5, 1.0, 0.25),
                ball(9.0, 39.5, -3.0, 0.5, 1.0, 0.25),
                // ... of an edge that turns.
                ball(40.0, 40.0, 0.0, 0.5, 2.0, 0.125),
                ball(47.0, 40.0, 1.0, -0.5, 3.0, 0.125),
                ball(39.0, 41.5, 3.0, -0.5, 1.0, 0.25),
                ball(49.0, 41.5, -5.0, -1.0, 1.0, 0.25),
                ball(0.0, 80.0, -0.5, 0.25, 2.0, 0.125),
                ball(7.0, 83.0, 1.0, 0.5, 3.0, 0.125),
                ball(-2.0, 81.0, 3.0, -0.25, 1.0, 0.25),
                ball(9.0, 82.0, -5.0, 0.25, 1.0, 0.25),
                // Beyond the end at the start; the edge grows so that it is struck.
                ball(40.0, 80.0, -3.0, 0.0, 2.0, 0.25),
                ball(48.0, 80.0, 0.0, 0.0, 3.0, 0.25),
                ball(39.0, 83.0, 0.0, -5.0, 1.0, 0.5),
            ],
        )
    }
}

/// Contacts at exactly the start and exactly the end of the step, for each kind of pair; one group each misses narrowly.
pub(super) fn contact_at_start_and_end() -> Scene {
    Scene {
        edges: vec![edge(6, 7, 0.25), edge(10, 11, 0.25)],
        half_planes: vec![half_plane(0.0, -16.0, 0.0, 2.0)],
        ..scene(
            1,
            PLASTIC,
            vec![
                ball(0.0, 0.0, 1.0, 0.0, 1.0, 1.0),
                ball(2.0, 0.0, 0.0, 0.0, 2.0, 1.0),
                ball(20.0, 0.0, 1.0, 0.0, 1.0, 1.0),
                ball(24.0, 0.0, -1.0, 0.0, 2.0, 1.0),
                ball(40.0, 0.0, 1.0, 0.0, 1.0, 1.0),
                ball(44.0, 0.0, -0.9375, 0.0, 2.0, 1.0),
                post(0.0, 20.0, 0.0, 0.0, 1.0, 0.25),
                post(8.0, 20.0, 0.0, 0.0, 1.0, 0.25),
                ball(2.0, 21.0, 1.0, -1.0, 1.0, 0.75),
                ball(6.0, 17.0, 0.0, 2.0, 1.0, 0.75),
                ball(20.0, 20.0, 0.0, 0.0, 1.0, 0.25),
                ball(28.0, 20.0, 0.0, 0.0, 3.0, 0.25),
                ball(22.0, 23.0, 0.0, -2.0, 2.0, 0.75),
                ball(0.0, -15.0, 0.0, -1.0, 1.0, 1.0),
                ball(8.0, -13.0, 0.0, -2.0, 1.0, 1.0),
                ball(16.0, -13.0, 0.0, -1.9375, 1.0, 1.0),
            ],
        )
    }
}
