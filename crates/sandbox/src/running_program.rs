//! A running program. It can be stopped. After its end, its outcome and the files that it left can be read.

use std::{
    fs::File,
    io::{self, Write},
    os::unix::net::UnixStream,
    path::PathBuf,
    sync::{Arc, Mutex, PoisonError},
};

use super::{
    collect::{CollectError, OpenFolder},
    keepers::{IdleKeeper, RunSupervisor},
    layers::LayerReport,
    outcome::{CapturedOutput, RunOutcome},
    run_end,
    sandbox_error::{SandboxError, from_setup_failure},
    supervisor::orphans,
    wire::{self, COMMAND_CANCEL, Event, RunOrder},
};

/// The connection to the supervisor; `None` after the run.
type ControlSocket = Arc<Mutex<Option<UnixStream>>>;

/// A running program. Dropping the value stops the program and ends all its processes.
#[derive(Debug)]
pub struct RunningProgram {
    state: RunState,
    folder: RemainingFolder,
    canceler: Canceler,
}

#[derive(Debug)]
enum RunState {
    /// A supervisor controls the run.
    Supervised(Box<SupervisedRun>),
    /// The outcome is known, and was not returned to the caller yet.
    Known(Box<RunOutcome>),
    /// The outcome has been returned to the caller.
    Taken,
}

#[derive(Debug)]
pub(super) struct SupervisedRun {
    pub(super) supervisor: RunSupervisor,
    /// The file from which the supervisor's answers are read.
    pub(super) answers: File,
    pub(super) session: Option<i32>,
    pub(super) user: Option<u32>,
    pub(super) order: RunOrder,
    pub(super) layers: Arc<[LayerReport]>,
}

impl RunningProgram {
    /// Creates the value for a run whose supervisor has reported that it is ready.
    pub(super) fn new(supervised: SupervisedRun, control: UnixStream, memory_folder: Option<OpenFolder>) -> Self {
        let folder = RemainingFolder { memory_folder, path: wire::to_path(&supervised.order.folder), _keeper: None };
        let control = Arc::new(Mutex::new(Some(control)));
        Self { state: RunState::Supervised(Box::new(supervised)), folder, canceler: Canceler { control } }
    }

    /// Creates the value for a run in the folder `path` whose outcome is already known.
    pub(super) fn from_outcome(outcome: RunOutcome, path: PathBuf) -> Self {
        let folder = RemainingFolder { memory_folder: None, path, _keeper: None };
        let canceler = Canceler { control: ControlSocket::default() };
        Self { state: RunState::Known(Box::new(outcome)), folder, canceler }
    }

    /// Returns whether the program works in a copy of its working folder in memory. The folder on disk then does not
    /// change.
    pub fn is_in_memory(&self) -> bool {
        self.folder.memory_folder.is_some()
    }

    /// Returns a handle that stops the program. It can be used in other threads, and on Ctrl-C.
    pub fn canceler(&self) -> Canceler {
        self.canceler.clone()
    }

    /// Waits until the program and all its processes have ended.
    ///
    /// # Errors
    ///
    /// Fails if the grader or the host fails.
    pub fn wait(self) -> Result<RunOutcome, SandboxError> {
        self.wait_with_folder().map(|(outcome, _)| outcome)
    }

    /// Waits like [`RunningProgram::wait`], and also returns the files that the program left in its working folder.
    ///
    /// # Errors
    ///
    /// Fails like [`RunningProgram::wait`].
    pub fn wait_with_folder(mut self) -> Result<(RunOutcome, RemainingFolder), SandboxError> {
        let (outcome, keeper) = match std::mem::replace(&mut self.state, RunState::Taken) {
            RunState::Supervised(supervised) => self.conclude(*supervised)?,
            RunState::Known(outcome) => (*outcome, None),
            RunState::Taken => unreachable!("`wait` takes the run by value"),
        };
        let RemainingFolder { memory_folder, path, .. } = std::mem::take(&mut self.folder);
        Ok((outcome, RemainingFolder { memory_folder, path, _keeper: keeper }))
    }

    fn conclude(&self, mut supervised: SupervisedRun) -> Result<(RunOutcome, Option<IdleKeeper>), SandboxError> {
        let answer = receive_end(&mut supervised.answers);
        // A supervisor that has reported needs no further commands.
        drop(self.canceler.control.lock().unwrap_or_else(PoisonError::into_inner).take());
        let (event, stdout, stderr) = match answer {
            Ok(answer) => answer,
            Err(_) => {
                let error = supervised.supervisor.loss_error();
                orphans::kill_orphans(supervised.session, supervised.user);
                return Err(error);
            }
        };
        let report = match event {
            Event::Done(report) => Ok(report),
            Event::Failed(failure) => Err(from_setup_failure(failure)),
            Event::Ready { .. } => Err(SandboxError::Lost { how: "it sent an unexpected message".into() }),
        };
        let keeper = supervised.supervisor.keep_for_reuse(report.as_ref().ok());
        let report = report?;
        if report.survivors > 0 {
            return Err(SandboxError::Survivors { count: report.survivors });
        }
        let program = wire::to_path(&supervised.order.program);
        if report.exec_errno.is_some() && !program.is_file() {
            return Err(SandboxError::ChangedProgram { program: program.display().to_string() });
        }
        let outcome = RunOutcome {
            ended: run_end::decide_end(&supervised.order, &report, &stderr),
            cpu: report.cpu,
            wall: report.wall,
            peak_memory: report.peak_memory,
            stdout: CapturedOutput { bytes: stdout, truncated: report.stdout_truncated },
            stderr: CapturedOutput { bytes: stderr, truncated: report.stderr_truncated },
            layers: supervised.layers,
        };
        Ok((outcome, keeper))
    }
}

/// The working folder after the program has ended. All processes of the run have ended as well, so the folder no longer
/// changes. When the value is dropped, other runs can use the supervisor.
#[derive(Debug, Default)]
pub struct RemainingFolder {
    memory_folder: Option<OpenFolder>,
    path: PathBuf,
    // The host is dropped last. Otherwise the pages of a folder in memory would count toward the memory of the keeper's
    // next run.
    _keeper: Option<IdleKeeper>,
}

impl RemainingFolder {
    /// Returns the folder, if the program worked in a copy in memory
    /// ([`Job::folder_in_memory`](super::Job::folder_in_memory)). Otherwise the files are in the job's folder on disk.
    pub fn memory_folder(&self) -> Option<&OpenFolder> {
        self.memory_folder.as_ref()
    }

    /// Opens a regular file in the folder, and returns it with its length. The file must have at most `longest` bytes.
    /// Links are not followed.
    ///
    /// # Errors
    ///
    /// Fails if there is no such regular file.
    pub fn regular_file(&self, name: &str, longest: u64) -> Result<(File, u64), CollectError> {
        if let Some(folder) = &self.memory_folder {
            return folder.regular_file(name, longest);
        }
        let opened = OpenFolder::open(&self.path);
        opened.map_err(|source| CollectError::System { name: name.to_owned(), source })?.regular_file(name, longest)
    }
}

impl Drop for RunningProgram {
    fn drop(&mut self) {
        if let RunState::Supervised(supervised) = std::mem::replace(&mut self.state, RunState::Taken) {
            self.canceler.cancel();
            // The caller no longer needs the program, so errors do not matter.
            let _ = self.conclude(*supervised);
        }
    }
}

/// Returns the supervisor's last message, and the captured bytes that follow it.
fn receive_end(answers: &mut File) -> io::Result<(Event, Vec<u8>, Vec<u8>)> {
    let event = wire::receive(&mut *answers)?;
    let mut bytes = |length| wire::receive_bytes(&mut *answers, length);
    let (first, second) = match &event {
        Event::Done(report) => (bytes(report.stdout_bytes)?, bytes(report.stderr_bytes)?),
        _ => Default::default(),
    };
    Ok((event, first, second))
}

/// A handle that stops a program. If the program has ended, the handle does nothing.
#[derive(Debug, Clone)]
pub struct Canceler {
    control: ControlSocket,
}

impl Canceler {
    /// Kills the program and all its processes. Then [`RunningProgram::wait`] returns `Canceled`.
    pub fn cancel(&self) {
        if let Some(control) = self.control.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
            // This fails if the supervisor has ended, which does not matter.
            let _ = control.write_all(&[COMMAND_CANCEL]);
        }
    }
}
