//! Fake programs for tests. They run instead of real programs in the sandbox. The name of each says what it does.
use super::{
    batch,
    cancellation::Cancellation,
    grade::Grade,
    grader::{Grader, Options, Submission},
    plan::{self, Plan},
};
use fosssim_files::FilePlace;
use fosssim_model::{
    scene::Scene,
    sim::{Observer, RootSearch, Simulation, Zone},
    trace::{Layout, Recorder},
};
use fosssim_sandbox::{Backend, FakeRun, Job, RunEnd};
use std::{
    path::Path,
    sync::{Arc, Mutex},
    time::Duration,
};

const SUITE_TEXT: &str = "schema = 1\nname = \"test\"\nrules = \"both\"\nhints = \"full\"\n\
                     [[group]]\nname = \"first\"\npoints = 10\n\
                     scenes = [\"asset:SimpleTests/*\"]\n[[group]]\nname = \"second\"\npoints = 5\ncredit = \"all\"\n\
                     scenes = [\"asset:PenaltyTests/*\"]\n";

/// A number of bytes that traces of correct programs do not exceed, for the scenes of the small plan.
pub(super) const SMALL_TRACE: usize = 1 << 20;

pub(super) fn small_plan() -> Plan {
    plan::load_suite(SUITE_TEXT, Path::new("nowhere")).expect("a sound suite")
}

/// Returns the scene in a job's working folder.
fn scene(job: &Job) -> Scene {
    let xml = std::fs::read(job.folder.join("scene.xml")).expect("the scene");
    fosssim_model::scene::read("scene.xml", &xml).expect("a sound scene").scene
}

/// Returns the first `steps` steps of the correct trace.
fn trace(scene: &Scene, steps: u32) -> Vec<u8> {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(scene), simulation.state());
    for _ in 0..steps {
        simulation.step(&mut recorder).expect("a step");
    }
    recorder.finish().expect("memory").0
}

/// Returns the correct trace of the scene in a job's working folder.
pub(super) fn right_trace(job: &Job) -> Vec<u8> {
    let scene = scene(job);
    trace(&scene, scene.step_count())
}

/// An observer that records whether the failsafe moves a zone.
struct ZoneObserver(bool);

impl Observer for ZoneObserver {
    fn observe_failsafe(&mut self, _round: u32, _zone: &Zone<'_>) {
        self.0 = true;
    }
}

/// Runs the fake program that has the name of the job's program.
fn run_fake(job: &Job) -> FakeRun {
    match job.program.file_name().and_then(|name| name.to_str()) {
        Some("right") => FakeRun::with_trace(right_trace(job)),
        Some("wrong") => {
            let mut trace = right_trace(job);
            // The first particle starts at a different position, so only the first step is wrong.
            let x = f64::from_le_bytes(trace[..8].try_into().expect("eight bytes"));
            trace[..8].copy_from_slice(&(x + 1.0).to_le_bytes());
            FakeRun::with_trace(trace)
        }
        Some("trailing") => FakeRun::with_trace([&right_trace(job)[..], b"more"].concat()),
        Some("crash-after-right-trace") => {
            FakeRun { ended: RunEnd::Signaled(11), ..FakeRun::with_trace(right_trace(job)) }
        }
        Some("exit-1-after-right-trace") => {
            FakeRun { ended: RunEnd::Exited(1), ..FakeRun::with_trace(right_trace(job)) }
        }
        Some("nothing") => FakeRun::with_trace([]),
        Some("unwritten") => {
            let (scene, trace) = (scene(job), right_trace(job));
            let layout = Layout::for_scene(&scene);
            // In the first record, the lists are empty.
            let record = &trace[..layout.state_bytes() + 8];
            FakeRun::with_trace(record.repeat(usize::try_from(layout.records()).expect("small")))
        }
        Some("half") => {
            let trace = right_trace(job);
            FakeRun::with_trace(&trace[..trace.len() / 2])
        }
        Some("crashes-in-the-failsafe") => {
            let scene = scene(job);
            let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
            let mut moved = ZoneObserver(false);
            let step = (1..=scene.step_count()).find(|_| {
                simulation.step(&mut moved).expect("a step");
                moved.0
            });
            match step {
                Some(step) => FakeRun { ended: RunEnd::Signaled(11), ..FakeRun::with_trace(trace(&scene, step - 1)) },
                None => FakeRun::with_trace(right_trace(job)),
            }
        }
        Some("slow") => FakeRun { ended: RunEnd::WallLimit, ..FakeRun::with_trace([]) },
        Some("lengthy") => FakeRun { cpu: Duration::from_secs(10), ..FakeRun::with_trace(right_trace(job)) },
        Some("fault-while-judging" | "fault-while-explaining") => FakeRun::with_trace(right_trace(job)),
        Some(name) if name.starts_with("right-then-") => {
            let more = if name.contains("flood") { 2 * SMALL_TRACE } else { usize::from(name.contains("byte")) };
            let ended = match name.rsplit('-').next() {
                Some("exits") => RunEnd::Exited(0),
                Some("fails") => RunEnd::Exited(1),
                Some("crashes") => RunEnd::Signaled(11),
                Some("unread") => RunEnd::Signaled(13),
                Some("stopped") => RunEnd::TraceLimit,
                Some("sleeps") => RunEnd::WallLimit,
                other => panic!("no end {other:?}"),
            };
            FakeRun { ended, ..FakeRun::with_trace([&right_trace(job)[..], &vec![b'x'; more]].concat()) }
        }
        Some("flood-of-nonsense") => FakeRun::with_trace(vec![0xff; 2 * SMALL_TRACE]),
        Some("hostile") => FakeRun::with_end(RunEnd::Violation { call: "ptrace".to_owned() }),
        name => panic!("no part for {name:?}"),
    }
}

pub(super) struct TestGrading {
    pub(super) folder: tempfile::TempDir,
    backend: Backend,
    faults: FilePlace,
    pub(super) starts: Arc<Mutex<Vec<String>>>,
}

impl TestGrading {
    pub(super) fn new() -> Self {
        let starts: Arc<Mutex<Vec<String>>> = Arc::default();
        let seen = starts.clone();
        let backend = Backend::fake(move |job| {
            let scene = std::fs::read(job.folder.join("scene.xml")).expect("the scene");
            let name = job.program.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let entry = format!("{name} {}", blake3::hash(&scene));
            seen.lock().expect("lock").push(entry);
            run_fake(job)
        });
        let folder = tempfile::tempdir().expect("folder");
        Self { faults: FilePlace::new(folder.path(), ""), folder, backend, starts }
    }

    pub(super) fn submissions(&self, names: &[&str]) -> Vec<Submission> {
        names
            .iter()
            .map(|name| {
                let path = self.folder.path().join(name);
                std::fs::write(&path, name).expect("a program");
                Submission { name: (*name).to_owned(), path, program: None, file: None }
            })
            .collect()
    }

    pub(super) fn grader<'a>(&'a self, plan: &'a Plan) -> Grader<'a> {
        let options = Options { jobs: 2, fail_fast: false, uses_recordings: false };
        let faults = &self.faults;
        let reference = None;
        Grader {
            program: "FOSSSim",
            plan,
            backend: &self.backend,
            options,
            fault_folder: faults,
            trace_file: None,
            cards: None,
            smallest: None,
            receive_grade: None,
            timings: None,
            reference,
        }
    }

    pub(super) fn grade_with(&self, plan: &Plan, names: &[&str]) -> Vec<Grade> {
        batch::grade_all(&self.grader(plan), &self.submissions(names), None, &Cancellation::default(), &mut |_| {})
            .grades
    }

    pub(super) fn grade(&self, names: &[&str]) -> Vec<Grade> {
        self.grade_with(&small_plan(), names)
    }

    pub(super) fn started_count(&self) -> usize {
        self.starts.lock().expect("lock").len()
    }
}
