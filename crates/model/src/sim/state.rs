//! The moving parts of a scene: positions and velocities.

/// Positions and velocities in trace order (`x0, y0, x1, y1, ...`), 2N each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Positions.
    pub positions: Vec<f64>,
    /// Velocities.
    pub velocities: Vec<f64>,
}
