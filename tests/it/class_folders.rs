//! Hostile folders of classes, traces, results and shards. No submission is omitted without a message, no submission
//! gets another one's points, links are not followed, and the grader never waits for other programs.
use crate::workspace::{BOUNCE, Run, Workspace, trace_of};
use fosssim_testing::{Need, skip};
use std::{
    ffi::OsStr,
    fs,
    os::unix::{
        ffi::OsStrExt,
        fs::{PermissionsExt, chown, symlink},
    },
    path::Path,
    process::Command,
    time::{Duration, Instant},
};

const SUITE: &str =
    "schema = 1\nname = \"test\"\n[[group]]\nname = \"own\"\npoints = 10\nscenes = [\"scenes/*.xml\"]\n";

/// Returns a workspace with a suite of one small scene.
fn workspace() -> Workspace {
    let workspace = Workspace::new();
    workspace.write("suite.toml", SUITE);
    workspace.write("scenes/bounce.xml", BOUNCE);
    workspace
}

/// Returns the workspace if this machine can run programs.
fn with_programs() -> Option<Workspace> {
    let workspace = workspace();
    let doctor = workspace.run(["doctor"]);
    if doctor.code == Some(0) {
        return Some(workspace);
    }
    skip(Need::Sandbox, doctor.out().lines().last().unwrap_or_default());
    None
}

/// Writes a program that exits with this code.
fn program(workspace: &Workspace, name: impl AsRef<Path>, code: u8) {
    workspace.write(&name, format!("#!/bin/sh\nexit {code}\n"));
    fs::set_permissions(workspace.path(name), fs::Permissions::from_mode(0o755)).expect("a mode");
}

fn grade(workspace: &Workspace, what: &[&str]) -> Run {
    workspace.run([&["grade", "--suite", "suite.toml"], what].concat())
}

fn fifo(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("mkfifo").success());
}

fn table(workspace: &Workspace, file: &str) -> Vec<csv::StringRecord> {
    let bytes = workspace.read(file);
    csv::Reader::from_reader(&bytes[..]).into_records().map(|row| row.expect("a row")).collect()
}

/// Returns the names of submissions that imitate each other or other files.
fn hostile_names() -> Vec<Vec<u8>> {
    let long: [Vec<u8>; 2] = [vec![b'x'; 255], "\u{754c}".repeat(85).into_bytes()];
    let names: [&[u8]; 34] = [
        b"alice",
        b"alice\r",
        b"alice\\r",
        b"alice ",
        b"alice\t",
        b"carol x",
        b"carol\tx",
        b"carol\nx",
        b"carol  x",
        b"-rf",
        b"=cmd",
        b"'=cmd",
        b"a,b",
        b"a\"b",
        b"con",
        b"con.",
        b"NUL",
        b"a|b",
        b"<b>bold",
        b"%3A",
        b"::error::x",
        b"x\xff",
        b"x\xfe",
        b"x\\xff",
        b"\x1b[31mred",
        "bob\u{200b}".as_bytes(),
        "bob\u{202e}".as_bytes(),
        "bob\u{3164}".as_bytes(),
        "bob\u{fe0f}".as_bytes(),
        "bob\u{e0100}".as_bytes(),
        "\u{e9}".as_bytes(),
        "e\u{301}".as_bytes(),
        "\u{5d0}\u{5d1}\u{5d2}".as_bytes(),
        "\u{ff1d}1+1".as_bytes(),
    ];
    names.into_iter().map(<[u8]>::to_vec).chain(long).collect()
}

#[test]
fn every_entry_of_a_class_has_one_row_and_a_name_of_its_own() {
    let Some(workspace) = with_programs() else { return };
    let names = hostile_names();
    for name in &names {
        program(&workspace, Path::new("class").join(OsStr::from_bytes(name)), 3);
    }
    let formats = ["json", "junit", "github", "markdown", "csv", "text"];
    let formats: Vec<String> = formats.iter().map(|format| format!("--format={format}={format}.out")).collect();
    let mut arguments = vec!["class", "--output", "grades"];
    arguments.extend(formats.iter().map(String::as_str));
    let run = grade(&workspace, &arguments);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let rows = table(&workspace, "grades/grades.csv");
    let mut seen: Vec<&str> = rows.iter().map(|row| &row[0]).collect();
    assert_eq!(seen.len(), names.len());
    for (name, plain) in [("alice", true), ("alice\\r", true), ("'=cmd", true), ("''=cmd", true), ("=cmd", false)] {
        assert_eq!(seen.contains(&name), plain, "{name}");
    }
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), names.len(), "two rows of one name");
    // An import may change cells: it may remove spaces around names and ignore case.
    let mut imported: Vec<String> = seen.iter().map(|name| name.trim().to_lowercase()).collect();
    imported.sort_unstable();
    imported.dedup();
    assert_eq!(imported.len(), names.len());
    for folder in ["logs", "reports"] {
        assert_eq!(fs::read_dir(workspace.path("grades").join(folder)).expect("a folder").count(), names.len());
    }
    for file in
        ["text.out", "markdown.out", "github.out", "junit.out", "csv.out", "grades/index.html", "grades/class.txt"]
    {
        let text = String::from_utf8(workspace.read(file)).expect("text");
        let hidden = |c: char| {
            c != '\n' && c != '\r' && c.is_control() || "\u{200b}\u{202e}\u{3164}\u{fe0f}\u{e0100}".contains(c)
        };
        assert!(!text.contains(hidden), "{file}");
        let is_plain = ["csv.out", "text.out", "github.out", "grades/class.txt"].contains(&file);
        assert!(is_plain || !text.contains("<b>bold"), "{file}");
    }
    let annotations = String::from_utf8(workspace.read("github.out")).expect("text");
    assert!(annotations.lines().all(|line| line.starts_with("::error title=") || line.starts_with("::warning title=")));
    // A second run finds all submissions again under the same names.
    let again = grade(&workspace, &["class", "--output", "grades"]);
    assert!(again.err().contains(&format!("reused {0} of {0} results", names.len())), "{}", again.shown());
    // No name makes the table wider or breaks its lines.
    let widest = again.out().lines().map(|line| line.chars().count()).max();
    assert!(widest < Some(160), "{widest:?}\n{}", again.out());
    assert_eq!(
        again.out().lines().filter(|line| line.contains("run-time error")).count(),
        names.len(),
        "{}",
        again.out()
    );
}

#[test]
fn nobody_is_passed_over_in_silence() {
    let Some(workspace) = with_programs() else { return };
    for name in ["class/alice", "class/bob/FOSSSim", "class/.hidden/FOSSSim", "class/.dotted"] {
        program(&workspace, name, 3);
    }
    workspace.write("class/readme.txt", "text");
    workspace.write("class/__MACOSX/._bob", "attributes");
    fs::create_dir(workspace.path("class/empty")).expect("a folder");
    symlink("alice", workspace.path("class/link")).expect("a link");
    fifo(&workspace.path("class/fifo"));
    let passed_over = [".dotted", ".hidden", "__MACOSX", "fifo", "link", "readme.txt"];
    let formats = ["json", "junit", "github", "markdown", "csv", "text"];
    let formats: Vec<String> = formats.iter().map(|format| format!("--format={format}={format}.out")).collect();
    let mut arguments = vec!["class", "--output", "grades"];
    arguments.extend(formats.iter().map(String::as_str));
    let run = grade(&workspace, &arguments);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let files = ["json", "junit", "github", "markdown", "csv", "text"].map(|format| format!("{format}.out"));
    let others =
        ["grades.csv", "scenes.csv", "grades.jsonl", "class.txt", "index.html"].map(|name| format!("grades/{name}"));
    for file in files.iter().chain(&others) {
        let text = String::from_utf8(workspace.read(file)).expect("text").replace('\\', "");
        // That file contains the class in numbers.
        let graded: &[&str] = if file.ends_with("class.txt") { &[] } else { &["alice", "bob", "empty"] };
        for name in passed_over.iter().chain(graded) {
            assert!(text.contains(name), "{file} does not tell of {name}\n{text}");
        }
        assert!(text.contains("begins with a dot"), "{file}");
    }
    let rows = table(&workspace, "grades/grades.csv");
    assert_eq!(rows.len(), 9);
    for row in rows.iter().filter(|row| passed_over.contains(&&row[0])) {
        assert_eq!((&row[1], &row[2], &row[3]), ("not graded", "", ""));
    }
    assert!(rows.iter().any(|row| &row[0] == "empty" && &row[1] == "unusable submission" && &row[2] == "0"));
    // For a single submission, the report contains its grade.
    let alone = workspace.path("class/alice");
    fs::create_dir(workspace.path("single")).expect("a folder");
    fs::rename(alone, workspace.path("single/alice")).expect("moved");
    program(&workspace, "single/.late", 3);
    for format in ["text", "json", "junit", "github", "markdown", "csv", "gradescope", "prairielearn", "html"] {
        let run = grade(&workspace, &["single", "--format", format]);
        assert!(run.out().contains(".late"), "{format}: {}", run.shown());
    }
}

/// Platforms drop permissions, pack uploads, and put them into folders. A decompression bomb only affects its own
/// submission.
#[test]
fn a_class_as_platforms_export_it_is_graded() {
    let Some(workspace) = with_programs() else { return };
    workspace.write("class/ada_123_FOSSSim", "#!/bin/sh\nexit 3\n");
    workspace.write("hw/FOSSSim", "#!/bin/sh\nexit 3\n");
    let pack = |archive: &str, what: &str| {
        fs::create_dir_all(workspace.path(archive).parent().expect("a folder")).expect("made");
        let (archive, from) = (workspace.path(archive), workspace.path("."));
        let packing = Command::new("tar").arg("czf").arg(archive).arg("-C").arg(from).arg(what).status();
        assert!(packing.expect("tar").success());
    };
    pack("class/bob.tar.gz", "hw");
    pack("class/cleo_assignsubmission_file/hw.tgz", "hw");
    fs::File::create(workspace.path("zeros")).expect("a file").set_len(100 << 20).expect("zeros");
    pack("class/bomb.tar.gz", "zeros");
    workspace.write("class/notes.pdf", "%PDF-1.7");
    workspace.write("class/zoe/FOSSSim", "#!/bin/sh\nexit 3\n");
    let run = grade(&workspace, &["class", "--output", "grades"]);
    let rows = table(&workspace, "grades/grades.csv");
    let found: Vec<(&str, &str)> = rows.iter().map(|row| (&row[0], &row[1])).collect();
    let ran = "run-time error";
    let expected = [
        ("ada_123_FOSSSim", ran),
        ("bob.tar.gz", ran),
        ("bomb.tar.gz", "unusable submission"),
        ("cleo_assignsubmission_file", ran),
        ("zoe", ran),
        ("notes.pdf", "not graded"),
    ];
    assert_eq!(found, expected, "{}", run.shown());
    assert!(run.err().contains("notes.pdf: this is neither a program nor an archive"), "{}", run.shown());
    // A second run starts no program again.
    let again = grade(&workspace, &["class", "--output", "grades"]);
    assert!(again.err().contains("reused 4 of 5 results"), "{}", again.shown());
}

#[test]
fn a_second_name_of_a_file_takes_nobodys_points() {
    let Some(workspace) = with_programs() else { return };
    for name in ["alice", "bob"] {
        program(&workspace, format!("class/{name}/FOSSSim"), 3);
    }
    program(&workspace, "class/carol", 3);
    let link = |from: &str, to: &str| fs::hard_link(workspace.path(from), workspace.path(to)).expect("a hard link");
    // The folder is like a backup made by `cp -al`.
    fs::create_dir(workspace.path("backup")).expect("a folder");
    link("class/alice/FOSSSim", "backup/alice");
    link("class/carol", "backup/carol");
    let verdicts = |expected: &[(&str, &str)]| {
        let run = grade(&workspace, &["class", "--output", "grades"]);
        let rows = table(&workspace, "grades/grades.csv");
        let found: Vec<(&str, &str)> = rows.iter().map(|row| (&row[0], &row[1])).collect();
        assert_eq!(found, expected, "{}", run.shown());
        run
    };
    let fine = "run-time error";
    verdicts(&[("alice", fine), ("bob", fine), ("carol", fine)]);
    // If both names are within the class, the owner is unknown. No submission loses points, and staff get a warning.
    link("class/carol", "class/thief");
    let run = verdicts(&[("alice", fine), ("bob", fine), ("carol", fine), ("thief", fine)]);
    assert!(run.err().contains("one file with several names (hard links): carol, thief"), "{}", run.shown());
    let json = String::from_utf8(workspace.read("grades/grades.jsonl")).expect("text");
    assert_eq!(json.matches("the same file as another submission").count(), 2, "{json}");
    // If the owner is known, the copy gets no points, and the original loses nothing.
    fs::create_dir(workspace.path("class/mallory")).expect("a folder");
    link("class/bob/FOSSSim", "class/mallory/FOSSSim");
    if chown(workspace.path("class/mallory"), Some(1234), None).is_ok() {
        verdicts(&[
            ("alice", fine),
            ("bob", fine),
            ("carol", fine),
            ("mallory", "unusable submission"),
            ("thief", fine),
        ]);
    }
}

#[test]
fn traces_are_reached_by_no_link() {
    let workspace = workspace();
    workspace.write("alice/scenes/bounce.bin", trace_of(BOUNCE));
    fs::create_dir(workspace.path("mallory")).expect("a folder");
    symlink("../alice/scenes", workspace.path("mallory/scenes")).expect("a link");
    fs::create_dir_all(workspace.path("eve/scenes")).expect("a folder");
    fifo(&workspace.path("eve/scenes/bounce.bin"));
    fs::create_dir_all(workspace.path("frank/scenes")).expect("a folder");
    fs::File::create(workspace.path("frank/scenes/bounce.bin")).expect("a file").set_len(1 << 40).expect("a hole");
    // A backup made of hard links does no harm.
    fs::create_dir(workspace.path("backup")).expect("a folder");
    fs::hard_link(workspace.path("alice/scenes/bounce.bin"), workspace.path("backup/bounce.bin")).expect("a link");
    fs::create_dir(workspace.path("two")).expect("a folder");
    fs::hard_link(workspace.path("alice/scenes/bounce.bin"), workspace.path("two/bounce.bin")).expect("a link");
    fs::create_dir_all(workspace.path("b/two")).expect("a folder");
    let folders = ["alice", "mallory", "eve", "frank", "two", "b/two"];
    let run = grade(&workspace, &[&["--traces", "--output", "grades", "--format", "json"], &folders[..]].concat());
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let found: Vec<(String, String)> =
        table(&workspace, "grades/grades.csv").iter().map(|row| (row[0].to_owned(), row[1].to_owned())).collect();
    let expected = [
        ("alice", "accepted"),
        ("mallory", "no output"),
        ("eve", "no output"),
        ("frank", "bad trace"),
        ("two", "accepted"),
        ("b/two", "no output"),
    ];
    assert_eq!(found, expected.map(|(name, verdict)| (name.to_owned(), verdict.to_owned())), "{}", run.shown());
    for why in ["bounce.bin is a symbolic link", "bounce.bin is a pipe"] {
        assert!(run.out().contains(why), "{}", run.shown());
    }
}

#[test]
fn a_class_is_compared_with_its_earlier_grading() {
    let workspace = workspace();
    let bytes = trace_of(BOUNCE);
    let hand_in = |alice: &[u8], bob: &[u8]| {
        workspace.write("alice/bounce.bin", alice);
        workspace.write("bob/bounce.bin", bob);
    };
    let traces = ["--traces", "alice", "bob", "--output", "grades"];
    hand_in(&bytes[..bytes.len() - 8], &bytes);
    assert_eq!(grade(&workspace, &traces).code, Some(1));
    hand_in(&bytes, &bytes[..bytes.len() - 8]);
    let compared = |words: &[&str]| grade(&workspace, &[&traces[..], words].concat());
    let run = compared(&["--compare", "grades"]);
    let text = run.out();
    let rows: Vec<Vec<&str>> = text.lines().take(3).map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(rows[0], ["submission", "points", "verdict", "before", "right", "broke", "own", "seconds"]);
    assert_eq!((&rows[1][..2], &rows[1][3..6]), (&["alice", "10"][..], &["0", "+1", "-0"][..]), "{}", run.shown());
    assert_eq!(rows[2][rows[2].len() - 6..][..3], ["10", "+0", "-1"], "{}", run.shown());
    assert!(text.contains("Since the earlier grading\n  more points: alice\n  fewer points: bob\n"), "{}", run.shown());
    let page = String::from_utf8(workspace.read("grades/index.html")).expect("text");
    assert!(page.contains(">0 <b>+10</b></td>") && page.contains(">10 <b>-10</b></td>"), "{page}");
    let page = String::from_utf8(workspace.read("grades/reports/bob.html")).expect("text");
    assert!(
        page.contains("<li>10 points before, 0 now</li><li>1 scene broke: scenes/bounce (BT)</li>"),
        "{page:.3000}"
    );
    // The folder now contains this grading, so any file of grades works.
    let run = compared(&["--compare", "grades/grades.jsonl", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&run.out()).expect("JSON");
    let expected = serde_json::json!({ "points": 10.0, "max_points": 10.0, "right": [], "broke": [], "others": [] });
    assert_eq!(json["grades"][0]["changes"], expected, "{}", run.shown());
    // Submissions that are new or missing are named.
    workspace.write("cleo/bounce.bin", &bytes);
    let run = grade(&workspace, &["--traces", "alice", "cleo", "--output", "next", "--compare", "grades"]);
    let text = run.out();
    assert!(text.contains("\nSince the earlier grading\n  new: cleo\n"), "{}", run.shown());
    assert!(text.contains("Not graded\n  bob   only the earlier grading contains it\n"), "{}", run.shown());
    let page = String::from_utf8(workspace.read("next/index.html")).expect("text");
    let change = page.split("Since the earlier grading").nth(1).expect("a section");
    assert!(change.contains("<b>1</b> new") && page.contains("<bdi>bob</bdi>"), "{page}");
    let refused = compared(&["--compare", "suite.toml"]);
    assert!(refused.code == Some(2) && refused.err().contains("suite.toml contains no grades"), "{}", refused.shown());
}

#[test]
fn a_folder_has_defaults_of_its_own() {
    let workspace = workspace();
    workspace.write("alice/bounce.bin", trace_of(BOUNCE));
    workspace.write("fosssim.toml", "suite = 'suite.toml'\noutput = 'results'\n");
    let run = workspace.run(["grade", "--traces", "alice", "--quiet"]);
    assert!(run.code == Some(0) && workspace.exists("results/grades.csv"), "{}", run.shown());
    let typed = workspace.run(["grade", "--traces", "alice", "--suite", "t1m1"]);
    assert!(typed.out().contains("suite Theme 1, Milestone 1"), "{}", typed.shown());
    workspace.write("fosssim.toml", "suit = 'suite.toml'\n");
    let wrong = workspace.run(["grade", "--traces", "alice"]);
    assert!(wrong.code == Some(2) && wrong.err().contains("unknown field `suit`"), "{}", wrong.shown());
}

/// The files that the grading of a class creates, whose names are well known.
const RESULTS: [&str; 6] = ["grades.csv", "scenes.csv", "grades.jsonl", "class.txt", "index.html", "last-run.json"];

#[test]
fn a_folder_of_results_leads_nowhere_else() {
    let workspace = workspace();
    let bytes = trace_of(BOUNCE);
    for name in ["alice", "bob"] {
        workspace.write(format!("{name}/bounce.bin"), &bytes[..bytes.len() - 8]);
    }
    workspace.write("precious/file", "precious");
    fs::create_dir(workspace.path("grades")).expect("a folder");
    for name in RESULTS {
        symlink("../precious/file", workspace.path("grades").join(name)).expect("a link");
    }
    let run = grade(&workspace, &["--traces", "alice", "bob", "--output", "grades"]);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    for name in &RESULTS[..5] {
        assert!(workspace.path("grades").join(name).symlink_metadata().expect("written").is_file(), "{name}");
    }
    assert_eq!(workspace.read("precious/file"), b"precious");
    // The folders for results do not lead to other places either.
    for folder in ["reports", "cards", "students"] {
        drop(fs::remove_dir_all(workspace.path("grades").join(folder)));
        symlink("../precious", workspace.path("grades").join(folder)).expect("a link");
        let run = grade(&workspace, &["--traces", "alice", "bob", "--output", "grades", "--for", "student"]);
        assert_eq!(run.code, Some(2), "{folder}: {}", run.shown());
        let reasons = String::from_utf8(workspace.read("grades/grades.jsonl")).expect("text");
        assert!((run.shown() + &reasons).contains("a link, which is not followed"), "{folder}: {}", run.shown());
        fs::remove_file(workspace.path("grades").join(folder)).expect("removed");
    }
    assert_eq!(fs::read_dir(workspace.path("precious")).expect("a folder").count(), 1);
    // A link in place of the folder itself is followed only if the command line names it.
    if workspace.run(["doctor"]).code == Some(0) {
        program(&workspace, "class/one", 3);
        program(&workspace, "class/two", 3);
        symlink("precious", workspace.path("fosssim-grades")).expect("a link");
        let run = grade(&workspace, &["class"]);
        assert!(run.code == Some(2) && run.err().contains("is a link"), "{}", run.shown());
        assert_eq!(fs::read_dir(workspace.path("precious")).expect("a folder").count(), 1);
    }
}

/// Runs a command that may wait, and sends SIGTERM if it does. Returns the result and how long the end took after the
/// signal.
fn ended(workspace: &Workspace, arguments: &[&str]) -> (Run, Duration) {
    let mut command = workspace.command();
    let child = command.args(arguments).spawn().expect("a start");
    let begun = Instant::now();
    let number = child.id().to_string();
    let (done, waits) = std::sync::mpsc::channel::<()>();
    let killer = std::thread::spawn(move || {
        if waits.recv_timeout(Duration::from_secs(8)).is_err() {
            drop(Command::new("kill").args(["-TERM", &number]).status());
        }
    });
    let output = child.wait_with_output().expect("an end");
    drop(done);
    killer.join().expect("joined");
    (output.into(), begun.elapsed())
}

#[test]
fn pipes_are_waited_for_nowhere() {
    let workspace = workspace();
    let bytes = trace_of(BOUNCE);
    workspace.write("alice/bounce.bin", &bytes);
    workspace.write("bob/bounce.bin", &bytes);
    program(&workspace, "class/one", 3);
    program(&workspace, "class/two", 3);
    let with_programs = workspace.run(["doctor"]).code == Some(0);
    let class = ["grade", "--suite", "suite.toml", "class", "--output", "grades", "--format", "csv"];
    let traces =
        ["grade", "--suite", "suite.toml", "--traces", "alice", "bob", "--output", "grades", "--format", "csv"];
    let merge = ["merge", "shards", "--output", "merged", "--format", "csv"];
    let everywhere: [(&str, &[&str], &str); 10] = [
        ("grades/.lock", &class, "a pipe"),
        ("grades/journal.jsonl", &class, "a pipe"),
        ("grades/last-run.json", &class, ""),
        ("grades/grades.csv", &traces, ""),
        ("grades/index.html", &traces, ""),
        ("shards/shard-1-of-1/shard.json", &merge, "a pipe"),
        ("shards/shard-1-of-1/journal.jsonl", &merge, "no complete shard"),
        ("scenes/pipe.xml", &traces, "a pipe"),
        ("suite.toml", &["suite", "check", "suite.toml"], "nothing wrote to the pipe"),
        ("scene.xml", &["simulate", "scene.xml"], "nothing wrote to the pipe"),
    ];
    for (place, arguments, says) in everywhere {
        if arguments == class && !with_programs {
            continue;
        }
        let path = workspace.path(place);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        let before = fs::read(&path).ok();
        drop(fs::remove_file(&path));
        fifo(&path);
        let (run, _) = ended(&workspace, arguments);
        // Signals end the commands that wait; no process had to be killed.
        let wanted = if says.is_empty() { [Some(0), Some(1)] } else { [Some(2), Some(2)] };
        assert!(wanted.contains(&run.code), "{place}: {}", run.shown());
        assert!(run.err().contains(says), "{place}: {}", run.shown());
        drop(fs::remove_file(&path));
        if let Some(before) = before {
            fs::write(&path, before).expect("as it was");
        }
    }
}

#[test]
fn a_grading_ends_by_the_first_signal_although_nobody_reads_what_it_writes() {
    let Some(workspace) = with_programs() else { return };
    for number in 0..40 {
        program(&workspace, format!("class/{number}{}", "x".repeat(200)), 3);
    }
    let mut command = workspace.command();
    // No process reads standard output and standard error, and the report is larger than a pipe's buffer.
    let arguments = ["grade", "--suite", "suite.toml", "class", "--output", "grades", "--format", "json"];
    let mut child = command.args(arguments).spawn().expect("a start");
    let reported = || workspace.path("grades/index.html").exists();
    let begun = Instant::now();
    while !reported() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(child.try_wait().expect("a state").is_none(), "it waits for a reader");
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill").success());
    let ended = child.wait().expect("an end");
    assert_eq!(ended.code(), Some(130), "{ended:?}");
    assert!(
        !fs::read_dir(workspace.path("grades"))
            .expect("a folder")
            .any(|entry| { entry.expect("an entry").file_name().to_string_lossy().starts_with(".fosssim-oracle-") })
    );
}

#[test]
fn endless_files_are_read_up_to_a_limit() {
    let workspace = workspace();
    let huge = |name: &str| {
        let path = workspace.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::File::create(path).expect("a file").set_len(1 << 40).expect("a hole");
    };
    huge("huge");
    huge("sparse/shard-1-of-1/shard.json");
    fs::create_dir(workspace.path("folder")).expect("a folder");
    workspace.write("empty", "");
    let _socket = std::os::unix::net::UnixListener::bind(workspace.path("socket")).expect("a socket");
    let suite =
        |scenes: &str| format!("{}scenes = [\"{scenes}\"]\n", SUITE.replace("scenes = [\"scenes/*.xml\"]\n", ""));
    workspace.write("devices.toml", suite("/dev/zero"));
    workspace.write("hole.toml", suite("huge"));
    for (arguments, says) in [
        (&["suite", "check", "/dev/zero"][..], "larger than 1048576 bytes"),
        (&["suite", "check", "huge"], "larger than 1048576 bytes"),
        (&["suite", "check", "folder"], "directory"),
        (&["suite", "check", "socket"], "a socket"),
        (&["suite", "check", "empty"], "no [[group]]"),
        (&["suite", "check", "devices.toml"], "a device, not a regular file"),
        (&["suite", "check", "hole.toml"], "too large for a scene"),
        (&["simulate", "/dev/zero"], "larger than 8388608 bytes"),
        (&["simulate", "huge"], "larger than 8388608 bytes"),
        (&["simulate", "socket"], "a socket"),
        (&["simulate", "folder"], "a folder"),
        (&["check", "scenes/bounce.xml", "socket"], "a socket"),
        (&["check", "scenes/bounce.xml", "folder"], "a folder"),
        (&["merge", "sparse", "--output", "merged"], "shard.json"),
        (&["record", "--assets", "folder"], "there is no scene"),
    ] {
        let run = workspace.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.shown());
        assert!(run.err().contains(says), "{arguments:?}: {}", run.shown());
    }
    for (arguments, verdict) in [
        (&["check", "scenes/bounce.xml", "/dev/zero"][..], 1),
        (&["check", "scenes/bounce.xml", "huge"], 1),
        (&["check", "scenes/bounce.xml", "empty"], 1),
        (&["explain", "scenes/bounce.xml", "/dev/zero"], 1),
    ] {
        let run = workspace.run(arguments);
        assert_eq!(run.code, Some(verdict), "{arguments:?}: {}", run.shown());
    }
}

#[test]
fn points_of_a_shard_follow_from_its_verdicts() {
    let Some(workspace) = with_programs() else { return };
    for name in ["ada", "bob", "carol"] {
        program(&workspace, format!("class/{name}"), 3);
    }
    program(&workspace, "class/.late", 3);
    for shard in ["1/2", "2/2"] {
        let run = grade(&workspace, &["class", "--shard", shard, "--output", "grades"]);
        assert_eq!(run.code, Some(1), "{}", run.shown());
    }
    let sound = workspace.run(["merge", "grades", "--output", "merged"]);
    assert_eq!(sound.code, Some(1), "{}", sound.shown());
    let rows = table(&workspace, "merged/grades.csv");
    assert_eq!(rows.iter().filter(|row| &row[1] == "not graded").count(), 1, "told once: {rows:?}");
    let file = "grades/shard-1-of-2/shard.json";
    let text = String::from_utf8(workspace.read(file)).expect("text");
    let mut part: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for (pointer, value) in [
        ("/grades/0/points", serde_json::json!(1e308)),
        ("/grades/0/groups/0/points", serde_json::json!(10.0)),
        ("/grades/0/groups/0/scenes/0/points", serde_json::json!(-5.0)),
        ("/grades/0/max_points", serde_json::json!(1e308)),
        ("/grades/0/groups/0/max_points", serde_json::json!(20.0)),
        ("/grades/0/verdict", serde_json::json!("Accepted")),
        ("/grades/0/submission", serde_json::json!("bob")),
        ("/common/of", serde_json::json!(u64::MAX)),
        ("/number", serde_json::json!(7)),
    ] {
        let place = part.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer} in {text}"));
        let before = std::mem::replace(place, value);
        workspace.write(file, part.to_string());
        let forged = workspace.run(["merge", "grades", "--output", "forged"]);
        assert_eq!(forged.code, Some(2), "{pointer}: {}", forged.shown());
        assert!(forged.err().contains("grade this shard again"), "{pointer}: {}", forged.shown());
        *part.pointer_mut(pointer).expect("its place") = before;
    }
}
