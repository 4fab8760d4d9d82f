//! The choice of colors: `--color` decides, then `NO_COLOR`, then `CLICOLOR_FORCE`, then the terminal.
use crate::workspace::{DRIFT, Workspace, finish};

fn is_colored(workspace: &Workspace, words: &[&str], variables: &[(&str, &str)]) -> bool {
    let run = finish(workspace.command().args(words).envs(variables.iter().copied()));
    assert_eq!(run.code, Some(0), "{}", run.shown());
    run.out().contains("\u{1b}[")
}

#[test]
fn words_win_over_variables_and_variables_over_the_terminal() {
    let workspace = Workspace::with_trace(DRIFT);
    let check = ["check", "scene.xml", "trace.bin"];
    let with =
        |words: &[&str], variables: &[(&str, &str)]| is_colored(&workspace, &[&check[..], words].concat(), variables);
    assert!(!with(&[], &[]), "standard output is no terminal here");
    assert!(with(&[], &[("CLICOLOR_FORCE", "1")]));
    assert!(!with(&[], &[("CLICOLOR_FORCE", "0")]));
    assert!(!with(&[], &[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]));
    assert!(with(&["--color", "always"], &[("NO_COLOR", "1")]));
    assert!(!with(&["--color", "never"], &[("CLICOLOR_FORCE", "1")]));
    assert!(!with(&["--color", "auto"], &[]));
    // The option has the same meaning before the command.
    assert!(is_colored(&workspace, &[&["--color", "always"][..], &check].concat(), &[]));
}

#[test]
fn every_report_for_people_can_be_colored() {
    let workspace = Workspace::with_trace(DRIFT);
    for words in [
        &["explain", "scene.xml", "trace.bin"][..],
        &["simulate", "scene.xml"],
        &["suite", "check", "t2m2"],
        &["scene", "list"],
    ] {
        assert!(is_colored(&workspace, &[words, &["--color=always"]].concat(), &[]), "{words:?}");
        assert!(!is_colored(&workspace, words, &[]), "{words:?}");
    }
}

#[test]
fn the_drop_in_is_itself_behind_options_too() {
    let workspace = Workspace::with_trace(DRIFT);
    let plain = workspace.run(["original", "-s", "scene.xml", "-d", "0", "-i", "trace.bin"]);
    let behind = workspace.run(["--color", "always", "original", "-s", "scene.xml", "-d", "0", "-i", "trace.bin"]);
    assert_eq!((plain.code, plain.stdout), (behind.code, behind.stdout));
}
