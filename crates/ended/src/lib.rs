//! The result of a program's run. The sandbox creates results, grades store them, and reports describe them.
//!
//! ```
//! use fosssim_ended::RunEnd;
//!
//! let ended = RunEnd::TraceLimit;
//! assert_eq!(ended.to_string(), "wrote more than allowed to the trace");
//! assert_eq!(ended.kind(), "output");
//! ```
#![forbid(unsafe_code)]

use serde::{Deserialize, Serialize};
use std::{borrow::Cow, fmt};

/// The result of a run: how the program ended, or, if the sandbox stopped it, which limit it exceeded. Except for
/// [`RunEnd::Exited`] and [`RunEnd::Signaled`], each is a decision of the sandbox.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum RunEnd {
    /// The program exited by itself with this exit code.
    Exited(i32),
    /// A signal with this number ended the program. The program itself was the cause, as in a crash or an abort.
    #[serde(rename = "Signalled")]
    Signaled(i32),
    /// The program used up its processor time.
    CpuLimit,
    /// The program used up its wall time.
    WallLimit,
    /// The program used more memory than allowed, or ended because it did not get more memory.
    MemoryLimit,
    /// The trace that the program wrote is longer than allowed.
    TraceLimit,
    /// The program had more threads and processes than allowed.
    ProcessLimit,
    /// The program wrote more bytes or files into its working folder than allowed.
    FolderLimit,
    /// The program used a system call that no submission needs.
    Violation {
        /// The usual name of the call, such as `ptrace`, or a description if it has no name.
        call: String,
    },
    /// The program could not be started.
    CouldNotStart(StartProblem),
    /// The grader stopped the program.
    #[serde(rename = "Cancelled")]
    Canceled,
}

impl RunEnd {
    /// Returns a name for this kind of result, which never changes. Examples are `exited`, `cpu` and `violation`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Exited(_) => "exited",
            Self::Signaled(_) => "signalled",
            Self::CpuLimit => "cpu",
            Self::WallLimit => "wall",
            Self::MemoryLimit => "memory",
            Self::TraceLimit => "output",
            Self::ProcessLimit => "processes",
            Self::FolderLimit => "folder",
            Self::Violation { .. } => "violation",
            Self::CouldNotStart(_) => "could-not-start",
            Self::Canceled => "cancelled",
        }
    }
}

impl fmt::Display for RunEnd {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exited(code) => write!(formatter, "exited with code {code}"),
            Self::Signaled(signal) => write!(formatter, "was killed by signal {signal} ({})", signal_name(*signal)),
            Self::CpuLimit => formatter.write_str("used up its processor time"),
            Self::WallLimit => formatter.write_str("used up its wall time"),
            Self::MemoryLimit => formatter.write_str("needed more memory than allowed"),
            Self::TraceLimit => formatter.write_str("wrote more than allowed to the trace"),
            Self::ProcessLimit => formatter.write_str("had more threads and processes than allowed"),
            Self::FolderLimit => formatter.write_str("put more into its working folder than allowed"),
            Self::Violation { call } => write!(formatter, "used a forbidden system call: {call}"),
            Self::CouldNotStart(own @ StartProblem::GradersOwn) => write!(formatter, "was not started: {own}"),
            Self::CouldNotStart(problem) => write!(formatter, "could not start: {problem}"),
            Self::Canceled => formatter.write_str("was stopped by the grader"),
        }
    }
}

/// Returns the usual name and the meaning of a signal that ends programs. `signal` is its number on Linux.
pub fn signal_name(signal: i32) -> &'static str {
    match signal {
        11 => "SIGSEGV: it accessed memory that does not belong to it",
        6 => "SIGABRT: it aborted, by a failed assertion or an uncaught exception",
        8 => "SIGFPE: an integer division by zero",
        4 => "SIGILL: an instruction that this processor does not have",
        7 => "SIGBUS: it accessed memory that does not exist",
        13 => "SIGPIPE: it wrote to a pipe without a reader",
        5 => "SIGTRAP: a breakpoint",
        15 => "SIGTERM: it ended itself",
        9 => "SIGKILL: killed by itself or by the system",
        24 => "SIGXCPU: processor time",
        25 => "SIGXFSZ: file size",
        31 => "SIGSYS: a forbidden system call",
        1 => "SIGHUP",
        2 => "SIGINT",
        14 => "SIGALRM: a timer of its own",
        _ => "unnamed",
    }
}

/// The reason why a program could not be started. The text describes what is wrong and what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum StartProblem {
    /// The file does not exist.
    #[error("the program does not exist; check the path and build the program first")]
    NotFound,
    /// The path leads to a folder.
    #[error("this is a folder, not a program; give the path of the program inside it")]
    IsFolder,
    /// The path leads to something that is neither a file nor a folder.
    #[error("this is not a regular file")]
    NotAFile,
    /// The file may not be executed, according to its permissions.
    #[error("the file is not executable; if it is the program, run chmod +x on it")]
    NotExecutable,
    /// The user of the run may not access the file.
    #[error("permission denied; put the program where every user may read and execute it")]
    NotPermitted,
    /// The file is neither an ELF program nor a script.
    #[error("the file is not a program: neither ELF nor a script that begins with #!; give the linker's output")]
    NotAProgram,
    /// The file is an ELF file, but not a program. It may be an object file or a core dump.
    #[error("the file is {what}, not a linked program; give the linker's output")]
    NotLinked {
        /// The kind of the file, in words.
        what: Cow<'static, str>,
    },
    /// The file is a 32-bit program.
    #[error("this is a 32-bit program; build it for 64 bits (without -m32)")]
    ThirtyTwoBit,
    /// The file is a program for a different processor.
    #[error("this program was built for {machine}, but this machine is {here}; build it on the grading platform")]
    WrongMachine {
        /// The processor for which it was built.
        machine: String,
        /// The processor of this machine.
        here: Cow<'static, str>,
    },
    /// The file is a program for a different operating system.
    #[error("this program was built for {system}, but Linux is needed; build it on the grading platform")]
    WrongSystem {
        /// The operating system for which it was built.
        system: Cow<'static, str>,
    },
    /// The program requires a dynamic loader that this system does not have.
    #[error("the program needs a dynamic loader that is not on this machine; build it on the grading platform")]
    MissingLoader {},
    /// The program requires a shared library that is missing.
    #[error("the shared library {library} is missing; install it, or link it statically")]
    MissingLibrary {
        /// The file name of the library, as the loader prints it.
        library: String,
    },
    /// The file is a script, but its `#!` line names no interpreter.
    #[error("the script's first line names no interpreter; it must look like #!/bin/sh")]
    NoInterpreter,
    /// The file is a script, but its interpreter is missing.
    #[error("the script's interpreter {interpreter} is not on this machine{hint}")]
    MissingInterpreter {
        /// The path of the interpreter.
        interpreter: String,
        /// Advice about what to do, or an empty text.
        hint: Cow<'static, str>,
    },
    /// The interpreter of the script is not part of the system.
    #[error(
        "its interpreter {path} is not part of the system; \
         begin a script with #!/usr/bin/env NAME or #!/bin/sh"
    )]
    NotTheSystems {
        /// The path of the interpreter that the script names.
        path: String,
    },
    /// The program was built with a sanitizer, which is not allowed in this run.
    #[error(
        "the program was built with a sanitizer (-fsanitize), for which memory can't be limited; build it without, \
         or allow it in the suite"
    )]
    Sanitized,
    /// The file is the grader's own program.
    #[error("this is the grader's own program, not a submission; submit the program that you wrote")]
    GradersOwn,
    /// Another process has the file open for writing.
    #[error("the file is still being written (text file busy); wait for the build or the copy to end")]
    Busy,
    /// The program tried to open a window, which is not possible.
    #[error("the program needs a display; run it without one: pass -d 0")]
    NeedsDisplay,
    /// The kernel rejected the program for some other reason.
    #[error("the system refused to execute it: {0}")]
    Refused(String),
}
