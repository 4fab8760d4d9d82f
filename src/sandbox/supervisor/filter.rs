//! The seccomp filters: an allow list, refusals with an error number, and calls that end the program.
//!
//! Three kinds of filter are stacked; the kernel takes the strictest answer, in the order kill, error, announce,
//! allow. The first installed announces forbidden calls to the supervisor, which names the call and kills; where the
//! kernel cannot announce, the call kills by `SIGSYS`. The allow list comes last, because it also takes away the calls
//! that install filters. Every filter ends programs that use another architecture's calls (32-bit `int 0x80`); x32
//! numbers are on no list and so do not exist.

use std::collections::BTreeMap;
use std::io;

use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};

use super::calls;

/// Stands for "announce" while a filter is compiled, because the compiler does not know that action.
const ANNOUNCE_PLACEHOLDER: u16 = 0x5151;
const RETURN_CONSTANT: u16 = 0x06;
const ACTION_TRACE: u32 = 0x7ff0_0000;
const ACTION_ANNOUNCE: u32 = 0x7fc0_0000;

/// Flags of `clone` that make namespaces.
const NAMESPACE_FLAGS: [u64; 8] = [
    libc::CLONE_NEWNS as u64,
    libc::CLONE_NEWCGROUP as u64,
    libc::CLONE_NEWUTS as u64,
    libc::CLONE_NEWIPC as u64,
    libc::CLONE_NEWUSER as u64,
    libc::CLONE_NEWPID as u64,
    libc::CLONE_NEWNET as u64,
    0x80, // CLONE_NEWTIME
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
    let own = purpose.own_process.map(|pid| pid as u64);
    refuse(libc::EPERM, libc::SYS_prlimit64, vec![all_differ(0, &[0, own.unwrap_or(0)])?]);
    if let Some(pid) = own {
        refuse(libc::EPERM, libc::SYS_kill, vec![all_differ(0, &[pid, 0])?]);
        refuse(libc::EPERM, libc::SYS_tgkill, vec![all_differ(0, &[pid])?]);
        refuse(libc::EPERM, libc::SYS_tkill, vec![all_differ(0, &[pid])?]);
    }
    for (errno, rules) in refusals {
        filters.push(compile(rules, SeccompAction::Allow, SeccompAction::Errno(errno as u32))?);
    }
    filters.push(known()?);
    Ok(filters)
}

type Rules = BTreeMap<i64, Vec<SeccompRule>>;

/// Whatever is in some group gets past this filter; the others then decide. All else does not exist.
fn known() -> io::Result<BpfProgram> {
    let rules = calls::GROUPS.into_iter().flatten().map(|(_, call)| (*call, Vec::new())).collect();
    compile(rules, SeccompAction::Errno(libc::ENOSYS as u32), SeccompAction::Allow)
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
        if purpose.announce {
            // The supervisor lets the first one through, which starts the program itself.
            rules.insert(libc::SYS_execve, Vec::new());
            rules.insert(libc::SYS_execveat, Vec::new());
        }
    }
    rules.insert(libc::SYS_clone, clone);
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

fn compile(rules: Rules, otherwise: SeccompAction, matched: SeccompAction) -> io::Result<BpfProgram> {
    let machine = std::env::consts::ARCH.try_into().map_err(io::Error::other)?;
    SeccompFilter::new(rules, otherwise, matched, machine).and_then(BpfProgram::try_from).map_err(io::Error::other)
}

/// Matches when the argument is none of the values.
fn all_differ(argument: u8, values: &[u64]) -> io::Result<SeccompRule> {
    rule(values.iter().map(|value| condition(argument, SeccompCmpOp::Ne, *value)).collect::<io::Result<_>>()?)
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
    fn the_announcing_filter_has_no_placeholder_left() {
        for tools in [false, true] {
            let filters = filters(Purpose { tools, announce: true, own_process: Some(77), own_user: true }).unwrap();
            let returns = |k: u32| filters[0].iter().any(|i| i.code == RETURN_CONSTANT && i.k == k);
            assert!(returns(ACTION_ANNOUNCE));
            assert!(filters.iter().flatten().all(|i| i.k != ACTION_TRACE | u32::from(ANNOUNCE_PLACEHOLDER)));
        }
    }

    #[test]
    fn without_announcements_forbidden_calls_kill() {
        let filters =
            filters(Purpose { tools: false, announce: false, own_process: Some(77), own_user: true }).unwrap();
        assert!(filters.iter().flatten().all(|instruction| instruction.k != ACTION_ANNOUNCE));
        assert!(
            filters[0].iter().any(|instruction| instruction.code == RETURN_CONSTANT && instruction.k == 0x8000_0000)
        );
    }
}
