//! `scene`: the embedded scenes.
use crate::workspace::Workspace;
use fosssim_oracle::suite::library;

#[test]
fn every_scene_is_listed_with_a_line_about_it() {
    let workspace = Workspace::new();
    let run = workspace.run(["scene", "list"]);
    assert_eq!(run.code, Some(0), "{}", run.shown());
    let text = run.out();
    assert_eq!(text.lines().count(), library::all_names().count());
    for (line, name) in text.lines().zip(library::all_names()) {
        let words = line.strip_prefix(&format!("asset:{name}")).unwrap_or_else(|| panic!("{line}"));
        assert!(words.contains(" step") && words.trim().len() > 20, "{line}");
    }
    let names = workspace.run(["scene", "list", "--quiet", "Geometric*", "asset:HolisticTests/balls-in-a-box"]).out();
    let groups = |line: &str| line.starts_with("asset:GeometricTests/") || line == "asset:HolisticTests/balls-in-a-box";
    assert!(names.lines().count() > 2 && names.lines().all(groups), "{names}");
    let of_assignments = ["t2m1/*", "t2m2/*", "t1m1/*", "t1m2/*", "t1m3/*", "t2m3@1/*", "t2m3@2/*"]
        .map(|folder| workspace.run(["scene", "list", "--quiet", folder]).out());
    assert!(of_assignments[0].contains("asset:SimpleTests/") && of_assignments[1].contains("asset:GeometricTests/"));
    // Two scenes of continuous-time collisions are in no suite, and six are only in the first versions of t1m2 and
    // t1m3.
    assert_eq!(of_assignments.concat().lines().count() + 8, library::all_names().count());
    let full = ["asset:t2m2/HolisticTests/balls-in-a-box"; 2];
    assert_eq!(workspace.run(["check", full[0], full[1]]).code, Some(0));
}

#[test]
fn a_scene_is_shown_as_it_is_and_can_be_judged_with() {
    let workspace = Workspace::new();
    let name = "HolisticTests/balls-in-a-box";
    for word in [
        "HolisticTests/balls-in-a-box",
        "asset:HolisticTests/balls-in-a-box",
        "balls-in-a-box",
        "t2m2/HolisticTests/balls-in-a-box",
    ] {
        let run = workspace.run(["scene", "show", word]);
        assert_eq!((run.code, run.stdout.as_slice()), (Some(0), library::find_scene(name).expect("a scene")), "{word}");
    }
    let run = workspace.run(["scene", "show", "HolisticTests/balls"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("; the nearest are "), "{}", run.err());
}

#[test]
fn scenes_are_exported_and_what_is_there_is_not_harmed() {
    let workspace = Workspace::new();
    let run = workspace.run(["scene", "export", "HolisticTests/*", "--output", "scenes"]);
    assert_eq!(run.code, Some(0), "{}", run.shown());
    let exported: Vec<_> = library::all_names().filter(|name| name.starts_with("HolisticTests/")).collect();
    assert!(run.out().starts_with(&format!("{} scenes written to scenes", exported.len())), "{}", run.out());
    for name in &exported {
        assert_eq!(workspace.read(format!("scenes/{name}.xml")), library::find_scene(name).expect("a scene"));
    }
    let again = workspace.run(["scene", "export", "HolisticTests/*", "--output", "scenes"]);
    assert!(again.out().contains("there already"), "{}", again.shown());
    let mine = format!("scenes/{}.xml", exported[0]);
    workspace.write(&mine, "mine");
    let refused = workspace.run(["scene", "export", "--output", "scenes"]);
    assert_eq!(refused.code, Some(2), "{}", refused.shown());
    assert!(refused.err().contains(&mine) && refused.err().contains("--force"), "{}", refused.err());
    assert_eq!(workspace.read(&mine), b"mine");
    assert!(
        workspace.exists(format!("scenes/{}.xml", library::all_names().next().expect("a scene"))),
        "the others are"
    );
    let forced = workspace.run(["scene", "export", "--output", "scenes", "--force", "--quiet"]);
    assert_eq!((forced.code, forced.out()), (Some(0), String::new()), "{}", forced.shown());
    assert_eq!(workspace.read(&mine), library::find_scene(exported[0]).expect("a scene"));
    let run = workspace.run(["scene", "export", "NoSuchTests/*", "--output", "none"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("NoSuchTests/* matches no scene; the scenes are "), "{}", run.err());
    assert!(!workspace.exists("none"));
}
