use super::*;
use crate::{
    disclosure::DisclosedFinding,
    failure_cause::FailureKind,
    fake_programs::{SMALL_TRACE, TestGrading, right_trace, small_plan},
    grader::Options,
    plan::{self, Plan},
    result::{Activity, BadTrace, Failure, NotRunReason, Reason, SavedTrace, SceneResult, WrongTrace},
    results::FolderResults,
    verdict::Verdict,
};
use fosssim_judge::{FindingDetail, Rules, fair::Cause};
use fosssim_mistakes::together::disclosed_grade;
use fosssim_sandbox::Job;
use std::{path::Path, time::Duration};

/// Returns the step and particle of a wrong position that is the first difference.
fn first_divergence(result: &SceneResult) -> (u32, usize) {
    let told = result.disclosure.as_ref().expect("full hints");
    match &told.official().first_divergence {
        Some(DisclosedFinding::Full(finding)) => match finding.detail {
            FindingDetail::Position { particle, .. } => (finding.step, particle),
            other => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    }
}

fn journal(folder: &tempfile::TempDir) -> FolderResults {
    FolderResults::open(folder.path(), false).expect("a journal")
}

#[test]
fn a_right_program_gets_every_point_and_the_others_their_verdicts() {
    let stage = TestGrading::new();
    let names =
        ["right", "wrong", "crash-after-right-trace", "exit-1-after-right-trace", "nothing", "half", "slow", "hostile"];
    let grades = stage.grade(&names);
    let verdicts: Vec<_> = grades.iter().map(|grade| (grade.submission.as_str(), grade.verdict)).collect();
    assert_eq!(
        verdicts,
        [
            ("right", Verdict::Accepted),
            ("wrong", Verdict::WrongAnswer),
            ("crash-after-right-trace", Verdict::RuntimeError),
            ("exit-1-after-right-trace", Verdict::RuntimeError),
            ("nothing", Verdict::NoOutput),
            ("half", Verdict::BadTrace),
            ("slow", Verdict::TimeLimit),
            ("hostile", Verdict::Violation),
        ]
    );
    assert_eq!((grades[0].points, grades[0].max_points), (Some(15.0), 15.0));
    assert!(grades[1..].iter().all(|grade| grade.points == Some(0.0)));
    let wrong = grades[1].scenes().next().expect("a scene");
    assert_eq!(wrong.right_steps, wrong.steps - 1);
    assert_eq!(first_divergence(wrong), (1, 0), "{wrong:?}");
}

#[test]
fn an_interrupted_grading_has_no_points_and_goes_on_where_it_stopped_and_ends_the_same() {
    let stage = TestGrading::new();
    let (plan, names) = (small_plan(), ["right", "wrong", "half", "slow"]);
    let submissions = stage.submissions(&names);
    let results = tempfile::tempdir().expect("folder");
    for stop_after in [3, 9] {
        let (cancellation, mut done) = (Cancellation::default(), 0);
        let mut on_event = |event: Event<'_>| {
            if let Event::SceneDone { is_reused: false, .. } = event {
                done += 1;
                if done == stop_after {
                    cancellation.cancel();
                }
            }
        };
        let stopped =
            grade_all(&stage.grader(&plan), &submissions, Some(&journal(&results)), &cancellation, &mut on_event)
                .grades;
        assert!(stopped.iter().any(Grade::is_incomplete), "it stopped before the end");
        for grade in stopped {
            assert_eq!(grade.points.is_none(), grade.is_incomplete(), "what is missing is no zero: {grade:?}");
        }
    }
    let never = Cancellation::default();
    let resumed = grade_all(&stage.grader(&plan), &submissions, Some(&journal(&results)), &never, &mut |_| {}).grades;
    let mut starts = stage.starts.lock().expect("lock").clone();
    let runs = starts.len();
    starts.sort();
    starts.dedup();
    assert_eq!(starts.len(), runs, "nothing was run twice");
    let uninterrupted = stage.grade(&names);
    for (resumed, whole) in resumed.iter().zip(&uninterrupted) {
        assert_eq!((resumed.verdict, resumed.points), (whole.verdict, whole.points));
        for (resumed, whole) in resumed.scenes().zip(whole.scenes()) {
            assert_eq!((resumed.verdict, &resumed.reason), (whole.verdict, &whole.reason));
        }
    }
}

#[test]
fn equal_programs_of_a_class_are_run_once_and_shown_to_staff_alone() {
    for jobs in [1, 2, 8] {
        let stage = TestGrading::new();
        let (plan, never) = (small_plan(), Cancellation::default());
        let submissions: Vec<Submission> = [("ada", "wrong"), ("bob", "wrong"), ("eve", "half")]
            .into_iter()
            .map(|(name, program)| {
                let path = stage.folder.path().join(name);
                std::fs::create_dir(&path).expect("a folder");
                std::fs::write(path.join(program), program).expect("a program");
                Submission { name: name.to_owned(), path, program: Some(program.to_owned()), file: None }
            })
            .collect();
        let mut grader = stage.grader(&plan);
        grader.options.jobs = jobs;
        let results = tempfile::tempdir().expect("folder");
        let grade = || grade_all(&grader, &submissions, Some(&journal(&results)), &never, &mut |_| {}).grades;
        let grades = grade();
        assert_eq!(stage.started_count(), 2 * plan.scenes().count(), "{jobs} jobs");
        assert!(grades.iter().all(|grade| grade.count_reused() == 0), "nothing is from an earlier run");
        assert!(grades[0].scenes().map(|scene| &scene.result).eq(grades[1].scenes().map(|scene| &scene.result)));
        for grades in [&grades, &grade()] {
            let same: Vec<_> = grades.iter().map(|grade| grade.same_program.as_slice()).collect();
            assert_eq!(same, [&["bob".to_owned()][..], &["ada".to_owned()], &[]]);
            assert!(grades.iter().all(|grade| disclosed_grade(grade).same_program.is_empty()));
        }
    }
}

#[test]
fn a_changed_program_is_graded_again() {
    let stage = TestGrading::new();
    let (plan, never) = (small_plan(), Cancellation::default());
    let results = tempfile::tempdir().expect("folder");
    let grade = |submissions: &[Submission]| {
        grade_all(&stage.grader(&plan), submissions, Some(&journal(&results)), &never, &mut |_| {}).grades
    };
    let submissions = stage.submissions(&["right"]);
    assert!(grade(&submissions)[0].scenes().all(|scene| !scene.cached));
    assert!(grade(&submissions)[0].scenes().all(|scene| scene.cached));
    std::fs::write(&submissions[0].path, "another build").expect("changed");
    assert!(grade(&submissions)[0].scenes().all(|scene| !scene.cached));
}

#[test]
fn the_official_book_gives_verdict_and_points_and_results_are_not_mixed_up() {
    let stage = TestGrading::new();
    let submissions = stage.submissions(&["trailing"]);
    let results = tempfile::tempdir().expect("folder");
    let grade = |rules: Rules, recorded: bool| {
        let (plan, never) = (Plan { rules, ..small_plan() }, Cancellation::default());
        let mut grader = stage.grader(&plan);
        grader.options.uses_recordings = recorded;
        grade_all(&grader, &submissions, Some(&journal(&results)), &never, &mut |_| {}).grades.remove(0)
    };
    let both = grade(Rules::Both, false);
    assert_eq!((both.verdict, both.points), (Verdict::Accepted, Some(15.0)));
    assert!(both.scenes().all(|scene| scene.difference_cause == Some(Cause::TrailingBytes)), "{both:?}");
    let fair = grade(Rules::Fair, false);
    assert_eq!((fair.verdict, fair.points), (Verdict::BadTrace, Some(0.0)));
    let trailing = Reason::Trace(BadTrace::TrailingBytes);
    assert!(fair.scenes().all(|scene| !scene.cached && scene.reason == trailing));
    let parity = grade(Rules::Parity, false);
    assert_eq!((parity.verdict, parity.count_differing()), (Verdict::Accepted, 0));
    // The stored results are the same, and recordings have only a parity verdict.
    let again = grade(Rules::Both, false);
    assert!(again.scenes().all(|scene| scene.cached && scene.difference_cause == Some(Cause::TrailingBytes)));
    assert_eq!(grade(Rules::Both, true).rules, Rules::Parity);
}

#[test]
fn a_fault_of_the_grader_is_a_judge_error_of_its_scene_and_the_batch_goes_on() {
    let stage = TestGrading::new();
    let (plan, never) = (small_plan(), Cancellation::default());
    let names = ["fault-while-judging", "fault-while-explaining", "right"];
    let submissions = stage.submissions(&names);
    let grader = stage.grader(&plan);
    let results = tempfile::tempdir().expect("folder");
    let graded = grade_all(&grader, &submissions, Some(&journal(&results)), &never, &mut |_| {});
    assert!(graded.fault.is_none() && graded.grades.len() == names.len());
    for (grade, stage) in graded.grades.iter().zip([Some(Activity::Judging), Some(Activity::Explaining), None]) {
        let Some(stage) = stage else {
            assert_eq!(grade.verdict, Verdict::Accepted);
            continue;
        };
        assert_eq!((grade.verdict, grade.points), (Verdict::JudgeError, None), "nobody's zero: {grade:?}");
        for (number, scene) in grade.scenes().enumerate() {
            assert_eq!(scene.verdict, Verdict::JudgeError);
            let Reason::Failed(Failure::Panic { stage: Some(doing), fault, trace: Some(SavedTrace::In(path)) }) =
                &scene.reason
            else {
                panic!("{scene:?}")
            };
            assert!(*doing == stage && fault.contains(".rs:"), "{scene:?}");
            let trace = std::fs::read(path).expect("the trace");
            let xml = &plan.scenes().nth(number).expect("a scene").xml;
            let folder = tempfile::tempdir().expect("folder");
            std::fs::write(folder.path().join("scene.xml"), xml).expect("the scene");
            assert_eq!(trace, right_trace(&Job::new("right", folder.path())));
        }
    }
}

#[test]
fn a_failing_display_is_reported_and_changes_no_grade() {
    let stage = TestGrading::new();
    let (plan, never) = (small_plan(), Cancellation::default());
    let mut told = 0;
    let graded = grade_all(&stage.grader(&plan), &stage.submissions(&["right", "wrong"]), None, &never, &mut |event| {
        told += 1;
        assert!(!matches!(event, Event::SceneDone { .. }), "no display");
    });
    assert_eq!(graded.grades.len(), 2);
    assert!(told > 2 * plan.scenes().count(), "it hears of everything all the same");
    assert!(graded.fault.expect("a fault").to_string().contains("no display"));
}

#[test]
fn after_some_time_outs_in_a_row_the_rest_is_not_run() {
    let scenes = small_plan().scenes().count();
    assert!(scenes > 6);
    for (jobs, time_outs) in [(1, 3), (4, 3), (1, 1), (1, 0)] {
        let stage = TestGrading::new();
        let mut plan = small_plan();
        plan.skip_limits.time_outs = time_outs;
        let never = Cancellation::default();
        let mut grader = stage.grader(&plan);
        grader.options.jobs = jobs;
        let grades = grade_all(&grader, &stage.submissions(&["slow", "right"]), None, &never, &mut |_| {}).grades;
        let expected = if time_outs == 0 { scenes } else { time_outs as usize };
        // Parallel jobs may have started other scenes in the meantime.
        let began = stage.started_count() - scenes;
        assert!(began == expected || jobs > 1 && began > expected, "{began} of {expected} with {jobs} jobs");
        assert_eq!((grades[0].verdict, grades[0].points), (Verdict::TimeLimit, Some(0.0)));
        assert_eq!(grades[1].points, Some(15.0), "the next submission is not held up");
        let left_out = grades[0].scenes().filter(|scene| matches!(scene.reason, Reason::Skipped(_))).count();
        assert_eq!(left_out, scenes - expected, "whatever the jobs");
    }
}

/// The reference's runs show what the scenes in which a program crashes have in common.
#[test]
fn a_crash_in_the_failsafe_is_located() {
    let stage = TestGrading::new();
    let suite = |hints: &str| {
        let text = format!(
            "schema = 1\nname = \"test\"\nhints = \"{hints}\"\n[[group]]\nname = \"all\"\nscenes = \
             [\"asset:ImpulsesTests/*\", \"asset:GeometricTests/*\"]\n"
        );
        plan::load_suite(&text, Path::new("nowhere")).expect("a sound suite")
    };
    let mut grades = stage.grade_with(&suite("what"), &["crashes-in-the-failsafe"]);
    let grade = grades.remove(0);
    let located = grade.located_failure.as_ref().expect("a place");
    let crashed: Vec<_> = grade.scenes().filter(|scene| scene.verdict == Verdict::RuntimeError).collect();
    let others = grade.scenes().count() - crashed.len();
    assert_eq!(
        (located.failed_scenes, located.scenes_with_features, located.scenes_without_features),
        (crashed.len(), crashed.len(), others),
        "{located:?}"
    );
    assert_eq!(
        (located.failure, located.features[0].family.as_ref()),
        (FailureKind::Crash, "the failsafe moves a zone")
    );
    let Reason::Program(reached) = crashed[0].reason else { panic!("{:?}", crashed[0].reason) };
    assert_eq!((&located.first_scene, located.step), (&crashed[0].scene, reached.steps));
    let silent = stage.grade_with(&suite("where"), &["crashes-in-the-failsafe"]).remove(0);
    assert!(
        silent.located_failure.is_some() && disclosed_grade(&grade).located_failure.is_some(),
        "staff see everything"
    );
    assert_eq!(disclosed_grade(&silent).located_failure, None, "hints tell students less");
    assert_eq!(stage.grade_with(&suite("what"), &["right"]).remove(0).located_failure, None);
}

#[test]
fn stages_that_log_nothing_are_not_written_yet() {
    let stage = TestGrading::new();
    let text = "schema = 1\nname = \"test\"\n[[group]]\nname = \"all\"\ncredit = \"steps\"\nscenes = \
                [\"asset:ContinuousTimeTests/*\", \"asset:ImpulsesTests/o*\"]\n";
    let plan = plan::load_suite(text, Path::new("nowhere")).expect("a sound suite");
    let grades = stage.grade_with(&plan, &["unwritten", "nothing", "half"]);
    let verdicts: Vec<_> = grades.iter().map(|grade| grade.verdict).collect();
    assert_eq!(verdicts, [Verdict::Unwritten, Verdict::NoOutput, Verdict::BadTrace], "of the one all scenes say so");
    assert_eq!((grades[0].points, grades[0].submission_fault().is_some()), (Some(0.0), true));
    assert!(grades[0].scenes().all(|scene| scene.reason == Reason::Wrong(WrongTrace::Nothing)));
}

#[test]
fn a_submission_has_only_so_much_time() {
    let stage = TestGrading::new();
    let mut plan = small_plan();
    plan.skip_limits.total = Duration::from_secs(25);
    let grade = stage.grade_with(&plan, &["lengthy"]).remove(0);
    let verdicts: Vec<_> = grade.scenes().map(|scene| scene.verdict).collect();
    assert_eq!(verdicts[..4], [Verdict::Accepted, Verdict::Accepted, Verdict::Accepted, Verdict::TimeLimit]);
    assert!(verdicts[3..].iter().all(|verdict| *verdict == Verdict::TimeLimit));
    let last = grade.scenes().last().expect("a scene");
    assert_eq!(last.reason, Reason::Skipped(NotRunReason::Total(Duration::from_secs(25))));
    assert!(grade.points.is_some(), "that is the submission's own doing");
}

#[test]
fn fail_fast_stops_at_the_first_scene_that_is_not_accepted_and_gives_no_points() {
    for jobs in [1, 3] {
        let stage = TestGrading::new();
        let (plan, never) = (small_plan(), Cancellation::default());
        let mut grader = stage.grader(&plan);
        grader.options = Options { jobs, fail_fast: true, uses_recordings: false };
        let grades = grade_all(&grader, &stage.submissions(&["wrong", "right"]), None, &never, &mut |_| {}).grades;
        let verdicts: Vec<_> = grades[0].scenes().map(|scene| scene.verdict).collect();
        assert_eq!(verdicts[0], Verdict::WrongAnswer);
        assert!(verdicts[1..].iter().all(|verdict| *verdict == Verdict::NotRun), "{verdicts:?}");
        assert_eq!((grades[0].verdict, grades[0].points), (Verdict::WrongAnswer, None));
        assert_eq!(grades[1].points, Some(15.0));
    }
}

#[test]
fn a_wrong_first_record_costs_by_the_fair_rules_what_follows_from_it() {
    let stage = TestGrading::new();
    let plan = Plan { rules: Rules::Fair, ..small_plan() };
    let grade = stage.grade_with(&plan, &["wrong"]).remove(0);
    let scene = grade.scenes().next().expect("a scene");
    assert_eq!((grade.verdict, scene.right_steps), (Verdict::WrongAnswer, scene.steps - 1));
    assert_eq!(first_divergence(scene), (0, 0), "{scene:?}");
}

#[test]
fn bytes_behind_the_last_record_have_one_consequence_whoever_ends_first() {
    let (parity, fair) = (Verdict::Accepted, Verdict::BadTrace);
    for (name, by_parity, by_fair) in [
        ("right-then-exits", Verdict::Accepted, Verdict::Accepted),
        ("right-then-sleeps", Verdict::TimeLimit, Verdict::TimeLimit),
        ("right-then-crashes", Verdict::RuntimeError, Verdict::RuntimeError),
        ("right-then-byte-exits", parity, fair),
        ("right-then-byte-sleeps", Verdict::TimeLimit, Verdict::TimeLimit),
        ("right-then-byte-crashes", Verdict::RuntimeError, Verdict::RuntimeError),
        ("right-then-byte-fails", Verdict::RuntimeError, Verdict::RuntimeError),
        // Beyond the limit the grader does not wait for the program's end, so its exit code cannot count.
        ("right-then-flood-exits", parity, fair),
        ("right-then-flood-stopped", parity, fair),
        ("right-then-flood-unread", parity, fair),
        ("right-then-flood-fails", parity, fair),
        ("right-then-flood-sleeps", parity, fair),
    ] {
        for (rules, expected) in [(Rules::Both, by_parity), (Rules::Parity, by_parity), (Rules::Fair, by_fair)] {
            let (stage, mut plan) = (TestGrading::new(), Plan { rules, ..small_plan() });
            plan.limits.trace = SMALL_TRACE as u64;
            let grade = stage.grade_with(&plan, &[name]).remove(0);
            assert_eq!(
                (grade.verdict, grade.groups[0].verdict),
                (expected, expected),
                "{name} by {rules:?}: {grade:?}"
            );
        }
    }
}

#[test]
fn a_trace_beyond_its_limit_before_the_last_record_is_an_output_limit() {
    let (stage, mut plan) = (TestGrading::new(), small_plan());
    plan.limits.trace = 100;
    for rules in [Rules::Both, Rules::Fair] {
        plan.rules = rules;
        let names = ["right", "right-then-flood-exits", "right-then-flood-unread", "flood-of-nonsense"];
        for grade in stage.grade_with(&plan, &names) {
            assert_eq!(grade.verdict, Verdict::OutputLimit, "{grade:?}");
            assert!(grade.scenes().all(|scene| scene.verdict == Verdict::OutputLimit), "{grade:?}");
        }
    }
}
