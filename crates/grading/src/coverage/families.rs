//! The kinds of events in a step that are counted. Each has properties, and pairs of values that exclude each other.
use super::axes::{
    Axis, AxisValue, ContactCount, ContactTime, DetectionPass, EdgeMotion, Ends, FixedOfThree, FixedOfTwo, FixedOne,
    Forces, Hits, Integrator, Kind, Limit, Links, LoopEnd, MassRatio, Motion, NoContactReason, Normal, Penalty, Place,
    Position, Radii, Restitution, Rounds, Side, Size, SomeFixed, ZoneAnchor, ZoneCount, ZoneEdge, ZoneOrigin,
};

/// A kind of event and its properties. Scenes should contain every pair of values of any two properties.
#[derive(Debug)]
pub struct Family {
    /// The name of the kind of event.
    pub name: &'static str,
    /// The properties of such events.
    pub axes: &'static [Axis],
    /// The pairs of values that exclude each other, so that no event has both.
    pub(super) impossible_pairs: &'static [(AxisValue, AxisValue)],
}

/// An event: the index of its kind in [`FAMILIES`], and for each property the index of its value.
pub(super) type Event = (usize, Vec<usize>);

/// Declares a kind of event, with its number, its properties, and the values that exclude each other.
macro_rules! family {
    ($type:ident, $number:literal, $name:literal { $($field:ident: $axis:ident),+ $(,)? } never $never:expr) => {
        #[derive(Debug, Clone, Copy)]
        pub(super) struct $type {
            $(pub(super) $field: $axis),+
        }

        impl $type {
            pub(super) const FAMILY: Family =
                Family { name: $name, axes: &[$($axis::AXIS),+], impossible_pairs: $never };

            pub(super) fn event(self) -> Event {
                ($number, vec![$(self.$field as usize),+])
            }
        }
    };
}

/// Declares values that exclude each other: one value, and all values of another property that never occur together
/// with it.
macro_rules! never {
    ($($one:ident::$value:ident with $other:ident::{$($excluded:ident),+}),* $(,)?) => {
        &[$($((($one::AXIS.name, $one::$value as usize), ($other::AXIS.name, $other::$excluded as usize))),+),*]
    };
}

family!(ParticleContact, 0, "two particles collide" {
    found: DetectionPass,
    when: ContactTime,
    fixed: FixedOfTwo,
    masses: MassRatio,
    radii: Radii,
    company: ContactCount,
    restitution: Restitution,
    integrator: Integrator,
} never never![]);

family!(EdgeContact, 1, "a particle and an edge collide" {
    found: DetectionPass,
    when: ContactTime,
    fixed: FixedOfThree,
    place: Place,
    ends: Ends,
    motion: EdgeMotion,
    masses: MassRatio,
    radii: Radii,
    company: ContactCount,
    restitution: Restitution,
    integrator: Integrator,
} never never![]);

family!(HalfPlaneContact, 2, "a particle and a half-plane collide" {
    found: DetectionPass,
    when: ContactTime,
    fixed: FixedOne,
    side: Side,
    normal: Normal,
    company: ContactCount,
    restitution: Restitution,
    integrator: Integrator,
} never never![]);

family!(NoContact, 3, "a pair does not collide" {
    kind: Kind,
    why: NoContactReason,
    found: DetectionPass,
    fixed: SomeFixed,
} never never![
    // Only edges have ends that a particle can miss. A pair with a half-plane has only one particle, which is either
    // fixed or not.
    Kind::Particles with NoContactReason::{BesideFirst, BesideSecond},
    Kind::HalfPlane with NoContactReason::{BesideFirst, BesideSecond},
    Kind::HalfPlane with SomeFixed::{Some},
]);

family!(MovedZone, 4, "the failsafe moves a zone" {
    size: Size,
    held: ZoneAnchor,
    motion: Motion,
    age: ZoneOrigin,
    position: Position,
    edge: ZoneEdge,
    links: Links,
    masses: MassRatio,
    radii: Radii,
    limit: Limit,
    integrator: Integrator,
} never never![
    // A zone with a single body is one that hits a half-plane. It cannot rotate, has not grown, has no edge, and has no
    // other body to differ from.
    Size::One with ZoneAnchor::{Nothing, Fixed},
    Size::One with Motion::{Turns},
    Size::One with ZoneOrigin::{Grown},
    Size::One with ZoneEdge::{Next, Previous, Apart},
    Size::One with MassRatio::{Unequal},
    Size::One with Radii::{Unequal},
    // An edge and a particle are three bodies. A contact joins at most three bodies, and a half-plane has a contact of
    // its own.
    Size::Two with ZoneEdge::{Next, Previous, Apart},
    Size::More with Links::{One},
]);

family!(ContinuousStep, 5, "a continuous-time step" {
    hits: Hits,
    restitution: Restitution,
    forces: Forces,
    integrator: Integrator,
} never never![]);

family!(HybridStep, 6, "a hybrid step" {
    end: LoopEnd,
    zones: ZoneCount,
    rounds: Rounds,
    limit: Limit,
    restitution: Restitution,
    forces: Forces,
    penalty: Penalty,
    integrator: Integrator,
} never never![
    // If the impulses do not suffice, there is at least one round that searches for zones.
    LoopEnd::Nothing with ZoneCount::{One, Several},
    LoopEnd::Within with ZoneCount::{One, Several},
    LoopEnd::JustEnough with ZoneCount::{One, Several},
    LoopEnd::Nothing with Rounds::{One, Two, More},
    LoopEnd::Within with Rounds::{One, Two, More},
    LoopEnd::JustEnough with Rounds::{One, Two, More},
    LoopEnd::RunOut with Rounds::{None},
    LoopEnd::NotAllowed with Rounds::{None},
    Limit::Zero with Rounds::{None},
    // A new zone always causes a second round.
    ZoneCount::None with Rounds::{Two, More},
    ZoneCount::One with Rounds::{None},
    ZoneCount::Several with Rounds::{None},
    // These are the ways in which the loop can end for each limit on the rounds.
    Limit::Zero with LoopEnd::{Nothing, Within, JustEnough, RunOut},
    Limit::One with LoopEnd::{Within, JustEnough, NotAllowed},
    Limit::More with LoopEnd::{NotAllowed},
]);

/// All kinds of events, in the order of their indices.
pub const FAMILIES: [Family; 7] = [
    ParticleContact::FAMILY,
    EdgeContact::FAMILY,
    HalfPlaneContact::FAMILY,
    NoContact::FAMILY,
    MovedZone::FAMILY,
    ContinuousStep::FAMILY,
    HybridStep::FAMILY,
];
