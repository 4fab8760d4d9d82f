//! `simulate`: traces and summaries. Each output is complete, or does not exist.
use super::workspace::{BEAM, BOUNCE, Workspace, finish, trace_of};
use std::{os::unix::fs::symlink, process::Command};

#[test]
fn the_summary_says_what_happened() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BEAM);
    let run = workspace.run(["simulate", "scene.xml", "--output", "trace.bin"]);
    insta::assert_snapshot!("summary", run.shown());
    assert_eq!(workspace.read("trace.bin"), trace_of(BEAM));
    let run = workspace.run(["simulate", "scene.xml", "-o", "trace.bin", "--format", "json"]);
    insta::assert_snapshot!("summary_json", run.shown());
    insta::assert_snapshot!("summary_without_trace", workspace.run(["simulate", "scene.xml"]).shown());
}

#[test]
fn the_trace_may_go_to_standard_output() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BOUNCE);
    for name in ["-", "/dev/stdout", "/dev/fd/1"] {
        let run = workspace.run(["simulate", "scene.xml", "--output", name]);
        assert_eq!((run.code, &run.stdout), (Some(0), &trace_of(BOUNCE)));
        assert!(run.err().starts_with("Simulated scene.xml"), "{}", run.err());
    }
    assert_eq!(workspace.run(["simulate", "scene.xml", "--output", "/dev/null"]).code, Some(0));
    let mut child = workspace.command().args(["simulate", "scene.xml", "-o", "-"]).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn a_link_is_followed_and_the_mode_is_kept() {
    use std::os::unix::fs::PermissionsExt;
    let workspace = Workspace::new();
    workspace.write("scene.xml", BOUNCE);
    workspace.write("real.bin", "old");
    std::fs::set_permissions(workspace.path("real.bin"), std::fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real.bin", workspace.path("link.bin")).unwrap();
    assert_eq!(workspace.run(["simulate", "scene.xml", "--output", "link.bin"]).code, Some(0));
    assert_eq!(workspace.read("real.bin"), trace_of(BOUNCE));
    assert!(workspace.path("link.bin").symlink_metadata().unwrap().is_symlink());
    assert_eq!(workspace.path("real.bin").metadata().unwrap().permissions().mode() & 0o777, 0o640);
    // The umask does not remove permissions either.
    std::fs::set_permissions(workspace.path("real.bin"), std::fs::Permissions::from_mode(0o666)).unwrap();
    let script = "umask 077; exec \"$0\" simulate scene.xml -o real.bin";
    let mut shell = Command::new("sh");
    shell.args(["-c", script, env!("CARGO_BIN_EXE_fosssim-oracle")]).current_dir(workspace.path(""));
    assert_eq!(finish(&mut shell).code, Some(0));
    assert_eq!(workspace.path("real.bin").metadata().unwrap().permissions().mode() & 0o777, 0o666);
}

#[test]
fn outputs_that_cannot_be_written_are_rejected() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BOUNCE);
    workspace.write("folder/inside", "");
    symlink("nowhere", workspace.path("dangling")).unwrap();
    for (output, says) in [
        ("scene.xml", "this is also an input"),
        ("folder", "this is a folder"),
        ("new/", "this is the name of a folder"),
        ("nowhere/trace.bin", "there is no folder nowhere; create it first"),
        ("dangling", "a symbolic link to a file that does not exist"),
    ] {
        let run = workspace.run(["simulate", "scene.xml", "--output", output]);
        assert_eq!(run.code, Some(2), "{output}");
        assert!(run.err().contains(says), "{output}: {}", run.err());
    }
    assert_eq!(workspace.read("scene.xml"), BOUNCE.as_bytes());
    assert_eq!(workspace.list(), ["dangling", "folder", "scene.xml"]);
}

#[test]
fn a_simulation_that_fails_leaves_the_old_trace_alone() {
    let workspace = Workspace::new();
    // Two particles are at the same place: their distance has no direction, and Newton's method finds no solution.
    let scene = r#"<scene><duration time="1"/><integrator type="implicit-euler" dt="0.1"/>
        <collision type="penalty" k="1e9" thickness="0.5"/>
        <particle m="1" px="0" py="0" vx="1" vy="0" fixed="0" radius="1"/>
        <particle m="1" px="1" py="0.001" vx="-1" vy="0" fixed="0" radius="1"/></scene>"#;
    workspace.write("scene.xml", scene);
    workspace.write("trace.bin", "old");
    let run = workspace.run(["simulate", "scene.xml", "--output", "trace.bin"]);
    assert_eq!(run.code, Some(2), "{}", run.shown());
    assert!(run.err().contains("has no result"), "{}", run.err());
    assert_eq!(workspace.read("trace.bin"), b"old");
    assert_eq!(workspace.list(), ["scene.xml", "trace.bin"]);
}

#[test]
fn a_file_that_may_not_grow_and_a_full_disk_leave_nothing_behind() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BOUNCE.replace(r#"time="1""#, r#"time="50000""#));
    // The size limit is inherited, so that a shell can set it.
    let mut command = std::process::Command::new("/bin/sh");
    command.current_dir(workspace.path("")).env_clear().env("PROGRAM", env!("CARGO_BIN_EXE_fosssim-oracle"));
    let run = finish(command.args(["-c", "ulimit -f 64; exec \"$PROGRAM\" simulate scene.xml -o trace.bin"]));
    assert_eq!(run.code, Some(2), "{}", run.shown());
    assert!(run.err().starts_with("error: ") && run.err().contains("arge"), "{}", run.err());
    assert_eq!(workspace.list(), ["scene.xml"]);
    let run = workspace.run(["simulate", "scene.xml", "-o", "/dev/full"]);
    assert_eq!(run.code, Some(2), "{}", run.shown());
    assert!(run.err().contains("o space left"), "{}", run.err());
    assert_eq!(workspace.list(), ["scene.xml"]);
}

#[test]
fn an_interrupt_leaves_nothing_behind() {
    for signal in ["-TERM", "-INT"] {
        let workspace = Workspace::new();
        // Ten million steps take long enough to be interrupted.
        let scene = BOUNCE.replace(r#"time="1""#, r#"time="5000000""#);
        workspace.write("scene.xml", scene);
        let mut child = workspace.command().args(["simulate", "scene.xml", "-o", "trace.bin"]).spawn().unwrap();
        while workspace.list().len() < 2 {
            assert!(child.try_wait().unwrap().is_none(), "it ended before it was interrupted");
            std::thread::yield_now();
        }
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert_eq!(workspace.list(), ["scene.xml"]);
    }
}

#[test]
fn every_command_has_help_with_an_example() {
    let workspace = Workspace::new();
    insta::assert_snapshot!("help", workspace.run(["--help"]).shown());
    for command in [
        &["grade"][..],
        &["merge"],
        &["suite"],
        &["suite", "init"],
        &["suite", "check"],
        &["suite", "list"],
        &["scene"],
        &["scene", "list"],
        &["scene", "show"],
        &["scene", "export"],
        &["demo"],
        &["doctor"],
        &["selftest"],
        &["simulate"][..],
        &["check"],
        &["detect"],
        &["render"],
        &["trace"],
        &["trace", "show"],
        &["record"],
        &["completions"],
        &["man"],
    ] {
        let run = workspace.run(command.iter().chain(&["--help"]));
        assert_eq!(run.code, Some(0));
        assert!(run.out().contains("Example:\n  fosssim-oracle "), "{command:?}");
        insta::assert_snapshot!(format!("help_{}", command.join("_")), run.shown());
    }
    let original = workspace.run(["help", "original"]);
    assert!(original.out().contains("Example:\n  fosssim-oracle original -s"), "{}", original.shown());
}

#[test]
fn a_shell_completes_names() {
    let workspace = Workspace::new();
    for (words, expected) in [
        (&["grade", "--suite", "t2m"][..], "t2m2"),
        (&["grade", "--scene", "HolisticTests/rope"], "HolisticTests/rope-bridge"),
        (&["grade", "--format", "ht"], "html"),
        (&["demo", "--mistake", "pe-square-no-e"], "pe-square-no-eh"),
        (&["check", "asset:HolisticTests/rope"], "asset:HolisticTests/rope-bridge"),
    ] {
        let mut command = workspace.command();
        command.env("FOSSSIM_COMPLETE", "bash").env("_CLAP_COMPLETE_INDEX", words.len().to_string());
        let run = finish(command.env("_CLAP_IFS", "\n").args(["--", "fosssim-oracle"]).args(words));
        assert!(run.out().lines().any(|line| line == expected), "{words:?}: {}", run.shown());
    }
}

#[test]
fn wrong_usage_differs_from_a_wrong_trace() {
    let workspace = Workspace::new();
    for arguments in
        [&[][..], &["grade"], &["check"], &["check", "a", "b", "--threads", "0"], &["check", "a", "b", "c"]]
    {
        let run = workspace.run(arguments);
        assert_eq!((run.code, run.stdout.len()), (Some(2), 0), "{arguments:?}");
    }
    let run = workspace.run(["--version"]);
    assert_eq!(run.out(), format!("fosssim-oracle {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn the_manual_page_knows_every_command() {
    let workspace = Workspace::new();
    let manual = workspace.run(["man"]);
    assert_eq!(manual.code, Some(0));
    for command in ["simulate", "check", "trace", "record", "original"] {
        assert!(manual.out().contains(command), "{command}");
    }
    let mut child = workspace.command().arg("man").spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(finish(workspace.command().args(["completions", "tcsh-for-kids"])).code == Some(2));
}

#[test]
fn every_command_that_the_manual_page_refers_to_has_a_page() {
    let workspace = Workspace::new();
    let page = workspace.run(["man", "trace", "show"]);
    assert_eq!(page.code, Some(0));
    assert!(page.out().contains(".TH fosssim-oracle-trace-show 1"), "{}", page.out());
    let mut pages = 0;
    let mut todo = vec![Vec::<String>::new()];
    while let Some(command) = todo.pop() {
        let page = workspace.run([&["man".to_owned()][..], &command].concat());
        assert_eq!(page.code, Some(0), "{command:?}: {}", page.err());
        let name = [&["fosssim-oracle".to_owned()][..], &command].concat().join("-");
        assert!(page.out().contains(&format!(".TH {name} 1")), "{}", page.out());
        let page = page.out().replace("\\-", "-");
        for line in page.lines().filter(|line| line.ends_with("(1)")) {
            let last = line.trim_end_matches("(1)").strip_prefix(&format!("{name}-")).unwrap();
            todo.push([&command[..], &[last.to_owned()]].concat());
        }
        pages += 1;
    }
    assert!(pages > 15, "{pages} pages");
    let run = workspace.run(["man", "trace", "nothing"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("fosssim-oracle trace has no command `nothing`; it has show"), "{}", run.err());
}
