//! Completion scripts and manual pages, tested in their shells.
use crate::workspace::{Workspace, finish};
use fosssim_testing::{Need, skip};
use std::process::Command;

/// Returns bash's completions of the last of these words, by the printed script.
fn offered(workspace: &Workspace, words: &[&str]) -> Vec<String> {
    // Bash splits words at colons, and the colons are separate words.
    let split = words.join("\n").replace(':', "\n:\n");
    let split = if split.ends_with(":\n") { split.trim_end() } else { &split };
    let words: Vec<&str> = split.split('\n').collect();
    let list: Vec<String> = words.iter().map(|word| format!("'{word}'")).collect();
    let (last, previous) = (words.len() - 1, words.get(words.len().wrapping_sub(2)).unwrap_or(&""));
    let script = format!(
        "source completions.bash\n\
         function=$(complete -p fosssim-oracle | sed 's/.*-F \\([^ ]*\\).*/\\1/')\n\
         COMP_WORDS=({}); COMP_CWORD={last}\n\
         $function fosssim-oracle '{}' '{previous}'\n\
         printf '%s\\n' \"${{COMPREPLY[@]}}\"\n",
        list.join(" "),
        words[last],
    );
    let mut bash = Command::new("bash");
    let programs = std::path::Path::new(env!("CARGO_BIN_EXE_fosssim-oracle")).parent().expect("a folder");
    bash.env("PATH", format!("{}:{}", programs.display(), std::env::var("PATH").unwrap_or_default()));
    let run = finish(bash.args(["--norc", "-c", &script]).current_dir(workspace.path("")));
    assert_eq!(run.code, Some(0), "{}", run.shown());
    assert_eq!(run.err(), "", "{words:?}");
    run.out().lines().map(str::to_owned).collect()
}

#[test]
fn bash_completes_behind_a_command() {
    let workspace = Workspace::new();
    let script = workspace.run(["completions", "bash"]);
    workspace.write("completions.bash", &script.stdout);
    if Command::new("bash").arg("--version").output().is_err() {
        skip(Need::Bash, "there is no bash");
        return;
    }
    let offers = |words: &[&str]| offered(&workspace, words);
    assert_eq!(offers(&["fosssim-oracle", "sim"]), ["simulate"]);
    let options = offers(&["fosssim-oracle", "grade", "--f"]);
    assert!(["--format", "--fresh", "--fail-fast"].iter().all(|known| options.iter().any(|offer| offer == known)));
    assert!(options.iter().all(|option| option.starts_with("--f")), "{options:?}");
    assert_eq!(offers(&["fosssim-oracle", "check", "--rules", ""]), ["parity", "fair", "both"]);
    assert_eq!(offers(&["fosssim-oracle", "check", "--rules", "p"]), ["parity"]);
    assert_eq!(offers(&["fosssim-oracle", "trace", "sh"]), ["show"]);
    assert_eq!(offers(&["fosssim-oracle", "trace", "show", "--st"]), ["--step"]);
    assert_eq!(offers(&["fosssim-oracle", "help", "trace", "sh"]), ["show"]);
    // The completions are the names of built-in scenes and suites, together with files.
    assert_eq!(offers(&["fosssim-oracle", "grade", "x", "--suite", "t1"]), ["t1m1", "t1m2", "t1m3"]);
    assert_eq!(offers(&["fosssim-oracle", "grade", "x", "--suite", "comp"]), ["completions.bash"]);
    assert_eq!(
        offers(&["fosssim-oracle", "check", "asset:GeometricTests/pair-b"]),
        ["GeometricTests/pair-becomes-rigid"]
    );
    assert!(offers(&["fosssim-oracle", "check", "a", "asset:"]).len() > 100);
    assert_eq!(offers(&["fosssim-oracle", "demo", "--mistake", "pe-square-no-e"]), ["pe-square-no-eh"]);
}

#[test]
fn zsh_and_fish_can_read_their_scripts() {
    let workspace = Workspace::new();
    for (need, file) in [(Need::Zsh, "_fosssim-oracle"), (Need::Fish, "fosssim-oracle.fish")] {
        let shell = need.name();
        workspace.write(file, &workspace.run(["completions", shell]).stdout);
        match Command::new(shell).args(["-n", file]).current_dir(workspace.path("")).output() {
            Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
            Err(_) => skip(need, format_args!("there is no {shell}")),
        }
    }
}

#[test]
fn the_foot_of_a_manual_page_names_the_program_and_its_version() {
    let workspace = Workspace::new();
    for page in [&["man"][..], &["man", "grade"], &["man", "trace", "show"]] {
        let text = workspace.run(page).out();
        let foot = format!("\"fosssim-oracle {}\"", env!("CARGO_PKG_VERSION"));
        let title = text.lines().find(|line| line.starts_with(".TH ")).expect("a title");
        assert!(title.contains(&foot), "{title}");
        assert!(!text.contains(".SH EXTRA"), "{page:?}");
    }
}
