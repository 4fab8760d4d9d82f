//! The moving parts of a scene: positions and velocities.
use crate::scene::Scene;

/// Positions and velocities in trace order (`x0, y0, x1, y1, ...`), 2N each.
#[derive(Debug, PartialEq, Default)]
pub struct State {
    /// The positions of all particles.
    pub positions: Vec<f64>,
    /// The velocities of all particles.
    pub velocities: Vec<f64>,
}

impl State {
    /// Returns the initial state of a scene.
    pub fn for_scene(scene: &Scene) -> Self {
        let mut state = Self::default();
        for particle in &scene.particles {
            state.positions.extend([particle.position.x, particle.position.y]);
            state.velocities.extend([particle.velocity.x, particle.velocity.y]);
        }
        state
    }

    /// Returns whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.positions.iter().chain(&self.velocities).all(|value| value.is_finite())
    }
}

/// Copies a state, and reuses the memory of an existing one.
impl Clone for State {
    fn clone(&self) -> Self {
        Self { positions: self.positions.clone(), velocities: self.velocities.clone() }
    }

    fn clone_from(&mut self, other: &Self) {
        self.positions.clone_from(&other.positions);
        self.velocities.clone_from(&other.velocities);
    }
}
