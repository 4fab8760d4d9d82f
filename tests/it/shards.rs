//! A grading that is divided among machines: the merged results are those of a single grading.
use crate::{
    grading::workspace,
    workspace::{Workspace, submission},
};
use std::fs;

const MISTAKES: [(&str, &str); 4] = [
    ("ada", "pe-square-no-eh"),
    ("bob", "pp-contact-reversed"),
    ("carol", "pe-square-no-eh"),
    ("dave", "contact-time-zero"),
];

/// Creates six submissions: four with a mistake, a right one, and one that does nothing.
fn class(workspace: &Workspace) {
    fs::create_dir_all(workspace.path("class")).expect("a folder");
    for (name, mistake) in MISTAKES {
        let program = format!("class/{name}");
        let made = workspace.run(["demo", "--mistake", mistake, "--program", &program]);
        assert_eq!(made.code, Some(0), "{}", made.shown());
    }
    workspace.write("class/eve", submission("right"));
    fs::copy("/bin/true", workspace.path("class/frank")).expect("a copy");
}

/// Returns a table, a page or JSON lines without measurements.
fn without_measurements(name: &str, bytes: &[u8]) -> String {
    let text = String::from_utf8(bytes.to_vec()).expect("text");
    if name.ends_with(".csv") {
        let mut reader = csv::Reader::from_reader(bytes);
        let head = reader.headers().expect("a head").clone();
        let measured = |at: usize| head[at].ends_with("_seconds");
        let rows = std::iter::once(head.clone()).chain(reader.records().map(|row| row.expect("a row")));
        let kept = rows.map(|row| {
            let cells = row.iter().enumerate().filter(|(at, _)| !measured(*at)).map(|(_, cell)| cell.to_owned());
            cells.collect::<Vec<_>>().join(",")
        });
        return kept.collect::<Vec<_>>().join("\n");
    }
    if name.ends_with(".jsonl") {
        fn forget(value: &mut serde_json::Value) {
            match value {
                serde_json::Value::Object(fields) => {
                    fields.retain(|name, _| !name.ends_with("_seconds") && name != "memory_bytes");
                    fields.values_mut().for_each(forget);
                }
                serde_json::Value::Array(values) => values.iter_mut().for_each(forget),
                _ => {}
            }
        }
        let lines = text.lines().map(|line| {
            let mut value = serde_json::from_str(line).expect("JSON");
            forget(&mut value);
            value.to_string()
        });
        return lines.collect::<Vec<_>>().join("\n");
    }
    text
}

/// Returns the files of a folder, without the folder's internal files.
fn files(workspace: &Workspace, folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut left = vec![workspace.path(folder)];
    while let Some(place) = left.pop() {
        for entry in fs::read_dir(&place).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            let name = entry.strip_prefix(workspace.path(folder)).expect("beneath").to_string_lossy().into_owned();
            if name.starts_with("shard-") || name.starts_with('.') || name == "journal.jsonl" {
                continue;
            }
            if entry.is_dir() { left.push(entry) } else { found.push(name) }
        }
    }
    found.sort();
    found
}

#[test]
fn shards_put_together_are_a_grading_in_one_go() {
    let Some(workspace) = workspace() else { return };
    class(&workspace);
    let whole = workspace.run(["grade", "class", "--suite", "suite.toml", "--output", "whole", "--quiet"]);
    assert_eq!(whole.code, Some(1), "{}", whole.shown());
    for shard in ["1/3", "2/3", "3/3"] {
        let run = workspace.run(["grade", "class", "--suite", "suite.toml", "--output", "parts", "--shard", shard]);
        // Both entries of the second shard are right on these scenes.
        assert_eq!(run.code, Some(u8::from(shard != "2/3").into()), "{}", run.shown());
        assert!(
            run.err().contains(&format!("shard {}: 2 of 6 submissions", shard.replace('/', " of "))),
            "{}",
            run.err()
        );
    }
    let merged = workspace.run(["merge", "parts", "--quiet"]);
    assert_eq!((merged.code, merged.out()), (whole.code, whole.out()), "{}", merged.shown());
    let names = files(&workspace, "whole");
    assert_eq!(files(&workspace, "parts"), names);
    for expected in ["grades.csv", "grades.jsonl", "scenes.csv", "class.txt", "index.html", "reports/ada.html"] {
        assert!(names.iter().any(|name| name == expected), "{expected}: {names:?}");
    }
    for name in names.iter().filter(|name| !name.starts_with("cards/")) {
        let text = |folder: &str| without_measurements(name, &workspace.read(format!("{folder}/{name}")));
        assert!(text("parts") == text("whole"), "{name}:\n{}\n{}", text("parts"), text("whole"));
    }
    // A single grading finds every result in the merged folder.
    let again = workspace.run(["grade", "class", "--suite", "suite.toml", "--output", "parts", "--quiet"]);
    assert!(again.err().contains("reused 18 of 18 results from parts"), "{}", again.shown());
}

#[test]
fn missing_repeated_and_foreign_shards_are_reported() {
    let Some(workspace) = workspace() else { return };
    class(&workspace);
    let grade = |shard: &str, folder: &str, more: &[&str]| {
        let words = ["grade", "class", "--suite", "suite.toml", "--quiet", "--output", folder, "--shard", shard];
        workspace.run(words.iter().chain(more))
    };
    let refused = |words: &[&str], why: &str| {
        let run = workspace.run(words);
        assert_eq!(run.code, Some(2), "{}", run.shown());
        assert!(run.err().contains(why), "{}", run.shown());
    };
    // There are more shards than submissions: some shards have nothing to do, but still exist.
    for number in [1, 2, 4, 5, 6, 7, 8] {
        let run = grade(&format!("{number}/8"), "parts", &[]);
        assert!(matches!(run.code, Some(0 | 1)), "{}", run.shown());
    }
    refused(&["merge", "parts"], "1 shard of 8 is missing, or not done: 3; grade it with --shard");
    // A shard that was started again and did not end is not complete.
    fs::remove_file(workspace.path("parts/shard-7-of-8/shard.json")).expect("removed");
    refused(&["merge", "parts"], "2 shards of 8 are missing, or not done: 3, 7; grade them");
    assert_eq!(grade("7/8", "parts", &[]).code, Some(0));
    assert_eq!(grade("1/8", "other", &[]).code, Some(1));
    refused(
        &["merge", "parts", "other", "--output", "merged"],
        "shard 1 of 8 exists more than once: parts/shard-1-of-8 and other/",
    );
    refused(&["merge", "parts", "other"], "shard 1 of 8 exists more than once");
    assert_eq!(grade("3/8", "strict", &["--rules", "parity"]).code, Some(1));
    refused(
        &["merge", "parts", "strict", "--output", "merged"],
        "belong to different gradings: the suite, or an option that",
    );
    refused(&["merge", "class"], "class has no complete shard");
    refused(&["merge", "parts/shard-1-of-8"], "7 shards of 8 are missing");
    assert_eq!(grade("3/8", "third", &[]).code, Some(1));
    refused(&["merge", "parts", "third"], "choose a folder for the results with --output DIR");
    let merged = workspace.run(["merge", "parts", "third", "--output", "merged", "--format", "csv"]);
    assert_eq!(merged.code, Some(1), "{}", merged.shown());
    assert_eq!(
        workspace.read("merged/grades.csv").split(|byte| *byte == b'\n').count(),
        8,
        "six rows, a head and an end"
    );
    for words in [
        &["--shard", "0/3"][..],
        &["--shard", "4/3"],
        &["--shard", "1/3", "--watch"],
        &["--shard", "1/3", "--scene", "x"],
    ] {
        let run = workspace.run(["grade", "class"].iter().chain(words));
        assert_eq!(run.code, Some(2), "{}", run.shown());
    }
}
