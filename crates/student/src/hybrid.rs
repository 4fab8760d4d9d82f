//! The collision type `hybrid`: impulses first, then rigid impact zones if they are not enough (collisions.md 5).
use super::{
    Area, Mistake, detection, failsafe, impulses,
    objects::{State, Zone},
    step_failure::StepFailure,
    world::{StepLog, World},
    zones,
};

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::ImpactZones];

/// The number of rounds that no correct program exceeds in any scene. Some mistakes change the list of zones forever.
const MAX_ROUNDS: u32 = 1000;

/// The number of zones (or the number of particles, if larger) beyond which a step with a guard is stopped.
const MAX_ZONES: usize = 1000;

/// Handles a step's collisions. `middle` is called between the two parts, with the state and the log so far, for the
/// trace's mid record.
pub fn handle_collisions(
    world: &World,
    q_start: &[f64],
    max_iterations: i32,
    state: &mut State,
    log: &mut StepLog,
    middle: &mut dyn FnMut(&State, &StepLog),
) -> Result<(), StepFailure> {
    let prediction = state.clone();
    let resolved = impulses::apply_rounds(world, q_start, max_iterations, state, log)?;
    middle(state, log);
    if !resolved && world.student.makes(Mistake::GeometricMovesPrediction) {
        *state = prediction;
    }
    if !resolved && !world.student.makes(Mistake::GeometricEmpty) {
        let before = world.student.makes(Mistake::GeometricVelocitiesKept).then(|| state.v.clone());
        respond_geometrically(world, q_start, max_iterations, state, log)?;
        if let Some(before) = before {
            state.v = before;
        }
    }
    Ok(())
}

/// Moves impact zones rigidly, and enlarges them, until there is no new collision.
fn respond_geometrically(
    world: &World,
    q_start: &[f64],
    max_iterations: i32,
    state: &mut State,
    log: &mut StepLog,
) -> Result<(), StepFailure> {
    let student = world.student;
    let prediction = state.clone();
    log.prediction = None;
    let contacts = detection::detect_contacts(world, q_start, &state.x, log)?;
    let mut zones = zones::merge(student, contacts.iter().map(|contact| zones::contact_zone(world, contact)).collect());
    let mut round = 0;
    if zones.is_empty() && student.makes(Mistake::GeometricStopsWhenEmpty) {
        return Ok(());
    }
    let mut moved_zones: Vec<Zone> = Vec::new();
    loop {
        if student.makes(Mistake::GeometricCapped) && i64::from(round) >= i64::from(max_iterations) {
            return Ok(());
        }
        if student.makes(Mistake::GeometricRestarts) {
            state.clone_from(&prediction);
        }
        let mut chosen = zones.clone();
        if student.makes(Mistake::GeometricNewZonesOnly) {
            chosen.retain(|zone| !moved_zones.contains(zone));
        } else if student.makes(Mistake::GeometricGrownStay) {
            chosen.retain(|zone| moved_zones.iter().all(|other| other.particles.is_disjoint(&zone.particles)));
        }
        move_zones(world, q_start, &chosen, state);
        moved_zones.clone_from(&zones);
        round += 1;
        if student.makes(Mistake::GeometricOneRound) {
            return Ok(());
        }
        let is_old = student.makes(Mistake::GeometricDetectsPrediction);
        let q_end = if is_old { &prediction.x } else { &state.x };
        let contacts = detection::detect_contacts(world, q_start, q_end, log)?;
        let found = contacts.iter().map(|contact| zones::contact_zone(world, contact));
        let stops_when_clear = contacts.is_empty() && student.makes(Mistake::GeometricStopsWhenClear);
        if stops_when_clear || student.makes(Mistake::GeometricFindsInVain) {
            return Ok(());
        }
        let mut next: Vec<Zone> =
            if student.makes(Mistake::GeometricForgetsZones) { Vec::new() } else { zones.clone() };
        next.extend(found.filter(|zone| !(zone.has_half_plane && student.makes(Mistake::GeometricHalfPlanesDropped))));
        let next = zones::merge(student, next);
        let same = zones::has_same_zones(student, &zones, &next);
        if same || round > MAX_ROUNDS {
            if student.makes(Mistake::GeometricExtraPass) {
                detection::detect_contacts(world, q_start, &state.x, log)?;
            }
            return Ok(());
        }
        // Some mistakes enlarge the list in every round. A step with a guard does not wait for the end.
        if log.guard.is_some() && next.len() > MAX_ZONES.max(world.scene.particles.len()) {
            return Err(StepFailure::Stopped);
        }
        zones = next;
        if student.makes(Mistake::GeometricTwoRounds) {
            move_zones(world, q_start, &zones, state);
            return Ok(());
        }
    }
}

fn move_zones(world: &World, q_start: &[f64], zones: &[Zone], state: &mut State) {
    let (first, last) = (zones.len().min(1), zones.len().saturating_sub(1));
    let mut chosen: Vec<&Zone> = zones.iter().collect();
    match world.student.mistake_in(MODULE_AREAS) {
        Some(Mistake::ZonesReversed) => chosen.reverse(),
        Some(Mistake::GeometricFirstZoneOnly) => chosen.truncate(1),
        Some(Mistake::GeometricLastZoneOnly) => drop(chosen.drain(..last)),
        Some(Mistake::GeometricFirstZoneSkipped) => drop(chosen.drain(..first)),
        Some(Mistake::GeometricLastZoneSkipped) => chosen.truncate(last),
        _ => {}
    }
    let shared = world.student.makes(Mistake::ZonesFlagShared) && zones.iter().any(|zone| zone.has_half_plane);
    let flagged = chosen.into_iter().map(|zone| Zone { has_half_plane: zone.has_half_plane || shared, ..zone.clone() });
    flagged.for_each(|zone| failsafe::move_zone(world, &zone, q_start, state));
}
