//! Explanations of each known mistake, by one trace and by several.
use super::{
    corpus,
    fair::{assets, rows, simulated},
    grading, schemas,
    workspace::Workspace,
};
use fosssim_oracle::{
    diagnose::{ExamplePlace, Explanation, explain, explain_together, find_formula, find_known},
    judge::{fair::FairVerdict, replay},
    scene::{Scene, original},
    sim::PairKind,
    student::{self, FALSE_POSITIVES, Row, RowKind},
};
use fosssim_testing::{Need, skip};
use rayon::prelude::*;
use serde_json::Value;
use std::process::Command;

/// Scenes that show most mistakes of programs: a teacher's small suite.
const SCENES: [&str; 16] = [
    "ContinuousTimeTests/explicit-euler-under-gravity",
    "ContinuousTimeTests/impact-exactly-at-step-end",
    "ContinuousTimeTests/spinning-edge-sweeps-balls",
    "ContinuousTimeTests/stretching-edge-meets-balls",
    "ForcesTests/forces-between-collisions",
    "GeometricTests/ball-on-a-fixed-edge",
    "GeometricTests/chain-pushed-into-a-half-plane",
    "GeometricTests/limit-of-three-iterations",
    "GeometricTests/tiny-edge-just-missed",
    "GeometricTests/triangle-of-unequal-masses",
    "HalfPlaneTests/moving-fixed-ball-and-impulses",
    "HalfPlaneTests/normals-of-length-two-and-one-half",
    "HalfPlaneTests/touched-exactly-at-step-end",
    "HolisticTests/pendulum-into-a-wall-of-balls",
    "HolisticTests/wheel-on-a-slope",
    "IntegratorTests/implicit-euler-then-collisions",
];

fn suite() -> Vec<(String, Scene)> {
    let scenes: Vec<_> = assets().into_iter().filter(|(name, _)| SCENES.contains(&name.as_str())).collect();
    assert_eq!(scenes.len(), SCENES.len());
    scenes
}

/// Returns the explanations of the row's traces that the fair rules reject. After the first two, only the known
/// mistakes are searched.
fn explained(scenes: &[(String, Scene)], row: &Row) -> Vec<Vec<Explanation>> {
    let options = replay::Options { threads: 1, uses_fair_rules: true, ..replay::Options::default() };
    let mut found = Vec::new();
    for (_, scene) in scenes {
        let Some(trace) = simulated(scene, Some(row)) else { continue };
        let fair = replay::judge(scene, &trace[..], &options, &mut ()).fair.expect("the fair rules were asked");
        if fair.verdict == FairVerdict::Rejected {
            found.push(if found.len() < 2 { explain(scene, &trace) } else { find_known(scene, &trace[..]) });
        }
    }
    found
}

/// Every third mistake is explained here; `scripts/explanation-matrix` explains all of them. Mistakes that change no
/// trace of the course's scenes do not count.
#[test]
fn nine_of_ten_mistakes_are_named_first() {
    let scenes = suite();
    let rows: Vec<_> = rows(RowKind::Wrong).into_iter().step_by(3).collect();
    let named: Vec<Option<String>> = rows
        .par_iter()
        .map(|row| (row, explained(&scenes, row)))
        .filter(|(_, all)| !all.is_empty())
        .map(|(row, all)| match explain_together(all.iter().map(Vec::as_slice), &[]).into_iter().next() {
            Some(first) if first.key == row.id => None,
            Some(first) => Some(format!("{}: {} {:?}", row.id, first.key, first.same_as)),
            None => Some(format!("{}: nothing, {} rejected traces", row.id, all.len())),
        })
        .collect();
    let confused: Vec<&String> = named.iter().flatten().collect();
    eprintln!("{} of {} mistakes named first; the others:\n{confused:#?}", named.len() - confused.len(), named.len());
    assert!(10 * confused.len() <= named.len() && 10 * named.len() > 9 * rows.len(), "{confused:#?}");
}

/// The mistakes of the corpus's submissions, by name. If the fair rules reject one of their traces, the mistake is
/// named first, or reported together with mistakes that this trace cannot distinguish from it.
const SUBMISSIONS: [(&str, &str); 27] = [
    ("b02-", "pp-no-two"),
    ("b03-", "pp-radii-squared-apart"),
    ("b14-", "pp-first-radius-twice"),
    ("b16-", "handover-single-precision"),
    ("b17-", "handover-position-only"),
    ("b32-", "pe-edge-still"),
    ("b35-", "pe-no-cubic"),
    ("b36-", "pe-cubic-one-bc"),
    ("b37-", "pe-radii-squared-apart"),
    ("b42-", "ph-no-normal-square"),
    ("b53-", "pp-tiny-error"),
    ("c02-", "pp-contact-at-start"),
    ("c05-", "decision-open-start"),
    ("c18-", "ph-contact-undivided"),
    ("c21-", "contact-unit-length"),
    ("d01-", "loop-once-when-zero"),
    ("d03-", "loop-test-when-zero"),
    ("d05-", "loop-anew"),
    ("d08-", "loop-always-fails"),
    ("e02-", "failsafe-center-unweighted"),
    ("e05-", "failsafe-fixed-forgotten"),
    ("e08-", "failsafe-velocity-no-step"),
    ("e13-", "geometric-finds-in-vain"),
    ("e17-", "failsafe-small-angle"),
    ("e22-", "zones-one-endpoint"),
    ("e32-", "failsafe-angular-doubled"),
    ("real1", "failsafe-angular-doubled"),
];

#[test]
fn mistakes_of_the_corpus_submissions_are_named() {
    let Some(folder) = corpus::folder() else { return };
    let text = std::fs::read_to_string(folder.join("verdicts.jsonl")).expect("readable");
    let rows: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let options = replay::Options { threads: 1, uses_fair_rules: true, ..replay::Options::default() };
    let named: Vec<Option<String>> = rows
        .par_iter()
        .filter_map(|row| {
            let text = |key: &str| row[key].as_str().unwrap_or_default();
            let (_, id) = SUBMISSIONS.iter().find(|(start, _)| text("submission").starts_with(start))?;
            let file = row["trace_file"].as_str()?;
            let scene = std::fs::read(folder.join(format!("scenes/{}.xml", text("scene")))).expect("readable");
            let scene = original::read(&scene).expect("a scene").scene;
            let trace = corpus::unpack(&folder.join(file));
            let fair = replay::judge(&scene, &trace[..], &options, &mut ()).fair.expect("the fair rules were asked");
            (fair.verdict == FairVerdict::Rejected).then(|| {
                let found = explain(&scene, &trace);
                let first = found.first().map(|first| (first.key.clone(), first.same_as.clone())).unwrap_or_default();
                let is_named = first.0 == *id || first.1.iter().any(|other| other == id);
                (!is_named).then(|| format!("{} on {}: {first:?}", text("submission"), text("scene")))
            })
        })
        .collect();
    let misnamed: Vec<&String> = named.iter().flatten().collect();
    assert!(misnamed.is_empty(), "{misnamed:#?}");
    corpus::ran("mistakes_of_the_corpus_submissions_are_named", named.len());
}

/// No correct variant is reported as wrong: the fair rules accept it, so no explanation is requested. If an explanation
/// is requested anyway, it names nothing, except for the variants in this list. A fix for one of them removes it from
/// the list.
#[test]
fn correct_variants_are_not_reported() {
    let scenes = suite();
    let accused: Vec<(&str, Vec<String>)> = rows(RowKind::Variant)
        .into_par_iter()
        .map(|row| {
            let accusations = scenes.iter().filter_map(|(name, scene)| {
                let found = explain(scene, &simulated(scene, Some(row)).unwrap());
                let keys: Vec<&str> = found.iter().map(|explanation| explanation.key.as_str()).collect();
                (!keys.is_empty()).then(|| format!("{name}: {keys:?}"))
            });
            (row.id, accusations.collect())
        })
        .collect();
    let wrong: Vec<_> = accused.iter().filter(|(id, keys)| keys.is_empty() == FALSE_POSITIVES.contains(id)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

const SPINNING: &str = "asset:ContinuousTimeTests/spinning-edge-sweeps-balls";

fn write_trace(workspace: &Workspace, id: &str) {
    let (_, scene) =
        assets().into_iter().find(|(name, _)| SPINNING.ends_with(name.as_str())).expect("a built-in scene");
    workspace.write("submission.bin", simulated(&scene, student::find(id)).unwrap());
}

#[test]
fn a_dropped_term_is_named_with_an_example() {
    let workspace = Workspace::new();
    write_trace(&workspace, "pe-square-no-eh");
    let run = workspace.run(["explain", SPINNING, "submission.bin"]);
    assert_eq!(run.code, Some(1), "{}", run.err());
    let text = run.out();
    assert!(
        text.contains("Particle-edge: A product is missing in the quadratic coefficient of the overlap."),
        "{text}"
    );
    assert!(text.contains("coefficient of t^2 lacks the term -4 e h") && text.contains("d21 is dx2 - dx1"), "{text}");
    assert!(text.contains("expected") && text.contains("actual"), "{text}");
    let run = workspace.run(["explain", SPINNING, "submission.bin", "--format", "json"]);
    let report = schemas::valid("explain", &run.stdout);
    assert_eq!(report["traces"][0]["explanations"][0]["key"], "pe-square-no-eh");
    let run = workspace.run(["explain", SPINNING, "submission.bin", "--hints", "what"]);
    let text = run.out();
    let (_, told) = text.split_once("likely mistake: ").expect("a likely mistake");
    assert!(told.starts_with("Particle-edge: A product is missing"), "{text}");
    let told = told.lines().next().unwrap_or_default();
    let sentence = told.split(" (reproduces ").next().unwrap_or_default();
    assert_eq!(find_formula(sentence), None, "no formula: {text}");
    assert!(!text.contains("expected") && !text.contains("t^2"), "no value: {text}");
}

/// One wrong coefficient has one name and one expected value, in both rule books.
#[test]
fn the_headline_names_the_coefficient_that_differs() {
    let workspace = Workspace::new();
    write_trace(&workspace, "pe-linear-one-ab");
    for rules in ["parity", "fair"] {
        let run = workspace.run(["check", SPINNING, "submission.bin", "--rules", rules, "--format", "json"]);
        let report: Value = serde_json::from_str(&run.out()).unwrap();
        let first = &report["first_divergence"];
        assert_eq!(first["coefficient"], 1, "{rules}: {first}");
        let text = workspace.run(["check", SPINNING, "submission.bin", "--rules", rules]).out();
        let (_, block) = text.split_once("First difference").expect("a first difference");
        let headline = block.lines().nth(1).expect("a headline");
        let (_, expected) = headline.split_once("expected ").expect("one number");
        assert!(headline.contains("coefficient of t: "), "{headline}");
        let row = block.lines().find(|line| line.contains("<- differs")).expect("a marked row");
        assert!(row.trim().starts_with("t ") && row.contains(expected), "{row}, expected {expected}");
    }
}

#[test]
fn the_example_of_a_wrong_normal_shows_both() {
    let (_, scene) =
        assets().into_iter().find(|(name, _)| name.ends_with("head-on-equal-masses")).expect("a built-in scene");
    let trace = simulated(&scene, student::find("pp-contact-reversed")).unwrap();
    let explanations = explain(&scene, &trace);
    let example = explanations[0].example.as_ref().expect("an example");
    let (kind, first, second) = (Some(PairKind::ParticleParticle), 0, 1);
    assert_eq!(example.place, ExamplePlace::Contact { kind, first, second });
    assert!(example.expected.len() == 3 && example.expected[0] == -example.actual[0], "{example:?}");
    assert_eq!(example.expected[2].to_bits(), example.actual[2].to_bits());
}

#[test]
fn nothing_is_explained_where_nothing_is_wrong() {
    let workspace = Workspace::new();
    write_trace(&workspace, "scale-1000");
    let run = workspace.run(["explain", SPINNING, "submission.bin"]);
    assert_eq!(run.code, Some(0));
    assert!(run.out().contains("nothing to explain"), "{}", run.out());
    let report = workspace.run(["explain", SPINNING, "submission.bin", "--format", "json"]);
    assert_eq!(schemas::valid("explain", &report.stdout)["accepted"], true);
}

#[test]
fn a_program_at_hand_is_asked_on_probe_scenes() {
    let workspace = Workspace::new();
    for (id, accepted) in [("", true), ("failsafe-angular-overwritten", false), ("pe-linear-one-sh", false)] {
        let name = if id.is_empty() { "fosssim-sample".to_owned() } else { format!("fosssim-sample.{id}") };
        std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_fosssim-sample"), workspace.path(&name)).expect("a link");
        // The path goes up and down again, as shells complete paths.
        std::fs::create_dir_all(workspace.path("build")).expect("a folder");
        let run = workspace.run(["explain", "--program", &format!("build/../{name}"), "--format", "json"]);
        if run.code == Some(2) && run.err().contains("sandbox") {
            skip(Need::Sandbox, run.err());
            return;
        }
        let report = schemas::valid("explain", &run.stdout);
        assert_eq!(report["accepted"], accepted, "{name}: {}", run.err());
        let common = report["common"]["key"].as_str().unwrap_or_default();
        assert_eq!(common, id, "{name}");
        assert_eq!(report["smallest"].as_array().expect("a list").is_empty(), accepted, "{name}");
    }
    let program = "./fosssim-sample.pe-linear-one-sh";
    let first = workspace.run(["shrink", program, "--format", "json"]);
    let first = &schemas::valid("explain", &first.stdout)["smallest"][0];
    let words =
        first["again"].as_str().expect("a command").replace("fosssim-oracle", env!("CARGO_BIN_EXE_fosssim-oracle"));
    let script = format!("{words} --format json");
    let again = Command::new("sh").args(["-c", &script]).current_dir(workspace.path("")).output().expect("a shell");
    assert_eq!(schemas::valid("explain", &again.stdout)["smallest"][0]["scene"], first["scene"], "{script}");
    let run = workspace.run(["shrink", program, SPINNING, "--output", "small.xml"]);
    assert!(run.code == Some(1) && run.out().contains("The smallest scene: 3 bodies, 1 step"), "{}", run.shown());
    assert!(run.out().contains("<- differs") && run.out().contains("By hand\nPass 1: "), "{}", run.shown());
    // A second run is wrong for the same reason.
    let again = workspace.run(["shrink", program, "small.xml", "--format", "json"]);
    let again = schemas::valid("explain", &again.stdout);
    assert_eq!(again["common"]["key"], "pe-linear-one-sh");
    assert_eq!(again["smallest"][0]["scene"], std::fs::read_to_string(workspace.path("small.xml")).expect("a scene"));
    let run = workspace.run(["shrink", program, "small.xml", "--step", "2"]);
    assert!(run.code == Some(2) && run.err().contains("the last step of small.xml is 1"), "{}", run.shown());
    let run = workspace.run(["shrink", "./fosssim-sample", "small.xml"]);
    assert!(run.code == Some(0) && run.out().contains("Nothing is wrong"), "{}", run.shown());
    // The example of the cause shows the only wrong polynomial, which is not shown again after scaling.
    let reversed = workspace.path("fosssim-sample.pp-reversed");
    std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_fosssim-sample"), reversed).expect("a link");
    let out = workspace.run(["shrink", "./fosssim-sample.pp-reversed"]).out();
    assert!(out.contains("      actual    -3 t^2\n") && !out.contains("Step 1 of 1"), "{out}");
}

#[test]
fn wrong_usage_is_reported() {
    let workspace = Workspace::new();
    let run = workspace.run(["explain", SPINNING]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("a scene and a trace, or --program"), "{}", run.err());
    let run = workspace.run(["explain", "--program", "./missing"]);
    assert_eq!(run.code, Some(2), "{}", run.out());
    assert!(run.err().contains("missing"), "{}", run.err());
}

/// If a program writes no trace, the report contains how it ended and its output. Text is not a trace.
#[test]
fn without_a_trace_there_is_nothing_to_explain() {
    let Some(workspace) = grading::workspace() else { return };
    workspace.write("older", "#!/bin/sh\nprintf '\\033[31;1minvalid collision type hybrid\\033[m\\n' >&2\nexit 1\n");
    std::fs::set_permissions(workspace.path("older"), std::os::unix::fs::PermissionsExt::from_mode(0o755))
        .expect("ours");
    let run = workspace.run(["explain", "--program", "./older", "--suite", "T2M2"]);
    assert!(run.code == Some(1) && run.err().contains("another milestone"), "{}", run.shown());
    let said = "exited with code 1 and wrote no trace; its standard error ends with: invalid collision type hybrid";
    assert!(run.out().contains(said), "{}", run.shown());
    workspace.write("notes.txt", "nothing but some words\n");
    let run = workspace.run(["explain", SPINNING, "notes.txt"]);
    assert!(run.code == Some(2) && run.err().contains("is not a trace: it looks like text"), "{}", run.shown());
}

/// The library of T1M3 runs implicit integrators, rejects one other and has no collisions, whatever a student's code
/// contains.
#[test]
fn a_program_of_another_milestone_is_known_by_the_scenes_that_it_takes() {
    let Some(workspace) = grading::workspace() else { return };
    let script = "#!/bin/sh\nwhile read -r line || [ -n \"$line\" ]; do case $line in *forward-backward-euler*)\n\
                  printf '\\033[31;1mInvalid integrator\\033[m\\n' >&2; exit 1;; esac; done < \"$2\"\n\
                  printf x > \"$6\"\n";
    workspace.write("older", script);
    std::fs::set_permissions(workspace.path("older"), std::os::unix::fs::PermissionsExt::from_mode(0o755))
        .expect("ours");
    let run = workspace.run(["grade", "older", "--scene", "GeometricTests/b*"]);
    let told = "it looks like a program of Theme 1, Milestone 3, which is not the milestone of this suite";
    assert!(run.code == Some(1) && run.out().contains(told) && run.out().lines().count() < 8, "{}", run.shown());
    assert!(run.out().contains(": grade it with --suite t1m3"), "{}", run.shown());
    // A teacher's own suite also has a milestone. Only a reader at a terminal can type an option.
    assert_eq!(workspace.run(["suite", "init", "-o", "course.toml"]).code, Some(0));
    let page = ["--suite", "course.toml", "--scene", "GeometricTests/b*", "--format", "html=older.html"];
    let run = workspace.run([&["grade", "older"][..], &page].concat());
    let html = std::fs::read_to_string(workspace.path("older.html")).expect("a page");
    assert!(run.code == Some(1) && html.contains(&told["it ".len()..]) && !html.contains("--suite"), "{}", run.shown());
    let run = workspace.run(["explain", "--program", "./older"]);
    assert!(run.code == Some(1) && run.err().contains("program of Theme 1, Milestone 3"), "{}", run.shown());
}

/// The small scenes belong to the program's milestone.
#[test]
fn a_program_of_any_milestone_is_explained() {
    let Some(workspace) = grading::workspace() else { return };
    let programs = grading::submit(&workspace, &["", "spring-direction", "drag-sign", "near-pairs-last-missing"]);
    let explain = |program: &str, milestone: &str| {
        workspace.run(["explain", "--program", program, "--suite", milestone, "--format", "json"])
    };
    for milestone in ["t1m1", "t1m2", "t1m3", "t2m1", "t2m2", "t2m3"] {
        let right = explain(&programs[0], milestone);
        assert_eq!(right.code, Some(0), "{milestone}: {}", right.shown());
    }
    for (program, milestone, key) in
        [(1, "t1m2", "spring-direction"), (2, "t1m2", "drag-sign"), (3, "t2m3", "near-pairs")]
    {
        let wrong = explain(&programs[program], milestone);
        assert!(wrong.code == Some(1) && wrong.out().contains(&format!("\"key\": \"{key}\"")), "{}", wrong.shown());
    }
    let unknown = explain(&programs[0], "t3m1");
    assert!(unknown.code == Some(2) && unknown.err().contains("t2m3"), "{}", unknown.shown());
}
