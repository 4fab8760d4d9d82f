//! The two rule books side by side, as users see them: their verdicts on correct variants and on garbage.
use super::{
    schemas,
    workspace::{Run, Workspace},
};
use fosssim_oracle::suite::library;
use serde_json::Value;
use std::path::Path;

/// Returns a workspace with an embedded scene and the sample program's trace of it.
fn sampled(scene: &str, mistake: &str) -> Workspace {
    let workspace = Workspace::new();
    workspace.write("scene.xml", library::find_scene(scene).expect("an embedded scene"));
    sample(&workspace.path("scene.xml"), &workspace.path("trace.bin"), mistake);
    workspace
}

#[expect(clippy::disallowed_types, reason = "these tests are about a program, so they start it")]
fn sample(scene: &Path, trace: &Path, mistake: &str) {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_fosssim-sample"));
    let output = command.arg("-s").arg(scene).arg("-o").arg(trace).args(["--mistake", mistake]).output();
    assert!(output.expect("the sample starts").status.success());
}

/// Returns the run and its report as JSON, checked against its schema.
fn report(workspace: &Workspace, rules: &str) -> (Run, Value) {
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--format", "json", "--rules", rules]);
    let value = schemas::valid("check", &run.stdout);
    (run, value)
}

#[test]
fn correct_programs_that_the_original_fails_are_accepted_and_the_rule_is_named() {
    for (scene, mistake, cause) in [
        ("GeometricTests/tiny-edge-just-missed", "scale-2", "dropped_coefficients"),
        ("ContinuousTimeTests/bullet-through-thin-obstacles", "scale-1000", "absolute_coefficients"),
        ("ImpulsesTests/off-centre-on-turning-edge", "quintic-right", "approach_form"),
    ] {
        let workspace = sampled(scene, mistake);
        let (run, json) = report(&workspace, "both");
        assert_eq!((run.code, &json["verdict"]), (Some(1), &"wrong answer".into()), "{scene} {mistake}");
        assert_eq!(json["fair"]["verdict"], "accepted", "{scene} {mistake}");
        assert_eq!(json["difference"]["key"], cause, "{scene} {mistake}");
        // The official rule book decides the verdict at the top.
        let (run, json) = report(&workspace, "fair");
        assert_eq!((run.code, &json["verdict"]), (Some(0), &"accepted".into()), "{scene} {mistake}");
        assert_eq!((&json["official"], &json["wrong_steps"]), (&"fair".into(), &0.into()), "{scene} {mistake}");
        assert_eq!(json["first_divergence"], Value::Null, "{scene} {mistake}");
        assert_eq!(json["parity"]["overall"], "failed", "{scene} {mistake}");
    }
}

#[test]
fn a_wrong_trace_comes_with_its_likely_mistake_unless_nobody_asks() {
    let workspace = sampled("ImpulsesTests/off-centre-on-turning-edge", "pe-square-no-eh");
    let (run, json) = report(&workspace, "both");
    assert_eq!((run.code, &json["explanations"][0]["key"]), (Some(1), &"pe-square-no-eh".into()), "{json:#}");
    let text = workspace.run(["check", "scene.xml", "trace.bin"]);
    assert!(text.out().contains("Likely cause\n  likely mistake: "), "{}", text.shown());
    let silent = workspace.run(["check", "scene.xml", "trace.bin", "--no-explain"]);
    assert!(!silent.out().contains("likely mistake"), "{}", silent.shown());
    // Correct programs that the original rejects have no mistake.
    let (_, json) = report(&sampled("GeometricTests/tiny-edge-just-missed", "scale-2"), "both");
    assert_eq!(json["explanations"], serde_json::json!([]));
}

#[test]
fn garbage_that_the_original_passes_is_rejected_and_the_rule_is_named() {
    let scene = "ContinuousTimeTests/oblique-glancing-blow";
    for (mistake, cause, verdict) in [
        ("log-tiny", "small_errors", "wrong answer"),
        ("log-nan", "not_a_number", "wrong answer"),
        ("log-duplicate-impulses", "repeated_collision", "wrong answer"),
        // The scene has no zones, so the trace is right.
        ("zones-reversed", "trailing_bytes", "bad trace"),
    ] {
        let workspace = sampled(scene, mistake);
        if cause == "trailing_bytes" {
            workspace.write("trace.bin", [&workspace.read("trace.bin")[..], &[0; 8]].concat());
        }
        let (run, json) = report(&workspace, "both");
        assert_eq!((run.code, &json["verdict"]), (Some(0), &"accepted".into()), "{mistake}");
        assert_eq!((&json["difference"]["key"], &json["fair"]["verdict"]), (&cause.into(), &"rejected".into()));
        let (run, json) = report(&workspace, "fair");
        assert_eq!((run.code, &json["verdict"]), (Some(1), &verdict.into()), "{mistake}");
    }
}

#[test]
fn scenes_that_depend_on_round_off_are_reported() {
    let workspace = Workspace::new();
    // At the end of the first step the ball touches the half-plane, except for a rounding error.
    let ball = |vx, vy| {
        format!(
            "<scene><duration time=\"1\"/><integrator type=\"explicit-euler\" dt=\"0.5\"/>\
             <collision type=\"continuous-time\" COR=\"1\"/><particle m=\"1\" px=\"0.6\" py=\"0.8\" vx=\"{vx}\" \
             vy=\"{vy}\" fixed=\"0\" radius=\"0.1\"/><halfplane px=\"0\" py=\"0\" nx=\"0.3\" ny=\"0.4\"/></scene>"
        )
    };
    workspace.write("touch.xml", ball("-1.08", "-1.44"));
    workspace.write("clear.xml", ball("-0.3", "-0.4"));
    let suite = |scenes: &str| {
        let text = format!("schema = 1\nname = \"test\"\n[[group]]\nname = \"a\"\nscenes = [{scenes}]\n");
        workspace.write("suite.toml", text);
        workspace.run(["suite", "check", "suite.toml"])
    };
    let noted = suite("\"touch.xml\", \"clear.xml\"");
    assert_eq!(noted.code, Some(0), "{}", noted.shown());
    insta::assert_snapshot!("suite_check", noted.shown());
    let clear = suite("\"clear.xml\"");
    assert!(!clear.out().contains("note:"), "{}", clear.shown());
}

#[test]
fn parity_alone_says_nothing_of_fairness() {
    let workspace = sampled("ContinuousTimeTests/oblique-glancing-blow", "log-tiny");
    let (run, json) = report(&workspace, "parity");
    assert_eq!((run.code, &json["fair"], &json["difference"]), (Some(0), &Value::Null, &Value::Null));
    let text = workspace.run(["check", "scene.xml", "trace.bin", "--rules", "parity"]);
    assert!(!text.out().contains("Fair rules"), "{}", text.shown());
}

#[test]
fn the_text_says_why_the_books_differ() {
    let workspace = sampled("GeometricTests/tiny-edge-just-missed", "scale-2");
    insta::assert_snapshot!("scale_two", workspace.run(["check", "scene.xml", "trace.bin"]).shown());
    let fair = workspace.run(["check", "scene.xml", "trace.bin", "--rules", "fair"]);
    insta::assert_snapshot!("scale_two_fair", fair.shown());
    let workspace = sampled("ContinuousTimeTests/oblique-glancing-blow", "log-duplicate-impulses");
    insta::assert_snapshot!("duplicate_impulses", workspace.run(["check", "scene.xml", "trace.bin"]).shown());
}
