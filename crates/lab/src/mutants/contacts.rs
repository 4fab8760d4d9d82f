//! Wrong use of roots, intervals, contact vectors, and orders.
use super::{Mutant, mutant};
use fosssim_num::{
    polynomial::Polynomial,
    vector::{Vec2, length, unit},
};
use fosssim_oracle::{
    sim::PairKind,
    student::{
        Area::{ContactVector, Decision, ImpulseLoop},
        Object,
        hooks::{Change, Encounter, alpha},
    },
};

pub(super) const MUTANTS: &[Mutant] = &[
    mutant("root-approach-not-searched", Decision, "the approach is logged, but not searched")
        .told_by(&["approach"])
        .by(Change::Searched(|polynomials: &mut Vec<Polynomial>| {
            polynomials.pop();
        })),
    mutant("root-alpha-high-not-searched", Decision, "alpha < 1 is logged, but not searched")
        .at(PairKind::ParticleEdge)
        .told_by(&["alpha", "beside"])
        .by(Change::Searched(|polynomials: &mut Vec<Polynomial>| {
            if polynomials.len() == 4 {
                polynomials.remove(2);
            }
        })),
    mutant("root-rounded", Decision, "the time of impact is rounded to three decimals")
        .told_by(&["time"])
        .by(Change::Time(|time| (1000.0 * time).round() / 1000.0)),
    mutant("root-time-late", Decision, "the time of impact is a tenth too late")
        .told_by(&["time"])
        .by(Change::Time(|time| if time > 0.0 { 1.1 * time } else { time })),
    mutant("interval-shorter", Decision, "times behind 0.9 do not count")
        .told_by(&["missed", "not counted"])
        .by(Change::Counts(|_, time| time <= 0.9)),
    mutant("interval-up-to-two", Decision, "times up to 2 count")
        .told_by(&["too many", "counted"])
        .by(Change::Counts(|_, time| time <= 2.0)),
    mutant("interval-edge-inside", Decision, "only the middle half of an edge is struck")
        .at(PairKind::ParticleEdge)
        .told_by(&["missed", "not counted"])
        .by(Change::Counts(|encounter, time| {
            let inside = |bodies| (0.25..=0.75).contains(&alpha(bodies, time));
            time <= 1.0 && !matches!(encounter, Encounter::Edge(bodies, _) if !inside(bodies))
        })),
    mutant("interval-slow-left-out", Decision, "slow particles do not collide")
        .at(PairKind::ParticleParticle)
        .told_by(&["missed", "not counted"])
        .by(Change::Counts(|encounter, time| {
            let slow = matches!(encounter, Encounter::Particles(one, two)
                if length(two.displacement - one.displacement) < 2.5);
            time <= 1.0 && !slow
        })),
    mutant("vector-doubled", ContactVector, "contact vectors are twice as long")
        .told_by(&["2 times", "times as long"])
        .by(Change::Vector(|_, _, n| 2.0 * n)),
    mutant("vector-to-surface", ContactVector, "contact vectors end at the first particle's surface")
        .at(PairKind::ParticleParticle)
        .told_by(&["times as long", "length"])
        .by(Change::Vector(|encounter, _, n| match encounter {
            Encounter::Particles(one, _) => n - one.radius * unit(n),
            _ => n,
        })),
    mutant("vector-nearest-end", ContactVector, "contact vectors go to the nearer endpoint")
        .at(PairKind::ParticleEdge)
        .told_by(&["direction"])
        .by(Change::Vector(|encounter, time, n| match encounter {
            Encounter::Edge(bodies, _) => {
                let end = if alpha(bodies, time) < 0.5 { &bodies[1] } else { &bodies[2] };
                end.at(time) - bodies[0].at(time)
            }
            _ => n,
        })),
    mutant("vector-outward", ContactVector, "contact vectors never point along the normal")
        .at(PairKind::ParticleHalfPlane)
        .told_by(&["way round", "sign", "points"])
        .by(Change::Vector(|encounter, _, n| match encounter {
            Encounter::HalfPlane(_, _, normal) if n.dot(normal) > 0.0 => -n,
            _ => n,
        })),
    mutant("vector-turned", ContactVector, "contact vectors point along the edge")
        .at(PairKind::ParticleEdge)
        .told_by(&["direction", "perpendicular"])
        .by(Change::Vector(|encounter, _, n| match encounter {
            Encounter::Edge(..) => Vec2::new(-n.y, n.x),
            _ => n,
        })),
    mutant("order-edges-first", Decision, "edges are looked at before particles")
        .told_by(&["order"])
        .by(Change::Pairs(|pairs| pairs.sort_by_key(|pair| (pair.particle, !matches!(pair.object, Object::Edge(_)))))),
    mutant("order-backwards", Decision, "particles are looked at from the last to the first")
        .told_by(&["order"])
        .by(Change::Pairs(|pairs| pairs.sort_by_key(|pair| std::cmp::Reverse(pair.particle)))),
    mutant("order-kinds-apart", Decision, "all pairs of particles come first, then all edges, then all half-planes")
        .told_by(&["order"])
        .by(Change::Pairs(|pairs| {
            pairs.sort_by_key(|pair| match pair.object {
                Object::Particle(_) => 0,
                Object::Edge(_) => 1,
                Object::HalfPlane(_) => 2,
            });
        })),
    mutant("loop-every-other", ImpulseLoop, "every other contact of a round is dropped").told_by(&["impulse loop"]).by(
        Change::Contacts(|contacts| {
            let mut keep = false;
            contacts.retain(|_| {
                keep = !keep;
                keep
            });
        }),
    ),
    mutant("loop-one-contact-each", ImpulseLoop, "each particle has one contact per round")
        .told_by(&["impulse loop"])
        .by(Change::Contacts(|contacts| {
            let mut last = None;
            contacts.retain(|contact| {
                let is_new = last != Some(contact.pair.particle);
                last = Some(contact.pair.particle);
                is_new
            });
        })),
];
