//! The seccomp filters: an allow list, refusals with an error number, and calls that end the program.
//!
//! Rules come in layers; the strictest answer counts, in the order kill, error, announce, allow. Forbidden calls are
//! announced to the supervisor, which names the call and kills; that filter is installed first. Where the kernel cannot
//! announce, the call kills by `SIGSYS`. All other layers make one filter, which comes last, because its allow list
//! also takes away the calls that install filters. Every filter ends programs that use another architecture's calls
//! (32-bit `int 0x80`); x32 numbers are on no list and so do not exist.

use std::{collections::BTreeMap, io};

use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};

use super::{
    calls::{self, Call},
    search::{self, Answer},
};

/// Stands for "announce" while a filter is compiled, because the compiler does not know that action.
const ANNOUNCE_PLACEHOLDER: u16 = 0x5151;
const RETURN_CONSTANT: u16 = 0x06;
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
/// or make them wait (owner, signal, lease, notice), and the size of pipes, which
/// shrinks when a user has many.
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

/// Calls that name a clock in their first argument.
const CLOCKS: [i64; 4] =
    [libc::SYS_clock_gettime, libc::SYS_clock_getres, libc::SYS_clock_nanosleep, libc::SYS_timerfd_create];

/// Advice about memory that concerns nobody but the caller, by number, because not every C library knows all: usual,
/// random and sequential reading, needed or not, free, remove, for children, huge pages, dumps, populate, and guards.
/// Left out are those that have pages of files or of memory leave, age, merge or move, which others would notice or no
/// counter shows.
const HARMLESS_ADVICE: [u64; 20] = [0, 1, 2, 3, 4, 8, 9, 10, 11, 13, 14, 15, 16, 17, 18, 19, 22, 23, 102, 103];

/// Barriers among the threads of one process, and the question which there are.
const OWN_BARRIERS: [u64; 7] = [0, 8, 16, 32, 64, 128, 256];

/// Waits for a word that may be shared, which the C library needs to wait for the end of a thread: with the clocks that
/// a limit of time may be by.
const SHARED_WAITS: [u64; 4] = [
    libc::FUTEX_WAIT as u64,
    libc::FUTEX_WAIT_BITSET as u64,
    (libc::FUTEX_WAIT | libc::FUTEX_CLOCK_REALTIME) as u64,
    (libc::FUTEX_WAIT_BITSET | libc::FUTEX_CLOCK_REALTIME) as u64,
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

/// The purpose of a set of filters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    let (forbidden, mut layers) = (forbidden(purpose)?, refusals(purpose)?);
    let allow: u32 = SeccompAction::Allow.into();
    let mut filters = Vec::new();
    if purpose.announce {
        let announced = joined(forbidden.keys().copied(), &[(forbidden.clone(), announce())])?;
        filters.push(search::filter(&announced, allow, frame()?)?);
    } else {
        layers.insert(0, (forbidden, SeccompAction::KillProcess));
    }
    // A call that is in some group exists, and the layers decide. All else does not.
    let known = calls::GROUPS.into_iter().flatten().map(|(_, call)| *call);
    filters.push(search::filter(&joined(known, &layers)?, SeccompAction::Errno(libc::ENOSYS as u32).into(), frame()?)?);
    for instruction in filters.iter_mut().flatten() {
        if instruction.code == RETURN_CONSTANT && instruction.k == u32::from(announce()) {
            instruction.k = ACTION_ANNOUNCE;
        }
    }
    Ok(filters)
}

/// Rules with the answer to matching calls; calls without rules always match.
type Layer = (CallRules, SeccompAction);

/// The answer to each of these calls by layers; the first layer that matches decides.
fn joined(calls: impl Iterator<Item = i64>, layers: &[Layer]) -> io::Result<BTreeMap<u32, Answer>> {
    let mut answers = BTreeMap::new();
    for call in calls {
        let mut asked = Vec::new();
        let mut at_last = SeccompAction::Allow;
        for (rules, action) in layers {
            match rules.get(&call) {
                None => {}
                Some(always) if always.is_empty() => {
                    at_last = action.clone();
                    break;
                }
                Some(rules) => {
                    let program = compile(CallRules::from([(call, rules.clone())]), action.clone())?;
                    asked.push(search::without_number(program, &frame()?));
                }
            }
        }
        let at_last = u32::from(at_last);
        let answer = match asked.is_empty() {
            true => Answer::Constant(at_last),
            false => {
                asked.push(vec![search::answer(at_last)]);
                Answer::Asked(asked)
            }
        };
        answers.insert(u32::try_from(call).map_err(io::Error::other)?, answer);
    }
    Ok(answers)
}

/// The layers of refusals. The largest error number comes first.
fn refusals(purpose: Purpose) -> io::Result<Vec<Layer>> {
    let mut refusals: BTreeMap<i32, CallRules> = BTreeMap::new();
    let mut refuse = |errno: i32, call: i64, rules: Vec<SeccompRule>| {
        refusals.entry(errno).or_default().insert(call, rules);
    };
    let own_files = purpose.tools && purpose.own_user;
    // The supervisor decides about these in a build tool's stead.
    let asked = purpose.tools && purpose.announce;
    for (group, is_refused) in [
        (calls::REFUSED, true),
        (calls::LINKING, !purpose.tools),
        (calls::IDENTITY, !purpose.tools),
        (calls::TIMES_BY_NAME, !own_files),
        (calls::MODES, !own_files && !asked),
        (calls::LOCKS, !asked),
    ] {
        for (_, call) in group.iter().filter(|_| is_refused) {
            let network = *call == libc::SYS_socket || *call == libc::SYS_socketpair;
            refuse(if network { libc::EACCES } else { libc::EPERM }, *call, Vec::new());
        }
    }
    if !own_files {
        // A build tool may set the times of a file that it has open (no path: a null pointer), which is what most do.
        let named = given(1)?;
        refuse(libc::EPERM, libc::SYS_utimensat, if purpose.tools { vec![named] } else { Vec::new() });
    }
    // Words in a file's pages are the same words for everybody who maps it: a library's would wake other runs.
    let private = libc::FUTEX_PRIVATE_FLAG as u64;
    let shared = std::iter::once(condition(1, SeccompCmpOp::MaskedEq(private), 0)).chain(differ(1, &SHARED_WAITS));
    refuse(libc::EPERM, libc::SYS_futex, vec![rule(shared.collect::<io::Result<_>>()?)?]);
    refuse(libc::EINVAL, libc::SYS_madvise, vec![all_differ(2, &HARMLESS_ADVICE)?]);
    refuse(libc::EINVAL, libc::SYS_membarrier, vec![all_differ(0, &OWN_BARRIERS)?]);
    let others = clocks_of_others(purpose.own_process)?;
    for call in CLOCKS {
        refuse(libc::EINVAL, call, vec![others.clone()]);
    }
    // The last argument of both asks for the counters of children.
    refuse(libc::EPERM, libc::SYS_waitid, vec![given(4)?]);
    if !asked {
        refuse(libc::EPERM, libc::SYS_wait4, vec![given(3)?]);
    }
    refuse(libc::ENOTTY, libc::SYS_ioctl, vec![all_differ(1, &HARMLESS_REQUESTS)?]);
    refuse(libc::EINVAL, libc::SYS_prctl, vec![all_differ(0, &HARMLESS_OPTIONS.map(|option| option as u64))?]);
    // Memory that is shared and in no file, and huge pages, are resident for nobody: no counter would show them.
    let unseen = (libc::MAP_ANONYMOUS | libc::MAP_SHARED) as u64;
    let huge = libc::MAP_HUGETLB as u64;
    refuse(libc::EPERM, libc::SYS_mmap, vec![masked(3, unseen, unseen)?, masked(3, huge, huge)?]);
    let flag = libc::O_ASYNC as u64;
    let asynchronous =
        vec![condition(1, SeccompCmpOp::Eq, libc::F_SETFL as u64)?, condition(2, SeccompCmpOp::MaskedEq(flag), flag)?];
    let commands = if asked { [&HARMLESS_COMMANDS[..], &LOCK_COMMANDS[..]].concat() } else { HARMLESS_COMMANDS.into() };
    refuse(libc::EPERM, libc::SYS_fcntl, vec![all_differ(1, &commands)?, rule(asynchronous)?]);
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
    for (errno, call, rules) in on_others(purpose)? {
        refuse(errno, call, rules);
    }
    Ok(refusals.into_iter().rev().map(|(errno, rules)| (rules, SeccompAction::Errno(errno as u32))).collect())
}

/// Refusals of calls that name a process, unless it is the caller: error number, call, rules.
fn on_others(purpose: Purpose) -> io::Result<Vec<(i32, i64, Vec<SeccompRule>)>> {
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
        for call in QUESTIONS {
            // A thread of its own has a number, too: the C library does without this answer if there is no such call.
            let errno = if call == libc::SYS_sched_getaffinity { libc::ENOSYS } else { libc::EPERM };
            refusals.push((errno, call, vec![all_differ(0, &[0, pid])?]));
        }
        refusals.push((libc::EPERM, libc::SYS_getpriority, vec![all_differ(1, &[0, pid])?]));
    }
    Ok(refusals)
}

type CallRules = BTreeMap<i64, Vec<SeccompRule>>;

/// Which calls end the program, or are the supervisor's to decide.
fn forbidden(purpose: Purpose) -> io::Result<CallRules> {
    let always = |group: &[Call]| group.iter().map(|(_, call)| (*call, Vec::new())).collect::<CallRules>();
    let mut rules = always(calls::FORBIDDEN);
    let mut clone = NAMESPACE_FLAGS.map(|flag| masked(0, flag, flag)).into_iter().collect::<io::Result<Vec<_>>>()?;
    if !purpose.tools {
        rules.extend(always(calls::FORKING));
        clone.push(masked(0, libc::CLONE_THREAD as u64, 0)?);
        // The supervisor lets the first one through, which starts the program itself. Where it hears nothing, only the
        // one by that descriptor gets past the filter.
        rules.insert(libc::SYS_execve, Vec::new());
        let entrance = purpose.entrance.map(|number| all_differ(0, &[number]));
        rules.insert(libc::SYS_execveat, entrance.into_iter().collect::<io::Result<_>>()?);
    }
    let parted = (libc::CLONE_THREAD | libc::CLONE_FILES) as u64;
    clone.push(masked(0, parted, libc::CLONE_THREAD as u64)?);
    rules.insert(libc::SYS_clone, clone);
    if purpose.announce {
        // The supervisor answers itself: what the machine has, without what others use of it; and that a thread may
        // have ended, without a wait that others could end.
        rules.insert(libc::SYS_sysinfo, Vec::new());
        rules.insert(libc::SYS_futex, each(1, &SHARED_WAITS)?);
    }
    if purpose.tools && purpose.announce {
        // The supervisor looks who asks for counters.
        rules.insert(libc::SYS_wait4, vec![given(3)?]);
        // The supervisor looks where the file lies.
        rules.extend(always(calls::LOCKS));
        rules.insert(libc::SYS_fcntl, each(1, &LOCK_COMMANDS)?);
    }
    if purpose.tools && purpose.announce && !purpose.own_user {
        // The supervisor changes the mode itself, in the working folder only.
        rules.extend(always(calls::MODES));
    }
    Ok(rules)
}

/// Stands for the announcement as long as a filter is compiled.
fn announce() -> SeccompAction {
    SeccompAction::Trace(ANNOUNCE_PLACEHOLDER.into())
}

/// A filter that looks at the architecture only.
fn frame() -> io::Result<BpfProgram> {
    compile(CallRules::new(), SeccompAction::Log)
}

fn compile(rules: CallRules, matched: SeccompAction) -> io::Result<BpfProgram> {
    let machine = std::env::consts::ARCH.try_into().map_err(io::Error::other)?;
    let filter = SeccompFilter::new(rules, SeccompAction::Allow, matched, machine);
    filter.and_then(BpfProgram::try_from).map_err(io::Error::other)
}

/// Matches when the argument is none of the values.
fn all_differ(argument: u8, values: &[u64]) -> io::Result<SeccompRule> {
    rule(differ(argument, values).collect::<io::Result<_>>()?)
}

fn differ(argument: u8, values: &[u64]) -> impl Iterator<Item = io::Result<SeccompCondition>> {
    values.iter().map(move |value| condition(argument, SeccompCmpOp::Ne, *value))
}

/// Rules that match when the argument is one of the values.
fn each(argument: u8, values: &[u64]) -> io::Result<Vec<SeccompRule>> {
    values.iter().map(|value| rule(vec![condition(argument, SeccompCmpOp::Eq, *value)?])).collect()
}

/// Matches when the argument is no null pointer.
fn given(argument: u8) -> io::Result<SeccompRule> {
    let given = SeccompCondition::new(argument, SeccompCmpArgLen::Qword, SeccompCmpOp::Ne, 0);
    rule(vec![given.map_err(io::Error::other)?])
}

/// Matches clocks that count the time of another process, or are a device. Negative numbers hold a process or a thread
/// in their upper bits, 0 for the caller, and the kind of clock in the lowest two; bit 2 says that it is a thread, and
/// the kernel answers for those of the same process only.
fn clocks_of_others(own: Option<i32>) -> io::Result<SeccompRule> {
    const NEGATIVE: u64 = 1 << 31;
    const THREAD: u64 = 4;
    let of = |process: i32| (0..3).map(move |kind| (!process << 3 | kind) as u32 as u64);
    let own: Vec<u64> = std::iter::once(0).chain(own).flat_map(of).collect();
    let kind = [SeccompCmpOp::MaskedEq(NEGATIVE), SeccompCmpOp::MaskedEq(THREAD)].into_iter().zip([NEGATIVE, 0]);
    let kind = kind.map(|(operator, value)| condition(0, operator, value));
    rule(kind.chain(differ(0, &own)).collect::<io::Result<_>>()?)
}

/// Matches when the bits of the mask have this value.
fn masked(argument: u8, mask: u64, value: u64) -> io::Result<SeccompRule> {
    rule(vec![condition(argument, SeccompCmpOp::MaskedEq(mask), value)?])
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

    /// The kernel's answer for filters that are installed one after the other: the strictest one, of equals the latest.
    fn stacked(filters: &[BpfProgram], call: u32, architecture: u32, arguments: [u64; 6]) -> u32 {
        let answers = filters.iter().rev().map(|filter| search::tests::run(filter, call, architecture, arguments));
        // The action is the upper half, and killing a process is negative.
        answers.min_by_key(|answer| (answer & 0xffff_0000).cast_signed()).unwrap()
    }

    /// One filter for each layer, as the compiler makes them.
    fn by_layers(purpose: Purpose) -> Vec<BpfProgram> {
        let action = if purpose.announce { announce() } else { SeccompAction::KillProcess };
        let mut filters = vec![compile(forbidden(purpose).unwrap(), action).unwrap()];
        filters.extend(
            refusals(purpose).unwrap().into_iter().rev().map(|(rules, action)| compile(rules, action).unwrap()),
        );
        let known = calls::GROUPS.into_iter().flatten().map(|(_, call)| (*call, Vec::new())).collect();
        let mut known = compile(known, SeccompAction::Log).unwrap();
        let (allow, log) = (u32::from(SeccompAction::Allow), u32::from(SeccompAction::Log));
        for instruction in known.iter_mut().filter(|instruction| instruction.code == RETURN_CONSTANT) {
            instruction.k = match instruction.k {
                answer if answer == log => allow,
                answer if answer == allow => SeccompAction::Errno(libc::ENOSYS as u32).into(),
                other => other,
            };
        }
        filters.push(known);
        let placeholder = u32::from(announce());
        for instruction in filters.iter_mut().flatten().filter(|instruction| instruction.k == placeholder) {
            instruction.k = ACTION_ANNOUNCE;
        }
        filters
    }

    #[test]
    fn the_search_answers_as_the_layers_do() {
        let entrance = |announce: bool| (!announce).then_some(99);
        let cases =
            [(false, true, true), (false, false, true), (true, true, true), (true, true, false), (true, false, false)];
        for (tools, announce, own_user) in cases {
            let own_process = (!tools).then_some(77);
            let purpose = Purpose { tools, announce, own_process, entrance: entrance(announce), own_user };
            let (ours, layers) = (filters(purpose).unwrap(), by_layers(purpose));
            assert!(ours.len() <= 2 && ours.iter().all(|filter| filter.len() < 4096));
            let native = layers[0][1].k;
            let mut words: Vec<u64> =
                NAMESPACE_FLAGS.into_iter().chain(HARMLESS_COMMANDS).chain(LOCK_COMMANDS).collect();
            words.extend(HARMLESS_REQUESTS.iter().chain(&HARMLESS_OPTIONS.map(|option| option as u64)));
            words.extend([20, 21, 102, 128, 129, 137].into_iter().chain(SHARED_WAITS));
            // The clocks of processes 0, 77 and 78, and of a thread.
            words.extend(
                [!0 << 3 | 2, !77 << 3 | 2, !78 << 3 | 2, !78 << 3 | 6]
                    .map(|clock: i32| u64::from(clock.cast_unsigned())),
            );
            words.extend([0, 1, 2, 3, 77, 99, 1 << 32, u64::MAX, u64::from(u32::MAX)]);
            words.extend([libc::CLONE_THREAD, libc::CLONE_THREAD | libc::CLONE_FILES].map(|flags| flags as u64));
            words.extend([libc::O_TRUNC, libc::O_TRUNC | libc::O_RDWR, libc::MAP_HUGETLB].map(|flags| flags as u64));
            words.extend(
                [libc::MAP_ANONYMOUS | libc::MAP_SHARED, libc::MAP_SHARED, libc::O_ASYNC].map(|flags| flags as u64),
            );
            // x32 numbers, and the largest.
            let strange = (0..600).map(|call| call | 0x4000_0000).chain([u32::MAX, 1 << 31]);
            for call in (0..500).chain(strange) {
                let agree = |architecture, arguments| {
                    let (ours, theirs) = (
                        stacked(&ours, call, architecture, arguments),
                        stacked(&layers, call, architecture, arguments),
                    );
                    assert_eq!(ours, theirs, "call {call:#x} of {architecture:#x} with {arguments:x?}, {purpose:?}");
                };
                [0x4000_0003, 0].into_iter().for_each(|architecture| agree(architecture, [0; 6]));
                let words: &[u64] = if call < 500 { &words } else { &[0] };
                for word in words {
                    agree(native, [*word; 6]);
                    agree(native, [*word, libc::F_SETFL as u64, *word, *word, *word, 0]);
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
            assert!(filters.iter().flatten().all(|i| i.k != u32::from(announce())));
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
        assert_eq!(filters.len(), 1);
        assert!(filters.iter().flatten().all(|instruction| instruction.k != ACTION_ANNOUNCE));
        assert!(
            filters[0].iter().any(|instruction| instruction.code == RETURN_CONSTANT && instruction.k == 0x8000_0000)
        );
    }
}
