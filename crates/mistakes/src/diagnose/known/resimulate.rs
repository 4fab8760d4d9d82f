//! Simulates steps of a student's program from a submission's own state.
use crate::diagnose::sampling::{LoggedNumbers, StepRecords};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::pairs,
};
use fosssim_student::{Mistake, Record, State, StepLog, Student, World, step};

/// The form of the particle-edge approach that a submission uses. Both forms are accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ApproachForm {
    /// The program uses the particle-edge approach that the course supplies.
    Supplied,
    /// The program uses the mathematically right approach.
    RightApproach,
}

impl ApproachForm {
    /// Returns a program of this form that is correct except for `mistake`.
    pub(super) fn with_mistake(self, mistake: Option<Mistake>) -> Student {
        let student = Student::new(mistake);
        match self {
            Self::Supplied => student,
            Self::RightApproach => student.with_right_approach(),
        }
    }
}

/// Returns the cost of a step without its polynomials, in units of a polynomial. Forces between all pairs are much
/// cheaper than polynomials, and penalty forces check only nearby pairs. Solves of implicit integrators are counted
/// when they happen.
pub(super) fn step_work(scene: &Scene) -> u64 {
    let pair_work = match scene.collision {
        Collision::None => 0,
        Collision::Penalty { .. } => scene.particles.len() + scene.edges.len(),
        _ => pairs(scene).count() / 128,
    };
    10 + (pair_work + scene.forces.len() / 16) as u64
}

/// Returns the records that a program writes in a step from a given state, or `None` if the step fails or writes
/// another number of records.
pub(super) fn resimulate(
    world: &World,
    before: &fosssim_model::sim::State,
    log: &mut StepLog<'_>,
) -> Option<StepRecords> {
    let mut state = State { x: before.positions.clone(), v: before.velocities.clone() };
    let mut records: Vec<LoggedNumbers> = Vec::new();
    step(world, &mut state, log, &mut |state, log| {
        records.push(Record::new(world.student, &world.scene.collision, state, log).into());
    })
    .ok()?;
    let end = records.pop()?;
    let mid = records.pop();
    records.is_empty().then_some(StepRecords { mid, end })
}
