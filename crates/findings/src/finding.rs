//! Findings: the faults of a step, and their places.
use fosssim_model::{
    sim::{Impulse, Pair, PairKind, Pass, StepError},
    trace::LoggedImpulse,
};
use fosssim_num::polynomial::Polynomial;
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// The kinds of findings, in the order in which reports list them.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "snake_case")]
    pub enum FindingKind {
        /// A collision of the reference is not in the trace.
        MissedCollision = "missed collision",
        /// A collision of the trace is not in the reference.
        SuperfluousCollision = "superfluous collision",
        /// A collision is in both, with different contact normals.
        WrongNormal = "wrong contact normal",
        /// The step logged another number of polynomials: detection ran more or less often.
        PolynomialCount = "wrong number of polynomials",
        /// A polynomial has another number of coefficients.
        PolynomialDegree = "wrong polynomial degree",
        /// The reference's coefficients are all tiny, the trace's are not.
        VanishingPolynomial = "polynomial should vanish",
        /// A coefficient differs after rescaling.
        Coefficient = "wrong coefficient",
        /// A particle's position at the end of the step differs.
        Position = "wrong position",
        /// A particle's velocity at the end of the step differs.
        Velocity = "wrong velocity",
        /// Fair rules: the time of impact of a collision is wrong.
        ContactTime = "wrong time of impact",
        /// Fair rules: a collision is logged more than once.
        RepeatedCollision = "repeated collision",
        /// Fair rules: a later detection pass of the step used wrong positions.
        PassPositions = "wrong positions within the step",
        /// Fair rules: the two records of a step contradict each other.
        RecordsDiffer = "contradicting records",
        /// Fair rules: the trace holds a log that the course's library can't have written.
        ImpossibleLog = "impossible log",
        /// Fair rules: coefficients that were lost as too small change a decision.
        TrimmedDecision = "decision changed by lost coefficients",
        /// Fair rules: the two accepted forms of the approach polynomial are mixed.
        MixedForms = "mixed forms of the approach",
        /// Fair rules: the penalty force between two bodies was left out, or applied twice.
        PairForce = "force of a pair left out or doubled",
        /// Fair rules: from the step's state, or with its polynomials, no next state exists.
        NoResult = "no next state",
    }
}

impl FindingKind {
    /// Returns the original's message for it; `None` for positions and velocities, which only raise residuals, and for
    /// what the original does not check.
    #[must_use]
    pub const fn original_message(self) -> Option<&'static str> {
        match self {
            Self::MissedCollision => Some("Missed collision"),
            Self::SuperfluousCollision => Some("Superfluous collision"),
            Self::WrongNormal => Some("Collision with wrong normal"),
            Self::PolynomialCount => Some("Wrong number of polynomials!"),
            Self::PolynomialDegree => Some("Wrong polynomial degree!"),
            Self::VanishingPolynomial => Some("Polynomial coefficients are close to all zero!"),
            Self::Coefficient => Some("Wrong polynomial coefficients!"),
            _ => None,
        }
    }
}

/// One thing that is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The step, from 1.
    pub step: u32,
    /// The frame of the trace that was compared, from 0 (the initial record).
    pub frame: u64,
    /// The fault, with its values.
    pub detail: FindingDetail,
}

impl Finding {
    /// Returns the finding's kind.
    #[must_use]
    pub const fn kind(&self) -> FindingKind {
        match self.detail {
            FindingDetail::MissedCollision { .. } => FindingKind::MissedCollision,
            FindingDetail::SuperfluousCollision { .. } => FindingKind::SuperfluousCollision,
            FindingDetail::WrongNormal { .. } => FindingKind::WrongNormal,
            FindingDetail::PolynomialCount { .. } | FindingDetail::PassCount { .. } => FindingKind::PolynomialCount,
            FindingDetail::PolynomialDegree { .. } => FindingKind::PolynomialDegree,
            FindingDetail::VanishingPolynomial { .. } => FindingKind::VanishingPolynomial,
            FindingDetail::Coefficient { .. } => FindingKind::Coefficient,
            FindingDetail::Position { .. } | FindingDetail::BeyondReach { .. } => FindingKind::Position,
            FindingDetail::Velocity { .. } => FindingKind::Velocity,
            FindingDetail::ContactTime { .. } => FindingKind::ContactTime,
            FindingDetail::RepeatedCollision { .. } => FindingKind::RepeatedCollision,
            FindingDetail::PassPositions { .. } => FindingKind::PassPositions,
            FindingDetail::RecordsDiffer { .. } => FindingKind::RecordsDiffer,
            FindingDetail::ImpossibleLog => FindingKind::ImpossibleLog,
            FindingDetail::TrimmedDecision { .. } | FindingDetail::TrimmedTime { .. } => FindingKind::TrimmedDecision,
            FindingDetail::MixedForms { .. } => FindingKind::MixedForms,
            FindingDetail::PairForce { .. } => FindingKind::PairForce,
            FindingDetail::NoResult { .. } => FindingKind::NoResult,
        }
    }
}

/// A fault, with expected (reference) and actual (trace) values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum FindingDetail {
    /// The reference collides here, the trace does not.
    MissedCollision {
        /// The reference's collision.
        expected: Impulse,
    },
    /// The trace collides here, the reference does not.
    SuperfluousCollision {
        /// The trace's collision.
        actual: LoggedImpulse,
    },
    /// Both collide here, along different normals.
    WrongNormal {
        /// The reference's collision.
        expected: Impulse,
        /// The trace's first collision of the same pair.
        actual: LoggedImpulse,
        /// Euclidean distance of the normals.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
    },
    /// Another number of polynomials.
    PolynomialCount {
        /// Logged by the reference.
        expected: usize,
        /// Logged by the trace.
        actual: usize,
        /// Polynomials of one detection pass over all pairs, with which missing or surplus passes are counted.
        per_pass: usize,
    },
    /// Another number of detection passes in one part of the step (fair rules).
    PassCount {
        /// The part.
        part: Part,
        /// Passes of the reference.
        expected: usize,
        /// Passes in the trace.
        actual: usize,
    },
    /// Another number of coefficients.
    PolynomialDegree {
        /// Which polynomial.
        place: PolynomialPlace,
        /// The reference's polynomial.
        expected: Polynomial,
        /// The trace's number of coefficients.
        actual_size: usize,
        /// The trace's first coefficients (at most six).
        actual: Polynomial,
    },
    /// The reference's polynomial vanishes, the trace's does not.
    VanishingPolynomial {
        /// Which polynomial.
        place: PolynomialPlace,
        /// The reference's polynomial.
        expected: Polynomial,
        /// The trace's polynomial.
        actual: Polynomial,
    },
    /// A coefficient differs.
    Coefficient {
        /// Which polynomial.
        place: PolynomialPlace,
        /// The highest power of t whose coefficient differs once the factor on which most agree is taken out.
        power: usize,
        /// The reference's coefficient times that factor.
        #[serde(with = "fosssim_num::written")]
        expected: f64,
        /// The trace's coefficient.
        #[serde(with = "fosssim_num::written")]
        actual: f64,
        /// The distance between both.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
        /// The values that the original compares; `None` from the fair rules.
        rescaled: Option<RescaledCoefficient>,
        /// The reference's whole polynomial, not rescaled.
        expected_polynomial: Polynomial,
        /// The trace's whole polynomial.
        actual_polynomial: Polynomial,
    },
    /// A position differs by more than the bound of the maximum residual.
    Position {
        /// The particle.
        particle: usize,
        /// The reference's position (x, y).
        #[serde(with = "fosssim_num::written")]
        expected: [f64; 2],
        /// The trace's position (x, y).
        #[serde(with = "fosssim_num::written")]
        actual: [f64; 2],
        /// Euclidean distance.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
    },
    /// A velocity differs by more than the bound of the maximum residual.
    Velocity {
        /// The particle.
        particle: usize,
        /// The reference's velocity (x, y).
        #[serde(with = "fosssim_num::written")]
        expected: [f64; 2],
        /// The trace's velocity (x, y).
        #[serde(with = "fosssim_num::written")]
        actual: [f64; 2],
        /// Euclidean distance.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
    },
    /// The time of impact is not where the polynomials turn positive (fair rules).
    ContactTime {
        /// The reference's collision.
        expected: Impulse,
        /// The trace's.
        actual: LoggedImpulse,
    },
    /// A collision that the trace already has (fair rules).
    RepeatedCollision {
        /// The repetition.
        actual: LoggedImpulse,
    },
    /// A polynomial of a pair that a response or the failsafe has moved fits neither (fair rules). It may be right:
    /// then the particles' positions are wrong.
    PassPositions {
        /// The first such polynomial.
        place: PolynomialPlace,
    },
    /// The mid record and the end record of the step contradict each other (fair rules).
    RecordsDiffer {
        /// In what.
        part: RecordPart,
    },
    /// A polynomial with more coefficients than any detection has, or with small leading ones, which the course's
    /// library drops (fair rules).
    ImpossibleLog,
    /// The trace's polynomials lack coefficients, as if the course's library had dropped them because of a factor, and
    /// this decision depends on them (fair rules).
    TrimmedDecision {
        /// The pair's first polynomial.
        place: PolynomialPlace,
        /// Whether the pair collides.
        collides: bool,
    },
    /// The trace's polynomials lack coefficients, as where the course's library drops them because of a factor, and
    /// this time of impact is theirs (fair rules).
    TrimmedTime {
        /// The pair's first polynomial.
        place: PolynomialPlace,
        /// The time of impact without the loss.
        #[serde(with = "fosssim_num::written")]
        expected: f64,
        /// The time of impact that the trace's polynomials have.
        #[serde(with = "fosssim_num::written")]
        actual: f64,
    },
    /// A state from which nothing can be right or wrong any more: without numbers, or of another size altogether than
    /// anything that the scene leads to (fair rules).
    BeyondReach {
        /// The particle.
        particle: usize,
        /// The particle's position (x, y).
        #[serde(with = "fosssim_num::written")]
        position: [f64; 2],
        /// The particle's velocity (x, y).
        #[serde(with = "fosssim_num::written")]
        velocity: [f64; 2],
    },
    /// The approach polynomial has the other of its two accepted forms than before (fair rules).
    MixedForms {
        /// The first such polynomial.
        place: PolynomialPlace,
    },
    /// Two bodies are within reach of the penalty force, and it was left out, or applied twice (fair rules).
    PairForce {
        /// The bodies.
        pair: Pair,
        /// Whether it was applied twice.
        is_doubled: bool,
    },
    /// From the trace's own state, or with its own polynomials, no next state exists (fair rules).
    NoResult {
        /// The reason.
        error: StepError,
    },
}

impl FindingDetail {
    /// Returns the finding's place in the step.
    #[must_use]
    pub const fn place(&self) -> FindingPlace {
        match self {
            Self::MissedCollision { expected }
            | Self::WrongNormal { expected, .. }
            | Self::ContactTime { expected, .. } => FindingPlace::Pair(expected.pair),
            Self::PairForce { pair, .. } | Self::NoResult { error: StepError::RootSearch { pair, .. } } => {
                FindingPlace::Pair(*pair)
            }
            Self::PolynomialDegree { place, .. }
            | Self::VanishingPolynomial { place, .. }
            | Self::Coefficient { place, .. }
            | Self::PassPositions { place }
            | Self::TrimmedDecision { place, .. }
            | Self::TrimmedTime { place, .. }
            | Self::MixedForms { place } => FindingPlace::Polynomial(*place),
            Self::Position { particle, .. } | Self::Velocity { particle, .. } | Self::BeyondReach { particle, .. } => {
                FindingPlace::Particle(*particle)
            }
            Self::SuperfluousCollision { actual } | Self::RepeatedCollision { actual } => {
                FindingPlace::Objects(actual.first, actual.second)
            }
            Self::PolynomialCount { .. }
            | Self::PassCount { .. }
            | Self::RecordsDiffer { .. }
            | Self::ImpossibleLog
            | Self::NoResult { .. } => FindingPlace::Step,
        }
    }

    /// Returns the pair that it is about; `None` if it is about no pair, or the trace names no such pair.
    #[must_use]
    pub fn pair(&self) -> Option<Pair> {
        match (self, self.place()) {
            (Self::SuperfluousCollision { actual } | Self::RepeatedCollision { actual }, _) => actual.pair(),
            (_, FindingPlace::Pair(pair)) => Some(pair),
            (_, FindingPlace::Polynomial(place)) => Some(place.pair),
            _ => None,
        }
    }

    /// Returns the detection pass that it is about.
    #[must_use]
    pub const fn pass(&self) -> Option<Pass> {
        match self.place() {
            FindingPlace::Polynomial(place) => Some(place.pass),
            _ => None,
        }
    }
}

/// The place of a finding in its step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FindingPlace {
    /// In no place that could be named.
    Step,
    /// At a pair of the scene.
    Pair(Pair),
    /// At a polynomial.
    Polynomial(PolynomialPlace),
    /// At a particle.
    Particle(usize),
    /// At the objects with these numbers, of which the trace alone speaks.
    Objects(i32, i32),
}

/// A coefficient as the original compares it: rescaled by sums of moduli, so that one wrong coefficient moves all
/// others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RescaledCoefficient {
    /// The highest power of t whose coefficient is beyond the original's bound.
    #[serde(rename = "coefficient")]
    pub power: usize,
    /// The reference's coefficient, rescaled to the trace's magnitude.
    #[serde(with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub expected: f64,
    /// The trace's coefficient.
    #[serde(with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub actual: f64,
    /// The distance between both.
    #[serde(with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub residual: f64,
}

/// A part of a step's collision handling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Part {
    /// The part before the mid record: the only pass, or the impulse rounds.
    Impulses,
    /// Impact zones and the rigid failsafe.
    Geometric,
}

/// The part in which two records of a step contradict each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordPart {
    /// Positions or velocities.
    State,
    /// The impulse lists.
    Impulses,
    /// The polynomial lists.
    Polynomials,
}

/// Which polynomial of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PolynomialPlace {
    /// The detection pass.
    pub pass: Pass,
    /// The pair.
    pub pair: Pair,
    /// The role of the polynomial.
    pub role: Role,
    /// The polynomial's number in the frame's list, from 0.
    pub index: usize,
}

fosssim_num::closed_set! {
    /// The meaning of a detection polynomial that is positive (collisions.md 2).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "snake_case")]
    pub enum Role {
        /// The objects overlap (the distance is below the sum of radii).
        Overlap = "overlap",
        /// The particle is beyond the edge's first endpoint (alpha > 0).
        AlphaAboveZero = "alpha > 0",
        /// The particle is before the edge's second endpoint (alpha < 1).
        AlphaBelowOne = "alpha < 1",
        /// The objects approach each other.
        Approach = "approach",
    }
}

impl Role {
    /// Returns the role of polynomial `number` (from 0) of a detection call.
    #[must_use]
    pub const fn from_number(kind: PairKind, number: usize) -> Self {
        match (kind, number) {
            (_, 0) => Self::Overlap,
            (PairKind::ParticleEdge, 1) => Self::AlphaAboveZero,
            (PairKind::ParticleEdge, 2) => Self::AlphaBelowOne,
            _ => Self::Approach,
        }
    }
}
