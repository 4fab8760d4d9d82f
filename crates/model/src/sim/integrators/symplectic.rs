//! forward-backward-euler, also called symplectic-euler (simulation.md 4): the positions move with the new velocities.
use super::{add_scaled, add_scaled_accelerations};
use crate::sim::{bodies::Bodies, state::State};

/// `v += h F / m`, then `x += h v`.
pub(super) fn advance(bodies: &Bodies, h: f64, force: &[f64], state: &mut State) {
    add_scaled_accelerations(&mut state.velocities, h, force, &bodies.masses);
    add_scaled(&mut state.positions, h, &state.velocities);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::samples::{particle, scene};

    #[test]
    fn positions_use_the_new_velocity() {
        let bodies = Bodies::new(&scene(vec![particle((0.0, 0.0), (1.0, 0.0), 2.0, 0.1)]));
        let mut state = State { positions: vec![0.0, 0.0], velocities: vec![1.0, 0.0] };
        advance(&bodies, 0.5, &[4.0, 0.0], &mut state);
        assert_eq!(state.velocities, [2.0, 0.0]);
        assert_eq!(state.positions, [1.0, 0.0]);
    }
}
