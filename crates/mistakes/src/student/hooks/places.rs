//! Where an operator can change a program, and what operators do there.
use std::fmt;

/// Something that stands in the program.
///
/// `Kind` is that of a pair, 0 for two particles, 1 for a particle and an edge, 2 for a particle and a half-plane;
/// `Role` is 0 for the particle, 1 for the other one or the first end of the edge, 2 for its second end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each has its line in the table below")]
pub enum Place {
    PairsOfPass,
    OwnFirstEnd,
    OwnSecondEnd,
    SeenEnd { role: usize },
    SeenOther,
    SeenHalfPlane,
    SeenRadius { kind: usize, role: usize },
    SeenMotion { kind: usize, role: usize },
    Coefficient { kind: usize, polynomial: usize, index: usize },
    LastTime,
    ContactVector { kind: usize },
    ContactAlpha,
    ContactTime { kind: usize },
    StepStart,
    ContinuousPrediction,
    LoggedImpulses,
    Restitution,
    UnitVector { kind: usize },
    MeanVelocity { kind: usize, role: usize },
    Simultaneous { kind: usize },
    ResponseMass { kind: usize, role: usize },
    InfiniteMass { kind: usize, role: usize },
    SparesFixed { kind: usize, role: usize },
    VelocityChange { kind: usize, role: usize },
    PositionChange { kind: usize, role: usize },
    ResponseEnd { role: usize },
    ResponseTime,
    ResponseAlpha,
    ResponseClampLow,
    ResponseClampHigh,
    SquareInInertia { role: usize },
    RoundLimit,
    RoundContacts,
    RoundIsEmpty,
    RoundPrediction,
    RoundContactsKept,
    LoopSucceeds,
    NeedsZones,
    FirstZoneContacts,
    LaterZoneContacts,
    ZoneContactsKept,
    ZonesMoved { later: usize },
    ZonePrediction,
    ZonesAreTheSame,
    ZonesBefore,
    ZoneEnd { role: usize },
    ZoneOther,
    ZoneFlag { kind: usize },
    ZonesMeet,
    ZonesShare,
    ZonesToMerge,
    MergedAgain,
    FlagOfOld,
    FlagOfNew,
    JoinedParticles,
    SameParticles,
    SameFlag,
    FreeZone,
    HeldZone,
    FixedHolds,
    HalfPlaneHolds,
    AskedWhetherFixed,
    StoppedParticles,
    StoppedPosition,
    StoppedVelocity,
    SummedParticles,
    SumMass,
    SumMotion,
    TurningParticles,
    TurnMotion,
    TurnArm,
    AngularMomentum,
    Inertia,
    Angle,
    Cosine,
    Sine,
    CarriedParticles,
    CarriedArm,
    CarriedCentre,
    CarriedShift,
    CarriedVelocity,
}

/// A change of the value at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// An index: the one of the partner stands there.
    Other,
    /// An index: the one behind the partner's.
    AfterOther,
    /// An index: the next one.
    Next,
    /// An index: the one before.
    Previous,
    /// An index: 0.
    First,
    /// A number or a vector: 0.
    Zero,
    /// A number or a vector with the other sign.
    Negated,
    /// Twice the number or the vector.
    Doubled,
    /// Half the number.
    Halved,
    /// A vector: its components change places.
    AxesExchanged,
    /// A condition: it holds.
    Always,
    /// A condition: it does not hold.
    Never,
    /// A list: its first entry is skipped.
    WithoutFirst,
    /// A list: its last entry is skipped.
    WithoutLast,
    /// A list: the loop is left after the first entry.
    FirstOnly,
    /// A list: every entry overwrites the one before.
    LastOnly,
    /// A list: it is gone through backwards.
    Reversed,
    /// A list: it is gone through twice.
    Repeated,
    /// A list: it is not gone through.
    Empty,
    /// A count: one more.
    OneMore,
    /// A count: one less.
    OneLess,
    /// A value: another one that the program has at hand, as a rule of before.
    Stale,
    /// A block: it is left at once.
    Skipped,
    /// A block: it is left where the number that it computes first is zero.
    AtZero,
    /// A block: it is left where that number is not zero.
    NotAfterZero,
}

/// One change of one place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mutation {
    /// Where.
    pub place: Place,
    /// What.
    pub operator: Operator,
}

impl fmt::Display for Mutation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {:?}", self.place, self.operator)
    }
}
