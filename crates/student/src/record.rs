//! The contents of one record: a state and its log as written by a program, before they are encoded (trace-format.md).

use super::{
    Area, Mistake,
    author::Student,
    logged_polynomials::logged_polynomial,
    objects::{Contact, State},
    rounding::round_to_f32,
    step::step,
    step_failure::StepFailure,
    world::{StepLog, World},
};
use fosssim_model::scene::{Collision, Scene};
use fosssim_num::vector::Vec2;

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Trace];

/// The numbers of one record, with this student's mistakes in logging. A list is `None` if scenes of this collision
/// type do not have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The positions of all particles.
    pub x: Vec<f64>,
    /// The velocities of all particles.
    pub v: Vec<f64>,
    /// The impulse list.
    pub impulses: Option<Vec<Contact>>,
    /// The polynomial list, normally with the highest power first.
    pub polynomials: Option<Vec<Vec<f64>>>,
}

impl Record {
    /// Creates the record that a student writes in a scene of this collision type.
    pub fn new(student: Student, collision: &Collision, state: &State, log: &StepLog) -> Self {
        let has_polynomials = matches!(collision, Collision::ContinuousTime { .. } | Collision::Hybrid { .. });
        let has_impulses = has_polynomials || matches!(collision, Collision::Simple { .. });
        Self {
            x: logged_numbers(student, &state.x),
            v: logged_numbers(student, &state.v),
            impulses: has_impulses.then(|| logged_impulses(student, &log.impulses)),
            polynomials: has_polynomials.then(|| {
                (0..log.polynomials.len()).map(|index| logged_polynomial(student, log, index).into()).collect()
            }),
        }
    }

    /// Appends the record's bytes (trace-format.md 3).
    pub fn encode(&self, bytes: &mut Vec<u8>) {
        self.x.iter().chain(&self.v).for_each(|value| bytes.extend(value.to_le_bytes()));
        if let Some(impulses) = &self.impulses {
            bytes.extend(to_i32(impulses.len()).to_le_bytes());
            for impulse in impulses {
                let (kind, second) = impulse.pair.object.numbers();
                for value in [kind, impulse.pair.particle, second] {
                    bytes.extend(to_i32(value).to_le_bytes());
                }
                for value in [impulse.n.x, impulse.n.y, impulse.time] {
                    bytes.extend(value.to_le_bytes());
                }
            }
        }
        if let Some(polynomials) = &self.polynomials {
            bytes.extend(to_i32(polynomials.len()).to_le_bytes());
            for coefficients in polynomials {
                bytes.extend(to_i32(coefficients.len()).to_le_bytes());
                coefficients.iter().for_each(|coefficient| bytes.extend(coefficient.to_le_bytes()));
            }
        }
    }
}

/// Runs this student's program on `scene` and returns its trace.
///
/// # Errors
/// Returns the bytes written before the failure, and the failure.
pub fn record_trace(scene: &Scene, student: Student) -> Result<Vec<u8>, (Vec<u8>, StepFailure)> {
    write_trace(scene, student, StepLog::default())
}

/// Returns a trace like [`record_trace`], but a step with more than `max_polynomials` polynomials fails. Without this
/// limit, the program may run forever.
///
/// # Errors
/// Returns the bytes written before the failure, and the failure.
pub fn record_limited_trace(
    scene: &Scene,
    student: Student,
    max_polynomials: usize,
) -> Result<Vec<u8>, (Vec<u8>, StepFailure)> {
    let guard = |index: usize, _: &[f64]| index < max_polynomials;
    write_trace(scene, student, StepLog { guard: Some(&guard), ..StepLog::default() })
}

fn write_trace(scene: &Scene, student: Student, mut log: StepLog<'_>) -> Result<Vec<u8>, (Vec<u8>, StepFailure)> {
    let world = World::new(scene.clone(), student);
    let mut state = world.initial_state();
    let mut bytes = Vec::new();
    if !student.makes(Mistake::LogNoInitial) {
        Record::new(student, &scene.collision, &state, &log).encode(&mut bytes);
    }
    for _ in 0..scene.step_count() {
        let stepped = step(&world, &mut state, &mut log, &mut |state, log| {
            Record::new(student, &scene.collision, state, log).encode(&mut bytes);
        });
        if let Err(failure) = stepped {
            return Err((bytes, failure));
        }
    }
    Ok(bytes)
}

fn to_i32(value: usize) -> i32 {
    i32::try_from(value).unwrap_or(i32::MAX)
}

fn logged_numbers(student: Student, values: &[f64]) -> Vec<f64> {
    if student.makes(Mistake::LogSinglePrecision) {
        values.iter().map(|&value| round_to_f32(value)).collect()
    } else {
        values.to_vec()
    }
}

fn logged_impulses(student: Student, impulses: &[Contact]) -> Vec<Contact> {
    let mut listed: Vec<Contact> = match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::LogNoImpulses) => Vec::new(),
        Some(Mistake::LogDuplicateImpulses) => impulses.iter().flat_map(|impulse| [*impulse, *impulse]).collect(),
        Some(Mistake::LogImpulsesReversed) => impulses.iter().rev().copied().collect(),
        _ => impulses.to_vec(),
    };
    if student.makes(Mistake::LogNanContacts) {
        listed.iter_mut().for_each(|impulse| impulse.n = Vec2::new(f64::NAN, f64::NAN));
    }
    listed
}
