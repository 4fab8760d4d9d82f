//! Finds a record that a program leaves out in every step. Each later record then takes the place of another one, so
//! every step looks wrong.
use super::{resimulate::resimulate, row_explanation};
use crate::diagnose::{
    Explanation,
    sampling::{LoggedNumbers, ROUND_OFF, Scan, StepRecords, find_first_difference},
};
use fosssim_model::{scene::Scene, sim::State, trace::Layout};
use fosssim_student::{Mistake, Row, StepLog, Student, World, find};

/// Returns the explanation that this program leaves out a record, if the beginning of the trace is right once the
/// missing record is taken into account.
pub(super) fn find_missing_record(scene: &Scene, scan: &Scan) -> Option<Explanation> {
    let layout = Layout::for_scene(scene);
    ["log-no-initial", "log-no-mid"].into_iter().filter_map(find).find_map(|row| {
        let expected = count_records_without(layout, row);
        if scan.outline.records.is_some_and(|records| records > expected) {
            return None;
        }
        let steps = count_aligned_steps(scene, layout, &scan.outline.opening, row)?;
        // If nothing moves in a scene, every record is right, so only the number of records counts.
        let is_evidence = !scan.wrong_steps.is_empty() || scan.outline.records == Some(expected);
        is_evidence.then(|| row_explanation(row, (steps, steps)))
    })
}

/// Returns the number of records that a trace has without the record of `row`.
fn count_records_without(layout: Layout, row: &Row) -> u64 {
    match row.mistake {
        Mistake::LogNoInitial => layout.records() - 1,
        _ => 1 + u64::from(layout.steps),
    }
}

/// Returns the number of right steps in the opening if the records are read without the missing one. Returns `None` if
/// one of these steps is wrong, or if there are none.
fn count_aligned_steps(scene: &Scene, layout: Layout, opening: &[LoggedNumbers], row: &Row) -> Option<u64> {
    let world = World::new(scene.clone(), Student::default());
    let initial = world.initial_state();
    let mut before = State { positions: initial.x, velocities: initial.v };
    let no_mid = row.mistake == Mistake::LogNoMid;
    let mut frames = opening.iter();
    if no_mid {
        if !layout.has_polynomials {
            return None;
        }
        before = frames.next()?.state.clone();
    }
    let per_step = if layout.has_polynomials && !no_mid { 2 } else { 1 };
    let mut steps = 0;
    while frames.len() >= per_step && steps < u64::from(layout.steps) {
        let mid = if per_step == 2 { frames.next().cloned() } else { None };
        let end = frames.next()?.clone();
        let guard = |index: usize, _: &[f64]| index < end.polynomials.len();
        let mut expected = resimulate(&world, &before, &mut StepLog { guard: Some(&guard), ..StepLog::default() })?;
        if no_mid {
            expected.mid = None;
        }
        before = end.state.clone();
        if find_first_difference(&expected, &StepRecords { mid, end }, &ROUND_OFF).is_some() {
            return None;
        }
        steps += 1;
    }
    (steps > 0).then_some(steps)
}
