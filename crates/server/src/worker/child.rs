//! A child process that never outlives its owner. The child leads a process group, which is killed as a whole. If this
//! process ends for any reason, the kernel kills the child. A [`guard`](super::guard) process is between the two.
use super::guard;
use std::{
    io,
    os::unix::process::{CommandExt, ExitStatusExt},
    process::{Command, Stdio},
    sync::{Arc, Mutex, PoisonError},
};
use tokio::sync::watch;

/// The end of a child process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The process exited with this code.
    Code(i32),
    /// The signal with this number ended the process.
    Signal(i32),
}

/// A running child process. It is killed when this value is dropped.
#[derive(Debug)]
pub(super) struct Child {
    /// The ID of the process group, while it may be used. No other process can get this ID before the leader is
    /// reaped.
    group: Arc<Mutex<Option<libc::pid_t>>>,
    end: watch::Receiver<Option<End>>,
}

/// Limits a command's memory in bytes and its processor time in seconds, and makes the kernel kill it when this process
/// ends.
pub(crate) fn set_limits(command: &mut Command, memory: u64, seconds: u64) {
    // SAFETY: only calls that are allowed between fork and exec are made here.
    unsafe {
        command.pre_exec(move || {
            libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL);
            for (resource, limit) in [(libc::RLIMIT_AS, memory), (libc::RLIMIT_CPU, seconds), (libc::RLIMIT_CORE, 0)] {
                let limit = libc::rlimit { rlim_cur: limit, rlim_max: limit };
                libc::setrlimit(resource, &raw const limit);
            }
            Ok(())
        });
    }
}

impl Child {
    /// Starts a child without input.
    ///
    /// # Errors
    /// Fails if the child can't be started.
    pub(super) fn start(mut command: Command) -> io::Result<Self> {
        command.stdin(Stdio::null()).stdout(Stdio::null()).process_group(0);
        let parent = std::process::id();
        // SAFETY: only functions that are allowed between fork and exec are called here.
        unsafe {
            command.pre_exec(move || {
                libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL);
                // If the parent ended before the kernel was instructed to kill this process, this process must end by
                // itself.
                if libc::getppid().unsigned_abs() != parent {
                    return Err(io::Error::from_raw_os_error(libc::ESRCH));
                }
                guard::run_guard()
            });
        }
        let (started_sender, started) = std::sync::mpsc::channel();
        let (end_sender, end) = watch::channel(None);
        let group = Arc::new(Mutex::new(None));
        let shared_group = group.clone();
        // For the kernel, the parent is the thread that forked. Therefore that thread must outlive the child, and it
        // waits for it.
        std::thread::Builder::new().name("grader".to_owned()).spawn(move || {
            let mut child = match command.spawn() {
                Ok(child) => child,
                Err(error) => return drop(started_sender.send(Err(error))),
            };
            let process_id = child.id().cast_signed();
            *shared_group.lock().unwrap_or_else(PoisonError::into_inner) = Some(process_id);
            drop(started_sender.send(Ok(())));
            wait_without_reaping(process_id);
            let mut group_id = shared_group.lock().unwrap_or_else(PoisonError::into_inner);
            *group_id = None;
            // SAFETY: the leader is not reaped yet, so the ID still belongs to the group.
            unsafe { libc::kill(-process_id, libc::SIGKILL) };
            let end = match child.wait() {
                Ok(status) => match (status.code(), status.signal()) {
                    (Some(code), _) => End::Code(code),
                    (None, signal) => End::Signal(signal.unwrap_or(0)),
                },
                Err(_) => End::Signal(0),
            };
            end_sender.send_replace(Some(end));
        })?;
        started.recv().map_err(io::Error::other)??;
        Ok(Self { group, end })
    }

    /// Waits until the child has ended, and returns how it ended.
    pub(super) async fn wait(&self) -> End {
        let mut end = self.end.clone();
        match end.wait_for(Option::is_some).await {
            Ok(end) => (*end).unwrap_or(End::Signal(0)),
            // The thread that waits for the child has ended without an answer.
            Err(_) => End::Signal(0),
        }
    }

    /// Requests the child to stop, with a signal.
    pub(super) fn interrupt(&self) {
        self.signal(libc::SIGTERM, false);
    }

    /// Kills the child and its process group.
    pub(super) fn kill(&self) {
        self.signal(libc::SIGKILL, true);
    }

    fn signal(&self, signal: i32, whole_group: bool) {
        if let Some(process_id) = *self.group.lock().unwrap_or_else(PoisonError::into_inner) {
            // SAFETY: the leader is not reaped as long as the ID is known.
            unsafe { libc::kill(if whole_group { -process_id } else { process_id }, signal) };
        }
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Waits until a child has ended, but keeps its ID in use. If the child was stopped, it is continued, because the
/// wait might never end otherwise.
fn wait_without_reaping(number: libc::pid_t) {
    let wait = |options| {
        // SAFETY: a zeroed siginfo_t is valid, and the call writes it only.
        unsafe {
            let mut info: libc::siginfo_t = std::mem::zeroed();
            let result = libc::waitid(libc::P_PID, number.unsigned_abs(), &raw mut info, options);
            (result, info.si_code)
        }
    };
    loop {
        match wait(libc::WEXITED | libc::WSTOPPED | libc::WNOWAIT) {
            (0, libc::CLD_STOPPED) => {
                // This consumes the event that the child was stopped, so that the next wait does not return it again.
                wait(libc::WSTOPPED | libc::WNOHANG);
                // SAFETY: the child is not reaped yet, so the ID still belongs to it.
                unsafe { libc::kill(number, libc::SIGCONT) };
            }
            (0, _) => return,
            _ if io::Error::last_os_error().raw_os_error() != Some(libc::EINTR) => return,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[tokio::test]
    async fn ends_are_told() {
        let end = async |script| Child::start(shell(script)).expect("a child").wait().await;
        assert_eq!(end("exit 3").await, End::Code(3));
        assert_eq!(end("kill -SEGV $$").await, End::Signal(libc::SIGSEGV));
        assert!(Child::start(Command::new("/nowhere/fosssim-oracle")).is_err());
    }

    #[tokio::test]
    async fn a_grader_reaches_its_guard_and_not_its_worker() {
        let end = async |script| Child::start(shell(script)).expect("a child").wait().await;
        assert_eq!(end("kill -KILL $PPID; sleep 1000").await, End::Signal(libc::SIGKILL));
        assert_eq!(end("kill -STOP $PPID; exit 4").await, End::Code(4), "a guard that was stopped goes on");
        let child = Child::start(shell("trap 'exit 7' TERM; kill -USR1 $PPID; while :; do sleep 0.01; done"));
        let child = child.expect("a child");
        // The trap may not be set yet; then the shell ends by the signal.
        child.interrupt();
        assert!(matches!(child.wait().await, End::Code(7) | End::Signal(libc::SIGTERM | libc::SIGUSR1)));
    }

    #[tokio::test]
    async fn the_whole_group_dies() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("pid");
        let script = format!("sleep 1000 & echo $! > {0}.new; mv {0}.new {0}; wait", file.display());
        let child = Child::start(shell(&script)).expect("a child");
        while !file.exists() {
            tokio::task::yield_now().await;
        }
        let grandchild: i32 = std::fs::read_to_string(&file).expect("a file").trim().parse().expect("a number");
        child.kill();
        assert_eq!(child.wait().await, End::Signal(libc::SIGKILL));
        // It has ended, or is a zombie that waits for init; it does not run. Dying takes a moment.
        let start = std::time::Instant::now();
        loop {
            let state = std::fs::read_to_string(format!("/proc/{grandchild}/stat")).unwrap_or_default();
            if state.is_empty() || state.contains(") Z ") || state.contains(") X ") {
                break;
            }
            assert!(start.elapsed().as_secs() < 60, "it lives on: {state}");
            tokio::task::yield_now().await;
        }
    }
}
