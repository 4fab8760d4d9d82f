//! Distributes the scenes of submissions among jobs, and reports progress.
//!
//! Reports and progress displays receive events. Events arrive on the caller's thread, one at a time. A result is
//! stored before its event is sent. The module [`grader`](super::grader) contains the single steps of a grading.
use super::{
    cancellation::Cancellation,
    grade::Grade,
    grader::{Grader, SceneEvent, SharedGrading, Submission, SubmissionGrading},
    guard::{CaughtPanic, catch_panic},
    results::{Results, StoreError},
    task::SceneTask,
    temporary_folders,
};
use std::sync::{
    atomic::{AtomicUsize, Ordering},
    mpsc,
};

/// An event that reports the progress of a grading.
#[derive(Debug)]
pub enum Event<'a> {
    /// A run of a scene begins.
    SceneBegins {
        /// The index of the submission.
        submission: usize,
        /// The index of the scene in the plan.
        scene: usize,
    },
    /// A running scene has been judged up to a step. This is not reported for every step.
    Step {
        /// The index of the submission.
        submission: usize,
        /// The index of the scene in the plan.
        scene: usize,
        /// The last step that has been judged.
        step: u32,
    },
    /// A scene has its verdict.
    SceneDone {
        /// The index of the submission.
        submission: usize,
        /// The index of the scene in the plan.
        scene: usize,
        /// Whether the verdict was reused from an earlier grading.
        is_reused: bool,
    },
    /// A submission has its grade.
    GradeDone {
        /// The index of the submission.
        submission: usize,
        /// The submission's grade.
        grade: &'a Grade,
    },
}

/// The grades of several submissions, and an error that belongs to no scene, if there was one.
#[derive(Debug)]
pub struct BatchResult {
    /// The grades, in the order of the submissions.
    pub grades: Vec<Grade>,
    /// An error of the grader or the machine that belongs to no scene, if there was one.
    pub fault: Option<GradeFault>,
}

/// An error that belongs to no scene's result. The grader or the machine caused it.
#[derive(Debug, thiserror::Error)]
pub enum GradeFault {
    /// Results could not be stored, for example because the disk is full. The grading was stopped.
    #[error(transparent)]
    Storing(#[from] StoreError),
    /// An event could not be reported. The grading continued.
    #[error("reporting the progress of grading failed: {0}; please report this")]
    Reporting(CaughtPanic),
}

/// Grades all submissions, and returns the grades in the same order. If the grading is canceled, the scenes that were
/// not run are marked in the grades. Without `results`, nothing is reused or stored.
pub fn grade_all(
    grader: &Grader<'_>,
    submissions: &[Submission],
    results: Option<&dyn Results>,
    cancellation: &Cancellation,
    on_event: &mut dyn FnMut(Event<'_>),
) -> BatchResult {
    temporary_folders::remove_abandoned();
    let shared = SharedGrading::new(grader, results, cancellation);
    let gradings: Vec<SubmissionGrading<'_>> =
        submissions.iter().map(|submission| SubmissionGrading::new(grader, &shared, submission)).collect();
    let mut first_panic = None;
    let mut report = |event: Event<'_>| {
        if let Err(panic) = catch_panic(|| on_event(event)) {
            first_panic.get_or_insert(panic);
        }
    };
    let mut grades = distribute(grader, &gradings, &mut report);
    Grade::record_same_programs(&mut grades);
    drop(gradings);
    // The sweep is repeated, because processes of killed graders may have ended after the first sweep.
    temporary_folders::remove_abandoned();
    let fault = shared.storage_error.into_inner().map(GradeFault::Storing).or(first_panic.map(GradeFault::Reporting));
    BatchResult { grades, fault }
}

/// Starts the jobs, each of which grades one scene after the other. The job that completes a submission also makes its
/// grade. This thread receives all events.
fn distribute(grader: &Grader<'_>, gradings: &[SubmissionGrading<'_>], tell: &mut dyn FnMut(Event<'_>)) -> Vec<Grade> {
    let scenes: Vec<&SceneTask> = grader.plan.scenes().collect();
    let task_count = gradings.len() * scenes.len();
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    let mut grades: Vec<Option<Grade>> = gradings.iter().map(|_| None).collect();
    std::thread::scope(|scope| {
        for _ in 0..grader.options.jobs.clamp(1, task_count.max(1)) {
            let (sender, next, scenes) = (sender.clone(), &next, &scenes);
            scope.spawn(move || {
                loop {
                    let task = next.fetch_add(1, Ordering::Relaxed);
                    if task >= task_count {
                        return;
                    }
                    let (submission, scene) = (task / scenes.len(), task % scenes.len());
                    let mut send = |news| drop(sender.send((submission, scene, news)));
                    gradings[submission].grade_scene(scene, scenes[scene], &mut send);
                }
            });
        }
        drop(sender);
        for (submission, scene, news) in receiver {
            match news {
                SceneEvent::Begins => tell(Event::SceneBegins { submission, scene }),
                SceneEvent::Step(step) => tell(Event::Step { submission, scene, step }),
                SceneEvent::Done(cached) => tell(Event::SceneDone { submission, scene, is_reused: cached }),
                SceneEvent::Graded(grade) => {
                    tell(Event::GradeDone { submission, grade: &grade });
                    grades[submission] = Some(*grade);
                }
            }
        }
    });
    grades.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests;
