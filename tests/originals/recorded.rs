//! Checks that each built-in scene is recorded as by its milestone's original.
use fosssim_oracle::{
    assignments::Assignment,
    suite::{library, recording::Recording},
};
use rayon::prelude::*;

use crate::{oracle::Originals, workspace::Workspace};

/// Returns the original's trace of a scene, and its output before the trace.
fn original(originals: &Originals, milestone: Assignment, scene: &[u8]) -> Result<Vec<u8>, String> {
    let workspace = Workspace::new();
    workspace.write("scene.xml", scene);
    let run = originals.run(milestone, &workspace.path(""), ["-s", "scene.xml", "-d", "0", "-o", "trace.bin"]);
    if run.code == Some(0) && workspace.exists("trace.bin") {
        Ok(workspace.read("trace.bin"))
    } else {
        Err(run.shown())
    }
}

#[test]
fn bundled_scenes_are_recorded_as_their_originals_record_them() {
    let Some(originals) = Originals::find() else { return };
    let names: Vec<&str> = library::scene_names().collect();
    let differing: Vec<String> = names
        .par_iter()
        .filter_map(|name| {
            let milestone = library::find_assignment(name).expect("a scene of a milestone");
            let scene = library::find_scene(name).expect("a scene");
            let fault = match original(&originals, milestone, scene) {
                Ok(trace) => {
                    (trace != Recording::for_scene(name, scene).expect("a recording").trace).then(String::new)?
                }
                Err(shown) => shown,
            };
            Some(format!("{name} {fault}"))
        })
        .collect();
    assert!(differing.is_empty(), "{} of {} scenes differ:\n{}", differing.len(), names.len(), differing.join("\n"));
}
