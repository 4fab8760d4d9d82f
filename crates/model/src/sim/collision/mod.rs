//! Collision handling: detection per pair type, responses, impact zones (collisions.md).
//!
//! One file per pair type contains its detection and its responses; `pass` visits all pairs, `blocks` many at a time;
//! `simple`, `continuous_time` and `hybrid` are the three handlers, of which `hybrid` uses `zones` and `failsafe`.
//! Nothing is pruned: every pair is checked in every pass, including two fixed particles (collisions.md 1).
mod blocks;
mod continuous_time;
mod failsafe;
mod hybrid;
mod impact;
mod motion;
mod particle_edge;
mod particle_half_plane;
mod particle_particle;
mod pass;
mod response;
mod simple;
mod zones;

/// The coefficients of the detection polynomials (collisions.md 2), generic over the number type: one number for a
/// pass, [lanes](fosssim_num::lanes), and numbers with bounds. Highest power first, with nothing dropped.
pub mod formulas {
    pub use super::{
        particle_edge::{
            EdgeMotions, EdgePolynomials as EdgeCoefficients, coefficients as particle_edge,
            coefficients_and_right_cubic as particle_edge_and_right_cubic,
        },
        particle_half_plane::coefficients as particle_half_plane,
        particle_particle::coefficients as particle_particle,
    };
}

use super::{
    bodies::Bodies,
    nearby::NearbyPairs,
    observer::Observer,
    search::{RootSearch, SearchCounts},
    state::State,
    step_error::StepError,
};
use crate::scene::{Collision, Scene};
use hybrid::HybridScratch;
pub use motion::{PairMotion, PointMotion};
use pass::Detector;
use response::ResponseConstants;

/// The scene's collision handling with its scratch memory.
#[derive(Debug, Clone)]
pub(super) struct Handler {
    kind: Collision,
    constants: ResponseConstants,
    detector: Detector,
    /// The broad phase of `simple`, which omits pairs that are apart.
    nearby: Option<NearbyPairs>,
    hybrid: HybridScratch,
}

impl Handler {
    /// Creates the handler of the scene's collision handling.
    pub fn new(scene: &Scene, search: RootSearch) -> Self {
        let is_simple = matches!(scene.collision, Collision::Simple { .. });
        Self {
            kind: scene.collision,
            constants: ResponseConstants::new(scene.collision.restitution(), scene.time_step),
            detector: Detector::new(search, scene.step_count()),
            nearby: is_simple.then(|| NearbyPairs::for_large_scene(scene, 0.0)).flatten(),
            hybrid: HybridScratch::default(),
        }
    }

    /// Handles the collisions of step `step`, which began at positions `q_start` and whose integration ended in
    /// `state`.
    ///
    /// # Errors
    /// Fails with [`StepError::RootSearch`] if a root search would never end, and with [`StepError::Work`] if the
    /// allowed work is exceeded. In both cases the state is unspecified.
    pub fn handle<O: Observer>(
        &mut self,
        bodies: &Bodies,
        step: u32,
        q_start: &[f64],
        state: &mut State,
        observer: &mut O,
    ) -> Result<(), StepError> {
        self.detector.begin_step(step);
        match self.kind {
            Collision::None | Collision::Penalty { .. } => Ok(()),
            Collision::Simple { .. } => {
                simple::handle(bodies, &self.constants, self.nearby.as_mut(), q_start, state, observer);
                Ok(())
            }
            Collision::ContinuousTime { .. } => {
                continuous_time::handle(bodies, &self.constants, &mut self.detector, q_start, state, observer)
            }
            Collision::Hybrid { max_iterations, .. } => {
                let detector = &mut self.detector;
                hybrid::handle(
                    bodies,
                    &self.constants,
                    max_iterations,
                    detector,
                    &mut self.hybrid,
                    q_start,
                    state,
                    observer,
                )
            }
        }
    }

    /// Sets the maximum work over all steps.
    pub fn limit_work(&mut self, max_work: u64) {
        self.detector.limit_work(max_work);
    }

    /// Computes the following pairs individually, without lanes.
    pub fn disable_lanes(&mut self) {
        self.detector.disable_lanes();
    }

    /// Returns the counts of root searches so far.
    pub fn counts(&self) -> SearchCounts {
        self.detector.counts()
    }
}
