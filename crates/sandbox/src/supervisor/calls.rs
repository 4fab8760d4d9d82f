//! The system calls by name, in groups that the filter treats differently.
//!
//! A call in no group does not exist for the program (`ENOSYS`); programs treat it like a call that is newer than the
//! kernel. A real submission of the course uses 21 calls. POSIX timers (`timer_create`) are in no group, because all
//! programs of a user share their number; `setitimer`, `alarm` and `timerfd_create` do not affect others.

/// The name and the number of a system call.
pub(super) type NamedCall = (&'static str, i64);

/// Lists calls. The calls after `old` exist only on x86_64: older names, and dangerous calls.
macro_rules! calls {
    ($($name:ident)* $(; old: $($old:ident)*)?) => {
        &[
            $((stringify!($name), libc::$name),)*
            $($(#[cfg(target_arch = "x86_64")] (stringify!($old), libc::$old),)*)?
        ]
    };
}

/// Calls that every program needs for its own memory, files, time, threads and signals. For file calls, Landlock
/// decides which files; resource limits decide how much.
pub(super) const ALLOWED_CALLS: &[NamedCall] = calls![
    SYS_read SYS_write SYS_readv SYS_writev SYS_pread64 SYS_pwrite64 SYS_preadv SYS_pwritev SYS_preadv2 SYS_pwritev2
    SYS_openat SYS_close SYS_close_range SYS_lseek SYS_fstat SYS_newfstatat SYS_statx SYS_faccessat SYS_faccessat2
    SYS_readlinkat SYS_getdents64 SYS_getcwd SYS_chdir SYS_fchdir SYS_mkdirat SYS_unlinkat SYS_renameat SYS_renameat2
    SYS_ftruncate SYS_fsync SYS_fdatasync SYS_copy_file_range SYS_sendfile SYS_dup SYS_dup3
    SYS_fcntl SYS_pipe2 SYS_ppoll SYS_pselect6 SYS_eventfd2 SYS_epoll_create1 SYS_epoll_ctl SYS_epoll_pwait
    SYS_timerfd_create SYS_timerfd_settime SYS_timerfd_gettime SYS_umask
    SYS_mmap SYS_mprotect SYS_munmap SYS_mremap SYS_madvise SYS_msync SYS_brk SYS_mlock SYS_munlock
    SYS_membarrier
    SYS_rt_sigaction SYS_rt_sigprocmask SYS_rt_sigreturn SYS_rt_sigsuspend SYS_rt_sigpending SYS_rt_sigtimedwait
    SYS_sigaltstack SYS_nanosleep SYS_clock_nanosleep SYS_clock_gettime SYS_clock_getres SYS_gettimeofday SYS_times
    SYS_setitimer SYS_getitimer
    SYS_getpid SYS_getppid SYS_gettid SYS_getuid SYS_geteuid SYS_getgid SYS_getegid SYS_getgroups SYS_getresuid
    SYS_getresgid SYS_getpgid SYS_getsid SYS_setpgid SYS_setsid SYS_uname SYS_sysinfo SYS_sched_yield
    SYS_sched_getaffinity SYS_sched_setaffinity SYS_sched_getparam SYS_sched_getscheduler SYS_sched_get_priority_max
    SYS_sched_get_priority_min SYS_getpriority SYS_set_tid_address SYS_set_robust_list SYS_get_robust_list SYS_futex
    SYS_rseq SYS_getrandom SYS_getcpu SYS_exit SYS_exit_group SYS_wait4 SYS_waitid SYS_getrusage SYS_restart_syscall
    SYS_ioctl SYS_prctl SYS_prlimit64 SYS_kill SYS_tkill SYS_tgkill SYS_clone SYS_execve SYS_execveat
    ; old:
    SYS_open SYS_creat SYS_stat SYS_lstat SYS_access SYS_readlink SYS_getdents SYS_mkdir SYS_rmdir SYS_unlink SYS_rename
    SYS_dup2 SYS_pipe SYS_poll SYS_select SYS_eventfd SYS_epoll_create SYS_epoll_wait
    SYS_pause SYS_alarm SYS_time SYS_getpgrp SYS_getrlimit SYS_setrlimit SYS_arch_prctl
];

/// Older calls that start a process. Compilers need them, but no submission needs them.
pub(super) const FORK_CALLS: &[NamedCall] = calls![; old: SYS_fork SYS_vfork];

/// Calls that create links and special files. They are answered with `EPERM`. The folder's rules forbid most of them as
/// well.
pub(super) const LINK_CALLS: &[NamedCall] = calls![
    SYS_linkat SYS_symlinkat SYS_mknodat
    ; old:
    SYS_link SYS_symlink SYS_mknod
];

/// Calls that change permission bits, by name or by descriptor. Landlock does not restrict them, so a program that runs
/// as the grader's user could change the grader's files.
pub(super) const MODE_CALLS: &[NamedCall] = calls![SYS_fchmodat SYS_fchmod; old: SYS_chmod];

/// Calls that change the times of files. Landlock does not restrict them either.
pub(super) const TIME_CALLS: &[NamedCall] = calls![SYS_utimensat];
/// Older calls that change the times of files. They take a name, and never an open file.
pub(super) const TIMES_BY_NAME: &[NamedCall] = calls![; old: SYS_utime SYS_utimes SYS_futimesat];

/// Calls that libraries try but do not need. They are denied with `EPERM` or `EACCES`, and do not count as an attack.
/// An example is the socket by which the C library connects to the name service. The list includes calls that count
/// free blocks, because they reveal what others wrote.
pub(super) const DENIED_CALLS: &[NamedCall] = calls![
    SYS_socket SYS_socketpair SYS_truncate SYS_fchown SYS_fchownat SYS_setxattr SYS_lsetxattr SYS_fsetxattr
    SYS_removexattr SYS_lremovexattr SYS_fremovexattr SYS_setpriority SYS_sched_setscheduler
    SYS_sched_setparam SYS_sched_setattr SYS_setgroups SYS_setfsuid SYS_setfsgid
    SYS_personality SYS_shmget SYS_shmat SYS_shmctl SYS_semget SYS_semctl SYS_semop SYS_msgget SYS_msgsnd SYS_msgrcv
    SYS_mincore SYS_fadvise64 SYS_msgctl SYS_mq_open SYS_rt_sigqueueinfo SYS_rt_tgsigqueueinfo SYS_pidfd_send_signal
    SYS_mlockall SYS_ioprio_set SYS_statfs SYS_fstatfs
    ; old:
    SYS_chown SYS_lchown
];

/// Calls that are dangerous for the kernel. No submission makes such a call by accident, so the program is stopped, and
/// the outcome names the call.
pub(super) const FORBIDDEN_CALLS: &[NamedCall] = calls![
    SYS_ptrace SYS_process_vm_readv SYS_process_vm_writev SYS_kcmp SYS_pidfd_getfd SYS_unshare SYS_setns SYS_mount
    SYS_umount2 SYS_pivot_root SYS_chroot SYS_open_tree SYS_move_mount SYS_fsopen SYS_fsconfig SYS_fsmount SYS_fspick
    SYS_mount_setattr SYS_bpf SYS_perf_event_open SYS_userfaultfd SYS_io_uring_setup SYS_io_uring_enter
    SYS_io_uring_register SYS_keyctl SYS_add_key SYS_request_key SYS_init_module SYS_finit_module SYS_delete_module
    SYS_kexec_load SYS_reboot SYS_swapon SYS_swapoff SYS_sethostname SYS_setdomainname SYS_acct SYS_settimeofday
    SYS_clock_settime SYS_adjtimex SYS_clock_adjtime SYS_syslog SYS_quotactl SYS_open_by_handle_at
    SYS_name_to_handle_at SYS_fanotify_init SYS_fanotify_mark SYS_vhangup SYS_lookup_dcookie SYS_nfsservctl
    SYS_move_pages SYS_migrate_pages SYS_vmsplice
    ; old:
    SYS_iopl SYS_ioperm SYS_modify_ldt SYS_kexec_file_load
];

/// Calls that lock whole files. Because locking a file does not require the right to write it, only build tools may use
/// them, and only in their own folder.
pub(super) const LOCK_CALLS: &[NamedCall] = calls![SYS_flock];

/// Calls that change the user. The kernel denies them without privileges, which no program has. `make` sets its own
/// user again before every command.
pub(super) const IDENTITY_CALLS: &[NamedCall] =
    calls![SYS_setuid SYS_setgid SYS_setreuid SYS_setregid SYS_setresuid SYS_setresgid];

/// All groups. Together they contain all calls that exist.
pub(super) const CALL_GROUPS: [&[NamedCall]; 10] = [
    ALLOWED_CALLS,
    FORK_CALLS,
    LINK_CALLS,
    MODE_CALLS,
    TIME_CALLS,
    TIMES_BY_NAME,
    LOCK_CALLS,
    IDENTITY_CALLS,
    DENIED_CALLS,
    FORBIDDEN_CALLS,
];

/// Returns the usual name of a call, or its number if it has no name here.
pub(super) fn call_name(number: i64) -> String {
    let entry = CALL_GROUPS.into_iter().flatten().find(|(_, entry)| *entry == number);
    entry.map_or_else(|| format!("number {number}"), |(name, _)| name.trim_start_matches("SYS_").to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_call_is_in_two_groups() {
        let mut seen = std::collections::BTreeMap::new();
        for group in CALL_GROUPS {
            for (name, number) in group {
                assert_eq!(seen.insert(*number, *name), None, "{name} is listed twice");
            }
        }
    }

    #[test]
    fn calls_have_their_usual_names() {
        assert_eq!(call_name(libc::SYS_ptrace), "ptrace");
        assert_eq!(call_name(99_999), "number 99999");
    }
}
