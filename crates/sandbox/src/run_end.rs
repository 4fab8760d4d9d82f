//! Decides how a run ended, from the supervisor's report.
//!
//! The reports of the kernel come first: why the supervisor killed the program, the wait status, and the counters. The
//! program's output is used only to explain a failure, such as why the program did not start, or whether it ran out of
//! memory. A program gains nothing by forging its output, because it would only replace one failure by another.

use super::{
    outcome::{RunEnd, StartProblem},
    wire::{Report, RunOrder},
};

/// The exit code of the dynamic loader if a library is missing.
const LOADER_FAILURE_CODE: i32 = 127;

/// Returns how the run of `order` ended, according to the supervisor's report and the program's standard error.
pub(super) fn decide_end(order: &RunOrder, report: &Report, stderr: &[u8]) -> RunEnd {
    if report.exec_errno == Some(libc::ENOMEM) {
        return RunEnd::MemoryLimit;
    }
    if let Some(errno) = report.exec_errno {
        return RunEnd::CouldNotStart(start_problem(errno));
    }
    match &report.cause {
        Some(RunEnd::Canceled) => return RunEnd::Canceled,
        _ if report.exceeds_trace_limit => return RunEnd::TraceLimit,
        Some(cause) => return cause.clone(),
        None => {}
    }
    let signal = libc::WIFSIGNALED(report.status).then(|| libc::WTERMSIG(report.status));
    match signal {
        Some(libc::SIGXCPU) => return RunEnd::CpuLimit,
        Some(libc::SIGXFSZ) => return RunEnd::FolderLimit,
        Some(libc::SIGSYS) => return RunEnd::Violation { call: "a call of another architecture (32 bits)".into() },
        _ => {}
    }
    // A short run can exceed a limit and end before the supervisor checks again.
    if report.peak_memory > order.limits.memory {
        return RunEnd::MemoryLimit;
    }
    if report.cpu > order.limits.cpu {
        return RunEnd::CpuLimit;
    }
    if report.exceeds_folder_limit {
        return RunEnd::FolderLimit;
    }
    let text = String::from_utf8_lossy(stderr);
    if report.status != 0 && !order.sanitizers && lacks_shadow_memory(&text) {
        return RunEnd::CouldNotStart(StartProblem::Sanitized);
    }
    if let Some(signal) = signal {
        let refused = signal == libc::SIGABRT && lacks_memory(&text);
        return if refused { RunEnd::MemoryLimit } else { RunEnd::Signaled(signal) };
    }
    let code = libc::WEXITSTATUS(report.status);
    if code != 0 && lacks_memory(&text) {
        return RunEnd::MemoryLimit;
    }
    if code == LOADER_FAILURE_CODE
        && let Some(library) = missing_library(&text)
    {
        return RunEnd::CouldNotStart(StartProblem::MissingLibrary { library });
    }
    if code != 0 && lacks_display(&text) {
        return RunEnd::CouldNotStart(StartProblem::NeedsDisplay);
    }
    RunEnd::Exited(code)
}

/// Returns the reason why the kernel does not execute a file that exists and is executable.
fn start_problem(errno: i32) -> StartProblem {
    match errno {
        libc::ENOENT | libc::EACCES | libc::EPERM => StartProblem::MissingLoader {},
        libc::ETXTBSY => StartProblem::Busy,
        libc::ENOEXEC => StartProblem::NotAProgram,
        _ => StartProblem::Refused(std::io::Error::from_raw_os_error(errno).to_string()),
    }
}

/// Returns the library that the loader of glibc or musl reports as missing. A program could print the same text itself,
/// but would only change a name in a message.
fn missing_library(stderr: &str) -> Option<String> {
    const MAX_NAME_BYTES: usize = 100;
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._+-".contains(c);
    let (_, after) = stderr
        .split_once("error while loading shared libraries: ")
        .or_else(|| stderr.split_once("Error loading shared library "))?;
    let name = after.split([':', '\n']).next()?.trim();
    (name.len() <= MAX_NAME_BYTES && name.contains(".so") && name.chars().all(is_plain)).then(|| name.to_owned())
}

/// Returns whether the runtime of a sanitizer reports that it did not get the terabytes of address space that it needs.
fn lacks_shadow_memory(stderr: &str) -> bool {
    const MESSAGES: [&str; 3] = [
        "ReserveShadowMemoryRange failed",
        "Sanitizer: CHECK failed: sanitizer_allocator",
        "Sanitizer: unexpected memory mapping",
    ];
    MESSAGES.iter().any(|complaint| stderr.contains(complaint))
}

/// Returns whether the output ends with a runtime's message about a request for memory that was denied. If a single
/// request exceeds the address space limit, it fails before the memory is used, so no counter shows it.
fn lacks_memory(stderr: &str) -> bool {
    // These are messages of C++, Rust, Python, Java, Node and the sanitizers.
    const MESSAGES: [&str; 6] = [
        "what():  std::bad_alloc",
        "memory allocation of ",
        "MemoryError",
        "java.lang.OutOfMemoryError",
        "JavaScript heap out of memory",
        "AddressSanitizer: out of memory",
    ];
    const LAST_LINES: usize = 4;
    let last = stderr.lines().rev().filter(|line| !line.trim().is_empty()).take(LAST_LINES);
    { last }.any(|line| MESSAGES.iter().any(|complaint| line.contains(complaint)))
}

fn lacks_display(stderr: &str) -> bool {
    let text = stderr.to_lowercase();
    ["cannot open display", "failed to open display", "can't open display", "could not open display"]
        .iter()
        .any(|complaint| text.contains(complaint))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::Limits;
    use std::time::Duration;

    fn order() -> RunOrder {
        let limits = Limits { cpu: Duration::from_secs(1), memory: 1000, ..Limits::default() };
        RunOrder { limits, ..RunOrder::default() }
    }

    fn exit(code: i32) -> Report {
        Report { status: code << 8, ..Report::default() }
    }

    #[test]
    fn the_reason_to_kill_outranks_the_kill() {
        let report = Report { status: libc::SIGKILL, cause: Some(RunEnd::WallLimit), ..Report::default() };
        assert_eq!(decide_end(&order(), &report, b""), RunEnd::WallLimit);
        assert_eq!(decide_end(&order(), &Report { cause: None, ..report }, b""), RunEnd::Signaled(libc::SIGKILL));
    }

    #[test]
    fn a_trace_beyond_its_limit_outranks_all_but_a_cancellation() {
        for cause in [None, Some(RunEnd::FolderLimit), Some(RunEnd::WallLimit)] {
            let report = Report { cause, exceeds_trace_limit: true, status: libc::SIGXFSZ, ..Report::default() };
            assert_eq!(decide_end(&order(), &report, b""), RunEnd::TraceLimit);
        }
        let report = Report { cause: Some(RunEnd::Canceled), exceeds_trace_limit: true, ..Report::default() };
        assert_eq!(decide_end(&order(), &report, b""), RunEnd::Canceled);
    }

    #[test]
    fn signals_of_limits_are_limits() {
        for (signal, expected) in [
            (libc::SIGXCPU, RunEnd::CpuLimit),
            (libc::SIGXFSZ, RunEnd::FolderLimit),
            (libc::SIGSEGV, RunEnd::Signaled(libc::SIGSEGV)),
        ] {
            assert_eq!(decide_end(&order(), &Report { status: signal, ..Report::default() }, b""), expected);
        }
    }

    #[test]
    fn a_limit_passed_between_two_looks_is_still_passed() {
        assert_eq!(decide_end(&order(), &Report { peak_memory: 1001, ..exit(0) }, b""), RunEnd::MemoryLimit);
        assert_eq!(
            decide_end(&order(), &Report { cpu: Duration::from_micros(1_000_001), ..exit(0) }, b""),
            RunEnd::CpuLimit
        );
        assert_eq!(decide_end(&order(), &Report { exceeds_folder_limit: true, ..exit(0) }, b""), RunEnd::FolderLimit);
        assert_eq!(decide_end(&order(), &exit(0), b""), RunEnd::Exited(0));
    }

    #[test]
    fn loaders_and_displays_explain_a_failure_and_never_a_success() {
        let loader = b"./FOSSSim: error while loading shared libraries: libglut.so.3: cannot open shared object file";
        let missing = RunEnd::CouldNotStart(StartProblem::MissingLibrary { library: "libglut.so.3".into() });
        assert_eq!(decide_end(&order(), &exit(127), loader), missing);
        assert_eq!(decide_end(&order(), &exit(1), loader), RunEnd::Exited(1));
        let forged = b"error while loading shared libraries: what the hidden scene holds: x";
        assert_eq!(decide_end(&order(), &exit(127), forged), RunEnd::Exited(127), "a sentence is no name");
        let display = b"freeglut (./FOSSSim): failed to open display ''";
        assert_eq!(decide_end(&order(), &exit(1), display), RunEnd::CouldNotStart(StartProblem::NeedsDisplay));
        assert_eq!(decide_end(&order(), &exit(0), display), RunEnd::Exited(0));
    }

    #[test]
    fn a_program_that_runs_out_of_memory_has_met_the_memory_limit() {
        let aborted = Report { status: libc::SIGABRT, ..Report::default() };
        let words = b"terminate called after throwing an instance of 'std::bad_alloc'\n  what():  std::bad_alloc\n";
        assert_eq!(decide_end(&order(), &aborted, words), RunEnd::MemoryLimit);
        assert_eq!(
            decide_end(&order(), &aborted, b"a.cpp:3: Assertion `x' failed.\n"),
            RunEnd::Signaled(libc::SIGABRT)
        );
        assert_eq!(
            decide_end(&order(), &exit(1), b"Traceback\n  x = [0] * 10**12\nMemoryError\n"),
            RunEnd::MemoryLimit
        );
        assert_eq!(decide_end(&order(), &exit(0), b"MemoryError\n"), RunEnd::Exited(0));
        let long_ago = [&words[..], b"caught it\n1\n2\n3\n"].concat();
        assert_eq!(decide_end(&order(), &aborted, &long_ago), RunEnd::Signaled(libc::SIGABRT));
        let crashed = Report { status: libc::SIGSEGV, ..Report::default() };
        assert_eq!(decide_end(&order(), &crashed, words), RunEnd::Signaled(libc::SIGSEGV));
    }

    #[test]
    fn a_refusal_of_the_kernel_is_translated() {
        let refused = |errno| decide_end(&order(), &Report { exec_errno: Some(errno), ..Report::default() }, b"");
        assert_eq!(refused(libc::ETXTBSY), RunEnd::CouldNotStart(StartProblem::Busy));
        assert_eq!(refused(libc::ENOEXEC), RunEnd::CouldNotStart(StartProblem::NotAProgram));
        assert_eq!(refused(libc::ENOENT), RunEnd::CouldNotStart(StartProblem::MissingLoader {}));
    }
}
