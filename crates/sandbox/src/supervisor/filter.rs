//! The seccomp filters. They allow the calls in a list, deny some calls with an error number, and kill the program for
//! others.
//!
//! There is a separate filter for each kind of answer. For a call, the strictest answer counts, in the order kill,
//! error, announce, allow. If answers are equal, the last filter's counts. Forbidden calls are announced to the
//! supervisor, which names the call and kills the program. The filter that announces is the first. If the kernel cannot
//! announce calls, a forbidden call kills the program with `SIGSYS`. The filter for calls that do not exist is
//! installed last, because it also removes the calls that install filters. Every filter kills programs that use another
//! architecture's calls (32-bit `int 0x80`); x32 numbers are in no group and therefore do not exist.

use std::{collections::BTreeMap, io};

use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};

use super::calls::{self, NamedCall};

/// A placeholder for the action "announce" while a filter is compiled, because the compiler does not support that
/// action.
const ANNOUNCE_PLACEHOLDER: u16 = 0x5151;
const RETURN_CONSTANT: u16 = 0x06;
const ACTION_ANNOUNCE: u32 = 0x7fc0_0000;

/// The flags of `clone` that create namespaces.
pub(super) const NAMESPACE_FLAGS: [u64; 8] = [
    libc::CLONE_NEWNS as u64,
    libc::CLONE_NEWCGROUP as u64,
    libc::CLONE_NEWUTS as u64,
    libc::CLONE_NEWIPC as u64,
    libc::CLONE_NEWUSER as u64,
    libc::CLONE_NEWPID as u64,
    libc::CLONE_NEWNET as u64,
    0x80, // CLONE_NEWTIME
];

/// Commands for descriptors that affect only the process that uses them. The list does not contain commands by which
/// the kernel sends signals to others or makes them wait (owner, signal, lease, notice). It does not contain the size
/// of pipes either, because all pipes become smaller if a user has many.
const HARMLESS_COMMANDS: [u64; 8] = [
    libc::F_DUPFD as u64,
    libc::F_GETFD as u64,
    libc::F_SETFD as u64,
    libc::F_GETFL as u64,
    libc::F_SETFL as u64,
    libc::F_GETOWN as u64,
    libc::F_DUPFD_CLOEXEC as u64,
    libc::F_GET_SEALS as u64,
];

/// Commands that lock parts of files, or that report which process holds a lock.
pub(super) const LOCK_COMMANDS: [u64; 6] = [
    libc::F_GETLK as u64,
    libc::F_SETLK as u64,
    libc::F_SETLKW as u64,
    libc::F_OFD_GETLK as u64,
    libc::F_OFD_SETLK as u64,
    libc::F_OFD_SETLKW as u64,
];

/// The calls that query a process. Their first argument is the process ID.
const PROCESS_QUERIES: [i64; 6] = [
    libc::SYS_getsid,
    libc::SYS_getpgid,
    libc::SYS_sched_getaffinity,
    libc::SYS_sched_getparam,
    libc::SYS_sched_getscheduler,
    libc::SYS_get_robust_list,
];

/// Advice about memory that affects only the caller. Numbers are used, because some C libraries have no names for them:
/// usual, random and sequential reading, needed or not, free, remove, for children, huge pages, dumps, populate, and
/// guards. The list does not contain advice that evicts, ages, merges or moves pages, because others would notice it,
/// or no counter would show it.
const HARMLESS_ADVICE: [u64; 20] = [0, 1, 2, 3, 4, 8, 9, 10, 11, 13, 14, 15, 16, 17, 18, 19, 22, 23, 102, 103];

/// The futex wait operations that may use shared memory, once for each clock that a timeout may use. The C library
/// needs them to wait for the end of a thread.
const SHARED_WAITS: [u64; 4] = [
    libc::FUTEX_WAIT as u64,
    libc::FUTEX_WAIT_BITSET as u64,
    (libc::FUTEX_WAIT | libc::FUTEX_CLOCK_REALTIME) as u64,
    (libc::FUTEX_WAIT_BITSET | libc::FUTEX_CLOCK_REALTIME) as u64,
];

/// Operations that wake threads which wait for a shared futex word. The supervisor itself notices that a word has
/// changed, so these calls need no effect.
const SHARED_WAKES: [u64; 2] = [libc::FUTEX_WAKE as u64, libc::FUTEX_WAKE_BITSET as u64];

/// Requests about terminals and descriptors that the C library and compilers send for any file.
const HARMLESS_REQUESTS: [u64; 8] = [
    libc::TCGETS,
    libc::TIOCGWINSZ,
    libc::TIOCGPGRP,
    libc::FIONREAD,
    libc::FIONBIO,
    libc::FIOCLEX,
    libc::FIONCLEX,
    0x802c_542a, // TCGETS2, which newer C libraries use instead
];

/// Options of `prctl` that name a thread, query something, or restrict the process.
const HARMLESS_OPTIONS: [i32; 10] = [
    libc::PR_SET_NAME,
    libc::PR_GET_NAME,
    libc::PR_GET_DUMPABLE,
    libc::PR_GET_NO_NEW_PRIVS,
    libc::PR_SET_NO_NEW_PRIVS,
    libc::PR_GET_SECCOMP,
    libc::PR_CAPBSET_READ,
    libc::PR_GET_PDEATHSIG,
    libc::PR_SET_VMA,
    libc::PR_GET_TIMERSLACK,
];

/// The purpose of a set of filters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Purpose {
    /// Whether the program is a build tool. Build tools may start processes, execute programs, and create links within
    /// their folder.
    pub(super) tools: bool,
    /// Whether forbidden calls are announced to the supervisor instead of killing the program.
    pub(super) announce: bool,
    /// The process to which the filter applies. It may send signals only to itself. `None` if other layers restrict its
    /// signals.
    pub(super) own_process: Option<i32>,
    /// The descriptor from which the program itself is executed, if calls are not announced. Its number is beyond the
    /// limit of descriptors, so no other file can get it.
    pub(super) entry_file: Option<u64>,
    /// Whether the program runs as its own user, so that permissions protect other users' files.
    pub(super) own_user: bool,
}

/// Returns the filters in the order in which they are installed. The first one announces calls.
pub(super) fn compile_filters(purpose: Purpose) -> io::Result<Vec<BpfProgram>> {
    let strictest = if purpose.announce { announce() } else { SeccompAction::KillProcess };
    let mut filters = vec![compile(forbidden_rules(purpose)?, strictest, SeccompAction::Allow)?];
    for instruction in &mut filters[0] {
        if instruction.code == RETURN_CONSTANT && instruction.k == u32::from(announce()) {
            instruction.k = ACTION_ANNOUNCE;
        }
    }
    for (errno, rules) in denial_rules(purpose)? {
        filters.push(compile(rules, SeccompAction::Errno(errno as u32), SeccompAction::Allow)?);
    }
    // If a call is in any group, it exists, and the earlier filters decide about it. Other calls do not exist.
    let existing = calls::CALL_GROUPS.into_iter().flatten().map(|(_, call)| (*call, Vec::new())).collect();
    filters.push(compile(existing, SeccompAction::Allow, SeccompAction::Errno(libc::ENOSYS as u32))?);
    Ok(filters)
}

/// Returns the calls that are denied, by their error numbers. The number 0 means that a call succeeds without any
/// effect.
fn denial_rules(purpose: Purpose) -> io::Result<BTreeMap<i32, CallRules>> {
    let mut refusals: BTreeMap<i32, CallRules> = BTreeMap::new();
    let mut refuse = |errno: i32, call: i64, rules: Vec<SeccompRule>| {
        refusals.entry(errno).or_default().insert(call, rules);
    };
    let own_files = purpose.tools && purpose.own_user;
    // If the program is a build tool, the supervisor decides about these calls.
    let supervised = purpose.tools && purpose.announce;
    for (group, is_rejected) in [
        (calls::DENIED_CALLS, true),
        (calls::LINK_CALLS, !purpose.tools),
        (calls::IDENTITY_CALLS, !purpose.tools),
        (calls::TIMES_BY_NAME, !own_files),
        (calls::MODE_CALLS, !own_files && !supervised),
        (calls::LOCK_CALLS, !supervised),
    ] {
        for (_, call) in group.iter().filter(|_| is_rejected) {
            let network = *call == libc::SYS_socket || *call == libc::SYS_socketpair;
            refuse(if network { libc::EACCES } else { libc::EPERM }, *call, Vec::new());
        }
    }
    if !own_files {
        // A build tool may set the times of a file that it has open, in which case the path is null. Most tools do it
        // in this way.
        let named = is_not_null(1)?;
        refuse(libc::EPERM, libc::SYS_utimensat, if purpose.tools { vec![named] } else { Vec::new() });
    }
    // Futex words in the pages of a file are shared by all processes that map the file, so a word in a library would
    // wake threads of other runs.
    let private = libc::FUTEX_PRIVATE_FLAG as u64;
    let harmless = if purpose.announce { [&SHARED_WAITS[..], &SHARED_WAKES].concat() } else { SHARED_WAITS.into() };
    let shared = std::iter::once(condition(1, SeccompCmpOp::MaskedEq(private), 0)).chain(differs_from(1, &harmless));
    refuse(libc::EPERM, libc::SYS_futex, vec![rule(shared.collect::<io::Result<_>>()?)?]);
    if purpose.announce {
        refuse(0, libc::SYS_futex, match_each(1, &SHARED_WAKES)?);
    }
    refuse(libc::EINVAL, libc::SYS_madvise, vec![all_differ(2, &HARMLESS_ADVICE)?]);
    refuse(libc::ENOTTY, libc::SYS_ioctl, vec![all_differ(1, &HARMLESS_REQUESTS)?]);
    refuse(libc::EINVAL, libc::SYS_prctl, vec![all_differ(0, &HARMLESS_OPTIONS.map(|option| option as u64))?]);
    // Shared memory outside of files, and huge pages, are not resident for any process, so no counter would show them.
    let unseen = (libc::MAP_ANONYMOUS | libc::MAP_SHARED) as u64;
    let huge = libc::MAP_HUGETLB as u64;
    refuse(libc::EPERM, libc::SYS_mmap, vec![mask_rule(3, unseen, unseen)?, mask_rule(3, huge, huge)?]);
    let flag = libc::O_ASYNC as u64;
    let asynchronous =
        vec![condition(1, SeccompCmpOp::Eq, libc::F_SETFL as u64)?, condition(2, SeccompCmpOp::MaskedEq(flag), flag)?];
    let commands =
        if supervised { [&HARMLESS_COMMANDS[..], &LOCK_COMMANDS[..]].concat() } else { HARMLESS_COMMANDS.into() };
    refuse(libc::EPERM, libc::SYS_fcntl, vec![all_differ(1, &commands)?, rule(asynchronous)?]);
    // Opening a file for reading can truncate it. Older versions of Landlock do not prevent that.
    let (mask, emptied) = ((libc::O_ACCMODE | libc::O_TRUNC) as u64, libc::O_TRUNC as u64);
    refuse(libc::EPERM, libc::SYS_openat, vec![mask_rule(2, mask, emptied)?]);
    #[cfg(target_arch = "x86_64")]
    refuse(libc::EPERM, libc::SYS_open, vec![mask_rule(1, mask, emptied)?]);
    // If threads could stop sharing descriptors, they could hide open files from the supervisor.
    refuse(libc::EINVAL, libc::SYS_close_range, vec![all_differ(2, &[0, u64::from(libc::CLOSE_RANGE_CLOEXEC)])?]);
    for (errno, call, rules) in denials_for_others(purpose)? {
        refuse(errno, call, rules);
    }
    Ok(refusals)
}

/// Returns the denials of calls that name a process other than the caller. Each has the error number, the call, and the
/// rules.
fn denials_for_others(purpose: Purpose) -> io::Result<Vec<(i32, i64, Vec<SeccompRule>)>> {
    let own = purpose.own_process.map(|pid| pid as u64);
    let mut refusals = vec![
        (libc::EPERM, libc::SYS_sched_setaffinity, vec![all_differ(0, &[0, own.unwrap_or(0)])?]),
        (libc::EPERM, libc::SYS_prlimit64, vec![all_differ(0, &[0, own.unwrap_or(0)])?]),
    ];
    if let Some(pid) = own {
        refusals.push((libc::EPERM, libc::SYS_kill, vec![all_differ(0, &[pid, 0])?]));
        refusals.push((libc::EPERM, libc::SYS_tgkill, vec![all_differ(0, &[pid])?]));
        refusals.push((libc::EPERM, libc::SYS_tkill, vec![all_differ(0, &[pid])?]));
    }
    if let Some(pid) = own.filter(|_| !purpose.tools) {
        for call in PROCESS_QUERIES {
            // The argument may also be a thread ID. The C library does not need `sched_getaffinity`, so that call fails
            // as if it did not exist.
            let errno = if call == libc::SYS_sched_getaffinity { libc::ENOSYS } else { libc::EPERM };
            refusals.push((errno, call, vec![all_differ(0, &[0, pid])?]));
        }
        refusals.push((libc::EPERM, libc::SYS_getpriority, vec![all_differ(1, &[0, pid])?]));
    }
    Ok(refusals)
}

type CallRules = BTreeMap<i64, Vec<SeccompRule>>;

/// Returns the calls for which the program is killed, and those about which the supervisor decides.
fn forbidden_rules(purpose: Purpose) -> io::Result<CallRules> {
    let always = |group: &[NamedCall]| group.iter().map(|(_, call)| (*call, Vec::new())).collect::<CallRules>();
    let mut rules = always(calls::FORBIDDEN_CALLS);
    let mut clone = NAMESPACE_FLAGS.map(|flag| mask_rule(0, flag, flag)).into_iter().collect::<io::Result<Vec<_>>>()?;
    if !purpose.tools {
        rules.extend(always(calls::FORK_CALLS));
        clone.push(mask_rule(0, libc::CLONE_THREAD as u64, 0)?);
        // The supervisor allows the first execution, which starts the program itself. Without a listener, the filter
        // allows executions only from the reserved descriptor.
        rules.insert(libc::SYS_execve, Vec::new());
        let entry_file = purpose.entry_file.map(|number| all_differ(0, &[number]));
        rules.insert(libc::SYS_execveat, entry_file.into_iter().collect::<io::Result<_>>()?);
    }
    let parted = (libc::CLONE_THREAD | libc::CLONE_FILES) as u64;
    clone.push(mask_rule(0, parted, libc::CLONE_THREAD as u64)?);
    rules.insert(libc::SYS_clone, clone);
    if purpose.announce {
        // The supervisor answers these calls itself, so that other runs cannot end the wait for a thread.
        rules.insert(libc::SYS_futex, match_each(1, &SHARED_WAITS)?);
    }
    if purpose.tools && purpose.announce {
        // The supervisor checks where the file is.
        rules.extend(always(calls::LOCK_CALLS));
        rules.insert(libc::SYS_fcntl, match_each(1, &LOCK_COMMANDS)?);
    }
    if purpose.tools && purpose.announce && !purpose.own_user {
        // The supervisor itself changes the mode, and only in the working folder.
        rules.extend(always(calls::MODE_CALLS));
    }
    Ok(rules)
}

/// Returns the placeholder for the action "announce" while a filter is compiled.
fn announce() -> SeccompAction {
    SeccompAction::Trace(ANNOUNCE_PLACEHOLDER.into())
}

/// Compiles a filter. Its answer is `matched` for calls that match a rule, and `otherwise` for all others.
fn compile(rules: CallRules, matched: SeccompAction, otherwise: SeccompAction) -> io::Result<BpfProgram> {
    let machine = std::env::consts::ARCH.try_into().map_err(io::Error::other)?;
    let filter = SeccompFilter::new(rules, otherwise, matched, machine);
    filter.and_then(BpfProgram::try_from).map_err(io::Error::other)
}

/// Returns a rule that matches if the argument has none of these values.
fn all_differ(argument: u8, values: &[u64]) -> io::Result<SeccompRule> {
    rule(differs_from(argument, values).collect::<io::Result<_>>()?)
}

fn differs_from(argument: u8, values: &[u64]) -> impl Iterator<Item = io::Result<SeccompCondition>> {
    values.iter().map(move |value| condition(argument, SeccompCmpOp::Ne, *value))
}

/// Returns rules that match if the argument has one of these values.
fn match_each(argument: u8, values: &[u64]) -> io::Result<Vec<SeccompRule>> {
    values.iter().map(|value| rule(vec![condition(argument, SeccompCmpOp::Eq, *value)?])).collect()
}

/// Returns a rule that matches if the argument is not a null pointer.
fn is_not_null(argument: u8) -> io::Result<SeccompRule> {
    let given = SeccompCondition::new(argument, SeccompCmpArgLen::Qword, SeccompCmpOp::Ne, 0);
    rule(vec![given.map_err(io::Error::other)?])
}

/// Returns a rule that matches if the bits of `mask` in the argument have the given value.
fn mask_rule(argument: u8, mask: u64, value: u64) -> io::Result<SeccompRule> {
    rule(vec![condition(argument, SeccompCmpOp::MaskedEq(mask), value)?])
}

fn rule(conditions: Vec<SeccompCondition>) -> io::Result<SeccompRule> {
    SeccompRule::new(conditions).map_err(io::Error::other)
}

/// Returns a condition on the low 32 bits of the argument. These arguments are of the type `int`, so the kernel ignores
/// the higher bits.
fn condition(argument: u8, operator: SeccompCmpOp, value: u64) -> io::Result<SeccompCondition> {
    let value = value & u64::from(u32::MAX);
    SeccompCondition::new(argument, SeccompCmpArgLen::Dword, operator, value).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_announcing_filter_has_no_placeholder_left() {
        for tools in [false, true] {
            let filters = compile_filters(Purpose {
                tools,
                announce: true,
                own_process: Some(77),
                entry_file: None,
                own_user: true,
            })
            .unwrap();
            let returns = |k: u32| filters[0].iter().any(|i| i.code == RETURN_CONSTANT && i.k == k);
            assert!(returns(ACTION_ANNOUNCE));
            assert!(filters.iter().flatten().all(|i| i.k != u32::from(announce())));
        }
    }

    #[test]
    fn without_announcements_forbidden_calls_kill() {
        let filters = compile_filters(Purpose {
            tools: false,
            announce: false,
            own_process: Some(77),
            entry_file: Some(99),
            own_user: true,
        })
        .unwrap();
        assert!(filters.iter().flatten().all(|instruction| instruction.k != ACTION_ANNOUNCE));
        assert!(
            filters[0].iter().any(|instruction| instruction.code == RETURN_CONSTANT && instruction.k == 0x8000_0000)
        );
    }
}
