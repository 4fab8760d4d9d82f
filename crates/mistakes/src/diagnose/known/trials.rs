//! Runs programs with mistakes of the catalog on kept steps.
use super::resimulate::{ApproachForm, resimulate, step_work};
use crate::diagnose::sampling::{
    KeptStep, ROUND_OFF, Reference, StepDifference, Tolerance, find_first_difference, polynomial_matches,
};
use fosssim_model::scene::Scene;
use fosssim_student::{Row, StepLog, Student, World};
use std::cell::Cell;

/// Trials of programs, with a count of the polynomials that they compute. Computing one takes about a third of a
/// microsecond.
pub(super) struct Trials<'a> {
    /// The scene, prepared for programs of all students.
    world: World,
    approach_form: ApproachForm,
    round_off: Tolerance,
    step_work: u64,
    /// The number of polynomials computed so far.
    used_work: Cell<u64>,
    /// The number of polynomials that all trials of an explanation may still compute.
    remaining_work: &'a Cell<u64>,
}

/// A student's program on the scene.
pub(super) struct Program(World);

impl<'a> Trials<'a> {
    /// Creates the trials on a scene; `correct` is the program to which mistakes are added.
    pub(super) fn new(reference: &'a Reference<'_>, scene: &Scene, correct: ApproachForm) -> Self {
        let world = World::new(scene.clone(), Student::default());
        let (round_off, step_work) = (Tolerance::for_scene(scene), step_work(scene));
        Self {
            world,
            approach_form: correct,
            round_off,
            step_work,
            used_work: Cell::new(0),
            remaining_work: &reference.trial_work,
        }
    }

    /// Returns whether more than `max_polynomials` polynomials were computed, or whether no work is left.
    pub(super) fn exceeds_limit(&self, max_polynomials: u64) -> bool {
        self.used_work.get() > max_polynomials || self.remaining_work.get() == 0
    }

    /// Resets the count of polynomials.
    pub(super) fn restart(&self) {
        self.used_work.set(0);
    }

    /// Creates a program with the mistakes of `rows`.
    pub(super) fn program(&self, rows: &[&'static Row]) -> Program {
        let student: Student = rows
            .iter()
            .fold(self.approach_form.with_mistake(None), |student, row| student.with_mistake(Some(row.mistake)));
        Program(self.world.for_student(student))
    }

    /// Returns the part of the logged step that the program reproduces, from 0 to 1. The polynomials count as the first
    /// half of the step.
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    pub(super) fn reproduced_share(&self, program: &Program, kept_step: &KeptStep) -> f64 {
        let logged = &kept_step.records.end.polynomials;
        let (logged_count, failed) = (Cell::new(self.step_work), Cell::new(None));
        let guard = |index: usize, coefficients: &[f64]| {
            logged_count.set(logged_count.get() + 1);
            let goes_on = index < logged.len() && polynomial_matches(coefficients, logged.get(index), &ROUND_OFF);
            if !goes_on && failed.get().is_none() {
                failed.set(Some(index));
            }
            goes_on
        };
        let mut log = StepLog { guard: Some(&guard), ..StepLog::default() };
        let records = resimulate(&program.0, &kept_step.before, &mut log);
        self.used_work.set(self.used_work.get() + logged_count.get() + log.long_searches);
        self.remaining_work.set(self.remaining_work.get().saturating_sub(logged_count.get() + log.long_searches));
        let share = |index: usize| 0.5 * index as f64 / (logged.len() + 1) as f64;
        let Some(records) = records else { return failed.get().map_or(0.0, share) };
        match find_first_difference(&records, &kept_step.records, &self.round_off) {
            None => 1.0,
            Some(StepDifference::Polynomial(index)) => share(index),
            Some(StepDifference::PolynomialCount) => share(records.end.polynomials.len().min(logged.len())),
            Some(StepDifference::MidState(_)) => 0.6,
            Some(StepDifference::Impulses) => 0.7,
            Some(StepDifference::EndState(_)) => 0.8,
            Some(StepDifference::MidLists) => 0.9,
        }
    }
}
