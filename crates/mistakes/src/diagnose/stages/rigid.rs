//! Impact zones and the rigid failsafe: steps whose first part is right, zone by zone.
use super::{
    ALIKE, Explanation, common_value,
    events::{Facts, ZoneFacts},
    observation, ratios,
};
use crate::diagnose::{StageDetail, StageFault, WrongMotion, WrongZoneRounds, WrongZones};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::State,
};
use fosssim_num::vector::{Vec2, at, length, over};

/// Differences below this are round-off (relative to the size of the numbers, and 1).
const SMALL: f64 = 1e-9;

/// What is wrong with the geometric part, whose start is right.
pub(super) fn explain(scene: &Scene, facts: &[Facts]) -> Option<Explanation> {
    if !matches!(scene.collision, Collision::Hybrid { .. }) {
        return None;
    }
    let wrong: Vec<&Facts> = facts.iter().filter(|facts| facts.is_wrong && facts.has_right_middle()).collect();
    // Something else is wrong with the others, and may be with these.
    if wrong.is_empty() || facts.iter().any(|facts| facts.is_wrong && !facts.has_right_middle()) {
        return None;
    }
    let mut moved = Moved::default();
    for facts in facts.iter().filter(|facts| facts.has_right_middle()) {
        moved.look(scene, facts);
    }
    moved.explain().or_else(|| rounds(&wrong, moved.right > 0))
}

/// The passes of the geometric part, expected and actual.
fn passes(facts: &Facts) -> (usize, usize) {
    let (Some((middle, _)), size) = (facts.middles(), facts.pass_size().max(1)) else { return (0, 0) };
    let of = |all: usize| all.saturating_sub(middle.polynomials.len()) / size;
    (of(facts.expected.end.polynomials.len()), of(facts.actual.end.polynomials.len()))
}

/// What is wrong where zones grow.
fn rounds(wrong: &[&Facts], is_right_at_first: bool) -> Option<Explanation> {
    let mut fewer = 0;
    let mut more = 0;
    let mut later = 0;
    for facts in wrong {
        let (ours, theirs) = passes(facts);
        let shorter = facts.expected.end.polynomials.len().min(facts.actual.end.polynomials.len());
        let is_whole = facts.actual.end.polynomials.len().is_multiple_of(facts.pass_size().max(1));
        if ours != theirs && is_whole && facts.right_polynomials >= shorter {
            *(if theirs < ours { &mut fewer } else { &mut more }) += 1;
        } else {
            later += 1;
        }
    }
    if !is_right_at_first && later > 0 {
        return Some(observation(StageFault::AfterRounds, Vec::new(), wrong.len()));
    }
    let rounds = match (fewer, more, later) {
        (0, 0, _) => WrongZoneRounds::Growth,
        (_, 0, 0) => WrongZoneRounds::Fewer,
        (0, _, 0) => WrongZoneRounds::More,
        _ => WrongZoneRounds::Later,
    };
    Some(observation(StageFault::ZoneRounds(rounds), Vec::new(), wrong.len()))
}

/// What became of zones that were moved once.
#[derive(Default)]
struct Moved {
    right: usize,
    zones: usize,
    unmoved: usize,
    partly: usize,
    stops: usize,
    kept_positions: usize,
    /// Velocities of zones that have to stop, over what they were.
    stopped: Vec<f64>,
    has_stopped_otherwise: bool,
    bent: usize,
    shifts: Vec<f64>,
    has_side_shift: bool,
    turns: Vec<f64>,
    velocities: Vec<f64>,
    has_other_velocity: bool,
}

impl Moved {
    /// Looks at the zones of a step that stay as they are from the first round to the last.
    fn look(&mut self, scene: &Scene, facts: &Facts) {
        let Some(last) = facts.zones.iter().map(|zone| zone.round).max() else { return };
        let is_alike = |zone: &ZoneFacts, other: &ZoneFacts| {
            (&zone.particles, zone.half_plane) == (&other.particles, other.half_plane)
        };
        let first = facts.zones.iter().map(|zone| zone.round).min().unwrap_or(last);
        for zone in facts.zones.iter().filter(|zone| zone.round == first) {
            let in_round = |round| facts.zones.iter().any(|other| other.round == round && is_alike(zone, other));
            if !(first..=last).all(in_round) {
                continue;
            }
            if self.is_right(facts, zone) {
                self.right += 1;
                continue;
            }
            let is_stopped = zone.half_plane || zone.particles.iter().any(|&one| scene.particles[one].fixed);
            self.zones += 1;
            if is_stopped { self.stopped_zone(facts, zone) } else { self.free_zone(scene, facts, zone) }
        }
    }

    fn is_right(&self, facts: &Facts, zone: &ZoneFacts) -> bool {
        let (expected, actual) = (&facts.expected.end.state, &facts.actual.end.state);
        zone.particles.iter().all(|&one| {
            near(at(&expected.positions, one), at(&actual.positions, one))
                && near(at(&expected.velocities, one), at(&actual.velocities, one))
        })
    }

    fn stopped_zone(&mut self, facts: &Facts, zone: &ZoneFacts) {
        let Some((_, middle)) = facts.middles() else { return };
        let end = &facts.actual.end.state;
        let goes_back =
            zone.particles.iter().all(|&one| near(at(&end.positions, one), at(&facts.before.positions, one)));
        self.kept_positions += usize::from(!goes_back);
        for &one in &zone.particles {
            let (was, is) = (at(&middle.state.velocities, one), at(&end.velocities, one));
            if length(was) > SMALL {
                let ratio = is.dot(&was) / was.dot(&was);
                self.has_stopped_otherwise |= !near(is, ratio * was);
                self.stopped.push(ratio);
            }
        }
    }

    fn free_zone(&mut self, scene: &Scene, facts: &Facts, zone: &ZoneFacts) {
        let Some((_, middle)) = facts.middles() else { return };
        let (start, end, expected) = (&facts.before, &facts.actual.end.state, &facts.expected.end.state);
        let stays = |one: &usize| {
            near(at(&end.positions, *one), at(&middle.state.positions, *one))
                && near(at(&end.velocities, *one), at(&middle.state.velocities, *one))
        };
        match zone.particles.iter().filter(|one| stays(one)).count() {
            all if all == zone.particles.len() => {
                self.unmoved += 1;
                return;
            }
            0 => {}
            _ => {
                self.partly += 1;
                return;
            }
        }
        let goes_back = zone.particles.iter().all(|&one| near(at(&end.positions, one), at(&start.positions, one)));
        if goes_back && zone.particles.iter().all(|&one| length(at(&end.velocities, one)) <= SMALL) {
            self.stops += 1;
            return;
        }
        self.bent += usize::from(!keeps_distances(zone, start, end));
        let centre = |state: &State| {
            let sum = |weigh: &dyn Fn(usize) -> Vec2| zone.particles.iter().map(|&one| weigh(one)).sum::<Vec2>();
            let total: f64 = zone.particles.iter().map(|&one| scene.particles[one].mass).sum();
            over(sum(&|one| scene.particles[one].mass * at(&state.positions, one)), total)
        };
        let [from, ours, theirs] = [start, expected, end].map(centre);
        let (should, does) = (ours - from, theirs - from);
        if length(should) > SMALL {
            let ratio = does.dot(&should) / should.dot(&should);
            self.has_side_shift |= !near(does, ratio * should);
            self.shifts.push(ratio);
        }
        let [right, angle] =
            [(expected, ours), (end, theirs)].map(|(state, centre)| turn(zone, start, from, state, centre));
        if right.abs() > SMALL {
            self.turns.push(angle / right);
        }
        for &one in &zone.particles {
            let motion = over(at(&end.positions, one) - at(&start.positions, one), scene.time_step);
            let velocity = at(&end.velocities, one);
            if length(motion) > SMALL {
                let ratio = velocity.dot(&motion) / motion.dot(&motion);
                self.has_other_velocity |= !near(velocity, ratio * motion);
                self.velocities.push(ratio);
            }
        }
    }

    fn explain(&self) -> Option<Explanation> {
        if self.zones == 0 {
            return None;
        }
        let told = |fault: StageFault, details: Vec<StageDetail>| Some(observation(fault, details, self.zones));
        let of_zones = |wrong: WrongZones| told(StageFault::Zones(wrong), Vec::new());
        if self.partly > 0 {
            return of_zones(WrongZones::Partly);
        }
        if self.unmoved > 0 {
            return of_zones(WrongZones::Unmoved);
        }
        if self.stops > 0 {
            return of_zones(WrongZones::Stop);
        }
        if self.kept_positions > 0 {
            return of_zones(WrongZones::KeepPositions);
        }
        if !self.stopped.is_empty() {
            let stopped = (!self.has_stopped_otherwise).then(|| StageDetail::Stopped(ratios(&self.stopped)));
            return told(StageFault::Zones(WrongZones::KeepVelocities), stopped.into_iter().collect());
        }
        let (wrong, details) = self.motion();
        // A zone of other particles moves otherwise in every respect.
        let is_simple =
            self.bent > 0 || is_one(&self.turns) || (!self.has_side_shift && common_value(&self.shifts).is_some());
        told(StageFault::Motion { wrong, or_zones: !is_simple }, details)
    }

    /// What is wrong with the motion of zones that need not stop.
    fn motion(&self) -> (Vec<WrongMotion>, Vec<StageDetail>) {
        let (mut wrong, mut details) = (Vec::new(), Vec::new());
        if self.has_side_shift || !is_one(&self.shifts) {
            wrong.push(WrongMotion::Centre);
            details.push(match common_value(&self.shifts) {
                Some(_) if !self.has_side_shift => StageDetail::CentreMoves(ratios(&self.shifts)),
                _ => StageDetail::CentreDirection,
            });
        }
        if self.bent > 0 {
            wrong.push(WrongMotion::Distances);
        } else if !is_one(&self.turns) {
            wrong.push(WrongMotion::Turn);
            details.push(StageDetail::Turns(ratios(&self.turns)));
        }
        if self.has_other_velocity {
            wrong.push(WrongMotion::Velocities);
        } else if !is_one(&self.velocities) {
            wrong.push(WrongMotion::Speeds);
            details.push(StageDetail::Velocities(ratios(&self.velocities)));
        }
        (wrong, details)
    }
}

fn is_one(ratios: &[f64]) -> bool {
    ratios.iter().all(|ratio| (ratio - 1.0).abs() <= ALIKE)
}

fn near(one: Vec2, two: Vec2) -> bool {
    length(one - two) <= SMALL * (1.0 + length(one))
}

fn keeps_distances(zone: &ZoneFacts, start: &State, end: &State) -> bool {
    let distance =
        |state: &State, one: usize, two: usize| length(at(&state.positions, one) - at(&state.positions, two));
    let pairs = || zone.particles.iter().flat_map(|&one| zone.particles.iter().map(move |&two| (one, two)));
    pairs().all(|(one, two)| {
        let (was, is) = (distance(start, one, two), distance(end, one, two));
        (was - is).abs() <= SMALL * (1.0 + was)
    })
}

/// The angle by which the particles have turned about their centre, radians.
fn turn(zone: &ZoneFacts, start: &State, from: Vec2, end: &State, to: Vec2) -> f64 {
    let (mut across, mut along) = (0.0, 0.0);
    for &one in &zone.particles {
        let (was, is) = (at(&start.positions, one) - from, at(&end.positions, one) - to);
        across += was.x * is.y - was.y * is.x;
        along += was.dot(&is);
    }
    f64::atan2(across, along)
}
