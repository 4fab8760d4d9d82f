//! Where a tool of measurement changes a program: mistakes that explanations never try.
//!
//! The tools are in `crates/lab`: `mutants` makes a [`Change`] by hand, `operators` enumerates [`Mutation`]s.
mod apply;
mod places;

pub use super::{
    encounter::{Encounter, MovingBody, alpha},
    objects::Zone,
};
pub use places::{Mutation, Operator, Place};

use super::objects::{Contact, Pair, State};
use fosssim_num::{polynomial::Polynomial, vector::Vec2};

/// A contact's share for one of its bodies.
#[derive(Debug, Clone, Copy)]
pub struct Share {
    /// 0 for the particle, 1 for the other one or the first endpoint, 2 for the second endpoint.
    pub role: usize,
    /// The pair in contact.
    pub pair: Pair,
    /// The unit contact vector.
    pub u: Vec2,
    /// The change of velocity.
    pub velocity: Vec2,
    /// The change of position.
    pub position: Vec2,
    /// The body's velocity before.
    pub before: Vec2,
    /// Twice `(1 + COR) / 2`.
    pub bounce: f64,
}

/// A zone's motion.
#[derive(Debug, Clone, Copy)]
pub struct ZoneTurn {
    /// The centre of mass at the start of the step.
    pub centre: Vec2,
    /// How far it moves.
    pub shift: Vec2,
    /// How far the zone turns, radians.
    pub angle: f64,
    /// The moment of inertia.
    pub inertia: f64,
    /// The sum of `m r^2` over the radii.
    pub discs: f64,
    /// The step size.
    pub h: f64,
}

/// A change of one thing.
#[derive(Debug)]
pub enum Change {
    /// The coefficients of a pair.
    Polynomials(fn(&Encounter, &mut Vec<Vec<f64>>)),
    /// The polynomials for the root finder, behind the log.
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
    /// The change by a contact.
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
    Rigid(fn(&mut ZoneTurn)),
    /// A moved particle: its start, its motion, where it is now, its velocity.
    Moved(fn(Vec2, &ZoneTurn, &mut Vec2, &mut Vec2)),
    /// A stopped particle: its velocity before.
    Stopped(fn(Vec2) -> Vec2),
}
