//! Which states are nothing out of the ordinary.
use super::formulas::extent;
use fosssim_model::{scene::Scene, sim::State};
use fosssim_num::{
    tolerances::FAIR_REACH,
    vector::{Vec2, at},
};

/// The smallest and the largest size of states.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    /// The largest position.
    pub(super) position: f64,
    /// The largest velocity.
    pub(super) velocity: f64,
    /// The least extent of all particles together.
    pub(super) spread: f64,
}

impl Range {
    /// The range of the scene's start.
    pub(super) fn of(scene: &Scene) -> Self {
        let radii = scene.particles.iter().map(|particle| extent(particle.position) + particle.radius);
        let sizes = radii.chain(scene.half_planes.iter().map(|half_plane| extent(half_plane.point)));
        let position = Some(sizes.fold(0.0, f64::max)).filter(|size| *size > 0.0).unwrap_or(1.0);
        let fastest = scene.particles.iter().map(|particle| extent(particle.velocity)).fold(0.0, f64::max);
        let velocity = fastest.max(position / scene.time_step);
        let places = scene.particles.iter().map(|particle| particle.position);
        Self { position, velocity, spread: spread(places) }
    }
}

/// The range with which a step's states are compared first; most need no other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ordinary(Range);

impl Ordinary {
    /// The range to expect from the scene's start.
    pub fn of(scene: &Scene) -> Self {
        Self(Range::of(scene))
    }

    /// Whether nothing in a state is out of the ordinary.
    pub fn holds(&self, state: &State) -> bool {
        beyond(&self.0, state).is_none()
    }
}

/// The first particle whose state is beyond what the range allows.
pub(super) fn beyond(range: &Range, state: &State) -> Option<usize> {
    let particles = state.positions.len() / 2;
    let is_far = |value: f64, most: f64| !(value <= FAIR_REACH * most);
    let far = (0..particles).find(|&particle| {
        is_far(extent(at(&state.positions, particle)), range.position)
            || is_far(extent(at(&state.velocities, particle)), range.velocity)
    });
    let places = || (0..particles).map(|particle| at(&state.positions, particle));
    far.or_else(|| (spread(places()) * FAIR_REACH < range.spread).then_some(0))
}

/// The extent of all points together; 0 of one point.
pub(super) fn spread(points: impl Iterator<Item = Vec2>) -> f64 {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let [x, y] = points.fold([none; 2], |[x, y], point| [widened(x, point.x), widened(y, point.y)]);
    (x[1] - x[0]).max(y[1] - y[0]).max(0.0)
}

fn widened([low, high]: [f64; 2], value: f64) -> [f64; 2] {
    [low.min(value), high.max(value)]
}
