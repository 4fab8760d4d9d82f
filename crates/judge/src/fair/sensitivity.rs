//! The sensitivity of a step to round-off.

/// Largest deviations, component by component.
#[derive(Debug, Clone)]
pub(super) struct Deviation {
    /// Of positions, 2N.
    pub positions: Vec<f64>,
    /// Of velocities, 2N.
    pub velocities: Vec<f64>,
}

/// The sensitivity of a step, as far as it was measured.
#[derive(Debug, Clone)]
pub(super) struct Sensitivity {
    /// For each detection pass the deviation of the positions that it sees, 2N each.
    pub passes: Vec<Vec<f64>>,
    /// Deviation of the state at the synchronisation point.
    pub mid: Deviation,
    /// Deviation of the state at the end.
    pub end: Deviation,
    /// Calls whose decisions flip.
    pub flipped: Vec<usize>,
}
