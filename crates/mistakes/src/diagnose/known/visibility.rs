//! Decides whether a mistake would show in a scene. A program that is right on such a scene does not make the mistake.
use super::{
    applicable_rows::{is_state_mistake, may_change_trace},
    resimulate::{resimulate, step_work},
};
use crate::diagnose::sampling::{CLEAR_TOLERANCE, Capture, StepRecords, find_first_difference, polynomial_matches};
use fosssim_model::{
    assignments::Integrator,
    scene::{Collision, Scene},
    sim::{RootSearch, Simulation},
};
use fosssim_student::{Area, Mistake, StepLog, Student, World, find};
use std::cell::Cell;

/// The maximum number of computed polynomials. Computing one takes about a microsecond.
const MAX_WORK: u64 = 200_000;

/// The effect of a mistake on what a program logs for a scene.
#[derive(PartialEq, Eq)]
pub(in crate::diagnose) enum MistakeEffect {
    /// The mistake changes no logged value by more than round-off, or the search for one would take too long.
    Hidden,
    /// The mistake changes a logged value.
    Visible,
    /// With the mistake, Newton's method does not converge soon, or diverges. Where a program ends its loop is not
    /// known, so it may log any value.
    NoResult,
}

/// Returns whether a program with the mistake would be wrong on this scene by more than round-off. Also returns `false`
/// if the search would take too long, or if the course's library, and not the student's code, computes what the mistake
/// would change. In t2m2 the library applies the collision response, so mistakes in a student's own impulses are
/// visible only with `hybrid` handling.
pub fn mistake_is_visible(scene: &Scene, key: &str) -> bool {
    find_effect(scene, key, &Cell::new(0)) != MistakeEffect::Hidden
}

/// Returns the effect of the mistake on what a program logs for the scene. `work` counts the computed polynomials of
/// several calls, which share one limit.
pub(in crate::diagnose) fn find_effect(scene: &Scene, key: &str, work: &Cell<u64>) -> MistakeEffect {
    let Some(row) = find(key).filter(|row| may_change_trace(scene, row)) else {
        return MistakeEffect::Hidden;
    };
    if row.area == Area::Response
        && !is_state_mistake(row)
        && matches!(scene.collision, Collision::ContinuousTime { .. } | Collision::Simple { .. })
    {
        return MistakeEffect::Hidden;
    }
    let world = World::new(scene.clone(), Student::new(Some(row.mistake)));
    // The fair rules also accept the nearest point of an edge, so a different contact vector proves nothing there.
    let accepted = world.for_student(Student::new(Some(Mistake::ParticleEdgeContactClamped)));
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut capture = Capture::new(&scene.collision);
    let each = step_work(scene);
    let is_iterative = scene.integrator == Integrator::ImplicitEuler;
    for _ in 0..scene.step_count() {
        let before = simulation.state().clone();
        if work.get() > MAX_WORK || simulation.step(&mut capture).is_err() {
            return MistakeEffect::Hidden;
        }
        let expected = &capture.records.end.polynomials;
        work.set(work.get() + each + expected.len() as u64);
        let guard = |index: usize, coefficients: &[f64]| {
            work.set(work.get() + 1);
            index < expected.len() && polynomial_matches(coefficients, expected.get(index), &CLEAR_TOLERANCE)
        };
        let find_step_effect = |world: &World| {
            let records = resimulate(world, &before, &mut StepLog { guard: Some(&guard), ..StepLog::default() });
            let has_result = !is_iterative || records.as_ref().is_some_and(StepRecords::is_finite);
            match records {
                _ if !has_result => MistakeEffect::NoResult,
                Some(records) if find_first_difference(&capture.records, &records, &CLEAR_TOLERANCE).is_none() => {
                    MistakeEffect::Hidden
                }
                _ => MistakeEffect::Visible,
            }
        };
        let effect = find_step_effect(&world);
        if effect != MistakeEffect::Hidden && find_step_effect(&accepted) == MistakeEffect::Hidden {
            return effect;
        }
    }
    MistakeEffect::Hidden
}
