//! Points for speed, with programs whose processor times are far apart.
use crate::{
    grading,
    workspace::{Run, Workspace},
};
use serde_json::Value;

/// Returns a suite with 60 points for scenes and 40 for speed. The program computes this many million useless rounds.
fn suite(busy: u32, scenes: &str) -> String {
    let words = ["{program}", "-s", "{scene}", "-d", "0", "-o", "{trace}", "--busy", &busy.to_string()];
    let run = words.map(|word| format!("\"{word}\"")).join(", ");
    format!(
        "schema = 1\nname = \"contest\"\nrun = [{run}]\n\
         [[group]]\nname = \"Crowd\"\npoints = 60\nscenes = [{scenes}]\n\
         [group.speed]\npoints = 40\nfull_at = 10\nnone_at = 20\nruns = 2\n"
    )
}

const SCENES: &str = "\"asset:ImpulsesTests/off-centre-on-turning-edge\", \"asset:GeometricTests/pair-becomes-rigid\"";

fn grade(workspace: &Workspace, program: &str, more: &[&str]) -> (Run, Value) {
    let run = workspace.run([&["grade", program, "--suite", "contest.toml", "--format", "json"], more].concat());
    let json: Value = serde_json::from_slice(&run.stdout).unwrap_or_else(|_| panic!("{}", run.shown()));
    (run, json["grades"][0].clone())
}

#[test]
fn a_fast_program_has_all_points_and_a_slow_one_those_for_being_right() {
    let Some(workspace) = grading::workspace() else { return };
    let program = grading::submit(&workspace, &[""]).remove(0);
    for (busy, speed, points) in [(0, 40.0, 100.0), (60, 0.0, 60.0)] {
        workspace.write("contest.toml", suite(busy, SCENES));
        let (run, grade) = grade(&workspace, &program, &[]);
        assert_eq!(run.code, Some(0), "{}", run.shown());
        let found = &grade["groups"][0]["speed"];
        assert_eq!(
            (&found["points"], &grade["points"], &grade["max_points"]),
            (&speed.into(), &points.into(), &100.0.into()),
            "{grade:#}"
        );
        assert_eq!(found["runs"], 2);
        let of = |key: &str| found[key].as_f64().expect("a ratio");
        assert!(of("least_ratio") <= of("greatest_ratio") && (of("ratio") < 10.0) == (busy == 0), "{found}");
        // Every report shows where the points come from.
        let words = found["text"].as_str().expect("words").to_owned();
        assert!(words.contains("times the reference's processor time; 2 rounds gave"), "{words}");
        for format in ["text", "html", "gradescope", "prairielearn"] {
            let run = workspace.run(["grade", &program, "--suite", "contest.toml", "--format", format]);
            assert!(
                run.out().contains("times the reference&#39;s") || run.out().contains("times the reference's"),
                "{format}: {}",
                run.shown()
            );
        }
    }
}

/// Correctness comes first, and a repeated grading measures nothing again.
#[test]
fn speed_counts_once_all_scenes_are_accepted_and_is_measured_once() {
    let Some(workspace) = grading::workspace() else { return };
    workspace.write("contest.toml", suite(0, SCENES));
    let wrong = grading::submit(&workspace, &["response-sign"]).remove(0);
    let (_, wrong) = grade(&workspace, &wrong, &[]);
    assert_eq!(
        (&wrong["groups"][0]["speed"]["points"], &wrong["groups"][0]["speed"]["runs"]),
        (&0.0.into(), &0.into())
    );
    let right = grading::submit(&workspace, &[""]).remove(0);
    let again = || grade(&workspace, &right, &["--output", "out"]).1;
    let (first, second) = (again(), again());
    assert_eq!(first["groups"][0]["speed"], second["groups"][0]["speed"]);
    assert_eq!(second["groups"][0]["scenes"][0]["cached"], true);
    // Times from another machine do not count.
    let journal = String::from_utf8(workspace.read("out/journal.jsonl")).expect("text");
    assert!(journal.contains("\"machine\":\""), "{journal}");
    workspace.write("out/journal.jsonl", journal.replace("\"machine\":\"", "\"machine\":\"other "));
    assert_eq!(again()["groups"][0]["scenes"][0]["cached"], false);
    // Traces have no times.
    let traces = workspace.run(["grade", "--traces", ".", "--suite", "contest.toml", "--format", "json"]);
    let traces: Value = serde_json::from_slice(&traces.stdout).expect("JSON");
    assert_eq!(traces["grades"][0]["max_points"], 60.0);
}

#[test]
fn a_suite_says_what_is_wrong_with_its_points_for_speed() {
    let workspace = Workspace::new();
    let check = |suite: String| {
        workspace.write("contest.toml", suite);
        workspace.run(["suite", "check", "contest.toml"])
    };
    let sound = check(suite(0, SCENES));
    assert!(
        sound.code == Some(0) && sound.out().contains("speed: 40 points, full points up to 10 times"),
        "{}",
        sound.shown()
    );
    let turned = check(suite(0, SCENES).replace("none_at = 20", "none_at = 5"));
    assert!(turned.code == Some(2) && turned.err().contains("greater than speed.full_at (10)"), "{}", turned.shown());
    let misspelt = check(suite(0, SCENES).replace("none_at", "nothing_at"));
    assert!(misspelt.code == Some(2) && misspelt.err().contains("nothing_at"), "{}", misspelt.shown());
}
