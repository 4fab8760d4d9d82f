//! `render`: images and animations of motions.
use super::workspace::{BEAM, BOUNCE, Run, Workspace, finish};
use std::{fs, os::unix::fs::PermissionsExt, os::unix::fs::symlink};

fn render(workspace: &Workspace, words: &str) -> Run {
    workspace.run(["render"].into_iter().chain(words.split(' ')))
}

fn made(workspace: &Workspace, words: &str) -> Run {
    let run = render(workspace, words);
    assert_eq!((run.code, run.err().as_str()), (Some(0), ""), "{words}: {}", run.shown());
    run
}

#[test]
fn films_are_made_in_one_command_and_are_equal_on_two_runs() {
    let workspace = Workspace::with_trace(BEAM);
    let run = made(&workspace, "scene.xml --output film.gif");
    assert!(run.out().starts_with("4 pictures of 640x480: steps 0 to 3, 25 per second, 0.16 s, "), "{}", run.out());
    let gif = workspace.read("film.gif");
    assert!(gif.starts_with(b"GIF89a\x80\x02\xe0\x01") && gif.ends_with(b";"));
    made(&workspace, "scene.xml --output film.gif");
    assert!(workspace.read("film.gif") == gif, "it differs on the second run");
    // The reference's own trace gives the same motion.
    made(&workspace, "scene.xml trace.bin --output film.gif");
    assert!(workspace.read("film.gif") == gif, "it differs for the trace");
    assert_eq!(workspace.list(), ["film.gif", "scene.xml", "trace.bin"]);
}

#[test]
fn a_folder_gets_a_picture_per_step_under_the_originals_names() {
    let workspace = Workspace::with_trace(BEAM);
    let run = made(&workspace, "scene.xml --format png --output pngs --size 64x48");
    assert_eq!(run.out(), "3 pictures of 64x48: steps 1 to 3, frame00001.png to frame00003.png, into pngs\n");
    made(&workspace, "scene.xml --format svg --output svgs --size 64x48 --every 2");
    let names = |folder: &str| {
        let list = fs::read_dir(workspace.path(folder)).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = list.collect();
        names.sort();
        names
    };
    assert_eq!(names("pngs"), ["frame00001.png", "frame00002.png", "frame00003.png"]);
    assert_eq!(names("svgs"), ["frame00000000000000000001.svg"]);
    insta::assert_snapshot!("svg", String::from_utf8(workspace.read("svgs/frame00000000000000000001.svg")).unwrap());
    // The image after a step is the same in the animation and on its own.
    made(&workspace, "scene.xml --step 2 --output one.png --size 64x48");
    assert!(workspace.read("one.png") == workspace.read("pngs/frame00002.png"));
    let run = render(&workspace, "scene.xml --format png --output pngs --size 64x48 --every 2");
    assert_eq!(run.err(), "pngs also contains older pictures, from frame00002.png on\n");
}

#[test]
fn a_second_trace_is_drawn_on_top() {
    let workspace = Workspace::with_trace(BOUNCE);
    let mut other = workspace.read("trace.bin");
    // This moves the last record's position by one unit. The end record of step 2 is the last 32 bytes before its
    // lists.
    let place = other.len() - (32 + 4 + 4 + 28 + 20);
    assert_eq!(f64::from_le_bytes(other[place..place + 8].try_into().unwrap()), 0.0);
    other[place..place + 8].copy_from_slice(&1.0_f64.to_le_bytes());
    workspace.write("other.bin", other);
    made(&workspace, "scene.xml trace.bin --overlay other.bin --step 2 --output both.svg");
    let svg = String::from_utf8(workspace.read("both.svg")).unwrap();
    assert_eq!(svg.matches("stroke-dasharray").count(), 1);
    assert_eq!(svg.matches("<circle").count(), 2);
    made(&workspace, "scene.xml --step 2 --output one.svg");
    assert_eq!(String::from_utf8(workspace.read("one.svg")).unwrap().matches("<circle").count(), 1);
}

#[test]
fn a_damaged_trace_is_drawn_as_far_as_it_goes() {
    let workspace = Workspace::with_trace(BEAM);
    let trace = workspace.read("trace.bin");
    workspace.write("cut.bin", &trace[..trace.len() - 9]);
    let run = render(&workspace, "scene.xml cut.bin --output cut.gif");
    assert_eq!(run.code, Some(1), "{}", run.shown());
    assert!(run.err().starts_with("the trace cut.bin ends early: "), "{}", run.err());
    assert!(run.out().starts_with("3 pictures of 640x480: steps 0 to 2"), "{}", run.out());
    workspace.write("empty.bin", "");
    let run = render(&workspace, "scene.xml empty.bin --output empty.gif");
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("there is nothing to draw of the trace empty.bin"), "{}", run.err());
    assert!(!workspace.exists("empty.gif"));
}

#[test]
fn invalid_input_is_rejected_before_anything_is_written() {
    let workspace = Workspace::with_trace(BEAM);
    for (words, says) in [
        (
            "scene.xml --output x.gif --size 0x480",
            "0x480 is out of range; width and height must be between 16 and 7680 pixels",
        ),
        ("scene.xml --output x.gif --size 640x99999999999", "is not a size; write WIDTHxHEIGHT"),
        ("scene.xml --output x.gif --fps 0", "--fps must be between 1 and 240"),
        ("scene.xml --output x.gif --every 0", "--every"),
        ("scene.xml --output x.gif --every 4 --format png", "no step is drawn: the scene has 3 steps, and --every 4"),
        ("scene.xml --output x.png", "x.png can hold one picture: add --step N"),
        ("scene.xml --output x", "choose the format of x: --format svg or --format png"),
        ("scene.xml --output x.gif --step 1", "--step is for one picture"),
        ("scene.xml --output x.png --step 4", "the scene has 3 steps; there is no step 4"),
        ("scene.xml --output x.mp4 --size 641x480", "an MP4 needs even width and height, not 641x480"),
        ("scene.xml trace.bin --output trace.bin --format gif", "this is also an input"),
        ("scene.xml --output scene.xml --format gif", "this is also an input"),
        ("scene.xml --output no/such/x.gif", "there is no folder no/such"),
        ("scene.xml --output scene.xml --format png", "scene.xml is not a folder"),
    ] {
        let run = render(&workspace, words);
        assert_eq!((run.code, run.stdout.len()), (Some(2), 0), "{words}: {}", run.shown());
        assert!(run.err().contains(says), "{words}: {}", run.err());
    }
    let long = BEAM.replace(r#"time="0.3""#, r#"time="1000000""#);
    workspace.write("long.xml", long);
    let run = render(&workspace, "long.xml --output pictures --format png");
    assert!(run.err().contains("more than the limit of 100000; add --every 101"), "{}", run.err());
    assert_eq!(workspace.list(), ["long.xml", "scene.xml", "trace.bin"]);
}

/// A prepared folder cannot make the program write to other places.
#[test]
fn links_in_a_folder_of_pictures_are_replaced_and_not_followed() {
    let workspace = Workspace::with_trace(BEAM);
    workspace.write("precious", "old");
    fs::create_dir(workspace.path("pngs")).unwrap();
    symlink("../precious", workspace.path("pngs/frame00001.png")).unwrap();
    made(&workspace, "scene.xml --format png --output pngs --size 64x48");
    assert_eq!(workspace.read("precious"), b"old");
    assert!(!workspace.path("pngs/frame00001.png").symlink_metadata().unwrap().is_symlink());
}

/// Creates an ffmpeg that stores its input and its arguments.
fn with_ffmpeg(workspace: &Workspace, film: &str) {
    let script = format!(
        "#!/bin/sh\nfor last; do :; done\nif [ \"$last\" = -encoders ]; then echo ' V....D libx264  H.264'; exit; fi\n\
         echo \"$*\" > arguments\n{film}\n"
    );
    workspace.write("bin/ffmpeg", script);
    fs::set_permissions(workspace.path("bin/ffmpeg"), fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn an_mp4_is_made_by_ffmpeg_from_raw_pictures() {
    let workspace = Workspace::with_trace(BEAM);
    let run = |path: &str| {
        let mut command = workspace.command();
        finish(command.args("render scene.xml --output film.mp4 --size 32x16".split(' ')).env("PATH", path))
    };
    let path = format!("{}:/usr/bin:/bin", workspace.path("bin").display());
    with_ffmpeg(&workspace, "cat > \"${last#file:}\"");
    let made = run(&path);
    assert_eq!((made.code, made.err().as_str()), (Some(0), ""), "{}", made.shown());
    assert_eq!(workspace.read("film.mp4").len(), 4 * 4 * 32 * 16);
    let arguments = String::from_utf8(workspace.read("arguments")).unwrap();
    assert!(
        arguments.contains("-f rawvideo -pix_fmt rgba -s 32x16 -r 25 -i pipe:0") && arguments.contains(" file:"),
        "{arguments}"
    );
    with_ffmpeg(&workspace, "echo 'disk on fire' >&2; exit 3");
    let failed = run(&path);
    assert_eq!(failed.code, Some(2));
    assert!(failed.err().contains("ffmpeg failed (exit status: 3): disk on fire"), "{}", failed.err());
    assert_eq!(workspace.read("film.mp4").len(), 4 * 4 * 32 * 16, "the old film is unharmed");
    let missing = run("/nonexistent");
    assert_eq!(missing.code, Some(2));
    assert!(
        missing.err().contains("needs ffmpeg, which is not installed") && missing.err().contains("an output .gif"),
        "{}",
        missing.err()
    );
    assert_eq!(workspace.list(), ["arguments", "bin", "film.mp4", "scene.xml", "trace.bin"]);
}
