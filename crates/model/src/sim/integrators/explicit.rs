//! explicit-euler (simulation.md 4): the positions move with the old velocities.
use super::{add_scaled, add_scaled_accelerations};
use crate::sim::{bodies::Bodies, state::State};

/// `x += h v`, then `v += h F / m`.
pub(super) fn advance(bodies: &Bodies, h: f64, force: &[f64], state: &mut State) {
    add_scaled(&mut state.positions, h, &state.velocities);
    add_scaled_accelerations(&mut state.velocities, h, force, &bodies.masses);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::samples::{fixed, particle, scene};

    #[test]
    fn positions_use_the_old_velocity_and_a_fixed_particle_keeps_moving() {
        let scene =
            scene(vec![particle((0.0, 0.0), (1.0, 0.0), 2.0, 0.1), fixed(particle((5.0, 0.0), (0.0, 3.0), 1.0, 0.1))]);
        let bodies = Bodies::new(&scene);
        let mut state = State { positions: vec![0.0, 0.0, 5.0, 0.0], velocities: vec![1.0, 0.0, 0.0, 3.0] };
        advance(&bodies, 0.5, &[4.0, 0.0, 0.0, 0.0], &mut state);
        assert_eq!(state.positions, [0.5, 0.0, 5.0, 1.5]);
        assert_eq!(state.velocities, [2.0, 0.0, 0.0, 3.0]);
    }
}
