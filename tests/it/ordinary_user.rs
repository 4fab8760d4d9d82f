//! Graders of ordinary users, and on kernels without some features. Root runs these tests, with only the program.
use crate::workspace::{Run, Workspace, finish, submission};
use fosssim_testing::{Need, skip};
use std::{
    fs::{self, Permissions},
    os::unix::fs::PermissionsExt,
    process::{Command, Stdio},
};

const SUITE: &str =
    "schema = 1\nname = \"test\"\n[[group]]\nname = \"g\"\nscenes = [\"asset:ImpulsesTests/o*\"]\npoints = 10\n";
const BUILD: &str = "[build]\ncommand = [\"sh\", \"build.sh\"]\nprogram = \"FOSSSim\"\n[[group]]";
/// The user `nobody`, by number.
const NOBODY: [&str; 3] = ["--reuid=65534", "--regid=65534", "--clear-groups"];

/// Runs a program without some system calls: missing (38, ENOSYS) or forbidden (1, EPERM), as on an older kernel.
const OLDER: &str = r#"
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>
int main(int argc, char **argv) {
    struct sock_filter code[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 444, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | 38),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, strcmp(argv[1], "bare") ? 999999 : SYS_unshare, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    struct sock_fprog filter = {sizeof code / sizeof *code, code};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter)) return 125;
    execv(argv[2], argv + 2);
    return 126;
}
"#;

/// Returns a folder that all users may use, with the grader and a correct program in it, or `None` unless we are root.
fn open_to_all() -> Option<Workspace> {
    let workspace = Workspace::new();
    if workspace.run(["doctor"]).code != Some(0) {
        skip(Need::Sandbox, "programs cannot be run safely here");
        return None;
    }
    if !Command::new("setpriv").args(NOBODY).arg("true").stderr(Stdio::null()).status().is_ok_and(|s| s.success()) {
        skip(Need::Setpriv, "setpriv cannot be used here");
        return None;
    }
    workspace.write("suite.toml", SUITE);
    fs::copy(env!("CARGO_BIN_EXE_fosssim-oracle"), workspace.path("oracle")).expect("a copy");
    workspace.write("class/right", submission("right"));
    set_mode(&workspace, "class/right", 0o755);
    for open in ["", "class"] {
        set_mode(&workspace, open, 0o777);
    }
    Some(workspace)
}

fn set_mode(workspace: &Workspace, name: &str, mode: u32) {
    fs::set_permissions(workspace.path(name), Permissions::from_mode(mode)).expect("a file of ours");
}

/// Runs the copied grader through some other commands.
fn run(workspace: &Workspace, before: &[&str], arguments: &[&str]) -> Run {
    let oracle = workspace.path("oracle");
    let words: Vec<&str> =
        before.iter().copied().chain([oracle.to_str().expect("text")]).chain(arguments.iter().copied()).collect();
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).current_dir(workspace.path("")).env_clear().env("PATH", "/usr/bin:/bin");
    finish(command.env("TMPDIR", workspace.path("")).stdin(Stdio::null()))
}

fn as_nobody() -> Vec<&'static str> {
    [&["setpriv"][..], &NOBODY].concat()
}

#[test]
fn unreadable_files_are_reported_and_not_a_grader_fault() {
    let Some(workspace) = open_to_all() else { return };
    fs::copy(workspace.path("class/right"), workspace.path("class/closed")).expect("a copy");
    fs::copy(workspace.path("class/right"), workspace.path("class/only-executable")).expect("a copy");
    set_mode(&workspace, "class/closed", 0o700);
    set_mode(&workspace, "class/only-executable", 0o711);
    let graded = run(&workspace, &as_nobody(), &["grade", "class", "--suite", "suite.toml", "--output", "out"]);
    let verdicts = String::from_utf8(workspace.read("out/grades.csv")).expect("text");
    assert_eq!(graded.code, Some(1), "{}", graded.shown());
    assert!(verdicts.contains("right,accepted"), "{verdicts}");
    for name in ["closed", "only-executable"] {
        let row = verdicts.lines().find(|row| row.starts_with(&format!("{name},"))).expect("a row");
        assert!(row.contains(",0,10,") && !row.contains("judge error"), "{verdicts}");
        assert!(graded.out().contains("Permission denied"), "{}", graded.shown());
    }

    workspace.write("suite.toml", SUITE.replacen("[[group]]", BUILD, 1));
    for name in ["file", "folder"] {
        workspace.write(format!("sources/{name}/build.sh"), "cp inner/ready FOSSSim\n");
        workspace.write(format!("sources/{name}/inner/ready"), "x");
    }
    set_mode(&workspace, "sources/file/inner/ready", 0o600);
    set_mode(&workspace, "sources/folder/inner", 0o700);
    let graded = run(&workspace, &as_nobody(), &["grade", "sources", "--suite", "suite.toml", "--output", "built"]);
    assert_eq!(graded.code, Some(1), "{}", graded.shown());
    assert!(graded.out().contains("Permission denied"), "{}", graded.shown());
    let verdicts = String::from_utf8(workspace.read("built/grades.csv")).expect("text");
    assert_eq!(verdicts.matches(",0,10,").count(), 2, "{verdicts}");
    assert!(!verdicts.contains("judge error"), "{verdicts}");
}

#[test]
fn a_kernel_without_landlock_holds_by_namespaces_or_nothing_is_graded() {
    let Some(workspace) = open_to_all() else { return };
    workspace.write("older.c", OLDER);
    let older = workspace.path("older");
    let built = Command::new("cc").arg("-o").args([&older, &workspace.path("older.c")]).status();
    if !built.is_ok_and(|status| status.success()) {
        skip(Need::Cc, "there is no C compiler (cc)");
        return;
    }
    let older = older.to_str().expect("text");
    let grade = ["grade", "class/right", "--suite", "suite.toml"];
    let refused = |before: &[&str]| {
        let graded = run(&workspace, before, &grade);
        assert_eq!(graded.code, Some(2), "{}", graded.shown());
        assert!(graded.err().contains("Landlock") && !graded.out().contains("accepted"), "{}", graded.shown());
        let doctor = run(&workspace, before, &["doctor"]);
        assert_ne!(doctor.code, Some(0), "{}", doctor.shown());
    };
    refused(&[&as_nobody()[..], &[older, "landlock"]].concat());
    refused(&[older, "bare"]);
    let doctor = run(&workspace, &[older, "landlock"], &["doctor"]);
    if doctor.code != Some(0) {
        assert!(doctor.out().contains("Landlock"), "{}", doctor.shown());
        skip(Need::Walls, "there are no namespaces here");
        return;
    }
    let graded = run(&workspace, &[older, "landlock"], &grade);
    assert_eq!(graded.code, Some(0), "{}", graded.shown());
}
