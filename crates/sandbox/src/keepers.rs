//! The grader's side of supervisors that serve several runs of one submission.
//!
//! With them, grading a correct program on 116 scenes takes 1.2 s of processor time, compared with 2.0 s with one
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
    job::ProgramIdentity,
    sandbox_error::{SandboxError, loss_error},
    sys,
    wire::{self, Report, RunOrder},
};

/// The properties that all runs of a keeper share: the order except for the arguments, the environment, and the working
/// folder with its contents; and the identities of the files that the order names.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct RunKind {
    order: RunOrder,
    program: Option<ProgramIdentity>,
    files: Vec<Option<(u64, u64)>>,
}

impl RunKind {
    /// Returns whether a keeper may serve the order. The run must have its working folder in memory, namespaces that
    /// end with it, and a system call filter. It must not be allowed to start other programs.
    pub(super) fn is_possible_for(order: &RunOrder) -> bool {
        order.is_in_memory && !order.allows_tools && order.layers.namespaces && order.layers.seccomp
    }

    /// Returns the kind of an order; `None` if no keeper may serve it.
    pub(super) fn from_order(order: &RunOrder) -> Option<Self> {
        if !Self::is_possible_for(order) {
            return None;
        }
        let common = RunOrder {
            folder: Vec::new(),
            arguments: Vec::new(),
            environment: Vec::new(),
            files: Vec::new(),
            ..order.clone()
        };
        let named_paths = order.readable.iter().chain(&order.executable).chain(&order.named_paths);
        let identity = |path: &Path| path.metadata().ok().map(|metadata| (metadata.dev(), metadata.ino()));
        let files = named_paths.map(|path| identity(&wire::to_path(path))).collect();
        Some(Self { order: common, program: ProgramIdentity::from_path(&wire::to_path(&order.program)), files })
    }
}

/// A keeper process. When the value is dropped, the process is stopped, and its end is awaited.
#[derive(Debug)]
pub(super) struct Keeper {
    kind: RunKind,
    child: Option<Child>,
    socket: UnixStream,
}

impl Keeper {
    pub(super) fn new(kind: RunKind, child: Child, socket: UnixStream) -> Self {
        Self { kind, child: Some(child), socket }
    }

    /// Requests a run. `files` are the contents of the files that the order names. Returns the connection to the run's
    /// supervisor, and the file from which its answers are read.
    pub(super) fn request_run(&self, order: &RunOrder, files: &[(String, Vec<u8>)]) -> io::Result<(UnixStream, File)> {
        let folder = File::open(wire::to_path(&order.folder))?;
        let (control, theirs) = UnixStream::pair()?;
        let (answers, writer) = io::pipe()?;
        let mut packet = wire::encode_packet(order)?;
        files.iter().for_each(|(_, content)| packet.extend_from_slice(content));
        sys::send_descriptors(&self.socket, wire::RUN_BYTE, [theirs.as_fd(), writer.as_fd(), folder.as_fd()])?;
        (&self.socket).write_all(&packet)?;
        Ok((control, OwnedFd::from(answers).into()))
    }

    fn end_process(&self) {
        // This fails if the keeper has ended, which does not matter.
        let _ = self.socket.shutdown(Shutdown::Both);
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        self.end_process();
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
    /// Takes an idle keeper for runs of this kind. If there is none, an idle keeper of another kind is stopped to make
    /// room.
    pub(super) fn take_keeper(&self, kind: &RunKind) -> Option<Keeper> {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let same_kind = idle.iter().rposition(|keeper| keeper.kind == *kind);
        let keeper = match same_kind {
            Some(index) => Some(idle.swap_remove(index)),
            None => idle.pop(),
        };
        drop(idle);
        // The keeper is dropped here, after the lock is released, so that no thread waits for its end.
        keeper.filter(|_| same_kind.is_some())
    }

    fn return_keeper(&self, keeper: Keeper) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(keeper);
    }
}

/// The process that supervises a run.
#[derive(Debug)]
pub(super) enum RunSupervisor {
    /// A supervisor process for this run only.
    Own(Child),
    /// A keeper, and the pool to which it returns after the run.
    Shared(Box<Keeper>, Arc<KeeperPool>),
}

impl RunSupervisor {
    /// Returns the error for a supervisor that ended without a report. The caller must have closed its channel.
    pub(super) fn loss_error(self) -> SandboxError {
        match self {
            Self::Own(child) => loss_error(child),
            Self::Shared(mut keeper, _) => {
                keeper.end_process();
                keeper.child.take().map_or_else(
                    || SandboxError::Lost { how: "its exit status was already collected".into() },
                    loss_error,
                )
            }
        }
    }

    /// Kills the supervisor or the keeper, whatever it is doing.
    pub(super) fn kill(&mut self) {
        let child = match self {
            Self::Own(child) => Some(child),
            Self::Shared(keeper, _) => keeper.child.as_mut(),
        };
        // This fails if the process has ended, which does not matter.
        let _ = child.map(Child::kill);
    }

    /// Keeps the keeper for another run, if the report shows that this run ended normally.
    pub(super) fn keep_for_reuse(self, report: Option<&Report>) -> Option<IdleKeeper> {
        match self {
            Self::Own(mut child) => {
                // After its report, the supervisor ends by itself. Its exit status no longer matters.
                let _ = child.wait();
                None
            }
            Self::Shared(keeper, pool) if report.is_some_and(has_ended_normally) => {
                Some(IdleKeeper { keeper: Some(keeper), pool })
            }
            Self::Shared(..) => None,
        }
    }
}

/// A keeper between two runs. When the value is dropped, others can use the keeper. The folder of the last run must be
/// removed before that, because the pages of the folder count toward the memory of the keeper's group.
#[derive(Debug)]
pub(super) struct IdleKeeper {
    keeper: Option<Box<Keeper>>,
    pool: Arc<KeeperPool>,
}

impl Drop for IdleKeeper {
    fn drop(&mut self) {
        if let Some(keeper) = self.keeper.take() {
            self.pool.return_keeper(*keeper);
        }
    }
}

/// Returns whether the program exited by itself, within its limits.
fn has_ended_normally(report: &Report) -> bool {
    let calm =
        report.cause.is_none() && report.exec_errno.is_none() && report.survivors == 0 && !report.exceeds_folder_limit;
    calm && libc::WIFEXITED(report.status)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{job::Limits, outcome::RunEnd, wire::ActiveLayers};

    fn order() -> RunOrder {
        let walls = ActiveLayers { namespaces: true, seccomp: true, ..ActiveLayers::default() };
        RunOrder { program: b"/bin/sh".to_vec(), is_in_memory: true, layers: walls, ..RunOrder::default() }
    }

    #[test]
    fn runs_of_one_submission_are_of_one_kind() {
        let kind = RunKind::from_order(&order()).unwrap();
        let same = RunOrder {
            folder: b"/x".to_vec(),
            arguments: vec![b"-s".to_vec()],
            files: vec![(b"a".to_vec(), 9)],
            ..order()
        };
        assert_eq!(RunKind::from_order(&same).unwrap(), kind);
        for other in [
            RunOrder { program: b"/bin/ls".to_vec(), ..order() },
            RunOrder { limits: Limits { memory: 7, ..Limits::default() }, ..order() },
            RunOrder { readable: vec![b"/etc/hostname".to_vec()], ..order() },
        ] {
            assert_ne!(RunKind::from_order(&other).unwrap(), kind);
        }
    }

    #[test]
    fn a_program_that_was_exchanged_is_of_another_kind() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("program");
        let kind = || RunKind::from_order(&RunOrder { program: wire::to_raw_bytes(&program), ..order() }).unwrap();
        std::fs::write(&program, "one").unwrap();
        let before = kind();
        assert_eq!(kind(), before);
        std::fs::write(folder.path().join("other"), "two").unwrap();
        std::fs::rename(folder.path().join("other"), &program).unwrap();
        assert_ne!(kind(), before);
    }

    #[test]
    fn tools_and_runs_without_namespaces_have_supervisors_of_their_own() {
        assert!(RunKind::from_order(&RunOrder { allows_tools: true, ..order() }).is_none());
        assert!(RunKind::from_order(&RunOrder { is_in_memory: false, ..order() }).is_none());
        assert!(RunKind::from_order(&RunOrder { layers: ActiveLayers::default(), ..order() }).is_none());
    }

    #[test]
    fn only_a_run_that_simply_ended_leaves_its_keeper_to_others() {
        let exited = Report { status: 7 << 8, ..Report::default() };
        assert!(has_ended_normally(&exited));
        for report in [
            Report { cause: Some(RunEnd::WallLimit), ..exited.clone() },
            Report { status: libc::SIGKILL, ..exited.clone() },
            Report { survivors: 1, ..exited.clone() },
            Report { exceeds_folder_limit: true, ..exited.clone() },
            Report { exec_errno: Some(libc::ENOEXEC), ..exited },
        ] {
            assert!(!has_ended_normally(&report), "{report:?}");
        }
    }
}
