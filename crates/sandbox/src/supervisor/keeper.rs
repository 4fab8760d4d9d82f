//! A supervisor for all runs of one submission, one after the other.
//!
//! The parts common to all runs are created once: the process itself, a user and a control group, a root folder with
//! the files that every run may read, a namespace without network, Landlock's places and the filters. For each run the
//! keeper forks into new namespaces of processes, mounts and messages; the child is the run's supervisor and the first
//! process of its namespace, with a copy of the prepared mounts, a working folder in memory and a separate `/proc`.
//! Everything that a run could leave behind is removed with them; the prepared root is read-only, and no filter allows
//! sockets. The next run begins when the kernel has ended the last process of the previous run. After a run that did
//! not end by itself, the grader uses no keeper again.
//!
//! The guardian outside holds the user and the control group until the keeper has ended. The keeper dies with the
//! guardian, and every run with the keeper.

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
    namespaces,
    prepared_run::{HeldResources, PreparedRun},
    run::{self, Run},
    view,
};
use crate::{
    mounts,
    sys::{self, Fork, Readiness},
    wire::{self, Event, Failure, RawBytes, RunOrder, failure_at},
};

/// The time after which a keeper without orders ends, so that others can use its user.
const MAX_IDLE: Duration = Duration::from_secs(2);
/// The number of a program in its process namespace, where the supervisor is the first.
const PROGRAM_PID: i32 = 2;

/// Serves the requests from standard input, a socket.
pub(super) fn main() -> ExitCode {
    let Ok(socket) = io::stdin().as_fd().try_clone_to_owned().map(UnixStream::from) else { return ExitCode::from(2) };
    let Ok(Some(mut first)) = RunRequest::next(&socket) else { return ExitCode::from(2) };
    ExitCode::from(match fork_keeper(&first.order) {
        Ok(Side::Guardian { keeper, held }) => {
            // The pipe that the grader reads must be closed at the end of the run.
            drop((first, socket));
            let code = sys::wait_for(keeper).unwrap_or(1);
            drop(held);
            code
        }
        Ok(Side::Keeper(keeper)) => keeper.serve(first, &socket),
        Err(failure) => {
            // Sending fails if the grader has ended, which does not matter.
            let _ = wire::send(&mut first.answers, &Event::Failed(failure));
            1
        }
    })
}

/// One run: its order, the connection with the grader, the working folder on disk, and further files for that folder.
struct RunRequest {
    order: RunOrder,
    control: File,
    answers: File,
    folder: OwnedFd,
    files: Vec<(RawBytes, Vec<u8>)>,
}

impl RunRequest {
    /// Returns the next request; `None` if the grader has no more.
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

enum Side {
    /// Outside the namespaces: the process only waits for the keeper.
    Guardian {
        keeper: i32,
        held: HeldResources,
    },
    Keeper(Keeper),
}

/// Takes the run's exclusive resources, and prepares its namespaces in a child.
fn fork_keeper(order: &RunOrder) -> Result<Side, Failure> {
    sys::new_session().map_err(failure_at("start the supervisor's session"))?;
    let alone = sys::single_thread().map_err(failure_at("fork"))?;
    let held = HeldResources::take(order)?;
    if let Fork::Parent(keeper) = namespaces::fork_into_namespaces()? {
        return Ok(Side::Guardian { keeper, held });
    }
    mounts::unshare(libc::CLONE_NEWNS | libc::CLONE_NEWNET).map_err(failure_at("make namespaces"))?;
    view::prepare(order)?;
    let prepared = PreparedRun::for_order(order, PROGRAM_PID, alone)?;
    Ok(Side::Keeper(Keeper { held: Some(held), prepared }))
}

struct Keeper {
    /// The resources, of which every run uses a copy.
    held: Option<HeldResources>,
    prepared: PreparedRun,
}

impl Keeper {
    /// Serves one request after the other, until there are no more or one ends unexpectedly.
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
        let folder = wire::path(&request.order.folder);
        let namespaces = libc::CLONE_NEWPID | libc::CLONE_NEWNS | libc::CLONE_NEWIPC | libc::CLONE_NEWUTS;
        // The mount point of the folder exists only during its run.
        let forked = std::fs::create_dir_all(&folder).and_then(|()| self.prepared.fork_into(namespaces));
        match forked {
            Ok(Fork::Child) => sys::exit_now(self.supervise(request).into()),
            Ok(Fork::Parent(supervisor)) => {
                drop(request);
                let code = sys::wait_for(supervisor).unwrap_or(1);
                // A folder that was visible before must not be removed.
                let _ = std::fs::remove_dir(folder);
                code
            }
            Err(error) => run::report_end(Err(Failure::new("make namespaces", &error)), &mut request.answers).max(1),
        }
    }

    /// Serves one run, and returns its exit code.
    fn supervise(&mut self, request: RunRequest) -> u8 {
        let RunRequest { order, control, mut answers, folder, files } = request;
        let Some(held) = self.held.take() else { return 1 };
        let bound = sys::die_with_parent().map_err(failure_at("bind the supervisor's life to its keeper's"));
        let finished = bound
            .and_then(|()| view::complete(&order, folder.as_fd(), &files))
            .and_then(|()| Run::start(order, control, held, &self.prepared))
            .and_then(|run| run.finish(&mut answers));
        run::report_end(finished, &mut answers)
    }
}
