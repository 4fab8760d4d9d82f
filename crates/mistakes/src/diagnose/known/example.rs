//! Finds the first value of a wrong step that differs from the reference's.
use super::resimulate::{ApproachForm, resimulate};
use crate::diagnose::{
    Example, ExamplePlace, StepRecord,
    sampling::{Capture, KeptStep, ROUND_OFF, Reference, StepDifference, impulse_matches},
};
use fosssim_judge::Role;
use fosssim_model::{scene::Scene, sim::State, trace::LoggedImpulse};
use fosssim_num::vector::vector_at;
use fosssim_student::{StepLog, World};

/// Returns the example of a wrong step: the first difference, with the expected and the logged value.
pub(super) fn find_example(
    reference: &mut Reference<'_>,
    scene: &Scene,
    correct: ApproachForm,
    kept_step: &KeptStep,
) -> Example {
    let mut capture = Capture::new(&scene.collision);
    // The step was simulated before, so it does not fail. If it failed, the lists below would be empty.
    let _end = reference.step(kept_step.step, &kept_step.before, &mut capture);
    if correct == ApproachForm::RightApproach {
        let world = World::new(scene.clone(), correct.with_mistake(None));
        capture.records = resimulate(&world, &kept_step.before, &mut StepLog::default()).unwrap_or_default();
    }
    let (ours, theirs) = (&capture.records, &kept_step.records);
    let (place, expected, actual) = match kept_step.difference {
        Some(StepDifference::Polynomial(index)) => {
            let list = |log: &fosssim_model::trace::PolynomialLog| {
                if index < log.len() { log.get(index).to_vec() } else { Vec::new() }
            };
            let place = capture.locate_polynomial(index).map_or(
                ExamplePlace::NumberedPolynomial(index),
                |(pair, pass, number)| ExamplePlace::Polynomial {
                    pair,
                    pass: pass.index,
                    role: Role::from_number(pair.kind, number),
                },
            );
            (place, list(&ours.end.polynomials), list(&theirs.end.polynomials))
        }
        Some(StepDifference::PolynomialCount) => {
            let (ours, theirs) = (ours.end.polynomials.len(), theirs.end.polynomials.len());
            (ExamplePlace::PolynomialCount, count_value(ours), count_value(theirs))
        }
        Some(StepDifference::Impulses) => contact_example(&ours.end.impulses, &theirs.end.impulses),
        Some(StepDifference::MidState(particle)) => match (&ours.mid, &theirs.mid) {
            (Some(ours), Some(theirs)) => state_example(particle, StepRecord::Mid, &ours.state, &theirs.state),
            _ => (ExamplePlace::MidParticle(particle), Vec::new(), Vec::new()),
        },
        Some(StepDifference::EndState(particle)) => {
            state_example(particle, StepRecord::End, &ours.end.state, &theirs.end.state)
        }
        Some(StepDifference::MidLists) | None => (ExamplePlace::MidLists, Vec::new(), Vec::new()),
    };
    Example { step: kept_step.step, place, given: Vec::new(), expected, actual }
}

/// Returns the first different contact, as the reference and the submission log it: the normal's components and the
/// time. A contact that one of them does not log has no numbers.
fn contact_example(ours: &[LoggedImpulse], theirs: &[LoggedImpulse]) -> (ExamplePlace, Vec<f64>, Vec<f64>) {
    let key = |contact: &LoggedImpulse| (contact.kind, contact.first, contact.second);
    let values = |contact: &LoggedImpulse| vec![contact.normal.x, contact.normal.y, contact.time];
    let place = |contact: &LoggedImpulse| ExamplePlace::Contact {
        kind: contact.kind(),
        first: contact.first,
        second: contact.second,
    };
    for contact in ours {
        match theirs.iter().find(|other| key(other) == key(contact)) {
            Some(other) if !impulse_matches(contact, other, &ROUND_OFF) => {
                return (place(contact), values(contact), values(other));
            }
            Some(_) => {}
            None => return (place(contact), values(contact), Vec::new()),
        }
    }
    match theirs.iter().find(|contact| ours.iter().all(|other| key(other) != key(contact))) {
        Some(contact) => (place(contact), Vec::new(), values(contact)),
        None => (ExamplePlace::ContactCount, count_value(ours.len()), count_value(theirs.len())),
    }
}

/// Returns a particle in the states of the reference and the submission, each as four numbers: position and velocity.
fn state_example(
    particle: usize,
    record: StepRecord,
    ours: &State,
    theirs: &State,
) -> (ExamplePlace, Vec<f64>, Vec<f64>) {
    let values = |state: &State| {
        let (x, v) = (vector_at(&state.positions, particle), vector_at(&state.velocities, particle));
        vec![x.x, x.y, v.x, v.y]
    };
    (ExamplePlace::Particle { particle, record }, values(ours), values(theirs))
}

fn count_value(number: usize) -> Vec<f64> {
    #[expect(clippy::cast_precision_loss, reason = "a count of values in memory")]
    let number = number as f64;
    vec![number]
}
