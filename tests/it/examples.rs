//! The programs in `examples`, each with the input that its first line requires.
use crate::workspace::{Workspace, root, submission};
use fosssim_oracle::{sandbox::Supervisor, suite::library};
use fosssim_testing::{Need, skip};

#[expect(dead_code, reason = "its `main` is not called here")]
#[path = "../../examples/explain.rs"]
mod explain;
#[expect(dead_code, reason = "its `main` is not called here")]
#[path = "../../examples/grade.rs"]
mod grade;
#[expect(dead_code, reason = "its `main` is not called here")]
#[path = "../../examples/judge.rs"]
mod judge;
#[expect(dead_code, reason = "its `main` is not called here")]
#[path = "../../examples/render.rs"]
mod render;
#[expect(dead_code, reason = "its `main` is not called here")]
#[path = "../../examples/walk.rs"]
mod walk;

/// Returns the scene of the README's first command, and the wrong trace that comes with it.
fn flawed() -> (&'static [u8], Vec<u8>) {
    let scene = library::find_scene("ContinuousTimeTests/spinning-edge-sweeps-balls").expect("an embedded scene");
    (scene, std::fs::read(root().join("examples/traces/flawed.bin")).expect("a trace"))
}

#[test]
fn a_wrong_trace_is_judged_explained_and_walked() {
    let (scene, trace) = flawed();
    let verdicts = judge::run(scene, &trace).expect("a sound scene");
    assert!(verdicts.starts_with("original: wrong answer\nfair: wrong answer\nstep "), "{verdicts}");
    let mistakes = explain::run(scene, &trace).expect("a sound scene");
    assert!(mistakes.starts_with("pe-"), "{mistakes}");
    let records = walk::run(scene, &trace).expect("a whole trace");
    assert!(records.lines().count() > 1 && records.contains("impulses, particle 0 at ["), "{records}");
    assert!(walk::run(scene, &trace[..trace.len() - 9]).is_err(), "a trace that is cut short");
}

#[test]
fn a_scene_is_drawn() {
    let picture = render::run(flawed().0).expect("a sound scene");
    assert!(picture.starts_with("<svg") && picture.contains("<circle"), "{picture}");
}

#[test]
fn a_folder_of_programs_is_graded() {
    let workspace = Workspace::new();
    if workspace.run(["doctor"]).code != Some(0) {
        skip(Need::Sandbox, "programs can't be run safely");
        return;
    }
    workspace.write("class/right", submission("right"));
    workspace.write("class/wrong", "no program");
    workspace.write(
        "suite.toml",
        "schema = 1\nname = \"one\"\n[[group]]\nname = \"g\"\nscenes = [\"asset:ImpulsesTests/o*\"]\npoints = 1\n",
    );
    let suite = workspace.path("suite.toml").display().to_string();
    let supervisor = Supervisor::from_path(env!("CARGO_BIN_EXE_fosssim-oracle"));
    let grades = grade::run(&workspace.path("class"), &suite, supervisor).expect("a grading");
    let mut lines: Vec<&str> = grades.lines().collect();
    lines.sort_unstable();
    assert_eq!(lines[0], "right: Accepted, Some(1.0) of 1 points", "{grades}");
    assert!(lines[1].starts_with("wrong: ") && !lines[1].contains("Accepted"), "{grades}");
}
