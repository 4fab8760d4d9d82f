//! `detect`: the calculator for one pair.
use super::{
    schemas,
    workspace::{BEAM, BOUNCE, DRIFT, Run, Workspace},
};
use serde_json::Value;

fn detect(workspace: &Workspace, words: &str) -> Run {
    workspace.run(["detect"].into_iter().chain(words.split(' ')))
}

/// Returns the answer as JSON, checked against its schema.
fn answer(workspace: &Workspace, words: &str) -> Value {
    let run = detect(workspace, &format!("{words} --format json"));
    assert_eq!((run.code, run.err().as_str()), (Some(0), ""), "{words}");
    schemas::valid("detect", &run.stdout)
}

fn coefficients(json: &Value, number: usize) -> Vec<f64> {
    let list = json["polynomials"][number]["coefficients"].as_array().unwrap();
    list.iter().map(|value| value.as_f64().unwrap()).collect()
}

/// The worked examples of the assignment; both are in the help.
#[test]
fn the_assignments_examples() {
    let workspace = Workspace::new();
    let first = "pe:3,1+4,1:5,9+2,6:5,3+5,8 --radii 1,1";
    insta::assert_snapshot!("detect_first_example", detect(&workspace, first).shown());
    assert_eq!(coefficients(&answer(&workspace, first), 0), [-361.0, -304.0, -468.0, -288.0, 0.0]);
    let second = "pe:1,4+1,4:2,1+3,5:6,2+3,7 --radii 1,2";
    let json = answer(&workspace, second);
    assert_eq!(coefficients(&json, 0), [-16.0, 0.0, -68.0, 36.0, -16.0]);
    assert_eq!(json["answer"]["collides"], false);
    assert_eq!(answer(&workspace, "pe:1,4..2,8:2,1+3,5:6,2..9,9 --radii 1,2"), json);
    let help = detect(&workspace, "--help").out();
    assert!(help.contains(first) && help.contains(second), "{help}");
    assert!(help.contains("-361 t^4 - 304 t^3 - 468 t^2 - 288 t") && help.contains("-16 t^4 - 68 t^2 + 36 t - 16"));
}

#[test]
fn a_ball_meets_a_half_plane() {
    let workspace = Workspace::new();
    // The ball of the example in the format's description touches the half-plane after half the step.
    let run = detect(&workspace, "ph:0,0.5+0,-0.5:0,0:0,1 --radii 0.25");
    insta::assert_snapshot!("detect_half_plane", run.shown());
    let json = answer(&workspace, "ph:0,0.5+0,-0.5:0,0:0,1 --radii 0.25");
    assert_eq!((&json["answer"]["time"], &json["answer"]["normal"][1]), (&Value::from(0.5), &Value::from(-0.25)));
    assert_eq!(json["certain"], true);
    let later = answer(&workspace, "pp:0,0+1,0:10,0 --radii 1,1");
    assert!((later["answer"]["time"].as_f64().unwrap() - 8.0).abs() < 1e-12);
    assert_eq!(later["answer"]["collides"], false);
}

/// The polynomials of a scene's pair are the ones that the step's trace logs.
#[test]
fn a_pair_of_a_scene_is_what_the_trace_logs() {
    let workspace = Workspace::with_trace(BEAM);
    let shown = workspace.run("trace show scene.xml trace.bin --step 2 --format json".split(' '));
    let shown: Value = serde_json::from_slice(&shown.stdout).unwrap();
    let logged: Vec<_> = shown["records"][1]["polynomials"].as_array().unwrap().to_vec();
    let mut seen = 0;
    for (word, kind, first, second) in [
        ("pe:2,0", "particle-edge", 2, 0),
        ("pp:0,2", "particle-particle", 0, 2),
        ("pp:2,1", "particle-particle", 1, 2),
    ] {
        for source in ["", " --trace trace.bin"] {
            let json = answer(&workspace, &format!("--scene scene.xml{source} --step 2 --pair {word}"));
            let pair = serde_json::json!({ "kind": kind, "first": first, "second": second });
            let of_pair = logged.iter().filter(|one| one["pair"] == pair && one["pass"]["index"] == 0);
            let expected: Vec<_> = of_pair.map(|one| one["coefficients"].clone()).collect();
            let own = json["polynomials"].as_array().unwrap();
            assert_eq!(own.iter().map(|one| one["coefficients"].clone()).collect::<Vec<_>>(), expected);
            assert_eq!(
                json["place"]["logged"].as_array().map(Vec::as_slice),
                (!source.is_empty()).then_some(&expected[..])
            );
            seen += expected.len();
        }
    }
    assert_eq!(seen, 2 * (4 + 2 + 2));
    let passes = answer(&workspace, "--scene scene.xml --step 2 --pair pe:2,0")["place"]["passes"].as_u64().unwrap();
    assert!(passes > 1, "the beam is hit in this step");
    let last = answer(&workspace, &format!("--scene scene.xml --step 2 --pair pe:2,0 --pass {passes}"));
    assert_eq!(last["place"]["pass"]["index"], passes - 1);
    insta::assert_snapshot!(
        "detect_scene",
        detect(&workspace, "--scene scene.xml --trace trace.bin --step 2 --pair pe:2,0").shown()
    );
}

#[test]
fn a_wrong_polynomial_of_a_trace_is_shown_beside_the_right_one() {
    let workspace = Workspace::with_trace(BOUNCE);
    let mut trace = workspace.read("trace.bin");
    // This is the place of the first coefficient in the end record of step 1: after the state, one impulse, two counts
    // and the first size.
    let (record, place) = (32 + 4 + 4, 32 + 4 + 36 + 4 + 4);
    let mid = 32 + 4 + 36 + 4 + (4 + 24) + (4 + 16);
    let place = record + mid + place;
    assert_eq!(f64::from_le_bytes(trace[place..place + 8].try_into().unwrap()), -0.25);
    trace[place..place + 8].copy_from_slice(&(-0.75_f64).to_le_bytes());
    workspace.write("trace.bin", trace);
    let run = detect(&workspace, "--scene scene.xml --trace trace.bin --step 1 --pair ph:0,0");
    assert!(run.out().contains("  overlap: differs\n    -0.75 t^2 + 0.5 t - 0.1875\n"), "{}", run.shown());
    assert!(run.out().contains("  approach: the same\n"), "{}", run.shown());
    let table =
        "          expected    logged\n    t^2      -0.25     -0.75   <- differs\n    t^1        0.5       0.5\n";
    assert!(run.out().contains(table), "{}", run.shown());
}

/// With a factor, a program keeps round-off that the course's library drops from the reference's polynomials. The
/// trace's polynomials are still right, and they are found in their places although they lead to more passes.
#[test]
fn coefficients_kept_by_a_factor_are_not_wrong() {
    let workspace = Workspace::new();
    let text = r#"<scene><duration time="0.4"/><integrator type="symplectic-euler" dt="0.02"/>
        <collision type="hybrid" COR="1" maxiters="0" k="0" thickness="0"/>
        <particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="0.3"/>
        <particle m="1" px="9.67" py="11.81" vx="0" vy="0" fixed="0" radius="0.1"/>
        <simplegravity fx="0" fy="-3.7"/></scene>"#;
    workspace.write("scene.xml", text);
    let scene = fosssim_oracle::scene::read("scene", text.as_bytes()).expect("a scene").scene;
    let row = fosssim_oracle::student::find("scale-1000").expect("a variant");
    let student = fosssim_oracle::student::Student::new(Some(row.mistake));
    workspace.write("trace.bin", fosssim_oracle::student::record_trace(&scene, student).expect("a trace"));
    let mut kept = 0;
    for step in 1..=20 {
        let run = detect(&workspace, &format!("--scene scene.xml --trace trace.bin --step {step} --pair pp:0,1"));
        assert!(!run.out().contains("differs") && !run.out().contains("missing"), "{}", run.out());
        kept += usize::from(run.out().contains("right except for a factor and small leading coefficients"));
    }
    assert!(kept > 0);
}

/// The pair is found from the trace's own mid record. If the trace omits pairs, the polynomials of the others are still
/// found.
#[test]
fn a_pair_of_a_trace_that_logs_too_little_is_found() {
    let workspace = Workspace::new();
    let scene = "asset:ContinuousTimeTests/spinning-edge-sweeps-balls";
    let row = fosssim_oracle::student::find("pairs-pruned").expect("a mistake");
    let scene_file = fosssim_oracle::suite::library::find_scene(&scene["asset:".len()..]).expect("a scene");
    let read = fosssim_oracle::scene::original::read(scene_file);
    let student = fosssim_oracle::student::Student::new(Some(row.mistake));
    let trace = fosssim_oracle::student::record_trace(&read.expect("a scene").scene, student).expect("a trace");
    workspace.write("pruned.bin", trace);
    let pair = |word: &str| detect(&workspace, &format!("--scene {scene} --trace pruned.bin --step 1 --pair {word}"));
    assert!(
        pair("pp:0,1").out().contains("What the trace logged\n  nothing is logged for this pair in this pass\n"),
        "{}",
        pair("pp:0,1").shown()
    );
    assert!(pair("pe:2,0").out().contains("  overlap: the same\n"), "{}", pair("pe:2,0").shown());
    let json = answer(&workspace, &format!("--scene {scene} --trace pruned.bin --step 1 --pair pp:0,1"));
    assert_eq!(json["place"]["logged"], serde_json::json!([]));
}

#[test]
fn scenes_without_continuous_detection_give_the_motion_of_the_step() {
    let workspace = Workspace::new();
    let two =
        DRIFT.replace("</scene>", r#"<particle m="1" px="1" py="0" vx="0" vy="0" fixed="0" radius="0.5"/></scene>"#);
    workspace.write("scene.xml", two);
    let json = answer(&workspace, "--scene scene.xml --step 3 --pair pp:0,1");
    assert_eq!((&json["place"]["pass"], &json["place"]["passes"]), (&Value::Null, &Value::from(0)));
    assert_eq!(json["motion"]["points"][0]["start"], serde_json::json!([0.5, 0.25]));
}

#[test]
fn invalid_requests_are_reported() {
    let workspace = Workspace::with_trace(BEAM);
    for (words, says) in [
        ("--radii 1,1", "name a pair"),
        ("pe:3,1+4,1:5,9+2,6:5,3+5,8", "the radii are missing"),
        ("pe:3,1+4,1:5,9+2,6 --radii 1,1", "pe takes 3 points"),
        ("pp:1e200,0+1,0:0,0 --radii 1,1", "pp"),
        ("--scene scene.xml --step 4 --pair pe:2,0", "are 1 to 3"),
        ("--scene scene.xml --step 0 --pair pe:2,0", "there is no step 0"),
        ("--scene scene.xml --step 1 --pair pe:0,0", "particle 0 is an end of edge 0"),
        ("--scene scene.xml --step 1 --pair pe:2,1", "there is no edge 1; the scene's last edge is 0"),
        ("--scene scene.xml --step 1 --pair pp:1,1", "a particle cannot form a pair with itself"),
        ("--scene scene.xml --step 1 --pair pe:2,0 --pass 99", "there is no pass 99"),
        ("--scene scene.xml --step 1 --pair pe:2,0 --pass 0", "0 is not in 1.."),
        ("--scene scene.xml --step 1", "--pair"),
        ("--step 1 pp:0,0:1,1 --radii 1,1", "--scene"),
    ] {
        let run = detect(&workspace, words);
        if words.starts_with("pp:1e200") {
            // Parabolas have closed forms: infinite values have no result, but the program does not hang.
            assert_eq!(run.code, Some(0), "{}", run.shown());
            continue;
        }
        assert_eq!((run.code, run.stdout.len()), (Some(2), 0), "{words}: {}", run.shown());
        assert!(run.err().contains(says), "{words}: {}", run.err());
    }
    let endless = detect(&workspace, "pe:1e200,0+4,1:5,9+2,6:5,3+5,8 --radii 1,1");
    assert_eq!(endless.code, Some(2));
    assert!(
        endless.err().contains("the original would hang: the root search of the overlap polynomial"),
        "{}",
        endless.err()
    );
}

/// A pair that is wrong in a later pass is examined in that pass, because in the first pass nothing is wrong.
#[test]
fn the_pair_of_a_later_pass_is_examined_in_that_pass() {
    let workspace = Workspace::new();
    let scene = "asset:ImpulsesTests/row-of-five-one-end";
    let file = fosssim_oracle::suite::library::find_scene(&scene["asset:".len()..]).expect("a scene");
    let read = fosssim_oracle::scene::original::read(file).expect("a scene").scene;
    let row = fosssim_oracle::student::find("loop-anew").expect("a mistake");
    let student = fosssim_oracle::student::Student::new(Some(row.mistake));
    workspace.write("trace.bin", fosssim_oracle::student::record_trace(&read, student).expect("a trace"));
    let run = workspace.run(["check", scene, "trace.bin", "--rules", "fair"]);
    let command = run.out().lines().find(|line| line.contains("fosssim-oracle detect ")).expect("a command").to_owned();
    assert!(command.ends_with(" --step 2 --pair pp:0,1 --pass 3"), "{}", run.shown());
    let words = command.split_once("fosssim-oracle ").expect("a command").1.to_owned();
    let run = workspace.run(words.split(' '));
    assert!(run.code == Some(0) && run.out().contains("differs"), "{}", run.shown());
}
