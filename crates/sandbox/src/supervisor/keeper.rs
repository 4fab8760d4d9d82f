//! The keeper, which is the supervisor for all runs of one submission, one after the other.
//!
//! The parts that all runs have in common are created once: the process itself, a user and a control group, a root
//! folder with the files that every run may read, a namespace without network, the places for Landlock, and the
//! filters. For each run, the keeper forks into new namespaces of processes, mounts and messages. The child is the
//! run's supervisor, and the first process in its namespace. It has a copy of the prepared mounts, a working folder in
//! memory, and its own `/proc`. Everything that a run could leave behind is removed with these namespaces. The prepared
//! root is read-only, and no filter allows sockets. The next run begins after the kernel has ended the last process of
//! the previous run. After a run that did not end by itself, the grader does not use the keeper again.
//!
//! A guardian process outside of the namespaces holds the user and the control group until the keeper has ended. If the
//! guardian ends, the keeper and its runs end as well.

use std::{
    fs::File,
    io,
    os::{
        fd::{AsFd, OwnedFd},
        unix::net::UnixStream,
    },
    process::ExitCode,
    time::Duration,
};

use super::{
    file_view, namespaces,
    prepared_run::{ExclusiveResources, PreparedRun},
    run::{self, Run},
};
use crate::{
    mounts,
    sys::{self, Fork, Readiness},
    wire::{self, Event, Failure, RawBytes, RunOrder, failure_at},
};

/// The time without orders after which a keeper ends, so that others can use its user.
const MAX_IDLE: Duration = Duration::from_secs(2);
/// The ID of the program's process in its namespace, in which the supervisor has the ID 1.
const PROGRAM_PID: i32 = 2;

/// Serves the requests that arrive on standard input, which is a socket.
pub(super) fn main() -> ExitCode {
    let Ok(socket) = io::stdin().as_fd().try_clone_to_owned().map(UnixStream::from) else { return ExitCode::from(2) };
    let Ok(Some(mut first)) = RunRequest::next(&socket) else { return ExitCode::from(2) };
    ExitCode::from(match fork_keeper(&first.order) {
        Ok(ForkSide::Guardian { keeper, resources }) => {
            // The pipe from which the grader reads must be closed at the end of the run.
            drop((first, socket));
            let code = sys::wait_for_exit(keeper).unwrap_or(1);
            drop(resources);
            code
        }
        Ok(ForkSide::Keeper(keeper)) => keeper.serve(first, &socket),
        Err(failure) => {
            // This fails if the grader has ended, which does not matter.
            let _ = wire::send(&mut first.answers, &Event::Failed(failure));
            1
        }
    })
}

/// A requested run: its order, the connection to the grader, the working folder on disk, and further files for that
/// folder.
struct RunRequest {
    order: RunOrder,
    control: File,
    answers: File,
    folder: OwnedFd,
    files: Vec<(RawBytes, Vec<u8>)>,
}

impl RunRequest {
    /// Returns the next request; `None` if the grader has no more requests.
    fn next(socket: &UnixStream) -> io::Result<Option<Self>> {
        let mut byte = [0];
        let (length, descriptors) = sys::receive_descriptors(socket, &mut byte)?;
        if length == 0 {
            return Ok(None);
        }
        let (wire::RUN_BYTE, Ok([control, answers, folder])) = (byte[0], <[OwnedFd; 3]>::try_from(descriptors)) else {
            return Err(io::ErrorKind::InvalidData.into());
        };
        let order: RunOrder = wire::receive(socket)?;
        let file = |(name, length): &(RawBytes, u64)| Ok((name.clone(), wire::receive_bytes(socket, *length)?));
        let files = order.files.iter().map(file).collect::<io::Result<_>>()?;
        Ok(Some(Self { order, control: control.into(), answers: answers.into(), folder, files }))
    }
}

enum ForkSide {
    /// The process outside of the namespaces, which only waits for the keeper.
    Guardian {
        keeper: i32,
        resources: ExclusiveResources,
    },
    Keeper(Keeper),
}

/// Claims the exclusive resources of the runs, and prepares their namespaces in a child process.
fn fork_keeper(order: &RunOrder) -> Result<ForkSide, Failure> {
    sys::start_session().map_err(failure_at("start the supervisor's session"))?;
    let single_thread = sys::single_thread().map_err(failure_at("fork"))?;
    let resources = ExclusiveResources::claim(order)?;
    if let Fork::Parent(keeper) = namespaces::fork_into_namespaces()? {
        return Ok(ForkSide::Guardian { keeper, resources });
    }
    mounts::unshare(libc::CLONE_NEWNS | libc::CLONE_NEWNET).map_err(failure_at("make namespaces"))?;
    file_view::prepare(order)?;
    let prepared = PreparedRun::for_order(order, PROGRAM_PID, single_thread)?;
    Ok(ForkSide::Keeper(Keeper { resources: Some(resources), prepared }))
}

struct Keeper {
    /// The exclusive resources. Each run uses a copy of their descriptors.
    resources: Option<ExclusiveResources>,
    prepared: PreparedRun,
}

impl Keeper {
    /// Serves one request after the other. Ends when there are no more, or when a run ends unexpectedly.
    fn serve(mut self, first: RunRequest, socket: &UnixStream) -> u8 {
        let mut next = Some(first);
        while let Some(request) = next {
            match self.run(request) {
                0 => {}
                code => return code,
            }
            next = match sys::poll([Some(socket.as_fd())], MAX_IDLE) {
                Ok([Readiness::Ready]) => RunRequest::next(socket).ok().flatten(),
                _ => None,
            };
        }
        0
    }

    fn run(&mut self, mut request: RunRequest) -> u8 {
        let folder = wire::to_path(&request.order.folder);
        let namespaces = libc::CLONE_NEWPID | libc::CLONE_NEWNS | libc::CLONE_NEWIPC | libc::CLONE_NEWUTS;
        // The mount point for the folder exists only during the run.
        let forked = std::fs::create_dir_all(&folder).and_then(|()| self.prepared.fork_into(namespaces));
        match forked {
            Ok(Fork::Child) => sys::exit_now(self.supervise(request).into()),
            Ok(Fork::Parent(supervisor)) => {
                drop(request);
                let code = sys::wait_for_exit(supervisor).unwrap_or(1);
                // If the folder was visible before, it must not be removed.
                let _ = std::fs::remove_dir(folder);
                code
            }
            Err(error) => run::report_end(Err(Failure::new("make namespaces", &error)), &mut request.answers).max(1),
        }
    }

    /// Serves one run, and returns the exit code of its supervisor.
    fn supervise(&mut self, request: RunRequest) -> u8 {
        let RunRequest { order, control, mut answers, folder, files } = request;
        let Some(resources) = self.resources.take() else { return 1 };
        let bound = sys::die_with_parent().map_err(failure_at("make the supervisor end with its keeper"));
        let finished = bound
            .and_then(|()| file_view::complete_view(&order, folder.as_fd(), &files))
            .and_then(|()| Run::start(order, control, resources, &self.prepared))
            .and_then(|run| run.finish(&mut answers));
        run::report_end(finished, &mut answers)
    }
}
