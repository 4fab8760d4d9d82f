//! Mutations that no scene can refuse, because the program does the same, and why.
use fosssim_oracle::student::hooks::{
    Mutation,
    Operator::{self, Negated, Repeated, Reversed, Stale},
    Place::{
        self, AskedWhetherFixed, CarriedParticles, FirstZoneContacts, JoinedParticles, LaterZoneContacts,
        LoggedImpulses, RoundContacts, StoppedParticles, SummedParticles, TurningParticles, UnitVector,
        ZoneContactsKept, ZonesBefore, ZonesMoved, ZonesToMerge,
    },
};

const ORDER: &str = "no two zones have a particle in common, so their order means nothing, and doubled ones are merged";
const SETS: &str = "a set of particles has no order";
const SUMS: &str = "sums in another order differ by round-off; of sums gone through twice the quotients are the same";
const TWICE: &str = "each particle is computed from its start, whatever was done before";
const SIGN: &str = "the impulse holds the unit vector twice, so its sign goes away";

/// Places, with the operators that change nothing there, and the reason.
pub const EQUIVALENT: &[(Place, &[Operator], &str)] = &[
    (LoggedImpulses, &[Reversed], "nothing asks for an order of a record's impulses: this is a correct variant"),
    (RoundContacts, &[Reversed], "the responses of a round are added up, in another order but for round-off"),
    (UnitVector { kind: 0 }, &[Negated], SIGN),
    (UnitVector { kind: 1 }, &[Negated], SIGN),
    (UnitVector { kind: 2 }, &[Negated], SIGN),
    (FirstZoneContacts, &[Reversed, Repeated], ORDER),
    (LaterZoneContacts, &[Reversed, Repeated], ORDER),
    (ZonesBefore, &[Reversed, Repeated], ORDER),
    (ZonesToMerge, &[Reversed, Repeated], ORDER),
    (ZonesMoved { later: 0 }, &[Reversed], ORDER),
    (ZonesMoved { later: 1 }, &[Reversed], ORDER),
    (ZoneContactsKept, &[Stale], "what an earlier pass has found lies in a zone already"),
    (JoinedParticles, &[Reversed, Repeated], SETS),
    (AskedWhetherFixed, &[Reversed, Repeated], SETS),
    (StoppedParticles, &[Reversed, Repeated], TWICE),
    (SummedParticles, &[Reversed, Repeated], SUMS),
    (TurningParticles, &[Reversed, Repeated], SUMS),
    (CarriedParticles, &[Reversed, Repeated], TWICE),
];

/// Why a mutation changes nothing; none where it does.
#[must_use]
pub fn equivalent(mutation: Mutation) -> Option<&'static str> {
    let is_it = |row: &&(Place, &[Operator], &str)| row.0 == mutation.place && row.1.contains(&mutation.operator);
    EQUIVALENT.iter().find(is_it).map(|row| row.2)
}
