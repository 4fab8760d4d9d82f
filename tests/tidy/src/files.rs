//! All files are opened by `crates/files`: without waiting, inside their folder, and with a size limit. Code that opens
//! files in another way is listed here with the number of calls and the reason.
use crate::tree::{files, name, root, text};
use std::collections::BTreeMap;

/// Calls that open, create or list files directly.
const WORDS: [&str; 10] = [
    "File::open(",
    "File::create(",
    "File::options(",
    "OpenOptions::new(",
    "fs::read(",
    "fs::read_to_string(",
    "fs::write(",
    "fs::copy(",
    "read_dir(",
    "tempfile_in(",
];

/// The crates that follow this rule. The sandbox opens files in its own ways, and has its own tests.
const ROOMS: [&str; 10] = [
    "src",
    "crates/evidence/src",
    "crates/grading/src",
    "crates/judge/src",
    "crates/mistakes/src",
    "crates/student/src",
    "crates/model/src",
    "crates/original/src",
    "crates/render/src",
    "crates/report/src",
];

/// The exceptions, with their reasons.
const ALLOWED: [(&str, usize, &str); 11] = [
    ("crates/grading/src/key.rs", 1, "the grader's own program, in /proc"),
    ("crates/grading/src/scene_files.rs", 1, "lists a folder of scenes that somebody names; listing waits for nothing"),
    ("crates/grading/src/speed.rs", 2, "reads what the kernel says of this machine"),
    ("crates/grading/src/staging.rs", 1, "makes a new file in a folder of our own that is closed to others"),
    ("crates/grading/src/temporary_folders.rs", 3, "makes and sweeps folders of our own that are closed to others"),
    ("crates/original/src/run.rs", 1, "options for `files::open_for_writing`: the original writes through links"),
    ("src/cli/commands/grade.rs", 1, "lists a submission's folder for times of changes"),
    ("src/cli/commands/merge.rs", 1, "lists folders that somebody names"),
    ("src/cli/commands/results.rs", 1, "options for `files::open_for_writing`: a GitHub job's summary is added to"),
    ("src/cli/commands/submissions.rs", 1, "lists a class's folder that somebody names"),
    ("src/cli/output.rs", 2, "options for a device, and whether a file that will be replaced may be written"),
];

#[test]
fn files_are_opened_in_one_way() {
    let mut found: BTreeMap<String, usize> = BTreeMap::new();
    for room in ROOMS {
        for file in files(&root().join(room), ".rs") {
            let name = name(&file).to_owned();
            let is_of_tests =
                ["tests", "fake_programs.rs", "formats.rs", "src/sample/"].iter().any(|part| name.contains(part));
            if is_of_tests {
                continue;
            }
            let text = text(&file);
            let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            let of_word = |line: &str, word: &str| {
                let is_other = |at: usize| line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
                // Only `std::fs` and `fs` count; `files` is the allowed crate.
                line.match_indices(word).filter(|(at, _)| !is_other(*at)).count()
            };
            let count: usize = code.map(|line| WORDS.iter().map(|word| of_word(line, word)).sum::<usize>()).sum();
            if count > 0 {
                found.insert(name, count);
            }
        }
    }
    let allowed = ALLOWED.iter().map(|(name, count, _)| ((*name).to_owned(), *count)).collect();
    assert_eq!(found, allowed, "open files by `crates/files`, or say here why not");
}
