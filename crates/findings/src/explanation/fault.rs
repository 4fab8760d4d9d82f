//! Faults in a stage of a step that no known mistake explains. The measured values are in
//! [`StageDetail`](super::StageDetail).
use super::area::Area;
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};

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
    /// The pairs are checked in another order than they should be.
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
    /// The contacts of a step of `continuous-time` are right, but the states after them are wrong.
    Responses,
    /// The number of impulse rounds is wrong.
    Rounds(WrongNumber),
    /// The polynomials of all impulse rounds are right, but the state after them is wrong.
    HandedOver,
    /// The polynomials of the first impulse round are right, but those of the second one or the state are wrong.
    FirstRound,
    /// The polynomials of the second impulse round are right, but later ones or the state are wrong.
    LaterRounds,
    /// The geometric part runs when it should not, or does not run when it should.
    Geometric(WrongGeometric),
    /// The part of the step after the impulse rounds is wrong.
    AfterRounds,
}

/// The common properties of wrong changes of states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WrongChange {
    /// The quantity that is wrong. If positions are wrong, velocities are right. If velocities are wrong, positions
    /// agree with the wrong velocities.
    pub quantity: Quantity,
    /// The component that is wrong: 0 for x or 1 for y; `None` if both are.
    pub axis: Option<usize>,
    /// The particles whose states change wrongly.
    pub particles: ChangedParticles,
    /// The factor between the actual and the right changes.
    pub ratio: ChangeRatio,
    /// The part of the student's code that makes these changes.
    pub cause: ChangeCause,
}

/// The part of a student's code that changes states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ChangeCause {
    /// The responses to simple collisions.
    Response,
    /// The penalty force.
    Penalty,
    /// The forces, without the penalty force.
    Forces,
    /// The integrator, which computes new positions and velocities from the forces.
    Integrator,
    /// The forces or the integrator, which the trace does not distinguish.
    ForcesOrIntegrator,
    /// The derivatives of forces or the integrator, which the trace does not distinguish.
    JacobiansOrIntegrator,
}

fosssim_num::closed_set! {
    /// The particles whose state changes wrongly.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ChangedParticles {
        /// Some particles that have nothing in common.
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
    pub enum WrongNumber {
        /// The loop makes too few rounds.
        Fewer = "the loop makes fewer rounds than it should",
        /// The loop makes too many rounds.
        More = "the loop makes more rounds than it should",
        /// The loop makes too few rounds in some steps, and too many in others.
        Other = "the loop makes a wrong number of rounds",
    }
}

/// An error in when the geometric part runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WrongGeometric {
    /// The geometric part does not run, although the rounds have used up their maximum number.
    Left {
        /// Whether it never runs; otherwise it fails to run in some steps.
        always: bool,
    },
    /// The geometric part runs, although nothing collides.
    Superfluous,
}

impl StageFault {
    /// Returns the stage of the step in which the fault is.
    pub const fn stage(&self) -> StepStage {
        match self {
            Self::Order | Self::Decisions { .. } | Self::ContactTimes | Self::Overlaps { .. } => StepStage::Detection,
            Self::ContactVectors { .. } => StepStage::ContactVectors,
            Self::Responses
            | Self::Change(_)
            | Self::Rounds(_)
            | Self::HandedOver
            | Self::FirstRound
            | Self::LaterRounds
            | Self::Geometric(_) => StepStage::Responses,
            Self::AfterRounds => StepStage::Zones,
        }
    }

    /// Returns the parts of the assignment in which the mistake may be.
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
            Self::Responses => &[Area::Response],
            // In a hybrid step, the trace contains no contacts.
            Self::FirstRound => &[Area::Decision, Area::ContactVector, Area::Response, Area::ImpulseLoop],
            Self::HandedOver => &[Area::Response, Area::ImpulseLoop],
            Self::Rounds(_) | Self::LaterRounds => &[Area::ImpulseLoop, Area::Decision],
            Self::Geometric(WrongGeometric::Left { always: false } | WrongGeometric::Superfluous) => {
                &[Area::ImpulseLoop]
            }
            Self::Geometric(WrongGeometric::Left { always: true }) => &[Area::ImpulseLoop, Area::ImpactZones],
            Self::AfterRounds => &[Area::ImpactZones, Area::Failsafe],
        }
    }

    /// Returns the kind of pair; `None` if the fault concerns several kinds.
    pub const fn kind(&self) -> Option<PairKind> {
        match self {
            Self::Decisions { kind, .. } | Self::Overlaps { kind, .. } | Self::ContactVectors { kind, .. } => *kind,
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
            Self::Overlaps { .. } => "stage-overlaps",
            Self::Change(_) => "stage-change",
            Self::ContactTimes => "stage-contact-times",
            Self::ContactVectors { .. } => "stage-contact-vectors",
            Self::Responses => "stage-response",
            Self::Rounds(_) => "stage-rounds",
            Self::HandedOver => "stage-handed-over",
            Self::FirstRound => "stage-first-round",
            Self::LaterRounds => "stage-later-rounds",
            Self::Geometric(_) => "stage-geometric",
            Self::AfterRounds => "stage-zones",
        }
    }
}

/// The first value in a trace that is not finite: where it is, and how it came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct NonFiniteValue {
    /// The number of the step, from 1; 0 is the first record. `None` if the explanation covers several traces.
    pub step: Option<u32>,
    /// The stage whose inputs are finite but whose result is not.
    pub stage: NanStage,
    /// Whether the value is NaN; otherwise it is infinite.
    pub is_nan: bool,
    /// Whether all values are finite again in a later step.
    #[serde(default)]
    #[serde(rename = "ends")]
    pub recovers: bool,
}

/// The first stage of a step whose inputs are finite but whose result is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NanStage {
    /// The first record already contains a value that is not finite.
    FirstRecord,
    /// The motion within the step, before any contact.
    Motion,
    /// The integrator, while it solves a system of equations.
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
