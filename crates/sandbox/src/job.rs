//! Jobs, which are programs to run with their limits.
//!
//! A [`Job`] is only a description; this module runs no process.

use std::{
    ffi::OsString,
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
    time::Duration,
};

use serde::{Deserialize, Serialize};

/// The rights of a program, in addition to computing and writing into its working folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Policy {
    /// A student's program: it may start threads, but no other process and no other program.
    Submission,
    /// A compiler or a build tool: it may start processes and the system's programs, within the same limits.
    Tools,
}

/// The limits of one run. All limits are always enforced.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Limits {
    /// The limit on the processor time of all threads and processes together.
    pub cpu: Duration,
    /// The limit on the wall time from the start to the end.
    pub wall: Duration,
    /// The limit on the total resident memory of all processes, in bytes. Files of the working folder do not count
    /// unless they are mapped, even if the folder is in memory. The stack of the main thread is always limited to 8
    /// MiB.
    pub memory: u64,
    /// The number of bytes that are kept of standard output, and of standard error. The rest is read and dropped.
    pub output_bytes: u64,
    /// The maximum length of the trace ([`Job::trace`]) in bytes.
    pub trace_bytes: u64,
    /// The limit on the bytes on disk in the working folder, including those that are there at the start. Blocks in use
    /// are counted, so holes do not count. A job with a trace may use [`Limits::trace_bytes`] in addition.
    pub folder_bytes: u64,
    /// The limit on the number of files and folders in the working folder, including those that are there at the start.
    pub folder_files: u64,
    /// The maximum number of threads and processes at the same time.
    pub processes: u32,
    /// The maximum number of descriptors that one process may have open.
    pub open_files: u32,
}

impl Default for Limits {
    fn default() -> Self {
        const MIB: u64 = 1 << 20;
        Self {
            cpu: Duration::from_secs(10),
            wall: Duration::from_secs(30),
            memory: 512 * MIB,
            output_bytes: MIB,
            trace_bytes: 256 * MIB,
            folder_bytes: 256 * MIB,
            folder_files: 2000,
            processes: 64,
            open_files: 64,
        }
    }
}

/// The identity of a file. If the file is replaced or changed, its identity differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProgramIdentity([i64; 5]);

impl ProgramIdentity {
    /// Returns the identity of the regular file at the path. Links are followed. Returns `None` if there is no such
    /// file.
    pub fn from_path(path: &Path) -> Option<Self> {
        let metadata = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
        let (device, inode) = (metadata.dev().cast_signed(), metadata.ino().cast_signed());
        Some(Self([device, inode, metadata.size().cast_signed(), metadata.mtime(), metadata.mtime_nsec()]))
    }
}

/// A program that is to be run once, with its limits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    /// The path of the program.
    pub program: PathBuf,
    /// The path of the working folder.
    pub folder: PathBuf,
    pub(crate) arguments: Vec<OsString>,
    pub(crate) readable: Vec<PathBuf>,
    pub(crate) trace: Option<String>,
    pub(crate) policy: Policy,
    pub(crate) environment: Vec<(OsString, OsString)>,
    pub(crate) sanitizers: bool,
    pub(crate) identity: Option<ProgramIdentity>,
    pub(crate) has_folder_in_memory: bool,
    pub(crate) files: Vec<(String, Vec<u8>)>,
    pub(crate) limits: Limits,
}

impl Job {
    /// Creates a job that runs `program` in the existing working folder `folder`, which the program may change freely.
    ///
    /// Standard input is empty. A relative `program` is resolved from the grader's current folder, never from `PATH`.
    pub fn new(program: impl Into<PathBuf>, folder: impl Into<PathBuf>) -> Self {
        Self {
            program: program.into(),
            folder: folder.into(),
            arguments: Vec::new(),
            readable: Vec::new(),
            trace: None,
            policy: Policy::Submission,
            environment: Vec::new(),
            sanitizers: false,
            identity: None,
            has_folder_in_memory: false,
            files: Vec::new(),
            limits: Limits::default(),
        }
    }

    /// Sets the arguments of the program, without the program's own name.
    #[must_use]
    pub fn arguments<A: Into<OsString>>(mut self, arguments: impl IntoIterator<Item = A>) -> Self {
        self.arguments = arguments.into_iter().map(Into::into).collect();
        self
    }

    /// Sets the files and folders outside the working folder that the program may read, but not change or execute.
    ///
    /// If the grader is root, the program runs as another user, so the paths must be readable by all users.
    #[must_use]
    pub fn readable<P: Into<PathBuf>>(mut self, paths: impl IntoIterator<Item = P>) -> Self {
        self.readable = paths.into_iter().map(Into::into).collect();
        self
    }

    /// Declares that the program writes its trace into the file `name` in the working folder. The trace has a limit of
    /// its own. [`RemainingFolder::regular_file`](crate::RemainingFolder::regular_file) opens the trace.
    #[must_use]
    pub fn trace(mut self, name: impl Into<String>) -> Self {
        self.trace = Some(name.into());
        self
    }

    /// Lets the program work in a copy of the working folder in memory, if namespaces work and there is enough memory.
    /// The kernel then limits the copy's bytes and files. The folder itself does not change; the program's files are in
    /// the [`RemainingFolder`](crate::RemainingFolder).
    #[must_use]
    pub fn folder_in_memory(mut self) -> Self {
        self.has_folder_in_memory = true;
        self
    }

    /// Adds a file that is written into the working folder before the program starts. If the program works in a copy in
    /// memory, the file is only in the copy.
    #[must_use]
    pub fn file(mut self, name: impl Into<String>, content: impl Into<Vec<u8>>) -> Self {
        self.files.push((name.into(), content.into()));
        self
    }

    /// Sets what the program may do.
    #[must_use]
    pub fn policy(mut self, policy: Policy) -> Self {
        self.policy = policy;
        self
    }

    /// Sets environment variables for the program, in addition to the few that every program gets (`PATH`, `HOME`,
    /// `TMPDIR`, `LC_ALL`). The grader's own environment is never passed to the program.
    #[must_use]
    pub fn environment<N: Into<OsString>, V: Into<OsString>>(
        mut self,
        variables: impl IntoIterator<Item = (N, V)>,
    ) -> Self {
        self.environment = variables.into_iter().map(|(name, value)| (name.into(), value.into())).collect();
        self
    }

    /// Sets whether programs that were built with an address, thread or memory sanitizer may run. Sanitizers reserve
    /// terabytes of address space. Therefore the memory of such a program is limited only by checks of the memory in
    /// use, which come a little late.
    #[must_use]
    pub fn sanitizers(mut self, allowed: bool) -> Self {
        self.sanitizers = allowed;
        self
    }

    /// Declares that the program is a copy that the grader made, with this identity. If the file is then missing or
    /// different at the start, the grader is at fault, and not the program.
    #[must_use]
    pub fn with_identity(mut self, identity: Option<ProgramIdentity>) -> Self {
        self.identity = identity;
        self
    }

    /// Sets the limits of the run.
    #[must_use]
    pub fn limits(mut self, limits: Limits) -> Self {
        self.limits = limits;
        self
    }
}
