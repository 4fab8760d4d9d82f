//! Tests that commands that cannot succeed give the reason, and create no files.
use std::{
    fs,
    net::TcpListener,
    path::Path,
    process::{Command, Stdio},
};

/// Runs a command, and returns its exit code and its output.
fn say(words: &[&str], data: &Path) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
        .args(words)
        .arg("--data")
        .arg(data)
        .env_remove("FOSSSIM_DATABASE")
        .stdin(Stdio::null())
        .output()
        .expect("the program");
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (output.status.code(), said)
}

#[test]
fn a_mistyped_folder_is_told_and_not_made() {
    let temp = tempfile::tempdir().expect("a folder");
    let missing = temp.path().join("nosuch");
    let link = ["admin-link", "--public-url", "http://127.0.0.1:1"];
    for words in [&["worker"][..], &link, &["backup", "copy"]] {
        let (code, said) = say(words, &missing);
        assert!(code == Some(2) && said.contains("there is no data folder") && said.contains("--data"), "{said}");
        assert!(!missing.exists(), "{words:?}");
        // A folder that is not a data folder.
        let (code, said) = say(words, temp.path());
        assert!(code == Some(2) && said.contains("there is no database"), "{said}");
        assert_eq!(fs::read_dir(temp.path()).expect("a folder").count(), 0, "{words:?}");
    }
    let (code, said) = say(&["health"], &missing);
    assert!(code == Some(1) && said.contains("nosuch"), "{said}");
}

#[test]
fn a_server_that_can_t_begin_says_what_to_do() {
    let temp = tempfile::tempdir().expect("a folder");
    let (file, data) = (temp.path().join("file"), temp.path().join("data"));
    fs::write(&file, "x").expect("a file");
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let taken = listener.local_addr().expect("an address").to_string();
    for (words, folder, part) in [
        (&["serve", "--listen", "127.0.0.1:0"][..], file.as_path(), "must be a folder"),
        (&["serve", "--listen", "127.0.0.1:0"], Path::new("/proc"), "cannot write in /proc"),
    ] {
        let (code, said) = say(words, folder);
        assert!(code == Some(2) && said.contains(part) && !said.contains("chmod"), "{said}");
    }
    let (code, said) = say(&["serve", "--listen", &taken], &data);
    drop(listener);
    assert!(code == Some(2) && said.contains("choose another address with --listen"), "{said}");
    assert!(!data.exists(), "a server that can't listen makes nothing");
}
