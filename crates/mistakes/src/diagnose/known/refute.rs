//! Decides whether a mistake would show on a scene. A program that is right on such a scene does not make the mistake.
use super::{
    applicable_rows::{is_state_mistake, may_change_trace},
    resimulate::{resimulate, step_work},
};
use crate::diagnose::sampling::{CLEAR_TOLERANCE, Capture, find_first_difference, polynomial_matches};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{RootSearch, Simulation},
};
use fosssim_student::{Area, Mistake, StepLog, Student, World, find};
use std::cell::Cell;

/// The maximum number of computed polynomials. Computing one takes about a microsecond.
const MAX_WORK: u64 = 200_000;

/// Returns whether the mistake changes a logged value on this scene by more than round-off. Returns `false` if the
/// search would take too long, or if the course's library does that part of the work. In t2m2 the library responds, so
/// a program's own impulses show only in `hybrid`.
pub fn mistake_is_visible(scene: &Scene, key: &str) -> bool {
    mistake_is_visible_within(scene, key, &Cell::new(0))
}

/// Returns whether the mistake is visible on the scene. `work` counts the work of several calls, which is limited
/// together.
pub(in crate::diagnose) fn mistake_is_visible_within(scene: &Scene, key: &str, work: &Cell<u64>) -> bool {
    let Some(row) = find(key).filter(|row| may_change_trace(scene, row)) else { return false };
    if row.area == Area::Response
        && !is_state_mistake(row)
        && matches!(scene.collision, Collision::ContinuousTime { .. } | Collision::Simple { .. })
    {
        return false;
    }
    let world = World::new(scene.clone(), Student::new(Some(row.mistake)));
    // The fair rules also accept the nearest point of an edge, so a different contact vector proves nothing there.
    let accepted = world.for_student(Student::new(Some(Mistake::ParticleEdgeContactClamped)));
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut capture = Capture::new(&scene.collision);
    let each = step_work(scene);
    for _ in 0..scene.step_count() {
        let before = simulation.state().clone();
        if work.get() > MAX_WORK || simulation.step(&mut capture).is_err() {
            return false;
        }
        let expected = &capture.records.end.polynomials;
        work.set(work.get() + each + expected.len() as u64);
        let guard = |index: usize, coefficients: &[f64]| {
            work.set(work.get() + 1);
            index < expected.len() && polynomial_matches(coefficients, expected.get(index), &CLEAR_TOLERANCE)
        };
        let is_seen = |world: &World| {
            let records = resimulate(world, &before, &mut StepLog { guard: Some(&guard), ..StepLog::default() });
            records.is_none_or(|records| find_first_difference(&capture.records, &records, &CLEAR_TOLERANCE).is_some())
        };
        if is_seen(&world) && !is_seen(&accepted) {
            return true;
        }
    }
    false
}
