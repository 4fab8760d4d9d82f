//! Finds what the wrong steps of a trace without polynomials have in common: contacts at the end of a step, then
//! velocities, then positions. An observation names what to check, without a guess.
use super::{Explanation, common_value, contacts::explain_overlaps, new_observation};
use crate::diagnose::{
    ChangeRatio, ChangedParticles, Quantity, StageDetail, StageFault, WrongChange,
    known::has_effect,
    sampling::{Capture, KeptStep, Reference, pair_particles},
};
use fosssim_model::{
    assignments::{ForceKind, Integrator, Part},
    scene::{Collision, Force, Scene},
    sim::{PairKind, PenaltyTerms, pairs},
    trace::LoggedImpulse,
};
use fosssim_num::tolerances::KNOWN_STATE_ERROR;
use std::collections::BTreeSet;

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
    let mut parts = Parts::for_scene(scene);
    for kept_step in steps.filter(|kept_step| kept_step.difference.is_some()).take(super::MAX_STEPS) {
        reference.step(kept_step.step, &kept_step.before, &mut capture)?;
        count += 1;
        contacts.push((capture.records.end.impulses.clone(), kept_step.records.end.impulses.clone()));
        let wrong = find_wrong_entries(scene, kept_step, &capture);
        parts.keep_acting(&wrong, kept_step, &capture);
        entries.extend(wrong);
    }
    explain_overlaps(scene, &contacts).or_else(|| explain_changes(scene, &entries, parts.into_likely(), count))
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

fn explain_changes(
    scene: &Scene,
    entries: &[WrongEntry],
    mut parts: BTreeSet<Part>,
    count: usize,
) -> Option<Explanation> {
    let has_wrong = |quantity: Quantity| entries.iter().any(|entry| entry.quantity == quantity);
    let quantity = match (has_wrong(Quantity::Position), has_wrong(Quantity::Velocity)) {
        (true, false) => Quantity::Position,
        (false, true) => Quantity::Velocity,
        _ => return None,
    };
    if quantity == Quantity::Position {
        parts.retain(|part| matches!(part, Part::Integrator(_)));
    }
    if parts.is_empty() {
        return None;
    }
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
    let wrong = WrongChange { quantity, axis, particles, ratio, parts };
    Some(new_observation(StageFault::Change(wrong), details, count))
}

/// The parts of the student's code that may have changed velocities wrongly.
struct Parts<'a> {
    scene: &'a Scene,
    /// The parts that have an effect in the scene.
    present: BTreeSet<Part>,
    /// The parts that act on every particle whose velocity is wrong.
    acting: BTreeSet<Part>,
}

impl<'a> Parts<'a> {
    fn for_scene(scene: &'a Scene) -> Self {
        let written = scene.assignment().definition().student;
        // A submitted file also contains what an earlier milestone asked for.
        let is_submitted = |part: &Part| written.iter().any(|other| other.file() == part.file());
        let forces = ForceKind::ALL.into_iter().map(Part::Force).filter(is_submitted);
        let is_implicit = scene.integrator.is_implicit();
        let counts = pairs(scene).counts();
        let present: BTreeSet<Part> = forces
            .chain(written.iter().copied())
            .filter(|part| !matches!(part, Part::SimpleDetection(_) | Part::Jacobians(ForceKind::SimpleGravity)))
            .filter(|part| !(is_implicit && matches!(part, Part::Force(_))))
            .filter(|part| has_effect(scene, &counts, *part))
            .collect();
        Self { scene, acting: present.clone(), present }
    }

    /// Removes the parts that do not act on a particle whose velocity is wrong. A particle on which nothing acts
    /// removes none.
    fn keep_acting(&mut self, wrong: &[WrongEntry], kept_step: &KeptStep, capture: &Capture) {
        let scene = self.scene;
        let mut touching: BTreeSet<(PairKind, usize)> = BTreeSet::new();
        if let Some(mut terms) = PenaltyTerms::for_scene(scene).filter(|_| !scene.integrator.is_implicit()) {
            terms.visit_pairs(&kept_step.before.positions, |pair, forces| {
                touching.extend(forces.iter().map(|(particle, _)| (pair.kind, *particle)));
            });
        }
        let impulses = capture.records.end.impulses.iter().chain(&kept_step.records.end.impulses);
        for pair in impulses.filter_map(LoggedImpulse::pair) {
            touching.extend(pair_particles(scene, pair).into_iter().map(|particle| (pair.kind, particle)));
        }
        let acts = |part: &Part, particle: usize| match *part {
            Part::Force(kind) => {
                scene.forces.iter().any(|force| force.kind() == kind && acts_on(scene, force, particle))
            }
            Part::Penalty(kind) | Part::SimpleResponse(kind) => touching.contains(&(kind, particle)),
            _ => true,
        };
        for entry in wrong.iter().filter(|entry| entry.quantity == Quantity::Velocity) {
            if self.present.iter().any(|part| acts(part, entry.index / 2)) {
                self.acting.retain(|part| acts(part, entry.index / 2));
            }
        }
    }

    /// Returns the parts that act on all wrong particles, or all parts if none does.
    fn into_likely(self) -> BTreeSet<Part> {
        if self.acting.is_empty() { self.present } else { self.acting }
    }
}

/// Returns whether a force acts on a particle.
fn acts_on(scene: &Scene, force: &Force, particle: usize) -> bool {
    match *force {
        Force::Spring { edge, .. } => {
            scene.edges.get(edge).is_some_and(|edge| [edge.first, edge.second].contains(&particle))
        }
        Force::Gravitation { first, second, .. } | Force::Vortex { first, second, .. } => {
            [first, second].contains(&particle)
        }
        Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } => true,
    }
}
