//! The terminal while a command runs, and the text that remains on it afterwards.
use crate::workspace::{DRIFT, Workspace};
use fosssim_testing::{Need, skip};
use std::{
    fs::{File, Permissions},
    io::Read,
    os::{
        fd::{FromRawFd, OwnedFd},
        unix::fs::PermissionsExt,
    },
    process::Stdio,
};

/// Returns the two ends of a terminal.
pub(super) fn terminal() -> (File, OwnedFd) {
    let (mut main, mut side) = (0, 0);
    let size = libc::winsize { ws_row: 24, ws_col: 80, ws_xpixel: 0, ws_ypixel: 0 };
    // SAFETY: both numbers are written before they are used, and belong to nobody else.
    unsafe {
        let made = libc::openpty(&raw mut main, &raw mut side, std::ptr::null_mut(), std::ptr::null(), &raw const size);
        assert_eq!(made, 0, "a terminal");
        (File::from_raw_fd(main), OwnedFd::from_raw_fd(side))
    }
}

/// Interrupts the program when these words appear on its standard error. Returns the complete output and the exit code.
fn interrupted(workspace: &Workspace, words: &[&str], at: &str) -> (String, Option<i32>) {
    let (mut main, side) = terminal();
    let mut command = workspace.command();
    command.args(words).env("TERM", "xterm").stdout(Stdio::null()).stderr(Stdio::from(side));
    let mut child = command.spawn().expect("the program");
    // Now only the copies keep the other end open.
    drop(command);
    let (mut seen, mut buffer, mut sent) = (Vec::new(), [0; 4096], false);
    while let Ok(count @ 1..) = main.read(&mut buffer) {
        seen.extend_from_slice(&buffer[..count]);
        if !sent && String::from_utf8_lossy(&seen).contains(at) {
            sent = true;
            // SAFETY: the child has not been waited for, so the number is its own.
            unsafe { libc::kill(i32::try_from(child.id()).expect("a number"), libc::SIGINT) };
        }
    }
    let code = child.wait().expect("an end").code();
    (String::from_utf8_lossy(&seen).into_owned(), code)
}

/// Returns the text that is still visible after the last erasure.
fn left(seen: &str) -> &str {
    seen.rsplit("\u{1b}[2K").next().unwrap_or_default()
}

#[test]
fn an_interrupt_leaves_no_bar_behind() {
    let workspace = Workspace::new();
    // The number of steps is so large that the program does not end.
    workspace.write("scene.xml", DRIFT.replace("time=\"1\"", "time=\"100000000\""));
    let (seen, code) = interrupted(&workspace, &["simulate", "scene.xml"], " left");
    assert_eq!((code, left(&seen).trim()), (Some(130), ""), "{seen:?}");
}

#[test]
fn a_slow_program_is_seen_to_run_and_can_be_stopped() {
    let workspace = Workspace::new();
    workspace.write("FOSSSim", "#!/bin/sh\nwhile :; do :; done\n");
    std::fs::set_permissions(workspace.path("FOSSSim"), Permissions::from_mode(0o755)).expect("its mode");
    if workspace.run(["doctor"]).code != Some(0) {
        skip(Need::Sandbox, "programs can't be run safely here");
        return;
    }
    let (seen, code) = interrupted(&workspace, &["explain", "--program", "./FOSSSim"], "run 1 of ");
    assert_eq!((code, left(&seen).trim()), (Some(130), ""), "{seen:?}");
    assert!(seen.contains("stopping (press Ctrl-C again to stop immediately)"), "{seen:?}");
}
