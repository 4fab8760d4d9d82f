//! Bubblewrap (`bwrap`) in place of the supervisor's own namespaces, where it is installed and has rights that we lack.
//!
//! Some systems refuse namespaces to ordinary programs and trust `bwrap` with them. The whole supervisor then runs
//! inside: with its own processes, without network, and with everything read-only but the working folder. Inside, it
//! puts up the same walls as ever; nothing is left to bubblewrap alone. What it shows of the host is more than our own
//! view does, so that the file rules (Landlock) matter more.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// Where the system keeps it; a `PATH` could name somebody else's.
const PLACES: [&str; 3] = ["/usr/bin/bwrap", "/usr/local/bin/bwrap", "/bin/bwrap"];
/// Places to which the supervisor itself writes: its locks for users, and control groups.
const SUPERVISORS: [&str; 4] =
    ["/run/fosssim-oracle-users", "/var/tmp/fosssim-oracle-users", "/tmp/fosssim-oracle-users", "/sys/fs/cgroup"];

/// The installed program, if there is one.
pub(super) fn installed() -> Option<PathBuf> {
    PLACES.into_iter().map(PathBuf::from).find(|path| path.is_file())
}

/// The command that runs `program` inside, where only `folder` can be changed. Arguments for the program follow.
pub(super) fn command(bwrap: &Path, program: &Path, folder: Option<&Path>, root: bool) -> Command {
    let mut command = Command::new(bwrap);
    command.args(["--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts"]);
    // Root needs no user namespace, but its rights: to become the run's user, and to give it the folder.
    command.args(if root { ["--cap-add", "ALL"].as_slice() } else { ["--unshare-user"].as_slice() });
    command.args(["--ro-bind", "/", "/", "--dev-bind", "/dev", "/dev", "--proc", "/proc"]);
    for path in SUPERVISORS {
        command.args(["--bind-try", path, path]);
    }
    if let Some(folder) = folder {
        command.arg("--bind").args([folder, folder]);
    }
    command.args(["--chdir", "/", "--"]).arg(program);
    command
}
