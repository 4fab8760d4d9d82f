//! The scene as the simulator needs it: plain values, every index valid when it comes from the strict reader.
use crate::assignments::{Assignment, CollisionType, Handling, Integrator};
use fosssim_num::vector::Vec2;

/// A scene: the bodies, the duration, the integrator and the collision handling.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Simulated time in seconds.
    pub duration: f64,
    /// Time step `dt` in seconds.
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
    /// The text shown in the banner, if the scene has one.
    pub description: Option<String>,
    /// The values that only a display uses.
    pub display: Display,
}

impl Scene {
    /// Returns the number of steps as the original computes it: the 32-bit conversion of `ceil(duration / dt)`; zero,
    /// negative and unrepresentable quotients give no step (scene-format.md 4).
    #[must_use]
    pub fn steps(&self) -> u32 {
        let quotient = (self.duration / self.time_step).ceil();
        // Outside the 32-bit range (and for NaN) the processor's conversion gives -2147483648, hence no step.
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
    /// No handling, records of positions and velocities only.
    None,
    /// Impulses on overlap at the end of the step.
    Simple {
        /// Coefficient of restitution (`COR`).
        restitution: f64,
    },
    /// A repelling force.
    Penalty {
        /// `k`, force per length.
        stiffness: f64,
        /// `thickness`, length.
        thickness: f64,
        /// The way to find the pairs that repel each other.
        detection: CollisionDetection,
    },
    /// Continuous-time detection, one pass.
    ContinuousTime {
        /// Coefficient of restitution (`COR`).
        restitution: f64,
    },
    /// Impulses, impact zones, rigid failsafe, and the penalty force.
    Hybrid {
        /// Coefficient of restitution (`COR`).
        restitution: f64,
        /// `maxiters`; zero or negative means no detection in the impulse stage.
        max_iterations: i32,
        /// `k` of the penalty force.
        stiffness: f64,
        /// `thickness` of the penalty force.
        thickness: f64,
    },
}

impl Collision {
    /// Returns the handling's type, without the numbers.
    #[must_use]
    pub const fn kind(&self) -> CollisionType {
        match self {
            Self::None => CollisionType::None,
            Self::Simple { .. } => CollisionType::Simple,
            Self::Penalty { .. } => CollisionType::Penalty,
            Self::ContinuousTime { .. } => CollisionType::ContinuousTime,
            Self::Hybrid { .. } => CollisionType::Hybrid,
        }
    }

    /// Returns the coefficient of restitution; 1 if no collision has a response.
    #[must_use]
    pub const fn restitution(&self) -> f64 {
        match *self {
            Self::Simple { restitution } | Self::ContinuousTime { restitution } | Self::Hybrid { restitution, .. } => {
                restitution
            }
            Self::None | Self::Penalty { .. } => 1.0,
        }
    }

    /// Returns the handling that its assignment requires of a program.
    ///
    /// # Panics
    /// Never: a test checks that every type is handled by its assignment.
    #[must_use]
    pub fn handling(&self) -> &'static Handling {
        let kind = self.kind();
        Assignment::for_collisions(kind).definition().handling(kind).expect("an assignment handles what it brings")
    }
}

/// The way in which a penalty force finds its pairs (`collisiondetection`), which determines the order of their sum
/// (simulation.md 3). Other collision handling always checks all pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CollisionDetection {
    /// `all-pairs`, also the default: in the order of a detection pass.
    #[default]
    AllPairs,
    /// `contest`, in Theme 2, Milestone 3: in the order of a sweep along x.
    Contest,
}

/// A particle: a disc with a mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Particle {
    /// Center at the start.
    pub position: Vec2,
    /// Velocity at the start.
    pub velocity: Vec2,
    /// Mass.
    pub mass: f64,
    /// Whether forces and responses leave it alone (its own velocity still moves it).
    pub fixed: bool,
    /// Radius of the disc.
    pub radius: f64,
    /// A name without effect.
    pub tag: Option<String>,
}

/// An edge between two particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Index of the first endpoint (`i`).
    pub first: usize,
    /// Index of the second endpoint (`j`).
    pub second: usize,
    /// Half the edge's thickness.
    pub radius: f64,
}

/// An infinite obstacle through a point.
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
    /// `springforce`
    Spring {
        /// Index of the edge it acts on.
        edge: usize,
        /// `k`
        stiffness: f64,
        /// `l0`
        rest_length: f64,
        /// `b`
        damping: f64,
    },
    /// `simplegravity`
    SimpleGravity {
        /// `(fx, fy)`
        acceleration: Vec2,
    },
    /// `gravitationalforce`
    Gravitation {
        /// `i`
        first: usize,
        /// `j`
        second: usize,
        /// `G`
        constant: f64,
    },
    /// `constantforce`
    Constant {
        /// `(fx, fy)`, on every particle
        force: Vec2,
    },
    /// `dragdamping`
    Drag {
        /// `b`
        coefficient: f64,
    },
    /// `vortexforce`
    Vortex {
        /// `i`
        first: usize,
        /// `j`
        second: usize,
        /// `kbs`
        strength: f64,
        /// `kvc`
        coupling: f64,
    },
}

/// The values that only a display uses; kept so that a scene survives being read and written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Display {
    /// `maxsimfreq max`, steps per second of wall time.
    pub max_frequency: Option<f64>,
    /// `viewport`
    pub viewport: Option<Viewport>,
    /// `backgroundcolor`
    pub background: Option<Color>,
    /// `scenetag tag`
    pub tag: Option<String>,
    /// `particlecolor`: particle and color, in document order.
    pub particle_colors: Vec<(usize, Color)>,
    /// `edgecolor`: edge and color, in document order.
    pub edge_colors: Vec<(usize, Color)>,
    /// `halfplanecolor`: half-plane and color, in document order.
    pub half_plane_colors: Vec<(usize, Color)>,
    /// `particlepath`
    pub paths: Vec<ParticlePath>,
}

/// The visible part of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewport {
    /// The viewport's center.
    pub center: Vec2,
    /// Half its extent; zero or negative means "fit".
    pub size: f64,
}

/// A color, components in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Color {
    /// Red.
    pub red: f64,
    /// Green.
    pub green: f64,
    /// Blue.
    pub blue: f64,
}

/// A trail behind a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticlePath {
    /// The particle.
    pub particle: usize,
    /// The time that the trail lasts, seconds.
    pub duration: f64,
    /// The path's color.
    pub color: Color,
}
