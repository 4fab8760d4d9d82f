//! Wrong responses, loops, zones and failsafes.
use super::{Mutant, mutant};
use fosssim_num::vector::Vec2;
use fosssim_oracle::{
    sim::PairKind,
    student::{
        Area::{Failsafe, ImpactZones, ImpulseLoop, Response},
        Object,
        hooks::{Change, Share},
    },
};

fn is_edge(share: &Share) -> bool {
    matches!(share.pair.object, Object::Edge(_))
}

fn is_half_plane(share: &Share) -> bool {
    matches!(share.pair.object, Object::HalfPlane(_))
}

fn is_particle(share: &Share) -> bool {
    matches!(share.pair.object, Object::Particle(_))
}

fn scale(share: &mut Share, factor: f64) {
    share.velocity *= factor;
    share.position *= factor;
}

pub(super) const MUTANTS: &[Mutant] = &[
    mutant("response-stronger", Response, "impulses are half as strong again")
        .told_by(&["1.5 times"])
        .by(Change::Respond(|share| scale(share, 1.5))),
    mutant("response-position-halved", Response, "positions change by half")
        .told_by(&["0.5 times"])
        .by(Change::Respond(|share| share.position *= 0.5)),
    mutant("response-friction", Response, "a tenth of the motion along the contact is lost")
        .told_by(&["across", "along the contact vector"])
        .by(Change::Respond(|share| share.velocity -= 0.1 * (share.before - share.before.dot(&share.u) * share.u))),
    mutant("response-particles-elastic", Response, "particles among themselves are elastic")
        .at(PairKind::ParticleParticle)
        .told_by(&["times"])
        .by(Change::Respond(|share| {
            if is_particle(share) {
                scale(share, 2.0 / share.bounce);
            }
        })),
    mutant("response-half-plane-elastic", Response, "half-planes are elastic")
        .at(PairKind::ParticleHalfPlane)
        .told_by(&["times"])
        .by(Change::Respond(|share| {
            if is_half_plane(share) {
                scale(share, 2.0 / share.bounce);
            }
        })),
    mutant("response-half-plane-position-sign", Response, "half-planes pull positions")
        .at(PairKind::ParticleHalfPlane)
        .told_by(&["-1 times", "sign"])
        .by(Change::Respond(|share| {
            if is_half_plane(share) {
                share.position = -share.position;
            }
        })),
    mutant("response-edge-particle-halved", Response, "the particle at an edge gets half")
        .at(PairKind::ParticleEdge)
        .told_by(&["0.5 times"])
        .by(Change::Respond(|share| {
            if is_edge(share) && share.role == 0 {
                scale(share, 0.5);
            }
        })),
    mutant("response-edge-second-velocity", Response, "an edge's second endpoint changes position only")
        .at(PairKind::ParticleEdge)
        .told_by(&["second endpoint"])
        .by(Change::Respond(|share| {
            if is_edge(share) && share.role == 2 {
                share.velocity *= 0.0;
            }
        })),
    mutant("response-second-stronger", Response, "the second particle gets a quarter more")
        .at(PairKind::ParticleParticle)
        .told_by(&["1.25 times"])
        .by(Change::Respond(|share| {
            if is_particle(share) && share.role == 1 {
                scale(share, 1.25);
            }
        })),
    mutant("response-edge-pulled", Response, "the endpoints are pulled")
        .at(PairKind::ParticleEdge)
        .told_by(&["-1 times", "sign"])
        .by(Change::Respond(|share| {
            if is_edge(share) && share.role > 0 {
                scale(share, -1.0);
            }
        })),
    mutant("loop-at-most-two", ImpulseLoop, "there are two rounds at most")
        .told_by(&["rounds"])
        .by(Change::Limit(|most| most.min(2))),
    mutant("loop-half", ImpulseLoop, "half of the rounds are made")
        .told_by(&["rounds"])
        .by(Change::Limit(|most| most / 2)),
    mutant("loop-three-more", ImpulseLoop, "three rounds more are made")
        .told_by(&["rounds"])
        .by(Change::Limit(|most| if most > 0 { most + 3 } else { most })),
    mutant("loop-one-contact-is-none", ImpulseLoop, "the loop ends with one contact")
        .told_by(&["rounds"])
        .by(Change::Enough(1)),
    mutant("loop-failed-positions", ImpulseLoop, "positions go back to the start when the loop fails")
        .told_by(&["impulse loop"])
        .by(Change::Failed(|start, state| state.x.copy_from_slice(start))),
    mutant("loop-failed-velocities", ImpulseLoop, "velocities are zero when the loop fails")
        .told_by(&["impulse loop"])
        .by(Change::Failed(|_, state| state.v.fill(0.0))),
    mutant("zone-flag-of-particles", Failsafe, "contacts of particles set the half-plane flag")
        .told_by(&["stop"])
        .by(Change::Zone(|contact, zone| zone.half_plane |= matches!(contact.pair.object, Object::Particle(_)))),
    mutant("zone-at-most-three", ImpactZones, "a zone holds three particles at most").told_by(&["zone"]).by(
        Change::Zones(|zones| {
            for zone in zones {
                while zone.particles.len() > 3 {
                    zone.particles.pop_last();
                }
            }
        }),
    ),
    mutant("zone-three-rounds", ImpactZones, "zones grow three times at most")
        .told_by(&["round"])
        .by(Change::GeometricRounds(3)),
    mutant("rigid-half-turn", Failsafe, "zones turn half as far")
        .told_by(&["0.5 times"])
        .by(Change::Rigid(|turn| turn.angle *= 0.5)),
    mutant("rigid-double-turn", Failsafe, "zones turn twice as far")
        .told_by(&["2 times"])
        .by(Change::Rigid(|turn| turn.angle *= 2.0)),
    mutant("rigid-discs", Failsafe, "the moment of inertia has the discs' own")
        .told_by(&["turn"])
        .by(Change::Rigid(|turn| turn.angle *= turn.inertia / (turn.inertia + 0.5 * turn.discs))),
    mutant("rigid-shift-halved", Failsafe, "zones move half as far")
        .told_by(&["centre", "0.5 times"])
        .by(Change::Rigid(|turn| turn.shift *= 0.5)),
    mutant("rigid-shift-first-axis", Failsafe, "zones move along x only")
        .told_by(&["centre"])
        .by(Change::Rigid(|turn| turn.shift.y = 0.0)),
    mutant("rigid-velocity-halved", Failsafe, "velocities of zones are half")
        .told_by(&["0.5 times"])
        .by(Change::Moved(|_, _, _, v| *v *= 0.5)),
    mutant("rigid-velocity-reversed", Failsafe, "velocities of zones are reversed")
        .told_by(&["-1 times"])
        .by(Change::Moved(|_, _, _, v| *v = -*v)),
    mutant("rigid-shrinks", Failsafe, "zones shrink by a tenth about their centre").told_by(&["distances"]).by(
        Change::Moved(|start, turn, x, v| {
            let to = turn.centre + turn.shift;
            *x = to + 0.9 * (*x - to);
            let shift = *x - start;
            *v = Vec2::new(shift.x / turn.h, shift.y / turn.h);
        }),
    ),
    mutant("stop-keeps-a-tenth", Failsafe, "stopped zones keep a tenth of their velocity")
        .told_by(&["stop"])
        .by(Change::Stopped(|v| 0.1 * v)),
    mutant("stop-rebounds", Failsafe, "stopped zones turn back").told_by(&["stop"]).by(Change::Stopped(|v| -v)),
];
