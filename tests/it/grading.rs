//! Grades programs as a user does, with real processes in the real sandbox.
//!
//! The submissions are links to `fosssim-sample` whose names give their mistakes. Without a sandbox, the tests print a
//! message and are skipped.
mod platforms;
mod programs;

use crate::workspace::{Workspace, finish};
use fosssim_oracle::{
    student::{self, Student},
    suite::library,
};
use fosssim_testing::{Need, skip};
use std::{
    os::unix::fs::symlink,
    path::Path,
    process::{Command, Stdio},
    time::Duration,
};

pub(crate) const SUITE: &str = "schema = 1\nname = \"test\"\nrules = \"both\"\nhints = \"full\"\n\
                     [limits]\ncpu_seconds = 1\nwall_seconds = 3\nmemory_mib = 256\n\
                     [[group]]\nname = \"Impulses\"\nscenes = [\"asset:ImpulsesTests/o*\"]\n\
                     points = 10\ncredit = \"steps\"\n\
                     [[group]]\nname = \"Zones\"\nscenes = [\"asset:GeometricTests/ball-*\"]\npoints = 10\n";

/// Returns a workspace with a suite, or `None` if programs cannot run safely.
pub(crate) fn workspace() -> Option<Workspace> {
    let workspace = Workspace::new();
    workspace.write("suite.toml", SUITE);
    let doctor = workspace.run(["doctor"]);
    if doctor.code == Some(0) {
        Some(workspace)
    } else {
        skip(Need::Sandbox, doctor.out().lines().last().unwrap_or_default());
        None
    }
}

/// Puts sample submissions into `submissions/` and returns their paths. An empty name is the correct program. The
/// submissions are links, which are graded only if the command line names them.
pub(crate) fn submit(workspace: &Workspace, mistakes: &[&str]) -> Vec<String> {
    std::fs::create_dir_all(workspace.path("submissions")).expect("a folder");
    let submit = |mistake: &&str| {
        let name = if mistake.is_empty() { "fosssim-sample".to_owned() } else { format!("fosssim-sample.{mistake}") };
        let path = format!("submissions/{name}");
        symlink(env!("CARGO_BIN_EXE_fosssim-sample"), workspace.path(&path)).expect("a link");
        path
    };
    mistakes.iter().map(submit).collect()
}

/// The only scene of the suite for scripts.
const SCRIPTED_SCENE: &str = "GeometricTests/ball-on-a-fixed-edge";

/// Commands that print 16 MiB.
const FLOOD: &str = "x=0123456789abcdef; for i in 1 2 3 4 5 6 7 8 9 10 11 12; do x=$x$x; done; i=0; \
                     while [ $i -lt 256 ]; do printf %s $x; i=$((i + 1)); done";

/// A command that stops the program, so that it never ends.
const SLEEP: &str = "kill -STOP $$";

/// Puts programs into `submissions/` that are scripts, and returns their paths. Each runs its commands, in which
/// `RIGHT` writes a correct trace of [`SCRIPTED_SCENE`], and `HALF` the first half of it. Programs must not start
/// others.
fn submit_scripts(workspace: &Workspace, programs: &[(&str, &str)]) -> Vec<String> {
    let suite = SUITE.split("[[group]]").next().unwrap_or_default();
    let group = format!("[[group]]\nname = \"Zones\"\nscenes = [\"asset:{SCRIPTED_SCENE}\"]\npoints = 10\n");
    workspace.write("scripts.toml", format!("{suite}{group}"));
    let scene = library::find_scene(SCRIPTED_SCENE).expect("an embedded scene");
    let scene = fosssim_oracle::scene::read(SCRIPTED_SCENE, scene).expect("a scene").scene;
    let trace = student::record_trace(&scene, Student::default()).expect("a trace");
    let write = |bytes: &[u8]| {
        let octal: String = bytes.iter().map(|byte| format!("\\{byte:03o}")).collect();
        format!("printf '{octal}' > trace.bin")
    };
    let (right, half) = (write(&trace), write(&trace[..trace.len() / 2]));
    let submit = |&(name, commands): &(&str, &str)| {
        let path = format!("submissions/{name}");
        workspace.write(&path, format!("#!/bin/sh\n{}\n", commands.replace("RIGHT", &right).replace("HALF", &half)));
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        std::fs::set_permissions(workspace.path(&path), mode).expect("a mode");
        path
    };
    programs.iter().map(submit).collect()
}

/// Returns the submission, verdict and points of every row of a grades.csv.
fn rows(csv: &[u8]) -> Vec<(String, String, String)> {
    let mut reader = csv::Reader::from_reader(csv);
    let row = |record: csv::StringRecord| (record[0].to_owned(), record[1].to_owned(), record[2].to_owned());
    reader.records().map(|record| row(record.expect("a row"))).collect()
}

#[test]
fn a_right_and_a_wrong_program_get_their_reports() {
    let Some(workspace) = workspace() else { return };
    submit(&workspace, &["", "pe-square-no-eh"]);
    let program = "submissions/fosssim-sample";
    let run = workspace.run(["grade", program, "--suite", "suite.toml", "--format", "csv", "--timings"]);
    assert_eq!(run.code, Some(0), "{}", run.shown());
    assert!(run.out().lines().skip(1).all(|line| line.contains(",AC,")), "{}", run.shown());
    let seconds = |part: &str| -> f64 {
        let row = run.err().lines().find_map(|line| line.trim().strip_prefix(part)).expect("a row").to_owned();
        row.split_whitespace().next().and_then(|cell| cell.parse().ok()).expect("seconds")
    };
    let parts =
        ["programs", "the sandbox's processes", "starting runs", "judging", "reports and the rest"].map(seconds);
    // A part may be 0 s, because it is rounded to milliseconds.
    assert!(parts.iter().sum::<f64>() <= seconds("together") + 0.01, "{parts:?}: {}", run.shown());
    let run = workspace.run([
        "grade",
        "submissions/fosssim-sample.pe-square-no-eh",
        "--suite",
        "suite.toml",
        "--format=gradescope=results.json",
        "--format=junit=junit.xml",
        "--format=text",
    ]);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    assert!(run.out().contains("overlap polynomial of particle"), "{}", run.shown());
    assert!(run.out().contains("coefficient of t^2"), "{}", run.shown());
    assert!(run.out().contains("likely mistake: "), "{}", run.shown());
    let results: serde_json::Value = serde_json::from_slice(&workspace.read("results.json")).expect("JSON");
    assert!(results["score"].as_f64().expect("a score") < 20.0);
    assert!(String::from_utf8(workspace.read("junit.xml")).expect("text").contains("<failure"));
    assert!(!workspace.exists("fosssim-grades"), "one program leaves nothing behind");
}

#[test]
fn against_recordings_right_programs_pass_and_wrong_ones_do_not() {
    let Some(workspace) = workspace() else { return };
    let submissions = submit(&workspace, &["", "response-half-plane-spares-fixed"]);
    let scene = "HalfPlaneTests/moving-fixed-ball-and-impulses";
    for (submission, code) in submissions.iter().zip([0, 1]) {
        let run = workspace.run(["grade", submission, "--scene", scene, "--recorded"]);
        assert_eq!(run.code, Some(code), "{}", run.shown());
    }
    let right = workspace.run(["grade", &submissions[0], "--suite", "suite.toml", "--recorded"]);
    assert_eq!(right.code, Some(0), "{}", right.shown());
}

#[test]
fn the_fair_rules_count_unless_somebody_says_otherwise() {
    let Some(workspace) = workspace() else { return };
    let scaled = submit(&workspace, &["scale-1000"]).remove(0);
    let trailing = submit_scripts(&workspace, &[("trailing-bytes", "RIGHT; printf '12345678' >> trace.bin")]).remove(0);
    workspace.write("plain.toml", SUITE.replacen("rules = \"both\"\n", "", 1));
    let verdict = |submission: &str, more: &[&str]| {
        let fixed = ["grade", submission, "--format", "csv"];
        let run = workspace.run(fixed.iter().chain(more));
        let rows = csv::Reader::from_reader(&run.stdout[..]).into_records();
        let mut codes: Vec<_> = rows.map(|row| row.expect("a row")[3].to_owned()).collect();
        codes.sort();
        codes.dedup();
        (codes.join(" "), run)
    };
    let scene = ["--scene", SCRIPTED_SCENE];
    for suite in [&["--suite", "plain.toml"][..], &scene] {
        assert_eq!(verdict(&scaled, suite).0, "AC", "{suite:?}");
    }
    let (codes, run) = verdict(&trailing, &scene);
    assert_eq!(codes, "BT", "{}", run.shown());
    assert!(run.out().contains("trailing_bytes"), "where the original differs is told: {}", run.shown());
    assert_eq!(verdict(&trailing, &[&scene[..], &["--rules", "parity"]].concat()).0, "AC");
    let recorded = verdict(&trailing, &[&scene[..], &["--recorded"]].concat());
    assert_eq!(recorded.0, "AC", "recordings know parity only: {}", recorded.1.shown());
}

#[test]
fn the_rules_decide_the_points_and_reports_say_where_they_differ() {
    let Some(workspace) = workspace() else { return };
    submit(&workspace, &["scale-1000"]);
    let grade = |rules: &[&str]| {
        let fixed = ["grade", "submissions/fosssim-sample.scale-1000", "--suite", "suite.toml", "--output", "out"];
        workspace.run(fixed.iter().chain(rules))
    };
    let both = grade(&[]);
    assert_eq!(both.code, Some(1), "{}", both.shown());
    assert!(both.out().contains("the rule books differ: the original rejects it, but the fair rules accept it"));
    assert!(both.out().contains("by the original's rules (the fair rules differ in "), "{}", both.shown());
    let scenes = String::from_utf8(workspace.read("out/scenes.csv")).expect("text");
    assert!(scenes.contains(",absolute_coefficients"), "{scenes}");
    // In the same folder, results of other rules are not used for these rules.
    let fair = grade(&["--rules", "fair"]);
    assert_eq!(fair.code, Some(0), "{}", fair.shown());
    let parity = grade(&["--rules", "parity"]);
    assert_eq!(parity.code, Some(1), "{}", parity.shown());
    assert!(!["books differ", "rules differ"].iter().any(|words| parity.out().contains(words)), "{}", parity.shown());
    let recorded = grade(&["--rules", "fair", "--recorded"]);
    assert_eq!(recorded.code, Some(2), "{}", recorded.shown());
}

#[test]
fn hints_decide_how_much_a_report_tells_students() {
    let Some(workspace) = workspace() else { return };
    submit(&workspace, &["pe-square-no-eh"]);
    let told_to = |reader: &str, level: &str| {
        workspace.write("hints.toml", SUITE.replace("hints = \"full\"", &format!("hints = \"{level}\"")));
        let program = "submissions/fosssim-sample.pe-square-no-eh";
        let run = workspace.run(["grade", program, "--suite", "hints.toml", "--format", "json", "--for", reader]);
        assert_eq!(run.code, Some(1), "{}", run.shown());
        let json: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
        let groups = json["grades"][0]["groups"].as_array().expect("groups").clone();
        let scenes = groups.into_iter().flat_map(|group| group["scenes"].as_array().expect("scenes").clone());
        scenes.into_iter().find(|scene| scene["verdict"] == "wrong answer").expect("a wrong scene")
    };
    let [none, place, what, full] = ["none", "where", "what", "full"].map(|level| told_to("student", level));
    let staff = told_to("staff", "none");
    assert_eq!((&staff["details"], &staff["explanations"]), (&full["details"], &full["explanations"]), "staff see all");
    assert_eq!((&none["summary"], &none["details"]), (&"the trace is wrong".into(), &serde_json::json!([])));
    assert_eq!(place["explanations"], serde_json::json!([]));
    assert!(place["details"][0].as_str().expect("a line").contains("edge"), "{place:#}");
    assert_eq!(what["details"], place["details"]);
    assert_eq!(what["explanations"][0]["key"], "pe-square-no-eh", "{what:#}");
    assert_eq!(what["explanations"][0]["details"], serde_json::json!([]));
    assert_ne!(full["details"], place["details"]);
    assert_ne!(full["explanations"][0]["example"], serde_json::Value::Null, "{full:#}");
}

#[test]
fn hostile_programs_get_their_verdicts_and_an_interrupted_batch_ends_the_same() {
    let Some(workspace) = workspace() else { return };
    let flood = format!("RIGHT; {FLOOD}");
    let cast = [
        ("crash-midway", "HALF; kill -ABRT $$", "run-time error"),
        ("endless-loop", "HALF; while :; do :; done", "time limit"),
        ("escape-codes", r"RIGHT; printf '\033[31;1mred\033[m \033]0;title\007' >&2", "accepted"),
        ("exit-one", "RIGHT; exit 1", "run-time error"),
        ("flood-stdout", &flood, "accepted"),
        ("forged-verdict", "HALF; echo 'Overall success: Passed.'", "bad trace"),
        ("leaves-children", "RIGHT; sleep 60 &", "sandbox violation"),
        ("no-output", ":", "no output"),
        ("right", "RIGHT", "accepted"),
        ("sleep-forever", SLEEP, "time limit"),
        ("trailing-bytes", "RIGHT; printf '12345678' >> trace.bin", "accepted"),
        ("truncated-trace", "HALF", "bad trace"),
    ];
    let submissions = submit_scripts(&workspace, &cast.map(|(name, commands, _)| (name, commands)));
    let words = |output: &'static str| {
        let options = ["--suite", "scripts.toml", "--output", output].map(str::to_owned);
        ["grade".to_owned()].into_iter().chain(submissions.clone()).chain(options)
    };
    let whole = workspace.run(words("whole"));
    assert_eq!(whole.code, Some(1), "{}", whole.shown());
    let verdicts: Vec<_> =
        rows(&workspace.read("whole/grades.csv")).into_iter().map(|(_, verdict, _)| verdict).collect();
    assert_eq!(verdicts, cast.map(|(.., verdict)| verdict), "{}", whole.shown());
    assert!(!whole.out().contains('\u{1b}') && !whole.err().contains('\u{1b}'), "no escape code gets through");
    let log = workspace.read("whole/logs/escape-codes.log");
    assert!(!log.contains(&0x1b), "{}", String::from_utf8_lossy(&log));

    // The grading is interrupted when the first results are stored, twice, and then completed.
    for kept in [3, 8] {
        let mut child = workspace
            .command()
            .args(words("parts"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        let lines = || {
            let journal = std::fs::read(workspace.path("parts/journal.jsonl")).unwrap_or_default();
            journal.iter().filter(|byte| **byte == b'\n').count()
        };
        while lines() < kept && child.try_wait().expect("a state").is_none() {
            std::thread::sleep(Duration::from_millis(5));
        }
        let stopped = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
        assert!(stopped.success());
        assert_eq!(child.wait().expect("ended").code(), Some(130));
    }
    let resumed = workspace.run(words("parts"));
    assert_eq!(resumed.code, Some(1), "{}", resumed.shown());
    assert!(resumed.err().contains(" results from parts"), "{}", resumed.shown());
    let mut resumed = rows(&workspace.read("parts/grades.csv"));
    let mut whole = rows(&workspace.read("whole/grades.csv"));
    // A program that is killed may come a different distance with its first scene. Verdicts and whole points may not
    // differ.
    for row in resumed.iter_mut().chain(&mut whole) {
        row.2 = row.2.split('.').next().unwrap_or_default().to_owned();
    }
    assert_eq!(resumed, whole);
    let journal = String::from_utf8(workspace.read("parts/journal.jsonl")).expect("text");
    let mut keys: Vec<_> =
        journal.lines().map(|line| line.split("\"key\":\"").nth(1).expect("a key")[..32].to_owned()).collect();
    let lines = keys.len();
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), lines, "nothing was run twice");
}

/// The output is exactly as long as the limit, so both the program and the grader may end the run.
#[test]
fn a_flood_behind_the_trace_gets_one_verdict_however_busy_the_machine_is() {
    let Some(workspace) = workspace() else { return };
    let program = format!("RIGHT; {{ {FLOOD}; }} >> trace.bin");
    let flood = submit_scripts(&workspace, &[("flood", &program)]).remove(0);
    let suite = String::from_utf8(workspace.read("scripts.toml")).expect("text");
    workspace.write("flood.toml", suite.replace("[limits]", "[limits]\ntrace_mib = 16"));
    for (rules, verdict) in [("both", "AC"), ("fair", "BT")] {
        for jobs in ["1", "3", "12"] {
            let run = workspace.run([
                "grade",
                &flood,
                "--suite=flood.toml",
                "--rules",
                rules,
                "--jobs",
                jobs,
                "--format=csv",
            ]);
            let rows = csv::Reader::from_reader(&run.stdout[..]).into_records();
            let verdicts: Vec<_> = rows.map(|row| row.expect("a row")[3].to_owned()).collect();
            assert!(!verdicts.is_empty() && verdicts.iter().all(|one| one == verdict), "{jobs} jobs: {}", run.shown());
        }
    }
}

/// These are copies, as students submit them, because a link may lead to another student's submission.
#[test]
fn a_folder_with_the_program_is_one_submission_and_results_and_links_are_none() {
    let Some(workspace) = workspace() else { return };
    let script = "#!/bin/sh\nexit 3\n";
    for file in ["one/alice/FOSSSim", "one/alice/src/x.sh", "one/bob/FOSSSim", "one/carol"] {
        workspace.write(file, script);
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        std::fs::set_permissions(workspace.path(file), mode).expect("a mode");
    }
    symlink("bob", workspace.path("one/mallory")).expect("a link");
    workspace.write("one/.dotted/FOSSSim", script);
    std::fs::hard_link(workspace.path("one/carol"), workspace.path("one/thief")).expect("a link");
    let alone = workspace.run(["grade", "one/alice", "--suite", "suite.toml", "--quiet"]);
    assert_eq!((alone.code, alone.out().lines().count()), (Some(1), 1), "{}", alone.shown());
    assert!(alone.out().starts_with("alice: run-time error"), "{}", alone.shown());
    let names = |run: &crate::workspace::Run| {
        assert_eq!(run.code, Some(1), "{}", run.shown());
        let rows = rows(&workspace.read("one/grades/grades.csv"));
        rows.into_iter().map(|(name, verdict, _)| format!("{name} {verdict}")).collect::<Vec<_>>()
    };
    // If a file has two names, its owner is unknown. Both entries are graded, and staff get a warning.
    let passed_over = |name: &str| format!("{name} not graded");
    let graded = ["alice", "bob", "carol", "thief"].map(|name| format!("{name} run-time error"));
    let expected =
        |others: &[&str]| [&graded[..], &others.iter().map(|name| passed_over(name)).collect::<Vec<_>>()].concat();
    for others in [&[".dotted", "mallory"][..], &[".dotted", "grades", "mallory"]] {
        // In the second run the folder for results is among the submissions.
        let class = workspace.run(["grade", "one", "--suite", "suite.toml", "--output", "one/grades"]);
        assert_eq!(names(&class), expected(others));
        assert!(class.err().contains("skipped mallory: this is a link"), "{}", class.shown());
        assert!(class.err().contains("skipped .dotted: the name begins with a dot"), "{}", class.shown());
        // The output has a row for each submission and a summary of the class. The scenes are in the folder, and are
        // shown on request.
        assert!(class.out().lines().count() < 25 && class.out().contains("Class: 4 submissions"), "{}", class.out());
    }
    let whole = workspace.run(["grade", "one", "--suite", "suite.toml", "--output", "one/grades", "--verbose"]);
    assert!(whole.out().contains("ImpulsesTests/off-centre-on-turning-edge"), "{}", whole.out());
    let other = workspace.run(["grade", "one", "--suite", "suite.toml", "--output", "other"]);
    assert!(other.err().contains("skipped grades: the folder contains the results"), "{}", other.shown());
    let table = String::from_utf8(workspace.read("other/grades.csv")).expect("text");
    assert!(table.contains("of ") && table.contains("the program exited with code 3"), "the reason: {table}");
    assert!(String::from_utf8(workspace.read("other/class.txt")).expect("text").starts_with("Class: 4 submissions"));
}

#[test]
fn a_part_of_a_suite_and_the_failed_scenes_are_graded_again() {
    let Some(workspace) = workspace() else { return };
    let submission = submit(&workspace, &["pe-square-no-eh"]).remove(0);
    let grade = |more: &[&str]| {
        let mut command = workspace.command();
        command.args(["grade", &submission, "--suite", "suite.toml"]).args(more);
        finish(command.env("XDG_CACHE_HOME", workspace.path("cache")))
    };
    let none = grade(&["--failed"]);
    assert_eq!(none.code, Some(2), "{}", none.shown());
    assert!(none.err().contains("there is no earlier run of this grading"), "{}", none.shown());
    let whole = grade(&["--format", "csv"]);
    let failing = |run: &crate::workspace::Run| {
        let rows = csv::Reader::from_reader(&run.stdout[..]).into_records();
        rows.map(|row| row.expect("a row"))
            .filter(|row| &row[3] != "AC")
            .map(|row| row[2].to_owned())
            .collect::<Vec<_>>()
    };
    let wrong = failing(&whole);
    assert!(!wrong.is_empty() && wrong.len() < whole.out().lines().count() - 1, "{}", whole.shown());
    let again = grade(&["--failed", "--format", "csv"]);
    assert_eq!((failing(&again), again.out().lines().count() - 1), (wrong.clone(), wrong.len()), "{}", again.shown());
    let text = grade(&["--failed"]).out();
    let before = format!("0 of {} scene", wrong.len());
    assert!(text.contains(&before) && text.contains("no other scenes ran") && !text.contains("fixing it"), "{text}");
    // The last lines name the scene and a command, and that command works.
    let text = grade(&["--hints", "what"]);
    let command = text.out().lines().find_map(|line| line.trim().strip_prefix("$ fosssim-oracle ").map(str::to_owned));
    let command = command.unwrap_or_else(|| panic!("{}", text.shown()));
    assert!(command.contains(&format!("--scene {} --hints full", wrong[0])), "{command}");
    let closer = workspace.run(command.split(' '));
    assert_eq!(closer.code, Some(1), "{}", closer.shown());
    assert!(closer.out().contains("1 of ") && closer.out().contains("expected"), "{}", closer.shown());
    let verdict_only = grade(&["--hints", "none", "--scene", &wrong[0]]);
    assert!(!verdict_only.out().contains("likely mistake"), "{}", verdict_only.shown());
    let missing = grade(&["--scene", "no-such-scene"]);
    assert_eq!(missing.code, Some(2), "{}", missing.shown());
    // `check` accepts a kept trace. Only whole suites have tables.
    let kept = grade(&["--scene", &wrong[0], "--keep-traces", "--output", "out"]);
    assert!(!workspace.exists("out/grades.csv") && kept.err().contains("only a part was graded"), "{}", kept.shown());
    let shown = kept.out();
    let command = shown.lines().find_map(|line| line.trim().strip_prefix("$ fosssim-oracle check "));
    let words = command.unwrap_or_else(|| panic!("{}", kept.shown())).split(' ');
    let checked = workspace.run(["check"].into_iter().chain(words));
    assert_eq!(checked.code, Some(1), "{}", checked.shown());
}

#[test]
fn reports_do_not_overwrite_each_other_nor_the_summary_of_a_step() {
    let Some(workspace) = workspace() else { return };
    workspace.write("FOSSSim", "#!/bin/sh\r\nexit 0\r\n");
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    std::fs::set_permissions(workspace.path("FOSSSim"), mode).expect("a mode");
    let twice = workspace.run(["grade", "FOSSSim", "--format=json=x", "--format=csv=./x"]);
    assert_eq!(twice.code, Some(2), "{}", twice.shown());
    assert!(twice.err().contains("two formats have the same file") && !workspace.exists("x"), "{}", twice.shown());
    workspace.write("summary.md", "what a step wrote before\n");
    let mut command = workspace.command();
    command
        .args(["grade", "FOSSSim", "--suite", "suite.toml"])
        .arg(format!("--format=markdown={}", workspace.path("summary.md").display()));
    let run = finish(command.env("GITHUB_STEP_SUMMARY", workspace.path("summary.md")));
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let summary = String::from_utf8(workspace.read("summary.md")).expect("text");
    assert!(summary.starts_with("what a step wrote before\n### FOSSSim: unusable submission"), "{summary}");
    assert!(summary.contains("carriage return"), "{summary}");
}

#[test]
fn two_graders_do_not_share_a_folder() {
    let Some(workspace) = workspace() else { return };
    submit(&workspace, &[""]);
    std::fs::create_dir(workspace.path("out")).expect("a folder");
    let _held = fosssim_oracle::suite::results::FolderResults::open(&workspace.path("out"), false).expect("a journal");
    let run = workspace.run(["grade", "submissions/fosssim-sample", "--suite", "suite.toml", "--output", "out"]);
    assert_eq!(run.code, Some(2), "{}", run.shown());
    assert!(run.err().contains("another grader is using out"), "{}", run.shown());
}

#[test]
fn suites_are_written_checked_and_explained() {
    let workspace = Workspace::new();
    let template = workspace.run(["suite", "init"]);
    workspace.write("course.toml", &template.stdout);
    let check = workspace.run(["suite", "check", "course.toml"]);
    assert_eq!(check.code, Some(0), "{}", check.shown());
    assert!(check.out().contains("ContinuousTimeTests: 35 points"), "{}", check.out());
    let list: serde_json::Value =
        serde_json::from_slice(&workspace.run(["suite", "list", "--format", "json"]).stdout).expect("JSON");
    let text = workspace.run(["suite", "list"]).out();
    let suites = list["suites"].as_array().expect("a list");
    assert_eq!((suites.len(), suites[0]["default"].as_bool()), (text.lines().count(), Some(true)), "{list}");
    for (suite, line) in suites.iter().zip(text.lines()) {
        let (name, title) = (suite["name"].as_str().expect("a name"), suite["title"].as_str().expect("a title"));
        assert!(line.starts_with(name) && line.contains(title), "{line}");
        let checked = workspace.run(["suite", "check", name]).out();
        assert!(checked.contains(&format!("{} scenes", suite["scenes"])), "{checked}");
    }
    let scenes = workspace.run(["scene", "list"]);
    assert!(scenes.out().lines().count() >= 48 && scenes.out().starts_with("asset:"), "{}", scenes.out());
}

#[test]
fn the_demo_ends_well() {
    let Some(workspace) = workspace() else { return };
    let run = workspace.run(["demo"]);
    assert_eq!(run.code, Some(0), "{}", run.shown());
    assert!(run.out().ends_with("for a browser: fosssim-demo.html\n"), "{}", run.out());
    let page = String::from_utf8(workspace.read("fosssim-demo.html")).expect("text");
    assert!(
        page.contains("Likely mistake") && page.contains("data-scene=") && page.len() < 3_000_000,
        "{}",
        page.len()
    );
}

#[test]
fn a_course_script_counts_with_the_drop_in() {
    let workspace = Workspace::new();
    if Command::new("python3").arg("--version").output().is_err() {
        skip(Need::Python, "there is no python3");
        return;
    }
    for name in ["SimpleTests/two-balls-overlap-at-step-end", "ContinuousTimeTests/spinning-edge-sweeps-balls"] {
        let scene = fosssim_oracle::suite::library::find_scene(name).expect("an embedded scene");
        workspace.write(format!("scenes/{name}.xml"), scene);
    }
    symlink(env!("CARGO_BIN_EXE_fosssim-oracle"), workspace.path("FOSSSimOracle")).expect("a link");
    let count = |program: &Path| {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("integrations/course/run_tests.py");
        let mut run = Command::new("python3");
        run.arg(script).arg("--program").arg(program).arg("--oracle").arg(workspace.path("FOSSSimOracle"));
        run.arg(workspace.path("scenes")).stdout(Stdio::piped());
        finish(&mut run)
    };
    let right = count(Path::new(env!("CARGO_BIN_EXE_fosssim-sample")));
    assert!(right.out().ends_with("2 passed, 0 failed\n"), "{}", right.shown());
    let wrong = workspace.path("fosssim-sample.pe-square-no-eh");
    symlink(env!("CARGO_BIN_EXE_fosssim-sample"), &wrong).expect("a link");
    let wrong = count(&wrong);
    assert!(wrong.out().ends_with("1 passed, 1 failed\n"), "{}", wrong.shown());
}

#[test]
fn a_grading_that_is_stopped_by_the_platform_keeps_its_partial_results() {
    let Some(workspace) = workspace() else { return };
    let mut submissions = submit(&workspace, &[""]);
    submissions.extend(submit_scripts(&workspace, &[("sleep-forever", SLEEP)]));
    let mut child = workspace
        .command()
        .arg("grade")
        .args(submissions)
        .args(["--suite", "suite.toml", "--output", "out", "--format", "json=grades.json"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("started");
    while std::fs::read(workspace.path("out/journal.jsonl")).unwrap_or_default().is_empty() {
        assert!(child.try_wait().expect("a state").is_none(), "it ended before it was stopped");
        std::thread::yield_now();
    }
    // `timeout` sends a signal to the program and its group, so two signals arrive.
    for _ in 0..2 {
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
        assert!(kill.success());
    }
    assert_eq!(child.wait().expect("ended").code(), Some(130));
    let grades: serde_json::Value = serde_json::from_slice(&workspace.read("grades.json")).expect("JSON");
    let text = grades.to_string();
    assert!(text.contains("\"not run\"") && text.contains("\"accepted\""), "{text}");
}
