//! Two particles that make each other rotate (simulation.md 3, vortexforce).
//!
//! The force has no Hessians; `Simulation::step` rejects it with an implicit integrator (scene-format.md 6).
use super::{add, subtract};
use fosssim_num::vector::{Vec2, divide, length, vector_at};

/// Adds the gradient. `strength` is `kbs`, `coupling` is `kvc`.
pub(super) fn add_gradient(
    [a, b]: [usize; 2],
    strength: f64,
    coupling: f64,
    x: &[f64],
    v: &[f64],
    gradient: &mut [f64],
) {
    let d = vector_at(x, b) - vector_at(x, a);
    let r = length(d);
    let n = divide(d, r);
    let scaled_direction = strength * n;
    let turned = Vec2::new(-scaled_direction.y, scaled_direction.x);
    let slip = turned - (vector_at(v, b) - vector_at(v, a));
    let force = coupling * divide(slip, r * r);
    add(gradient, a, force);
    subtract(gradient, b, force);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_at_rest_are_driven_across_their_line() {
        let mut gradient = [0.0; 4];
        add_gradient([0, 1], 2.0, 3.0, &[0.0, 0.0, 1.0, 0.0], &[0.0; 4], &mut gradient);
        assert_eq!(gradient, [0.0, 6.0, 0.0, -6.0]);
    }
}
