use super::*;
use crate::{
    batch::{BatchResult, Event, GradeFault, grade_all},
    cards::JudgedTrace,
    fake_programs::{TestGrading, small_plan},
    grade::Grade,
    result::Measurements,
    results::FolderResults,
};
use std::collections::BTreeMap;

/// Results that exist only as long as the grader.
#[derive(Default)]
struct MemoryResults {
    kept: Mutex<BTreeMap<ResultKey, SceneResult>>,
    /// The maximum number of keys, or `None` for no limit. Later results cannot be stored, as on a full disk.
    room: Option<usize>,
}

impl MemoryResults {
    fn len(&self) -> usize {
        lock(&self.kept).len()
    }
}

impl Results for MemoryResults {
    fn find(&self, key: &ResultKey) -> Option<SceneResult> {
        lock(&self.kept).get(key).cloned()
    }

    fn store(&self, key: &ResultKey, _: &str, result: &SceneResult) -> Result<(), StoreError> {
        let mut kept = lock(&self.kept);
        if !kept.contains_key(key) && self.room.is_some_and(|room| kept.len() >= room) {
            return Err(StoreError(format!("there is room for {} results only", kept.len())));
        }
        kept.insert(key.clone(), result.clone());
        Ok(())
    }
}

fn grade(
    grader: &Grader<'_>,
    submission: &Submission,
    results: &dyn Results,
) -> (Grade, Option<GradeFault>, Vec<String>) {
    let mut told = Vec::new();
    let submission = std::slice::from_ref(submission);
    let BatchResult { grades, fault } =
        grade_all(grader, submission, Some(results), &Cancellation::default(), &mut |event| {
            if let Event::SceneDone { submission: 0, scene, is_reused: cached } = event {
                told.push(format!("{scene} {cached}"));
            }
        });
    (grades.into_iter().next().expect("a grade"), fault, told)
}

/// Returns the content of a grade, without the time of judging and whether its results were already stored.
fn says(grade: &Grade) -> (Verdict, Option<f64>, Vec<SceneResult>) {
    let timeless = |result: &SceneResult| SceneResult {
        measured: Measurements { judging: Duration::ZERO, ..result.measured },
        ..result.clone()
    };
    (grade.verdict, grade.points, grade.scenes().map(|scene| timeless(&scene.result)).collect())
}

#[test]
fn a_submission_is_graded_the_same_wherever_its_results_are_kept_and_nothing_is_run_twice() {
    let (stage, plan) = (TestGrading::new(), small_plan());
    let scenes = plan.scenes().count();
    let grader = stage.grader(&plan);
    let folder = tempfile::tempdir().expect("folder");
    for name in ["right", "wrong", "half"] {
        let submission = stage.submissions(&[name]).remove(0);
        let before = stage.started_count();
        let memory = MemoryResults::default();
        let (first, fault, told) = grade(&grader, &submission, &memory);
        assert!(fault.is_none() && first.count_reused() == 0);
        assert_eq!((told.len(), memory.len(), stage.started_count() - before), (scenes, scenes, scenes));
        let (again, _, told) = grade(&grader, &submission, &memory);
        assert_eq!((again.count_reused(), stage.started_count() - before), (scenes, scenes), "all of it is found");
        assert!(told.iter().all(|line| line.ends_with("true")));
        let journal = FolderResults::open(folder.path(), false).expect("a journal");
        let (on_disk, _, _) = grade(&grader, &submission, &journal);
        drop(journal);
        let read = FolderResults::open(folder.path(), false).expect("a journal");
        let (from_disk, _, _) = grade(&grader, &submission, &read);
        assert_eq!((on_disk.count_reused(), from_disk.count_reused()), (0, scenes));
        for other in [&again, &on_disk, &from_disk] {
            assert_eq!(says(other), says(&first), "{name}");
        }
    }
}

#[test]
fn grading_stops_if_results_cannot_be_stored() {
    let (stage, plan) = (TestGrading::new(), small_plan());
    let mut grader = stage.grader(&plan);
    grader.options.jobs = 1;
    let submission = stage.submissions(&["right"]).remove(0);
    let small = MemoryResults { room: Some(3), ..MemoryResults::default() };
    let (stopped, fault, told) = grade(&grader, &submission, &small);
    assert!(matches!(&fault, Some(GradeFault::Storing(error)) if error.to_string().contains("room")), "{fault:?}");
    assert_eq!((stopped.points, stopped.is_incomplete(), stopped.verdict), (None, true, Verdict::NotRun));
    assert_eq!((small.len(), stage.started_count()), (3, 4), "the fourth result was one too many");
    assert_eq!(told.len(), plan.scenes().count(), "every scene is told of all the same");
    // After a teacher has freed space, the grading continues.
    let (resumed, _, _) = grade(&grader, &submission, &small);
    assert_eq!((resumed.count_reused(), stage.started_count()), (3, 5));
}

#[test]
fn a_panic_on_one_scene_is_its_judge_error_and_is_tried_again() {
    let (stage, plan) = (TestGrading::new(), small_plan());
    let scenes = plan.scenes().count();
    let troubled = plan.scenes().nth(2).expect("a scene").name.clone();
    let submission = stage.submissions(&["wrong"]).remove(0);
    let memory = MemoryResults::default();
    let draw = |judged: &JudgedTrace<'_>| {
        assert!(!judged.name.ends_with(&troubled), "no picture of this");
        None
    };
    let folder = FilePlace::new("", "cards");
    let cards = Some(Cards { folder: &folder, draw: &draw, for_students: false });
    let grader = Grader { cards, ..stage.grader(&plan) };
    let (failed, fault, _) = grade(&grader, &submission, &memory);
    assert!(fault.is_none());
    let errors: Vec<_> = failed.scenes().filter(|scene| scene.verdict == Verdict::JudgeError).collect();
    assert_eq!(errors.iter().map(|scene| scene.scene.as_str()).collect::<Vec<_>>(), [troubled.as_str()]);
    assert_eq!((failed.points, memory.len()), (None, scenes - 1), "nobody's zero, and not kept");
    let (mended, _, _) = grade(&stage.grader(&plan), &submission, &memory);
    assert_eq!((mended.verdict, mended.count_reused()), (Verdict::WrongAnswer, scenes - 1));
}

/// A result store that panics.
struct Panics;

impl Results for Panics {
    fn find(&self, _: &ResultKey) -> Option<SceneResult> {
        None
    }

    fn store(&self, _: &ResultKey, _: &str, _: &SceneResult) -> Result<(), StoreError> {
        panic!("no place")
    }
}

#[test]
fn a_place_that_panics_is_a_fault_and_no_end() {
    let (stage, plan) = (TestGrading::new(), small_plan());
    let submission = stage.submissions(&["right"]).remove(0);
    let (stopped, fault, _) = grade(&stage.grader(&plan), &submission, &Panics);
    assert!(matches!(&fault, Some(GradeFault::Storing(error)) if error.to_string().contains("no place")), "{fault:?}");
    assert!(stopped.is_incomplete());
}
