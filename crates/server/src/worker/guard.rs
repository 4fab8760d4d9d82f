//! The guard, a process between a worker and its grader. It only waits. If a grader kills or stops its parent, that
//! affects only the guard, not the worker with its other jobs.
use std::{
    io,
    sync::atomic::{AtomicI32, Ordering},
};

/// The grader's process ID, for the guard's signal handler.
static GRADER_PID: AtomicI32 = AtomicI32::new(0);

/// Forks. In the child, this function returns, and the child becomes the grader. This process becomes the grader's
/// guard, and ends in the same way as the grader.
///
/// # Safety
///
/// Call this only between fork and exec, in a child that leads a process group.
///
/// # Errors
///
/// Fails if no other process can be created.
pub(super) unsafe fn run_guard() -> io::Result<()> {
    // SAFETY: these calls are allowed between fork and exec, and the only memory of this process that they use is the
    // constant text.
    unsafe {
        // If memory runs short, the grader is killed before the worker.
        let file = libc::open(c"/proc/self/oom_score_adj".as_ptr(), libc::O_WRONLY | libc::O_CLOEXEC);
        if file >= 0 {
            libc::write(file, c"800".as_ptr().cast(), 3);
            libc::close(file);
        }
        let guard = libc::getpid();
        let mut ready = [0; 2];
        if libc::pipe2(ready.as_mut_ptr(), libc::O_CLOEXEC) != 0 {
            return Err(io::Error::last_os_error());
        }
        match libc::fork() {
            -1 => Err(io::Error::last_os_error()),
            0 => {
                libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL);
                // If the guard ended before the kernel was instructed to kill this process, this process must end by
                // itself.
                if libc::getppid() != guard {
                    return Err(io::Error::from_raw_os_error(libc::ESRCH));
                }
                // Wait until the guard has closed its copies of open files, so that other processes are not held up
                // when the guard ends.
                libc::close(ready[1]);
                libc::read(ready[0], ready.as_mut_ptr().cast(), 1);
                libc::close(ready[0]);
                Ok(())
            }
            grader => wait_for_grader(grader),
        }
    }
}

/// Passes a signal on to the grader.
extern "C" fn forward_signal(signal: libc::c_int) {
    // SAFETY: kill may be called in a signal handler, and the grader is not reaped before the guard ends.
    unsafe { libc::kill(GRADER_PID.load(Ordering::Relaxed), signal) };
}

/// Waits for the grader, and then ends in the same way as the grader.
unsafe fn wait_for_grader(grader: libc::pid_t) -> ! {
    GRADER_PID.store(grader, Ordering::Relaxed);
    // SAFETY: these system calls use only numbers, and structures that were filled with zeros.
    unsafe {
        // The worker's signal handlers would write to files that are closed here. The worker notices that the grader
        // has started when one of these files is closed in all other processes.
        for signal in [libc::SIGINT, libc::SIGHUP, libc::SIGQUIT, libc::SIGCHLD, libc::SIGUSR1, libc::SIGUSR2] {
            libc::signal(signal, libc::SIG_DFL);
        }
        let mut action: libc::sigaction = std::mem::zeroed();
        action.sa_sigaction = forward_signal as extern "C" fn(libc::c_int) as libc::sighandler_t;
        libc::sigaction(libc::SIGTERM, &raw const action, std::ptr::null_mut());
        if libc::syscall(libc::SYS_close_range, 0, libc::c_uint::MAX, 0) != 0 {
            // Kernels before 5.9 do not have this call.
            for file in 0..65_536 {
                libc::close(file);
            }
        }
        let mut status = 0;
        while libc::waitpid(grader, &raw mut status, 0) != grader {
            if *libc::__errno_location() != libc::EINTR {
                libc::_exit(127);
            }
        }
        if libc::WIFSIGNALED(status) {
            let no_core = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
            libc::setrlimit(libc::RLIMIT_CORE, &raw const no_core);
            libc::signal(libc::WTERMSIG(status), libc::SIG_DFL);
            libc::kill(libc::getpid(), libc::WTERMSIG(status));
        }
        libc::_exit(libc::WEXITSTATUS(status))
    }
}
