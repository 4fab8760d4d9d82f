//! The effects of a collision: the law of impact and the changes that a response makes (collisions.md 3, 6).
use super::super::bodies::Bodies;
use fosssim_num::vector::{Vec2, set_vector, vector_at};

/// The constants of every response of a scene.
#[derive(Debug, Clone, Copy)]
pub(super) struct ResponseConstants {
    /// The time step `dt`.
    pub time_step: f64,
    /// The factor `1/dt` that turns displacements into mean velocities.
    pub rate: f64,
    /// The factor `f = (1 + COR)/2`. The value 1 conserves the energy; the value 1/2 removes all velocity of approach.
    pub factor: f64,
}

impl ResponseConstants {
    /// Creates the law for a coefficient of restitution and a time step.
    pub fn new(restitution: f64, time_step: f64) -> Self {
        Self { time_step, rate: 1.0 / time_step, factor: (1.0 + restitution) / 2.0 }
    }

    /// Returns the mean velocity of a particle over the step, `(1/dt) (q_end - q_start)`. Responses of continuous-time
    /// detection use it instead of the state's velocity.
    #[inline]
    pub fn mean_velocity(&self, q_start: &[f64], q_end: &[f64], particle: usize) -> Vec2 {
        self.rate * (vector_at(q_end, particle) - vector_at(q_start, particle))
    }
}

/// The input of a response.
#[derive(Debug, Clone, Copy)]
pub(super) struct ResponseInput<'a> {
    /// The constants of the scene.
    pub bodies: &'a Bodies,
    /// The law of impact.
    pub law: &'a ResponseConstants,
    /// The positions at the start of the step.
    pub q_start: &'a [f64],
    /// The positions at the end of the step, before this response (hybrid: before all responses of the round).
    pub q_end: &'a [f64],
}

/// The change of one particle's velocity and end position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Change {
    /// The index of the particle.
    pub particle: usize,
    /// The change of the velocity.
    pub velocity: Vec2,
    /// The change of the position at the end of the step; `simple` ignores it.
    pub position: Vec2,
}

/// A response: the gain of the first object and the loss of the others. An entry is `None` if its particle is fixed or
/// missing.
///
/// Gain and loss are separate because the original adds one and subtracts the other, which affects the sign of a NaN.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Response {
    /// The change that is added to the first particle.
    pub gain: Option<Change>,
    /// The changes that are subtracted, in this order.
    pub loss: [Option<Change>; 2],
}

impl Response {
    /// Applies the response to velocities and end positions.
    pub fn apply(&self, q: &mut [f64], v: &mut [f64]) {
        self.change_entries(q, |change| change.position);
        self.apply_velocities(v);
    }

    /// Applies the response to velocities only (`simple`).
    pub fn apply_velocities(&self, v: &mut [f64]) {
        self.change_entries(v, |change| change.velocity);
    }

    fn change_entries(&self, array: &mut [f64], select: fn(&Change) -> Vec2) {
        if let Some(change) = &self.gain {
            set_vector(array, change.particle, vector_at(array, change.particle) + select(change));
        }
        for change in self.loss.iter().flatten() {
            set_vector(array, change.particle, vector_at(array, change.particle) - select(change));
        }
    }
}

/// Returns `alpha` clamped to [0, 1] by the original's comparisons: NaN and -0 become 0.
#[inline]
pub(super) fn clamp(alpha: f64) -> f64 {
    let alpha = if 0.0 < alpha { alpha } else { 0.0 };
    if alpha < 1.0 { alpha } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamping_turns_nan_into_zero() {
        assert_eq!([clamp(f64::NAN), clamp(-1.0), clamp(0.25), clamp(7.0)], [0.0, 0.0, 0.25, 1.0]);
    }

    #[test]
    fn the_factor_is_half_of_one_plus_restitution() {
        let law = ResponseConstants::new(0.5, 0.25);
        assert_eq!((law.factor, law.rate), (0.75, 4.0));
    }
}
