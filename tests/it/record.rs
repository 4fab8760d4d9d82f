//! `record`: recordings, their check, and the embedded ones.
use super::workspace::{BEAM, BOUNCE, Workspace, trace_of};

fn assets() -> Workspace {
    let workspace = Workspace::new();
    workspace.write("assets/Balls/bounce.xml", BOUNCE);
    workspace.write("assets/Beams/beam.xml", BEAM);
    workspace.write("assets/README.md", "not a scene");
    workspace
}

#[test]
fn recordings_are_written_and_found_the_same() {
    let workspace = assets();
    let run = workspace.run(["record"]);
    assert_eq!(run.code, Some(0), "{}", run.shown());
    let packed = workspace.read("references/Balls/bounce.bin.zst");
    assert_eq!(zstd::decode_all(&packed[..]).unwrap(), trace_of(BOUNCE));
    let manifest = String::from_utf8(workspace.read("references/manifest.txt")).unwrap();
    let steps = String::from_utf8(workspace.read("references/Balls/bounce.steps")).unwrap();
    insta::assert_snapshot!("recording", format!("{manifest}\n{steps}"));
    let check = workspace.run(["record", "--check"]);
    assert_eq!((check.code, check.out().as_str()), (Some(0), "2 recordings, 5 steps: all the same\n"));
    // A second recording changes nothing.
    assert_eq!(workspace.run(["record"]).code, Some(0));
    assert_eq!(workspace.read("references/Balls/bounce.bin.zst"), packed);
}

#[test]
fn a_byte_that_differs_fails_the_check_with_a_diff() {
    let workspace = assets();
    workspace.run(["record"]);
    workspace.write("assets/Balls/bounce.xml", BOUNCE.replace(r#"vy="-1""#, r#"vy="-1.5""#));
    workspace.write("assets/Balls/new.xml", BOUNCE);
    std::fs::remove_file(workspace.path("assets/Beams/beam.xml")).unwrap();
    let before = workspace.read("references/manifest.txt");
    let run = workspace.run(["record", "--check"]);
    assert_eq!(run.code, Some(1));
    insta::assert_snapshot!("recording_differs", run.shown());
    assert_eq!(workspace.read("references/manifest.txt"), before, "a check writes nothing");
    // A second recording repairs the file, and removes recordings without a scene.
    assert_eq!(workspace.run(["record"]).code, Some(0));
    assert_eq!(workspace.run(["record", "--check"]).code, Some(0));
    assert!(!workspace.exists("references/Beams/beam.bin.zst") && !workspace.exists("references/Beams/beam.steps"));
}

/// Scenes may be in one folder per assignment. Their names do not change, and their recordings are in the same folders.
#[test]
fn a_folder_per_assignment_changes_no_name() {
    let workspace = assets();
    workspace.run(["record"]);
    let manifest = workspace.read("references/manifest.txt");
    std::fs::create_dir(workspace.path("assets/t2m2")).unwrap();
    std::fs::rename(workspace.path("assets/Balls"), workspace.path("assets/t2m2/Balls")).unwrap();
    let check = workspace.run(["record", "--check"]);
    assert_eq!(check.code, Some(1));
    let words = "Balls/bounce: there is no recording\nBalls/bounce: there is a recording, but no scene\n";
    assert_eq!(check.out(), words, "what was recorded lies elsewhere");
    assert_eq!(workspace.run(["record"]).code, Some(0));
    assert!(
        workspace.exists("references/t2m2/Balls/bounce.steps") && !workspace.exists("references/Balls/bounce.steps")
    );
    assert_eq!(workspace.read("references/manifest.txt"), manifest);
    assert_eq!(workspace.run(["record", "--check"]).out(), "2 recordings, 5 steps: all the same\n");
    // A name may belong to only one scene.
    workspace.write("assets/Balls/bounce.xml", BOUNCE);
    let twice = workspace.run(["record", "--check"]);
    assert_eq!(twice.code, Some(2));
    assert!(twice.err().contains("would both be called Balls/bounce; rename one of them"), "{}", twice.err());
}

#[test]
fn scenes_that_cannot_be_recorded_are_named() {
    let workspace = Workspace::new();
    let run = workspace.run(["record"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("cannot read the scenes in assets"), "{}", run.err());
    workspace.write("assets/README.md", "not a scene");
    assert!(workspace.run(["record"]).err().contains("there is no scene in assets"));
    workspace.write("assets/Bad/bad.xml", "<scene/>");
    let run = workspace.run(["record"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("cannot record Bad/bad: the scene has errors"), "{}", run.err());
    assert!(!workspace.exists("references"));
}

#[test]
fn the_embedded_recordings_are_what_is_simulated_now() {
    // This folder contains no file of the checkout, so `record --check` checks the embedded scenes.
    let run = Workspace::new().run(["record", "--check"]);
    assert_eq!(run.code, Some(0), "{}", run.shown().chars().take(4000).collect::<String>());
}

#[test]
fn a_named_folder_is_meant_even_when_it_is_not_there() {
    let run = Workspace::new().run(["record", "--check", "--references", "nope"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("cannot read the scenes in assets"), "{}", run.err());
    let workspace = Workspace::new();
    workspace.write("assets/Balls/bounce.xml", BOUNCE);
    assert!(workspace.run(["record"]).out().starts_with("1 recording, "));
    assert_eq!(workspace.run(["record", "--check"]).out(), "1 recording, 2 steps: all the same\n");
}

#[test]
fn every_embedded_scene_is_accepted_with_its_recording() {
    let workspace = Workspace::new();
    let mut scenes = 0;
    for name in fosssim_oracle::suite::library::scene_names() {
        let asset = format!("asset:{name}");
        let run = workspace.run(["check", &asset, &asset]);
        assert_eq!((run.code, run.err().as_str()), (Some(0), ""), "{name}: {}", run.shown());
        scenes += 1;
    }
    assert!(scenes >= 48, "{scenes} scenes");
}
