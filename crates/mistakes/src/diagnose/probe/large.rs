//! Probe scenes of many bodies and fractional masses: what takes several rounds of zones, and zones that turn very little or
//! very far.
use super::{ball, edge, half_plane, hybrid, post, scene};
use fosssim_model::scene::{Particle, Scene};

/// A heavy disc that comes 3 per step, and light ones at rest which its zone reaches one after the other; `offsets` are
/// theirs to the side.
fn row(y: f64, heavy: f64, masses: &[f64], offsets: &[f64]) -> Vec<Particle> {
    let mut all = vec![ball(0.0, y, 3.0, 0.0, heavy, 0.5)];
    let mut x = 2.0;
    for (mass, offset) in masses.iter().zip(offsets) {
        all.push(ball(x, y + offset, 0.0, 0.0, *mass, 0.25));
        x += 2.25;
    }
    all
}

/// Rows that are collected over many rounds: into the open, against a post, against the half-plane, against another row.
pub(super) fn rows_collected() -> Scene {
    let mut particles = row(0.0, 6.5, &[0.375, 0.5, 0.75, 0.125, 0.25], &[0.125, -0.0625, 0.0, 0.0625, -0.125]);
    particles.extend(row(8.0, 5.75, &[0.375, 0.25, 0.625], &[0.125, -0.125, 0.0625]));
    particles.push(post(8.75, 8.0, 0.0, 0.0, 1.0, 0.25));
    particles.extend(row(16.0, 6.5, &[0.375, 0.25, 0.25], &[0.0625, 0.0, -0.0625]));
    particles.extend(row(24.0, 6.5, &[0.25, 0.375], &[0.0, 0.125]));
    // The other row comes from the right.
    particles.extend(row(24.0, 7.25, &[0.375], &[-0.125]).into_iter().map(|mut disc| {
        disc.position.x = 12.0 - disc.position.x;
        disc.velocity.x = -disc.velocity.x;
        disc
    }));
    Scene { half_planes: vec![half_plane(9.5, 16.0, -2.0, -0.5)], ..scene(1, hybrid(0), particles) }
}

/// Zones of fractional masses that turn by less than a thousandth, by some, and by more than a right angle.
pub(super) fn small_and_large_turns() -> Scene {
    let little = 1.0 / 2048.0;
    Scene {
        edges: vec![edge(7, 8, 0.25)],
        ..scene(
            2,
            hybrid(0),
            vec![
                ball(0.0, 0.0, 1.25, 0.0, 0.375, 0.25),
                ball(1.5, little, 0.0, 0.0, 0.5, 0.5),
                ball(0.0, 8.0, 0.0, -1.0, 0.75, 0.5),
                ball(little, 6.75, 0.0, 0.0, 0.875, 0.25),
                ball(2.0 * little, 6.0, 0.0, 0.0, 0.125, 0.25),
                ball(8.0, 0.0, 0.25, 0.75, 1.625, 0.5),
                ball(8.0 + little, 1.25, 0.25, 0.0, 2.75, 0.5),
                ball(8.0, 8.0, 0.0, 0.0, 0.625, 0.25),
                ball(11.0, 8.0, 0.0, 0.0, 0.75, 0.25),
                ball(9.75, 9.25, 0.0, -1.0, 0.875, 0.25),
                ball(16.0, 0.0, 1.0, 0.0, 0.5, 0.5),
                ball(17.25, 0.5, 0.0, 0.0, 1.375, 0.5),
                ball(17.0, -0.75, 0.0, 0.0, 0.25, 0.25),
                ball(16.0, 8.0, 2.0, 0.0, 0.375, 0.5),
                ball(17.25, 8.75, -1.5, 0.0, 1.375, 0.5),
            ],
        )
    }
}
