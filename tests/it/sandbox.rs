//! The sandbox as a grader uses it: ordinary programs of the system, started, limited, stopped and explained.
//!
//! The hostile programs are in `attacks.rs`.

pub mod deaths;
pub mod libraries;

use std::ffi::OsString;
use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use fosssim_testing::{Need, skip};

use fosssim_oracle::sandbox::{
    Backend, Job, Layer, Limits, Policy, RunEnd, RunOutcome, StartProblem, Supervisor, collect,
};

/// Returns the sandbox of the real binary. Tests without the required layers of protection are skipped with a message.
pub fn backend() -> Option<&'static Backend> {
    static BACKEND: OnceLock<Result<Backend, String>> = OnceLock::new();
    let make = || Backend::with_all_layers(Supervisor::from_path(env!("CARGO_BIN_EXE_fosssim-oracle")));
    let backend = BACKEND.get_or_init(|| make().map_err(|error| error.to_string()));
    backend.as_ref().map_err(|error| skip(Need::Sandbox, error)).ok()
}

/// Returns limits that a small program keeps and that a hostile one soon reaches.
pub fn small() -> Limits {
    Limits {
        cpu: Duration::from_millis(500),
        wall: Duration::from_secs(20),
        memory: 64 << 20,
        output_bytes: 10_000,
        trace_bytes: 1 << 20,
        folder_bytes: 4 << 20,
        folder_files: 100,
        processes: 16,
        open_files: 32,
    }
}

struct Bench {
    backend: &'static Backend,
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Option<Self> {
        Some(Self { backend: backend()?, folder: tempfile::tempdir().unwrap() })
    }

    fn job(&self, program: impl Into<PathBuf>, arguments: &[&str]) -> Job {
        Job::new(program, self.folder.path()).arguments(arguments.iter().map(OsString::from)).limits(small())
    }

    fn run(&self, program: impl Into<PathBuf>, arguments: &[&str]) -> RunOutcome {
        self.finish(&self.job(program, arguments))
    }

    fn finish(&self, job: &Job) -> RunOutcome {
        self.backend.start(job).unwrap().wait().unwrap()
    }

    fn script(&self, text: &str) -> PathBuf {
        let path = self.folder.path().join("program");
        std::fs::write(&path, text).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        path
    }
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

#[test]
fn an_ordinary_program_runs_and_its_words_are_kept() {
    let Some(bench) = Bench::new() else { return };
    let outcome = bench.run("/bin/echo", &["hello", "two  words"]);
    assert_eq!(outcome.ended, RunEnd::Exited(0));
    assert_eq!(text(&outcome.stdout.bytes), "hello two  words\n");
    assert!(outcome.wall > Duration::ZERO && outcome.peak_memory > 100_000);
    let active = |layer| outcome.layers.iter().any(|report| report.layer == layer && report.active);
    assert!(active(Layer::CallFilter) && active(Layer::NoNewPrivileges));
}

#[test]
fn exit_codes_and_own_signals_are_distinguished() {
    let Some(bench) = Bench::new() else { return };
    let program = bench.script("#!/bin/sh\nexit 3\n");
    assert_eq!(bench.run(&program, &[]).ended, RunEnd::Exited(3));
    let program = bench.script("#!/bin/sh\nkill -SEGV $$\n");
    assert_eq!(bench.run(&program, &[]).ended, RunEnd::Signaled(11));
}

#[test]
fn the_graders_environment_stays_with_the_grader() {
    let Some(bench) = Bench::new() else { return };
    let outcome = bench.finish(&bench.job("/usr/bin/env", &[]).environment([("SCENE", "a b"), ("LC_ALL", "C.UTF-8")]));
    let mut names: Vec<&str> = text(&outcome.stdout.bytes).lines().filter_map(|line| line.split('=').next()).collect();
    names.sort_unstable();
    assert_eq!(names, ["HOME", "LC_ALL", "PATH", "SCENE", "TMPDIR"]);
    assert!(text(&outcome.stdout.bytes).contains("SCENE=a b\n"));
}

#[test]
fn sleepers_and_spinners_meet_their_limits() {
    let Some(bench) = Bench::new() else { return };
    let limits = Limits { wall: Duration::from_millis(200), ..small() };
    let outcome = bench.finish(&bench.job("/bin/sleep", &["1000"]).limits(limits));
    assert_eq!(outcome.ended, RunEnd::WallLimit);
    assert!(outcome.cpu < Duration::from_millis(200));
    let program = bench.script("#!/bin/sh\nwhile :; do :; done\n");
    let outcome = bench.run(&program, &[]);
    assert_eq!(outcome.ended, RunEnd::CpuLimit);
    assert!(outcome.cpu >= Duration::from_millis(490));
}

#[test]
fn a_flood_is_cut_to_the_byte() {
    let Some(bench) = Bench::new() else { return };
    let outcome = bench.run("/usr/bin/yes", &[]);
    assert_eq!(outcome.ended, RunEnd::CpuLimit);
    assert!(outcome.stdout.truncated && outcome.stdout.bytes.len() == 10_000);
    let program = bench.script("#!/bin/sh\nhead -c 3000000 /dev/zero\nhead -c 3000000 /dev/zero >&2\n");
    let outcome = bench.finish(&bench.job(&program, &[]).policy(Policy::Tools));
    assert_eq!(outcome.ended, RunEnd::Exited(0), "who prints too much is heard no more, and goes on");
    assert!(outcome.stderr.truncated && outcome.stderr.bytes.len() == 10_000);
}

#[test]
fn a_trace_without_end_is_stopped_at_its_limit() {
    let Some(bench) = Bench::new() else { return };
    let program = bench.script("#!/bin/sh\nexec yes > trace.bin\n");
    let job = bench.job(&program, &[]).trace("trace.bin").policy(Policy::Tools);
    let (outcome, left) = bench.backend.start(&job).unwrap().wait_with_folder().unwrap();
    assert_eq!(outcome.ended, RunEnd::TraceLimit);
    let (_, length) = left.regular_file("trace.bin", u64::MAX).unwrap();
    assert!(length > small().trace_bytes && length <= small().folder_bytes, "{length}");
}

/// The limit of a trace does not depend on the folder's limit.
#[test]
fn a_trace_may_be_longer_than_all_else_in_the_folder() {
    let Some(bench) = Bench::new() else { return };
    let program = bench.script("#!/bin/sh\nexec head -c 3000000 /dev/zero > trace.bin\n");
    let job = |trace_bytes| {
        let limits = Limits { trace_bytes, folder_bytes: 1 << 20, ..small() };
        bench.job(&program, &[]).trace("trace.bin").policy(Policy::Tools).limits(limits)
    };
    let (outcome, left) = bench.backend.start(&job(3_000_000)).unwrap().wait_with_folder().unwrap();
    assert_eq!(outcome.ended, RunEnd::Exited(0));
    assert_eq!(left.regular_file("trace.bin", u64::MAX).unwrap().1, 3_000_000);
    assert_eq!(bench.finish(&job(2_999_999)).ended, RunEnd::TraceLimit);
}

#[test]
fn a_failed_memory_request_is_the_memory_limit() {
    let Some(bench) = Bench::new() else { return };
    let source = "#include <new>\nint main() { char *p = new char[1UL << 40]; p[0] = 1; return p[0]; }";
    let (from, program) = (bench.folder.path().join("source.cpp"), bench.folder.path().join("built"));
    std::fs::write(&from, source).unwrap();
    let built = std::process::Command::new("c++").args(["-O0", "-w", "-o"]).args([&program, &from]).status();
    if !built.is_ok_and(|status| status.success()) {
        skip(Need::Cxx, "there is no C++ compiler (c++)");
        return;
    }
    assert_eq!(bench.run(&program, &[]).ended, RunEnd::MemoryLimit);
}

#[test]
fn a_run_can_be_canceled_and_dropped() {
    let Some(bench) = Bench::new() else { return };
    let job = bench.job("/bin/sleep", &["1000"]).trace("trace.bin");
    let running = bench.backend.start(&job).unwrap();
    running.canceler().cancel();
    assert_eq!(running.wait().unwrap().ended, RunEnd::Canceled);
    // Dropping the run kills the sleeper, which would otherwise wait for a thousand seconds.
    drop(bench.backend.start(&job).unwrap());
}

#[test]
fn a_submission_starts_no_process_and_no_second_program() {
    let Some(bench) = Bench::new() else { return };
    let program = bench.script("#!/bin/sh\n/bin/ls | /bin/cat\n");
    let RunEnd::Violation { call } = bench.run(&program, &[]).ended else { panic!("it may not fork") };
    assert!(call.contains("process"), "{call}");
    let outcome = bench.finish(&bench.job(&program, &[]).policy(Policy::Tools));
    assert_eq!(outcome.ended, RunEnd::Exited(0), "{}", text(&outcome.stderr.bytes));
    assert_eq!(text(&outcome.stdout.bytes), "program\n");
}

#[test]
fn a_script_in_another_language_runs_as_one_program() {
    let Some(bench) = Bench::new() else { return };
    if !Path::new("/usr/bin/python3").exists() {
        skip(Need::Python, "there is no python3");
        return;
    }
    let program = bench.script("#!/usr/bin/env python3\nprint(6 * 7)\n");
    let outcome = bench.run(&program, &[]);
    assert_eq!(outcome.ended, RunEnd::Exited(0), "{}", text(&outcome.stderr.bytes));
    assert_eq!(text(&outcome.stdout.bytes), "42\n");
}

#[test]
fn readable_paths_are_readable_and_others_are_not() {
    let Some(bench) = Bench::new() else { return };
    let outside = tempfile::tempdir().unwrap();
    std::fs::set_permissions(outside.path(), std::fs::Permissions::from_mode(0o755)).unwrap();
    let scene = outside.path().join("scene.xml");
    std::fs::write(&scene, "<scene/>").unwrap();
    let scene = scene.to_str().unwrap();
    let refused = bench.run("/bin/cat", &[scene]);
    assert_eq!(refused.ended, RunEnd::Exited(1));
    let why = text(&refused.stderr.bytes);
    // In its own namespace the file does not even exist.
    assert!(why.contains("ermission denied") || why.contains("o such file"), "{why}");
    let outcome = bench.finish(&bench.job("/bin/cat", &[scene]).readable([outside.path()]));
    assert_eq!(text(&outcome.stdout.bytes), "<scene/>");
    let missing = bench.backend.start(&bench.job("/bin/cat", &[]).readable(["/no/such/scene.xml"]));
    assert!(missing.unwrap_err().to_string().contains("/no/such/scene.xml"));
}

#[test]
fn a_run_in_namespaces_sees_a_world_of_its_own() {
    let Some(bench) = Bench::new() else { return };
    let holds = |layer| bench.backend.layers().iter().any(|report| report.layer == layer && report.active);
    if !holds(Layer::Namespaces) {
        skip(Need::Walls, "there are no namespaces");
        return;
    }
    let outcome = bench.run(bench.script("#!/bin/sh\necho $$\n"), &[]);
    assert_eq!(text(&outcome.stdout.bytes), "2\n", "{outcome:?}");
    // Without Landlock, which forbids listing the root folder, only the separate view of the file system hides the
    // host.
    let Ok(backend) = bench.backend.without_layer(Layer::FileRules) else { return };
    let seen = |folder: &str| {
        let outcome = backend.start(&bench.job("/bin/ls", &["-A", folder])).unwrap().wait().unwrap();
        text(&outcome.stdout.bytes).lines().map(str::to_string).collect::<Vec<_>>()
    };
    let root = seen("/");
    assert!(root.contains(&"usr".into()) && root.contains(&"proc".into()), "{root:?}");
    assert!(!root.iter().any(|name| ["home", "root", "run", "boot", ".host"].contains(&name.as_str())), "{root:?}");
    assert_eq!(seen("/usr/bin"), ["ls"], "only the program itself is there");
    let processes = seen("/proc").iter().filter(|name| name.parse::<i32>().is_ok()).count();
    assert_eq!(processes, 1, "itself alone");
    let beside = tempfile::tempdir().unwrap();
    let planted = beside.path().join("planted").display().to_string();
    let script =
        bench.script("#!/bin/sh\n: > here && echo inside; : > \"$1\"; : > /tmp/planted; : > /usr/lib/planted\n");
    let job = bench.job(script, &[&planted]);
    let outcome = backend.start(&job).unwrap().wait().unwrap();
    assert_eq!(text(&outcome.stdout.bytes), "inside\n", "{outcome:?}");
    assert!(!Path::new(&planted).exists() && !Path::new("/tmp/planted").exists());
}

#[test]
fn the_folders_size_and_files_are_bounded() {
    let Some(bench) = Bench::new() else { return };
    let program = bench.script("#!/bin/sh\nexec yes > big\n");
    let tools = |program: &Path| bench.job(program, &[]).policy(Policy::Tools);
    assert_eq!(bench.finish(&tools(&program)).ended, RunEnd::FolderLimit);
    let program = bench.script("#!/bin/sh\nrm -f big\ni=0; while :; do i=$((i+1)); : > f$i; done\n");
    assert_eq!(bench.finish(&tools(&program)).ended, RunEnd::FolderLimit);
}

#[test]
fn programs_that_cannot_start_are_explained() {
    let Some(bench) = Bench::new() else { return };
    let problem = |program: &Path| match bench.run(program, &[]).ended {
        RunEnd::CouldNotStart(problem) => problem,
        other => panic!("{other:?}"),
    };
    assert_eq!(problem(Path::new("/no/such/program")), StartProblem::NotFound);
    assert_eq!(problem(bench.folder.path()), StartProblem::IsFolder);
    let program = bench.script("#!/usr/bin/no-such-interpreter\n");
    assert!(matches!(problem(&program), StartProblem::MissingInterpreter { .. }));
    let copy = bench.folder.path().join("busy");
    std::fs::copy("/bin/true", &copy).unwrap();
    let open = std::fs::OpenOptions::new().append(true).open(&copy).unwrap();
    assert_eq!(problem(&copy), StartProblem::Busy);
    drop(open);
    assert_eq!(bench.run(&copy, &[]).ended, RunEnd::Exited(0));
    let program = bench.script("#!/bin/sh\necho \"freeglut: failed to open display ''\" >&2; exit 1\n");
    assert_eq!(problem(&program), StartProblem::NeedsDisplay);
}

#[test]
fn a_program_that_only_its_owner_may_execute_runs_all_the_same() {
    let Some(bench) = Bench::new() else { return };
    let private = tempfile::tempdir().unwrap();
    let program = private.path().join("program");
    std::fs::copy("/bin/echo", &program).unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o700)).unwrap();
    let outcome = bench.run(&program, &["here"]);
    assert_eq!(outcome.ended, RunEnd::Exited(0), "{}", text(&outcome.stderr.bytes));
    assert_eq!(text(&outcome.stdout.bytes), "here\n");
}

#[test]
fn the_folder_is_the_graders_again_when_the_run_is_over() {
    let Some(bench) = Bench::new() else { return };
    use std::os::unix::fs::MetadataExt;
    let program = bench.script("#!/bin/sh\necho result > out.txt\n");
    let owner = bench.folder.path().metadata().unwrap().uid();
    assert_eq!(bench.run(&program, &[]).ended, RunEnd::Exited(0));
    let (mut file, _) = collect::OpenFolder::open(bench.folder.path()).unwrap().regular_file("out.txt", 100).unwrap();
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).unwrap();
    assert_eq!(bytes, b"result\n");
    assert_eq!(bench.folder.path().join("out.txt").metadata().unwrap().uid(), owner);
    assert_eq!(bench.folder.path().metadata().unwrap().uid(), owner);
}

/// Builds a C program in the folder. Returns `None` and prints a line without a suitable compiler.
fn compiled(folder: &Path, source: &str, options: &[&str]) -> Option<PathBuf> {
    let (from, to) = (folder.join("source.c"), folder.join("built"));
    std::fs::write(&from, source).unwrap();
    let built = std::process::Command::new("cc")
        .current_dir(folder)
        .args(["-O0", "-o"])
        .args([&to, &from])
        .args(options)
        .output();
    match built {
        Ok(output) if output.status.success() => Some(to),
        _ => {
            skip(Need::Cc, format_args!("cc can't build this here ({options:?})"));
            None
        }
    }
}

#[test]
fn a_missing_library_is_named() {
    let Some(bench) = Bench::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let library = ["-shared", "-fPIC", "-o", "libcourse.so"];
    if compiled(folder.path(), "int course(void) { return 0; }", &library).is_none() {
        return;
    }
    let source = "int course(void); int main(void) { return course(); }";
    let Some(program) = compiled(folder.path(), source, &["-L.", "-lcourse"]) else { return };
    let missing = StartProblem::MissingLibrary { library: "libcourse.so".into() };
    assert_eq!(bench.run(program, &[]).ended, RunEnd::CouldNotStart(missing));
}

#[test]
fn a_loader_that_is_not_the_systems_is_the_programs_fault() {
    let Some(bench) = Bench::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    // While the program starts, its process is the grader itself.
    for loader in ["/no/such/loader", "/proc/self/exe", "/proc/self/task/2/exe", env!("CARGO_BIN_EXE_fosssim-oracle")] {
        let option = format!("-Wl,--dynamic-linker={loader}");
        let Some(program) = compiled(folder.path(), "int main(void) { return 0; }", &[&option]) else { return };
        for backend in [
            Ok(bench.backend.clone()),
            bench.backend.without_layer(Layer::FileRules),
            bench.backend.without_layer(Layer::Namespaces),
        ] {
            let Ok(backend) = backend else { continue };
            let job = bench.job(&program, &["--version"]).folder_in_memory();
            let ended = backend.start(&job).unwrap().wait().unwrap().ended;
            assert_eq!(ended, RunEnd::CouldNotStart(StartProblem::MissingLoader {}), "{loader}");
        }
    }
}

#[test]
fn a_sanitized_program_runs_and_its_memory_is_limited_all_the_same() {
    let Some(bench) = Bench::new() else { return };
    let source = "#include <stdlib.h>\n#include <string.h>\nint main(int count, char **words) {\n\
                  int size = atoi(words[1]); memset(malloc(size), 1, size); return 0; }";
    let Some(program) = compiled(bench.folder.path(), source, &["-fsanitize=address"]) else { return };
    let unasked = bench.run(&program, &["1000"]).ended;
    assert_eq!(unasked, RunEnd::CouldNotStart(StartProblem::Sanitized), "only by the suite's own word");
    let run = |size| bench.finish(&bench.job(&program, &[size]).sanitizers(true)).ended;
    assert_eq!(run("1000"), RunEnd::Exited(0));
    assert_eq!(run("200000000"), RunEnd::MemoryLimit);
}

#[test]
fn a_build_step_compiles_a_program_in_the_sandbox() {
    let Some(bench) = Bench::new() else { return };
    if compiled(bench.folder.path(), "int main(void) { return 0; }", &[]).is_none() {
        return;
    }
    std::fs::remove_file(bench.folder.path().join("built")).unwrap();
    std::fs::write(bench.folder.path().join("Makefile"), "built: source.c\n\tcc -o built source.c\n").unwrap();
    let limits = Limits { cpu: Duration::from_secs(10), folder_bytes: 64 << 20, ..Limits::default() };
    for job in [bench.job("/usr/bin/make", &[]), bench.job("/usr/bin/cc", &["-o", "built", "source.c"])] {
        if !Path::new("/usr/bin/make").exists() {
            skip(Need::Make, "there is no make");
            return;
        }
        let outcome = bench.finish(&job.policy(Policy::Tools).limits(limits.clone()));
        assert_eq!(outcome.ended, RunEnd::Exited(0), "{}", text(&outcome.stderr.bytes));
        let built = bench.folder.path().join("built");
        assert_eq!(bench.run(&built, &[]).ended, RunEnd::Exited(0));
        std::fs::remove_file(built).unwrap();
    }
    std::fs::write(bench.folder.path().join("source.c"), "int main(void) { return nothing; }").unwrap();
    let job = bench.job("/usr/bin/cc", &["-o", "built", "source.c"]).policy(Policy::Tools).limits(limits);
    let outcome = bench.finish(&job);
    assert_eq!(outcome.ended, RunEnd::Exited(1));
    assert!(text(&outcome.stderr.bytes).contains("nothing"));
}

#[test]
fn without_the_required_walls_the_limits_and_all_other_walls_still_hold() {
    let Some(best) = backend() else { return };
    let bench_folder = tempfile::tempdir().unwrap();
    let backend = Backend::without_sandbox(Supervisor::from_path(env!("CARGO_BIN_EXE_fosssim-oracle"))).unwrap();
    assert!(backend.is_complete() && backend.weaknesses().is_empty(), "this host lacks nothing");
    assert_eq!(backend.layers(), best.layers(), "no wall that holds is left out");
    let job = Job::new("/usr/bin/id", bench_folder.path()).arguments(["-u"]);
    let outcome = backend.start(&job).unwrap().wait().unwrap();
    assert_ne!(text(&outcome.stdout.bytes), "0\n", "a program never runs as root");
    let limits = Limits { wall: Duration::from_millis(200), ..small() };
    let job = Job::new("/bin/sleep", bench_folder.path()).arguments(["1000"]).limits(limits);
    let outcome = backend.start(&job).unwrap().wait().unwrap();
    assert_eq!(outcome.ended, RunEnd::WallLimit);
    assert!(outcome.layers.iter().any(|report| report.layer == Layer::CallFilter && report.active));
    // This starts eight sleepers, but only four processes are allowed.
    let script = "for i in 1 2 3 4 5 6 7 8; do sleep 1000 & done; wait";
    let limits = Limits { processes: 4, ..small() };
    let job = Job::new("/bin/sh", bench_folder.path()).arguments(["-c", script]).limits(limits).policy(Policy::Tools);
    assert_eq!(backend.start(&job).unwrap().wait().unwrap().ended, RunEnd::ProcessLimit);
}

#[test]
fn a_program_cannot_have_the_grader_run_in_its_place() {
    let Some(bench) = Bench::new() else { return };
    let grader = env!("CARGO_BIN_EXE_fosssim-oracle");
    for line in [
        format!("#!{grader} --version\n"),
        format!("#!/usr/bin/../..{grader} --version\n"),
        format!("#!/usr/bin/env {grader}\n"),
        format!("#!/usr/bin/env -S {grader} --version --\n"),
        "#!/proc/self/exe --version\n".into(),
    ] {
        let ended = bench.run(bench.script(&line), &[]).ended;
        let RunEnd::CouldNotStart(StartProblem::NotTheSystems { .. }) = ended else { panic!("{line}: {ended:?}") };
    }
    for text in
        [format!("#!/bin/sh\nexec {grader} --version\n"), format!("#!/usr/bin/env sh\nexec {grader} --version\n")]
    {
        let outcome = bench.run(bench.script(&text), &[]);
        assert!(outcome.ended != RunEnd::Exited(0) && outcome.stdout.bytes.is_empty(), "{text}: {outcome:?}");
    }
    assert_eq!(bench.run(grader, &["--version"]).ended, RunEnd::CouldNotStart(StartProblem::GradersOwn));
    let link = bench.folder.path().join("link");
    std::os::unix::fs::symlink(grader, &link).unwrap();
    assert_eq!(bench.run(link, &["--version"]).ended, RunEnd::CouldNotStart(StartProblem::GradersOwn));
    // The program does not see the grader, even in a folder that it may read.
    let beside = Path::new(grader).parent().unwrap();
    let outcome = bench.finish(&bench.job("/bin/cat", &[grader]).readable([beside]).policy(Policy::Tools));
    assert!(outcome.ended != RunEnd::Exited(0) && outcome.stdout.bytes.is_empty(), "it read the grader");
}

#[test]
fn a_supervisor_that_is_none_is_our_fault_and_not_a_verdict() {
    let error = Backend::with_all_layers(Supervisor::from_path("/bin/true")).unwrap_err();
    assert!(error.to_string().contains("supervisor"), "{error}");
    assert!(Backend::with_all_layers(Supervisor::from_path("/no/such/program")).is_err());
}

#[test]
fn a_script_is_read_by_its_interpreter_and_executes_nothing_else() {
    let Some(bench) = Bench::new() else { return };
    let loader =
        ["/lib64/ld-linux-x86-64.so.2", "/lib/ld-linux-aarch64.so.1"].into_iter().find(|path| Path::new(path).exists());
    let Some(loader) = loader else { return };
    // With the loader, a script could run any file that it can read.
    let script = bench.script(&format!("#!/bin/sh\nexec {loader} /bin/echo run\n"));
    for backend in [bench.backend.clone(), bench.backend.without_layer(Layer::NamedCalls).unwrap()] {
        let outcome = backend.start(&bench.job(&script, &[])).unwrap().wait().unwrap();
        assert!(matches!(outcome.ended, RunEnd::Violation { .. }), "{:?}", outcome.ended);
        let plain = bench.folder.path().join("plain");
        std::fs::write(&plain, "#!/usr/bin/env -S VALUE=7 sh -e\necho \"$VALUE $1\"\nfalse\necho more\n").unwrap();
        std::fs::set_permissions(&plain, std::fs::Permissions::from_mode(0o755)).unwrap();
        let outcome = backend.start(&bench.job(&plain, &["one two"])).unwrap().wait().unwrap();
        assert_eq!((outcome.ended, text(&outcome.stdout.bytes)), (RunEnd::Exited(1), "7 one two\n"));
    }
}

#[test]
fn a_script_in_a_folder_that_is_closed_to_others_runs_all_the_same() {
    let Some(bench) = Bench::new() else { return };
    let closed = tempfile::tempdir().unwrap();
    let script = closed.path().join("script");
    std::fs::write(&script, "#!/bin/sh\necho here\n").unwrap();
    for (mode, inner) in [(0o700, 0o755), (0o755, 0o700), (0o700, 0o700)] {
        std::fs::set_permissions(closed.path(), std::fs::Permissions::from_mode(mode)).unwrap();
        std::fs::set_permissions(&script, std::fs::Permissions::from_mode(inner)).unwrap();
        for backend in [bench.backend.clone(), bench.backend.without_layer(Layer::Namespaces).unwrap()] {
            let outcome = backend.start(&bench.job(&script, &[])).unwrap().wait().unwrap();
            assert_eq!(text(&outcome.stdout.bytes), "here\n", "{mode:o} {inner:o} {outcome:?}");
        }
    }
}

#[test]
fn a_removed_or_changed_staged_program_is_a_grader_fault() {
    use fosssim_oracle::sandbox::ProgramIdentity;
    let Some(bench) = Bench::new() else { return };
    let program = bench.script("#!/bin/sh\nexit 0\n");
    let job = bench.job(&program, &[]).with_identity(ProgramIdentity::from_path(&program));
    assert_eq!(bench.finish(&job).ended, RunEnd::Exited(0));
    std::fs::write(&program, "#!/bin/sh\nexit 1\n").unwrap();
    let changed = bench.backend.start(&job).unwrap_err();
    assert!(changed.to_string().contains("changed or removed"), "{changed}");
    std::fs::remove_file(&program).unwrap();
    assert!(bench.backend.start(&job).unwrap_err().to_string().contains("changed or removed"));
}

/// Runs the program's own commands with a temporary folder in which nothing may be executed.
#[test]
fn a_noexec_temporary_folder_is_reported_and_programs_run_from_memory() {
    let Some(_) = backend() else { return };
    let folder = tempfile::tempdir().unwrap();
    let line = "mount -t tmpfs -o noexec,mode=1777 tmpfs \"$0\" && export TMPDIR=\"$0\" && \"$1\" doctor; \"$1\" demo";
    let output = std::process::Command::new("unshare")
        .args(["-m", "sh", "-c", line])
        .arg(folder.path())
        .arg(env!("CARGO_BIN_EXE_fosssim-oracle"))
        .output();
    let Ok(output) = output else { return };
    let (out, err) = (text(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if out.is_empty() {
        eprintln!("skipped: {err}");
        return;
    }
    assert!(out.contains("in memory, because the temporary folder is mounted noexec"), "{out}{err}");
    assert!(output.status.success() && out.contains("everything works on this machine"), "{out}{err}");
}
