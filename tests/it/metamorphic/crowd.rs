//! Random scenes of a few particles that do not overlap at the start and meet within a step.
use fosssim_oracle::{
    num::vector::Vec2,
    scene::{Collision, Display, Edge, HalfPlane, Integrator, Particle, Scene},
};
use proptest::{collection::vec, prelude::*};

/// The step size of all random scenes, in seconds.
pub const TIME_STEP: f64 = 0.25;

/// The properties of the wanted scenes.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// Collision handling.
    pub collision: Collision,
    /// Whether particles may be fixed.
    pub fixed: bool,
    /// Whether there may be half-planes.
    pub half_planes: bool,
    /// The number of steps.
    pub steps: u32,
}

/// Returns hybrid handling without a penalty force.
pub const fn hybrid(restitution: f64, max_iterations: i32) -> Collision {
    Collision::Hybrid { restitution, max_iterations, stiffness: 0.0, thickness: 0.0 }
}

/// Returns a scene without forces, with explicit Euler: all bodies move straight until they meet.
pub fn scene(steps: u32, collision: Collision, particles: Vec<Particle>) -> Scene {
    Scene {
        duration: f64::from(steps) * TIME_STEP,
        time_step: TIME_STEP,
        integrator: Integrator::ExplicitEuler,
        collision,
        particles,
        edges: Vec::new(),
        half_planes: Vec::new(),
        forces: Vec::new(),
        description: None,
        display: Display::default(),
    }
}

/// Returns a particle in a cell of the plane whose corner is set later. It moves by up to the width of a cell in a
/// step.
fn particle(fixed: bool) -> impl Strategy<Value = Particle> {
    let place = (-0.5..0.5, -0.5..0.5);
    let velocity = (-8.0..8.0, -8.0..8.0);
    (place, velocity, 0.25..4.0, 0.2..0.5, prop::bool::weighted(if fixed { 0.2 } else { 0.0 })).prop_map(
        |((x, y), (vx, vy), mass, radius, fixed)| Particle {
            position: Vec2::new(x, y),
            velocity: Vec2::new(vx, vy),
            mass,
            fixed,
            radius,
            tag: None,
        },
    )
}

/// Returns a half-plane near the particles.
fn half_plane() -> impl Strategy<Value = HalfPlane> {
    let part = || -2.0..6.0;
    ((part(), part()), (0.0..6.3), 0.3..4.0).prop_map(|((x, y), angle, length): ((f64, f64), f64, f64)| HalfPlane {
        point: Vec2::new(x, y),
        normal: Vec2::new(length * angle.cos(), length * angle.sin()),
    })
}

/// Returns three to seven particles in the cells of a square, with up to two edges between neighbors.
pub fn crowd(wanted: Wanted) -> impl Strategy<Value = Scene> {
    let planes = if wanted.half_planes { 0..2_usize } else { 0..1 };
    (vec(particle(wanted.fixed), 3..8), 0..3_usize, 0.05..0.2, vec(half_plane(), planes)).prop_map(
        move |(mut particles, edges, radius, half_planes)| {
            for (index, particle) in particles.iter_mut().enumerate() {
                let cell = Vec2::new([0.0, 2.0, 4.0][index % 3], [0.0, 2.0, 4.0][index / 3]);
                particle.position += cell;
            }
            let edges = edges.min(particles.len() / 2);
            Scene {
                edges: (0..edges).map(|index| Edge { first: 2 * index, second: 2 * index + 1, radius }).collect(),
                half_planes,
                ..scene(wanted.steps, wanted.collision, particles)
            }
        },
    )
}
