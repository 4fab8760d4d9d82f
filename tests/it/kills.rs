//! Graders that are killed at any moment, and graders that cannot see each other: nothing is lost, done twice,
//! different or left behind. `scripts/kill-test` repeats this many times.
use crate::workspace::{Run, Workspace, finish, submission};
use fosssim_testing::{Need, skip};
use std::{
    collections::BTreeSet,
    fs,
    path::Path,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

const SUITE: &str = "schema = 1\nname = \"killed\"\n[build]\ncommand = [\"sh\", \"build.sh\"]\nprogram = \"FOSSSim\"\n\
                     [[group]]\nname = \"scenes\"\nscenes = [\"asset:ImpulsesTests/o*\"]\npoints = 10\n";
const SUBMISSIONS: usize = 3;
const SCENES: usize = 2;

/// Returns a workspace with submissions `class/*`, a suite that builds them, and an empty temporary folder `tmp`. Each
/// build leaves a daemon. The first two programs are equal.
fn class() -> Option<Workspace> {
    let workspace = Workspace::new();
    let doctor = workspace.run(["doctor"]);
    if doctor.code != Some(0) {
        skip(Need::Sandbox, doctor.out().lines().last().unwrap_or_default());
        return None;
    }
    fs::create_dir(workspace.path("tmp")).expect("a folder");
    workspace.write("suite.toml", SUITE);
    let sample = submission("right");
    for number in 0..SUBMISSIONS {
        let folder = format!("class/student{number}");
        workspace.write(format!("{folder}/ready"), [&sample[..], format!("{}", number / 2).as_bytes()].concat());
        let build = "(setsid sleep 987654 &)\ncp ready FOSSSim && chmod 755 FOSSSim\n";
        workspace.write(format!("{folder}/build.sh"), build);
    }
    Some(workspace)
}

fn grading(workspace: &Workspace, output: &str) -> Command {
    let mut command = workspace.command();
    command.args(["grade", "class", "--suite", "suite.toml", "--output", output]);
    command.env("TMPDIR", workspace.path("tmp"));
    command
}

/// Returns the submission, verdict and points of every row, in the order of the names.
fn results(workspace: &Workspace, output: &str) -> BTreeSet<Vec<String>> {
    let bytes = workspace.read(format!("{output}/grades.csv"));
    let mut reader = csv::Reader::from_reader(&bytes[..]);
    reader.records().map(|row| row.expect("a row").iter().take(4).map(str::to_owned).collect()).collect()
}

/// Checks that the journal contains no result twice, and as many results as that of an undisturbed grading.
fn assert_undisturbed(workspace: &Workspace, output: &str, run: &Run) {
    assert_eq!(run.code, Some(0), "{}", run.shown());
    assert_eq!(results(workspace, output), results(workspace, "whole"), "{}", run.shown());
    let journal = |output: &str| {
        let text = String::from_utf8(workspace.read(format!("{output}/journal.jsonl"))).expect("text");
        let entries = text.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).expect("a whole line"));
        entries.map(|entry| entry["key"].to_string()).collect::<Vec<_>>()
    };
    let keys = journal(output);
    let different: BTreeSet<_> = keys.iter().collect();
    assert_eq!(different.len(), keys.len(), "a result twice");
    assert_eq!(keys.len(), journal("whole").len());
    assert_eq!(keys.len(), (SUBMISSIONS - 1) * SCENES, "equal programs are run once");
    let grades = String::from_utf8(workspace.read(format!("{output}/grades.csv"))).expect("text");
    let same = |name: &str| grades.lines().any(|line| line.contains(&format!(",{name},")));
    assert!(same("student0") && same("student1") && !same("student2"), "{grades}");
}

/// Returns the processes that belong to the folder, according to their environment or their program.
fn processes_of(folder: &Path) -> Vec<String> {
    let folder = folder.as_os_str().as_encoded_bytes();
    let concerns = |bytes: &[u8]| bytes.windows(folder.len()).any(|window| window == folder);
    let numbers =
        fs::read_dir("/proc").expect("/proc").flatten().filter_map(|entry| entry.file_name().into_string().ok());
    let own = std::process::id().to_string();
    numbers
        .filter(|number| number.bytes().all(|byte| byte.is_ascii_digit()) && *number != own)
        .filter(|number| {
            let read = |name: &str| fs::read(format!("/proc/{number}/{name}")).unwrap_or_default();
            let link = |name: &str| fs::read_link(format!("/proc/{number}/{name}")).unwrap_or_default();
            ["environ", "cmdline"].into_iter().any(|name| concerns(&read(name)))
                || ["exe", "cwd"].into_iter().any(|name| concerns(link(name).as_os_str().as_encoded_bytes()))
        })
        .collect()
}

fn assert_nothing_left(workspace: &Workspace) {
    let left: Vec<_> = fs::read_dir(workspace.path("tmp")).expect("the folder").flatten().map(|e| e.path()).collect();
    assert!(left.is_empty(), "left behind: {left:?}");
    // Supervisors notice the end of their grader immediately, if the machine is not too busy.
    let deadline = Instant::now() + Duration::from_secs(60);
    while !processes_of(&workspace.path("")).is_empty() {
        assert!(Instant::now() < deadline, "left behind: {:?}", processes_of(&workspace.path("")));
        std::thread::yield_now();
    }
}

#[test]
fn graders_killed_at_any_moment_lose_and_leave_nothing() {
    let Some(workspace) = class() else { return };
    let whole = finish(&mut grading(&workspace, "whole"));
    assert_eq!(whole.code, Some(0), "{}", whole.shown());
    // The exact moments do not matter.
    for moment in [0, 15, 45, 90, 130, 170, 220, 300] {
        let mut grader =
            grading(&workspace, "out").stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("a grader");
        std::thread::sleep(Duration::from_millis(moment));
        grader.kill().expect("a child of ours");
        grader.wait().expect("a child of ours");
    }
    let last = finish(&mut grading(&workspace, "out"));
    assert_undisturbed(&workspace, "out", &last);
    assert_nothing_left(&workspace);
}

/// This is like two containers that share a temporary folder: neither sees the other's processes.
#[test]
fn graders_in_process_namespaces_of_their_own_disturb_nobody() {
    let Some(workspace) = class() else { return };
    let apart = |output: &str| {
        let grading = grading(&workspace, output);
        let mut command = Command::new("unshare");
        command.args(["--pid", "--fork", "--kill-child", "--mount-proc", "--"]).arg(grading.get_program());
        command
            .args(grading.get_args())
            .current_dir(workspace.path(""))
            .env_clear()
            .env("TMPDIR", workspace.path("tmp"));
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    };
    if !Command::new("unshare").args(["--pid", "--fork", "--mount-proc", "true"]).status().is_ok_and(|s| s.success()) {
        skip(Need::Walls, "process namespaces cannot be made here");
        return;
    }
    let whole = finish(&mut grading(&workspace, "whole"));
    assert_eq!(whole.code, Some(0), "{}", whole.shown());
    std::thread::scope(|scope| {
        let outputs = ["one", "two", "three"];
        let runs = outputs.map(|output| (output, scope.spawn(move || finish(&mut apart(output)))));
        for (output, run) in runs {
            assert_undisturbed(&workspace, output, &run.join().expect("a run"));
        }
    });
    // If all processes of a grader are killed, the next one takes over its folder, on any machine.
    let mut killed = apart("killed").stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("a grader");
    while fs::read_dir(workspace.path("tmp")).expect("the folder").next().is_none() {
        assert!(killed.try_wait().expect("a child of ours").is_none(), "it ended before it had begun");
        std::thread::yield_now();
    }
    killed.kill().expect("a child of ours");
    killed.wait().expect("a child of ours");
    let last = finish(&mut apart("killed"));
    assert_undisturbed(&workspace, "killed", &last);
    assert_nothing_left(&workspace);
}
