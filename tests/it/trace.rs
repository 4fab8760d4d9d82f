//! `trace show`.
use super::workspace::{BEAM, Workspace};
use serde_json::Value;

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
