//! `serve` starts the server next to the program, or reports that there is none.
use std::{
    fs,
    os::unix::fs::symlink,
    path::Path,
    process::{Command, Output},
};

fn run(folder: &Path, words: &[&str]) -> Output {
    Command::new(folder.join("fosssim-oracle")).args(words).output().expect("the program")
}

#[test]
fn serve_becomes_the_server_beside_the_program() {
    // These are links, so that no program is written while another test's child has it open.
    let program = Path::new(env!("CARGO_BIN_EXE_fosssim-oracle"));
    let folder = tempfile::tempdir_in(program.parent().expect("a folder")).expect("a folder");
    fs::hard_link(program, folder.path().join("fosssim-oracle")).expect("a link");
    let without = run(folder.path(), &["serve", "--data", "course"]);
    assert_eq!(without.status.code(), Some(2));
    let message = String::from_utf8_lossy(&without.stderr).into_owned();
    assert!(message.contains("there is no ") && message.contains("install the package fosssim-server"), "{message}");
    symlink("/bin/echo", folder.path().join("fosssim-server")).expect("a link");
    let with = run(folder.path(), &["serve", "--data", "course", "--help"]);
    assert_eq!(String::from_utf8_lossy(&with.stdout), "serve --data course --help\n");
    assert_eq!(with.status.code(), Some(0));
}
