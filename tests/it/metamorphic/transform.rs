//! Changes of the coordinates and names of scenes and of simulation results.
use fosssim_oracle::{
    num::vector::{Vec2, set_vector, vector_at},
    scene::{Collision, Edge, Force, HalfPlane, Particle, Scene},
    sim::State,
};

/// A map of the plane: a matrix that turns or mirrors, a factor for all lengths, and a shift.
#[derive(Debug, Clone, Copy)]
pub struct Map {
    /// The rows of the matrix, which is orthogonal.
    pub rows: [[f64; 2]; 2],
    /// The factor of all lengths.
    pub factor: f64,
    /// The shift, which is added last.
    pub shift: [f64; 2],
}

impl Map {
    /// The map that changes nothing.
    pub const NONE: Self = Self { rows: [[1.0, 0.0], [0.0, 1.0]], factor: 1.0, shift: [0.0; 2] };

    /// Returns the turn by `angle`, counterclockwise, in radians.
    pub fn turn(angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        Self { rows: [[c, -s], [s, c]], ..Self::NONE }
    }

    /// Returns the image of a direction of any length, which stays the same.
    pub fn direction(&self, v: Vec2) -> Vec2 {
        let [a, b] = self.rows;
        Vec2::new(a[0] * v.x + a[1] * v.y, b[0] * v.x + b[1] * v.y)
    }

    /// Returns the image of a displacement, velocity or acceleration.
    pub fn vector(&self, v: Vec2) -> Vec2 {
        self.direction(v) * self.factor
    }

    /// Returns the image of a point.
    pub fn point(&self, p: Vec2) -> Vec2 {
        self.vector(p) + Vec2::new(self.shift[0], self.shift[1])
    }

    /// Returns -1 for a map that mirrors, otherwise 1.
    fn handedness(&self) -> f64 {
        let [a, b] = self.rows;
        if a[0] * b[1] < a[1] * b[0] { -1.0 } else { 1.0 }
    }

    fn force(&self, force: Force) -> Force {
        let k = self.factor;
        match force {
            Force::Spring { edge, stiffness, rest_length, damping } => {
                Force::Spring { edge, stiffness, rest_length: k * rest_length, damping }
            }
            Force::SimpleGravity { acceleration } => Force::SimpleGravity { acceleration: self.vector(acceleration) },
            Force::Gravitation { first, second, constant } => {
                Force::Gravitation { first, second, constant: k * k * k * constant }
            }
            Force::Constant { force } => Force::Constant { force: self.vector(force) },
            Force::Drag { .. } => force,
            Force::Vortex { first, second, strength, coupling } => {
                let strength = self.handedness() * k * strength;
                Force::Vortex { first, second, strength, coupling: k * k * coupling }
            }
        }
    }

    /// Returns the image of the scene.
    pub fn scene(&self, scene: &Scene) -> Scene {
        let k = self.factor;
        let particle = |particle: &Particle| Particle {
            position: self.point(particle.position),
            velocity: self.vector(particle.velocity),
            radius: k * particle.radius,
            ..particle.clone()
        };
        let collision = match scene.collision {
            Collision::Penalty { stiffness, thickness, detection } => {
                Collision::Penalty { stiffness, thickness: k * thickness, detection }
            }
            Collision::Hybrid { restitution, max_iterations, stiffness, thickness } => {
                Collision::Hybrid { restitution, max_iterations, stiffness, thickness: k * thickness }
            }
            other => other,
        };
        let half_plane =
            |plane: &HalfPlane| HalfPlane { point: self.point(plane.point), normal: self.direction(plane.normal) };
        Scene {
            collision,
            particles: scene.particles.iter().map(particle).collect(),
            edges: scene.edges.iter().map(|edge| Edge { radius: k * edge.radius, ..*edge }).collect(),
            half_planes: scene.half_planes.iter().map(half_plane).collect(),
            forces: scene.forces.iter().map(|&force| self.force(force)).collect(),
            ..scene.clone()
        }
    }

    /// Returns the image of the state.
    pub fn state(&self, state: &State) -> State {
        let mut mapped = state.clone();
        for index in 0..state.positions.len() / 2 {
            set_vector(&mut mapped.positions, index, self.point(vector_at(&state.positions, index)));
            set_vector(&mut mapped.velocities, index, self.vector(vector_at(&state.velocities, index)));
        }
        mapped
    }
}

/// Returns the scene with the ends of every edge exchanged.
pub fn with_ends_exchanged(scene: &Scene) -> Scene {
    let edges = scene.edges.iter().map(|edge| Edge { first: edge.second, second: edge.first, ..*edge }).collect();
    Scene { edges, ..scene.clone() }
}

/// Returns the scene with its particles in the opposite order.
pub fn with_particles_reversed(scene: &Scene) -> Scene {
    let new = |old: usize| scene.particles.len() - 1 - old;
    let force = |force: &Force| match *force {
        Force::Gravitation { first, second, constant } => {
            Force::Gravitation { first: new(first), second: new(second), constant }
        }
        Force::Vortex { first, second, strength, coupling } => {
            Force::Vortex { first: new(first), second: new(second), strength, coupling }
        }
        other => other,
    };
    Scene {
        particles: scene.particles.iter().rev().cloned().collect(),
        edges: scene
            .edges
            .iter()
            .map(|edge| Edge { first: new(edge.first), second: new(edge.second), ..*edge })
            .collect(),
        forces: scene.forces.iter().map(force).collect(),
        ..scene.clone()
    }
}

/// Returns the state of [`with_particles_reversed`].
pub fn reversed(state: &State) -> State {
    let turned = |array: &[f64]| array.chunks(2).rev().flatten().copied().collect();
    State { positions: turned(&state.positions), velocities: turned(&state.velocities) }
}
