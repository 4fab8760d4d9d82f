//! Findings, which describe faults in a step and where they are.
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
        /// The reference has a collision that is not in the trace.
        MissedCollision = "missed collision",
        /// The trace has a collision that the reference does not have.
        SuperfluousCollision = "superfluous collision",
        /// The trace and the reference have the same collision with different contact normals.
        WrongNormal = "wrong contact normal",
        /// The step logs a wrong number of polynomials, because detection ran too often or not often enough.
        PolynomialCount = "wrong number of polynomials",
        /// A polynomial has a wrong number of coefficients.
        PolynomialDegree = "wrong polynomial degree",
        /// All coefficients of the reference are tiny, but the trace has a larger one.
        VanishingPolynomial = "polynomial should vanish",
        /// A coefficient differs after the polynomials were rescaled.
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
        PassPositions = "polynomial computed from wrong positions",
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
        /// Fair rules: the reference's step from the trace's own state has no result.
        NoResult = "no next state",
    }
}

impl FindingKind {
    /// Returns the original's message for findings of this kind. Returns `None` for positions and velocities, which
    /// only increase residuals, and for kinds that the original does not check.
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

/// A fault in a step of a trace.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The number of the step, from 1; 0 is the first record.
    pub step: u32,
    /// The index of the record that was compared, from 0 for the initial record.
    pub frame: u64,
    /// The fault, with the values that show it.
    pub detail: FindingDetail,
}

impl Finding {
    /// Returns the finding's kind.
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

/// The fault, with the expected values of the reference and the actual values of the trace.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum FindingDetail {
    /// The reference has a collision that is not in the trace.
    MissedCollision {
        /// The collision of the reference.
        expected: Impulse,
    },
    /// The trace has a collision that the reference does not have.
    SuperfluousCollision {
        /// The collision in the trace.
        actual: LoggedImpulse,
    },
    /// The trace and the reference have the same collision, but their normals differ.
    WrongNormal {
        /// The collision of the reference.
        expected: Impulse,
        /// The first collision of this pair in the trace.
        actual: LoggedImpulse,
        /// The Euclidean distance between the two normals.
        #[serde(with = "fosssim_num::number_serde")]
        residual: f64,
    },
    /// The number of polynomials differs.
    PolynomialCount {
        /// The number of polynomials that the reference logs.
        expected: usize,
        /// The number of polynomials that the trace logs.
        actual: usize,
        /// The number of polynomials that one detection pass over all pairs logs. With it, missing and surplus passes
        /// are counted.
        per_pass: usize,
    },
    /// The number of detection passes differs in one part of the step (fair rules).
    PassCount {
        /// The part of the step.
        part: Part,
        /// The number of passes that the reference makes.
        expected: usize,
        /// The number of passes that the trace has.
        actual: usize,
    },
    /// The number of coefficients differs.
    PolynomialDegree {
        /// The polynomial, by its pass, pair and index.
        place: PolynomialPlace,
        /// The polynomial of the reference.
        expected: Polynomial,
        /// The number of coefficients in the trace.
        actual_size: usize,
        /// The first coefficients in the trace, at most six.
        actual: Polynomial,
    },
    /// The reference's polynomial is zero up to round-off, but the trace's polynomial is not zero.
    VanishingPolynomial {
        /// The polynomial, by its pass, pair and index.
        place: PolynomialPlace,
        /// The polynomial of the reference.
        expected: Polynomial,
        /// The polynomial of the trace.
        actual: Polynomial,
    },
    /// A coefficient differs.
    Coefficient {
        /// The polynomial, by its pass, pair and index.
        place: PolynomialPlace,
        /// The highest power of t whose coefficient differs after division by the factor that most coefficients have in
        /// common.
        power: usize,
        /// The reference's coefficient, multiplied by that factor.
        #[serde(with = "fosssim_num::number_serde")]
        expected: f64,
        /// The coefficient in the trace.
        #[serde(with = "fosssim_num::number_serde")]
        actual: f64,
        /// The distance between the two coefficients.
        #[serde(with = "fosssim_num::number_serde")]
        residual: f64,
        /// The coefficients in the form in which the original compares them; `None` for the fair rules.
        rescaled: Option<RescaledCoefficient>,
        /// The whole polynomial of the reference, without the factor.
        expected_polynomial: Polynomial,
        /// The whole polynomial of the trace.
        actual_polynomial: Polynomial,
    },
    /// A position differs by more than the bound of the maximum position residual.
    Position {
        /// The index of the particle.
        particle: usize,
        /// The position (x, y) in the reference.
        #[serde(with = "fosssim_num::number_serde")]
        expected: [f64; 2],
        /// The position (x, y) in the trace.
        #[serde(with = "fosssim_num::number_serde")]
        actual: [f64; 2],
        /// The Euclidean distance between the two positions.
        #[serde(with = "fosssim_num::number_serde")]
        residual: f64,
    },
    /// A velocity differs by more than the bound of the maximum velocity residual.
    Velocity {
        /// The index of the particle.
        particle: usize,
        /// The velocity (x, y) in the reference.
        #[serde(with = "fosssim_num::number_serde")]
        expected: [f64; 2],
        /// The velocity (x, y) in the trace.
        #[serde(with = "fosssim_num::number_serde")]
        actual: [f64; 2],
        /// The Euclidean distance between the two velocities.
        #[serde(with = "fosssim_num::number_serde")]
        residual: f64,
    },
    /// The time of impact differs from the time at which the polynomials become positive (fair rules).
    ContactTime {
        /// The collision of the reference.
        expected: Impulse,
        /// The collision in the trace.
        actual: LoggedImpulse,
    },
    /// The trace logs a collision more than once (fair rules).
    RepeatedCollision {
        /// The collision that is logged again.
        actual: LoggedImpulse,
    },
    /// The polynomial of a pair that a response or the failsafe has moved matches neither the motion before it nor the
    /// motion after it (fair rules). If the polynomial is right, the particles' positions are wrong.
    PassPositions {
        /// The first such polynomial, by its pass, pair and index.
        place: PolynomialPlace,
    },
    /// The mid record and the end record of the step contradict each other (fair rules).
    RecordsDiffer {
        /// The part of the record that differs.
        part: RecordPart,
    },
    /// A polynomial could not have been logged by the course's library: it has more coefficients than any detection
    /// computes, or small leading ones, which the library drops (fair rules).
    ImpossibleLog,
    /// A decision of the trace depends on coefficients that are missing in its polynomials, because the course's
    /// library drops small ones after a scaling (fair rules).
    TrimmedDecision {
        /// The first polynomial of the pair, by its pass and index.
        place: PolynomialPlace,
        /// Whether the pair collides if no coefficient is missing.
        collides: bool,
    },
    /// A time of impact in the trace depends on coefficients that are missing in its polynomials, because the course's
    /// library drops small ones after a scaling (fair rules).
    TrimmedTime {
        /// The first polynomial of the pair, by its pass and index.
        place: PolynomialPlace,
        /// The time of impact if no coefficient is missing.
        #[serde(with = "fosssim_num::number_serde")]
        expected: f64,
        /// The time of impact according to the trace's polynomials.
        #[serde(with = "fosssim_num::number_serde")]
        actual: f64,
    },
    /// A state cannot be judged, because it is not finite, or far from every state that the scene leads to (fair
    /// rules).
    BeyondReach {
        /// The index of the particle.
        particle: usize,
        /// The particle's position (x, y) in the trace.
        #[serde(with = "fosssim_num::number_serde")]
        position: [f64; 2],
        /// The particle's velocity (x, y) in the trace.
        #[serde(with = "fosssim_num::number_serde")]
        velocity: [f64; 2],
    },
    /// The trace mixes the two accepted forms of the approach polynomial (fair rules).
    MixedForms {
        /// The first polynomial that has the other form, by its pass, pair and index.
        place: PolynomialPlace,
    },
    /// The penalty force between two nearby bodies was left out or applied twice (fair rules).
    PairForce {
        /// The pair whose force is wrong.
        pair: Pair,
        /// Whether the force was applied twice; otherwise it was left out.
        is_doubled: bool,
    },
    /// The reference's step from the trace's own state or polynomials has no result (fair rules).
    NoResult {
        /// The reason why the step has no result.
        error: StepError,
    },
}

impl FindingDetail {
    /// Returns the object of the step that the finding is about.
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

    /// Returns the pair that the finding is about; `None` if it is not about a pair, or if the trace names objects that
    /// do not form one.
    pub fn pair(&self) -> Option<Pair> {
        match (self, self.place()) {
            (Self::SuperfluousCollision { actual } | Self::RepeatedCollision { actual }, _) => actual.pair(),
            (_, FindingPlace::Pair(pair)) => Some(pair),
            (_, FindingPlace::Polynomial(place)) => Some(place.pair),
            _ => None,
        }
    }

    /// Returns the detection pass that the finding is about, if it is about one.
    pub const fn pass(&self) -> Option<Pass> {
        match self.place() {
            FindingPlace::Polynomial(place) => Some(place.pass),
            _ => None,
        }
    }
}

/// The object of the step that a finding is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FindingPlace {
    /// The step as a whole.
    Step,
    /// A pair of the scene.
    Pair(Pair),
    /// A polynomial of the step.
    Polynomial(PolynomialPlace),
    /// A particle, given by its index.
    Particle(usize),
    /// Two objects, given by their numbers in the trace, which do not form a pair of the scene.
    Objects(i32, i32),
}

/// A coefficient in the form in which the original compares it. Both polynomials are divided by the sums of their
/// absolute values, so a single wrong coefficient changes all others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RescaledCoefficient {
    /// The highest power of t whose coefficient is beyond the original's bound.
    #[serde(rename = "coefficient")]
    pub power: usize,
    /// The coefficient of the reference, scaled to the size of the trace's polynomial.
    #[serde(with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub expected: f64,
    /// The coefficient in the trace.
    #[serde(with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub actual: f64,
    /// The distance between the two coefficients.
    #[serde(with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    pub residual: f64,
}

/// A part of the collision handling in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Part {
    /// The part before the mid record, which is the single pass or the impulse rounds.
    Impulses,
    /// The geometric part: the impact zones and the rigid failsafe.
    Geometric,
}

/// The part of a step's two records in which they contradict each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordPart {
    /// The positions or velocities.
    State,
    /// The lists of impulses.
    Impulses,
    /// The lists of polynomials.
    Polynomials,
}

/// A polynomial of a step, identified by its pass, pair, condition and index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PolynomialPlace {
    /// The detection pass to which the polynomial belongs.
    pub pass: Pass,
    /// The pair to which the polynomial belongs.
    pub pair: Pair,
    /// The condition that the polynomial describes.
    pub role: Role,
    /// The index of the polynomial in the record's list, from 0.
    pub index: usize,
}

fosssim_num::closed_set! {
    /// The condition that holds while a detection polynomial is positive (collisions.md 2).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "snake_case")]
    pub enum Role {
        /// The objects overlap: their distance is smaller than the sum of their radii.
        Overlap = "overlap",
        /// The closest point is after the edge's first endpoint (alpha > 0).
        AlphaAboveZero = "alpha > 0",
        /// The closest point is before the edge's second endpoint (alpha < 1).
        AlphaBelowOne = "alpha < 1",
        /// The objects approach each other.
        Approach = "approach",
    }
}

impl Role {
    /// Returns the role of the polynomial with the index `number` in a detection call.
    pub const fn from_number(kind: PairKind, number: usize) -> Self {
        match (kind, number) {
            (_, 0) => Self::Overlap,
            (PairKind::ParticleEdge, 1) => Self::AlphaAboveZero,
            (PairKind::ParticleEdge, 2) => Self::AlphaBelowOne,
            _ => Self::Approach,
        }
    }
}
