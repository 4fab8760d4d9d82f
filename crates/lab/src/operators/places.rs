//! All changes of all places of a student's program.
use fosssim_oracle::student::hooks::{
    Operator::{
        self, AfterOther, Always, AtZero, AxesExchanged, Doubled, Empty, First, FirstOnly, Halved, LastOnly, Negated,
        Never, Next, NotAfterZero, OneLess, OneMore, Other, Previous, Repeated, Reversed, Skipped, Stale, WithoutFirst,
        WithoutLast, Zero,
    },
    Place,
};

const INDEX: &[Operator] = &[Other, AfterOther, Next, Previous, First];
const NUMBER: &[Operator] = &[Zero, Negated, Doubled, Halved];
const VECTOR: &[Operator] = &[Zero, Negated, Doubled, AxesExchanged];
const CONDITION: &[Operator] = &[Always, Never];
const LIST: &[Operator] = &[WithoutFirst, WithoutLast, FirstOnly, LastOnly, Reversed, Repeated, Empty];
const COUNT: &[Operator] = &[OneMore, OneLess, Zero];
const STALE: &[Operator] = &[Stale];
const BLOCK: &[Operator] = &[Skipped, AtZero, NotAfterZero];

/// How many coefficients the polynomials of each kind have.
const COEFFICIENTS: [&[usize]; 3] = [&[3, 2], &[5, 3, 3, 6], &[3, 2]];

/// The bodies of each kind of pair.
const ROLES: [usize; 3] = [2, 3, 1];

/// The places that a program has once.
const SINGLE: [(Place, &[Operator]); 62] = [
    (Place::PairsOfPass, LIST),
    (Place::OwnFirstEnd, CONDITION),
    (Place::OwnSecondEnd, CONDITION),
    (Place::SeenOther, &[Next, Previous, First]),
    (Place::SeenHalfPlane, &[Next, Previous, First]),
    (Place::LastTime, &[Zero, Doubled, Halved]),
    (Place::ContactAlpha, NUMBER),
    (Place::StepStart, STALE),
    (Place::ContinuousPrediction, STALE),
    (Place::LoggedImpulses, LIST),
    (Place::Restitution, NUMBER),
    (Place::ResponseTime, NUMBER),
    (Place::ResponseAlpha, NUMBER),
    (Place::ResponseClampLow, CONDITION),
    (Place::ResponseClampHigh, CONDITION),
    (Place::RoundLimit, COUNT),
    (Place::RoundContacts, LIST),
    (Place::RoundIsEmpty, CONDITION),
    (Place::RoundPrediction, STALE),
    (Place::RoundContactsKept, STALE),
    (Place::LoopSucceeds, &[Never]),
    (Place::NeedsZones, CONDITION),
    (Place::FirstZoneContacts, LIST),
    (Place::LaterZoneContacts, LIST),
    (Place::ZoneContactsKept, STALE),
    (Place::ZonePrediction, STALE),
    (Place::ZonesAreTheSame, &[Always]),
    (Place::ZonesBefore, LIST),
    (Place::ZoneOther, &[Other, Next, Previous, First]),
    (Place::ZonesMeet, CONDITION),
    (Place::ZonesShare, &[OneMore]),
    (Place::ZonesToMerge, LIST),
    (Place::MergedAgain, &[Never]),
    (Place::FlagOfOld, CONDITION),
    (Place::FlagOfNew, CONDITION),
    (Place::JoinedParticles, LIST),
    (Place::SameParticles, CONDITION),
    (Place::SameFlag, CONDITION),
    (Place::FreeZone, BLOCK),
    (Place::HeldZone, &[Skipped]),
    (Place::FixedHolds, CONDITION),
    (Place::HalfPlaneHolds, CONDITION),
    (Place::AskedWhetherFixed, LIST),
    (Place::StoppedParticles, LIST),
    (Place::StoppedPosition, STALE),
    (Place::StoppedVelocity, STALE),
    (Place::SummedParticles, LIST),
    (Place::SumMass, &[Other, Next, Previous, First]),
    (Place::SumMotion, STALE),
    (Place::TurningParticles, LIST),
    (Place::TurnMotion, STALE),
    (Place::TurnArm, STALE),
    (Place::AngularMomentum, NUMBER),
    (Place::Inertia, &[Doubled, Halved, Negated]),
    (Place::Angle, NUMBER),
    (Place::Cosine, NUMBER),
    (Place::Sine, NUMBER),
    (Place::CarriedParticles, LIST),
    (Place::CarriedArm, STALE),
    (Place::CarriedCentre, VECTOR),
    (Place::CarriedShift, VECTOR),
    (Place::CarriedVelocity, VECTOR),
];

/// Every place with the operators that fit what stands there.
pub(super) fn places() -> Vec<(Place, &'static [Operator])> {
    let mut all = SINGLE.to_vec();
    for role in 1..3 {
        all.push((Place::SeenEnd { role }, INDEX));
        all.push((Place::ResponseEnd { role }, INDEX));
        all.push((Place::ZoneEnd { role }, INDEX));
    }
    all.extend([0, 1].map(|later| (Place::ZonesMoved { later }, LIST)));
    for (kind, roles) in ROLES.into_iter().enumerate() {
        all.push((Place::ContactVector { kind }, VECTOR));
        all.push((Place::ContactTime { kind }, NUMBER));
        all.push((Place::UnitVector { kind }, &[Negated, Doubled, AxesExchanged]));
        all.push((Place::Simultaneous { kind }, STALE));
        all.push((Place::ZoneFlag { kind }, if kind < 2 { &[Always] } else { &[Never] }));
        for role in 0..roles {
            all.push((Place::SeenMotion { kind, role }, VECTOR));
            all.push((Place::MeanVelocity { kind, role }, &[Stale, Zero, Negated, Doubled]));
            all.push((Place::VelocityChange { kind, role }, NUMBER));
            all.push((Place::PositionChange { kind, role }, NUMBER));
            // Half-planes spare nothing, so there only what should not be can be.
            all.push((Place::SparesFixed { kind, role }, if kind < 2 { CONDITION } else { &[Always] }));
            if kind < 2 {
                all.push((Place::ResponseMass { kind, role }, &[Other, Next, Previous, First]));
                all.push((Place::InfiniteMass { kind, role }, &[Never]));
            }
        }
        for (polynomial, &length) in COEFFICIENTS[kind].iter().enumerate() {
            all.extend((0..length).map(|index| (Place::Coefficient { kind, polynomial, index }, NUMBER)));
        }
    }
    all.extend((0..2).map(|role| (Place::SeenRadius { kind: 0, role }, &[Other, Next, Previous, First][..])));
    all.extend((0..2).map(|role| (Place::SeenRadius { kind: 1, role }, &[Next, Previous, First][..])));
    all.push((Place::SeenRadius { kind: 2, role: 0 }, &[Next, Previous, First]));
    all.extend((0..3).map(|role| (Place::SquareInInertia { role }, STALE)));
    all
}
