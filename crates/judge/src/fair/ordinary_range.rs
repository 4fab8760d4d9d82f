//! Finds the states with ordinary values.
use super::formulas::l1_norm;
use fosssim_model::{scene::Scene, sim::State};
use fosssim_num::{
    tolerances::FAIR_REACH_FACTOR,
    vector::{Vec2, vector_at},
};

/// The range of ordinary states of a scene. A state is outside if it exceeds a limit by more than
/// [`FAIR_REACH_FACTOR`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct OrdinaryRange {
    /// The largest size of a position.
    position: f64,
    /// The largest size of a velocity.
    velocity: f64,
    /// The smallest extent of all particles together.
    spread: f64,
}

impl OrdinaryRange {
    /// Returns the range around the scene's initial state, which contains most states.
    pub fn for_scene(scene: &Scene) -> Self {
        let radii = scene.particles.iter().map(|particle| l1_norm(particle.position) + particle.radius);
        let sizes = radii.chain(scene.half_planes.iter().map(|half_plane| l1_norm(half_plane.point)));
        let position = Some(sizes.fold(0.0, f64::max)).filter(|size| *size > 0.0).unwrap_or(1.0);
        let fastest = scene.particles.iter().map(|particle| l1_norm(particle.velocity)).fold(0.0, f64::max);
        let velocity = fastest.max(position / scene.time_step);
        let positions = scene.particles.iter().map(|particle| particle.position);
        Self { position, velocity, spread: spread(positions) }
    }

    /// Returns whether every value of the state is in the range.
    pub fn contains(&self, state: &State) -> bool {
        self.find_outside(state).is_none()
    }

    /// Returns the first particle whose state is outside the range, or particle 0 if all particles together are too
    /// close. Returns `None` if every value is in the range.
    pub(super) fn find_outside(&self, state: &State) -> Option<usize> {
        let particles = state.positions.len() / 2;
        let is_far = |value: f64, limit: f64| !(value <= FAIR_REACH_FACTOR * limit);
        let far_particle = (0..particles).find(|&particle| {
            is_far(l1_norm(vector_at(&state.positions, particle)), self.position)
                || is_far(l1_norm(vector_at(&state.velocities, particle)), self.velocity)
        });
        far_particle.or_else(|| (spread(positions(state)) * FAIR_REACH_FACTOR < self.spread).then_some(0))
    }

    /// Extends the range so that it contains a state that is known to be ordinary.
    pub(super) fn widen(&mut self, state: &State) {
        self.position = self.position.max(largest_size(&state.positions));
        self.velocity = self.velocity.max(largest_size(&state.velocities));
        self.spread = self.spread.min(spread(positions(state)));
    }
}

fn positions(state: &State) -> impl Iterator<Item = Vec2> {
    (0..state.positions.len() / 2).map(|particle| vector_at(&state.positions, particle))
}

/// Returns the largest [`l1_norm`] of a vector.
pub(super) fn largest_size(vectors: &[f64]) -> f64 {
    let all = (0..vectors.len() / 2).map(|index| l1_norm(vector_at(vectors, index)));
    all.fold(0.0, f64::max)
}

/// Returns the extent of all points together, or 0 for fewer than two points.
fn spread(points: impl Iterator<Item = Vec2>) -> f64 {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let [x, y] = points.fold([none; 2], |[x, y], point| [widen(x, point.x), widen(y, point.y)]);
    (x[1] - x[0]).max(y[1] - y[0]).max(0.0)
}

fn widen([low, high]: [f64; 2], value: f64) -> [f64; 2] {
    [low.min(value), high.max(value)]
}
