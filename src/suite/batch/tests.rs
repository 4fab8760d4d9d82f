use super::*;
use crate::{
    judge::fair::Cause,
    sandbox::{Ended, FakeRun, Job},
    sim::{RootSearch, Simulation},
    suite::plan,
    trace::{Layout, Recorder},
};
use std::{path::Path, sync::Mutex};

const SUITE: &str = "schema = 1\nname = \"test\"\nhints = \"full\"\n[[group]]\nname = \"first\"\npoints = 10\n\
                     scenes = [\"asset:SimpleTests/*\"]\n[[group]]\nname = \"second\"\npoints = 5\ncredit = \"all\"\n\
                     scenes = [\"asset:PenaltyTests/*\"]\n";

fn small_plan() -> Plan {
    plan::load(SUITE, Path::new("nowhere")).expect("a sound suite")
}

/// The right trace of the scene in a job's working folder.
fn right_trace(job: &Job) -> Vec<u8> {
    let xml = std::fs::read(job.folder.join("scene.xml")).expect("the scene");
    let scene = crate::scene::read("scene.xml", &xml).expect("a sound scene").scene;
    let mut simulation = Simulation::new(&scene, RootSearch::WhereNeeded);
    let mut recorder = Recorder::start(Vec::new(), Layout::of(&scene), simulation.state());
    for _ in 0..scene.steps() {
        simulation.step(&mut recorder).expect("a step");
    }
    recorder.finish().expect("memory").0
}

/// Programs of this cast do what their names say.
fn act(job: &Job) -> FakeRun {
    match job.program.file_name().and_then(|name| name.to_str()) {
        Some("right") => FakeRun::wrote(right_trace(job)),
        Some("wrong") => {
            let mut trace = right_trace(job);
            // The first particle starts elsewhere: the first step does not follow from it, all others do.
            let x = f64::from_le_bytes(trace[..8].try_into().expect("eight bytes"));
            trace[..8].copy_from_slice(&(x + 1.0).to_le_bytes());
            FakeRun::wrote(trace)
        }
        Some("trailing") => FakeRun::wrote([&right_trace(job)[..], b"more"].concat()),
        Some("crash-after-right-trace") => FakeRun { ended: Ended::Signalled(11), ..FakeRun::wrote(right_trace(job)) },
        Some("exit-1-after-right-trace") => FakeRun { ended: Ended::Exited(1), ..FakeRun::wrote(right_trace(job)) },
        Some("nothing") => FakeRun::wrote([]),
        Some("half") => {
            let trace = right_trace(job);
            FakeRun::wrote(&trace[..trace.len() / 2])
        }
        Some("slow") => FakeRun { ended: Ended::WallLimit, ..FakeRun::wrote([]) },
        Some("hostile") => FakeRun::ended(Ended::Violation { call: "ptrace".to_owned() }),
        name => panic!("no part for {name:?}"),
    }
}

struct Stage {
    folder: tempfile::TempDir,
    backend: Backend,
    starts: Arc<Mutex<Vec<String>>>,
}

impl Stage {
    fn new() -> Self {
        let starts: Arc<Mutex<Vec<String>>> = Arc::default();
        let seen = starts.clone();
        let backend = Backend::fake(move |job| {
            seen.lock().expect("lock").push(job.program.to_string_lossy().into_owned());
            act(job)
        });
        Self { folder: tempfile::tempdir().expect("folder"), backend, starts }
    }

    fn submissions(&self, names: &[&str]) -> Vec<Submission> {
        names
            .iter()
            .map(|name| {
                let path = self.folder.path().join(name);
                std::fs::write(&path, name).expect("a program");
                Submission { name: (*name).to_owned(), path, program: None }
            })
            .collect()
    }

    fn grade(&self, names: &[&str]) -> Vec<Grade> {
        let (options, cancellation) =
            (BatchOptions { jobs: 2, fail_fast: false, recorded: false }, Cancellation::default());
        run(&small_plan(), &self.submissions(names), &self.backend, None, options, &cancellation, &mut |_| {}).grades
    }
}

#[test]
fn a_right_program_gets_every_point_and_the_others_their_verdicts() {
    let stage = Stage::new();
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
    assert!(wrong.details[0].starts_with("first divergence: step 1: particle 0"), "{wrong:?}");
}

#[test]
fn an_interrupted_grading_goes_on_where_it_stopped_and_ends_the_same() {
    let stage = Stage::new();
    let (plan, names) = (small_plan(), ["right", "wrong", "half", "slow"]);
    let submissions = stage.submissions(&names);
    let options = BatchOptions { jobs: 2, fail_fast: false, recorded: false };
    let results = tempfile::tempdir().expect("folder");
    for stop_after in [3, 9] {
        let mut journal = Journal::open(results.path(), false).expect("journal");
        let (cancellation, mut done) = (Cancellation::default(), 0);
        let mut on_event = |event: Event<'_>| {
            if let Event::SceneDone { grade, .. } = event
                && !grade.cached
            {
                done += 1;
                if done == stop_after {
                    cancellation.cancel();
                }
            }
        };
        let stopped =
            run(&plan, &submissions, &stage.backend, Some(&mut journal), options, &cancellation, &mut on_event).grades;
        assert!(stopped.iter().any(|grade| grade.count(Verdict::NotRun) > 0), "it stopped before the end");
    }
    let mut journal = Journal::open(results.path(), false).expect("journal");
    let resumed =
        run(&plan, &submissions, &stage.backend, Some(&mut journal), options, &Cancellation::default(), &mut |_| {})
            .grades;
    let scenes = plan.scenes().count();
    assert_eq!(stage.starts.lock().expect("lock").len(), names.len() * scenes, "nothing was run twice");
    let uninterrupted = stage.grade(&names);
    for (resumed, whole) in resumed.iter().zip(&uninterrupted) {
        assert_eq!((resumed.verdict, resumed.points), (whole.verdict, whole.points));
        for (resumed, whole) in resumed.scenes().zip(whole.scenes()) {
            assert_eq!((resumed.verdict, &resumed.summary), (whole.verdict, &whole.summary));
        }
    }
}

#[test]
fn a_changed_program_is_graded_anew() {
    let stage = Stage::new();
    let (plan, options) = (small_plan(), BatchOptions { jobs: 1, fail_fast: false, recorded: false });
    let results = tempfile::tempdir().expect("folder");
    let grade = |submissions: &[Submission]| {
        let mut journal = Journal::open(results.path(), false).expect("journal");
        run(&plan, submissions, &stage.backend, Some(&mut journal), options, &Cancellation::default(), &mut |_| {})
            .grades
    };
    let submissions = stage.submissions(&["right"]);
    assert!(grade(&submissions)[0].scenes().all(|scene| !scene.cached));
    assert!(grade(&submissions)[0].scenes().all(|scene| scene.cached));
    std::fs::write(&submissions[0].path, "another build").expect("changed");
    assert!(grade(&submissions)[0].scenes().all(|scene| !scene.cached));
}

#[test]
fn the_official_book_gives_verdict_and_points_and_results_are_not_mixed_up() {
    let stage = Stage::new();
    let submissions = stage.submissions(&["trailing"]);
    let results = tempfile::tempdir().expect("folder");
    let grade = |rules: Rules, recorded: bool| {
        let plan = Plan { rules, ..small_plan() };
        let options = BatchOptions { jobs: 2, fail_fast: false, recorded };
        let mut journal = Journal::open(results.path(), false).expect("journal");
        let never = Cancellation::default();
        run(&plan, &submissions, &stage.backend, Some(&mut journal), options, &never, &mut |_| {}).grades.remove(0)
    };
    let both = grade(Rules::Both, false);
    assert_eq!((both.verdict, both.points), (Verdict::Accepted, Some(15.0)));
    assert!(both.scenes().all(|scene| scene.differs == Some(Cause::TrailingBytes)), "{both:?}");
    let fair = grade(Rules::Fair, false);
    assert_eq!((fair.verdict, fair.points), (Verdict::BadTrace, Some(0.0)));
    assert!(fair.scenes().all(|scene| !scene.cached && scene.summary == "bytes follow the trace's last record"));
    let parity = grade(Rules::Parity, false);
    assert_eq!((parity.verdict, parity.differing()), (Verdict::Accepted, 0));
    // What was kept says the same, and recordings know parity only.
    let again = grade(Rules::Both, false);
    assert!(again.scenes().all(|scene| scene.cached && scene.differs == Some(Cause::TrailingBytes)));
    assert_eq!(grade(Rules::Both, true).rules, Rules::Parity);
}

#[test]
fn a_wrong_first_record_costs_by_the_fair_rules_what_follows_from_it() {
    let stage = Stage::new();
    let submissions = stage.submissions(&["wrong"]);
    let plan = Plan { rules: Rules::Fair, ..small_plan() };
    let options = BatchOptions { jobs: 2, fail_fast: false, recorded: false };
    let grade =
        run(&plan, &submissions, &stage.backend, None, options, &Cancellation::default(), &mut |_| {}).grades.remove(0);
    let scene = grade.scenes().next().expect("a scene");
    assert_eq!((grade.verdict, scene.right_steps), (Verdict::WrongAnswer, scene.steps - 1));
    assert!(scene.details[0].starts_with("first divergence: step 0: particle 0"), "{scene:?}");
}
