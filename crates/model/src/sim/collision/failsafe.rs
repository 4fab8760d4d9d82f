//! The rigid failsafe: an impact zone moves as one rigid body (collisions.md 5).
use super::super::{bodies::Bodies, observer::Zone};
use fosssim_num::{
    elementary::{cos, sin},
    vector::{Vec2, divide, set_vector, vector_at},
};

/// Moves the particles of `zone` from `q_start` by the zone's mean displacement and rotation; `q` and `v` receive their
/// new end positions and velocities. A zone with a half-plane or a fixed particle does not move.
///
/// A zone whose particles are all at one point has no moment of inertia, and becomes NaN as in the original.
pub(super) fn move_zone(bodies: &Bodies, dt: f64, zone: Zone<'_>, q_start: &[f64], q: &mut [f64], v: &mut [f64]) {
    let members = || zone.particles.iter().map(|&particle| particle as usize);
    if zone.half_plane || members().any(|particle| bodies.fixed[particle]) {
        for particle in members() {
            set_vector(q, particle, vector_at(q_start, particle));
            // The velocity is multiplied by zero, which keeps its sign and turns an infinity into NaN.
            set_vector(v, particle, vector_at(v, particle) * 0.0);
        }
        return;
    }
    let mut center = Vec2::zeros();
    let mut shift = Vec2::zeros();
    let mut mass = 0.0;
    for particle in members() {
        let (m, start) = (bodies.masses[particle], vector_at(q_start, particle));
        center += m * start;
        shift += m * (vector_at(q, particle) - start);
        mass += m;
    }
    let center = divide(center, mass);
    let shift = divide(shift, mass);
    let mut angular_momentum = 0.0;
    let mut inertia = 0.0;
    for particle in members() {
        let (m, start) = (bodies.masses[particle], vector_at(q_start, particle));
        let a = (vector_at(q, particle) - start) - shift;
        let s = start - center;
        angular_momentum += m * (s.x * a.y - s.y * a.x);
        inertia += m * s.dot(&s);
    }
    let angle = angular_momentum / inertia;
    let (c, s) = (cos(angle), sin(angle));
    for particle in members() {
        let start = vector_at(q_start, particle);
        let arm = start - center;
        let end = ((center + shift) + c * arm) + s * Vec2::new(-arm.y, arm.x);
        set_vector(q, particle, end);
        set_vector(v, particle, divide(end - start, dt));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::samples::{NumberSource, fixed_copy, particle, scene};
    use fosssim_num::vector::length;

    /// Distances within the zone equal those at the start, and the mean displacement is kept.
    #[test]
    fn a_zone_moves_rigidly_and_keeps_its_momentum() {
        let mut numbers = NumberSource(17);
        for _ in 0..500 {
            let masses: [f64; 4] = std::array::from_fn(|_| 1.5 + numbers.next());
            let start: [f64; 8] = std::array::from_fn(|_| numbers.next());
            let end: [f64; 8] = std::array::from_fn(|k| start[k] + 0.3 * numbers.next());
            let scene =
                scene((0..4).map(|p| particle((start[2 * p], start[2 * p + 1]), (0.0, 0.0), masses[p], 0.1)).collect());
            let bodies = Bodies::new(&scene);
            let (mut q, mut v) = (end, [9.0; 8]);
            move_zone(&bodies, 0.5, Zone { particles: &[0, 1, 3], half_plane: false }, &start, &mut q, &mut v);
            for (a, b) in [(0, 1), (0, 3), (1, 3)] {
                let before = length(vector_at(&start, a) - vector_at(&start, b));
                assert!((length(vector_at(&q, a) - vector_at(&q, b)) - before).abs() < 1e-14);
            }
            for axis in 0..2 {
                let sum = |q: &[f64; 8]| [0, 1, 3].map(|p| masses[p] * (q[2 * p + axis] - start[2 * p + axis]));
                let (before, after) = (sum(&end), sum(&q));
                assert!((before.iter().sum::<f64>() - after.iter().sum::<f64>()).abs() < 1e-14);
            }
            assert_eq!([q[4], q[5], v[4], v[5]], [end[4], end[5], 9.0, 9.0], "others stay");
            assert_eq!(v[0], (q[0] - start[0]) * 2.0);
        }
    }

    #[test]
    fn a_zone_with_a_fixed_particle_or_a_half_plane_stands_still() {
        let scene = scene(vec![
            particle((0.0, 0.0), (0.0, 0.0), 1.0, 0.1),
            fixed_copy(particle((1.0, 0.0), (0.0, 0.0), 1.0, 0.1)),
        ]);
        let bodies = Bodies::new(&scene);
        let start = [0.0, 0.0, 1.0, 0.0];
        for zone in [Zone { particles: &[0, 1], half_plane: false }, Zone { particles: &[0], half_plane: true }] {
            let (mut q, mut v) = ([0.5, 0.5, 1.0, 0.0], [-3.0, f64::INFINITY, 0.0, 0.0]);
            move_zone(&bodies, 0.5, zone, &start, &mut q, &mut v);
            assert_eq!(q, start);
            assert_eq!(v[0].to_bits(), (-0.0_f64).to_bits());
            assert!(v[1].is_nan());
        }
    }
}
