//! The system calls that the standard library does not offer, each behind a safe function.
//!
//! This file and `mounts.rs` are the sandbox's only ones with `unsafe` code. Every function passes the kernel valid
//! pointers to live values and turns its answer into a `Result`; none keeps a pointer. The one call with a condition of
//! its own, [`fork`], checks that condition.

#![expect(unsafe_code, reason = "fork, seccomp, prctl and their kin have no safe wrapper among the dependencies")]

use std::ffi::{CStr, CString};
use std::io;
use std::os::fd::{AsRawFd, BorrowedFd, FromRawFd, OwnedFd, RawFd};
use std::os::unix::net::UnixStream;
use std::time::Duration;

use seccompiler::sock_filter;

/// Turns the kernel's -1 into the error it left behind.
pub(super) fn check(answer: i64) -> io::Result<i64> {
    if answer < 0 { Err(io::Error::last_os_error()) } else { Ok(answer) }
}

/// The same where the answer says no more than that.
pub(super) fn done(answer: i32) -> io::Result<()> {
    check(i64::from(answer)).map(drop)
}

/// The two sides of a fork.
pub(super) enum Fork {
    /// We are the child.
    Child,
    /// We are the parent; the child's process id.
    Parent(i32),
}

/// The proof that this process, or the one that it was forked from, has one thread, and starts none: the copy of its
/// memory that a child gets is consistent.
pub(super) struct SingleThread(());

/// # Errors
///
/// When the process has more than one thread: its child could find locks held for ever.
pub(super) fn single_thread() -> io::Result<SingleThread> {
    match std::fs::read_dir("/proc/self/task")?.count() {
        1 => Ok(SingleThread(())),
        _ => Err(io::Error::other("the supervisor must have one thread only")),
    }
}

/// Forks the process, which must have one thread.
pub(super) fn fork() -> io::Result<Fork> {
    fork_alone(&single_thread()?)
}

/// Forks a process that is known to have one thread.
pub(super) fn fork_alone(_: &SingleThread) -> io::Result<Fork> {
    // SAFETY: the process has one thread, so the child's copy of memory is consistent.
    match check(i64::from(unsafe { libc::fork() }))? {
        0 => Ok(Fork::Child),
        pid => Ok(Fork::Parent(pid as i32)),
    }
}

/// Ends the process at once, without running anything on the way out.
pub(super) fn exit_now(code: i32) -> ! {
    // SAFETY: takes an integer and does not return.
    unsafe { libc::_exit(code) }
}

/// The effective user.
pub(super) fn user() -> u32 {
    // SAFETY: no arguments, cannot fail.
    unsafe { libc::geteuid() }
}

/// The effective group.
pub(super) fn group() -> u32 {
    // SAFETY: no arguments, cannot fail.
    unsafe { libc::getegid() }
}

/// Starts a session of its own, without a controlling terminal.
pub(super) fn new_session() -> io::Result<()> {
    // SAFETY: no arguments.
    done(unsafe { libc::setsid() })
}

/// A `prctl` whose arguments are integers.
fn prctl(option: i32, argument: u64) -> io::Result<()> {
    let none: libc::c_ulong = 0;
    // SAFETY: only called with options that take integers; unused arguments are zero, as the kernel asks.
    done(unsafe { libc::prctl(option, argument as libc::c_ulong, none, none, none) })
}

/// Makes this process adopt the orphans among its descendants.
pub(super) fn become_reaper() -> io::Result<()> {
    prctl(libc::PR_SET_CHILD_SUBREAPER, 1)
}

/// Has the kernel kill this process when its parent dies.
pub(super) fn die_with_parent() -> io::Result<()> {
    prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL as u64)
}

/// Gives up for ever the gain of privileges by executing a program.
pub(super) fn no_new_privileges() -> io::Result<()> {
    prctl(libc::PR_SET_NO_NEW_PRIVS, 1)
}

/// Sets a limit (`RLIMIT_*`), soft and hard, never above the hard limit that is already there.
pub(super) fn limit(resource: u32, value: u64) -> io::Result<()> {
    let mut old = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: `old` outlives the call; the resource number is checked by the kernel.
    done(unsafe { libc::getrlimit(resource, &raw mut old) })?;
    let value = value.min(old.rlim_max);
    let new = libc::rlimit { rlim_cur: value, rlim_max: value };
    // SAFETY: `new` outlives the call.
    done(unsafe { libc::setrlimit(resource, &raw const new) })
}

/// Becomes another user and group for good, and leaves all supplementary groups.
pub(super) fn switch_user(id: u32) -> io::Result<()> {
    // SAFETY: an empty list needs no memory behind its pointer.
    done(unsafe { libc::setgroups(0, std::ptr::null()) })?;
    // SAFETY: integers only.
    done(unsafe { libc::setresgid(id, id, id) })?;
    // SAFETY: integers only.
    done(unsafe { libc::setresuid(id, id, id) })
}

/// Does something with the file permissions of another user, as who root may look into that user's `/proc` entries even
/// without the capability to trace. Only the supervisor's single thread does this, and it always comes back.
pub(super) fn with_files_of<T>(user: Option<u32>, action: impl FnOnce() -> T) -> T {
    let Some(user) = user else { return action() };
    // SAFETY: integers only; both answer the previous id and change nothing where it is not allowed.
    let (old_group, old_user) = unsafe { (libc::setfsgid(user), libc::setfsuid(user)) };
    let result = action();
    // SAFETY: as above.
    unsafe {
        libc::setfsuid(old_user.cast_unsigned());
        libc::setfsgid(old_group.cast_unsigned());
    }
    result
}

/// Makes `new` a copy of the descriptor `old`, which stays open across `execve`.
pub(super) fn duplicate_to(old: RawFd, new: RawFd) -> io::Result<()> {
    // SAFETY: integers only; the caller owns what lies at `new` (the standard streams of a fresh child).
    done(unsafe { libc::dup2(old, new) })
}

/// A copy of the descriptor under a number from `least` on, closed by the next `execve`.
pub(super) fn duplicate_from(fd: BorrowedFd<'_>, least: u32) -> io::Result<OwnedFd> {
    let least = i32::try_from(least).map_err(io::Error::other)?;
    // SAFETY: integers only, on an open descriptor.
    let copy = check(i64::from(unsafe { libc::fcntl(fd.as_raw_fd(), libc::F_DUPFD_CLOEXEC, least) }))?;
    // SAFETY: the kernel has just opened it for us alone.
    Ok(unsafe { OwnedFd::from_raw_fd(copy as RawFd) })
}

/// Keeps the descriptor open across `execve`.
pub(super) fn keep_on_execute(fd: BorrowedFd<'_>) -> io::Result<()> {
    // SAFETY: integers only, on an open descriptor.
    done(unsafe { libc::fcntl(fd.as_raw_fd(), libc::F_SETFD, 0) })
}

/// Has every descriptor from 3 on closed by the next `execve`.
pub(super) fn close_on_execute() -> io::Result<()> {
    // SAFETY: integers only.
    if unsafe { libc::syscall(libc::SYS_close_range, 3_u32, u32::MAX, libc::CLOSE_RANGE_CLOEXEC) } == 0 {
        return Ok(());
    }
    // Kernels before 5.11 do not know the flag: mark each one.
    for entry in std::fs::read_dir("/proc/self/fd")? {
        let Some(fd) = entry?.file_name().to_str().and_then(|name| name.parse::<RawFd>().ok()) else { continue };
        if fd > 2 {
            // SAFETY: integers only; a descriptor that has gone meanwhile is refused by the kernel.
            unsafe { libc::fcntl(fd, libc::F_SETFD, libc::FD_CLOEXEC) };
        }
    }
    Ok(())
}

/// The signals that this process ignores. Only these stay as they are when a program is executed: what has a function
/// gets the default reaction then.
pub(super) fn ignored_signals() -> Vec<i32> {
    let is_ignored = |signal: &i32| {
        // SAFETY: an all-zero action is valid and outlives the call, which only asks; numbers without a signal are
        // refused by the kernel.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            libc::sigaction(*signal, std::ptr::null(), &raw mut action) == 0 && action.sa_sigaction == libc::SIG_IGN
        }
    };
    (1..=64).filter(is_ignored).collect()
}

/// Restores the default reaction to these signals and unblocks all.
pub(super) fn default_signals(ignored: &[i32]) {
    // SAFETY: the default action needs no function; numbers without a signal are refused by the kernel. The set is
    // initialised by `sigemptyset` before it is read.
    unsafe {
        for signal in ignored {
            libc::signal(*signal, libc::SIG_DFL);
        }
        let mut none: libc::sigset_t = std::mem::zeroed();
        libc::sigemptyset(&raw mut none);
        libc::sigprocmask(libc::SIG_SETMASK, &raw const none, std::ptr::null_mut());
    }
}

/// Sets the mask of permission bits that new files do not get.
pub(super) fn file_mask(mask: u32) {
    // SAFETY: an integer; cannot fail.
    unsafe { libc::umask(mask) };
}

/// Sends a signal to one process.
pub(super) fn kill(pid: i32, signal: i32) -> io::Result<()> {
    if pid <= 1 {
        return Err(io::Error::other("only single processes are ever signalled"));
    }
    // SAFETY: integers only; the process id is positive, so that no group is meant.
    done(unsafe { libc::kill(pid, signal) })
}

/// Kills everybody in this process namespace if this process is the namespace's first, which is the answer; nothing
/// otherwise.
pub(super) fn kill_everybody_inside() -> bool {
    let is_first = std::process::id() == 1;
    if is_first {
        // SAFETY: integers only. For the first process of a namespace -1 means everybody else in it, and nobody
        // outside.
        unsafe { libc::kill(-1, libc::SIGKILL) };
    }
    is_first
}

/// A process that has ended.
pub(super) struct Reaped {
    /// Which.
    pub(super) pid: i32,
    /// Its raw wait status.
    pub(super) status: i32,
}

/// Reaps one ended child without waiting; `None` when none has ended.
///
/// # Errors
///
/// `ECHILD` when there is no child at all.
pub(super) fn reap() -> io::Result<Option<Reaped>> {
    let mut status = 0;
    // SAFETY: `status` outlives the call.
    let pid = check(i64::from(unsafe { libc::waitpid(-1, &raw mut status, libc::WNOHANG) }))? as i32;
    Ok((pid != 0).then_some(Reaped { pid, status }))
}

/// Waits until the child has ended; the answer is its exit code, or 128 and the signal that ended it.
pub(super) fn wait_for(pid: i32) -> io::Result<u8> {
    let mut status = 0;
    loop {
        // SAFETY: `status` outlives the call.
        match check(i64::from(unsafe { libc::waitpid(pid, &raw mut status, 0) })) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
            Ok(_) if libc::WIFSIGNALED(status) => return Ok(128 + libc::WTERMSIG(status) as u8),
            Ok(_) => return Ok(libc::WEXITSTATUS(status) as u8),
        }
    }
}

/// Processor time and the largest resident set (bytes) of all reaped children and theirs.
pub(super) fn children_usage() -> io::Result<(Duration, u64)> {
    // SAFETY: an all-zero `rusage` is a valid value; the kernel fills it.
    let usage = unsafe {
        let mut usage: libc::rusage = std::mem::zeroed();
        done(libc::getrusage(libc::RUSAGE_CHILDREN, &raw mut usage))?;
        usage
    };
    let time = |value: libc::timeval| {
        Duration::from_secs(value.tv_sec.unsigned_abs()) + Duration::from_micros(value.tv_usec.unsigned_abs())
    };
    Ok((time(usage.ru_utime) + time(usage.ru_stime), usage.ru_maxrss.unsigned_abs() * 1024))
}

/// The result of [`poll`] for a descriptor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Readiness {
    /// Nothing to do.
    Idle,
    /// There is something to read, or its end.
    Ready,
    /// Nobody is left at the other end, and nothing to read.
    HungUp,
}

/// Waits until one of the descriptors can be read or was hung up, or until the time is over. The answer says which.
pub(super) fn poll<const N: usize>(fds: [Option<BorrowedFd<'_>>; N], time: Duration) -> io::Result<[Readiness; N]> {
    let mut list =
        fds.map(|fd| libc::pollfd { fd: fd.map_or(-1, |fd| fd.as_raw_fd()), events: libc::POLLIN, revents: 0 });
    let time = libc::timespec { tv_sec: time.as_secs().cast_signed(), tv_nsec: i64::from(time.subsec_nanos()) };
    // SAFETY: the array and the time outlive the call, the array's length is passed along; no signals are named.
    let answer = unsafe { libc::ppoll(list.as_mut_ptr(), N as libc::nfds_t, &raw const time, std::ptr::null()) };
    match check(i64::from(answer)) {
        Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok([Readiness::Idle; N]),
        Err(error) => Err(error),
        Ok(_) => Ok(list.map(|entry| match entry.revents {
            0 => Readiness::Idle,
            events if events & libc::POLLIN != 0 => Readiness::Ready,
            _ => Readiness::HungUp,
        })),
    }
}

/// Whether a write to the pipe would wait, because it is full.
pub(super) fn is_full(pipe: BorrowedFd<'_>) -> bool {
    let mut entry = libc::pollfd { fd: pipe.as_raw_fd(), events: libc::POLLOUT, revents: 0 };
    // SAFETY: the structure outlives the call, which does not wait.
    let answer = unsafe { libc::poll(&raw mut entry, 1, 0) };
    answer == 0
}

/// Has writes beyond the limit of file sizes fail instead of ending the process.
pub(super) fn ignore_file_size_signal() {
    // SAFETY: ignoring a signal needs no function.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

/// A descriptor that becomes readable when the process ends; `None` on kernels before 5.3.
pub(super) fn process_descriptor(pid: i32) -> Option<OwnedFd> {
    // SAFETY: integers only.
    let fd = check(unsafe { libc::syscall(libc::SYS_pidfd_open, pid, 0) }).ok()?;
    // SAFETY: the kernel has just opened it for us alone.
    Some(unsafe { OwnedFd::from_raw_fd(fd as RawFd) })
}

/// Makes reads and writes on the descriptor return at once when they would wait, or wait again.
pub(super) fn set_blocking(fd: BorrowedFd<'_>, blocking: bool) -> io::Result<()> {
    // SAFETY: integers only, on a borrowed and therefore open descriptor.
    let flags = check(i64::from(unsafe { libc::fcntl(fd.as_raw_fd(), libc::F_GETFL) }))? as i32;
    let flags = if blocking { flags & !libc::O_NONBLOCK } else { flags | libc::O_NONBLOCK };
    // SAFETY: as above.
    done(unsafe { libc::fcntl(fd.as_raw_fd(), libc::F_SETFL, flags) })
}

/// Opens `name` beneath the folder with `flags`, never leaving the folder and never following a symbolic link.
pub(super) fn open_beneath(folder: BorrowedFd<'_>, name: &CStr, flags: i32) -> io::Result<OwnedFd> {
    let flags = flags | libc::O_CLOEXEC | libc::O_NOFOLLOW;
    // SAFETY: an all-zero `open_how` is a valid value.
    let mut how: libc::open_how = unsafe { std::mem::zeroed() };
    how.flags = flags as u64;
    how.resolve = libc::RESOLVE_BENEATH | libc::RESOLVE_NO_SYMLINKS | libc::RESOLVE_NO_MAGICLINKS;
    let size = size_of::<libc::open_how>();
    // SAFETY: name and structure outlive the call and the size is the structure's.
    let mut answer =
        unsafe { libc::syscall(libc::SYS_openat2, folder.as_raw_fd(), name.as_ptr(), &raw const how, size) };
    let refused = |errno| matches!(errno, Some(libc::ENOSYS | libc::EPERM));
    let plain = !name.to_bytes().contains(&b'/') && name != c"..";
    if answer < 0 && plain && refused(io::Error::last_os_error().raw_os_error()) {
        // Kernels before 5.6 and old container profiles have no `openat2`; a single name needs less protection.
        // SAFETY: the name outlives the call.
        answer = i64::from(unsafe { libc::openat(folder.as_raw_fd(), name.as_ptr(), flags) });
    }
    let fd = check(answer)?;
    // SAFETY: the kernel has just opened it for us alone.
    Ok(unsafe { OwnedFd::from_raw_fd(fd as RawFd) })
}

/// Makes a FIFO in the folder; the answer is its reading end, which does not wait yet.
pub(super) fn make_pipe(folder: BorrowedFd<'_>, name: &CStr) -> io::Result<OwnedFd> {
    // The larger, the fewer switches between the program and the grader.
    const BYTES: i32 = 1 << 20;
    make_fifo(folder, name)?;
    let reader = open_beneath(folder, name, libc::O_RDONLY | libc::O_NONBLOCK)?;
    // SAFETY: integers only, on an open descriptor. The kernel may refuse, and a smaller pipe works, too.
    unsafe { libc::fcntl(reader.as_raw_fd(), libc::F_SETPIPE_SZ, BYTES) };
    Ok(reader)
}

/// Makes a FIFO in the folder, for its owner only.
pub(super) fn make_fifo(folder: BorrowedFd<'_>, name: &CStr) -> io::Result<()> {
    // SAFETY: the name outlives the call.
    done(unsafe { libc::mkfifoat(folder.as_raw_fd(), name.as_ptr(), 0o600) })
}

/// Gives an open file or folder (also one opened with `O_PATH`) to a user and group.
pub(super) fn change_owner(fd: BorrowedFd<'_>, user: u32, group: u32) -> io::Result<()> {
    // SAFETY: the empty name is a constant; with AT_EMPTY_PATH the descriptor itself is meant.
    done(unsafe { libc::fchownat(fd.as_raw_fd(), c"".as_ptr(), user, group, libc::AT_EMPTY_PATH) })
}

/// Makes the open folder the current one.
pub(super) fn enter_folder(fd: BorrowedFd<'_>) -> io::Result<()> {
    // SAFETY: an open descriptor.
    done(unsafe { libc::fchdir(fd.as_raw_fd()) })
}

/// Whether the current user may do `mode` (`X_OK`, `R_OK`) with the path.
pub(super) fn accessible(path: &CStr, mode: i32) -> bool {
    // SAFETY: the path outlives the call.
    unsafe { libc::access(path.as_ptr(), mode) == 0 }
}

/// A file in memory that nobody else can name.
pub(super) fn memory_file() -> io::Result<OwnedFd> {
    // SAFETY: the name is a constant.
    let fd = check(i64::from(unsafe { libc::memfd_create(c"program".as_ptr(), libc::MFD_CLOEXEC) }))?;
    // SAFETY: the kernel has just opened it for us alone.
    Ok(unsafe { OwnedFd::from_raw_fd(fd as RawFd) })
}

/// Null-terminated pointers to the strings, which must outlive the list.
fn pointers(strings: &[CString]) -> Vec<*const libc::c_char> {
    strings.iter().map(|text| text.as_ptr()).chain([std::ptr::null()]).collect()
}

/// Executes the program at `path` in place of this one; returns only the error.
pub(super) fn execute(path: &CStr, arguments: &[CString], environment: &[CString]) -> io::Error {
    let (arguments, environment) = (pointers(arguments), pointers(environment));
    // SAFETY: both lists end with a null pointer and, like the path, outlive the call.
    unsafe { libc::execve(path.as_ptr(), arguments.as_ptr(), environment.as_ptr()) };
    io::Error::last_os_error()
}

/// Executes the open file in place of this program; returns only the error.
pub(super) fn execute_open(file: BorrowedFd<'_>, arguments: &[CString], environment: &[CString]) -> io::Error {
    let (arguments, environment) = (pointers(arguments), pointers(environment));
    // SAFETY: as in `execute`; the empty path is a constant and means the descriptor itself.
    unsafe {
        libc::syscall(
            libc::SYS_execveat,
            file.as_raw_fd(),
            c"".as_ptr(),
            arguments.as_ptr(),
            environment.as_ptr(),
            libc::AT_EMPTY_PATH,
        )
    };
    io::Error::last_os_error()
}

/// Installs a seccomp filter for this thread and its children. With `listener`, calls that the filter hands to user
/// space are announced on the descriptor that comes back.
pub(super) fn install_filter(program: &[sock_filter], listener: bool) -> io::Result<Option<OwnedFd>> {
    #[repr(C)]
    struct Program {
        length: libc::c_ushort,
        filter: *const sock_filter,
    }
    let length = u16::try_from(program.len()).map_err(io::Error::other)?;
    let program = Program { length, filter: program.as_ptr() };
    let flags = if listener { libc::SECCOMP_FILTER_FLAG_NEW_LISTENER } else { 0 };
    // SAFETY: the structure has the layout of the kernel's `sock_fprog` and outlives the call, as does its array.
    let answer = unsafe { libc::syscall(libc::SYS_seccomp, libc::SECCOMP_SET_MODE_FILTER, flags, &raw const program) };
    let fd = check(answer)?;
    // SAFETY: with the flag the answer is a descriptor that the kernel has just opened for us alone.
    Ok(listener.then(|| unsafe { OwnedFd::from_raw_fd(fd as RawFd) }))
}

/// A system call that waits for a decision.
pub(super) struct Announced {
    /// The announcement's number.
    pub(super) id: u64,
    /// The calling thread.
    pub(super) thread: u32,
    /// The call's number.
    pub(super) call: i64,
    /// Its arguments.
    pub(super) arguments: [u64; 6],
}

/// Takes the next announcement; `None` when the caller has died meanwhile.
pub(super) fn next_announcement(listener: BorrowedFd<'_>) -> io::Result<Option<Announced>> {
    // SAFETY: an all-zero notification is valid, and the kernel asks for zeros.
    let mut notification: libc::seccomp_notif = unsafe { std::mem::zeroed() };
    // SAFETY: the structure is the one that this request fills, and it outlives the call.
    let answer = unsafe { libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_RECV, &raw mut notification) };
    match check(i64::from(answer)) {
        Err(error) if matches!(error.raw_os_error(), Some(libc::ENOENT | libc::EINTR)) => Ok(None),
        Err(error) => Err(error),
        Ok(_) => Ok(Some(Announced {
            id: notification.id,
            thread: notification.pid,
            call: i64::from(notification.data.nr),
            arguments: notification.data.args,
        })),
    }
}

/// Whether the announced call still waits for its answer.
pub(super) fn is_waiting(listener: BorrowedFd<'_>, id: u64) -> bool {
    // SAFETY: the number outlives the call, which only reads it.
    unsafe { libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_ID_VALID, &raw const id) == 0 }
}

/// The time since the clock's beginning: the calendar's clock, or the one that always goes on.
pub(super) fn time_by(calendar: bool) -> Duration {
    let clock = if calendar { libc::CLOCK_REALTIME } else { libc::CLOCK_MONOTONIC };
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the structure outlives the call, which fills it.
    unsafe { libc::clock_gettime(clock, &raw mut time) };
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// The answer to an announced call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CallAnswer {
    /// It goes on as if it had not been announced.
    GoOn,
    /// It has succeeded already.
    Done,
    /// It fails with this error number.
    Refused(i32),
}

/// Answers the announced call in the kernel's place.
pub(super) fn answer(listener: BorrowedFd<'_>, id: u64, answer: CallAnswer) -> io::Result<()> {
    let (error, flags) = match answer {
        CallAnswer::GoOn => (0, libc::SECCOMP_USER_NOTIF_FLAG_CONTINUE as u32),
        CallAnswer::Done => (0, 0),
        CallAnswer::Refused(errno) => (-errno, 0),
    };
    let mut answer = libc::seccomp_notif_resp { id, val: 0, error, flags };
    // SAFETY: the structure is the one that this request reads, and it outlives the call.
    done(unsafe { libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_SEND, &raw mut answer) })
}

/// Space for some descriptors in a control message, aligned as the kernel needs it.
#[repr(C, align(8))]
struct ControlSpace([u8; 64]);

/// Sends one byte and, along with it, descriptors.
pub(super) fn send_descriptors<const N: usize>(
    to: &UnixStream,
    mut byte: u8,
    fds: [BorrowedFd<'_>; N],
) -> io::Result<()> {
    const { assert!(N > 0 && N <= 8, "they fit into the control space") };
    let numbers = fds.map(|fd| fd.as_raw_fd());
    let size = size_of_val(&numbers);
    let mut space = ControlSpace([0; 64]);
    let mut part = libc::iovec { iov_base: (&raw mut byte).cast(), iov_len: 1 };
    // SAFETY: an all-zero header is valid; its pointers are set to values that outlive the call, the control space is
    // larger than CMSG_SPACE of this number of descriptors, so that the first header and its data lie within it.
    unsafe {
        let mut message: libc::msghdr = std::mem::zeroed();
        message.msg_iov = &raw mut part;
        message.msg_iovlen = 1;
        message.msg_control = space.0.as_mut_ptr().cast();
        message.msg_controllen = libc::CMSG_SPACE(size as u32) as _;
        let header = libc::CMSG_FIRSTHDR(&raw const message);
        (*header).cmsg_level = libc::SOL_SOCKET;
        (*header).cmsg_type = libc::SCM_RIGHTS;
        (*header).cmsg_len = libc::CMSG_LEN(size as u32) as _;
        std::ptr::copy_nonoverlapping(numbers.as_ptr().cast(), libc::CMSG_DATA(header), size);
        check(libc::sendmsg(to.as_raw_fd(), &raw const message, libc::MSG_NOSIGNAL) as i64).map(drop)
    }
}

/// Receives bytes and the descriptors that came along. No bytes mean that the other side is closed.
pub(super) fn receive_descriptors(from: &UnixStream, buffer: &mut [u8]) -> io::Result<(usize, Vec<OwnedFd>)> {
    let mut space = ControlSpace([0; 64]);
    let mut part = libc::iovec { iov_base: buffer.as_mut_ptr().cast(), iov_len: buffer.len() };
    // SAFETY: as in `send_descriptors`; the kernel writes only within the lengths given, and a header is read only when
    // it says that it holds descriptors, which are then ours alone.
    unsafe {
        let mut message: libc::msghdr = std::mem::zeroed();
        message.msg_iov = &raw mut part;
        message.msg_iovlen = 1;
        message.msg_control = space.0.as_mut_ptr().cast();
        message.msg_controllen = space.0.len() as _;
        let length = check(libc::recvmsg(from.as_raw_fd(), &raw mut message, libc::MSG_CMSG_CLOEXEC) as i64)?;
        let header = libc::CMSG_FIRSTHDR(&raw const message);
        let holds =
            !header.is_null() && (*header).cmsg_level == libc::SOL_SOCKET && (*header).cmsg_type == libc::SCM_RIGHTS;
        let size = if holds { ((*header).cmsg_len as usize).saturating_sub(libc::CMSG_LEN(0) as usize) } else { 0 };
        let fd = |at| std::ptr::read_unaligned(libc::CMSG_DATA(header).cast::<RawFd>().add(at));
        let fds = (0..size / size_of::<RawFd>()).map(|at| OwnedFd::from_raw_fd(fd(at))).collect();
        Ok((length as usize, fds))
    }
}

/// Bytes of one page of memory.
pub(super) fn page_size() -> u64 {
    // SAFETY: an integer; the answer of this question is always positive.
    unsafe { libc::sysconf(libc::_SC_PAGESIZE) }.unsigned_abs()
}

/// Landlock's version in the running kernel; 0 when there is none.
pub(super) fn landlock_version() -> i32 {
    let version_flag = 1_u32;
    // SAFETY: with this flag the kernel reads no structure: the pointer is null and the size zero.
    let answer =
        unsafe { libc::syscall(libc::SYS_landlock_create_ruleset, std::ptr::null::<u8>(), 0_usize, version_flag) };
    i32::try_from(answer).unwrap_or(0).max(0)
}

#[cfg(test)]
mod tests;
