//! Examines impact zones and the rigid failsafe in steps whose first part is right.
//!
//! A zone is wrong if other zones, moved correctly, explain the particles' positions. The failsafe is examined on right
//! zones: those with one contact, or with particles that move as one body.
use super::{
    Explanation, RATIO_TOLERANCE, common_value,
    events::StepFacts,
    new_observation, ratios, rounds,
    zones::{FirstRound, ParticleGroup, ROUND_OFF_LIMIT, ZoneResult, are_near, center_of_mass, rotation_angle},
};
use crate::diagnose::{StageDetail, StageFault, WrongMotion, WrongPositions, WrongZoneRounds, WrongZones};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::State,
};
use fosssim_num::vector::{Vec2, divide, length, vector_at};

/// The angle below which a rotation counts as zero, in radians.
const MIN_TURN: f64 = 1e-6;

/// Returns the fault in the geometric part, if its start is right.
pub(super) fn explain_geometric_part(scene: &Scene, facts: &[StepFacts]) -> Option<Explanation> {
    if !matches!(scene.collision, Collision::Hybrid { .. }) {
        return None;
    }
    let is_seen = |facts: &&StepFacts| facts.has_right_mid_state() && !may_be_round_off(scene, facts);
    let wrong: Vec<&StepFacts> = facts.iter().filter(|facts| facts.is_wrong).filter(is_seen).collect();
    // If other steps have a different fault, it may affect these steps as well.
    if wrong.is_empty() || facts.iter().any(|facts| facts.is_wrong && !facts.has_right_mid_state()) {
        return None;
    }
    if let Some(geometric) = rounds::explain_geometric(facts) {
        return Some(geometric);
    }
    if let Some(positions) = explain_first_positions(scene, &wrong) {
        return Some(positions);
    }
    let mut zone_motions = ZoneMotions::default();
    for facts in facts {
        zone_motions.compare(scene, facts);
    }
    zone_motions
        .explain()
        .or_else(|| explain_positions_before_failsafe(scene, &wrong))
        .or_else(|| explain_rounds(scene, &wrong))
}

/// Returns whether the first geometric pass may differ only by round-off, because it is right for the logged positions
/// after the impulse rounds. Small coefficients depend on the round-off of these positions.
fn may_be_round_off(scene: &Scene, facts: &StepFacts) -> bool {
    let Some((_, middle)) = facts.mid_states().filter(|_| facts.logged_passes().is_some()) else { return false };
    let pass = polynomial_index_after(facts, 0) / facts.pass_size();
    let differs = facts.right_polynomials < polynomial_index_after(facts, 1).min(facts.expected.end.polynomials.len());
    differs && facts.fits_motion(scene, pass, &middle.state.positions, |_| true)
}

/// Returns the index of the first polynomial after `passes` passes of the geometric part.
fn polynomial_index_after(facts: &StepFacts, passes: usize) -> usize {
    facts.mid_states().map_or(0, |(_, middle)| middle.polynomials.len()) + passes * facts.pass_size()
}

/// Returns the explanation of a first geometric pass that does not use the positions after the impulse rounds. Returns
/// `None` if this pass is right in all steps.
fn explain_first_positions(scene: &Scene, wrong: &[&StepFacts]) -> Option<Explanation> {
    let is_wrong = |facts: &&&StepFacts| {
        facts.logged_passes().is_some() && facts.right_polynomials < polynomial_index_after(facts, 1)
    };
    let wrong_zones: Vec<&&StepFacts> = wrong.iter().filter(is_wrong).collect();
    if wrong_zones.is_empty() {
        return None;
    }
    let is_prediction = |facts: &&&StepFacts| {
        let pass = polynomial_index_after(facts, 0) / facts.pass_size();
        facts.fits_motion(scene, pass, &facts.prediction.positions, |_| true)
    };
    let positions =
        if wrong_zones.iter().all(is_prediction) { WrongPositions::Prediction } else { WrongPositions::First };
    Some(new_observation(StageFault::ZonePositions(positions), Vec::new(), wrong_zones.len()))
}

/// Returns the explanation of a second geometric pass that uses the positions before the failsafe, although the
/// failsafe moves a zone. Returns `None` unless this is so in all wrong steps.
fn explain_positions_before_failsafe(scene: &Scene, wrong: &[&StepFacts]) -> Option<Explanation> {
    let is_so = |facts: &&&StepFacts| {
        let Some((_, middle)) = facts.mid_states() else { return false };
        let (middle, end) = (&middle.state.positions, &facts.actual.end.state.positions);
        let pass = polynomial_index_after(facts, 1) / facts.pass_size();
        facts.right_polynomials < polynomial_index_after(facts, 2)
            && middle.iter().zip(end).any(|(ours, theirs)| (ours - theirs).abs() > ROUND_OFF_LIMIT * (1.0 + ours.abs()))
            && facts.fits_motion(scene, pass, middle, |_| true)
    };
    let count = wrong.iter().filter(is_so).count();
    let fault = StageFault::ZonePositions(WrongPositions::BeforeFailsafe);
    (count == wrong.len()).then(|| new_observation(fault, Vec::new(), count))
}

/// Returns the explanation of the faults after the first round of zones.
fn explain_rounds(scene: &Scene, wrong: &[&StepFacts]) -> Option<Explanation> {
    let (mut fewer, mut more, mut later, mut ends) = (0, 0, 0, Vec::new());
    for facts in wrong {
        let (ours, theirs) = (facts.expected.end.polynomials.len(), facts.actual.end.polynomials.len());
        let all_right = facts.right_polynomials >= ours.min(theirs);
        if all_right && ours == theirs {
            ends.push(*facts);
        } else if all_right && facts.logged_passes().is_some() {
            *(if theirs < ours { &mut fewer } else { &mut more }) += 1;
        } else if facts.right_polynomials >= polynomial_index_after(facts, 2) {
            later += 1;
        } else {
            return Some(new_observation(StageFault::AfterRounds, Vec::new(), wrong.len()));
        }
    }
    let rounds = match (fewer, more, later, ends.len()) {
        (0, 0, 0, _) => return Some(explain_velocities(scene, &ends)),
        (0, 0, _, 0) => WrongZoneRounds::Growth,
        (_, 0, 0, 0) => WrongZoneRounds::Fewer,
        (0, _, 0, 0) => WrongZoneRounds::More,
        (.., 0) => WrongZoneRounds::Later,
        _ => return Some(new_observation(StageFault::AfterRounds, Vec::new(), wrong.len())),
    };
    Some(new_observation(StageFault::ZoneRounds(rounds), Vec::new(), wrong.len()))
}

/// Returns the explanation of steps whose polynomials are right but whose end states are wrong: the velocities of zones
/// with right positions.
fn explain_velocities(scene: &Scene, ends: &[&StepFacts]) -> Explanation {
    let mut errors = MotionErrors::default();
    for facts in ends {
        let (expected, actual) = (&facts.expected.end.state, &facts.actual.end.state);
        let count = scene.particles.len();
        if !(0..count)
            .all(|particle| are_near(vector_at(&expected.positions, particle), vector_at(&actual.positions, particle)))
        {
            return new_observation(StageFault::AfterRounds, Vec::new(), ends.len());
        }
        let Some(last) = facts.zones.iter().map(|zone| zone.round).max() else { continue };
        for zone in facts.zones.iter().filter(|zone| zone.round == last) {
            let group = ParticleGroup { particles: zone.particles.clone(), has_half_plane: zone.has_half_plane };
            if group.must_stop(scene) {
                return new_observation(StageFault::AfterRounds, Vec::new(), ends.len());
            }
            errors.measure_velocities(scene, &facts.before, actual, &group);
        }
    }
    let (wrong, details) = errors.describe();
    if wrong.is_empty() {
        return new_observation(StageFault::AfterRounds, Vec::new(), ends.len());
    }
    new_observation(StageFault::Motion { wrong, or_zones: false }, details, ends.len())
}

/// The results of the zones in the first round of each step.
#[derive(Default)]
struct ZoneMotions {
    results: Vec<ZoneResult>,
    /// The ratios of the new to the previous velocities of zones that must stop.
    stop_ratios: Vec<f64>,
    has_stopped_otherwise: bool,
    /// The number of zones of several contacts whose particles do not keep their distances.
    deformed_large_zones: usize,
    deformed_single_zones: usize,
    deformed_stops: usize,
    errors: MotionErrors,
}

impl ZoneMotions {
    fn compare(&mut self, scene: &Scene, facts: &StepFacts) {
        let Some(first) = FirstRound::for_scene(scene, facts) else { return };
        for zone in &first.zones {
            if !first.is_visible(zone) && (first.is_as_expected(zone) || !first.is_split(zone)) {
                continue;
            }
            let result =
                if first.is_visible(zone) { first.zone_result(zone) } else { ZoneResult::Wrong(WrongZones::NotMerged) };
            self.results.push(result);
            match result {
                ZoneResult::Wrong(WrongZones::KeepVelocities) => self.record_kept_velocities(&first, zone),
                ZoneResult::Deformed if zone.must_stop(scene) => self.deformed_stops += 1,
                ZoneResult::Deformed | ZoneResult::Rigid => {
                    let is_one = first.zone_contacts(zone).len() < 2;
                    if result == ZoneResult::Deformed {
                        *(if is_one { &mut self.deformed_single_zones } else { &mut self.deformed_large_zones }) += 1;
                    }
                    self.errors.measure_motion(scene, &first, zone);
                }
                _ => {}
            }
        }
    }

    fn record_kept_velocities(&mut self, first: &FirstRound<'_>, zone: &ParticleGroup) {
        for &one in &zone.particles {
            let (before, after) = (vector_at(&first.middle.velocities, one), vector_at(&first.end.velocities, one));
            if length(before) > ROUND_OFF_LIMIT {
                let ratio = after.dot(&before) / before.dot(&before);
                self.has_stopped_otherwise |= !are_near(after, ratio * before);
                self.stop_ratios.push(ratio);
            }
        }
    }

    fn count_results(&self, result: ZoneResult) -> usize {
        self.results.iter().filter(|zone_result| **zone_result == result).count()
    }

    fn explain(&self) -> Option<Explanation> {
        let zone_count = self.results.len();
        let wrong = zone_count - self.count_results(ZoneResult::Right);
        let count = |fault: WrongZones| self.count_results(ZoneResult::Wrong(fault));
        // The results that prove the failsafe right are checked first.
        let faults = [
            WrongZones::NotMerged,
            WrongZones::Joined,
            WrongZones::Others,
            WrongZones::Partly,
            WrongZones::Unmoved,
            WrongZones::Stop,
            WrongZones::PartlyStopped,
            WrongZones::MoveOn,
            WrongZones::KeepPositions,
            WrongZones::KeepVelocities,
        ];
        if let Some(fault) = faults.into_iter().find(|fault| count(*fault) > 0) {
            let details = match fault {
                WrongZones::KeepVelocities if self.has_stopped_otherwise || self.stop_ratios.is_empty() => Vec::new(),
                WrongZones::KeepVelocities => vec![StageDetail::StoppedVelocities(ratios(&self.stop_ratios))],
                _ => vec![StageDetail::ZoneCount { count: count(fault), of: zone_count }],
            };
            return Some(new_observation(StageFault::Zones(fault), details, wrong));
        }
        if wrong == 0 || self.deformed_stops > 0 {
            return (wrong > 0).then(|| new_observation(StageFault::AfterRounds, Vec::new(), wrong));
        }
        let (mut what, details) = self.errors.describe();
        if self.deformed_single_zones + self.deformed_large_zones > 0 {
            what.insert(
                what.iter().position(|motion| *motion != WrongMotion::Center).unwrap_or(what.len()),
                WrongMotion::Distances,
            );
        }
        let or_zones = self.deformed_large_zones > 0 && self.deformed_single_zones == 0;
        Some(new_observation(StageFault::Motion { wrong: what, or_zones }, details, wrong))
    }
}

/// The ratios of actual to expected motion of zones that need not stop.
#[derive(Default)]
struct MotionErrors {
    shift_ratios: Vec<f64>,
    has_side_shift: bool,
    turn_ratios: Vec<f64>,
    /// Whether a zone did not move as one rigid body. The turns then mean nothing.
    has_deformed_zone: bool,
    velocity_ratios: Vec<f64>,
    has_other_velocity: bool,
}

impl MotionErrors {
    fn measure_motion(&mut self, scene: &Scene, first: &FirstRound<'_>, zone: &ParticleGroup) {
        let (start, expected, end) = (&first.facts.before, first.expected_state(zone), first.end);
        let [from, ours, theirs] = [start, &expected, end].map(|state| center_of_mass(scene, zone, state));
        let (right_shift, actual_shift) = (ours - from, theirs - from);
        if length(right_shift) > ROUND_OFF_LIMIT {
            let ratio = actual_shift.dot(&right_shift) / right_shift.dot(&right_shift);
            self.has_side_shift |= !are_near(actual_shift, ratio * right_shift);
            self.shift_ratios.push(ratio);
        } else {
            self.has_side_shift |= length(actual_shift) > ROUND_OFF_LIMIT;
        }
        if first.zone_result(zone) == ZoneResult::Rigid {
            let [right, angle] = [(&expected, ours), (end, theirs)]
                .map(|(state, center)| measure_turn(zone, start, from, state, center));
            let is_once_round = rotation_angle(scene, zone, start, first.middle).abs() < std::f64::consts::PI;
            if !is_once_round {
                // If a rotation exceeds half a turn, only the remainder is visible, which shows neither the angle nor
                // the direction.
                self.turn_ratios.push(if (angle - right).abs() <= MIN_TURN { 1.0 } else { f64::NAN });
            } else if right.abs() > MIN_TURN {
                self.turn_ratios.push(angle / right);
            } else if angle.abs() > MIN_TURN {
                self.turn_ratios.push(f64::NAN);
            }
        } else {
            self.has_deformed_zone = true;
        }
        self.measure_velocities(scene, start, end, zone);
    }

    /// Compares velocities with the motion from the start to the end of the step.
    fn measure_velocities(&mut self, scene: &Scene, start: &State, end: &State, zone: &ParticleGroup) {
        for &one in &zone.particles {
            let motion = divide(vector_at(&end.positions, one) - vector_at(&start.positions, one), scene.time_step);
            let velocity = vector_at(&end.velocities, one);
            if length(motion) > ROUND_OFF_LIMIT {
                let ratio = velocity.dot(&motion) / motion.dot(&motion);
                self.has_other_velocity |= !are_near(velocity, ratio * motion);
                self.velocity_ratios.push(ratio);
            }
        }
    }

    fn describe(&self) -> (Vec<WrongMotion>, Vec<StageDetail>) {
        let (mut wrong, mut details) = (Vec::new(), Vec::new());
        if self.has_side_shift || !all_equal_one(&self.shift_ratios) {
            wrong.push(WrongMotion::Center);
            details.push(match common_value(&self.shift_ratios) {
                Some(_) if !self.has_side_shift => StageDetail::CenterMotion(ratios(&self.shift_ratios)),
                _ => StageDetail::CenterDirection,
            });
        }
        if !self.has_deformed_zone && !all_equal_one(&self.turn_ratios) {
            wrong.push(describe_turn(&self.turn_ratios));
            if self.turn_ratios.iter().all(|ratio| ratio.is_finite()) {
                details.push(StageDetail::Rotations(ratios(&self.turn_ratios)));
            }
        }
        if self.has_other_velocity {
            wrong.push(WrongMotion::Velocities);
        } else if !all_equal_one(&self.velocity_ratios) {
            wrong.push(WrongMotion::Speeds);
            details.push(StageDetail::Velocities(ratios(&self.velocity_ratios)));
        }
        (wrong, details)
    }
}

/// Returns the fault in the rotations of zones, from the ratios of their actual to their expected rotations.
fn describe_turn(ratios: &[f64]) -> WrongMotion {
    let wrong = || ratios.iter().filter(|ratio| !((*ratio - 1.0).abs() <= RATIO_TOLERANCE));
    if wrong().all(|ratio| ratio.abs() <= RATIO_TOLERANCE) {
        WrongMotion::NoTurn
    } else if wrong().all(|&ratio| 0.0 < ratio && ratio < 1.0) {
        WrongMotion::LessTurn
    } else if wrong().all(|&ratio| ratio > 1.0) {
        WrongMotion::MoreTurn
    } else if wrong().all(|&ratio| ratio < 0.0) && common_value(ratios).is_some() {
        WrongMotion::TurnBack
    } else {
        WrongMotion::Turn
    }
}

fn all_equal_one(ratios: &[f64]) -> bool {
    ratios.iter().all(|ratio| (ratio - 1.0).abs() <= RATIO_TOLERANCE)
}

/// Returns the angle by which the particles have turned about their center, in radians.
#[expect(clippy::disallowed_methods, reason = "angles are compared with a tolerance here: no bit is a contract")]
fn measure_turn(zone: &ParticleGroup, start: &State, from: Vec2, end: &State, to: Vec2) -> f64 {
    let (mut across, mut along) = (0.0, 0.0);
    for &one in &zone.particles {
        let (before, after) = (vector_at(&start.positions, one) - from, vector_at(&end.positions, one) - to);
        across += before.x * after.y - before.y * after.x;
        along += before.dot(&after);
    }
    f64::atan2(across, along)
}
