//! The seccomp filters: an allow list, refusals with an error number, and calls that end the program.
//!
//! Three kinds of filter are stacked; the kernel takes the strictest answer, in the order kill, error, announce,
//! allow. The first installed announces forbidden calls to the supervisor, which names the call and kills; where the
//! kernel cannot announce, the call kills by `SIGSYS`. The allow list comes last, because it also takes away the calls
//! that install filters. Every filter ends programs that use another architecture's calls (32-bit `int 0x80`); x32
//! numbers are on no list and so do not exist.

use std::collections::{BTreeMap, BTreeSet};
use std::io;

use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};

use super::{calls, sets};

/// Stands for "announce" while a filter is compiled, because the compiler does not know that action.
const ANNOUNCE_PLACEHOLDER: u16 = 0x5151;
const RETURN_CONSTANT: u16 = 0x06;
const ACTION_TRACE: u32 = 0x7ff0_0000;
const ACTION_ANNOUNCE: u32 = 0x7fc0_0000;

/// Flags of `clone` that make namespaces.
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

/// Commands for descriptors that concern nobody but their holder. Left out are those that have the kernel signal others
/// or make them wait (owner, signal, lease, notice), and the size of pipes.
const HARMLESS_COMMANDS: [u64; 9] = [
    libc::F_DUPFD as u64,
    libc::F_GETFD as u64,
    libc::F_SETFD as u64,
    libc::F_GETFL as u64,
    libc::F_SETFL as u64,
    libc::F_GETOWN as u64,
    libc::F_DUPFD_CLOEXEC as u64,
    libc::F_GETPIPE_SZ as u64,
    libc::F_GET_SEALS as u64,
];

/// Commands that lock parts of files, or ask who does.
pub(super) const LOCK_COMMANDS: [u64; 6] = [
    libc::F_GETLK as u64,
    libc::F_SETLK as u64,
    libc::F_SETLKW as u64,
    libc::F_OFD_GETLK as u64,
    libc::F_OFD_SETLK as u64,
    libc::F_OFD_SETLKW as u64,
];

/// Questions about a process whose number is the first argument.
const QUESTIONS: [i64; 6] = [
    libc::SYS_getsid,
    libc::SYS_getpgid,
    libc::SYS_sched_getaffinity,
    libc::SYS_sched_getparam,
    libc::SYS_sched_getscheduler,
    libc::SYS_get_robust_list,
];

/// Requests about terminals and descriptors that the C library and compilers make of any file.
const HARMLESS_REQUESTS: [u64; 8] = [
    libc::TCGETS,
    libc::TIOCGWINSZ,
    libc::TIOCGPGRP,
    libc::FIONREAD,
    libc::FIONBIO,
    libc::FIOCLEX,
    libc::FIONCLEX,
    0x802c_542a, // TCGETS2, which newer C libraries ask instead
];

/// `prctl` options that name a thread, ask, or make the process stricter.
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

/// What a set of filters is for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Purpose {
    /// Compilers may start processes, execute programs and make links within their folder.
    pub(super) tools: bool,
    /// Whether calls are announced to the supervisor rather than deadly by themselves.
    pub(super) announce: bool,
    /// The process that the filter will guard, the only one that it may signal; `None` when its signals are
    /// confined by other walls.
    pub(super) own_process: Option<i32>,
    /// The descriptor by which the program itself is executed, where calls are not announced. It is beyond the limit of
    /// descriptors, so that after that no file can ever be open under this number.
    pub(super) entrance: Option<u64>,
    /// Whether the program runs as a user of its own, whose permissions keep it from changing files of others.
    pub(super) own_user: bool,
}

/// The filters in the order of installation; the first is the one that announces.
pub(super) fn filters(purpose: Purpose) -> io::Result<Vec<BpfProgram>> {
    let mut filters = vec![forbidden(purpose)?];
    let mut refusals: BTreeMap<i32, Rules> = BTreeMap::new();
    let mut refuse = |errno: i32, call: i64, rules: Vec<SeccompRule>| {
        refusals.entry(errno).or_default().insert(call, rules);
    };
    for (_, call) in calls::REFUSED.iter().chain(calls::REFUSED_OLD) {
        let network = *call == libc::SYS_socket || *call == libc::SYS_socketpair;
        refuse(if network { libc::EACCES } else { libc::EPERM }, *call, Vec::new());
    }
    if !purpose.tools {
        for (_, call) in calls::LINKING.iter().chain(calls::LINKING_OLD).chain(calls::IDENTITY) {
            refuse(libc::EPERM, *call, Vec::new());
        }
    }
    if !(purpose.tools && purpose.own_user) {
        for (_, call) in calls::TIMES_OLD {
            refuse(libc::EPERM, *call, Vec::new());
        }
        // A build tool may set the times of a file that it has open (no path: a null pointer), which is what most do.
        let by_path = SeccompCondition::new(1, SeccompCmpArgLen::Qword, SeccompCmpOp::Ne, 0);
        let named = rule(vec![by_path.map_err(io::Error::other)?])?;
        refuse(libc::EPERM, libc::SYS_utimensat, if purpose.tools { vec![named] } else { Vec::new() });
        if !(purpose.tools && purpose.announce) {
            for (_, call) in calls::MODES.iter().chain(calls::MODES_OLD) {
                refuse(libc::EPERM, *call, Vec::new());
            }
        }
    }
    refuse(libc::ENOTTY, libc::SYS_ioctl, vec![all_differ(1, &HARMLESS_REQUESTS)?]);
    refuse(libc::EINVAL, libc::SYS_prctl, vec![all_differ(0, &HARMLESS_OPTIONS.map(|option| option as u64))?]);
    // Memory that is shared and in no file, and huge pages, are resident for nobody: no counter would show them.
    let unseen = (libc::MAP_ANONYMOUS | libc::MAP_SHARED) as u64;
    let huge = libc::MAP_HUGETLB as u64;
    refuse(libc::EPERM, libc::SYS_mmap, vec![masked(3, unseen, unseen)?, masked(3, huge, huge)?]);
    let asynchronous = vec![condition(1, SeccompCmpOp::Eq, libc::F_SETFL as u64)?, has(2, libc::O_ASYNC as u64)?];
    let lockable = purpose.tools && purpose.announce;
    let commands =
        if lockable { [&HARMLESS_COMMANDS[..], &LOCK_COMMANDS[..]].concat() } else { HARMLESS_COMMANDS.into() };
    refuse(libc::EPERM, libc::SYS_fcntl, vec![all_differ(1, &commands)?, rule(asynchronous)?]);
    if !lockable {
        for (_, call) in calls::LOCKS {
            refuse(libc::EPERM, *call, Vec::new());
        }
    }
    // Opening a file for reading only can empty it, and older Landlocks do not notice.
    let (mask, emptied) = ((libc::O_ACCMODE | libc::O_TRUNC) as u64, libc::O_TRUNC as u64);
    refuse(libc::EPERM, libc::SYS_openat, vec![masked(2, mask, emptied)?]);
    #[cfg(target_arch = "x86_64")]
    refuse(libc::EPERM, libc::SYS_open, vec![masked(1, mask, emptied)?]);
    // Flags ask whether bytes are in memory already.
    refuse(libc::EOPNOTSUPP, libc::SYS_preadv2, vec![all_differ(5, &[0])?]);
    refuse(libc::EOPNOTSUPP, libc::SYS_pwritev2, vec![all_differ(5, &[0])?]);
    // Without descriptors in common, open files could be hidden from the supervisor.
    refuse(libc::EINVAL, libc::SYS_close_range, vec![all_differ(2, &[0, u64::from(libc::CLOSE_RANGE_CLOEXEC)])?]);
    let own = purpose.own_process.map(|pid| pid as u64);
    refuse(libc::EPERM, libc::SYS_sched_setaffinity, vec![all_differ(0, &[0, own.unwrap_or(0)])?]);
    if let Some(pid) = own.filter(|_| !purpose.tools) {
        for call in QUESTIONS {
            refuse(libc::EPERM, call, vec![all_differ(0, &[0, pid])?]);
        }
        refuse(libc::EPERM, libc::SYS_getpriority, vec![all_differ(1, &[0, pid])?]);
    }
    refuse(libc::EPERM, libc::SYS_prlimit64, vec![all_differ(0, &[0, own.unwrap_or(0)])?]);
    if let Some(pid) = own {
        refuse(libc::EPERM, libc::SYS_kill, vec![all_differ(0, &[pid, 0])?]);
        refuse(libc::EPERM, libc::SYS_tgkill, vec![all_differ(0, &[pid])?]);
        refuse(libc::EPERM, libc::SYS_tkill, vec![all_differ(0, &[pid])?]);
    }
    for (errno, rules) in refusals {
        let action = SeccompAction::Errno(errno as u32);
        let (always, sometimes): (Rules, Rules) = rules.into_iter().partition(|(_, rules)| rules.is_empty());
        if !always.is_empty() {
            filters.push(set(always.into_keys().collect(), action.clone(), SeccompAction::Allow)?);
        }
        if !sometimes.is_empty() {
            filters.push(compile(sometimes, SeccompAction::Allow, action)?);
        }
    }
    filters.push(known()?);
    Ok(filters)
}

type Rules = BTreeMap<i64, Vec<SeccompRule>>;

/// Whatever is in some group gets past this filter; the others then decide. All else does not exist.
fn known() -> io::Result<BpfProgram> {
    let calls = calls::GROUPS.into_iter().flatten().map(|(_, call)| *call).collect();
    set(calls, SeccompAction::Allow, SeccompAction::Errno(libc::ENOSYS as u32))
}

/// The filter of the calls that end the program.
fn forbidden(purpose: Purpose) -> io::Result<BpfProgram> {
    let mut rules: Rules =
        calls::FORBIDDEN.iter().chain(calls::FORBIDDEN_OLD).map(|(_, call)| (*call, Vec::new())).collect();
    let mut clone = Vec::new();
    for flag in NAMESPACE_FLAGS {
        clone.push(rule(vec![condition(0, SeccompCmpOp::MaskedEq(flag), flag)?])?);
    }
    if !purpose.tools {
        rules.extend(calls::FORKING.iter().map(|(_, call)| (*call, Vec::new())));
        let threads = libc::CLONE_THREAD as u64;
        clone.push(rule(vec![condition(0, SeccompCmpOp::MaskedEq(threads), 0)?])?);
        // The supervisor lets the first one through, which starts the program itself. Where it hears nothing, only the
        // one by that descriptor gets past the filter.
        rules.insert(libc::SYS_execve, Vec::new());
        let entrance = purpose.entrance.map(|number| rule(vec![condition(0, SeccompCmpOp::Ne, number)?]));
        rules.insert(libc::SYS_execveat, entrance.into_iter().collect::<io::Result<_>>()?);
    }
    let parted = (libc::CLONE_THREAD | libc::CLONE_FILES) as u64;
    clone.push(masked(0, parted, libc::CLONE_THREAD as u64)?);
    rules.insert(libc::SYS_clone, clone);
    if purpose.tools && purpose.announce {
        // The supervisor looks where the file lies.
        rules.extend(calls::LOCKS.iter().map(|(_, call)| (*call, Vec::new())));
        let locks = LOCK_COMMANDS.iter().map(|command| rule(vec![condition(1, SeccompCmpOp::Eq, *command)?]));
        rules.insert(libc::SYS_fcntl, locks.collect::<io::Result<_>>()?);
    }
    if purpose.tools && purpose.announce && !purpose.own_user {
        // The supervisor changes the mode itself, in the working folder only.
        rules.extend(calls::MODES.iter().chain(calls::MODES_OLD).map(|(_, call)| (*call, Vec::new())));
    }
    let action =
        if purpose.announce { SeccompAction::Trace(ANNOUNCE_PLACEHOLDER.into()) } else { SeccompAction::KillProcess };
    let mut program = compile(rules, SeccompAction::Allow, action)?;
    for instruction in &mut program {
        if instruction.code == RETURN_CONSTANT && instruction.k == ACTION_TRACE | u32::from(ANNOUNCE_PLACEHOLDER) {
            instruction.k = ACTION_ANNOUNCE;
        }
    }
    Ok(program)
}

/// The filter of calls that need no look at their arguments.
fn set(calls: BTreeSet<i64>, inside: SeccompAction, outside: SeccompAction) -> io::Result<BpfProgram> {
    let frame = compile(Rules::new(), outside.clone(), inside.clone())?;
    sets::filter(&calls, inside, outside, frame)
}

fn compile(rules: Rules, otherwise: SeccompAction, matched: SeccompAction) -> io::Result<BpfProgram> {
    let machine = std::env::consts::ARCH.try_into().map_err(io::Error::other)?;
    SeccompFilter::new(rules, otherwise, matched, machine).and_then(BpfProgram::try_from).map_err(io::Error::other)
}

/// Matches when the argument is none of the values.
fn all_differ(argument: u8, values: &[u64]) -> io::Result<SeccompRule> {
    rule(values.iter().map(|value| condition(argument, SeccompCmpOp::Ne, *value)).collect::<io::Result<_>>()?)
}

/// Matches when the bits of the mask have this value.
fn masked(argument: u8, mask: u64, value: u64) -> io::Result<SeccompRule> {
    rule(vec![condition(argument, SeccompCmpOp::MaskedEq(mask), value)?])
}

/// Matches when the bit is set.
fn has(argument: u8, bit: u64) -> io::Result<SeccompCondition> {
    condition(argument, SeccompCmpOp::MaskedEq(bit), bit)
}

fn rule(conditions: Vec<SeccompCondition>) -> io::Result<SeccompRule> {
    SeccompRule::new(conditions).map_err(io::Error::other)
}

/// Compares the low 32 bits: these arguments are `int`s, and the kernel ignores what lies above.
fn condition(argument: u8, operator: SeccompCmpOp, value: u64) -> io::Result<SeccompCondition> {
    let value = value & u64::from(u32::MAX);
    SeccompCondition::new(argument, SeccompCmpArgLen::Dword, operator, value).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_calls_answer_as_the_compiler_does() {
        let lists: [BTreeSet<i64>; 4] = [
            calls::GROUPS.into_iter().flatten().map(|(_, call)| *call).collect(),
            calls::REFUSED.iter().chain(calls::REFUSED_OLD).map(|(_, call)| *call).collect(),
            BTreeSet::from([0, 1, 2, 5, 7, 8, 1023]),
            BTreeSet::new(),
        ];
        for list in lists {
            for (inside, outside) in
                [(SeccompAction::Allow, SeccompAction::Errno(38)), (SeccompAction::Errno(1), SeccompAction::Allow)]
            {
                let rules: Rules = list.iter().map(|call| (*call, Vec::new())).collect();
                let (ours, compiled) = (
                    set(list.clone(), inside.clone(), outside.clone()).unwrap(),
                    compile(rules, outside, inside).unwrap(),
                );
                let native = compiled[1].k;
                let numbers = (0..1200).chain((0..1200).map(|call| call | 0x4000_0000)).chain([u32::MAX, 1 << 31]);
                for call in numbers {
                    for architecture in [native, 0x4000_0003, 0] {
                        let answer = |program: &BpfProgram| sets::tests::run(program, call, architecture, [0; 6]);
                        assert_eq!(answer(&ours), answer(&compiled), "call {call:#x} of {architecture:#x}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_announcing_filter_has_no_placeholder_left() {
        for tools in [false, true] {
            let filters =
                filters(Purpose { tools, announce: true, own_process: Some(77), entrance: None, own_user: true })
                    .unwrap();
            let returns = |k: u32| filters[0].iter().any(|i| i.code == RETURN_CONSTANT && i.k == k);
            assert!(returns(ACTION_ANNOUNCE));
            assert!(filters.iter().flatten().all(|i| i.k != ACTION_TRACE | u32::from(ANNOUNCE_PLACEHOLDER)));
        }
    }

    #[test]
    fn without_announcements_forbidden_calls_kill() {
        let filters = filters(Purpose {
            tools: false,
            announce: false,
            own_process: Some(77),
            entrance: Some(99),
            own_user: true,
        })
        .unwrap();
        assert!(filters.iter().flatten().all(|instruction| instruction.k != ACTION_ANNOUNCE));
        assert!(
            filters[0].iter().any(|instruction| instruction.code == RETURN_CONSTANT && instruction.k == 0x8000_0000)
        );
    }
}
