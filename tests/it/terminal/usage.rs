//! Help, and what is said when the words are wrong.
use crate::workspace::{BOUNCE, DRIFT, Workspace};
use fosssim_testing::{Need, skip};
use std::{os::unix::fs::symlink, process::Command};

/// Text below the options is wrapped by the help alone: a line ends early only where a paragraph or an example does.
#[test]
fn help_is_wrapped_once() {
    let workspace = Workspace::new();
    for command in [&["grade"][..], &["record"], &["explain"], &["trace", "diff"], &["check"], &[]] {
        let text = workspace.run(command.iter().chain(&["--help"])).out();
        let lines: Vec<&str> = text.lines().collect();
        let begun = lines.iter().position(|line| *line == "Example:").unwrap_or(0);
        for pair in lines[begun..].windows(2) {
            let [line, next] = pair else { continue };
            let flows = !line.is_empty() && !line.starts_with(' ') && !next.is_empty() && !next.starts_with(' ');
            let word = next.split(' ').next().unwrap_or_default();
            // The next word had no room, or the next line begins a sentence of its own.
            let is_full = line.len() + 1 + word.len() > 100 || word.chars().all(|c| c.is_uppercase());
            assert!(!flows || is_full, "{command:?}: {line:?} is broken before {next:?}");
        }
    }
}

#[test]
fn a_trace_in_the_place_of_the_scene_is_told_in_one_line() {
    let workspace = Workspace::with_trace(DRIFT);
    for command in [&["check"][..], &["explain"], &["trace", "info"]] {
        let run = workspace.run(command.iter().chain(&["trace.bin", "scene.xml"]));
        assert_eq!(run.code, Some(2), "{}", run.shown());
        assert_eq!(run.err().lines().count(), 1, "{}", run.err());
        assert!(run.err().contains("trace.bin is no scene but a trace"), "{}", run.err());
        assert!(run.err().contains("SCENE comes first"), "{}", run.err());
    }
    let packed = zstd::encode_all(&workspace.read("trace.bin")[..], 3).expect("packed");
    workspace.write("trace.bin.zst", packed);
    let run = workspace.run(["check", "trace.bin.zst", "scene.xml"]);
    assert!(run.err().contains("SCENE comes first"), "{}", run.err());
    // What is text is read as a scene, however wrong.
    workspace.write("notes.txt", "no scene\n");
    assert!(!workspace.run(["check", "notes.txt", "trace.bin"]).err().contains("SCENE comes first"));
}

#[test]
fn the_course_script_says_in_a_sentence_that_a_program_is_missing() {
    let workspace = Workspace::new();
    workspace.write("scenes/bounce.xml", BOUNCE);
    workspace.write("plain", "no program");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/course/run_tests.py");
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
