//! Faults of a stage of a step that no known mistake explains. Their measured values are in
//! [`StageDetail`](super::StageDetail).
use super::area::Area;
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};

/// The stages of a step that can be distinguished, in the order of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum StepStage {
    /// The decisions whether and when pairs collide.
    Detection,
    /// The vectors between colliding objects.
    ContactVectors,
    /// Collision responses and impulse rounds.
    Responses,
    /// Impact zones and the rigid failsafe.
    Zones,
}

/// The fault of a stage whose inputs are right.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum StageFault {
    /// The pairs are checked in the wrong order.
    Order,
    /// Polynomials are right, but decisions are wrong.
    Decisions {
        /// The kind of all affected pairs, if they are of one kind.
        kind: Option<PairKind>,
        /// The way in which the decisions are wrong.
        wrong: WrongDecisions,
    },
    /// The choice of colliding bodies is wrong among those that overlap at the end of a step.
    Overlaps {
        /// The kind of all affected pairs, if they are of one kind.
        kind: Option<PairKind>,
        /// The way in which the decisions are wrong.
        wrong: WrongDecisions,
    },
    /// A state changes wrongly, in a trace that logs only states.
    Change(WrongChange),
    /// Times of impact are wrong.
    ContactTimes,
    /// Contact vectors are wrong.
    ContactVectors {
        /// The kind of all affected pairs, if they are of one kind.
        kind: Option<PairKind>,
        /// The fault of the vectors.
        wrong: WrongVectors,
    },
    /// The changes that isolated contacts cause are wrong.
    Responses {
        /// The kind of all affected pairs, if they are of one kind and other kinds are right.
        kind: Option<PairKind>,
        /// The fault of the changes.
        wrong: WrongResponses,
        /// Whether the fault occurs only in impulse rounds, which pass the changed values on.
        in_rounds: bool,
    },
    /// The state after several contacts is wrong, although isolated contacts are right.
    ManyContacts,
    /// Contacts of the first impulse round have no effect.
    Unresolved {
        /// Whether no contact of the first round has an effect; otherwise some have one.
        all: bool,
    },
    /// The number of impulse rounds is wrong.
    Rounds(WrongNumber),
    /// The impulse rounds are right, but pass on wrong values.
    HandedOver {
        /// The wrong quantity: positions or velocities; `None` for both.
        quantity: Option<Quantity>,
        /// The way in which the loop ends when the values are wrong; `None` if they are always wrong.
        when: Option<LoopEnd>,
        /// Whether wrong responses could also cause the fault.
        or_response: bool,
    },
    /// The changes that contacts of the first impulse round cause are wrong.
    FirstRound,
    /// The changes that several contacts of the first impulse round cause together are wrong, although isolated
    /// contacts are right.
    LaterRounds,
    /// Rounds after the first one use the predicted positions again for detection.
    RoundsOfPrediction,
    /// The second detection is right, but the rounds after it are wrong.
    BehindFirstRound,
    /// The geometric part runs, or does not run, at the wrong time.
    Geometric(WrongGeometric),
    /// A detection pass of the geometric part uses wrong positions.
    ZonePositions(WrongPositions),
    /// The part of the step after the impulse rounds is wrong.
    AfterRounds,
    /// Zones are wrong in later rounds.
    ZoneRounds(WrongZoneRounds),
    /// The choice of the zones that are moved or stopped is wrong.
    Zones(WrongZones),
    /// The motion of zones is wrong.
    Motion {
        /// The faults of the zones' motion.
        wrong: Vec<WrongMotion>,
        /// Whether wrongly chosen zones could also cause the fault.
        or_zones: bool,
    },
}

/// The properties that wrong changes of states have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WrongChange {
    /// The wrong quantity. If positions are wrong, velocities are right. If velocities are wrong, positions agree with
    /// them.
    pub quantity: Quantity,
    /// The only wrong component: 0 for x or 1 for y; `None` for both.
    pub axis: Option<usize>,
    /// The particles whose state changes wrongly.
    pub particles: ChangedParticles,
    /// The ratio to the expected changes.
    pub ratio: ChangeRatio,
    /// The code of the student that makes the changes.
    pub cause: ChangeCause,
}

/// The part of a student's code that changes states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ChangeCause {
    /// Responses to simple collisions.
    Response,
    /// The penalty force.
    Penalty,
    /// Forces.
    Forces,
    /// The integrator.
    Integrator,
    /// Forces or the integrator.
    ForcesOrIntegrator,
    /// The forces' derivatives or the integrator.
    JacobiansOrIntegrator,
}

fosssim_num::closed_set! {
    /// The particles whose state changes wrongly.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ChangedParticles {
        /// Some particles, without a common property.
        Any = "",
        /// Only fixed particles.
        Fixed = " of fixed particles only",
        /// Only the first particle.
        First = " of the first particle only",
        /// Only the last particle.
        Last = " of the last particle only",
    }
}

fosssim_num::closed_set! {
    /// The common factor of all wrong changes.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ChangeRatio {
        /// There is no change.
        Nothing = "stay as they were",
        /// The change has the opposite direction.
        Opposite = "change the opposite way",
        /// The change is multiplied by some other factor.
        Factor = "change by a wrong factor, which is always the same",
        /// The changes have no ratio in common.
        Other = "change wrongly",
    }
}

fosssim_num::closed_set! {
    /// The way in which decisions about contacts are wrong.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongDecisions {
        /// Contacts are missed.
        Missed = "contacts that its polynomials show are not counted",
            "collisions of bodies that overlap and approach each other are missed";
        /// Contacts are found that do not exist.
        Superfluous = "contacts are counted that its polynomials do not show",
            "collisions are found between bodies that do not overlap, or do not approach each other";
        /// Some contacts are missed, and others do not exist.
        Both = "the polynomials are right, the decisions are not: contacts are missed, others are superfluous",
            "some collisions are missed, and others are found that do not exist";
    }
    /// Returns the sentence about bodies that overlap at the end of a step.
    of_overlaps
}

fosssim_num::closed_set! {
    /// A fault of contact vectors.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongVectors {
        /// The vectors are perpendicular to the expected ones.
        Perpendicular = "it is perpendicular to the right vector",
        /// The vectors have the wrong direction.
        Direction = "it has the wrong direction",
        /// The vectors have length zero.
        Zero = "it has no length",
        /// The vectors are right except for their last digits.
        Inexact = "it is right except for its last digits",
        /// The vectors point in the opposite direction.
        Reversed = "it points in the opposite direction",
        /// The vectors have the right direction and the wrong length.
        Length = "it has the right direction, but not the right length",
    }
}

/// A fault of the changes by isolated contacts.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum WrongResponses {
    /// The responses change nothing.
    Nothing,
    /// The responses do not change some quantities.
    Unchanged(Vec<ChangedQuantity>),
    /// The responses also change some quantities across the contact vector.
    Across(Vec<ChangedQuantity>),
    /// The responses change some quantities along the contact vector by a wrong amount.
    Amount(Vec<ChangedQuantity>),
}

/// A quantity that a contact changes, and its owner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ChangedQuantity {
    /// The kind of the contact's pair.
    pub kind: PairKind,
    /// The body: 0 is the pair's (first) particle; 1 is the second particle, or the edge's first endpoint; 2 is the
    /// edge's second endpoint.
    pub body: usize,
    /// The quantity that changes.
    pub quantity: Quantity,
}

/// A quantity of a body's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Quantity {
    /// The position of the body.
    Position,
    /// The velocity of the body.
    Velocity,
}

fosssim_num::closed_set! {
    /// The way in which a number of rounds is wrong.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongNumber {
        /// The loop makes too few rounds.
        Fewer = "the loop makes fewer rounds than it should",
        /// The loop makes too many rounds.
        More = "the loop makes more rounds than it should",
        /// The loop makes too few rounds in some steps, and too many in others.
        Other = "the loop makes a wrong number of rounds",
    }
}

/// The way in which the geometric part runs at the wrong time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WrongGeometric {
    /// The geometric part makes no pass although the maximum number of rounds was used.
    Left {
        /// Whether the geometric part is always missing; otherwise only in some steps.
        always: bool,
    },
    /// The geometric part makes passes although nothing collides.
    Superfluous,
}

fosssim_num::closed_set! {
    /// The positions that the geometric part uses by mistake.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongPositions {
        /// The first round uses the predicted positions of the integrator.
        Prediction =
            "the first zones are searched on the predicted positions, not on those after the impulse rounds",
        /// The first round uses positions other than those after the impulse rounds.
        First = "the first zones are searched on wrong positions, not on those after the impulse rounds",
        /// The detection after the failsafe uses the positions before it.
        BeforeFailsafe = "the detection after the failsafe uses the positions before it",
    }
}

/// The reason why impulse rounds end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LoopEnd {
    /// The maximum number of rounds was used.
    RanOut,
    /// No pair collides.
    Settled,
}

fosssim_num::closed_set! {
    /// A fault of the rounds in which zones grow.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongZoneRounds {
        /// The zones are wrong.
        Growth = "zones are right in the first round, but not as they grow",
        /// There are too few rounds.
        Fewer = "the zones make fewer rounds than they should",
        /// There are too many rounds.
        More = "the zones make more rounds than they should",
        /// The zones or the number of rounds are wrong, from a later round on.
        Later = "the zones are right in the first round, but later rounds are wrong or too few",
    }
}

fosssim_num::closed_set! {
    /// A fault of the choice of zones that are moved or stopped.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongZones {
        /// Some particles of a zone are not moved with it.
        Partly = "some of a zone's particles are not moved with it",
        /// Some particles of a zone that has to stop do not stop.
        PartlyStopped = "in zones that must stop, some particles do not",
        /// Zones are not moved.
        Unmoved = "some zones that should move do not",
        /// Zones stop that should move.
        Stop = "zones stop although nothing in them is fixed",
        /// Contacts that share particles are moved one after the other.
        NotMerged = "zones that share particles are moved one after the other, not as one",
        /// Zones that share no particle are moved as one zone.
        Joined = "zones that share no particle are moved as one",
        /// Particles are moved that belong to no zone.
        Others = "zones move particles that do not belong to them",
        /// Zones that have to stop move on as rigid bodies.
        MoveOn = "zones that must stop move on as rigid bodies",
        /// Zones that have to stop keep their new positions.
        KeepPositions = "zones that must stop do not go back to their start",
        /// Zones that have to stop keep some velocity.
        KeepVelocities = "zones that must stop keep their velocities",
    }
}

fosssim_num::closed_set! {
    /// A fault of the motion of zones.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongMotion {
        /// The motion of the zones' center of mass.
        Center = "the center of mass of a zone does not move as it should",
        /// The distances between particles of a zone change.
        Distances = "the distances between particles of a zone change",
        /// The zones do not rotate.
        NoTurn = "zones do not rotate",
        /// The zones rotate less than they should.
        LessTurn = "zones rotate too little",
        /// The zones rotate further than they should.
        MoreTurn = "zones rotate too much",
        /// The zones rotate in the opposite direction.
        TurnBack = "zones rotate in the opposite direction",
        /// The zones rotate by a wrong angle.
        Turn = "zones rotate by a wrong angle",
        /// The zones' velocities are wrong.
        Velocities = "velocities in a zone do not match its motion from start to end",
        /// The speeds in the zones are wrong.
        Speeds = "velocities in a zone have the direction of its motion from start to end, but the wrong size",
    }
}

impl StageFault {
    /// Returns the stage that the fault is in.
    #[must_use]
    pub const fn stage(&self) -> StepStage {
        match self {
            Self::Order | Self::Decisions { .. } | Self::ContactTimes | Self::Overlaps { .. } => StepStage::Detection,
            Self::ContactVectors { .. } => StepStage::ContactVectors,
            Self::Responses { .. }
            | Self::Change(_)
            | Self::ManyContacts
            | Self::Unresolved { .. }
            | Self::Rounds(_)
            | Self::HandedOver { .. }
            | Self::FirstRound
            | Self::LaterRounds
            | Self::RoundsOfPrediction
            | Self::BehindFirstRound
            | Self::Geometric(_) => StepStage::Responses,
            Self::AfterRounds | Self::ZonePositions(_) | Self::ZoneRounds(_) | Self::Zones(_) | Self::Motion { .. } => {
                StepStage::Zones
            }
        }
    }

    /// Returns the parts of the assignment that may contain the mistake.
    #[must_use]
    pub const fn areas(&self) -> &'static [Area] {
        match self {
            Self::Order | Self::Decisions { .. } | Self::ContactTimes => &[Area::Decision],
            Self::Overlaps { .. } => &[Area::SimpleDetection],
            Self::Change(WrongChange { cause, .. }) => match cause {
                ChangeCause::Response => &[Area::Response],
                ChangeCause::Penalty => &[Area::Penalty],
                ChangeCause::Forces => &[Area::Forces],
                ChangeCause::Integrator => &[Area::Integrator],
                ChangeCause::ForcesOrIntegrator => &[Area::Forces, Area::Integrator],
                ChangeCause::JacobiansOrIntegrator => &[Area::Jacobians, Area::Integrator],
            },
            Self::ContactVectors { .. } => &[Area::ContactVector],
            Self::Responses { in_rounds: false, .. } | Self::ManyContacts => &[Area::Response],
            // The trace of a hybrid step contains no contact vector.
            Self::Responses { wrong: WrongResponses::Across(_), .. } => {
                &[Area::ContactVector, Area::Response, Area::ImpulseLoop]
            }
            Self::FirstRound => &[Area::Decision, Area::ContactVector, Area::Response, Area::ImpulseLoop],
            Self::Unresolved { .. } => &[Area::Decision, Area::Response, Area::ImpulseLoop],
            Self::Responses { .. } | Self::HandedOver { or_response: true, .. } => &[Area::Response, Area::ImpulseLoop],
            Self::Rounds(_) | Self::BehindFirstRound => &[Area::ImpulseLoop, Area::Decision],
            Self::HandedOver { or_response: false, .. }
            | Self::LaterRounds
            | Self::RoundsOfPrediction
            | Self::Geometric(WrongGeometric::Left { always: false } | WrongGeometric::Superfluous) => {
                &[Area::ImpulseLoop]
            }
            Self::Geometric(WrongGeometric::Left { always: true }) => &[Area::ImpulseLoop, Area::ImpactZones],
            Self::ZonePositions(_)
            | Self::ZoneRounds(WrongZoneRounds::Fewer | WrongZoneRounds::More)
            | Self::Zones(WrongZones::Partly | WrongZones::NotMerged | WrongZones::Joined | WrongZones::Others) => {
                &[Area::ImpactZones]
            }
            // The wrong effect of a larger zone may also be caused by the code that moves it.
            Self::AfterRounds
            | Self::ZoneRounds(WrongZoneRounds::Growth | WrongZoneRounds::Later)
            | Self::Motion { or_zones: true, .. }
            | Self::Zones(WrongZones::Unmoved | WrongZones::Stop | WrongZones::MoveOn | WrongZones::PartlyStopped) => {
                &[Area::ImpactZones, Area::Failsafe]
            }
            Self::Zones(WrongZones::KeepPositions | WrongZones::KeepVelocities)
            | Self::Motion { or_zones: false, .. } => &[Area::Failsafe],
        }
    }

    /// Returns the kind of pair, if the fault concerns only one.
    #[must_use]
    pub const fn kind(&self) -> Option<PairKind> {
        match self {
            Self::Decisions { kind, .. }
            | Self::Overlaps { kind, .. }
            | Self::ContactVectors { kind, .. }
            | Self::Responses { kind, .. } => *kind,
            _ => None,
        }
    }

    /// Returns the explanation's key.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Order => "stage-order",
            Self::Decisions { wrong: WrongDecisions::Missed, .. } => "stage-contacts-missed",
            Self::Decisions { wrong: WrongDecisions::Superfluous, .. } => "stage-contacts-superfluous",
            Self::Decisions { wrong: WrongDecisions::Both, .. } => "stage-decisions",
            Self::Overlaps { .. } => "stage-overlaps",
            Self::Change(_) => "stage-change",
            Self::ContactTimes => "stage-contact-times",
            Self::ContactVectors { .. } => "stage-contact-vectors",
            Self::Responses { .. } | Self::ManyContacts => "stage-response",
            Self::FirstRound => "stage-first-round",
            Self::Unresolved { .. } => "stage-unresolved",
            Self::Rounds(_) => "stage-rounds",
            Self::HandedOver { .. } => "stage-handed-over",
            Self::LaterRounds => "stage-loop",
            Self::RoundsOfPrediction => "stage-round-positions",
            Self::BehindFirstRound => "stage-later-rounds",
            Self::Geometric(_) => "stage-geometric",
            Self::ZonePositions(_) => "stage-zone-positions",
            Self::AfterRounds => "stage-zones",
            Self::ZoneRounds(_) => "stage-zone-rounds",
            Self::Zones(WrongZones::Partly | WrongZones::PartlyStopped) => "stage-zone-parts",
            Self::Zones(WrongZones::Unmoved) => "stage-zones-unmoved",
            Self::Zones(WrongZones::NotMerged) => "stage-zones-unmerged",
            Self::Zones(WrongZones::Joined | WrongZones::Others) => "stage-zones-of-others",
            Self::Zones(WrongZones::Stop) => "stage-zones-stop",
            Self::Zones(WrongZones::MoveOn | WrongZones::KeepPositions | WrongZones::KeepVelocities) => "stage-stop",
            Self::Motion { .. } => "stage-failsafe",
        }
    }
}

/// The first value of a trace that is not finite, and its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct NotFinite {
    /// The step, from 1, where 0 is the first record; `None` if the explanation covers several traces.
    pub step: Option<u32>,
    /// The stage that computes such a value from finite ones.
    pub stage: NanStage,
    /// Whether the first such value is NaN, and not infinite.
    pub is_nan: bool,
    /// Whether all values of a later step are finite again.
    #[serde(default)]
    pub ends: bool,
}

/// The first stage of a step that has finite inputs and an output that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NanStage {
    /// The first record already contains such a value.
    FirstRecord,
    /// The motion of the step, before any contact.
    Motion,
    /// The integrator, when it solves a system of equations.
    ImplicitMotion,
    /// The coefficients of the detection; the value is the kind of pair, if it is known.
    Detection(Option<PairKind>),
    /// Contact vectors and times of impact.
    ContactVectors,
    /// The response to a contact.
    Responses,
    /// The impulse rounds, whose contacts are not in the trace.
    ImpulseRounds,
    /// Impact zones and the rigid failsafe.
    Zones,
}
