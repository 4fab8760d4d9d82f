//! The quantities in programs of the milestones that log states, in which slips can be made.
use super::slips::{BLOCKS, DISTANCE, EACH, FORCE, NUMBER, PAIR, SUM, Slip, VECTOR};
use crate::assignments::rows::Area;
use fosssim_model::assignments::{ForceKind, Integrator, PairKind, Part};

/// The row of a quantity in the catalog.
#[derive(Debug)]
pub struct TermRow {
    /// The computed quantity, such as a force between two kinds of bodies.
    pub term: Term,
    /// The beginning of its rows' ids.
    pub id: &'static str,
    /// The beginning of its rows' sentences.
    pub subject: &'static str,
    /// The quantity's formula, in the letters of the assignment.
    pub formula: &'static str,
    /// The part of a student's work that computes the quantity.
    pub part: Part,
    /// The powers of the mass, the step size and the distance in the formula.
    pub(crate) mass: i8,
    pub(super) step: i8,
    pub(super) length: i8,
    /// Whether a function of the student computes only this quantity.
    pub is_function: bool,
    /// The slips that can be made in the quantity.
    pub(super) slips: &'static [&'static [Slip]],
}

macro_rules! terms {
    ($($part:expr => { $($term:ident $id:literal $subject:literal: $formula:literal
        [$mass:literal $step:literal $length:literal] $function:literal $slips:expr;)* })*) => {
        /// A quantity of a program.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Term { $($(#[doc = $subject] $term,)*)* }

        /// The rows of all quantities.
        pub const TERMS: &[TermRow] = &[$($(TermRow {
            term: Term::$term, id: $id, subject: $subject, formula: $formula, part: $part,
            mass: $mass, step: $step, length: $length, is_function: $function, slips: $slips,
        },)*)*];
    };
}

const POSITIONS: &[&[Slip]] = &[
    SUM,
    VECTOR,
    EACH,
    &[Slip::XForBoth, Slip::YForBoth, Slip::Step(-1), Slip::Step(1), Slip::Mass(1), Slip::Mass(-1), Slip::Assigned],
    &[Slip::OtherVelocity, Slip::MeanVelocity],
];
const VELOCITIES: &[&[Slip]] = &[
    SUM,
    VECTOR,
    EACH,
    &[Slip::XForBoth, Slip::YForBoth, Slip::Step(-1), Slip::Step(1), Slip::Mass(1), Slip::Mass(2), Slip::Mass(-1)],
    &[Slip::MassOfFirst, Slip::MassIndex, Slip::Assigned],
];
const STEP: &[&[Slip]] = &[&[
    Slip::Missing,
    Slip::FixedForgotten,
    Slip::FixedNotMoved,
    Slip::FixedVelocityZeroedFirst,
    Slip::FixedVelocityZeroedAfter,
]];
const SYSTEM: &[&[Slip]] =
    &[STEP[0], &[Slip::MatrixSign, Slip::RowsOfFixed, Slip::DiagonalOfFixed, Slip::RightOfFixed]];
const MATRIX: &[&[Slip]] = &[SUM, &[Slip::Step(1), Slip::Step(-1), Slip::Step(-2)]];
const RIGHT: &[&[Slip]] = &[SUM, &[Slip::Step(1), Slip::Step(-1), Slip::Mass(1), Slip::Mass(-1)]];
const THICKNESS: &[Slip] = &[
    Slip::NoFactor,
    Slip::NoThickness,
    Slip::ThicknessTwice,
    Slip::ThicknessInTest,
    Slip::ThicknessInDepth,
    Slip::NoRadii,
];
const PENALTY: &[&[Slip]] = &[
    SUM,
    THICKNESS,
    &[Slip::NoOtherRadius],
    PAIR,
    &[Slip::Always, Slip::Squared, Slip::SquaredWithSign, Slip::Length(1), Slip::Assigned],
];
const WHOLE_PENALTY: &[&[Slip]] =
    &[&[Slip::Sign, Slip::Doubled, Slip::Halved, Slip::NoFactor, Slip::ThicknessInTest, Slip::SameSign], PENALTY[4]];
const ALPHA: &[Slip] = &[Slip::Unclamped, Slip::Mirrored, Slip::Middle, Slip::Negated, Slip::Truncated, Slip::Rounded];
const NORMAL: &[Slip] = &[Slip::Sign, Slip::Unit, Slip::Doubled, Slip::Halved];
const APPROACH: &[Slip] = &[Slip::Missing, Slip::Sign, Slip::NotStrict];
const RESPONSE: &[Slip] = &[
    Slip::Missing,
    Slip::Sign,
    Slip::Halved,
    Slip::Doubled,
    Slip::NoFactor,
    Slip::Inelastic,
    Slip::RestitutionOnly,
    Slip::RestitutionTwice,
    Slip::Length(1),
    Slip::Length(2),
    Slip::Assigned,
    Slip::StartVelocity,
];
const BODIES: &[Slip] = &[
    Slip::FirstOnly,
    Slip::SecondOnly,
    Slip::SameSign,
    Slip::EqualMasses,
    Slip::SwappedMasses,
    Slip::FixedFinite,
    Slip::FixedAsFree,
    Slip::Sequential,
];

terms! {
    Part::Force(ForceKind::SimpleGravity) => {
        Gravity "gravity" "Simple gravity": "m_i g" [1 0 0] true &[SUM, FORCE, VECTOR, EACH,
            &[Slip::MassOfFirst, Slip::WholeMass, Slip::MassIndex]];
    }
    Part::Force(ForceKind::Drag) => {
        Drag "drag" "Drag": "-b v_i" [0 0 0] true &[SUM, FORCE, VECTOR, EACH, &[Slip::XForBoth, Slip::YForBoth]];
    }
    Part::Force(ForceKind::Spring) => {
        Spring "spring" "The spring force": "k (l - l0) n + b (n . (v_b - v_a)) n" [0 0 0] true
            &[SUM, FORCE, PAIR, VECTOR] ;
        SpringElastic "spring-elastic" "The elastic part of the spring force": "k (l - l0) n" [0 0 0] false
            &[SUM, FORCE, PAIR, DISTANCE, NUMBER] ;
        SpringDamping "spring-damping" "The damping of a spring": "b (n . (v_b - v_a)) n" [0 0 0] false
            &[SUM, FORCE, PAIR, DISTANCE, NUMBER] ;
    }
    Part::Force(ForceKind::Gravitation) => {
        Gravitation "gravitation" "The gravitational force": "G m_a m_b / r^2 n" [2 0 -2] true
            &[SUM, FORCE, PAIR, VECTOR, DISTANCE] ;
    }
    Part::Jacobians(ForceKind::Spring) => {
        JacobianSprings "jacobian-springs" "The derivative of the spring force":
            "the block with respect to positions or velocities" [0 0 0] false &[BLOCKS] ;
        JacobianSpring "jacobian-spring" "The derivative of the spring force with respect to positions":
            "k (n n^T + (l - l0) / l (I - n n^T)) - D" [0 0 0] true &[SUM, BLOCKS, &[Slip::OtherMatrix] ];
        JacobianElastic "jacobian-elastic" "The derivative of a spring's elastic part with respect to positions":
            "k (n n^T + (l - l0) / l (I - n n^T))" [0 0 0] false &[SUM, BLOCKS, DISTANCE] ;
        JacobianElasticAlong "jacobian-elastic-along"
            "The term along the spring in the derivative of its elastic part": "k n n^T" [0 0 0] false
            &[SUM, DISTANCE] ;
        JacobianElasticAcross "jacobian-elastic-across"
            "The term across the spring in the derivative of its elastic part": "k (l - l0) / l (I - n n^T)"
            [0 0 -1] false &[SUM, DISTANCE, &[Slip::Absolute] ];
        JacobianDamping "jacobian-damping" "The derivative of a spring's damping with respect to positions":
            "-D with D = -b / l ((n w^T + (n . w) I) (I - n n^T)) and w = v_b - v_a" [0 0 -1] false
            &[SUM, BLOCKS, DISTANCE] ;
        JacobianDampingOuter "jacobian-damping-outer"
            "The outer product with the velocity in the derivative of a spring's damping with respect to positions":
            "n w^T (using w n^T instead makes no difference)" [0 0 0] false &[SUM] ;
        JacobianDampingScalar "jacobian-damping-scalar"
            "The term of the speed along the spring in the derivative of its damping with respect to positions":
            "(n . w) I" [0 0 0] false &[SUM] ;
        JacobianVelocity "jacobian-velocity" "The derivative of a spring's damping with respect to velocities":
            "b n n^T" [0 0 0] true &[SUM, BLOCKS, DISTANCE, &[Slip::OtherMatrix] ];
    }
    Part::Jacobians(ForceKind::Gravitation) => {
        JacobianGravitation "jacobian-gravitation"
            "The derivative of the gravitational force with respect to positions":
            "G m_a m_b / r^3 (I - 3 n n^T)" [2 0 -3] true &[SUM, BLOCKS, DISTANCE, &[Slip::OtherMatrix] ];
        JacobianGravitationAlong "jacobian-gravitation-along"
            "The term along the line of the particles in the derivative of the gravitational force": "3 n n^T" [0 0 0]
            false &[SUM] ;
        JacobianGravitationAll "jacobian-gravitation-all"
            "The term that is the same in all directions in the derivative of the gravitational force": "I" [0 0 0]
            false &[SUM] ;
    }
    Part::Jacobians(ForceKind::Drag) => {
        JacobianDrag "jacobian-drag" "The derivative of drag with respect to velocities":
            "b on the diagonal" [0 0 0] true &[SUM, EACH,
            &[Slip::Assigned, Slip::Mass(1), Slip::OtherMatrix, Slip::XOnly, Slip::YOnly, Slip::Step(1)] ];
    }
    Part::Integrator(Integrator::ExplicitEuler) => {
        Explicit "explicit" "Explicit Euler": "x += h v, v += h F / m" [0 0 0] true STEP;
        ExplicitPositions "explicit-positions" "The update of positions in explicit Euler": "h v_old" [0 1 0] false
            POSITIONS;
        ExplicitVelocities "explicit-velocities" "The update of velocities in explicit Euler": "h F / m" [-1 1 0] false
            &[VELOCITIES[0], VELOCITIES[1], VELOCITIES[2], VELOCITIES[3], VELOCITIES[4], &[Slip::NotCleared] ];
    }
    Part::Integrator(Integrator::SymplecticEuler) => {
        Symplectic "symplectic" "Symplectic Euler": "v += h F / m, x += h v" [0 0 0] true STEP;
        SymplecticPositions "symplectic-positions" "The update of positions in symplectic Euler": "h v_new" [0 1 0]
            false POSITIONS;
        SymplecticVelocities "symplectic-velocities" "The update of velocities in symplectic Euler": "h F / m" [-1 1 0]
            false &[VELOCITIES[0], VELOCITIES[1], VELOCITIES[2], VELOCITIES[3], VELOCITIES[4],
            &[Slip::ForcesAfterMove, Slip::NotCleared] ];
    }
    Part::Integrator(Integrator::LinearizedImplicitEuler) => {
        Linear "linear" "Linearized implicit Euler": "(M + h Hv + h^2 Hx) dv = h F, v += dv, x += h v" [0 0 0] true
            SYSTEM;
        LinearPositions "linear-positions" "The update of positions in linearized implicit Euler": "h v_new" [0 1 0]
            false POSITIONS;
        LinearVelocities "linear-velocities" "The solution of the system in linearized implicit Euler": "v += dv"
            [0 0 0] false &[SUM, VECTOR, EACH, &[Slip::Assigned, Slip::Step(1)] ];
        LinearRight "linear-right" "The right-hand side of linearized implicit Euler": "h F" [0 1 0] false RIGHT;
        LinearMass "linear-mass" "The mass in the matrix of linearized implicit Euler": "M" [1 0 0] false &[SUM,
            &[Slip::Mass(-1), Slip::Mass(1)] ];
        LinearHx "linear-hx" "The derivative with respect to positions in the matrix of linearized implicit Euler":
            "h^2 Hx" [0 2 0] false MATRIX;
        LinearHv "linear-hv" "The derivative with respect to velocities in the matrix of linearized implicit Euler":
            "h Hv" [0 1 0] false MATRIX;
    }
    Part::Integrator(Integrator::ImplicitEuler) => {
        Implicit "implicit" "Implicit Euler": "Newton's method for v = v_0 + h F(x_0 + h v, v) / m" [0 0 0] true SYSTEM;
        Newton "newton" "Newton's method": "the loop until |d| < 1e-9" [0 0 0] false &[&[Slip::Iterations(1),
            Slip::Iterations(2), Slip::Iterations(3), Slip::Iterations(4), Slip::Iterations(5), Slip::Loose(1),
            Slip::Loose(2), Slip::Loose(3), Slip::Loose(4), Slip::Loose(5)]];
        ImplicitVelocities "implicit-velocities" "The solution of the system in implicit Euler": "v_i += d" [0 0 0]
            false &[SUM, &[Slip::Assigned] ];
        ImplicitPositions "implicit-positions" "The update of positions in implicit Euler": "h v_new" [0 1 0] false
            POSITIONS;
        ImplicitRight "implicit-right" "The force on the right-hand side of implicit Euler": "h F" [0 1 0] false RIGHT;
        ImplicitMomentum "implicit-momentum" "The momentum on the right-hand side of implicit Euler": "-M (v_i - v_0)"
            [1 0 0] false &[&[Slip::Missing, Slip::Doubled, Slip::Halved, Slip::Mass(-1), Slip::Step(1)]];
        ImplicitMass "implicit-mass" "The mass in the matrix of implicit Euler": "M" [1 0 0] false
            &[&[Slip::Missing, Slip::Doubled, Slip::Halved, Slip::Mass(-1), Slip::Mass(1)]];
        ImplicitHx "implicit-hx" "The derivative with respect to positions in the matrix of implicit Euler":
            "h^2 Hx" [0 2 0] false MATRIX;
        ImplicitHv "implicit-hv" "The derivative with respect to velocities in the matrix of implicit Euler":
            "h Hv" [0 1 0] false MATRIX;
    }
    Part::Penalty(PairKind::ParticleParticle) => {
        Penalty "penalty" "The penalty force": "k (|n| - r - h) u" [0 0 0] false WHOLE_PENALTY;
        PenaltyParticles "penalty-particles" "The penalty force between two particles": "k (|n| - r_i - r_j - h) u"
            [0 0 0] true PENALTY;
    }
    Part::Penalty(PairKind::ParticleEdge) => {
        PenaltyEdges "penalty-edges" "The penalty force between a particle and an edge":
            "k (|n| - r_i - r_e - h) u, with shares 1 - alpha and alpha of the ends" [0 0 0] true &[PENALTY[0],
            PENALTY[1], PENALTY[2], PENALTY[3], PENALTY[4], ALPHA, &[Slip::EndRadius, Slip::FirstRadius,
            Slip::SharesExchanged, Slip::EqualShares, Slip::FullShares, Slip::OneEnd] ];
    }
    Part::Penalty(PairKind::ParticleHalfPlane) => {
        PenaltyHalfPlanes "penalty-half-planes" "The penalty force between a particle and a half-plane":
            "k (|n| - r_i - h) u" [0 0 0] true &[SUM, THICKNESS, PENALTY[4],
            &[Slip::NotNormalized, Slip::SameNormalBehind, Slip::NormalAsGiven, Slip::OppositeNormalInFront,
            Slip::ToPoint, Slip::FrontOnly] ];
    }
    Part::SimpleDetection(PairKind::ParticleParticle) => {
        DetectParticles "detect-particles" "The collision detection of two particles":
            "detectParticleParticle" [0 0 0] true &[&[Slip::Missing]];
    }
    Part::SimpleDetection(PairKind::ParticleEdge) => {
        DetectEdges "detect-edges" "The collision detection of a particle with an edge":
            "detectParticleEdge" [0 0 0] true &[&[Slip::Missing]];
    }
    Part::SimpleDetection(PairKind::ParticleHalfPlane) => {
        DetectHalfPlanes "detect-half-planes" "The collision detection of a particle with a half-plane":
            "detectParticleHalfplane" [0 0 0] true &[&[Slip::Missing]];
    }
    Part::SimpleDetection(PairKind::ParticleParticle) => {
        OverlapParticles "overlap-particles" "The test of overlap between two particles": "|n| < r_1 + r_2" [0 0 0]
            false &[APPROACH, &[Slip::FirstOnly, Slip::SecondOnly] ];
    }
    Part::SimpleDetection(PairKind::ParticleEdge) => {
        OverlapEdges "overlap-edges" "The test of overlap between a particle and an edge": "|n| < r_1 + r_e" [0 0 0]
            false &[APPROACH, &[Slip::FirstOnly, Slip::SecondOnly, Slip::EndRadius, Slip::FirstRadius] ];
    }
    Part::SimpleDetection(PairKind::ParticleHalfPlane) => {
        OverlapHalfPlanes "overlap-half-planes" "The test of overlap between a particle and a half-plane": "|n| < r"
            [0 0 0] false &[APPROACH, &[Slip::SameNormalBehind] ];
    }
    Part::SimpleDetection(PairKind::ParticleParticle) => {
        ApproachParticles "approach-particles" "The test of approach between two particles": "(v_1 - v_2) . n > 0"
            [0 0 0] false &[APPROACH, &[Slip::IgnoresSlowApproach, Slip::FirstOnly, Slip::SecondOnly] ];
    }
    Part::SimpleDetection(PairKind::ParticleEdge) => {
        ApproachEdges "approach-edges" "The test of approach between a particle and an edge":
            "(v_1 - (v_2 + alpha (v_3 - v_2))) . n > 0" [0 0 0] false &[APPROACH,
            &[Slip::IgnoresSlowApproach, Slip::FirstOnly, Slip::SecondOnly, Slip::Middle, Slip::Mirrored,
            Slip::Unclamped] ];
    }
    Part::SimpleDetection(PairKind::ParticleHalfPlane) => {
        ApproachHalfPlanes "approach-half-planes" "The test of approach between a particle and a half-plane":
            "v . n > 0" [0 0 0] false &[APPROACH, &[Slip::IgnoresSlowApproach] ];
    }
    Part::SimpleDetection(PairKind::ParticleParticle) => {
        NormalParticles "normal-particles" "The contact vector between two particles": "n = x_2 - x_1" [0 0 0] false
            &[NORMAL] ;
    }
    Part::SimpleDetection(PairKind::ParticleEdge) => {
        NormalEdges "normal-edges" "The contact vector between a particle and an edge":
            "n = x_2 + alpha (x_3 - x_2) - x_1" [0 0 0] false &[NORMAL] ;
    }
    Part::SimpleDetection(PairKind::ParticleHalfPlane) => {
        NormalHalfPlanes "normal-half-planes" "The contact vector between a particle and a half-plane":
            "n = ((x_p - x) . q) / (q . q) q" [0 0 0] false &[NORMAL, &[Slip::ToPoint, Slip::NotNormalized] ];
    }
    Part::SimpleDetection(PairKind::ParticleEdge) => {
        ClosestPoint "closest-point" "The collision detection of a particle with an edge":
            "alpha = (x_1 - x_2) . (x_3 - x_2) / |x_3 - x_2|^2, not below 0 and not above 1" [0 0 0] false &[ALPHA,
            &[Slip::NothingBeyondEnds] ];
    }
    Part::SimpleResponse(PairKind::ParticleParticle) => {
        RespondParticles "respond-particles" "The response between two particles":
            "v_1 += (1 + COR) / (1 + m_1 / m_2) ((v_2 - v_1) . u) u, and likewise the other" [0 0 0] true
            &[RESPONSE, BODIES] ;
    }
    Part::SimpleResponse(PairKind::ParticleEdge) => {
        RespondEdges "respond-edges" "The response between a particle and an edge":
            "(1 + COR) ((v_e - v_1) . u) u, with shares 1 - alpha and alpha" [0 0 0] true &[RESPONSE, BODIES, ALPHA,
            &[Slip::SharesNotSquared, Slip::SharesExchanged, Slip::FullShares, Slip::EqualShares, Slip::OneEnd,
            Slip::OneEndFixesBoth, Slip::AfterParticle] ];
        RespondEdgeStill "respond-edge-still" "The velocity of the edge in the response": "v_2 + alpha (v_3 - v_2)"
            [0 0 0] false &[&[Slip::Missing, Slip::Middle]];
    }
    Part::SimpleResponse(PairKind::ParticleHalfPlane) => {
        RespondHalfPlanes "respond-half-planes" "The response between a particle and a half-plane":
            "v -= (1 + COR) (v . u) u" [0 0 0] true &[RESPONSE, &[Slip::WholeVelocity, Slip::FixedUnchanged] ];
    }
}

impl TermRow {
    /// Returns the area of the assignment to which the term belongs.
    pub const fn area(&self) -> Area {
        match self.part {
            Part::Force(_) => Area::Forces,
            Part::Jacobians(_) => Area::Jacobians,
            Part::Integrator(_) => Area::Integrator,
            Part::Penalty(_) => Area::Penalty,
            Part::SimpleResponse(_) => Area::Response,
            _ => Area::SimpleDetection,
        }
    }
}

impl Term {
    /// Returns the quantity of which this one is a part, or `None` if it is part of no other quantity.
    const fn containing_term(self) -> Option<Self> {
        Some(match self {
            Self::SpringElastic | Self::SpringDamping => Self::Spring,
            Self::JacobianSpring | Self::JacobianVelocity => Self::JacobianSprings,
            Self::JacobianElastic | Self::JacobianDamping => Self::JacobianSpring,
            Self::PenaltyParticles | Self::PenaltyEdges | Self::PenaltyHalfPlanes => Self::Penalty,
            _ => return None,
        })
    }

    /// Returns whether a slip in this quantity is also a slip in `other`.
    pub fn covers(self, other: Self) -> bool {
        let mut part = Some(other);
        while let Some(one) = part {
            if one == self {
                return true;
            }
            part = one.containing_term();
        }
        false
    }

    /// Returns the term's row in the catalog.
    pub const fn row(self) -> &'static TermRow {
        &TERMS[self as usize]
    }
}

/// A slip in a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edit {
    /// The quantity that is changed.
    pub term: Term,
    /// The slip in the quantity.
    pub slip: Slip,
}

impl Edit {
    /// Returns the area of the assignment to which the edit belongs.
    pub const fn area(self) -> Area {
        self.term.row().area()
    }

    /// Returns whether the slip is an unwritten function of the starter code.
    pub const fn is_empty_function(self) -> bool {
        matches!(self.slip, Slip::Missing) && self.term.row().is_function
    }
}
