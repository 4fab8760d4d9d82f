//! The size of a scene: the amount that its reader has to take in.
use crate::numbers::numbers;
use fosssim_model::scene::{Collision, Integrator, Scene};

/// The size of a scene. The first field that differs decides which of two scenes is smaller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SceneSize {
    /// Steps.
    pub steps: u32,
    /// Particles.
    pub bodies: usize,
    /// Edges and half-planes.
    pub objects: usize,
    /// Forces.
    pub forces: usize,
    /// Features that are not the plainest: the integrator, the kind of collision handling, fixed bodies.
    pub features: usize,
    /// Digits of all numbers that are not plain, such as a mass of 1.
    pub digits: usize,
    /// The numbers' magnitudes and signs: among equals, 1 before 7 and 7 before -7.
    pub magnitude: u64,
}

impl SceneSize {
    /// Measures a scene.
    #[must_use]
    pub fn from_scene(scene: &Scene) -> Self {
        let mut copy = scene.clone();
        let (mut written, mut magnitude) = (0, 0);
        for (quantity, value) in numbers(&mut copy) {
            if *value != quantity.plain() {
                written += written_digits(*value);
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded, and no NaN")]
                let size = (value.abs() * 16.0).min(1e6) as u64;
                magnitude += 2 * size + u64::from(*value < 0.0);
            }
        }
        let handling = match scene.collision {
            Collision::None => 0,
            Collision::Simple { .. } | Collision::Penalty { .. } | Collision::ContinuousTime { .. } => 1,
            Collision::Hybrid { max_iterations, .. } => 2 + usize::from(max_iterations != 1),
        };
        let fixed = scene.particles.iter().filter(|particle| particle.fixed).count();
        Self {
            steps: scene.steps(),
            bodies: scene.particles.len(),
            objects: scene.edges.len() + scene.half_planes.len(),
            forces: scene.forces.len(),
            features: effort(scene.integrator) + handling + fixed,
            digits: written,
            magnitude,
        }
    }
}

/// Returns a rank of integrators: the work of a step by hand.
const fn effort(integrator: Integrator) -> usize {
    match integrator {
        Integrator::ExplicitEuler => 0,
        Integrator::SymplecticEuler => 1,
        Integrator::ForwardBackwardEuler => 2,
        Integrator::LinearizedImplicitEuler => 3,
        Integrator::ImplicitEuler => 4,
    }
}

/// Returns the digits of a number as it is written, without the zero before its point: 2 for 0.05, for 1.5 and for 10.
fn written_digits(value: f64) -> usize {
    let text = value.abs().to_string();
    text.strip_prefix("0.").unwrap_or(&text).chars().filter(char::is_ascii_digit).count()
}
