//! Submissions other than a student's own program: a sample that is always wrong, and existing traces.
use crate::{
    grading::{SUITE, workspace},
    workspace::Workspace,
};
use std::{
    fs::{self, Permissions},
    os::unix::fs::{PermissionsExt, symlink},
    process::{Command, Stdio},
};

#[test]
fn the_demo_writes_a_wrong_program_that_may_be_handed_in() {
    let Some(workspace) = workspace() else { return };
    let made = workspace.run(["demo", "--mistake", "pe-square-no-eh", "--program", "flawed"]);
    assert_eq!(made.code, Some(0), "{}", made.shown());
    let graded = workspace.run(["grade", "flawed", "--suite", "suite.toml", "--format", "csv"]);
    assert_eq!(graded.code, Some(1), "{}", graded.shown());
    assert!(graded.out().contains(",WA,") && graded.out().contains(",pe-square-no-eh"), "{}", graded.shown());
    // Neither another name nor another argument makes it right.
    let told = Command::new(workspace.path("flawed")).args(["--mistake", "no-such", "-s", "none.xml"]).output();
    let told = String::from_utf8(told.expect("the program").stderr).expect("text");
    assert!(told.contains("none.xml"), "{told}");
    // A correct variant is right, too.
    for mistake in ["no-such", "right", "", "pe-square-no-eh,scale-2"] {
        let refused = workspace.run(["demo", "--mistake", mistake, "--program", "other"]);
        assert!(refused.code == Some(2) && refused.err().contains("there is no mistake"), "{}", refused.shown());
    }
}

/// The program itself can act as a correct submission, so it must not be accepted as one.
#[test]
fn the_program_itself_earns_no_points() {
    let Some(workspace) = workspace() else { return };
    let oracle = env!("CARGO_BIN_EXE_fosssim-oracle");
    let changed = [fs::read(oracle).expect("the program"), b"x".to_vec()].concat();
    for name in ["copy/FOSSSim", "changed/FOSSSim", "named/fosssim-sample", "drop-in/FOSSSimOracle"] {
        workspace.write(name, if name.starts_with("copy") { &changed[..changed.len() - 1] } else { &changed });
    }
    let python = |line: &str| {
        format!(
            "#!/usr/bin/python3\nimport os, sys\n{line}\nos.execv('o', ['fosssim-sample', 'sample', *sys.argv[1:]])\n"
        )
    };
    for (name, line) in [
        ("script/FOSSSim", format!("#!/bin/sh\nexec {oracle} sample \"$@\"\n")),
        (
            "copier/FOSSSim",
            python(&format!("open('o', 'wb').write(open('{oracle}', 'rb').read()); os.chmod('o', 493)")),
        ),
        ("linker/FOSSSim", python(&format!("os.symlink('{oracle}', 'o')"))),
        ("interpreter/FOSSSim", format!("#!{oracle} sample\n")),
        ("itself/FOSSSim", "#!/bin/sh\nexec /proc/$PPID/exe sample \"$@\"\n".to_owned()),
    ] {
        workspace.write(name, line);
    }
    for name in ["copy", "changed", "named", "drop-in", "script", "copier", "linker", "interpreter", "itself"] {
        let folder =
            fs::read_dir(workspace.path(name)).expect("a folder").next().expect("a program").expect("an entry");
        fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).expect("a mode");
        let program = folder.path().display().to_string();
        let run = workspace.run(["grade", &program, "--suite", "suite.toml"]);
        assert!(run.code == Some(1) && run.out().contains(", 0 of 20 points"), "{name}: {}", run.shown());
    }
    symlink(oracle, workspace.path("fosssim-sample")).expect("a link");
    let linked = workspace.run(["grade", "fosssim-sample", "--suite", "suite.toml"]);
    assert!(linked.out().contains("was not started: this is the grader's own program"), "{}", linked.shown());
    // Another build of the sample has other bytes.
    let sample = fs::read(env!("CARGO_BIN_EXE_fosssim-sample")).expect("the sample");
    workspace.write("class/ada/FOSSSim", [&sample[..], b"x"].concat());
    let other = workspace.run(["grade", "class/ada/FOSSSim", "--suite", "suite.toml"]);
    assert!(other.out().contains("the grader's own program"), "{}", other.shown());
}

#[test]
fn traces_that_are_there_already_are_graded_without_running_anything() {
    let workspace = Workspace::new();
    workspace.write("suite.toml", SUITE);
    let names = workspace.run(["suite", "check", "suite.toml"]);
    assert_eq!(names.code, Some(0), "{}", names.shown());
    let listing = workspace.run(["scene", "list"]).out();
    let scenes: Vec<&str> = listing
        .split_whitespace()
        .filter_map(|word| word.strip_prefix("asset:"))
        .filter(|name| name.starts_with("ImpulsesTests/o") || name.starts_with("GeometricTests/ball-"))
        .collect();
    assert!(scenes.len() > 1, "{listing}");
    for scene in &scenes {
        for (folder, mistake) in [("right", None), ("wrong", Some("pe-square-no-eh"))] {
            // The file has the scene's full name, or the last part of it.
            let name = if folder == "right" { scene } else { scene.rsplit('/').next().expect("a name") };
            let trace = workspace.path(format!("{folder}/{name}.bin"));
            std::fs::create_dir_all(trace.parent().expect("a folder")).expect("a folder");
            let xml = workspace.path("scene.xml");
            std::fs::write(&xml, fosssim_oracle::suite::library::find_scene(scene).expect("a scene")).expect("written");
            let mut sample = Command::new(env!("CARGO_BIN_EXE_fosssim-sample"));
            sample.arg("-s").arg(&xml).arg("-o").arg(&trace).stdout(Stdio::null());
            assert!(sample.args(mistake.map(|id| format!("--mistake={id}"))).status().expect("the sample").success());
        }
    }
    let grade = |folder: &str, words: &[&str]| {
        workspace.run(["grade", folder, "--suite", "suite.toml", "--traces"].iter().chain(words))
    };
    let right = grade("right", &[]);
    assert_eq!(right.code, Some(0), "{}", right.shown());
    assert!(right.out().contains("right: accepted, 20 of 20 points"), "{}", right.out());
    let page = grade("right", &["--format", "html=right.html"]).err();
    assert!(page.contains("right: accepted, 20 of 20 points\nopen in a browser: right.html\n"), "{page}");
    std::fs::create_dir(workspace.path("none")).expect("a folder");
    let none = grade("none", &[]).out();
    assert!(none.contains("Group/name.bin is missing or empty") && !none.contains("the program"), "{none}");
    let wrong = grade("wrong", &["--format", "csv", "--format", "html=wrong.html"]);
    assert_eq!(wrong.code, Some(1), "{}", wrong.shown());
    assert!(wrong.out().contains(",WA,") && wrong.out().contains(",pe-square-no-eh"), "{}", wrong.out());
    let page = String::from_utf8(workspace.read("wrong.html")).expect("text");
    assert!(page.contains("data-scene="), "the page has a viewer");
    // A trace whose name belongs to no scene is reported.
    workspace.write("right/ImpulsesTests/typo.bin", b"");
    let stray = grade("right", &[]).err();
    assert!(stray.contains("1 trace belongs to no scene of the suite: ImpulsesTests/typo.bin"), "{stray}");
    std::fs::remove_file(workspace.path("right/ImpulsesTests/typo.bin")).expect("removed");
    // Compressed traces are decompressed. A damaged file is not a trace, and the report gives the reason.
    let plain = grade("right", &["--format", "json"]).out();
    let name = format!("right/{}.bin", scenes[0]);
    let bytes = workspace.read(&name);
    std::fs::remove_file(workspace.path(&name)).expect("removed");
    let packed = zstd::encode_all(&bytes[..], 3).expect("packed");
    workspace.write(format!("{name}.zst"), &packed);
    assert_eq!(grade("right", &["--format", "json"]).out(), plain);
    workspace.write(format!("{name}.zst"), &packed[..packed.len() / 2]);
    let damaged = grade("right", &[]);
    assert!(damaged.code == Some(1) && damaged.out().contains("the zstd data is cut short"), "{}", damaged.shown());
    std::fs::remove_file(workspace.path(format!("{name}.zst"))).expect("removed");
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    std::io::Write::write_all(&mut packer, &bytes).expect("packed");
    let packed = packer.finish().expect("packed");
    workspace.write(format!("{name}.gz"), &packed);
    assert_eq!(grade("right", &["--format", "json"]).out(), plain);
    workspace.write(format!("{name}.gz"), &packed[..packed.len() / 2]);
    assert!(grade("right", &[]).out().contains("the gzip data is cut short"));
    std::fs::remove_file(workspace.path(format!("{name}.gz"))).expect("removed");
    workspace.write(&name, &bytes);
    // A missing or truncated file, or a link, is not a trace.
    let first = workspace.path(format!("right/{}.bin", scenes[0]));
    let bytes = std::fs::read(&first).expect("a trace");
    std::fs::write(&first, &bytes[..bytes.len() / 2]).expect("cut");
    let second = workspace.path(format!("right/{}.bin", scenes[1]));
    std::fs::rename(&second, workspace.path("elsewhere.bin")).expect("moved");
    symlink(workspace.path("elsewhere.bin"), &second).expect("a link");
    let damaged = grade("right", &["--format", "csv"]);
    assert_eq!(damaged.code, Some(1), "{}", damaged.shown());
    assert!(damaged.out().contains(",BT,") && damaged.out().contains(",NO,"), "{}", damaged.out());
    assert_eq!(grade("suite.toml", &[]).code, Some(2));
    assert_eq!(grade("right", &["--watch"]).code, Some(2));
}
