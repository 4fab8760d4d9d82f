//! Small plots: on a terminal, unless somebody wants it plain.
use super::bars::terminal;
use crate::workspace::Workspace;
use std::{io::Read, path::Path, process::Stdio};

/// The output of a command on a terminal.
fn on_terminal(workspace: &Workspace, words: &[&str], set: &[(&str, &str)]) -> String {
    let (mut main, side) = terminal();
    let mut command = workspace.command();
    command.args(words).env("TERM", "xterm").envs(set.iter().copied()).stdout(Stdio::from(side)).stderr(Stdio::null());
    let mut child = command.spawn().expect("the program");
    // Its copies alone keep the other end open.
    drop(command);
    let (mut seen, mut buffer) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = main.read(&mut buffer) {
        seen.extend_from_slice(&buffer[..count]);
    }
    child.wait().expect("an end");
    String::from_utf8(seen).expect("text")
}

fn has_plot(text: &str) -> bool {
    text.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
}

#[test]
fn check_plots_residuals_and_the_wrong_polynomial_on_a_terminal_alone() {
    let workspace = Workspace::new();
    let trace = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/traces/flawed.bin");
    let trace = trace.to_str().expect("a path");
    let scene = "asset:ContinuousTimeTests/spinning-edge-sweeps-balls";
    let check =
        |more: &[&str], set: &[(&str, &str)]| on_terminal(&workspace, &[&["check", scene, trace], more].concat(), set);
    let seen = check(&[], &[]);
    assert!(has_plot(&seen) && seen.contains("Residuals of the 24 steps") && seen.contains("yours (dotted)"), "{seen}");
    assert!(seen.contains("tolerance 1e-10"), "{seen}");
    for (more, set) in [
        (&[][..], &[("NO_COLOR", "1")][..]),
        (&["--color=never"], &[]),
        (&[], &[("TERM", "dumb")]),
        (&["--format=json"], &[]),
        (&["--step=2"], &[]),
    ] {
        let seen = check(more, set);
        assert!(!has_plot(&seen) && seen.contains("2"), "{more:?} {set:?}: {seen}");
    }
    assert!(!has_plot(&workspace.run(["check", scene, trace]).out()), "no terminal");
    let right = on_terminal(&workspace, &["check", scene, scene], &[]);
    assert!(!has_plot(&right), "nothing is wrong: {right}");
}
