//! The option `suite check --mistakes`, which finds the known mistakes that no scene of a suite shows.
use crate::{
    diagnose::{is_written_by_student, may_change_trace},
    scene::Scene,
    student::{self, Area, Row, RowKind, Student, all_rows},
    suite::plan::Plan,
    trace::Layout,
};
use rayon::prelude::*;

/// The number of polynomials in a step from which a program counts as endless.
const MAX_POLYNOMIALS: usize = 1 << 20;

/// The maximum number of particles in a scene that is used. Larger scenes exist only for timing.
const MAX_PARTICLES: usize = 2_000;

/// An area of the assignment, and which of its mistakes the scenes show.
#[derive(Debug)]
pub(super) struct VisibleMistakes {
    /// The area of the assignment.
    pub(super) area: Area,
    /// The number of mistakes in the area that a scene of the suite could show.
    pub(super) mistake_count: usize,
    /// The mistakes that no scene shows: on every scene, the sample program writes the same trace with and without the
    /// mistake.
    pub(super) invisible_mistakes: Vec<&'static str>,
    /// The mistakes that fewer than [`MAX_LISTED_SCENES`] scenes show. A small change of one scene could hide them.
    pub(super) rarely_visible: Vec<&'static str>,
}

/// The maximum number of scenes that are counted for a mistake. That number of scenes shows the mistake reliably.
pub(super) const MAX_LISTED_SCENES: usize = 3;

/// Returns for each area of the assignment which of its mistakes the plan's scenes show. The areas are in the order of
/// the catalog.
pub(super) fn find_visible_mistakes(plan: &Plan) -> Vec<VisibleMistakes> {
    let written = |scene: &Scene, student: Student| {
        student::record_limited_trace(scene, student, MAX_POLYNOMIALS).unwrap_or_else(|(bytes, _)| bytes)
    };
    let mut scenes: Vec<&Scene> = plan.scenes().map(|task| &task.scene).collect();
    scenes.retain(|scene| scene.particles.len() <= MAX_PARTICLES);
    // Small scenes are tried first, because most mistakes already show in these.
    scenes.sort_by_key(|scene| u64::from(scene.step_count()) * (scene.particles.len() as u64).pow(2));
    let right: Vec<Vec<u8>> = scenes.par_iter().map(|scene| written(scene, Student::default())).collect();
    let is_from_students = |row: &&Row| scenes.iter().any(|scene| is_written_by_student(row, scene.assignment()));
    let rows: Vec<_> = all_rows().filter(|row| row.kind == RowKind::Wrong).filter(is_from_students).collect();
    let logs_polynomials = scenes.iter().any(|scene| Layout::for_scene(scene).has_polynomials);
    // Most mistakes in writing a trace concern lists. Traces that contain only states have no lists.
    let concerns = |row: &Row| {
        (logs_polynomials || row.area != Area::Trace) && scenes.iter().any(|scene| may_change_trace(scene, row))
    };
    let scene_count: Vec<usize> = rows
        .par_iter()
        .map(|row| {
            let student = Student::new(Some(row.mistake));
            let showing = scenes.iter().zip(&right).filter(|(scene, right)| written(scene, student) != **right);
            showing.take(MAX_LISTED_SCENES).count()
        })
        .collect();
    let mut parts: Vec<VisibleMistakes> = Vec::new();
    for (row, scene_count) in rows.iter().zip(scene_count) {
        if scene_count == 0 && !concerns(row) {
            continue;
        }
        let index = parts.iter().position(|part| part.area == row.area).unwrap_or_else(|| {
            parts.push(VisibleMistakes {
                area: row.area,
                mistake_count: 0,
                invisible_mistakes: Vec::new(),
                rarely_visible: Vec::new(),
            });
            parts.len() - 1
        });
        parts[index].mistake_count += 1;
        match scene_count {
            0 => parts[index].invisible_mistakes.push(row.id),
            MAX_LISTED_SCENES.. => {}
            _ => parts[index].rarely_visible.push(row.id),
        }
    }
    parts
}
