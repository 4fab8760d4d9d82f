//! What explanations of polynomials are made of: the inputs of one detection and what the submission logged for it.
use fosssim_judge::fair::formulas::{self, Way};
use fosssim_model::sim::{Pair, PairKind};
use fosssim_num::{
    bounded::{Bounded, Bounded2},
    vector::Vec2,
};

/// A point on its even way through the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Where it is at the start of the step (`q_start`), in the scene's length unit.
    pub start: Vec2,
    /// How far it goes within the step (`q_end - q_start`).
    pub displacement: Vec2,
}

/// The two objects of a detection and how they move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// Two particles.
    Particles {
        /// The first and the second particle.
        bodies: [Body; 2],
        /// The radius of each.
        radii: [f64; 2],
    },
    /// A particle and an edge.
    Edge {
        /// The particle, the edge's first and its second endpoint.
        bodies: [Body; 3],
        /// The particle's and the edge's radius.
        radii: [f64; 2],
    },
    /// A particle and a half-plane.
    HalfPlane {
        /// The particle.
        body: Body,
        /// The particle's radius.
        radius: f64,
        /// A point on the boundary.
        point: Vec2,
        /// The normal as the scene gives it, of any length.
        normal: Vec2,
    },
}

impl Motion {
    /// The kind of the pair.
    #[must_use]
    pub const fn kind(&self) -> PairKind {
        match self {
            Self::Particles { .. } => PairKind::ParticleParticle,
            Self::Edge { .. } => PairKind::ParticleEdge,
            Self::HalfPlane { .. } => PairKind::ParticleHalfPlane,
        }
    }
}

/// One detection of a submission: what went in, and the polynomials that it handed to the root finder.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The step, from 1.
    pub step: u32,
    /// The detection pass within the step, from 0.
    pub pass: u32,
    /// Who was looked at. Its kind is that of `motion`.
    pub pair: Pair,
    /// The inputs, from the submission's own states.
    pub motion: Motion,
    /// What was logged, one list per polynomial of the kind in the trace's order
    /// (2 or 4); each highest power first and without the small
    /// leading coefficients that the course's library drops. Fewer lists: the last polynomials are missing.
    pub polynomials: Vec<Vec<f64>>,
}

/// What a polynomial of a detection says (collisions.md 2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Subject {
    /// Two particles overlap.
    ParticleOverlap,
    /// Two particles approach each other.
    ParticleApproach,
    /// A particle overlaps an edge's line.
    EdgeOverlap,
    /// The closest point lies behind the edge's first end.
    AlphaLow,
    /// The closest point lies before the edge's second end.
    AlphaHigh,
    /// A particle and an edge approach each other.
    EdgeApproach,
    /// A particle overlaps a half-plane's boundary.
    HalfPlaneOverlap,
    /// A particle and a half-plane approach each other.
    HalfPlaneApproach,
}

impl Subject {
    /// The polynomials of one kind of pair, in the order of the trace.
    #[must_use]
    pub const fn of(kind: PairKind) -> &'static [Self] {
        match kind {
            PairKind::ParticleParticle => &[Self::ParticleOverlap, Self::ParticleApproach],
            PairKind::ParticleEdge => &[Self::EdgeOverlap, Self::AlphaLow, Self::AlphaHigh, Self::EdgeApproach],
            PairKind::ParticleHalfPlane => &[Self::HalfPlaneOverlap, Self::HalfPlaneApproach],
        }
    }

    /// The kind of pair that it belongs to.
    #[must_use]
    pub const fn kind(self) -> PairKind {
        match self {
            Self::ParticleOverlap | Self::ParticleApproach => PairKind::ParticleParticle,
            Self::EdgeOverlap | Self::AlphaLow | Self::AlphaHigh | Self::EdgeApproach => PairKind::ParticleEdge,
            Self::HalfPlaneOverlap | Self::HalfPlaneApproach => PairKind::ParticleHalfPlane,
        }
    }

    /// The degree of its polynomial.
    #[must_use]
    pub const fn degree(self) -> usize {
        match self {
            Self::ParticleApproach | Self::HalfPlaneApproach => 1,
            Self::ParticleOverlap | Self::AlphaLow | Self::AlphaHigh | Self::HalfPlaneOverlap => 2,
            Self::EdgeOverlap => 4,
            Self::EdgeApproach => 5,
        }
    }

    /// Its name in a message, such as `particle-edge alpha > 0`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ParticleOverlap => "particle-particle overlap",
            Self::ParticleApproach => "particle-particle approach",
            Self::EdgeOverlap => "particle-edge overlap",
            Self::AlphaLow => "particle-edge alpha > 0",
            Self::AlphaHigh => "particle-edge alpha < 1",
            Self::EdgeApproach => "particle-edge approach",
            Self::HalfPlaneOverlap => "particle-half-plane overlap",
            Self::HalfPlaneApproach => "particle-half-plane approach",
        }
    }
}

/// The numbers that go into the formulas, with error bounds, ready to be exchanged by an explanation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inputs {
    /// Start positions of the particle and the other one or two points; of a half-plane its point and its normal.
    pub x: [Bounded2; 3],
    /// Displacements likewise; a half-plane has none.
    pub d: [Bounded2; 3],
    /// The radius of the particle and that of the other object (0 for a half-plane).
    pub radii: [Bounded; 2],
    /// What stands for the square of the sum of the radii.
    pub square: Bounded,
    /// What stands for the squared length of the normal; 0 without one.
    pub normal_square: Bounded,
}

impl Inputs {
    /// The inputs as they are.
    pub fn new(motion: &Motion) -> Self {
        let still = |point: Vec2| Way { start: Bounded2::exact(point), shift: Bounded2::default() };
        let (ways, radii) = match *motion {
            Motion::Particles { bodies: [one, two], radii } => ([way(&one), way(&two), still(Vec2::zeros())], radii),
            Motion::Edge { bodies, radii } => (bodies.each_ref().map(way), radii),
            Motion::HalfPlane { body, radius, point, normal } => {
                ([way(&body), still(point), still(normal)], [radius, 0.0])
            }
        };
        let radii = radii.map(Bounded::exact);
        let reach = radii[0] + radii[1];
        let (x, d) = (ways.map(|way| way.start), ways.map(|way| way.shift));
        let normal_square =
            if motion.kind() == PairKind::ParticleHalfPlane { x[2].dot(x[2]) } else { Bounded::default() };
        Self { x, d, radii, square: reach * reach, normal_square }
    }
}

/// The way of a point as the fair rules see it. The displacement's value is the sample's, its bound that of a
/// difference of positions.
fn way(body: &Body) -> Way {
    let (start, end) = (Bounded2::exact(body.start), body.start + body.displacement);
    let mut shift = Bounded2::rounded(end) - start;
    (shift.x.value, shift.y.value) = (body.displacement.x, body.displacement.y);
    Way { start, shift }
}

impl Motion {
    /// The motion as the fair rules see it, whose formulas say what is right.
    pub(super) fn judged(&self) -> formulas::Motion {
        match self {
            Self::Particles { bodies, radii } => formulas::Motion::Particles(bodies.each_ref().map(way), sum(radii)),
            Self::Edge { bodies, radii } => formulas::Motion::Edge(bodies.each_ref().map(way), sum(radii)),
            Self::HalfPlane { body, radius, point, normal } => {
                formulas::Motion::HalfPlane(way(body), Bounded::exact(*radius), *point, *normal)
            }
        }
    }
}

fn sum(radii: &[f64; 2]) -> Bounded {
    Bounded::exact(radii[0]) + Bounded::exact(radii[1])
}
