//! The drop-in: the original's command line, files and output, over our own scenes.
use super::workspace::{BEAM, BOUNCE, DRIFT, Workspace, finish, trace_of};
use fosssim_oracle::{scene, student};
use std::{
    ffi::OsStr,
    fs,
    os::unix::{ffi::OsStrExt, fs::symlink},
    process::Command,
};

const GRADE: [&str; 6] = ["-s", "scene.xml", "-d", "0", "-i", "trace.bin"];

#[test]
fn help_version_and_parse_errors_have_the_originals_shape() {
    let workspace = Workspace::new();
    insta::assert_snapshot!("original_help", workspace.original(["--help"]).shown());
    insta::assert_snapshot!("original_version", workspace.original(["--version"]).shown());
    insta::assert_snapshot!("original_no_arguments", workspace.original::<&str>([]).shown());
    insta::assert_snapshot!("original_bad_boolean", workspace.original(["-s", "a", "-d", "yes"]).shown());
    insta::assert_snapshot!("original_twice", workspace.original(["-s", "a", "--scene", "b"]).shown());
    insta::assert_snapshot!("original_both", workspace.original(["-s", "a", "-i", "b", "-o", "c"]).shown());
}

#[test]
fn recording_writes_the_trace_and_says_so() {
    for scene in [BOUNCE, BEAM, DRIFT] {
        let workspace = Workspace::new();
        workspace.write("scene.xml", scene);
        let run = workspace.original(["-s", "scene.xml", "-d", "0", "-o", "new.bin"]);
        assert_eq!(run.code, Some(0), "{}", run.shown());
        assert_eq!(workspace.read("new.bin"), trace_of(scene));
        assert!(run.out().ends_with("Saved simulation to file 'new.bin'.\n"));
        assert_eq!(workspace.list(), ["new.bin", "scene.xml"]);
    }
    let workspace = Workspace::with_trace(BOUNCE);
    insta::assert_snapshot!(
        "original_record",
        workspace.original(["-s", "scene.xml", "-d", "0", "-o", "new.bin"]).shown()
    );
    insta::assert_snapshot!("original_run", workspace.original(["-s", "scene.xml", "-d", "0"]).shown());
}

#[test]
fn grading_prints_the_verdict_and_writes_the_residuals() {
    let workspace = Workspace::with_trace(BOUNCE);
    let run = workspace.original(GRADE);
    insta::assert_snapshot!("original_pass", run.shown());
    assert_eq!(workspace.read("residual.txt"), b"1   0\n1   0\n1   0\n1   0\n");
    let mut trace = workspace.read("trace.bin");
    trace[164 + 15] = 0x7f;
    workspace.write("trace.bin", trace);
    let run = workspace.original(GRADE);
    insta::assert_snapshot!("original_fail", run.shown());
    let residuals = String::from_utf8(workspace.read("residual.txt")).unwrap();
    assert!(residuals.starts_with("0   ") && residuals.lines().count() == 4, "{residuals}");
}

#[test]
fn the_subcommand_behaves_like_the_name() {
    let workspace = Workspace::with_trace(BOUNCE);
    let by_name = workspace.original(GRADE);
    let by_command = workspace.run(["original"].iter().chain(&GRADE));
    assert_eq!(by_name.shown(), by_command.shown());
    symlink(env!("CARGO_BIN_EXE_fosssim-oracle"), workspace.path("FOSSSimOracleT2M2")).unwrap();
    let linked = finish(Command::new("./FOSSSimOracleT2M2").args(GRADE).current_dir(workspace.path("")));
    assert_eq!(by_name.shown(), linked.shown());
    let help = workspace.run(["original", "--help"]);
    assert!(help.out().starts_with("\nUSAGE: \n\n   fosssim-oracle original  [-m <string>]"), "{}", help.out());
}

#[test]
fn an_unreadable_trace_has_no_verdict_and_no_residual_file() {
    let workspace = Workspace::with_trace(BOUNCE);
    let trace = workspace.read("trace.bin");
    workspace.write("empty.bin", "");
    workspace.write("cut.bin", &trace[..170]);
    workspace.write("impulses.bin", &trace[..100]);
    fs::create_dir(workspace.path("folder")).unwrap();
    for (name, trace) in [
        ("original_missing", "nowhere.bin"),
        ("original_empty", "empty.bin"),
        ("original_cut", "cut.bin"),
        ("original_cut_in_impulses", "impulses.bin"),
    ] {
        let run = workspace.original(["-s", "scene.xml", "-d", "0", "-i", trace]);
        insta::assert_snapshot!(name, run.shown());
    }
    let folder = workspace.original(["-s", "scene.xml", "-d", "0", "-i", "folder"]);
    let empty = workspace.original(["-s", "scene.xml", "-d", "0", "-i", "empty.bin"]);
    assert_eq!(folder.out().replace("folder", "empty.bin"), empty.out());
    assert!(!workspace.exists("residual.txt"));
}

#[test]
fn the_message_about_a_missing_trace_names_the_third_word() {
    let workspace = Workspace::with_trace(BOUNCE);
    let run = workspace.original(["-i", "nowhere.bin", "-s", "scene.xml", "-d", "0"]);
    assert_eq!(
        run.err(),
        "\x1b[31;1mERROR IN INITIALIZATION: \x1b[mFailed to open binary input file:  `-s`   Exiting.\n"
    );
}

#[test]
fn input_that_crashes_the_original_gets_a_clear_message() {
    let workspace = Workspace::with_trace(BOUNCE);
    let mut huge = workspace.read("trace.bin");
    huge[72..76].copy_from_slice(&i32::MAX.to_le_bytes());
    workspace.write("huge.bin", huge);
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-i", "huge.bin"]);
    insta::assert_snapshot!("original_huge_count", run.shown());
    // A state that is not a number leads the original's root finder into an endless loop.
    let mut nan = trace_of(BEAM);
    nan[32..40].copy_from_slice(&f64::NAN.to_le_bytes());
    workspace.write("nan.bin", nan);
    workspace.write("beam.xml", BEAM);
    let run = workspace.original(["-s", "beam.xml", "-d", "0", "-i", "nan.bin"]);
    insta::assert_snapshot!("original_endless_search", run.shown());
    assert!(!workspace.exists("residual.txt"));
    workspace.write("broken.xml", "<scene><duration");
    let run = workspace.original(["-s", "broken.xml", "-d", "0", "-o", "x"]);
    insta::assert_snapshot!("original_broken_scene", run.shown());
    assert!(!workspace.exists("x"));
    let vortex = r#"<scene><duration time="1"/><integrator type="implicit-euler" dt="0.1"/>
        <particle m="1" px="0" py="0" vx="1" vy="0" fixed="0"/><particle m="1" px="1" py="0" vx="1" vy="0" fixed="0"/>
        <vortexforce i="0" j="1" kbs="1" kvc="1"/></scene>"#;
    workspace.write("vortex.xml", vortex);
    let run = workspace.original(["-s", "vortex.xml", "-d", "0", "-o", "v"]);
    insta::assert_snapshot!("original_vortex", run.shown());
}

#[test]
fn a_display_is_rejected() {
    let workspace = Workspace::with_trace(BOUNCE);
    for (arguments, says) in
        [(&["-s", "scene.xml"][..], "there is no window"), (&["-s", "scene.xml", "-d", "1", "-o", "x"], "add -d 0")]
    {
        let run = workspace.original(arguments);
        assert_eq!((run.code, run.stdout.len()), (Some(1), 0), "{arguments:?}");
        assert!(run.err().contains(says), "{}", run.err());
    }
    assert!(!workspace.exists("x"));
}

#[test]
fn pictures_are_made_beside_the_usual_output() {
    let workspace = Workspace::with_trace(BOUNCE);
    fs::create_dir(workspace.path("folder")).unwrap();
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-m", "nowhere"]);
    assert_eq!((run.code, run.err().as_str()), (Some(1), "Failure writing SVG file!\n"));
    assert!(run.out().ends_with(&format!("{}\n          ", "-".repeat(50))), "{}", run.out());
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-m", "nowhere", "-o", "first.bin"]);
    assert!(run.out().ends_with("Saved simulation to file 'first.bin'.\n"), "{}", run.out());
    assert_eq!(workspace.read("first.bin").len(), 40, "one record, with two empty lists");
    let run = workspace.original(GRADE.iter().chain(&["-m", "nowhere"]));
    assert!(run.out().contains("Maximum Velocity Residual: 0\n"), "{}", run.out());
    // The original aborts here.
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-g", "1"]);
    assert_eq!((run.code, run.stdout.len()), (Some(1), 0));
    assert!(run.err().starts_with("Error opening pngs/frame00001.png: there is no folder pngs"), "{}", run.err());
    fs::create_dir(workspace.path("pngs")).unwrap();
    let plain = workspace.original(["-s", "scene.xml", "-d", "0", "-o", "new.bin"]);
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-o", "new.bin", "-g", "1", "-m", "folder"]);
    assert_eq!(run.shown(), plain.shown());
    for name in ["pngs/frame00001.png", "pngs/frame00002.png", "folder/frame00000000000000000002.svg"] {
        assert!(workspace.exists(name), "{name}");
    }
    assert!(!workspace.exists("pngs/frame00003.png") && !workspace.exists("pngs/frame00000.png"));
    let first = workspace.read("pngs/frame00002.png");
    // Grading draws the trace.
    fs::remove_file(workspace.path("pngs/frame00002.png")).unwrap();
    let plain = workspace.original(GRADE);
    let run = workspace.original(GRADE.iter().chain(&["-g", "1"]));
    assert_eq!(run.shown(), plain.shown());
    assert!(workspace.read("pngs/frame00002.png") == first);
}

#[test]
fn scene_errors_are_the_originals() {
    let workspace = Workspace::new();
    let run = workspace.original(["-s", "nowhere.xml", "-d", "0"]);
    assert_eq!(
        (run.code, run.err().as_str()),
        (Some(1), "\x1b[31;1mERROR IN TWODSCENEXMLPARSER:\x1b[m XML scene file nowhere.xml. Failed to read file.\n")
    );
    workspace.write("plane.xml", BOUNCE.replace(r#" ny="1""#, ""));
    let run = workspace.original(["-s", "plane.xml", "-d", "0"]);
    assert_eq!((run.code, run.stdout.len()), (Some(0), 0), "the original ends with success here");
    assert!(run.err().contains("Failed to parse value of ny attribute for halfplane 0. Exiting."), "{}", run.err());
    let run = workspace.original(["-s", ".", "-d", "0"]);
    assert!(run.err().contains("Failed to locate root <scene> node"), "{}", run.err());
}

#[test]
fn names_and_descriptions_that_are_not_text_pass_through() {
    let workspace = Workspace::new();
    let scene = BOUNCE.replace("A ball bounces.", "@");
    let bytes: Vec<u8> = scene.bytes().map(|byte| if byte == b'@' { 0xe9 } else { byte }).collect();
    let name = OsStr::from_bytes(b"sc\xe8ne.xml");
    workspace.write(name, bytes);
    let trace = OsStr::from_bytes(b"tr\xe0ce.bin");
    let missing = workspace.original([OsStr::new("-s"), OsStr::from_bytes(b"n\xf6.xml"), "-d".as_ref(), "0".as_ref()]);
    assert!(missing.stderr.ends_with(b" XML scene file n\xf6.xml. Failed to read file.\n"), "{}", missing.err());
    let run = workspace.original([OsStr::new("-d"), "0".as_ref(), "-s".as_ref(), name, "-o".as_ref(), trace]);
    assert_eq!(run.code, Some(0), "{}", run.shown());
    let holds = |bytes: &[u8]| run.stdout.windows(bytes.len()).any(|window| window == bytes);
    assert!(holds(b"Scene: \x1b[msc\xe8ne.xml\n") && holds(b"Description: \x1b[m\xe9\n"));
    assert!(holds(b"Saved simulation to file 'tr\xe0ce.bin'.\n"));
    assert_eq!(workspace.read(trace), trace_of(BOUNCE));
}

#[test]
fn the_residual_file_is_written_through_and_failures_go_unnoticed() {
    let workspace = Workspace::with_trace(BOUNCE);
    workspace.write("target.txt", "something longer than four short lines of residuals, to be truncated");
    symlink("target.txt", workspace.path("residual.txt")).unwrap();
    workspace.original(GRADE);
    assert_eq!(workspace.read("target.txt"), b"1   0\n1   0\n1   0\n1   0\n");
    assert!(workspace.path("residual.txt").symlink_metadata().unwrap().is_symlink());
    fs::remove_file(workspace.path("residual.txt")).unwrap();
    fs::create_dir(workspace.path("residual.txt")).unwrap();
    let run = workspace.original(GRADE);
    assert_eq!((run.code, run.err().as_str()), (Some(0), ""));
    assert!(run.out().ends_with("Saved residual to residual.txt.\n"));
}

#[test]
fn outputs_that_cannot_be_opened_give_the_originals_message() {
    let workspace = Workspace::with_trace(BOUNCE);
    assert!(Command::new("mkfifo").arg(workspace.path("pipe")).status().unwrap().success());
    for name in ["no/such/folder", "pipe", "."] {
        let run = workspace.original(["-s", "scene.xml", "-d", "0", "-o", name]);
        assert_eq!((run.code, run.stdout.len()), (Some(1), 0));
        let text = format!(
            "\x1b[31;1mERROR IN INITIALIZATION: \x1b[mFailed to open binary output file:  `{name}`   Exiting.\n"
        );
        assert_eq!(run.err(), text);
    }
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-o", "scene.xml"]);
    assert_eq!(run.code, Some(1));
    assert_eq!(workspace.read("scene.xml"), BOUNCE.as_bytes());
}

/// Returns a scene whose trace is larger than a pipe's buffer of 64 KiB.
fn long_drift() -> String {
    DRIFT.replace(r#"time="1""#, r#"time="2000""#)
}

#[test]
fn a_pipe_that_is_read_slowly_gets_the_whole_trace() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", long_drift());
    assert!(Command::new("mkfifo").arg(workspace.path("pipe")).status().unwrap().success());
    let pipe = workspace.path("pipe");
    let mut reader =
        Command::new("sh").args(["-c", "exec 3<\"$0\"; sleep 0.3; cat <&3 >\"$0.got\""]).arg(&pipe).spawn().unwrap();
    let run = loop {
        // A pipe without a reader cannot be opened.
        let run = workspace.original(["-s", "scene.xml", "-d", "0", "-o", "pipe"]);
        if run.code == Some(0) || !run.err().contains("Failed to open binary output file") {
            break run;
        }
    };
    assert_eq!((run.code, run.err().as_str()), (Some(0), ""));
    assert!(reader.wait().unwrap().success());
    let trace = trace_of(&long_drift());
    assert!(trace.len() > 200_000);
    assert!(workspace.read("pipe.got") == trace, "the trace is not whole");
}

#[test]
fn standard_output_by_its_device_gets_the_whole_trace() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", long_drift());
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-o", "/dev/stdout"]);
    assert_eq!((run.code, run.err().as_str()), (Some(0), ""));
    assert!(run.stdout.len() > trace_of(&long_drift()).len());
}

#[test]
fn nobody_listening_changes_neither_exit_code_nor_files() {
    let workspace = Workspace::with_trace(BOUNCE);
    let mut child = workspace.command_as("FOSSSimOracle").args(GRADE).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(workspace.exists("residual.txt"));
}

/// Returns a scene of ten balls with different velocities, so that every pass logs polynomials of full length.
fn ten_balls(rounds: u32) -> String {
    let ball = |number: u32| {
        let i = f64::from(number);
        let (y, vx, vy) = (0.01 * i * i, if number == 0 { 9.0 } else { -0.1 * i }, 0.05 * i);
        format!(r#"<particle m="1" px="{number}" py="{y}" vx="{vx}" vy="{vy}" fixed="0" radius="0.1"/>"#)
    };
    let balls: String = (0..10).map(ball).collect();
    format!(
        r#"<scene><duration time="0.1"/><integrator type="symplectic-euler" dt="0.1"/>
        <collision type="hybrid" COR="1" maxiters="{rounds}" k="0" thickness="0"/>{balls}</scene>"#
    )
}

#[test]
fn an_impulse_loop_that_never_converges_fails_however_long_its_record_is() {
    // The response changes only velocities, so all rounds find the same collisions.
    let row = student::find("response-velocities-only").expect("a known mistake");
    let scene = scene::read("scene.xml", ten_balls(10_000).as_bytes()).expect("a scene").scene;
    let trace = student::record_trace(&scene, student::Student::new(Some(row.mistake))).expect("a trace");
    assert!(trace.len() > 40_000_000, "one record is as long as its rounds make it: {}", trace.len());
    let workspace = Workspace::new();
    workspace.write("trace.bin", trace);
    // A scene that does not allow such a record gives the same verdict and text.
    for rounds in [10_000, 5] {
        workspace.write("scene.xml", ten_balls(rounds));
        let run = workspace.original(GRADE);
        assert_eq!((run.code, run.err()), (Some(0), String::new()), "{rounds} rounds");
        assert!(run.out().contains("Wrong number of polynomials!\n"), "{}", run.shown());
        assert!(run.out().contains("Collisions Passed: No.\nOverall success: Failed.\n"), "{}", run.shown());
        let check = workspace.run(["check", "scene.xml", "trace.bin", "--rules", "parity", "--no-explain"]);
        assert_eq!(check.code, Some(1), "{}", check.shown());
        assert!(check.out().contains("900180 polynomials logged, expected 360"), "{}", check.shown());
    }
}
