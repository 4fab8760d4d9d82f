//! The runs of one submission share a supervisor, and nothing else.
use crate::folder_in_memory::with_namespaces;
use crate::sandbox::deaths::{eventually, kill, process};
use crate::sandbox::small;
use fosssim_oracle::sandbox::{Backend, Job, Limits, RunEnd, RunningProgram, Supervisor};
use std::{fs, os::unix::fs::PermissionsExt, path::Path};

/// A program that waits for a moment, so that tests can examine it, and then ends. Each test uses a different time, by
/// which its program is recognized.
struct Bench {
    words: [String; 2],
    folder: tempfile::TempDir,
}

impl Bench {
    fn new(seconds: &str) -> Self {
        Self { words: ["/bin/sleep", seconds].map(str::to_owned), folder: tempfile::tempdir().unwrap() }
    }

    fn start(&self, backend: &Backend, limits: Limits) -> RunningProgram {
        let job = Job::new(&self.words[0], self.folder.path()).arguments(&self.words[1..]);
        backend.start(&job.folder_in_memory().limits(limits)).expect("a run")
    }

    fn process(&self) -> Option<(i32, i32)> {
        process(&self.words.each_ref().map(String::as_str))
    }

    /// Returns the running program, the run's supervisor and the keeper.
    fn family(&self) -> [i32; 3] {
        let (program, supervisor) = eventually(|| self.process());
        let status = fs::read_to_string(format!("/proc/{supervisor}/status")).expect("the supervisor");
        let keeper = status.lines().find_map(|line| line.strip_prefix("PPid:")?.trim().parse().ok());
        [program, supervisor, keeper.expect("the supervisor's parent")]
    }
}

fn finish(running: RunningProgram) -> RunEnd {
    running.wait().expect("an outcome").ended
}

/// Returns a backend whose keepers no other test uses.
fn alone() -> Option<Backend> {
    with_namespaces()?;
    Some(
        Backend::with_all_layers(Supervisor::from_path(env!("CARGO_BIN_EXE_fosssim-oracle")))
            .expect("as for all tests"),
    )
}

#[test]
fn runs_of_one_submission_share_a_keeper_until_one_is_stopped() {
    let Some(backend) = alone() else { return };
    let bench = Bench::new("0.50077");
    let run = |limits: Limits| {
        let running = bench.start(&backend, limits);
        (bench.family(), running)
    };
    let ([first, supervisor, keeper], running) = run(small());
    assert_eq!(finish(running), RunEnd::Exited(0));
    let ([second, another, same], running) = run(small());
    assert!(same == keeper && another != supervisor && second != first, "a fresh supervisor under the same keeper");
    assert_eq!(finish(running), RunEnd::Exited(0));
    let others = || Limits { processes: 17, ..small() };
    let ([.., with_other_limits], running) = run(others());
    assert_ne!(with_other_limits, keeper);
    running.canceler().cancel();
    assert_eq!(running.wait().unwrap().ended, RunEnd::Canceled);
    let ([.., after_a_stop], running) = run(others());
    assert_ne!(after_a_stop, with_other_limits);
    assert_eq!(finish(running), RunEnd::Exited(0));
    drop(backend);
    assert!(!Path::new(&format!("/proc/{after_a_stop}")).exists(), "it goes with its backend");
}

#[test]
fn a_run_finds_nothing_of_the_one_before_it() {
    let Some(backend) = with_namespaces() else { return };
    let submission = tempfile::tempdir().unwrap();
    let program = submission.path().join("program");
    let script = "#!/bin/sh\necho $PPID $$ * /proc/[0-9]* /tmp/* /dev/* /* /.[a-z]*\n\
                  for place in . /tmp /dev /proc /run /var/tmp / \"$1\"; do true > $place/left; done\n";
    fs::write(&program, script).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    fs::set_permissions(submission.path(), fs::Permissions::from_mode(0o755)).unwrap();
    let seen: Vec<(RunEnd, String, String)> = (0..3)
        .map(|number| {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("scene.xml"), number.to_string()).unwrap();
            let job = Job::new(&program, folder.path()).arguments([submission.path()]).folder_in_memory();
            let outcome = backend.start(&job.limits(small())).unwrap().wait().unwrap();
            let name = folder.path().file_name().unwrap().to_string_lossy().into_owned();
            let shown = |bytes: &[u8]| String::from_utf8_lossy(bytes).replace(&name, "FOLDER");
            (outcome.ended.clone(), shown(&outcome.stdout.bytes), shown(&outcome.stderr.bytes))
        })
        .collect();
    assert!(seen[0].1.contains(" scene.xml "), "{seen:?}");
    assert!(!seen[0].1.contains("left"), "{seen:?}");
    assert!(seen.iter().all(|run| *run == seen[0]), "{seen:?}");
}

#[test]
fn a_run_reports_only_its_own_processor_time() {
    let Some(backend) = alone() else { return };
    let submission = tempfile::tempdir().unwrap();
    let program = submission.path().join("program");
    let script = "#!/bin/sh\n[ \"$1\" = long ] || exit 0\ni=0; while [ $i -lt 100000 ]; do i=$((i+1)); done\n";
    fs::write(&program, script).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    fs::set_permissions(submission.path(), fs::Permissions::from_mode(0o755)).unwrap();
    let cpu = |word: &str| {
        let folder = tempfile::tempdir().unwrap();
        let job = Job::new(&program, folder.path()).arguments([word]).folder_in_memory().limits(small());
        let outcome = backend.start(&job).unwrap().wait().unwrap();
        assert_eq!(outcome.ended, RunEnd::Exited(0));
        outcome.cpu
    };
    let (long, short) = (cpu("long"), cpu("short"));
    assert!(4 * short < long, "{short:?} after a run of {long:?}");
}

/// A layer of protection that stops or rejects a hostile program in a keeper's first run also does so in later runs.
#[test]
fn walls_stand_for_every_run_of_a_keeper() {
    if with_namespaces().is_none() {
        return;
    }
    let (submission, secret) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let program = submission.path().join("program");
    let script = "#!/bin/sh\ncase \"$1\" in\n\
                  fork) (true); echo forked;;\n\
                  execute) exec /bin/ls;;\n\
                  read) read text < \"$2/secret\"; echo \"$text\"; read text < /etc/passwd; echo \"$text\";;\n\
                  write) true > \"$2/made\"; true > /tmp/made; true > /dev/made; true > \"$0\";;\n\
                  signal) kill -9 1; kill -9 $PPID; kill -0 -1;;\n\
                  files) exec 2> /dev/null; i=0; while true; do i=$((i+1)); true > f$i; done;;\n\
                  flood) while true; do echo xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx; done;;\n\
                  spin) while true; do true; done;;\nesac\n";
    fs::write(&program, script).unwrap();
    fs::write(secret.path().join("secret"), "the secret").unwrap();
    for path in [&*program, submission.path(), secret.path()] {
        fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    for attack in ["fork", "execute", "read", "write", "signal", "files", "flood", "spin"] {
        let run = |backend: &Backend, word: &str| {
            let folder = tempfile::tempdir().unwrap();
            let job = Job::new(&program, folder.path()).arguments([Path::new(word), secret.path()]);
            let outcome = backend.start(&job.folder_in_memory().limits(small())).unwrap().wait().unwrap();
            (outcome.ended, outcome.stdout.bytes)
        };
        let (fresh, used) = (alone().unwrap(), alone().unwrap());
        let first = run(&fresh, attack);
        assert_eq!(run(&used, "nothing").0, RunEnd::Exited(0));
        assert_eq!(run(&used, attack), first, "{attack}");
        let shown = String::from_utf8_lossy(&first.1);
        assert!(!["secret", "root", "forked"].iter().any(|word| shown.contains(word)), "{attack}: {shown}");
        let stopped = !matches!(first.0, RunEnd::Exited(_));
        assert_eq!(stopped, ["fork", "execute", "files", "flood", "spin"].contains(&attack), "{attack}: {:?}", first.0);
    }
    assert!(!secret.path().join("made").exists() && !Path::new("/tmp/made").exists());
    assert_eq!(fs::read_to_string(&program).unwrap(), script);
}

#[test]
fn a_lost_keeper_or_supervisor_is_reported_and_replaced() {
    let Some(backend) = alone() else { return };
    let bench = Bench::new("0.50079");
    for victim in [1, 2] {
        let running = bench.start(&backend, small());
        kill(bench.family()[victim]);
        let error = running.wait().expect_err("a loss").to_string();
        assert!(error.contains("ended unexpectedly"), "{error}");
        eventually(|| bench.process().is_none().then_some(()));
        assert_eq!(finish(bench.start(&backend, small())), RunEnd::Exited(0));
    }
}
