//! Faults in a stage of a step that no known mistake explains. The measured values are in
//! [`StageDetail`](super::StageDetail).
use super::area::Area;
use fosssim_model::{assignments::Part, sim::PairKind};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The stages of a step that can be distinguished, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum StepStage {
    /// The stage that decides whether and when pairs collide.
    Detection,
    /// The stage that computes the vectors between colliding objects.
    ContactVectors,
    /// The stage of collision responses and impulse rounds.
    Responses,
    /// The stage of impact zones and the rigid failsafe.
    Zones,
}

/// A fault in a stage of a step. The inputs of the stage are right.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum StageFault {
    /// The pairs are checked in a wrong order.
    Order,
    /// The polynomials are right, but the decisions that follow from them are wrong.
    Decisions {
        /// The kind of the affected pairs, if all have the same kind.
        kind: Option<PairKind>,
        /// The error in the decisions, such as missed contacts.
        wrong: WrongDecisions,
    },
    /// Among the bodies that overlap at the end of a step, the wrong ones are treated as colliding.
    Overlaps {
        /// The kind of the affected pairs, if all have the same kind.
        kind: Option<PairKind>,
        /// The error in the decisions, such as missed contacts.
        wrong: WrongDecisions,
    },
    /// A state changes wrongly. The trace logs only states.
    Change(WrongChange),
    /// The times of impact are wrong.
    ContactTimes,
    /// The contact vectors are wrong.
    ContactVectors {
        /// The kind of the affected pairs, if all have the same kind.
        kind: Option<PairKind>,
        /// The fault of the contact vectors.
        wrong: WrongVectors,
    },
    /// Contacts that share no body with other contacts change states wrongly.
    Responses {
        /// The kind of the affected pairs, if all have the same kind and pairs of other kinds are right.
        kind: Option<PairKind>,
        /// The fault of the changes.
        wrong: WrongResponses,
        /// Whether the contacts are in impulse rounds, each of which starts from the states that the round before has
        /// changed.
        #[serde(rename = "in_rounds")]
        only_in_rounds: bool,
    },
    /// After several contacts in one step the state is wrong, although isolated contacts are right.
    ManyContacts,
    /// Contacts of the first impulse round have no effect.
    Unresolved {
        /// Whether no contact of the first round has an effect; otherwise some contacts have an effect.
        all: bool,
    },
    /// The number of impulse rounds is wrong.
    Rounds(RoundCountError),
    /// The impulse rounds are right, but the values after them are wrong.
    HandedOver {
        /// The quantity that is wrong; `None` if both positions and velocities are wrong.
        quantity: Option<Quantity>,
        /// The end of the loop after which the values are wrong; `None` if they are wrong after any end.
        when: Option<LoopEnd>,
        /// Whether wrong responses could also cause the fault.
        or_response: bool,
    },
    /// The contacts of the first impulse round change states wrongly.
    FirstRound,
    /// The result is wrong if the first impulse round has several contacts, but right for isolated contacts.
    LaterRounds,
    /// In rounds after the first one, detection uses the predicted positions again.
    RoundsOfPrediction,
    /// The second detection is right, but the rounds after it are wrong.
    BehindFirstRound,
    /// The geometric part runs in a step that does not need it, or is missing in a step that needs it.
    Geometric(GeometricPartError),
    /// A detection pass of the geometric part starts from wrong positions.
    ZonePositions(WrongPositions),
    /// The part of the step after the impulse rounds is wrong.
    AfterRounds,
    /// In rounds after the first one, zones are wrong.
    ZoneRounds(WrongZoneRounds),
    /// The wrong zones are moved or stopped.
    Zones(WrongZones),
    /// The motion of zones is wrong.
    Motion {
        /// The faults of the zones' motion.
        wrong: Vec<WrongMotion>,
        /// Whether the fault could also be that the wrong zones are moved.
        or_zones: bool,
    },
}

/// The common properties of wrong changes of states.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WrongChange {
    /// The quantity that is wrong. If positions are wrong, velocities are right. If velocities are wrong, positions
    /// agree with the wrong velocities.
    pub quantity: Quantity,
    /// The component that is wrong: 0 for x or 1 for y; `None` if both are wrong.
    pub axis: Option<usize>,
    /// The particles whose states change wrongly.
    pub particles: ChangedParticles,
    /// The factor between the actual and the right changes.
    pub ratio: ChangeRatio,
    /// The parts of the student's code that may make these changes. Each acts on all particles that change wrongly; if
    /// no part does, these are the parts that act anywhere in the scene.
    #[serde(default)]
    pub parts: BTreeSet<Part>,
}

impl WrongChange {
    /// Returns whether one wrong part of the student's code may make both the changes of `self` and those of `other`.
    pub fn may_share_part(&self, other: &Self) -> bool {
        self.quantity == other.quantity && !self.parts.is_disjoint(&other.parts)
    }

    /// Returns the names of the parts of the student's code. Forces come before integrators.
    pub fn part_names(&self) -> Vec<String> {
        self.parts.iter().rev().copied().map(name_part).collect()
    }

    /// Returns whether `self`, which is what several traces have in common, describes what `other` describes for one of
    /// these traces.
    pub fn includes(&self, other: &Self) -> bool {
        self.may_share_part(other)
            && (self.axis.is_none() || self.axis == other.axis)
            && (self.particles == ChangedParticles::Any || self.particles == other.particles)
            && (self.ratio == ChangeRatio::Other || self.ratio == other.ratio)
    }
}

fosssim_num::closed_set! {
    /// The particles whose state changes wrongly.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ChangedParticles {
        /// Some particles that have nothing in common.
        Any = "",
        /// Only fixed particles.
        Fixed = " of fixed particles",
        /// Only the first particle.
        First = " of the first particle",
        /// Only the last particle.
        Last = " of the last particle",
    }
}

fosssim_num::closed_set! {
    /// The factor that all wrong changes have in common.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ChangeRatio {
        /// The quantity does not change.
        Nothing = "stay as they were",
        /// The quantity changes in the opposite direction.
        Opposite = "change the opposite way",
        /// All changes are multiplied by the same factor.
        Factor = "change by a wrong factor, which is always the same",
        /// The changes do not have a factor in common.
        Other = "change wrongly",
    }
}

fosssim_num::closed_set! {
    /// An error in decisions about contacts.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongDecisions {
        /// Contacts that exist are missed.
        Missed = "contacts that its polynomials show are not counted",
            "collisions of bodies that overlap and approach each other are missed";
        /// Contacts are reported that do not exist.
        Superfluous = "contacts are counted that its polynomials do not show",
            "collisions are found between bodies that do not overlap, or do not approach each other";
        /// Some contacts are missed, and others are reported that do not exist.
        Both = "the polynomials are right, but the decisions are not: some contacts are missed, and others are \
            superfluous",
            "some collisions are missed, and others are found that do not exist";
        /// Some pairs are not tested at all.
        Skipped = "some pairs are not tested: their polynomials are not passed to the root finder",
            "some pairs are not tested";
    }
    /// Returns the sentence for bodies that overlap at the end of a step.
    of_overlaps
}

fosssim_num::closed_set! {
    /// The fault of contact vectors.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongVectors {
        /// The vectors are perpendicular to the right ones.
        Perpendicular = "it is perpendicular to the right vector",
        /// The vectors have the wrong direction.
        Direction = "it has the wrong direction",
        /// The vectors have the length zero.
        Zero = "it has no length",
        /// The vectors are right, except for their last digits.
        Inexact = "it is right except for its last digits",
        /// The vectors point in the opposite direction.
        Reversed = "it points in the opposite direction",
        /// The vectors have the right direction, but a wrong length.
        Length = "it has the right direction, but not the right length",
    }
}

/// The fault of the changes that isolated contacts cause.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum WrongResponses {
    /// The contacts change nothing.
    Nothing,
    /// These quantities stay the same, although they should change.
    Unchanged(Vec<ChangedQuantity>),
    /// These quantities also change at a right angle to the contact vector.
    Across(Vec<ChangedQuantity>),
    /// These quantities change along the contact vector by a wrong amount.
    Amount(Vec<ChangedQuantity>),
}

/// A quantity that a contact changes, and the body that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ChangedQuantity {
    /// The kind of the pair that is in contact.
    pub kind: PairKind,
    /// The body to which the quantity belongs. 0 is the pair's first particle. 1 is the second particle, or the edge's
    /// first endpoint. 2 is the edge's second endpoint.
    pub body: usize,
    /// The quantity that changes.
    pub quantity: Quantity,
}

/// A quantity of a body's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Quantity {
    /// The position of a body.
    Position,
    /// The velocity of a body.
    Velocity,
}

fosssim_num::closed_set! {
    /// An error in the number of rounds.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum RoundCountError {
        /// The loop makes too few rounds.
        Fewer = "the loop makes fewer rounds than it should",
        /// The loop makes too many rounds.
        More = "the loop makes more rounds than it should",
        /// The loop makes too few rounds in some steps, and too many in others.
        Other = "the loop makes a wrong number of rounds",
    }
}

/// A wrong decision about whether the geometric part runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum GeometricPartError {
    /// The geometric part does not run, although the rounds have used up their maximum number.
    #[serde(rename = "Left")]
    Omitted {
        /// Whether it never runs; otherwise it fails to run in some steps.
        always: bool,
    },
    /// The geometric part runs, although nothing collides.
    Superfluous,
}

fosssim_num::closed_set! {
    /// The wrong positions that the geometric part starts from.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongPositions {
        /// The first round starts from the positions that the integrator predicted.
        Prediction =
            "the search for the first zones uses the predicted positions, not those after the impulse rounds",
        /// The first round does not start from the positions after the impulse rounds.
        First = "the search for the first zones uses wrong positions, not those after the impulse rounds",
        /// The detection after the failsafe starts from the positions before the failsafe.
        BeforeFailsafe = "the detection after the failsafe uses the positions before it",
    }
}

/// The reason why the impulse rounds end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LoopEnd {
    /// The loop has made its maximum number of rounds.
    RanOut,
    /// The loop has ended because no pair collides.
    Settled,
}

fosssim_num::closed_set! {
    /// The fault of the rounds in which zones grow.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongZoneRounds {
        /// The zones are wrong after they have grown.
        Growth = "zones are right in the first round, but not as they grow",
        /// The zones grow in too few rounds.
        Fewer = "the zones grow in fewer rounds than they should",
        /// The zones grow in too many rounds.
        More = "the zones grow in more rounds than they should",
        /// From a later round on, the zones or the number of rounds are wrong.
        Later = "the zones are right in the first round, but later rounds are wrong or too few",
    }
}

fosssim_num::closed_set! {
    /// The fault of the choice of zones that are moved or stopped.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongZones {
        /// Some particles of a zone are not moved with the zone.
        Partly = "some of a zone's particles are not moved with it",
        /// Some particles do not stop, although their zone should stop.
        PartlyStopped = "some particles of zones that must stop still move",
        /// Zones that should be moved stay in place.
        Unmoved = "some zones that should move stay in place",
        /// Zones that should be moved are stopped.
        Stop = "zones stop although nothing in them is fixed",
        /// Zones that share particles are moved one after the other, instead of as one zone.
        NotMerged = "zones that share particles are moved one after the other, not as one",
        /// Zones that share no particle are moved as one zone.
        Joined = "zones that share no particle are moved as one",
        /// Particles are moved that do not belong to a zone.
        Others = "zones move particles that do not belong to them",
        /// Zones that should stop are moved as rigid bodies.
        MoveOn = "zones that must stop move on as rigid bodies",
        /// Zones that should stop keep their new positions.
        KeepPositions = "zones that must stop do not go back to their start",
        /// Zones that should stop keep some of their velocity.
        KeepVelocities = "zones that must stop keep their velocities",
    }
}

fosssim_num::closed_set! {
    /// The fault of the motion of zones.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum WrongMotion {
        /// The center of mass of the zones moves wrongly.
        Center = "the center of mass of a zone moves wrongly",
        /// The distances between particles of a zone change.
        Distances = "the distances between particles of a zone change",
        /// The rotation of the zones is missing.
        NoTurn = "zones do not rotate",
        /// The zones rotate too little.
        LessTurn = "zones rotate too little",
        /// The zones rotate too much.
        MoreTurn = "zones rotate too much",
        /// The zones rotate in the opposite direction.
        TurnBack = "zones rotate in the opposite direction",
        /// The zones rotate by a wrong angle.
        Turn = "zones rotate by a wrong angle",
        /// The velocities in the zones do not fit their motion.
        Velocities = "velocities in a zone do not match its motion from start to end",
        /// The velocities in the zones have the right directions, but the wrong speeds.
        Speeds = "velocities in a zone have the direction of its motion from start to end, but the wrong size",
    }
}

fn name_part(part: Part) -> String {
    match part {
        Part::Integrator(integrator) => integrator.name().replace("-euler", " Euler"),
        Part::Force(kind) => kind.name().to_owned(),
        Part::Jacobians(kind) => format!("derivatives of the {}", kind.name()),
        Part::Penalty(kind) => format!("{} penalty force", kind.name()),
        Part::SimpleResponse(kind) => format!("{} response", kind.name()),
        _ => part.file().to_owned(),
    }
}

impl StageFault {
    /// Returns the stage of the step in which the fault is.
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

    /// Returns the parts of the assignment in which the mistake may be.
    pub fn areas(&self) -> Vec<Area> {
        let Self::Change(WrongChange { parts, .. }) = self else { return self.fixed_areas().to_vec() };
        let area = |part: &Part| match part {
            Part::Integrator(_) => Area::Integrator,
            Part::Jacobians(_) => Area::Jacobians,
            Part::Penalty(_) => Area::Penalty,
            Part::SimpleResponse(_) => Area::Response,
            _ => Area::Forces,
        };
        parts.iter().rev().map(area).collect()
    }

    const fn fixed_areas(&self) -> &'static [Area] {
        match self {
            Self::Change(_) => &[],
            Self::Order | Self::Decisions { .. } | Self::ContactTimes => &[Area::Decision],
            Self::Overlaps { .. } => &[Area::SimpleDetection],
            Self::ContactVectors { .. } => &[Area::ContactVector],
            Self::Responses { only_in_rounds: false, .. } | Self::ManyContacts => &[Area::Response],
            // In a hybrid step, the trace contains no contact vector.
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
            | Self::Geometric(GeometricPartError::Omitted { always: false } | GeometricPartError::Superfluous) => {
                &[Area::ImpulseLoop]
            }
            Self::Geometric(GeometricPartError::Omitted { always: true }) => &[Area::ImpulseLoop, Area::ImpactZones],
            Self::ZonePositions(_)
            | Self::ZoneRounds(WrongZoneRounds::Fewer | WrongZoneRounds::More)
            | Self::Zones(WrongZones::Partly | WrongZones::NotMerged | WrongZones::Joined | WrongZones::Others) => {
                &[Area::ImpactZones]
            }
            // If a larger zone has a wrong effect, the code that moves it may also be the cause.
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

    /// Returns the kind of pair; `None` if the fault concerns several kinds.
    pub const fn kind(&self) -> Option<PairKind> {
        match self {
            Self::Decisions { kind, .. }
            | Self::Overlaps { kind, .. }
            | Self::ContactVectors { kind, .. }
            | Self::Responses { kind, .. } => *kind,
            _ => None,
        }
    }

    /// Returns the key of an explanation with this fault.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Order => "stage-order",
            Self::Decisions { wrong: WrongDecisions::Missed, .. } => "stage-contacts-missed",
            Self::Decisions { wrong: WrongDecisions::Superfluous, .. } => "stage-contacts-superfluous",
            Self::Decisions { wrong: WrongDecisions::Both, .. } => "stage-decisions",
            Self::Decisions { wrong: WrongDecisions::Skipped, .. } => "stage-pairs-skipped",
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

/// The first value in a trace that is not finite: where it is, and how it came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct NonFiniteValue {
    /// The number of the step, from 1; 0 is the first record. `None` if the explanation covers several traces.
    pub step: Option<u32>,
    /// The stage whose inputs are finite but whose result is not finite.
    pub stage: NanStage,
    /// Whether the value is NaN; otherwise it is infinite.
    pub is_nan: bool,
    /// Whether all values are finite again in a later step.
    #[serde(default)]
    #[serde(rename = "ends")]
    pub recovers: bool,
}

/// The first stage of a step whose inputs are finite but whose result is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NanStage {
    /// The first record already contains a value that is not finite.
    FirstRecord,
    /// The motion within the step, before any contact.
    Motion,
    /// The system of equations that the integrator solves.
    ImplicitMotion,
    /// The coefficients that the detection computes. The value is the kind of pair, if it is known.
    Detection(Option<PairKind>),
    /// The contact vectors or the times of impact.
    ContactVectors,
    /// The response to a contact.
    Responses,
    /// The impulse rounds. Their contacts are not in the trace.
    ImpulseRounds,
    /// Impact zones and the rigid failsafe.
    Zones,
}
