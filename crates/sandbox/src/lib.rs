//! Runs one program under limits and reports how it ended.
//!
//! This crate knows nothing about scenes, traces or verdicts. Its inputs and outputs are bytes, and a [`RunOutcome`]
//! contains what the kernel reports. A [`Job`] describes a run, a [`Backend`] starts it, and a [`RunningProgram`] is a
//! program that was started.
//!
//! The grader starts its own binary again with a hidden first argument ([`supervisor_main`]). The new, single-threaded
//! process is the *supervisor*. It becomes the reaper of all its descendants, forks, restricts the child (new session,
//! other user when it is root, resource limits, no new privileges, Landlock, seccomp) and executes the program. It
//! watches clocks, memory, output and the working folder, kills the whole process tree, and reports only when every
//! process has ended. The kernel kills the child when the supervisor ends for any reason, and the supervisor ends when
//! the grader ends.
//!
//! If the kernel allows it, the supervisor first moves into new namespaces that contain only the run's processes and
//! files and no network. If the first process in them ends, all others are killed as well. Namespaces are an additional
//! layer; all other layers work without them. With namespaces, the runs of one submission share a *keeper*, which is
//! prepared once and forks a supervisor into new namespaces for each run. After a run that was stopped, crashed or left
//! something behind, its keeper serves no other run.
//!
//! The sandbox never trusts a path that the program could change, never reads a result while the program runs, and
//! never continues silently if a required layer is missing ([`Backend::with_all_layers`] fails).
//!
//! ```no_run
//! use fosssim_sandbox::{Backend, Job, Supervisor};
//!
//! let backend = Backend::with_all_layers(Supervisor::this_program())?;
//! let running = backend.start(&Job::new("./FOSSSim", "/tmp/work"))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod backend;
pub mod collect;
mod fake;
mod host_check;
mod job;
mod job_files;
mod keepers;
mod layers;
mod machine;
mod memory_budget;
mod mounts;
mod outcome;
mod own_files;
mod program;
mod run_end;
mod running_program;
mod sandbox_error;
pub mod selftest;
mod supervisor;
mod sys;
mod wire;

pub use backend::{Backend, Supervisor};
pub use fake::FakeRun;
pub use host_check::check_host;
pub use job::{Job, Limits, Policy, ProgramIdentity};
pub use layers::{Layer, LayerReport};
pub use outcome::{CapturedOutput, RunEnd, RunOutcome, StartProblem};
pub use own_files::{MARK_BACKWARDS, is_own_file};
pub use running_program::{Canceler, RemainingFolder, RunningProgram};
pub use sandbox_error::SandboxError;
pub use supervisor::supervisor_main;
#[doc(hidden)]
pub use wire::read_messages;

/// The processes whose processor time is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProcessorTimeScope {
    /// The thread that makes the call.
    Thread,
    /// The process that makes the call.
    Process,
    /// The processes of all finished runs, and the supervisors of these runs.
    Children,
}

/// Returns the processor time of these processes, in user mode and in the kernel together.
pub fn processor_time(scope: ProcessorTimeScope) -> std::time::Duration {
    match scope {
        ProcessorTimeScope::Thread => sys::processor_time(true),
        ProcessorTimeScope::Process => sys::processor_time(false),
        ProcessorTimeScope::Children => sys::children_usage().map_or(std::time::Duration::ZERO, |(time, _)| time),
    }
}

/// Makes writes of this process beyond its file size limit (`ulimit -f`) fail with an error, as on a full disk.
/// Otherwise such a write would kill the process. The programs that it runs keep the signal, which kills them.
pub fn let_large_writes_fail() {
    sys::ignore_file_size_signal();
}
