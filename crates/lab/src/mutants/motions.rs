//! Wrong responses, loops, zones and failsafes.
use super::{Mutant, row};
use fosssim_num::vector::Vec2;
use fosssim_oracle::student::{
    Area, Object,
    hooks::{Change, Share},
};

const PP: &str = "particle-particle";
const PE: &str = "particle-edge";
const PH: &str = "particle-half-plane";

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
    row(
        "response-stronger",
        Area::Response,
        "",
        "impulses are half as strong again",
        &["1.5 times"],
        Change::Respond(|share| scale(share, 1.5)),
    ),
    row(
        "response-position-halved",
        Area::Response,
        "",
        "positions change by half",
        &["0.5 times"],
        Change::Respond(|share| share.position *= 0.5),
    ),
    row(
        "response-friction",
        Area::Response,
        "",
        "a tenth of the motion along the contact is lost",
        &["across", "along the contact vector"],
        Change::Respond(|share| share.velocity -= 0.1 * (share.before - share.before.dot(&share.u) * share.u)),
    ),
    row(
        "response-particles-elastic",
        Area::Response,
        PP,
        "particles among themselves are elastic",
        &["times"],
        Change::Respond(|share| {
            if is_particle(share) {
                scale(share, 2.0 / share.bounce);
            }
        }),
    ),
    row(
        "response-half-plane-elastic",
        Area::Response,
        PH,
        "half-planes are elastic",
        &["times"],
        Change::Respond(|share| {
            if is_half_plane(share) {
                scale(share, 2.0 / share.bounce);
            }
        }),
    ),
    row(
        "response-half-plane-position-sign",
        Area::Response,
        PH,
        "half-planes pull positions",
        &["-1 times", "sign"],
        Change::Respond(|share| {
            if is_half_plane(share) {
                share.position = -share.position;
            }
        }),
    ),
    row(
        "response-edge-particle-halved",
        Area::Response,
        PE,
        "the particle at an edge gets half",
        &["0.5 times"],
        Change::Respond(|share| {
            if is_edge(share) && share.role == 0 {
                scale(share, 0.5);
            }
        }),
    ),
    row(
        "response-edge-second-velocity",
        Area::Response,
        PE,
        "an edge's second endpoint changes position only",
        &["second endpoint"],
        Change::Respond(|share| {
            if is_edge(share) && share.role == 2 {
                share.velocity *= 0.0;
            }
        }),
    ),
    row(
        "response-second-stronger",
        Area::Response,
        PP,
        "the second particle gets a quarter more",
        &["1.25 times"],
        Change::Respond(|share| {
            if is_particle(share) && share.role == 1 {
                scale(share, 1.25);
            }
        }),
    ),
    row(
        "response-edge-pulled",
        Area::Response,
        PE,
        "the endpoints are pulled",
        &["-1 times", "sign"],
        Change::Respond(|share| {
            if is_edge(share) && share.role > 0 {
                scale(share, -1.0);
            }
        }),
    ),
    row(
        "loop-at-most-two",
        Area::ImpulseLoop,
        "",
        "there are two rounds at most",
        &["rounds"],
        Change::Limit(|most| most.min(2)),
    ),
    row("loop-half", Area::ImpulseLoop, "", "half of the rounds are made", &["rounds"], Change::Limit(|most| most / 2)),
    row(
        "loop-three-more",
        Area::ImpulseLoop,
        "",
        "three rounds more are made",
        &["rounds"],
        Change::Limit(|most| if most > 0 { most + 3 } else { most }),
    ),
    row(
        "loop-one-contact-is-none",
        Area::ImpulseLoop,
        "",
        "the loop ends with one contact",
        &["rounds"],
        Change::Enough(1),
    ),
    row(
        "loop-failed-positions",
        Area::ImpulseLoop,
        "",
        "positions go back to the start when the loop fails",
        &["impulse loop"],
        Change::Failed(|start, state| state.x.copy_from_slice(start)),
    ),
    row(
        "loop-failed-velocities",
        Area::ImpulseLoop,
        "",
        "velocities are zero when the loop fails",
        &["impulse loop"],
        Change::Failed(|_, state| state.v.fill(0.0)),
    ),
    row(
        "zone-flag-of-particles",
        Area::Failsafe,
        "",
        "contacts of particles set the half-plane flag",
        &["stop"],
        Change::Zone(|contact, zone| zone.half_plane |= matches!(contact.pair.object, Object::Particle(_))),
    ),
    row(
        "zone-at-most-three",
        Area::ImpactZones,
        "",
        "a zone holds three particles at most",
        &["zone"],
        Change::Zones(|zones| {
            for zone in zones {
                while zone.particles.len() > 3 {
                    zone.particles.pop_last();
                }
            }
        }),
    ),
    row(
        "zone-three-rounds",
        Area::ImpactZones,
        "",
        "zones grow three times at most",
        &["round"],
        Change::GeometricRounds(3),
    ),
    row(
        "rigid-half-turn",
        Area::Failsafe,
        "",
        "zones turn half as far",
        &["0.5 times"],
        Change::Rigid(|turn| turn.angle *= 0.5),
    ),
    row(
        "rigid-double-turn",
        Area::Failsafe,
        "",
        "zones turn twice as far",
        &["2 times"],
        Change::Rigid(|turn| turn.angle *= 2.0),
    ),
    row(
        "rigid-discs",
        Area::Failsafe,
        "",
        "the moment of inertia has the discs' own",
        &["turn"],
        Change::Rigid(|turn| turn.angle *= turn.inertia / (turn.inertia + 0.5 * turn.discs)),
    ),
    row(
        "rigid-shift-halved",
        Area::Failsafe,
        "",
        "zones move half as far",
        &["centre", "0.5 times"],
        Change::Rigid(|turn| turn.shift *= 0.5),
    ),
    row(
        "rigid-shift-first-axis",
        Area::Failsafe,
        "",
        "zones move along x only",
        &["centre"],
        Change::Rigid(|turn| turn.shift.y = 0.0),
    ),
    row(
        "rigid-velocity-halved",
        Area::Failsafe,
        "",
        "velocities of zones are half",
        &["0.5 times"],
        Change::Moved(|_, _, _, v| *v *= 0.5),
    ),
    row(
        "rigid-velocity-reversed",
        Area::Failsafe,
        "",
        "velocities of zones are reversed",
        &["-1 times"],
        Change::Moved(|_, _, _, v| *v = -*v),
    ),
    row(
        "rigid-shrinks",
        Area::Failsafe,
        "",
        "zones shrink by a tenth about their centre",
        &["distances"],
        Change::Moved(|start, turn, x, v| {
            let to = turn.centre + turn.shift;
            *x = to + 0.9 * (*x - to);
            let shift = *x - start;
            *v = Vec2::new(shift.x / turn.h, shift.y / turn.h);
        }),
    ),
    row(
        "stop-keeps-a-tenth",
        Area::Failsafe,
        "",
        "stopped zones keep a tenth of their velocity",
        &["stop"],
        Change::Stopped(|v| 0.1 * v),
    ),
    row("stop-rebounds", Area::Failsafe, "", "stopped zones turn back", &["stop"], Change::Stopped(|v| -v)),
];
