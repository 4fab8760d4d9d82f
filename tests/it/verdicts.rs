//! The original's verdicts: every row of the corpus, by the drop-in and by `check`, on one thread and on several.
use super::{
    corpus,
    workspace::{Run, Workspace},
};
use serde_json::Value;
use similar::TextDiff;
use std::path::Path;

/// Returns the rows of `verdicts.jsonl`.
fn rows(folder: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(folder.join("verdicts.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Returns a folder with the row's scene and trace, as the original had it.
fn workspace(folder: &Path, row: &Value) -> Workspace {
    let workspace = Workspace::new();
    let scene = scene(row);
    workspace.write(&scene, std::fs::read(folder.join(&scene)).unwrap());
    if let Some(trace) = row["trace_file"].as_str() {
        workspace.write("submission.bin", corpus::unpack(&folder.join(trace)));
    }
    workspace
}

fn scene(row: &Value) -> String {
    format!("scenes/{}.xml", row["scene"].as_str().unwrap())
}

fn name(row: &Value) -> String {
    format!("{} {}", row["submission"], row["scene"])
}

/// Returns whether the original ended by itself.
fn ended(row: &Value) -> bool {
    row["oracle_end"].as_str().unwrap().starts_with("exit")
}

#[test]
fn the_drop_in_prints_what_the_original_printed() {
    let Some(folder) = corpus::folder() else { return };
    let rows = rows(&folder);
    for row in &rows {
        let workspace = workspace(&folder, row);
        let run = workspace.original(["-s", &scene(row), "-d", "0", "-i", "submission.bin"]);
        if ended(row) {
            compare(row, &workspace, &run);
        } else {
            assert_eq!(run.code, Some(1), "{}", name(row));
            assert!(!run.out().contains("Passed."), "{}", name(row));
            assert!(!run.stderr.is_empty() && !workspace.exists("residual.txt"), "{}", name(row));
        }
    }
    corpus::ran("the_drop_in_prints_what_the_original_printed", rows.len());
}

/// Checks that standard output, standard error, `residual.txt` and the exit code are the original's.
fn compare(row: &Value, workspace: &Workspace, run: &Run) {
    let expected = row["stdout"].as_str().unwrap();
    // The corpus stores bytes as Latin-1.
    let actual: String = run.stdout.iter().map(|&byte| char::from(byte)).collect();
    if actual != expected {
        let diff = TextDiff::from_lines(expected, actual.as_str());
        let diff = diff.unified_diff().header("original", "drop-in").to_string();
        panic!("{}: standard output differs\n{}", name(row), diff.chars().take(4000).collect::<String>());
    }
    assert_eq!(run.err(), row["oracle_stderr"].as_str().unwrap(), "{}", name(row));
    let code: i32 = row["oracle_end"].as_str().unwrap().strip_prefix("exit ").unwrap().parse().unwrap();
    assert_eq!(run.code, Some(code), "{}", name(row));
    match row["residual_txt"].as_str() {
        Some(text) => assert_eq!(workspace.read("residual.txt"), text.as_bytes(), "{}", name(row)),
        None => assert!(!workspace.exists("residual.txt"), "{}", name(row)),
    }
}

#[test]
fn check_gives_the_originals_verdict_on_one_thread_and_on_many() {
    let Some(folder) = corpus::folder() else { return };
    let rows: Vec<_> = rows(&folder).into_iter().filter(|row| !row["trace_file"].is_null()).collect();
    for row in &rows {
        let workspace = workspace(&folder, row);
        let scene = scene(row);
        let check = |threads| {
            let fixed = ["check", &scene, "submission.bin", "--format", "json", "--no-explain", "--threads", threads];
            workspace.run(fixed)
        };
        let (one, many) = (check("1"), check("8"));
        assert_eq!(one.shown(), many.shown(), "{}", name(row));
        let report: Value = serde_json::from_slice(&one.stdout).unwrap_or_else(|_| panic!("{}", one.shown()));
        let verdict = match row["overall"].as_str().unwrap() {
            "passed" => ("accepted", 0),
            "failed" => ("wrong answer", 1),
            _ => ("bad trace", 1),
        };
        assert_eq!((report["verdict"].as_str().unwrap(), one.code.unwrap()), verdict, "{}", name(row));
        if !ended(row) {
            continue;
        }
        let parity = &report["parity"];
        assert_eq!(parity["overall"], row["overall"], "{}", name(row));
        assert_eq!(parity["messages"], row["messages"], "{}", name(row));
        let passed = row["collisions_passed"].as_str().map(|word| word == "Yes");
        assert_eq!(parity["collisions_passed"].as_bool(), passed, "{}", name(row));
        for (key, field) in [
            ("acc_pos", "accumulated_position_residual"),
            ("acc_vel", "accumulated_velocity_residual"),
            ("max_pos", "maximum_position_residual"),
            ("max_vel", "maximum_velocity_residual"),
        ] {
            // The corpus has no residuals of the empty traces; the complete standard output is compared above.
            let Some(expected) = row["residuals"][key][0].as_str() else { continue };
            let text = match &parity[field] {
                Value::String(text) => text.clone(),
                number => fosssim_oracle::report::number::format_g(number.as_f64().unwrap()),
            };
            assert_eq!(text, expected, "{} {key}", name(row));
        }
    }
    corpus::ran("check_gives_the_originals_verdict_on_one_thread_and_on_many", rows.len());
}
