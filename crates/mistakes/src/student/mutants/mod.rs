//! Mistakes that the catalogue does not have, for measuring what explanations say of what they can't know.
//!
//! Explanations never try these: a row here must not become a row of the catalogue, or the measure is gone. Each
//! changes one thing at one of the `Change`s.
mod coefficients;
mod contacts;
mod motions;

use fosssim_num::{polynomial::Polynomial, vector::Vec2};

use super::{
    catalogue::Area,
    encounter::Encounter,
    objects::Zone,
    objects::{Contact, Pair, State},
};

/// A mistake outside of the catalogue.
#[derive(Debug)]
pub struct Mutant {
    /// Its name.
    pub id: &'static str,
    /// Where it is made.
    pub area: Area,
    /// The kind of pair that it is made for, as explanations call it; empty where it is made for all.
    pub kind: &'static str,
    /// What is wrong.
    pub what: &'static str,
    /// What an explanation has to say at least in order to be right: one of these words stands in its sentence, its
    /// key, or its exact form.
    pub told_by: &'static [&'static str],
    pub(super) change: Change,
}

const fn row(
    id: &'static str,
    area: Area,
    kind: &'static str,
    what: &'static str,
    told_by: &'static [&'static str],
    change: Change,
) -> Mutant {
    Mutant { id, area, kind, what, told_by, change }
}

/// A contact's share for one of its bodies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    /// 0 for the particle, 1 for the other one or the first endpoint, 2 for the second endpoint.
    pub(super) role: usize,
    /// What the contact is with.
    pub(super) pair: Pair,
    /// The unit contact vector.
    pub(super) u: Vec2,
    /// The change of velocity.
    pub(super) velocity: Vec2,
    /// The change of position.
    pub(super) position: Vec2,
    /// The body's velocity before.
    pub(super) before: Vec2,
    /// Twice `(1 + COR) / 2`.
    pub(super) bounce: f64,
}

/// A zone's motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    /// The centre of mass at the start of the step.
    pub(super) centre: Vec2,
    /// How far it moves.
    pub(super) shift: Vec2,
    /// How far the zone turns, radians.
    pub(super) angle: f64,
    /// The moment of inertia.
    pub(super) inertia: f64,
    /// The sum of `m r^2` over the radii.
    pub(super) discs: f64,
    /// The step size.
    pub(super) h: f64,
}

/// Where a mutant changes something.
#[derive(Debug)]
pub(super) enum Change {
    /// The coefficients of a pair.
    Polynomials(fn(&Encounter, &mut Vec<Vec<f64>>)),
    /// What the root finder gets, behind the log.
    Searched(fn(&mut Vec<Polynomial>)),
    /// The time of impact.
    Time(fn(f64) -> f64),
    /// Whether a time counts.
    Counts(fn(&Encounter, f64) -> bool),
    /// The contact vector.
    Vector(fn(&Encounter, f64, Vec2) -> Vec2),
    /// The contacts of a pass.
    Contacts(fn(&mut Vec<Contact>)),
    /// The pairs of all passes.
    Pairs(fn(&mut Vec<Pair>)),
    /// What a contact changes.
    Respond(fn(&mut Share)),
    /// How many rounds there are.
    Limit(fn(i32) -> i32),
    /// How many contacts end the loop.
    Enough(usize),
    /// The state behind the loop when it fails: start positions and state.
    Failed(fn(&[f64], &mut State)),
    /// The zone of a contact.
    Zone(fn(&Contact, &mut Zone)),
    /// The zones after merging.
    Zones(fn(&mut Vec<Zone>)),
    /// How many rounds the geometric part makes.
    GeometricRounds(u32),
    /// The motion of a zone.
    Rigid(fn(&mut Turn)),
    /// A moved particle: its start, its motion, where it is now, its velocity.
    Moved(fn(Vec2, &Turn, &mut Vec2, &mut Vec2)),
    /// A stopped particle: its velocity before.
    Stopped(fn(Vec2) -> Vec2),
}

/// All mutants.
pub fn mutants() -> impl Iterator<Item = &'static Mutant> {
    coefficients::MUTANTS.iter().chain(contacts::MUTANTS).chain(motions::MUTANTS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::student::find;
    use std::collections::BTreeSet;

    #[test]
    fn there_are_many_and_none_is_of_the_catalogue() {
        let ids: BTreeSet<&str> = mutants().map(|mutant| mutant.id).collect();
        assert!(ids.len() >= 40 && ids.len() == mutants().count(), "{}", ids.len());
        assert!(ids.iter().all(|id| find(id).is_none()));
    }
}
