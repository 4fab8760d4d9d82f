//! Findings, which are faults of a step with their places.
use fosssim_model::{
    sim::{Impulse, Pair, PairKind, Pass, StepError},
    trace::LoggedImpulse,
};
use fosssim_num::polynomial::Polynomial;
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// The kinds of findings, in the order of reports.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "snake_case")]
    pub enum FindingKind {
        /// A collision of the reference is not in the trace.
        MissedCollision = "missed collision",
        /// A collision of the trace is not in the reference.
        SuperfluousCollision = "superfluous collision",
        /// A collision of both has different contact normals.
        WrongNormal = "wrong contact normal",
        /// The step logged a wrong number of polynomials, because detection ran too often or not often enough.
        PolynomialCount = "wrong number of polynomials",
        /// A polynomial has a wrong number of coefficients.
        PolynomialDegree = "wrong polynomial degree",
        /// The reference's coefficients are all tiny, but the trace's are not.
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
        /// Fair rules: the trace contains a log that the course's library can't have written.
        ImpossibleLog = "impossible log",
        /// Fair rules: coefficients that were dropped because they are small change a decision.
        TrimmedDecision = "decision changed by lost coefficients",
        /// Fair rules: the two accepted forms of the approach polynomial are mixed.
        MixedForms = "mixed forms of the approach",
        /// Fair rules: the penalty force between two bodies was left out or applied twice.
        PairForce = "force of a pair left out or doubled",
        /// Fair rules: the step's state or its polynomials have no next state.
        NoResult = "no next state",
    }
}

impl FindingKind {
    /// Returns the original's message for the kind. `None` for positions and velocities, which only raise residuals,
    /// and for kinds that the original does not check.
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

/// One fault of a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The step number, from 1.
    pub step: u32,
    /// The frame of the trace that was compared, from 0 (the initial record).
    pub frame: u64,
    /// The fault and its values.
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
    /// A collision of the reference is missing in the trace.
    MissedCollision {
        /// The reference's collision.
        expected: Impulse,
    },
    /// A collision of the trace is missing in the reference.
    SuperfluousCollision {
        /// The trace's collision.
        actual: LoggedImpulse,
    },
    /// The collision is in both, with different normals.
    WrongNormal {
        /// The reference's collision.
        expected: Impulse,
        /// The trace's first collision of the same pair.
        actual: LoggedImpulse,
        /// The Euclidean distance of the normals.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
    },
    /// The number of polynomials differs.
    PolynomialCount {
        /// The number of polynomials of the reference.
        expected: usize,
        /// The number of polynomials of the trace.
        actual: usize,
        /// The number of polynomials in one detection pass over all pairs, with which missing and surplus passes are
        /// counted.
        per_pass: usize,
    },
    /// The number of detection passes differs in one part of the step (fair rules).
    PassCount {
        /// The part of the step.
        part: Part,
        /// The number of passes of the reference.
        expected: usize,
        /// The number of passes of the trace.
        actual: usize,
    },
    /// The number of coefficients differs.
    PolynomialDegree {
        /// The place of the polynomial.
        place: PolynomialPlace,
        /// The reference's polynomial.
        expected: Polynomial,
        /// The trace's number of coefficients.
        actual_size: usize,
        /// The trace's first coefficients (at most six).
        actual: Polynomial,
    },
    /// The reference's polynomial vanishes, but the trace's does not.
    VanishingPolynomial {
        /// The place of the polynomial.
        place: PolynomialPlace,
        /// The reference's polynomial.
        expected: Polynomial,
        /// The trace's polynomial.
        actual: Polynomial,
    },
    /// A coefficient differs.
    Coefficient {
        /// The place of the polynomial.
        place: PolynomialPlace,
        /// The highest power of t whose coefficient differs after division by the factor of most coefficients.
        power: usize,
        /// The reference's coefficient, multiplied by that factor.
        #[serde(with = "fosssim_num::written")]
        expected: f64,
        /// The trace's coefficient.
        #[serde(with = "fosssim_num::written")]
        actual: f64,
        /// The distance between both coefficients.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
        /// The values that the original compares; `None` from the fair rules.
        rescaled: Option<RescaledCoefficient>,
        /// The reference's whole polynomial, not rescaled.
        expected_polynomial: Polynomial,
        /// The trace's whole polynomial.
        actual_polynomial: Polynomial,
    },
    /// A position differs by more than the bound of the maximum position residual.
    Position {
        /// The particle.
        particle: usize,
        /// The reference's position (x, y).
        #[serde(with = "fosssim_num::written")]
        expected: [f64; 2],
        /// The trace's position (x, y).
        #[serde(with = "fosssim_num::written")]
        actual: [f64; 2],
        /// The Euclidean distance of the positions.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
    },
    /// A velocity differs by more than the bound of the maximum velocity residual.
    Velocity {
        /// The particle.
        particle: usize,
        /// The reference's velocity (x, y).
        #[serde(with = "fosssim_num::written")]
        expected: [f64; 2],
        /// The trace's velocity (x, y).
        #[serde(with = "fosssim_num::written")]
        actual: [f64; 2],
        /// The Euclidean distance of the velocities.
        #[serde(with = "fosssim_num::written")]
        residual: f64,
    },
    /// The time of impact differs from the time at which the polynomials become positive (fair rules).
    ContactTime {
        /// The reference's collision.
        expected: Impulse,
        /// The trace's collision.
        actual: LoggedImpulse,
    },
    /// The trace repeats a collision (fair rules).
    RepeatedCollision {
        /// The repeated collision.
        actual: LoggedImpulse,
    },
    /// The polynomial of a pair that a response or the failsafe has moved matches the motion neither before nor after
    /// (fair rules). If the polynomial is right, the particles' positions are wrong.
    PassPositions {
        /// The place of the first such polynomial.
        place: PolynomialPlace,
    },
    /// The mid record and the end record of the step contradict each other (fair rules).
    RecordsDiffer {
        /// The part of the record that differs.
        part: RecordPart,
    },
    /// A polynomial has more coefficients than any detection computes, or small leading ones, which the course's
    /// library drops (fair rules).
    ImpossibleLog,
    /// The trace's polynomials lack coefficients that the course's library drops after a scaling, and a decision
    /// depends on them (fair rules).
    TrimmedDecision {
        /// The place of the pair's first polynomial.
        place: PolynomialPlace,
        /// Whether the pair collides.
        collides: bool,
    },
    /// The trace's polynomials lack coefficients that the course's library drops after a scaling, and a time of impact
    /// depends on them (fair rules).
    TrimmedTime {
        /// The place of the pair's first polynomial.
        place: PolynomialPlace,
        /// The time of impact with all coefficients.
        #[serde(with = "fosssim_num::written")]
        expected: f64,
        /// The time of impact that the trace's polynomials have.
        #[serde(with = "fosssim_num::written")]
        actual: f64,
    },
    /// A state cannot be judged, because it contains NaN or is far larger than every state that the scene leads to
    /// (fair rules).
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
    /// The trace mixes the two accepted forms of the approach polynomial (fair rules).
    MixedForms {
        /// The place of the first such polynomial.
        place: PolynomialPlace,
    },
    /// The penalty force between two near bodies was left out or applied twice (fair rules).
    PairForce {
        /// The pair of bodies.
        pair: Pair,
        /// Whether the force was applied twice; otherwise it was left out.
        is_doubled: bool,
    },
    /// The trace's own state or its polynomials have no next state (fair rules).
    NoResult {
        /// The numerical error that ended the step.
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

    /// Returns the pair of the finding; `None` if it has none, or if the trace names objects that do not form a pair.
    #[must_use]
    pub fn pair(&self) -> Option<Pair> {
        match (self, self.place()) {
            (Self::SuperfluousCollision { actual } | Self::RepeatedCollision { actual }, _) => actual.pair(),
            (_, FindingPlace::Pair(pair)) => Some(pair),
            (_, FindingPlace::Polynomial(place)) => Some(place.pair),
            _ => None,
        }
    }

    /// Returns the detection pass of the finding, if it has one.
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
    /// The whole step.
    Step,
    /// A pair of the scene.
    Pair(Pair),
    /// A polynomial of the step.
    Polynomial(PolynomialPlace),
    /// A particle, by its index.
    Particle(usize),
    /// Two object numbers in the trace that do not form a pair of the scene.
    Objects(i32, i32),
}

/// A coefficient as the original compares it: rescaled by the sum of absolute values, so that one wrong coefficient
/// changes all others.
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
    /// The distance between both coefficients.
    #[serde(with = "fosssim_num::written")]
    #[schemars(with = "fosssim_num::written::Number")]
    pub residual: f64,
}

/// A part of a step's collision handling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Part {
    /// The part before the mid record: the single pass, or the impulse rounds.
    Impulses,
    /// The impact zones and the rigid failsafe.
    Geometric,
}

/// The part in which two records of a step contradict each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordPart {
    /// The positions or velocities.
    State,
    /// The impulse lists.
    Impulses,
    /// The polynomial lists.
    Polynomials,
}

/// The place of a polynomial in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PolynomialPlace {
    /// The detection pass of the polynomial.
    pub pass: Pass,
    /// The pair that the polynomial belongs to.
    pub pair: Pair,
    /// The role of the polynomial.
    pub role: Role,
    /// The index in the frame's list of polynomials, from 0.
    pub index: usize,
}

fosssim_num::closed_set! {
    /// The meaning of a detection polynomial if it is positive (collisions.md 2).
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
