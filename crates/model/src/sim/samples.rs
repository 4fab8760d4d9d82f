//! Small scenes for the unit tests of the simulator.
use crate::scene::{Collision, Display, Edge, Force, HalfPlane, Integrator, Particle, Scene};
use fosssim_num::vector::Vec2;

/// Returns a free particle.
pub(crate) fn particle(position: (f64, f64), velocity: (f64, f64), mass: f64, radius: f64) -> Particle {
    Particle {
        position: Vec2::new(position.0, position.1),
        velocity: Vec2::new(velocity.0, velocity.1),
        mass,
        fixed: false,
        radius,
        tag: None,
    }
}

/// Returns a fixed copy of a particle.
pub(crate) fn fixed_copy(particle: Particle) -> Particle {
    Particle { fixed: true, ..particle }
}

/// Returns an edge.
pub(crate) fn edge(first: usize, second: usize, radius: f64) -> Edge {
    Edge { first, second, radius }
}

/// Returns a half-plane.
pub(crate) fn half_plane(point: (f64, f64), normal: (f64, f64)) -> HalfPlane {
    HalfPlane { point: Vec2::new(point.0, point.1), normal: Vec2::new(normal.0, normal.1) }
}

/// Returns a scene of the given particles: explicit Euler, dt 0.5, one step, no collision handling.
pub(crate) fn scene(particles: Vec<Particle>) -> Scene {
    Scene {
        duration: 0.5,
        time_step: 0.5,
        integrator: Integrator::ExplicitEuler,
        collision: Collision::None,
        particles,
        edges: Vec::new(),
        half_planes: Vec::new(),
        forces: Vec::<Force>::new(),
        description: None,
        display: Display::default(),
    }
}

/// A source of reproducible numbers in [-1, 1), by a linear congruential generator; quality does not matter here.
pub(crate) struct NumberSource(pub u64);

impl NumberSource {
    /// Returns the next number.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
        let fraction = (self.0 >> 11) as f64 / 9_007_199_254_740_992.0;
        2.0 * fraction - 1.0
    }

    /// Returns the next pair of numbers.
    pub fn next_pair(&mut self) -> (f64, f64) {
        let x = self.next();
        (x, self.next())
    }
}
