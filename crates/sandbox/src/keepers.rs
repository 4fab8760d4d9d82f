//! The grader's side of supervisors that serve several runs of one submission.
//!
//! With them, grading a right program on 116 scenes takes 1.2 s of processor time, compared with 2.0 s with one
//! supervisor per run.

use std::{
    fs::File,
    io::{self, Write},
    net::Shutdown,
    os::{
        fd::{AsFd, OwnedFd},
        unix::{fs::MetadataExt, net::UnixStream},
    },
    path::Path,
    process::Child,
    sync::{Arc, Mutex, PoisonError},
};

use super::{
    fault::{SandboxError, loss_error},
    job::ProgramIdentity,
    sys,
    wire::{self, Report, RunOrder},
};

/// The properties that all runs of a keeper share: the order except for the arguments, the environment, and the working
/// folder with its contents; and the identities of the files that the order names.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Kind {
    order: RunOrder,
    program: Option<ProgramIdentity>,
    files: Vec<Option<(u64, u64)>>,
}

impl Kind {
    /// Returns whether a keeper may serve the order. It may not if processes are not counted, or if the run has no
    /// namespaces that end with it.
    pub(super) fn exists_for(order: &RunOrder) -> bool {
        order.volatile && !order.tools && order.walls.namespaces && order.walls.seccomp
    }

    /// Returns the kind of an order; `None` if no keeper may serve it.
    pub(super) fn from_order(order: &RunOrder) -> Option<Self> {
        if !Self::exists_for(order) {
            return None;
        }
        let common = RunOrder {
            folder: Vec::new(),
            arguments: Vec::new(),
            environment: Vec::new(),
            files: Vec::new(),
            ..order.clone()
        };
        let named = order.readable.iter().chain(&order.executable).chain(&order.named);
        let identity = |path: &Path| path.metadata().ok().map(|metadata| (metadata.dev(), metadata.ino()));
        let files = named.map(|path| identity(&wire::path(path))).collect();
        Some(Self { order: common, program: ProgramIdentity::from_path(&wire::path(&order.program)), files })
    }
}

/// A keeper process. When the value is dropped, the process is ended and waited for.
#[derive(Debug)]
pub(super) struct Keeper {
    kind: Kind,
    child: Option<Child>,
    socket: UnixStream,
}

impl Keeper {
    pub(super) fn new(kind: Kind, child: Child, socket: UnixStream) -> Self {
        Self { kind, child: Some(child), socket }
    }

    /// Requests a run. `files` are the contents of the files that the order names. Returns the connection to the run's
    /// supervisor, and the file from which its answers are read.
    pub(super) fn request_run(&self, order: &RunOrder, files: &[(String, Vec<u8>)]) -> io::Result<(UnixStream, File)> {
        let folder = File::open(wire::path(&order.folder))?;
        let (control, theirs) = UnixStream::pair()?;
        let (answers, told) = io::pipe()?;
        let mut packet = wire::encode_packet(order)?;
        files.iter().for_each(|(_, content)| packet.extend_from_slice(content));
        sys::send_descriptors(&self.socket, wire::RUN_BYTE, [theirs.as_fd(), told.as_fd(), folder.as_fd()])?;
        (&self.socket).write_all(&packet)?;
        Ok((control, OwnedFd::from(answers).into()))
    }

    fn dismiss(&self) {
        // This fails if the keeper has ended, which does not matter.
        let _ = self.socket.shutdown(Shutdown::Both);
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        self.dismiss();
        if let Some(child) = &mut self.child {
            // The exit status of the keeper no longer matters.
            let _ = child.wait();
        }
    }
}

/// The idle keepers of a backend. Their number never exceeds the largest number of runs at the same time.
#[derive(Debug, Default)]
pub(super) struct KeeperPool {
    idle: Mutex<Vec<Keeper>>,
}

impl KeeperPool {
    /// Takes an idle keeper for runs of this kind. If there is none, an idle keeper of another kind is ended to make
    /// room.
    pub(super) fn take(&self, kind: &Kind) -> Option<Keeper> {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let fits = idle.iter().rposition(|keeper| keeper.kind == *kind);
        let taken = match fits {
            Some(index) => Some(idle.swap_remove(index)),
            None => idle.pop(),
        };
        drop(idle);
        // The keeper is dropped here, after the lock is released, so that no thread waits for its end.
        taken.filter(|_| fits.is_some())
    }

    fn return_keeper(&self, keeper: Keeper) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(keeper);
    }
}

/// The process that supervises a run.
#[derive(Debug)]
pub(super) enum Host {
    /// A supervisor process for this run only.
    Own(Child),
    /// A keeper, and the pool to which it returns after the run.
    Kept(Box<Keeper>, Arc<KeeperPool>),
}

impl Host {
    /// Returns the error for a supervisor that ended without a report. The caller must have closed its channel.
    pub(super) fn loss_error(self) -> SandboxError {
        match self {
            Self::Own(child) => loss_error(child),
            Self::Kept(mut keeper, _) => {
                keeper.dismiss();
                keeper.child.take().map_or_else(
                    || SandboxError::Lost { how: "its exit status was already collected".into() },
                    loss_error,
                )
            }
        }
    }

    /// Kills the keeper, whatever it is doing.
    pub(super) fn kill(&mut self) {
        let child = match self {
            Self::Own(child) => Some(child),
            Self::Kept(keeper, _) => keeper.child.as_mut(),
        };
        // This fails if the keeper has ended, which does not matter.
        let _ = child.map(Child::kill);
    }

    /// Keeps the keeper for another run, if the report shows that this run ended normally.
    pub(super) fn rest(self, report: Option<&Report>) -> Option<RestingKeeper> {
        match self {
            Self::Own(mut child) => {
                // After its report, the supervisor ends by itself. Its exit status no longer matters.
                let _ = child.wait();
                None
            }
            Self::Kept(keeper, pool) if report.is_some_and(has_simply_ended) => {
                Some(RestingKeeper { keeper: Some(keeper), pool })
            }
            Self::Kept(..) => None,
        }
    }
}

/// A keeper between two runs. When the value is dropped, others can use the keeper. The folder of the last run must be
/// removed before that, because the pages of the folder count for the keeper's group.
#[derive(Debug)]
pub(super) struct RestingKeeper {
    keeper: Option<Box<Keeper>>,
    pool: Arc<KeeperPool>,
}

impl Drop for RestingKeeper {
    fn drop(&mut self) {
        if let Some(keeper) = self.keeper.take() {
            self.pool.return_keeper(*keeper);
        }
    }
}

/// Returns whether the program exited by itself, within its limits.
fn has_simply_ended(report: &Report) -> bool {
    let calm = report.cause.is_none() && report.exec_errno.is_none() && report.survivors == 0 && !report.folder_over;
    calm && libc::WIFEXITED(report.status)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{job::Limits, outcome::RunEnd, wire::Walls};

    fn order() -> RunOrder {
        let walls = Walls { namespaces: true, seccomp: true, ..Walls::default() };
        RunOrder { program: b"/bin/sh".to_vec(), volatile: true, walls, ..RunOrder::default() }
    }

    #[test]
    fn runs_of_one_submission_are_of_one_kind() {
        let kind = Kind::from_order(&order()).unwrap();
        let same = RunOrder {
            folder: b"/x".to_vec(),
            arguments: vec![b"-s".to_vec()],
            files: vec![(b"a".to_vec(), 9)],
            ..order()
        };
        assert_eq!(Kind::from_order(&same).unwrap(), kind);
        for other in [
            RunOrder { program: b"/bin/ls".to_vec(), ..order() },
            RunOrder { limits: Limits { memory: 7, ..Limits::default() }, ..order() },
            RunOrder { readable: vec![b"/etc/hostname".to_vec()], ..order() },
        ] {
            assert_ne!(Kind::from_order(&other).unwrap(), kind);
        }
    }

    #[test]
    fn a_program_that_was_exchanged_is_of_another_kind() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("program");
        let kind = || Kind::from_order(&RunOrder { program: wire::to_raw_bytes(&program), ..order() }).unwrap();
        std::fs::write(&program, "one").unwrap();
        let before = kind();
        assert_eq!(kind(), before);
        std::fs::write(folder.path().join("other"), "two").unwrap();
        std::fs::rename(folder.path().join("other"), &program).unwrap();
        assert_ne!(kind(), before);
    }

    #[test]
    fn tools_and_runs_without_namespaces_have_supervisors_of_their_own() {
        assert!(Kind::from_order(&RunOrder { tools: true, ..order() }).is_none());
        assert!(Kind::from_order(&RunOrder { volatile: false, ..order() }).is_none());
        assert!(Kind::from_order(&RunOrder { walls: Walls::default(), ..order() }).is_none());
    }

    #[test]
    fn only_a_run_that_simply_ended_leaves_its_keeper_to_others() {
        let exited = Report { status: 7 << 8, ..Report::default() };
        assert!(has_simply_ended(&exited));
        for report in [
            Report { cause: Some(RunEnd::WallLimit), ..exited.clone() },
            Report { status: libc::SIGKILL, ..exited.clone() },
            Report { survivors: 1, ..exited.clone() },
            Report { folder_over: true, ..exited.clone() },
            Report { exec_errno: Some(libc::ENOEXEC), ..exited },
        ] {
            assert!(!has_simply_ended(&report), "{report:?}");
        }
    }
}
