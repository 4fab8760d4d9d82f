//! Runs one program under limits and reports how it ended.
//!
//! The room knows nothing of scenes, traces or verdicts: bytes go in and out, and a [`RunOutcome`] holds what the
//! kernel saw. [`Job`] is what to run, [`Backend`] is how, [`RunningProgram`] is a program at work.
//!
//! How it works: the grader starts its own binary again with a hidden first argument ([`supervisor_main`]). That
//! fresh, single-threaded process is the *supervisor*: it makes itself the reaper of everything below it, forks, shuts
//! the child in (own session, other user when it is root, resource limits, no new privileges, Landlock, seccomp) and
//! executes the program. It watches clocks, memory, output and the working folder, kills the whole tree, and reports
//! only when every process is dead. The child dies with the supervisor, and the supervisor's tree dies with the
//! grader, whatever kills them.
//!
//! Where the kernel lets it, the supervisor first moves into namespaces of its own, in which only the run's processes
//! and files exist and no network; when a process dies there, all processes below it die, too. This is a further wall,
//! never the only one: everything else holds without it. There, runs of one submission share a *keeper*, which is
//! prepared once and forks a supervisor for each run into fresh namespaces. A keeper whose run was stopped, crashed or
//! left anything serves no other run.
//!
//! The sandbox never trusts a path that the program could change, never reads a result while the program lives, and
//! never continues silently when a required layer is missing ([`Backend::best`] fails).
//!
//! ```no_run
//! use fosssim_sandbox::{Backend, Job, Supervisor};
//!
//! let backend = Backend::best(Supervisor::this_program())?;
//! let running = backend.start(&Job::new("./FOSSSim", "/tmp/work"))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod backend;
pub mod collect;
mod decide;
mod doctor;
mod fake;
mod fault;
mod job;
mod keepers;
mod laid;
mod layers;
mod machine;
mod mounts;
mod outcome;
mod own;
mod program;
mod room;
mod running;
pub mod selftest;
mod supervisor;
mod sys;
mod wire;

pub use backend::{Backend, Supervisor};
pub use doctor::doctor;
pub use fake::FakeRun;
pub use fault::SandboxError;
pub use job::{Job, Limits, Policy, ProgramIdentity};
pub use layers::{Layer, LayerReport};
pub use outcome::{CapturedOutput, RunEnd, RunOutcome, StartProblem};
pub use own::is_own;
pub use running::{Canceller, LeftFolder, RunningProgram};
pub use supervisor::supervisor_main;
#[doc(hidden)]
pub use wire::read_messages;

/// The owner of the requested processor time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeOf {
    /// This thread.
    Thread,
    /// This process.
    Process,
    /// The processes of all runs that have ended, and their supervisors.
    Children,
}

/// Returns a processor time, in user mode and in the kernel together.
#[must_use]
pub fn processor_time(of: TimeOf) -> std::time::Duration {
    match of {
        TimeOf::Thread => sys::processor_time(true),
        TimeOf::Process => sys::processor_time(false),
        TimeOf::Children => sys::children_usage().map_or(std::time::Duration::ZERO, |(time, _)| time),
    }
}

/// Lets this process's own writes beyond its limit of file sizes (`ulimit -f`) fail with an error, as on a full disk,
/// instead of ending it. The programs that it runs keep the signal, which then ends them.
pub fn let_large_writes_fail() {
    sys::ignore_file_size_signal();
}
