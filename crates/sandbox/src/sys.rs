//! The system calls that the standard library does not offer, each wrapped in a safe function. Most functions use
//! `rustix`.
//!
//! This file, `machine.rs` and `mounts.rs` are the sandbox's only files with `unsafe` code. Every function passes the
//! kernel valid pointers to live values, converts its result into a `Result`, and keeps no pointer. Only [`fork`] has a
//! precondition, which it checks.

#![expect(unsafe_code, reason = "fork, execve, seccomp and similar calls have no safe wrapper among the dependencies")]

use std::{
    ffi::{CStr, CString},
    io::{self, IoSlice, IoSliceMut},
    mem::MaybeUninit,
    os::{
        fd::{AsRawFd, BorrowedFd, FromRawFd, OwnedFd, RawFd},
        unix::net::UnixStream,
    },
    time::Duration,
};

use rustix::{
    event::{PollFd, PollFlags, Timespec},
    fs::{AtFlags, MemfdFlags, Mode, ResolveFlags},
    io::{Errno, FdFlags},
    net::{RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, SendAncillaryBuffer, SendAncillaryMessage, SendFlags},
    process::{Gid, Pid, PidfdFlags, Rlimit, Signal, Uid, WaitOptions, getrlimit, setrlimit},
    time::ClockId,
};
use seccompiler::sock_filter;

pub(super) use rustix::{
    fs::{Access, OFlags},
    process::Resource,
};

/// Turns a result of -1 into the error that the kernel reports.
pub(super) fn check(answer: i64) -> io::Result<i64> {
    if answer < 0 { Err(io::Error::last_os_error()) } else { Ok(answer) }
}

/// Turns a result of -1 into the error that the kernel reports, for calls with no other result.
pub(super) fn check_answer(answer: i32) -> io::Result<()> {
    check(i64::from(answer)).map(drop)
}

/// The two processes after a fork.
pub(super) enum Fork {
    /// This is the child process.
    Child,
    /// This is the parent process. The value is the child's process ID.
    Parent(i32),
}

/// The proof that this process has only one thread and starts no others, or that the process from which it was forked
/// did. The memory of a forked child is then consistent.
pub(super) struct SingleThread(());

/// Checks that this process has only one thread.
///
/// # Errors
///
/// Fails if the process has more than one thread, because its child could find locks that are held forever.
pub(super) fn single_thread() -> io::Result<SingleThread> {
    match std::fs::read_dir("/proc/self/task")?.count() {
        1 => Ok(SingleThread(())),
        _ => Err(io::Error::other("the supervisor must be single-threaded")),
    }
}

/// Forks the process, which must have only one thread.
pub(super) fn fork() -> io::Result<Fork> {
    fork_single_threaded(&single_thread()?)
}

/// Forks a process that was proved to have only one thread.
pub(super) fn fork_single_threaded(_: &SingleThread) -> io::Result<Fork> {
    // SAFETY: the process has only one thread, so the child's copy of its memory is consistent.
    match check(i64::from(unsafe { libc::fork() }))? {
        0 => Ok(Fork::Child),
        pid => Ok(Fork::Parent(pid as i32)),
    }
}

/// Ends the process immediately, without running exit handlers.
pub(super) fn exit_now(code: i32) -> ! {
    // SAFETY: the argument is an integer, and the call does not return.
    unsafe { libc::_exit(code) }
}

/// Returns the effective user of this process.
pub(super) fn user_id() -> u32 {
    rustix::process::geteuid().as_raw()
}

/// Returns the effective group of this process.
pub(super) fn group_id() -> u32 {
    rustix::process::getegid().as_raw()
}

/// Starts a new session without a controlling terminal.
pub(super) fn start_session() -> io::Result<()> {
    Ok(rustix::process::setsid().map(drop)?)
}

/// Makes this process adopt the orphans among its descendants.
pub(super) fn become_reaper() -> io::Result<()> {
    Ok(rustix::process::set_child_subreaper(Some(rustix::process::getpid()))?)
}

/// Makes the kernel kill this process when its parent ends.
pub(super) fn die_with_parent() -> io::Result<()> {
    Ok(rustix::process::set_parent_process_death_signal(Some(Signal::KILL))?)
}

/// Prevents permanently that an executed program gains privileges.
pub(super) fn forbid_new_privileges() -> io::Result<()> {
    Ok(rustix::thread::set_no_new_privs(true)?)
}

/// Sets both the soft and the hard limit. They never exceed the hard limit that exists.
pub(super) fn set_limit(resource: Resource, value: u64) -> io::Result<()> {
    let value = Some(getrlimit(resource).maximum.map_or(value, |maximum| value.min(maximum)));
    Ok(setrlimit(resource, Rlimit { current: value, maximum: value })?)
}

/// Becomes another user and group permanently, and leaves all supplementary groups.
pub(super) fn switch_user(id: u32) -> io::Result<()> {
    let (user, group) = (Uid::from_raw(id), Gid::from_raw(id));
    rustix::thread::set_thread_groups(&[])?;
    rustix::thread::set_thread_res_gid(group, group, group)?;
    Ok(rustix::thread::set_thread_res_uid(user, user, user)?)
}

/// Calls a function with another user's file permissions. In this way, root can read the user's entries in `/proc`
/// without the capability to trace. Only the single thread of the supervisor does this, and it always restores its own
/// user.
pub(super) fn with_file_permissions_of<T>(user: Option<u32>, action: impl FnOnce() -> T) -> T {
    let Some(user) = user else { return action() };
    // SAFETY: all arguments are integers. Both calls return the previous number, and change nothing if that is not
    // allowed.
    let (old_group, old_user) = unsafe { (libc::setfsgid(user), libc::setfsuid(user)) };
    let result = action();
    // SAFETY: all arguments are integers, as above.
    unsafe {
        libc::setfsuid(old_user.cast_unsigned());
        libc::setfsgid(old_group.cast_unsigned());
    }
    result
}

/// Makes the three descriptors standard input, output and error. They stay open across `execve`.
pub(super) fn connect_standard_streams(input: &OwnedFd, output: &OwnedFd, error: &OwnedFd) -> io::Result<()> {
    rustix::stdio::dup2_stdin(input)?;
    rustix::stdio::dup2_stdout(output)?;
    Ok(rustix::stdio::dup2_stderr(error)?)
}

/// Returns a copy of the descriptor whose number is at least `min`. The next `execve` closes it.
pub(super) fn duplicate_from(fd: BorrowedFd<'_>, min: u32) -> io::Result<OwnedFd> {
    Ok(rustix::io::fcntl_dupfd_cloexec(fd, min.cast_signed())?)
}

/// Keeps the descriptor open across `execve`.
pub(super) fn keep_on_execute(fd: BorrowedFd<'_>) -> io::Result<()> {
    Ok(rustix::io::fcntl_setfd(fd, FdFlags::empty())?)
}

/// Marks all descriptors from number 3 on, so that the next `execve` closes them.
pub(super) fn close_on_execute() -> io::Result<()> {
    // SAFETY: all arguments are integers.
    if unsafe { libc::syscall(libc::SYS_close_range, 3_u32, u32::MAX, libc::CLOSE_RANGE_CLOEXEC) } == 0 {
        return Ok(());
    }
    // Kernels before 5.11 do not support the flag, so each descriptor is marked.
    for entry in std::fs::read_dir("/proc/self/fd")? {
        let Some(fd) = entry?.file_name().to_str().and_then(|name| name.parse::<RawFd>().ok()) else { continue };
        if fd > 2 {
            // SAFETY: all arguments are integers, and the kernel rejects a descriptor that was closed in the meantime.
            unsafe { libc::fcntl(fd, libc::F_SETFD, libc::FD_CLOEXEC) };
        }
    }
    Ok(())
}

/// Returns the signals that this process ignores. When a program is executed, ignored signals are still ignored, and
/// handled signals get the default reaction.
pub(super) fn ignored_signals() -> Vec<i32> {
    let is_ignored = |signal: &i32| {
        // SAFETY: an all-zero action is valid and outlives the call, which only reads. The kernel rejects numbers that
        // are not signals.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            libc::sigaction(*signal, std::ptr::null(), &raw mut action) == 0 && action.sa_sigaction == libc::SIG_IGN
        }
    };
    (1..=64).filter(is_ignored).collect()
}

/// Restores the default reaction to the signals in `ignored`, and unblocks all signals.
pub(super) fn default_signals(ignored: &[i32]) {
    // SAFETY: the default action needs no function, and the kernel rejects numbers that are not signals. `sigemptyset`
    // initializes the set before it is read.
    unsafe {
        for signal in ignored {
            libc::signal(*signal, libc::SIG_DFL);
        }
        let mut none: libc::sigset_t = std::mem::zeroed();
        libc::sigemptyset(&raw mut none);
        libc::sigprocmask(libc::SIG_SETMASK, &raw const none, std::ptr::null_mut());
    }
}

/// Sets the permission bits that new files do not get (umask).
pub(super) fn set_file_mask(mask: u32) {
    rustix::process::umask(Mode::from_raw_mode(mask));
}

/// Sends a signal to one process.
pub(super) fn kill(pid: i32, signal: i32) -> io::Result<()> {
    if pid <= 1 {
        return Err(io::Error::other(format!("refusing to signal {pid}: it is not a single process")));
    }
    // SAFETY: all arguments are integers. The process ID is positive, so that no process group is meant.
    check_answer(unsafe { libc::kill(pid, signal) })
}

/// Kills all processes in this process namespace, if this process is the first one in it. Returns whether it is; if
/// not, nothing is killed.
pub(super) fn kill_namespace() -> bool {
    let is_first = std::process::id() == 1;
    if is_first {
        // SAFETY: all arguments are integers. If the first process of a namespace calls this, -1 means all other
        // processes in the namespace, and none outside.
        unsafe { libc::kill(-1, libc::SIGKILL) };
    }
    is_first
}

/// A process that has ended.
pub(super) struct ReapedProcess {
    /// The ID of the process.
    pub(super) pid: i32,
    /// The raw wait status of the process.
    pub(super) status: i32,
}

/// Reaps a child that has ended, without waiting. Returns `None` if no child has ended.
///
/// # Errors
///
/// Fails with `ECHILD` if there is no child at all.
pub(super) fn reap() -> io::Result<Option<ReapedProcess>> {
    let ended = rustix::process::wait(WaitOptions::NOHANG)?;
    Ok(ended.map(|(pid, status)| ReapedProcess { pid: pid.as_raw_pid(), status: status.as_raw() }))
}

/// Waits until the child has ended. Returns its exit code, or 128 plus the signal that ended it.
pub(super) fn wait_for_exit(pid: i32) -> io::Result<u8> {
    let ended = rustix::io::retry_on_intr(|| rustix::process::waitpid(Pid::from_raw(pid), WaitOptions::empty()))?;
    let (_, status) = ended.ok_or(io::ErrorKind::WouldBlock)?;
    let code = status.terminating_signal().map(|signal| 128 + signal).or(status.exit_status());
    Ok(code.unwrap_or_default() as u8)
}

/// Returns the processor time and the largest resident memory in bytes, of all reaped children and their descendants.
pub(super) fn children_usage() -> io::Result<(Duration, u64)> {
    // SAFETY: an all-zero `rusage` is a valid value, and the kernel fills it.
    let usage = unsafe {
        let mut usage: libc::rusage = std::mem::zeroed();
        check_answer(libc::getrusage(libc::RUSAGE_CHILDREN, &raw mut usage))?;
        usage
    };
    let time = |value: libc::timeval| {
        Duration::from_secs(value.tv_sec.unsigned_abs()) + Duration::from_micros(value.tv_usec.unsigned_abs())
    };
    Ok((time(usage.ru_utime) + time(usage.ru_stime), usage.ru_maxrss.unsigned_abs() * 1024))
}

/// The state of a descriptor, as [`poll`] reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Readiness {
    /// There is nothing to do.
    Idle,
    /// There are data to read, or the stream has ended.
    Ready,
    /// The other end is closed, and there are no data to read.
    Closed,
}

/// Waits until one of the descriptors can be read or was hung up, or until the time is over. Returns the state of each
/// descriptor.
pub(super) fn poll<const N: usize>(fds: [Option<BorrowedFd<'_>>; N], time: Duration) -> io::Result<[Readiness; N]> {
    let open_fds = fds.iter().flatten();
    let mut list: Vec<PollFd<'_>> = open_fds.map(|fd| PollFd::from_borrowed_fd(*fd, PollFlags::IN)).collect();
    let time = Timespec { tv_sec: time.as_secs().cast_signed(), tv_nsec: time.subsec_nanos().into() };
    match rustix::event::poll(&mut list, Some(&time)) {
        Err(Errno::INTR) => return Ok([Readiness::Idle; N]),
        found => found?,
    };
    let mut found = list.iter().map(PollFd::revents);
    Ok(fds.map(|fd| match fd.and_then(|_| found.next()).unwrap_or(PollFlags::empty()) {
        events if events.is_empty() => Readiness::Idle,
        events if events.contains(PollFlags::IN) => Readiness::Ready,
        _ => Readiness::Closed,
    }))
}

/// Makes writes beyond the file size limit fail, instead of killing the process.
pub(super) fn ignore_file_size_signal() {
    // SAFETY: ignoring a signal needs no function.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

/// Returns a descriptor that becomes readable when the process ends; `None` on kernels before 5.3.
pub(super) fn process_descriptor(pid: i32) -> Option<OwnedFd> {
    rustix::process::pidfd_open(Pid::from_raw(pid)?, PidfdFlags::empty()).ok()
}

/// Sets whether reads and writes on the descriptor wait, or return immediately.
pub(super) fn set_blocking(fd: BorrowedFd<'_>, blocking: bool) -> io::Result<()> {
    Ok(rustix::io::ioctl_fionbio(fd, !blocking)?)
}

/// Opens `name` below a folder, with `flags`. The folder is never left, and symbolic links are never followed.
pub(super) fn open_beneath(folder: BorrowedFd<'_>, name: &CStr, flags: OFlags) -> io::Result<OwnedFd> {
    let flags = flags | OFlags::CLOEXEC | OFlags::NOFOLLOW;
    let inside = ResolveFlags::BENEATH | ResolveFlags::NO_SYMLINKS | ResolveFlags::NO_MAGICLINKS;
    let plain = !name.to_bytes().contains(&b'/') && name != c"..";
    match rustix::fs::openat2(folder, name, flags, Mode::empty(), inside) {
        // Kernels before 5.6 and old container profiles have no `openat2`. A name without slashes needs less
        // protection.
        Err(Errno::NOSYS | Errno::PERM) if plain => Ok(rustix::fs::openat(folder, name, flags, Mode::empty())?),
        opened => Ok(opened?),
    }
}

/// Changes the owner and the group of an open file or folder. It may have been opened with `O_PATH`.
pub(super) fn change_owner(fd: BorrowedFd<'_>, user: u32, group: u32) -> io::Result<()> {
    let (user, group) = (Some(Uid::from_raw(user)), Some(Gid::from_raw(group)));
    Ok(rustix::fs::chownat(fd, c"", user, group, AtFlags::EMPTY_PATH)?)
}

/// Makes the open folder the current folder.
pub(super) fn enter_folder(fd: BorrowedFd<'_>) -> io::Result<()> {
    Ok(rustix::process::fchdir(fd)?)
}

/// Returns whether the current user has the access `mode` to the path.
pub(super) fn is_accessible(path: &CStr, mode: Access) -> bool {
    rustix::fs::access(path, mode).is_ok()
}

/// Creates a file in memory that no other process can name.
pub(super) fn memory_file() -> io::Result<OwnedFd> {
    Ok(rustix::fs::memfd_create(c"program", MemfdFlags::CLOEXEC)?)
}

/// Returns a null-terminated list of pointers to the strings. The strings must outlive the list.
fn to_pointers(strings: &[CString]) -> Vec<*const libc::c_char> {
    strings.iter().map(|text| text.as_ptr()).chain([std::ptr::null()]).collect()
}

/// Replaces this process with the program at `path`. Returns only if there is an error.
pub(super) fn execute(path: &CStr, arguments: &[CString], environment: &[CString]) -> io::Error {
    let (arguments, environment) = (to_pointers(arguments), to_pointers(environment));
    // SAFETY: both lists end with a null pointer. The lists and the path outlive the call.
    unsafe { libc::execve(path.as_ptr(), arguments.as_ptr(), environment.as_ptr()) };
    io::Error::last_os_error()
}

/// Replaces this process with the program in an open file. Returns only if there is an error.
pub(super) fn execute_open(file: BorrowedFd<'_>, arguments: &[CString], environment: &[CString]) -> io::Error {
    let (arguments, environment) = (to_pointers(arguments), to_pointers(environment));
    // SAFETY: the lists are as in `execute`. The empty path is a constant, and means the descriptor itself.
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

/// Installs a seccomp filter for this thread and its children. With `listener`, the returned descriptor announces the
/// calls that the filter passes to user space.
pub(super) fn install_filter(program: &[sock_filter], listener: bool) -> io::Result<Option<OwnedFd>> {
    #[repr(C)]
    struct FilterProgram {
        length: libc::c_ushort,
        filter: *const sock_filter,
    }
    let length = u16::try_from(program.len()).map_err(io::Error::other)?;
    let program = FilterProgram { length, filter: program.as_ptr() };
    let flags = if listener { libc::SECCOMP_FILTER_FLAG_NEW_LISTENER } else { 0 };
    // SAFETY: the structure has the layout of the kernel's `sock_fprog`. The structure and its array outlive the call.
    let answer = unsafe { libc::syscall(libc::SYS_seccomp, libc::SECCOMP_SET_MODE_FILTER, flags, &raw const program) };
    let fd = check(answer)?;
    // SAFETY: with this flag, the result is a descriptor that the kernel has just opened for this process alone.
    Ok(listener.then(|| unsafe { OwnedFd::from_raw_fd(fd as RawFd) }))
}

/// A system call of the program that waits for a decision.
pub(super) struct PendingCall {
    /// The ID of the notification (seccomp).
    pub(super) id: u64,
    /// The ID of the thread that made the call.
    pub(super) thread: u32,
    /// The number of the system call.
    pub(super) call: i64,
    /// The arguments of the system call.
    pub(super) arguments: [u64; 6],
}

/// Receives the next announcement; `None` if the caller has ended.
pub(super) fn next_announcement(listener: BorrowedFd<'_>) -> io::Result<Option<PendingCall>> {
    // SAFETY: an all-zero notification is valid, and the kernel requires that it is zero.
    let mut notification: libc::seccomp_notif = unsafe { std::mem::zeroed() };
    // SAFETY: this request fills exactly this structure, and the structure outlives the call.
    let answer = unsafe { libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_RECV, &raw mut notification) };
    match check(i64::from(answer)) {
        Err(error) if matches!(error.raw_os_error(), Some(libc::ENOENT | libc::EINTR)) => Ok(None),
        Err(error) => Err(error),
        Ok(_) => Ok(Some(PendingCall {
            id: notification.id,
            thread: notification.pid,
            call: i64::from(notification.data.nr),
            arguments: notification.data.args,
        })),
    }
}

/// Returns whether the announced call still waits for its answer.
pub(super) fn is_waiting(listener: BorrowedFd<'_>, id: u64) -> bool {
    // SAFETY: the number outlives the call, which only reads it.
    unsafe { libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_ID_VALID, &raw const id) == 0 }
}

/// Returns the processor time of this process. With `this_thread`, that of the calling thread alone.
pub(super) fn processor_time(this_thread: bool) -> Duration {
    let time = rustix::time::clock_gettime(if this_thread { ClockId::ThreadCPUTime } else { ClockId::ProcessCPUTime });
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// Returns the time of a clock: the time since 1970 if `calendar`, otherwise the time of the monotonic clock.
pub(super) fn clock_time(calendar: bool) -> Duration {
    let time = rustix::time::clock_gettime(if calendar { ClockId::Realtime } else { ClockId::Monotonic });
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// The answer to an announced call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CallAnswer {
    /// The kernel executes the call, as if it had not been announced.
    Continue,
    /// The call has already been carried out, and succeeds.
    Done,
    /// The call fails with this error number.
    Error(i32),
}

/// Answers an announced call.
pub(super) fn answer(listener: BorrowedFd<'_>, id: u64, answer: CallAnswer) -> io::Result<()> {
    let (error, flags) = match answer {
        CallAnswer::Continue => (0, libc::SECCOMP_USER_NOTIF_FLAG_CONTINUE as u32),
        CallAnswer::Done => (0, 0),
        CallAnswer::Error(errno) => (-errno, 0),
    };
    let mut answer = libc::seccomp_notif_resp { id, val: 0, error, flags };
    // SAFETY: this request reads exactly this structure, and the structure outlives the call.
    check_answer(unsafe { libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_SEND, &raw mut answer) })
}

/// The maximum number of descriptors in a message.
const MAX_DESCRIPTORS: usize = 8;

/// Sends one byte, together with descriptors.
pub(super) fn send_descriptors<const N: usize>(to: &UnixStream, byte: u8, fds: [BorrowedFd<'_>; N]) -> io::Result<()> {
    const { assert!(N <= MAX_DESCRIPTORS, "they fit into the control space") };
    let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(MAX_DESCRIPTORS))];
    let mut control = SendAncillaryBuffer::new(&mut space);
    control.push(SendAncillaryMessage::ScmRights(&fds));
    rustix::net::sendmsg(to, &[IoSlice::new(&[byte])], &mut control, SendFlags::NOSIGNAL)?;
    Ok(())
}

/// Receives bytes, together with descriptors. If there are no bytes, the other side is closed.
pub(super) fn receive_descriptors(from: &UnixStream, buffer: &mut [u8]) -> io::Result<(usize, Vec<OwnedFd>)> {
    let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(MAX_DESCRIPTORS))];
    let mut control = RecvAncillaryBuffer::new(&mut space);
    let parts = &mut [IoSliceMut::new(buffer)];
    let received = rustix::net::recvmsg(from, parts, &mut control, RecvFlags::CMSG_CLOEXEC)?;
    let fds = control.drain().filter_map(|message| match message {
        RecvAncillaryMessage::ScmRights(fds) => Some(fds),
        _ => None,
    });
    Ok((received.bytes, fds.flatten().collect()))
}

/// Returns the size of a page of memory, in bytes.
pub(super) fn page_size() -> u64 {
    rustix::param::page_size() as u64
}

/// Returns the version of Landlock in the running kernel; 0 if it has no Landlock.
pub(super) fn landlock_version() -> i32 {
    let version_flag = 1_u32;
    // SAFETY: with this flag the kernel reads no structure. The pointer is null, and the size is zero.
    let answer =
        unsafe { libc::syscall(libc::SYS_landlock_create_ruleset, std::ptr::null::<u8>(), 0_usize, version_flag) };
    i32::try_from(answer).unwrap_or(0).max(0)
}

#[cfg(test)]
mod tests;
