//! `trace info`, `trace show`.
use super::workspace::{BEAM, BOUNCE, Workspace};
use serde_json::Value;

#[test]
fn info_says_what_a_trace_holds() {
    let workspace = Workspace::with_trace(BOUNCE);
    insta::assert_snapshot!("info", workspace.run(["trace", "info", "scene.xml", "trace.bin"]).shown());
    let run = workspace.run(["trace", "info", "scene.xml", "trace.bin", "--format", "json"]);
    insta::assert_snapshot!("info_json", run.shown());
    let trace = workspace.read("trace.bin");
    workspace.write("cut.bin", &trace[..trace.len() - 9]);
    insta::assert_snapshot!("info_cut", workspace.run(["trace", "info", "scene.xml", "cut.bin"]).shown());
}

#[test]
fn show_puts_one_step_into_words() {
    let workspace = Workspace::with_trace(BEAM);
    let show = |step: &str, format: &str| {
        workspace.run(["trace", "show", "scene.xml", "trace.bin", "--step", step, "--format", format])
    };
    insta::assert_snapshot!("show_initial", show("0", "text").shown());
    insta::assert_snapshot!("show_step", show("2", "text").shown());
    let json: Value = serde_json::from_slice(&show("2", "json").stdout).unwrap();
    assert_eq!(json["records"].as_array().unwrap().len(), 2);
    assert_eq!(json["records"][1]["polynomials"][0]["role"], "overlap");
    let run = show("4", "text");
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("has 3 steps; there is no step 4"), "{}", run.err());
    let trace = workspace.read("trace.bin");
    workspace.write("cut.bin", &trace[..trace.len() - 9]);
    let run = workspace.run(["trace", "show", "scene.xml", "cut.bin", "--step", "3"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("cannot show step 3 of the trace cut.bin: byte "), "{}", run.err());
}

#[test]
fn streams_without_an_end_are_given_up() {
    let workspace = Workspace::with_trace(BOUNCE);
    insta::assert_snapshot!("info_endless", workspace.run(["trace", "info", "scene.xml", "/dev/zero"]).shown());
    let run = workspace.run(["trace", "info", "scene.xml", "/dev/zero", "--format", "json"]);
    let json: Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!((&json["sha256"], &json["all_bytes_read"]), (&Value::Null, &Value::Bool(false)));
    std::fs::File::create(workspace.path("sparse.bin")).unwrap().set_len(10_000_000_000).unwrap();
    let run = workspace.run(["trace", "info", "scene.xml", "sparse.bin"]);
    assert_eq!(run.code, Some(1));
    assert!(run.out().contains("67108864 bytes follow the last record"), "{}", run.shown());
}
