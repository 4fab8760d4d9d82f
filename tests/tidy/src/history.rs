//! Subjects of commits name a scope and one change.
use crate::tree::root;
use std::process::Command;

/// Tools cut longer subjects when they list them.
const LONGEST_SUBJECT: usize = 72;

/// The time from which subjects follow this rule.
const SINCE: &str = "2026-11-26T22:00:00Z";

/// Returns what is wrong with the subject of a commit.
fn fault(subject: &str) -> Option<&'static str> {
    if subject.split_once(": ").is_none_or(|(scope, _)| scope.trim().is_empty()) {
        return Some("has no scope");
    }
    if subject.chars().count() > LONGEST_SUBJECT {
        return Some("is longer than 72 characters");
    }
    (subject.contains(';') || subject.contains("/tmp")).then_some("names two changes, or a path")
}

#[test]
fn faults_of_subjects_are_found() {
    assert_eq!(fault("judge: reject traces with trailing bytes"), None);
    assert_eq!(fault("grading, server: unpack archives in one place"), None);
    assert!(fault("Traces with trailing bytes are rejected").is_some());
    assert!(fault("judge: reject this; and that").is_some());
    assert!(fault(&format!("judge: {}", "a".repeat(70))).is_some());
}

/// A checkout without history, as in a package, has nothing to check.
#[test]
fn subjects_of_commits_name_a_scope_and_one_change() {
    let mut git = Command::new("git");
    git.current_dir(root()).args(["log", "--no-merges", "--format=%s", "--since", SINCE]);
    let Ok(output) = git.output() else { return };
    let log = String::from_utf8_lossy(&output.stdout).into_owned();
    let wrong: Vec<(&str, &str)> = log.lines().filter_map(|subject| Some((subject, fault(subject)?))).collect();
    assert!(wrong.is_empty(), "subjects are `scope: verb ...` (CONTRIBUTING.md): {wrong:#?}");
}
