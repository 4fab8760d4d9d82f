//! Help, and the messages about wrong arguments.
use crate::workspace::{BOUNCE, DRIFT, Workspace};
use fosssim_testing::{Need, skip};
use std::{os::unix::fs::symlink, process::Command};

/// Only the help command wraps the text below the options: a line ends early only at the end of a paragraph or an
/// example.
#[test]
fn help_is_wrapped_once() {
    let workspace = Workspace::new();
    for command in [&["grade"][..], &["record"], &["explain"], &["trace", "show"], &["check"], &[]] {
        let text = workspace.run(command.iter().chain(&["--help"])).out();
        let lines: Vec<&str> = text.lines().collect();
        let begun = lines.iter().position(|line| *line == "Example:").unwrap_or(0);
        for pair in lines[begun..].windows(2) {
            let [line, next] = pair else { continue };
            let flows = !line.is_empty() && !line.starts_with(' ') && !next.is_empty() && !next.starts_with(' ');
            let word = next.split(' ').next().unwrap_or_default();
            // The next word did not fit, or the next line begins a new sentence.
            let is_full = line.len() + 1 + word.len() > 100 || word.chars().all(|c| c.is_uppercase());
            assert!(!flows || is_full, "{command:?}: {line:?} is broken before {next:?}");
        }
    }
}

#[test]
fn a_trace_instead_of_the_scene_is_reported_in_one_line() {
    let workspace = Workspace::with_trace(DRIFT);
    for command in [&["check"][..], &["explain"]] {
        let run = workspace.run(command.iter().chain(&["trace.bin", "scene.xml"]));
        assert_eq!(run.code, Some(2), "{}", run.shown());
        assert_eq!(run.err().lines().count(), 1, "{}", run.err());
        assert!(run.err().contains("trace.bin is not a scene but a trace"), "{}", run.err());
        assert!(run.err().contains("SCENE comes first"), "{}", run.err());
    }
    let packed = zstd::encode_all(&workspace.read("trace.bin")[..], 3).expect("packed");
    workspace.write("trace.bin.zst", packed);
    let run = workspace.run(["check", "trace.bin.zst", "scene.xml"]);
    assert!(run.err().contains("SCENE comes first"), "{}", run.err());
    // A text file is read as a scene, even if it is wrong.
    workspace.write("notes.txt", "no scene\n");
    assert!(!workspace.run(["check", "notes.txt", "trace.bin"]).err().contains("SCENE comes first"));
}

#[test]
fn a_scene_instead_of_the_trace_is_reported_in_one_line() {
    let workspace = Workspace::with_trace(DRIFT);
    for command in [&["check", "scene.xml", "scene.xml"][..], &["explain", "scene.xml", "scene.xml"]] {
        let run = workspace.run(command);
        assert_eq!((run.code, run.err().lines().count()), (Some(2), 1), "{}", run.shown());
        assert!(run.err().contains("scene.xml is a scene, not a trace"), "{}", run.err());
    }
    // Any other file with such a name is read as a trace, even if it is damaged.
    workspace.write("odd.xml", "no scene");
    assert_eq!(workspace.run(["check", "scene.xml", "odd.xml"]).code, Some(1));
}

#[test]
fn built_in_files_are_found_under_their_full_name() {
    let workspace = Workspace::with_trace(DRIFT);
    for name in ["SimpleTests/one-ball-into-two", "SimpleTests/one-ball-into-two.xml"] {
        let run = workspace.run(["check", name, "trace.bin"]);
        assert_eq!(run.code, Some(2), "{}", run.shown());
        assert!(run.err().contains("the built-in scene is asset:SimpleTests/one-ball-into-two\n"), "{}", run.err());
    }
}

#[test]
fn a_step_that_is_not_a_number_is_reported() {
    let workspace = Workspace::with_trace(DRIFT);
    for command in [&["check"][..], &["trace", "show"]] {
        for step in ["-1", "x", "1.5", "99999999999"] {
            let run = workspace.run(command.iter().chain(&["scene.xml", "trace.bin", "--step", step]));
            assert_eq!(run.code, Some(2), "{}", run.shown());
            assert!(run.err().contains("steps are counted from 1"), "{}", run.err());
        }
    }
}

#[test]
fn names_of_files_give_the_terminal_no_orders() {
    let workspace = Workspace::with_trace(DRIFT);
    let name = "a\u{1b}[31m\nb.bin";
    workspace.write(name, workspace.read("trace.bin"));
    let run = workspace.run(["check", "scene.xml", name]);
    assert_eq!(run.code, Some(0), "{}", run.shown());
    assert!(run.out().contains("  trace a\\x1b[31m b.bin\n"), "{}", run.out());
    let run = workspace.run(["check", "scene.xml", "gone\u{1b}[31m.bin"]);
    assert!(run.err().contains("gone\\x1b[31m.bin"), "{}", run.err());
}

#[test]
fn invalid_counts_and_scenes_are_reported() {
    let workspace = Workspace::with_trace(DRIFT);
    for (words, says) in [
        (&["check", "scene.xml", "trace.bin", "--threads", "0"][..], "the value must be a whole number of at least 1"),
        (&["render", "scene.xml", "--output", "x.gif", "--every", "0"], "whole number of at least 1"),
        (&["grade", "x", "--jobs", "many"], "the value must be a whole number of at least 1"),
        (&["check", "-", "trace.bin"], "a scene is read from a file"),
        (&["render", "scene.xml", "--format", "gif", "--output", "/dev/full"], "cannot write /dev/full: "),
    ] {
        let run = workspace.run(words);
        assert_eq!(run.code, Some(2), "{}", run.shown());
        assert!(run.err().contains(says), "{}", run.err());
    }
}

#[test]
fn quiet_leaves_only_errors_and_the_exit_code() {
    let workspace = Workspace::with_trace(DRIFT);
    workspace.write("short.bin", &workspace.read("trace.bin")[..50]);
    for (command, code) in [
        (&["check", "scene.xml", "trace.bin", "-q"][..], 0),
        (&["check", "scene.xml", "short.bin", "--quiet", "--format", "json"], 1),
        (&["explain", "-q", "scene.xml", "short.bin"], 1),
        (&["simulate", "-q", "scene.xml", "--output", "again.bin"], 0),
        (&["check", "scene.xml", "short.bin", "-q", "--output", "report.txt"], 1),
    ] {
        let run = workspace.run(command);
        assert_eq!((run.code, run.out(), run.err()), (Some(code), String::new(), String::new()), "{command:?}");
    }
    assert_eq!(workspace.read("again.bin"), workspace.read("trace.bin"));
    assert!(String::from_utf8(workspace.read("report.txt")).expect("text").starts_with("BAD TRACE"));
    let run = workspace.run(["check", "-q", "nowhere.xml", "trace.bin"]);
    assert_eq!((run.code, run.err().lines().count()), (Some(2), 1), "{}", run.shown());
}

#[test]
fn the_course_script_says_in_a_sentence_that_a_program_is_missing() {
    let workspace = Workspace::new();
    workspace.write("scenes/bounce.xml", BOUNCE);
    workspace.write("plain", "no program");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/integrations/course/run_tests.py");
    symlink(env!("CARGO_BIN_EXE_fosssim-oracle"), workspace.path("FOSSSimOracle")).expect("a link");
    for (program, oracle, says) in [
        ("./missing", "./FOSSSimOracle", "there is no program at "),
        ("./plain", "./FOSSSimOracle", "can't be run"),
        ("./FOSSSimOracle", "./missing", "there is no oracle at "),
    ] {
        let mut run = Command::new(script);
        run.args(["--program", program, "--oracle", oracle, "scenes"]).current_dir(workspace.path(""));
        let Ok(output) = run.output() else {
            skip(Need::Python, "there is no python3");
            return;
        };
        let run: crate::workspace::Run = output.into();
        assert_eq!((run.code, run.err().lines().count()), (Some(2), 1), "{}", run.shown());
        assert!(run.err().contains(says), "{}", run.err());
    }
}

#[test]
fn a_scene_instead_of_the_program_is_reported_with_the_right_command() {
    let workspace = Workspace::with_trace(DRIFT);
    let run = workspace.run(["grade", "scene.xml"]);
    assert_eq!((run.code, run.err().lines().count()), (Some(2), 1), "{}", run.shown());
    assert!(
        run.err().contains("scene.xml is a scene, not a program") && run.err().contains("--suite"),
        "{}",
        run.err()
    );
    assert!(!run.err().contains("chmod"), "{}", run.err());
}

#[test]
fn slips_in_names_of_scenes_and_pairs_find_what_was_meant() {
    let workspace = Workspace::with_trace(BOUNCE);
    for (typed, meant) in [
        ("asset:ImpulsesTests/of-centre-on-turning-edge", "ImpulsesTests/off-centre-on-turning-edge"),
        ("asset:off-centre-on-turning-egde", "ImpulsesTests/off-centre-on-turning-edge"),
        ("asset:GeometricTests/nothing-colildes.xml", "GeometricTests/nothing-collides"),
        ("asset:ContinuousTimeTests/spinning-egde", "ContinuousTimeTests/spinning-edge-sweeps-balls"),
    ] {
        let run = workspace.run(["check", typed, "trace.bin"]);
        let near = run.err().split("the nearest are ").nth(1).unwrap_or_default().to_owned();
        assert!(near.split(',').next().is_some_and(|first| first.ends_with(meant)), "{typed}: {}", run.err());
    }
    let run = workspace.run(["detect", "xx:1"]);
    assert!(run.err().contains("`xx` is not a kind of pair") && !run.err().contains("radii"), "{}", run.err());
}

#[test]
fn output_files_are_named() {
    let workspace = Workspace::with_trace(BOUNCE);
    for (command, says) in [
        (&["check", "scene.xml", "trace.bin", "--format", "html", "-o", "page.html"][..], "open in a browser: "),
        (&["explain", "scene.xml", "trace.bin", "--format", "html", "-o", "page.html"], "open in a browser: "),
        (&["check", "scene.xml", "trace.bin", "-o", "report.txt"], "written: "),
        (&["suite", "init", "-o", "course.toml"], "written: "),
    ] {
        let run = workspace.run(command);
        let file = command.last().expect("a word");
        let err = run.err();
        let place = err.strip_prefix("ACCEPTED: ").and_then(|verdict| verdict.split_once('\n')).map(|(_, rest)| rest);
        assert_eq!(place.is_some(), *file == "page.html" && command[0] == "check", "{}", run.shown());
        let place = place.unwrap_or(&err);
        assert!(place.starts_with(says) && place.trim_end().ends_with(file), "{}", run.shown());
        let quiet = workspace.run(command.iter().chain(&["--quiet"]));
        assert!(quiet.err().is_empty() || command[0] == "suite", "{}", quiet.shown());
    }
    assert_eq!(workspace.read("course.toml"), workspace.run(["suite", "init"]).stdout);
    // A suite that a teacher has changed is not overwritten.
    std::fs::write(workspace.path("course.toml"), "# mine\n").expect("ours");
    let again = workspace.run(["suite", "init", "-o", "course.toml"]);
    assert!(again.code == Some(2) && again.err().contains("may contain your changes"), "{}", again.shown());
    assert_eq!(workspace.read("course.toml"), b"# mine\n");
}
