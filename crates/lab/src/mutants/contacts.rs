//! Wrong use of roots, intervals, contact vectors, and orders.
use super::{Mutant, row};
use fosssim_num::{
    polynomial::Polynomial,
    vector::{Vec2, length, unit},
};
use fosssim_oracle::student::{
    Area, Object,
    hooks::{Change, Encounter, alpha},
};

pub(super) const MUTANTS: &[Mutant] = &[
    row(
        "root-approach-not-searched",
        Area::Decision,
        "",
        "the approach is logged, but not searched",
        &["approach"],
        Change::Searched(|polynomials: &mut Vec<Polynomial>| {
            polynomials.pop();
        }),
    ),
    row(
        "root-alpha-high-not-searched",
        Area::Decision,
        "particle-edge",
        "alpha < 1 is logged, but not searched",
        &["alpha", "beside"],
        Change::Searched(|polynomials: &mut Vec<Polynomial>| {
            if polynomials.len() == 4 {
                polynomials.remove(2);
            }
        }),
    ),
    row(
        "root-rounded",
        Area::Decision,
        "",
        "the time of impact is rounded to three decimals",
        &["time"],
        Change::Time(|time| (1000.0 * time).round() / 1000.0),
    ),
    row(
        "root-time-late",
        Area::Decision,
        "",
        "the time of impact is a tenth too late",
        &["time"],
        Change::Time(|time| if time > 0.0 { 1.1 * time } else { time }),
    ),
    row(
        "interval-shorter",
        Area::Decision,
        "",
        "times behind 0.9 do not count",
        &["missed", "not counted"],
        Change::Counts(|_, time| time <= 0.9),
    ),
    row(
        "interval-up-to-two",
        Area::Decision,
        "",
        "times up to 2 count",
        &["too many", "counted"],
        Change::Counts(|_, time| time <= 2.0),
    ),
    row(
        "interval-edge-inside",
        Area::Decision,
        "particle-edge",
        "only the middle half of an edge is struck",
        &["missed", "not counted"],
        Change::Counts(|encounter, time| {
            let inside = |bodies| (0.25..=0.75).contains(&alpha(bodies, time));
            time <= 1.0 && !matches!(encounter, Encounter::Edge(bodies, _) if !inside(bodies))
        }),
    ),
    row(
        "interval-slow-left-out",
        Area::Decision,
        "particle-particle",
        "slow particles do not collide",
        &["missed", "not counted"],
        Change::Counts(|encounter, time| {
            let slow = matches!(encounter, Encounter::Particles(one, two)
                if length(two.displacement - one.displacement) < 2.5);
            time <= 1.0 && !slow
        }),
    ),
    row(
        "vector-doubled",
        Area::ContactVector,
        "",
        "contact vectors are twice as long",
        &["2 times", "times as long"],
        Change::Vector(|_, _, n| 2.0 * n),
    ),
    row(
        "vector-to-surface",
        Area::ContactVector,
        "particle-particle",
        "contact vectors end at the first particle's surface",
        &["times as long", "length"],
        Change::Vector(|encounter, _, n| match encounter {
            Encounter::Particles(one, _) => n - one.radius * unit(n),
            _ => n,
        }),
    ),
    row(
        "vector-nearest-end",
        Area::ContactVector,
        "particle-edge",
        "contact vectors go to the nearer endpoint",
        &["direction"],
        Change::Vector(|encounter, time, n| match encounter {
            Encounter::Edge(bodies, _) => {
                let end = if alpha(bodies, time) < 0.5 { &bodies[1] } else { &bodies[2] };
                end.at(time) - bodies[0].at(time)
            }
            _ => n,
        }),
    ),
    row(
        "vector-outward",
        Area::ContactVector,
        "particle-half-plane",
        "contact vectors never point along the normal",
        &["way round", "sign", "points"],
        Change::Vector(|encounter, _, n| match encounter {
            Encounter::HalfPlane(_, _, normal) if n.dot(normal) > 0.0 => -n,
            _ => n,
        }),
    ),
    row(
        "vector-turned",
        Area::ContactVector,
        "particle-edge",
        "contact vectors point along the edge",
        &["direction", "perpendicular"],
        Change::Vector(|encounter, _, n| match encounter {
            Encounter::Edge(..) => Vec2::new(-n.y, n.x),
            _ => n,
        }),
    ),
    row(
        "order-edges-first",
        Area::Decision,
        "",
        "edges are looked at before particles",
        &["order"],
        Change::Pairs(|pairs| pairs.sort_by_key(|pair| (pair.particle, !matches!(pair.object, Object::Edge(_))))),
    ),
    row(
        "order-backwards",
        Area::Decision,
        "",
        "particles are looked at from the last to the first",
        &["order"],
        Change::Pairs(|pairs| pairs.sort_by_key(|pair| std::cmp::Reverse(pair.particle))),
    ),
    row(
        "order-kinds-apart",
        Area::Decision,
        "",
        "all pairs of particles come first, then all edges, then all half-planes",
        &["order"],
        Change::Pairs(|pairs| {
            pairs.sort_by_key(|pair| match pair.object {
                Object::Particle(_) => 0,
                Object::Edge(_) => 1,
                Object::HalfPlane(_) => 2,
            });
        }),
    ),
    row(
        "loop-every-other",
        Area::ImpulseLoop,
        "",
        "every other contact of a round is dropped",
        &["impulse loop"],
        Change::Contacts(|contacts| {
            let mut keep = false;
            contacts.retain(|_| {
                keep = !keep;
                keep
            });
        }),
    ),
    row(
        "loop-one-contact-each",
        Area::ImpulseLoop,
        "",
        "each particle has one contact per round",
        &["impulse loop"],
        Change::Contacts(|contacts| {
            let mut last = None;
            contacts.retain(|contact| {
                let is_new = last != Some(contact.pair.particle);
                last = Some(contact.pair.particle);
                is_new
            });
        }),
    ),
];
