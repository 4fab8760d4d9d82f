//! A program at work: its trace as it is written, the means to stop it, and its outcome.

use std::{
    fs::File,
    io::{self, Read, Write},
    os::unix::net::UnixStream,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
};

use super::{
    collect::OpenFolder,
    decide,
    fault::{SandboxError, set_up_failed},
    keepers::Host,
    layers::LayerReport,
    outcome::{Captured, RunOutcome},
    supervisor::orphans,
    wire::{self, COMMAND_CANCEL, COMMAND_TRACE_LIMIT, Event, RunOrder},
};

/// The way to the supervisor; gone when the run is over.
type ControlSocket = Arc<Mutex<Option<UnixStream>>>;

fn command(control: &ControlSocket, command: u8) {
    let mut control = control.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(control) = control.as_mut() {
        // A supervisor that has ended needs no command.
        let _ = control.write_all(&[command]);
    }
}

/// A program at work. Dropped, it is stopped, and the drop waits until every process is dead.
#[derive(Debug)]
pub struct Running {
    state: State,
    trace: Option<TraceReader>,
    folder: Option<OpenFolder>,
    traced: Arc<AtomicU64>,
    canceller: Canceller,
}

#[derive(Debug)]
enum State {
    /// Under a supervisor.
    Supervised(Box<Supervised>),
    /// Known already, with the limit of its trace.
    Known(Box<RunOutcome>, u64),
    /// Handed out.
    Taken,
}

#[derive(Debug)]
pub(super) struct Supervised {
    pub(super) host: Host,
    /// The supervisor's answers.
    pub(super) answers: File,
    pub(super) session: Option<i32>,
    pub(super) user: Option<u32>,
    pub(super) order: RunOrder,
    pub(super) layers: Arc<[LayerReport]>,
}

impl Running {
    /// A run whose supervisor has said that it is ready.
    pub(super) fn new(
        supervised: Supervised,
        control: UnixStream,
        trace: Option<File>,
        folder: Option<OpenFolder>,
    ) -> Self {
        let (limit, control) = (supervised.order.limits.trace_bytes, Arc::new(Mutex::new(Some(control))));
        let state = State::Supervised(Box::new(supervised));
        Self::reading(state, trace.map(Source::Pipe), limit, control, folder)
    }

    /// A run whose outcome is known already.
    pub(super) fn known(outcome: RunOutcome, trace: Option<Vec<u8>>, trace_bytes: u64) -> Self {
        let source = trace.map(|bytes| Source::Bytes(io::Cursor::new(bytes)));
        let state = State::Known(Box::new(outcome), trace_bytes);
        Self::reading(state, source, trace_bytes, ControlSocket::default(), None)
    }

    fn reading(
        state: State,
        source: Option<Source>,
        limit: u64,
        control: ControlSocket,
        folder: Option<OpenFolder>,
    ) -> Self {
        let traced = Arc::new(AtomicU64::new(0));
        let reader = |source| TraceReader { source, limit, traced: traced.clone(), control: control.clone() };
        let trace = source.map(reader);
        Self { state, trace, folder, traced, canceller: Canceller { control } }
    }

    /// The bytes that the program writes into its trace pipe; `None` without one, and from the second call on.
    ///
    /// The program waits while nobody reads and the pipe is full; its clock stands still then, within bounds
    /// ([`Limits::PATIENCE`](super::Limits::PATIENCE)). A reader that is dropped before the end makes the program's
    /// next write fail (`SIGPIPE`).
    pub fn trace(&mut self) -> Option<TraceReader> {
        self.trace.take()
    }

    /// Whether the program works in a copy of its working folder, and the folder itself stays as it is.
    #[must_use]
    pub fn is_in_memory(&self) -> bool {
        self.folder.is_some()
    }

    /// A handle that stops the program, for other threads and for Ctrl-C.
    #[must_use]
    pub fn canceller(&self) -> Canceller {
        self.canceller.clone()
    }

    /// Waits until the program and all that it started are dead. A trace that nobody has asked for is read and counted.
    ///
    /// # Errors
    ///
    /// Faults of ours or of the host.
    pub fn wait(mut self) -> Result<RunOutcome, SandboxError> {
        // Its pages would count for the supervisor's next run.
        self.folder = None;
        self.wait_with_folder().map(|(outcome, _)| outcome)
    }

    /// As [`Running::wait`], with what the program left in its working folder, where that lay in memory
    /// ([`Job::folder_in_memory`](super::Job::folder_in_memory)). Otherwise it lies where the job says.
    ///
    /// # Errors
    ///
    /// As for [`Running::wait`].
    pub fn wait_with_folder(mut self) -> Result<(RunOutcome, Option<OpenFolder>), SandboxError> {
        if let Some(mut trace) = self.trace.take() {
            // Its only error is the one that ends the program as well.
            let _ = io::copy(&mut trace, &mut io::sink());
        }
        let outcome = match std::mem::replace(&mut self.state, State::Taken) {
            State::Supervised(supervised) => self.conclude(*supervised)?,
            State::Known(outcome, limit) => {
                let traced = self.traced.load(Ordering::Relaxed);
                RunOutcome { ended: decide::beyond_trace(outcome.ended, traced > limit), ..*outcome }
            }
            State::Taken => unreachable!("`wait` takes the run by value"),
        };
        Ok((outcome, self.folder.take()))
    }

    fn conclude(&self, mut supervised: Supervised) -> Result<RunOutcome, SandboxError> {
        let answer = receive(&mut supervised.answers);
        // Nobody commands a supervisor that has reported.
        drop(self.canceller.control.lock().unwrap_or_else(PoisonError::into_inner).take());
        let (event, stdout, stderr) = match answer {
            Ok(answer) => answer,
            Err(_) => {
                let error = supervised.host.lost();
                orphans::end(supervised.session, supervised.user);
                return Err(error);
            }
        };
        let report = match event {
            Event::Done(report) => Ok(report),
            Event::Failed(failure) => Err(set_up_failed(failure)),
            Event::Ready { .. } => Err(SandboxError::Lost { how: "it spoke out of turn".into() }),
        };
        supervised.host.rest(report.as_ref().ok(), self.folder.is_none());
        let report = report?;
        if report.survivors > 0 {
            return Err(SandboxError::Survivors { count: report.survivors });
        }
        let program = wire::path(&supervised.order.program);
        if report.exec_errno.is_some() && !program.is_file() {
            return Err(SandboxError::Changed { program: program.display().to_string() });
        }
        let traced = self.traced.load(Ordering::Relaxed);
        let ended = decide::ended(&supervised.order, &report, &stderr);
        Ok(RunOutcome {
            ended: decide::beyond_trace(ended, traced > supervised.order.limits.trace_bytes),
            cpu: report.cpu,
            wall: report.wall,
            peak_memory: report.peak_memory,
            bytes_written: report.stdout_bytes + report.stderr_bytes + report.folder_growth + traced,
            stdout: Captured { bytes: stdout, truncated: report.stdout_truncated },
            stderr: Captured { bytes: stderr, truncated: report.stderr_truncated },
            layers: supervised.layers,
        })
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let State::Supervised(supervised) = std::mem::replace(&mut self.state, State::Taken) {
            self.canceller.cancel();
            // The program must not wait for a reader that never comes.
            self.trace = None;
            // Stopped by us: its further actions do not matter.
            let _ = self.conclude(*supervised);
        }
    }
}

/// The supervisor's last message and the captured bytes behind it.
fn receive(answers: &mut File) -> io::Result<(Event, Vec<u8>, Vec<u8>)> {
    let event = wire::receive(&mut *answers)?;
    let mut bytes = |length| wire::receive_bytes(&mut *answers, length);
    let (first, second) = match &event {
        Event::Done(report) => (bytes(report.stdout_bytes)?, bytes(report.stderr_bytes)?),
        _ => Default::default(),
    };
    Ok((event, first, second))
}

/// Stops a program; harmless when it has ended.
#[derive(Debug, Clone)]
pub struct Canceller {
    control: ControlSocket,
}

impl Canceller {
    /// Has the program and all that it started killed; [`Running::wait`] then says `Cancelled`.
    pub fn cancel(&self) {
        command(&self.control, COMMAND_CANCEL);
    }
}

/// The trace is longer than the limit; wrapped in the [`io::Error`] of the read that noticed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the trace is longer than {limit} bytes, the limit for this run")]
pub struct TraceTooLong {
    /// The limit in bytes.
    pub limit: u64,
}

/// The bytes of the trace as the program writes them. Reads wait for the program; the end comes when it is dead.
#[derive(Debug)]
pub struct TraceReader {
    source: Source,
    limit: u64,
    traced: Arc<AtomicU64>,
    control: ControlSocket,
}

#[derive(Debug)]
enum Source {
    Pipe(File),
    Bytes(io::Cursor<Vec<u8>>),
}

impl Read for TraceReader {
    /// Reads on. An error that holds [`TraceTooLong`] comes instead of the first byte beyond the limit, for good, and
    /// the program is stopped. Nobody who can do with the bytes within the limit gets to see it, however the bytes were
    /// shared out among reads.
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let before = self.traced.load(Ordering::Relaxed);
        let room = usize::try_from(self.limit.saturating_sub(before)).unwrap_or(usize::MAX).min(buffer.len());
        if room > 0 || buffer.is_empty() {
            let length = self.source.read(&mut buffer[..room])?;
            self.traced.store(before + length as u64, Ordering::Relaxed);
            return Ok(length);
        }
        if before == self.limit {
            if self.source.read(&mut [0])? == 0 {
                return Ok(0);
            }
            self.traced.store(before + 1, Ordering::Relaxed);
            command(&self.control, COMMAND_TRACE_LIMIT);
        }
        Err(io::Error::other(TraceTooLong { limit: self.limit }))
    }
}

impl Read for Source {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Pipe(file) => file.read(buffer),
            Self::Bytes(bytes) => bytes.read(buffer),
        }
    }
}
