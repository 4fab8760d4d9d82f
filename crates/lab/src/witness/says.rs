//! The sentences about a stage of a step, as questions to its records.
use super::step::{Step, same, same_list};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Pair, PairKind, Stage, State},
};
use fosssim_num::vector::{Vec2, at, length, unit};
use fosssim_oracle::diagnose::{
    Changed, LoopEnd, Quantity, StageFault, WrongDecisions, WrongGeometric, WrongMotion, WrongNumber, WrongPositions,
    WrongResponses, WrongVectors, WrongZoneRounds, WrongZones,
};

/// A zone of the first round: its particles, and whether a half-plane is in it.
type Zone<'a> = (&'a [usize], bool);

/// Whether the sentence is true of this step.
pub(super) fn is_so(scene: &Scene, step: &Step, fault: &StageFault) -> bool {
    let is_hybrid = matches!(scene.collision, Collision::Hybrid { .. });
    match fault {
        StageFault::Order => is_permuted(step),
        StageFault::Decisions { kind, wrong } => !is_hybrid && decisions(step, *kind, *wrong),
        StageFault::ContactTimes => contacts(step).iter().any(|one| (one.time - one.right_time).abs() > 1e-9),
        StageFault::ContactVectors { kind, wrong } => vectors(step, *kind, *wrong),
        StageFault::Responses { kind, wrong, in_rounds } => {
            *in_rounds == is_hybrid && responses(scene, step, *kind, wrong, is_hybrid)
        }
        StageFault::ManyContacts => !is_hybrid && step.right_lists() == step.size() && !step.is_right(),
        StageFault::Geometric(_)
        | StageFault::ZonePositions(_)
        | StageFault::AfterRounds
        | StageFault::ZoneRounds(_)
        | StageFault::Zones(_)
        | StageFault::Motion { .. } => is_hybrid && step.has_right_middle() && behind_middle(scene, step, fault),
        _ => is_hybrid && !step.has_right_middle() && rounds(scene, step, fault),
    }
}

fn is_permuted(step: &Step) -> bool {
    let Some(logged) = step.logged(0) else { return false };
    let mut left = logged.clone();
    let found = step.heard.polynomials[..step.size()].iter().filter(|ours| {
        let place = left.iter().position(|theirs| same_list(ours, theirs));
        place.map(|place| left.swap_remove(place)).is_some()
    });
    3 * found.count() >= step.size() && step.right_lists() < step.size()
}

/// A logged contact whose pair is one of the reference's.
struct ComparedContact {
    kind: PairKind,
    time: f64,
    right_time: f64,
    n: Vec2,
    right: Vec2,
}

fn is_of(pair: Pair, logged: &fosssim_model::trace::LoggedImpulse) -> bool {
    (pair.kind.code(), pair.first.cast_signed(), pair.second.cast_signed())
        == (logged.kind, logged.first, logged.second)
}

/// Contacts that both find, up to the first difference of the polynomials.
fn contacts(step: &Step) -> Vec<ComparedContact> {
    let right = step.right_lists();
    let certain = step.heard.hits.iter().filter(|hit| hit.4 < right);
    let beside = certain.filter_map(|(_, pair, time, n, _)| {
        let logged = step.end.impulses.iter().find(|logged| is_of(*pair, logged))?;
        Some(ComparedContact { kind: pair.kind, time: logged.time, right_time: *time, n: logged.normal, right: *n })
    });
    beside.collect()
}

fn decisions(step: &Step, kind: Option<PairKind>, wrong: WrongDecisions) -> bool {
    let right = step.right_lists();
    let is_kind = |pair: &Pair| kind.is_none_or(|kind| kind == pair.kind);
    let missed = step.heard.hits.iter().any(|(_, pair, _, _, first)| {
        *first < right && is_kind(pair) && !step.end.impulses.iter().any(|logged| is_of(*pair, logged))
    });
    let superfluous = step.heard.pairs.iter().any(|(pair, first)| {
        *first < right
            && is_kind(pair)
            && step.end.impulses.iter().any(|logged| is_of(*pair, logged))
            && !step.heard.hits.iter().any(|hit| hit.1 == *pair)
    });
    match wrong {
        WrongDecisions::Missed => missed,
        WrongDecisions::Superfluous => superfluous,
        WrongDecisions::Both => missed || superfluous,
    }
}

fn vectors(step: &Step, kind: Option<PairKind>, wrong: WrongVectors) -> bool {
    contacts(step).iter().filter(|one| kind.is_none_or(|kind| kind == one.kind)).any(|one| {
        let (sine, cosine) = (cross(one.right, one.n), one.right.dot(&one.n));
        let size = length(one.right) * length(one.n);
        let off = length(one.n - one.right) / length(one.right);
        let is_parallel = sine.abs() <= 1e-5 * size;
        match wrong {
            _ if off < 1e-13 => false,
            WrongVectors::Zero => length(one.n) < 1e-4 * length(one.right),
            WrongVectors::Inexact => off < 1e-4,
            WrongVectors::Perpendicular => cosine.abs() <= 1e-5 * size,
            WrongVectors::Direction => off > 1e-7 && (sine.abs() > 1e-7 * size || cosine <= 0.0),
            WrongVectors::Reversed => is_parallel && cosine < 0.0,
            WrongVectors::Length => is_parallel && cosine > 0.0 && off > 1e-6,
        }
    })
}

fn bodies(scene: &Scene, pair: Pair) -> Vec<usize> {
    let second = pair.second as usize;
    let others = match pair.kind {
        PairKind::ParticleParticle => vec![second],
        PairKind::ParticleEdge => vec![scene.edges[second].first, scene.edges[second].second],
        PairKind::ParticleHalfPlane => Vec::new(),
    };
    [vec![pair.first as usize], others].concat()
}

fn responses(scene: &Scene, step: &Step, kind: Option<PairKind>, wrong: &WrongResponses, is_hybrid: bool) -> bool {
    let (right, logged) =
        if is_hybrid { (&step.heard.middle, &step.middle.state) } else { (&step.right, &step.end.state) };
    let hits = || step.heard.hits.iter().filter(|hit| !matches!(step.heard.passes[hit.0], Stage::Geometric { .. }));
    let of = |state: &State, quantity, one| match quantity {
        Quantity::Position => at(&state.positions, one),
        Quantity::Velocity => at(&state.velocities, one),
    };
    hits().filter(|hit| kind.is_none_or(|kind| kind == hit.1.kind)).any(|(_, pair, _, n, _)| {
        let own = bodies(scene, *pair);
        let is_alone = hits().filter(|other| bodies(scene, other.1).iter().any(|one| own.contains(one))).count() == 1;
        let change = |changed: &Changed| {
            let one = *own.get(changed.body).filter(|_| changed.kind == pair.kind)?;
            let [before, ours, theirs] =
                [&step.prediction, right, logged].map(|state| of(state, changed.quantity, one));
            Some((ours - before, theirs - before))
        };
        let is_wrong = |changed: &Changed| change(changed).is_some_and(|(ours, theirs)| !same(ours, theirs));
        let across = |changed: &Changed| {
            let u = unit(*n);
            let is_aside =
                |(ours, theirs): (Vec2, Vec2)| length(theirs - theirs.dot(&u) * u) > 1e-10_f64.max(1e-6 * length(ours));
            change(changed).is_some_and(is_aside)
        };
        let rests = |changed: &Changed| change(changed).is_some_and(|(_, theirs)| length(theirs) < 1e-8);
        is_alone
            && match wrong {
                WrongResponses::Nothing => own.iter().all(|&one| {
                    same(of(&step.prediction, Quantity::Velocity, one), of(logged, Quantity::Velocity, one))
                }),
                WrongResponses::Unchanged(all) => all.iter().any(|one| is_wrong(one) && rests(one)),
                WrongResponses::Across(all) => all.iter().any(across),
                WrongResponses::Amount(all) => all.iter().any(|one| is_wrong(one) && !across(one)),
            }
    })
}

/// Whether the statement about the impulse rounds is true.
fn rounds(scene: &Scene, step: &Step, fault: &StageFault) -> bool {
    let ((ours, behind), (theirs, _)) = (step.right_passes(), step.passes());
    let first = || step.heard.hits.iter().filter(|hit| hit.0 == 0);
    let pass_of = |pair: Pair, pass: usize, wanted: &dyn Fn(usize, &[f64]) -> bool| {
        let own = step.heard.pairs.iter().find(|other| other.0 == pair).map(|other| other.1);
        let lists = own.zip(step.logged(pass));
        lists.is_some_and(|(own, lists)| (own..own + pair.kind.polynomials()).all(|index| wanted(index, lists[index])))
    };
    match fault {
        StageFault::Unresolved { .. } => {
            step.right_lists() >= step.size()
                && first().any(|(_, pair, ..)| {
                    let again = |index: usize, list: &[f64]| same_list(&step.heard.polynomials[index], list);
                    let rests = |one: &usize| {
                        same(at(&step.prediction.positions, *one), at(&step.middle.state.positions, *one))
                    };
                    pass_of(*pair, 1, &again) || bodies(scene, *pair).iter().all(rests)
                })
        }
        StageFault::Rounds(WrongNumber::Fewer) => theirs < ours,
        StageFault::Rounds(WrongNumber::More) => theirs > ours,
        StageFault::Rounds(WrongNumber::Other) => theirs != ours,
        StageFault::HandedOver { quantity, when, .. } => {
            let (right, logged) = (&step.heard.middle, &step.middle.state);
            let is_wrong = match quantity {
                Some(Quantity::Position) => !Step::are(&right.positions, &logged.positions),
                Some(Quantity::Velocity) => !Step::are(&right.velocities, &logged.velocities),
                None => true,
            };
            let is_then = match when {
                Some(LoopEnd::RanOut) => behind > 0,
                Some(LoopEnd::Settled) => behind == 0,
                None => true,
            };
            is_wrong && is_then && ours == theirs && step.right_lists() >= ours * step.size()
        }
        StageFault::FirstRound => {
            step.right_lists() >= step.size() && (step.right_lists() < 2 * step.size() || theirs < 2)
        }
        StageFault::LaterRounds => {
            let right = |index: usize, list: &[f64]| {
                step.heard.polynomials.get(step.size() + index).is_some_and(|ours| same_list(ours, list))
            };
            first().any(|(_, pair, ..)| pass_of(*pair, 1, &right)) && step.right_lists() < 2 * step.size()
        }
        StageFault::RoundsOfPrediction => {
            step.same_passes(0, 1)
                && step.right_lists() < 2 * step.size()
                && !Step::are(&step.prediction.positions, &step.middle.state.positions)
        }
        StageFault::BehindFirstRound => step.right_lists() >= 2 * step.size(),
        _ => false,
    }
}

/// Whether the statement about the part behind a right middle is true.
fn behind_middle(scene: &Scene, step: &Step, fault: &StageFault) -> bool {
    let ((_, ours), (middle, theirs)) = (step.right_passes(), step.passes());
    let reaches = |passes: usize| step.right_lists() >= (middle + passes) * step.size();
    if step.is_right() {
        return false;
    }
    match fault {
        StageFault::Geometric(WrongGeometric::Left { .. }) => ours > 0 && theirs == 0,
        StageFault::Geometric(WrongGeometric::Superfluous) => ours == 0 && theirs > 0,
        StageFault::ZonePositions(WrongPositions::Prediction) => !reaches(1) && step.same_passes(0, middle),
        StageFault::ZonePositions(WrongPositions::First) => theirs > 0 && !reaches(1),
        StageFault::ZonePositions(WrongPositions::BeforeFailsafe) => {
            step.same_passes(middle, middle + 1) && !Step::are(&step.middle.state.positions, &step.end.state.positions)
        }
        StageFault::AfterRounds => true,
        StageFault::ZoneRounds(WrongZoneRounds::Growth) => reaches(2),
        StageFault::ZoneRounds(WrongZoneRounds::Fewer) => theirs < ours,
        StageFault::ZoneRounds(WrongZoneRounds::More) => theirs > ours,
        StageFault::ZoneRounds(WrongZoneRounds::Later) => reaches(2) || theirs != ours,
        StageFault::Zones(wrong) => zones(step).iter().any(|zone| became(scene, step, *zone, *wrong)),
        StageFault::Motion { wrong, .. } => {
            let last = step.heard.zones.iter().map(|zone| zone.0).max();
            let later = step.heard.zones.iter().filter(|zone| Some(zone.0) == last);
            let all: Vec<Zone<'_>> =
                zones(step).into_iter().chain(later.map(|zone| (zone.1.as_slice(), zone.2))).collect();
            wrong
                .iter()
                .all(|wrong| all.iter().any(|zone| !stops(scene, *zone) && moves_so(scene, step, zone.0, *wrong)))
        }
        _ => false,
    }
}

/// The zones of the first round.
fn zones(step: &Step) -> Vec<Zone<'_>> {
    let first = step.heard.zones.iter().map(|zone| zone.0).min();
    step.heard.zones.iter().filter(|zone| Some(zone.0) == first).map(|zone| (zone.1.as_slice(), zone.2)).collect()
}

fn stops(scene: &Scene, (particles, half_plane): Zone<'_>) -> bool {
    half_plane || particles.iter().any(|&one| scene.particles[one].fixed)
}

fn cross(one: Vec2, two: Vec2) -> f64 {
    one.x * two.y - one.y * two.x
}

/// A particle as it is in a state.
fn of(state: &State, one: usize) -> (Vec2, Vec2) {
    (at(&state.positions, one), at(&state.velocities, one))
}

fn is_at(ours: (Vec2, Vec2), theirs: (Vec2, Vec2)) -> bool {
    same(ours.0, theirs.0) && same(ours.1, theirs.1)
}

fn keep_distances(step: &Step, particles: &[usize]) -> bool {
    let distance = |state: &State, one, two| length(at(&state.positions, one) - at(&state.positions, two));
    let mut pairs = particles.iter().flat_map(|&one| particles.iter().map(move |&two| (one, two)));
    pairs.all(|(one, two)| {
        let was = distance(&step.before, one, two);
        (distance(&step.end.state, one, two) - was).abs() <= 1e-8 * (1.0 + was)
    })
}

fn became(scene: &Scene, step: &Step, zone: Zone<'_>, wrong: WrongZones) -> bool {
    let (particles, _) = zone;
    let (end, middle) = (&step.end.state, &step.middle.state);
    let stays = |one: &usize| is_at(of(end, *one), of(middle, *one));
    let is_back = |one: &usize| same(at(&end.positions, *one), at(&step.before.positions, *one));
    let rests = |one: &usize| length(at(&end.velocities, *one)) <= 1e-8;
    let has_stopped = |one: &usize| is_back(one) && rests(one);
    let all = || particles.iter();
    let has_to_stop = stops(scene, zone);
    let first = step
        .heard
        .hits
        .iter()
        .map(|hit| hit.0)
        .find(|&pass| matches!(step.heard.passes[pass], Stage::Geometric { round: 0 }));
    let contacts = || step.heard.hits.iter().filter(move |hit| Some(hit.0) == first).map(|hit| bodies(scene, hit.1));
    match wrong {
        WrongZones::Unmoved => all().all(stays),
        WrongZones::Partly => !has_to_stop && all().any(stays) && !all().all(stays),
        WrongZones::PartlyStopped => has_to_stop && !all().all(has_stopped) && all().any(has_stopped),
        WrongZones::Stop => !has_to_stop && all().all(has_stopped),
        WrongZones::MoveOn => has_to_stop && keep_distances(step, particles) && !all().all(has_stopped),
        WrongZones::KeepPositions => has_to_stop && all().all(rests) && !all().all(is_back),
        WrongZones::KeepVelocities => has_to_stop && all().all(is_back) && !all().all(rests),
        WrongZones::NotMerged => {
            let own: Vec<Vec<usize>> = contacts().filter(|own| own.iter().all(|one| particles.contains(one))).collect();
            let is_split = if has_to_stop {
                !all().all(has_stopped)
            } else {
                all().any(|one| !is_at(of(&step.right, *one), of(end, *one)))
            };
            own.len() > 1 && is_split && own.iter().any(|own| keep_distances(step, own))
        }
        WrongZones::Joined => {
            let others = zones(step).into_iter().filter(|other| other.0 != particles);
            let both = others.map(|other| [particles, other.0].concat());
            both.into_iter().any(|both| keep_distances(step, &both) && !both.iter().all(stays))
        }
        WrongZones::Others => {
            let is_in_zone = |one: &usize| zones(step).iter().any(|zone| zone.0.contains(one));
            (0..scene.particles.len()).any(|one| !is_in_zone(&one) && !stays(&one))
        }
    }
}

fn moves_so(scene: &Scene, step: &Step, particles: &[usize], wrong: WrongMotion) -> bool {
    let mass = |one: usize| scene.particles[one].mass;
    let total: f64 = particles.iter().map(|&one| mass(one)).sum();
    let centre =
        |state: &State| particles.iter().map(|&one| mass(one) / total * at(&state.positions, one)).sum::<Vec2>();
    let end = &step.end.state;
    // The centre keeps its momentum.
    let (from, to, should) = (centre(&step.before), centre(end), centre(&step.middle.state));
    // The arm of each particle, before and after, as angles; the right one from the reference's own end.
    let angle = |state: &State, to: Vec2| {
        let one = *particles.iter().max_by(|a, b| {
            length(at(&step.before.positions, **a) - from).total_cmp(&length(at(&step.before.positions, **b) - from))
        })?;
        let (was, is) = (at(&step.before.positions, one) - from, at(&state.positions, one) - to);
        Some(f64::atan2(cross(was, is), was.dot(&is)))
    };
    let momentum: f64 = particles
        .iter()
        .map(|&one| {
            let (start, moved) = (at(&step.before.positions, one), at(&step.middle.state.positions, one));
            mass(one) * cross(start - from, moved - start - (should - from))
        })
        .sum();
    let inertia: f64 = particles
        .iter()
        .map(|&one| at(&step.before.positions, one) - from)
        .zip(particles)
        .map(|(arm, &one)| mass(one) * arm.dot(&arm))
        .sum();
    let turns = (momentum / inertia, angle(end, to).unwrap_or(0.0));
    let has_velocities = |is_parallel: bool| {
        particles.iter().any(|&one| {
            let motion = (1.0 / scene.time_step) * (at(&end.positions, one) - at(&step.before.positions, one));
            let v = at(&end.velocities, one);
            !same(v, motion) && (!is_parallel || cross(v, motion).abs() <= 1e-6 * (1.0 + length(v) * length(motion)))
        })
    };
    let is_rigid = keep_distances(step, particles);
    match wrong {
        WrongMotion::Centre => !same(to, should),
        WrongMotion::Distances => !is_rigid,
        WrongMotion::NoTurn => is_rigid && turns.1.abs() < 1e-6 && turns.0.abs() > 1e-7,
        WrongMotion::LessTurn => is_rigid && turns.1.abs() < turns.0.abs() && turns.0 * turns.1 > 0.0,
        WrongMotion::MoreTurn => is_rigid && turns.1.abs() > turns.0.abs() && turns.0 * turns.1 > 0.0,
        WrongMotion::TurnBack => is_rigid && turns.0 * turns.1 < 0.0,
        WrongMotion::Turn => is_rigid && (turns.1 - turns.0).abs() > 1e-8,
        WrongMotion::Velocities => has_velocities(false),
        WrongMotion::Speeds => has_velocities(true),
    }
}
