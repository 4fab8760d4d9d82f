//! The attack suite: every hostile program of `tests/attacks` in the real sandbox.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use fosssim_oracle::sandbox::selftest::{self, PromiseState, PromiseTable};
use fosssim_oracle::sandbox::{Backend, Layer};
use fosssim_testing::{Need, skip};

use crate::sandbox::backend;

/// Runs the attacks whose names begin with one of these words, or all attacks. Returns `None` and prints a line without
/// a C compiler.
fn attacked(backend: &Backend, families: &[&str]) -> Option<PromiseTable> {
    let cc = Path::new("cc");
    if std::process::Command::new(cc).arg("--version").output().is_err() {
        skip(Need::Cc, "there is no C compiler (cc)");
        return None;
    }
    let folder = folder();
    std::fs::create_dir_all(&folder).unwrap();
    let chosen = |name: &str| families.is_empty() || families.iter().any(|family| name.starts_with(family));
    let table = selftest::run_selected(backend, cc, &folder, chosen, |promise| match &promise.state {
        PromiseState::Kept => {}
        state => eprintln!("{}: {state:?}", promise.attack),
    });
    Some(table.unwrap())
}

/// Returns the folder in which the suite's programs are built and kept.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("attacks")
}

/// Runs the suite once, with all layers of protection that this machine has, for all tests. Afterwards all programs are
/// built.
fn with_all_walls() -> Option<&'static PromiseTable> {
    static TABLE: OnceLock<Option<PromiseTable>> = OnceLock::new();
    TABLE.get_or_init(|| attacked(backend()?, &[])).as_ref()
}

/// A compiler for the suite that returns programs that are already built.
const BUILT: &str = r#"#!/bin/sh
for word; do source=$word; [ "$before" = -o ] && program=$word; before=$word; done
name=${source##*/}
cp "${0%/*}/programs/${name%.c}"-???????????????? "$program" 2>/dev/null || exec cc "$@"
"#;

/// Attacks on files, which namespaces and file rules prevent.
const FILES: [&str; 13] = [
    "closed", "execute", "hard", "leak", "links", "lock", "proc_", "read", "strange", "survivor", "swap", "trace",
    "write",
];
/// Attacks on other processes, which namespaces hide.
const PROCESSES: [&str; 12] = [
    "affinity", "counts", "daemon", "kill", "leader", "numbers", "outlive", "priority", "process", "proc_", "signal",
    "lease",
];
/// Attacks that use much memory or many processes, which control groups limit.
const CROWDS: [&str; 9] = ["busy", "fork", "heap", "memory", "processor", "short", "sleeper", "stopped", "thread"];
/// Attacks by forbidden calls. The report names the calls if the kernel reports them.
const CALLS: [&str; 6] = ["commands", "execute", "kernel", "leak", "lock", "write_modes"];

fn assert_all_held(table: &PromiseTable, at_least: usize) {
    let broken: Vec<_> = table.broken_promises().map(|promise| &promise.attack).collect();
    assert!(broken.is_empty(), "broken promises: {broken:?}");
    let fault = |why: &str| why.contains("test itself") || why.contains("compile");
    let faults =
        table.promises.iter().filter(|promise| matches!(&promise.state, PromiseState::NotTested(why) if fault(why)));
    assert_eq!(faults.count(), 0);
    assert!(table.count_kept() >= at_least, "only {} promises were tried", table.count_kept());
}

#[test]
fn every_promise_of_the_sandbox_holds() {
    let Some(table) = with_all_walls() else { return };
    assert_all_held(table, 160);
}

#[test]
fn older_kernels_without_announcements_hold_the_promises_too() {
    let Some(backend) = backend() else { return };
    let backend = match backend.without_layer(Layer::NamedCalls) {
        Ok(backend) => backend,
        Err(error) => return skip(Need::Walls, error),
    };
    let Some(table) = attacked(&backend, &CALLS) else { return };
    assert_all_held(&table, 55);
}

#[test]
fn namespaces_hold_the_promises_where_there_is_no_landlock() {
    let Some(backend) = backend() else { return };
    let Ok(backend) = backend.without_layer(Layer::FileRules) else {
        skip(Need::Walls, "only root with namespaces may do without file rules");
        return;
    };
    let bare = backend.without_layer(Layer::Namespaces);
    assert!(bare.unwrap_err().to_string().contains("file rules"), "nothing would hide the grader's own file");
    let Some(table) = attacked(&backend, &FILES) else { return };
    assert_all_held(&table, 40);
}

#[test]
fn older_kernels_with_the_first_landlock_hold_the_promises_too() {
    let Some(backend) = backend() else { return };
    let backend = backend.without_layer(Layer::Namespaces).and_then(|backend| backend.with_landlock(1));
    let backend = match backend {
        Ok(backend) => backend,
        Err(error) => return skip(Need::Walls, error),
    };
    let Some(table) = attacked(&backend, &[&FILES[..], &PROCESSES].concat()) else { return };
    assert_all_held(&table, 75);
}

#[test]
fn hosts_without_namespaces_and_control_groups_hold_the_promises_too() {
    let Some(backend) = backend() else { return };
    let backend =
        backend.without_layer(Layer::Namespaces).and_then(|backend| backend.without_layer(Layer::ControlGroup));
    let backend = match backend {
        Ok(backend) => backend,
        Err(error) => return skip(Need::Walls, error),
    };
    let Some(table) = attacked(&backend, &[&PROCESSES[..], &CROWDS].concat()) else { return };
    assert_all_held(&table, 60);
}

/// Root can test what protects an ordinary user's grader: only the program, in a place where all users may execute it.
#[test]
fn an_ordinary_users_grader_holds_the_promises_too() {
    use std::os::unix::fs::PermissionsExt;
    let Some(_) = with_all_walls() else { return };
    let folder = tempfile::tempdir().unwrap();
    let open = std::fs::Permissions::from_mode(0o777);
    std::fs::set_permissions(folder.path(), open.clone()).unwrap();
    let grader = folder.path().join("fosssim-oracle");
    std::fs::copy(env!("CARGO_BIN_EXE_fosssim-oracle"), &grader).unwrap();
    std::fs::set_permissions(&grader, open.clone()).unwrap();
    let compiler = folder.path().join("cc");
    std::fs::write(&compiler, BUILT).unwrap();
    std::fs::set_permissions(&compiler, open).unwrap();
    let programs = folder.path().join("programs");
    std::fs::create_dir(&programs).unwrap();
    for built in std::fs::read_dir(self::folder().join("programs")).unwrap() {
        let built = built.unwrap();
        std::fs::copy(built.path(), programs.join(built.file_name())).unwrap();
    }
    let output = std::process::Command::new("setpriv")
        .args(["--reuid=65534", "--regid=65534", "--clear-groups"])
        .arg(&grader)
        .args(["selftest", "--compiler"])
        .arg(&compiler)
        .env("TMPDIR", folder.path())
        .current_dir("/")
        .output();
    let Ok(output) = output else {
        skip(Need::Setpriv, "there is no setpriv");
        return;
    };
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if err.contains("setpriv:") || err.contains("cannot run programs safely") {
        skip(Need::Setpriv, err);
        return;
    }
    assert!(output.status.success() && out.contains(" 0 broken"), "{out}{err}");
}

#[test]
fn attacks_are_never_run_without_walls() {
    let backend = Backend::fake(|_| unreachable!("nothing is started"));
    let folder = tempfile::tempdir().unwrap();
    let refusal = selftest::run(&backend, Path::new("cc"), folder.path(), |_| {});
    assert!(refusal.unwrap_err().to_string().contains("only inside the sandbox"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is built");
}

#[test]
fn an_attack_refuses_by_itself_outside_the_sandbox() {
    // The source of the attack that only prints.
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/attacks/forged_verdict.c");
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("program");
    let built = std::process::Command::new("cc").args(["-w", "-o"]).args([&program, &source]).status();
    if !built.is_ok_and(|status| status.success()) {
        skip(Need::Cc, "there is no C compiler (cc)");
        return;
    }
    let output =
        std::process::Command::new(&program).args(["1", "2", "3", "4"]).env("FOSSSIM_ATTACK", "1").output().unwrap();
    assert_eq!(output.status.code(), Some(98));
    assert!(output.stdout.is_empty());
}

#[test]
fn the_page_of_attacks_has_each_promise() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let table = std::process::Command::new(root.join("scripts/attacks-table")).output().expect("bash");
    let page = std::fs::read_to_string(root.join("docs/sandbox/attacks.md")).expect("a page");
    let table = String::from_utf8(table.stdout).expect("text");
    assert!(table.lines().count() > 200 && page.contains(&table), "put the table of scripts/attacks-table there");
}
