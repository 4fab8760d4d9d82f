//! The scene for the simulator, as plain values. Every index is valid if the strict reader read the scene.
use crate::assignments::{Assignment, CollisionHandling, CollisionType, Integrator};
use fosssim_num::vector::Vec2;

/// A scene: the bodies, the duration, the integrator and the collision handling.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The simulated time in seconds.
    pub duration: f64,
    /// The time step `dt` in seconds.
    pub time_step: f64,
    /// The time integrator.
    pub integrator: Integrator,
    /// The collision handling.
    pub collision: Collision,
    /// Particles in document order; their position in this list is their index.
    pub particles: Vec<Particle>,
    /// Edges in document order.
    pub edges: Vec<Edge>,
    /// Half-planes in document order.
    pub half_planes: Vec<HalfPlane>,
    /// Forces **in the order in which they act**: springs, simple gravity, gravitation, constant, drag, vortex; each
    /// kind in document order (simulation.md 2).
    pub forces: Vec<Force>,
    /// The text of the banner, if the scene has one.
    pub description: Option<String>,
    /// The values that only a display uses.
    pub display: Display,
}

impl Scene {
    /// Returns the number of steps as the original computes it: the 32-bit conversion of `ceil(duration / dt)`; zero,
    /// negative and unrepresentable quotients give no step (scene-format.md 4).
    pub fn step_count(&self) -> u32 {
        let quotient = (self.duration / self.time_step).ceil();
        // Outside the 32-bit range (and for NaN) the processor's conversion gives -2147483648, so there are no steps.
        if quotient >= 1.0 && quotient <= f64::from(i32::MAX) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked just above")]
            let steps = quotient as u32;
            steps
        } else {
            0
        }
    }
}

/// Collision handling (collisions.md).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Collision {
    /// Collisions are not handled, and records contain only positions and velocities.
    None,
    /// Impulses act on bodies that overlap at the end of the step.
    Simple {
        /// The coefficient of restitution (`COR`).
        restitution: f64,
    },
    /// A repulsive force acts between bodies that are close to each other.
    Penalty {
        /// The stiffness `k`, in units of force per length.
        stiffness: f64,
        /// The thickness of the layer (`thickness`), a length.
        thickness: f64,
        /// The method that finds the pairs that repel each other.
        detection: CollisionDetection,
    },
    /// One detection pass in continuous time responds to each impact.
    ContinuousTime {
        /// The coefficient of restitution (`COR`).
        restitution: f64,
    },
    /// Impulses, impact zones, the rigid failsafe and the penalty force handle collisions together.
    Hybrid {
        /// The coefficient of restitution (`COR`).
        restitution: f64,
        /// The maximum number of impulse rounds (`maxiters`). If it is zero or negative, the impulse stage detects
        /// nothing.
        max_iterations: i32,
        /// The stiffness `k` of the penalty force.
        stiffness: f64,
        /// The thickness of the penalty force's layer (`thickness`).
        thickness: f64,
    },
}

impl Collision {
    /// Returns the collision type, without the numbers.
    pub const fn kind(&self) -> CollisionType {
        match self {
            Self::None => CollisionType::None,
            Self::Simple { .. } => CollisionType::Simple,
            Self::Penalty { .. } => CollisionType::Penalty,
            Self::ContinuousTime { .. } => CollisionType::ContinuousTime,
            Self::Hybrid { .. } => CollisionType::Hybrid,
        }
    }

    /// Returns the coefficient of restitution, or 1 if the collision type has no response.
    pub const fn restitution(&self) -> f64 {
        match *self {
            Self::Simple { restitution } | Self::ContinuousTime { restitution } | Self::Hybrid { restitution, .. } => {
                restitution
            }
            Self::None | Self::Penalty { .. } => 1.0,
        }
    }

    /// Returns the handling that the scene's assignment requires of a program.
    ///
    /// # Panics
    /// Never panics: a test checks that every type is handled by its assignment.
    pub fn handling(&self) -> &'static CollisionHandling {
        let kind = self.kind();
        Assignment::for_collisions(kind).definition().handling(kind).expect("an assignment handles its collision types")
    }
}

/// The method with which a penalty force finds its pairs (`collisiondetection`), and therefore the order in which the
/// forces of the pairs are added (simulation.md 3). Other collision handling always checks all pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CollisionDetection {
    /// The forces of all pairs are added in the order of a detection pass (`all-pairs`, the default).
    #[default]
    AllPairs,
    /// The forces of nearby pairs are added in the order of a sweep along x (`contest`, Theme 2, Milestone 3).
    Contest,
}

/// A particle, which is a disc with a mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Particle {
    /// The center at the start.
    pub position: Vec2,
    /// The velocity at the start.
    pub velocity: Vec2,
    /// The particle's mass.
    pub mass: f64,
    /// Whether the particle is fixed. Forces and responses do not affect a fixed particle, but its own velocity still
    /// moves it.
    pub fixed: bool,
    /// The radius of the disc.
    pub radius: f64,
    /// A name without effect on the simulation.
    pub tag: Option<String>,
}

/// An edge between two particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// The index of the first endpoint (`i`).
    pub first: usize,
    /// The index of the second endpoint (`j`).
    pub second: usize,
    /// Half the edge's thickness.
    pub radius: f64,
}

/// An infinite obstacle whose boundary is a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// A point on its boundary.
    pub point: Vec2,
    /// The half-plane's normal as written, of any length.
    pub normal: Vec2,
}

/// A force (simulation.md 3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Force {
    /// A damped spring (`springforce`).
    Spring {
        /// The index of the edge that the spring acts on.
        edge: usize,
        /// The stiffness (`k`).
        stiffness: f64,
        /// The length at rest (`l0`).
        rest_length: f64,
        /// The damping (`b`).
        damping: f64,
    },
    /// A uniform gravity (`simplegravity`).
    SimpleGravity {
        /// The acceleration of every particle (`fx`, `fy`).
        acceleration: Vec2,
    },
    /// The attraction of two particles (`gravitationalforce`).
    Gravitation {
        /// The first particle (`i`).
        first: usize,
        /// The second particle (`j`).
        second: usize,
        /// The gravitational constant (`G`).
        constant: f64,
    },
    /// A constant force (`constantforce`).
    Constant {
        /// The force on every particle (`fx`, `fy`).
        force: Vec2,
    },
    /// A linear drag (`dragdamping`).
    Drag {
        /// The drag coefficient (`b`).
        coefficient: f64,
    },
    /// A vortex of two particles (`vortexforce`).
    Vortex {
        /// The first particle (`i`).
        first: usize,
        /// The second particle (`j`).
        second: usize,
        /// The strength (`kbs`).
        strength: f64,
        /// The coupling (`kvc`).
        coupling: f64,
    },
}

/// The values that only a display uses. They are kept so that a scene can be read and written without loss.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Display {
    /// The maximum number of steps per second of wall time (`maxsimfreq max`).
    pub max_frequency: Option<f64>,
    /// The visible part of the plane (`viewport`).
    pub viewport: Option<Viewport>,
    /// The background color (`backgroundcolor`).
    pub background: Option<Color>,
    /// The scene's tag (`scenetag tag`).
    pub tag: Option<String>,
    /// Pairs of particle and color, in document order (`particlecolor`).
    pub particle_colors: Vec<(usize, Color)>,
    /// Pairs of edge and color, in document order (`edgecolor`).
    pub edge_colors: Vec<(usize, Color)>,
    /// Pairs of half-plane and color, in document order (`halfplanecolor`).
    pub half_plane_colors: Vec<(usize, Color)>,
    /// The trails of particles (`particlepath`).
    pub paths: Vec<ParticlePath>,
}

/// The visible part of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewport {
    /// The viewport's center.
    pub center: Vec2,
    /// Half of the viewport's extent. Zero or a negative number means that the view fits the scene.
    pub size: f64,
}

/// A color with components in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Color {
    /// The red component.
    pub red: f64,
    /// The green component.
    pub green: f64,
    /// The blue component.
    pub blue: f64,
}

/// The visible trail of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticlePath {
    /// The index of the particle.
    pub particle: usize,
    /// The duration of the trail, in seconds.
    pub duration: f64,
    /// The path's color.
    pub color: Color,
}
