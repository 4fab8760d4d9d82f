//! Finds what the wrong steps of a trace without polynomials have in common: contacts at the end of a step, then
//! velocities, then positions. An observation names what to check, without a guess.
use super::{Explanation, common_value, contacts::explain_overlaps, new_observation};
use crate::diagnose::{
    ChangeCause, ChangeRatio, ChangedParticles, Quantity, StageDetail, StageFault, WrongChange,
    sampling::{Capture, KeptStep, Reference},
};
use fosssim_model::{
    assignments::{Assignment, Integrator},
    scene::{Collision, Scene},
};
use fosssim_num::tolerances::KNOWN_STATE_ERROR;

/// A wrong number of a state, with its actual and its expected change.
struct WrongEntry {
    index: usize,
    quantity: Quantity,
    actual: f64,
    expected: f64,
}

/// Returns the observation about the wrong steps among `steps`, if they have something in common.
pub(super) fn explain<'a>(
    reference: &mut Reference<'_>,
    scene: &Scene,
    steps: impl Iterator<Item = &'a KeptStep>,
) -> Option<Explanation> {
    let mut capture = Capture::new(&scene.collision);
    let (mut contacts, mut entries, mut count) = (Vec::new(), Vec::new(), 0);
    for kept_step in steps.filter(|kept_step| kept_step.difference.is_some()).take(super::MAX_STEPS) {
        reference.step(kept_step.step, &kept_step.before, &mut capture)?;
        count += 1;
        contacts.push((capture.records.end.impulses.clone(), kept_step.records.end.impulses.clone()));
        entries.extend(find_wrong_entries(scene, kept_step, &capture));
    }
    explain_overlaps(scene, &contacts).or_else(|| explain_changes(scene, &entries, count))
}

/// Returns the wrong velocities, and the positions that do not follow from the actual velocities.
fn find_wrong_entries(scene: &Scene, kept_step: &KeptStep, capture: &Capture) -> Vec<WrongEntry> {
    let (before, actual, expected) = (&kept_step.before, &kept_step.records.end.state, &capture.records.end.state);
    let is_wrong = |actual: f64, expected: f64| (actual - expected).abs() > KNOWN_STATE_ERROR * (1.0 + expected.abs());
    let mut entries = Vec::new();
    for index in 0..before.positions.len() {
        let (x, v) = (before.positions[index], before.velocities[index]);
        let (new, right) = (actual.velocities[index], expected.velocities[index]);
        if is_wrong(new, right) {
            entries.push(WrongEntry { index, quantity: Quantity::Velocity, actual: new - v, expected: right - v });
        }
        // The simple response changes velocities after the integrator.
        let rate = match scene.integrator {
            Integrator::ExplicitEuler => v,
            _ if matches!(scene.collision, Collision::Simple { .. }) => continue,
            _ => new,
        };
        let displacement = scene.time_step * rate;
        if is_wrong(actual.positions[index], x + displacement) {
            let actual = actual.positions[index] - x;
            entries.push(WrongEntry { index, quantity: Quantity::Position, actual, expected: displacement });
        }
    }
    entries
}

fn explain_changes(scene: &Scene, entries: &[WrongEntry], count: usize) -> Option<Explanation> {
    let has_wrong = |quantity: Quantity| entries.iter().any(|entry| entry.quantity == quantity);
    let quantity = match (has_wrong(Quantity::Position), has_wrong(Quantity::Velocity)) {
        (true, false) => Quantity::Position,
        (false, true) => Quantity::Velocity,
        _ => return None,
    };
    let cause = find_cause(scene, quantity)?;
    let last = scene.particles.len().checked_sub(1)?;
    let all_are = |test: &dyn Fn(usize) -> bool| entries.iter().all(|entry| test(entry.index));
    let axis = (0..2).find(|axis| all_are(&|index| index % 2 == *axis));
    let particles = match () {
        () if all_are(&|index| scene.particles[index / 2].fixed) => ChangedParticles::Fixed,
        () if last > 0 && all_are(&|index| index / 2 == 0) => ChangedParticles::First,
        () if last > 0 && all_are(&|index| index / 2 == last) => ChangedParticles::Last,
        () => ChangedParticles::Any,
    };
    let ratios: Vec<f64> =
        entries.iter().filter(|entry| entry.expected.abs() > 1e-9).map(|entry| entry.actual / entry.expected).collect();
    let (ratio, details) = match common_value(&ratios) {
        _ if ratios.len() < entries.len() => (ChangeRatio::Other, Vec::new()),
        Some(ratio) if ratio.abs() < super::RATIO_TOLERANCE => (ChangeRatio::Nothing, Vec::new()),
        Some(ratio) if (ratio + 1.0).abs() < super::RATIO_TOLERANCE => (ChangeRatio::Opposite, Vec::new()),
        Some(ratio) => (ChangeRatio::Factor, vec![StageDetail::Factor(ratio)]),
        None => (ChangeRatio::Other, Vec::new()),
    };
    let wrong = WrongChange { quantity, axis, particles, ratio, cause };
    Some(new_observation(StageFault::Change(wrong), details, count))
}

/// Returns the student code of the scene's milestone that changes `quantity`, or `None` if no single part of the code
/// does.
fn find_cause(scene: &Scene, quantity: Quantity) -> Option<ChangeCause> {
    use Quantity::{Position, Velocity};
    match (scene.assignment(), &scene.collision, scene.integrator, quantity) {
        (Assignment::T1M1 | Assignment::T1M3, _, _, Position)
        | (Assignment::T1M2, _, Integrator::SymplecticEuler, Position) => Some(ChangeCause::Integrator),
        (Assignment::T1M1, ..) | (Assignment::T1M2, _, Integrator::SymplecticEuler, _) => {
            Some(ChangeCause::ForcesOrIntegrator)
        }
        (Assignment::T1M2, _, _, Velocity) => Some(ChangeCause::Forces),
        (Assignment::T1M3, ..) => Some(ChangeCause::JacobiansOrIntegrator),
        (Assignment::T2M1, Collision::Simple { .. }, _, Velocity) => Some(ChangeCause::Response),
        (Assignment::T2M1, Collision::Penalty { .. }, _, Velocity) => Some(ChangeCause::Penalty),
        _ => None,
    }
}
