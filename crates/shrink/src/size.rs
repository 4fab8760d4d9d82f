//! The size of a scene: the amount that its reader has to take in.
use crate::{clear::run, numbers::numbers};
use fosssim_model::scene::{Collision, Integrator, Scene};

/// The reference is asked about scenes of at most this many bodies and steps.
const FEW: usize = 8;
/// Digits of a number that is computed by hand.
const HANDY: usize = 3;

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
    /// Collisions that the reference detects.
    pub collisions: usize,
    /// Digits of all numbers that are not plain, such as a mass of 1, and those of the reference's last state as far as
    /// they are more than anybody computes by hand.
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
        for (quantity, _, value) in numbers(&mut copy) {
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
        let (collisions, computed) = outcome(scene);
        let fixed = scene.particles.iter().filter(|particle| particle.fixed).count();
        Self {
            steps: scene.steps(),
            bodies: scene.particles.len(),
            objects: scene.edges.len() + scene.half_planes.len(),
            forces: scene.forces.len(),
            features: effort(scene.integrator) + handling + fixed,
            collisions,
            digits: written + computed,
            magnitude,
        }
    }
}

/// Returns how many collisions the reference detects, and the digits of its last state that are too many.
fn outcome(scene: &Scene) -> (usize, usize) {
    if scene.particles.len().max(scene.steps() as usize) > FEW {
        return (0, 0);
    }
    let Some((decisions, end)) = run(scene) else { return (usize::MAX, 0) };
    let too_many = |value: &f64| written_digits(*value).saturating_sub(HANDY);
    (decisions.iter().filter(|(_, collides)| *collides).count(), end.iter().map(too_many).sum())
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
