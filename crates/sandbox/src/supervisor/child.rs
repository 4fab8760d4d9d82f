//! The steps of the child process between the fork and the program's start. It sets up each layer, in an order in which
//! that is possible.
//!
//! No function returns to the supervisor's code. If a step fails, it is reported to the supervisor through the status
//! socket. The socket closes by itself when the program has started.

use std::{
    ffi::CString,
    fs::{File, Permissions},
    io::{self, Write},
    os::{
        fd::{AsFd, AsRawFd, OwnedFd},
        unix::{fs::PermissionsExt, net::UnixStream},
    },
    path::Path,
    rc::Rc,
    time::Duration,
};

use landlock::RulesetCreated;
use seccompiler::BpfProgram;

use super::{file_rules, file_view, filter, filter::Purpose, memory_folder, processes};
use crate::{
    mounts,
    sys::{self, Access, Resource},
    wire::{self, EXECUTE_STEP, Failure, RawBytes, RunOrder, failure_at},
};

/// The byte that announces a seccomp listener.
pub(super) const LISTENER_BYTE: u8 = b'L';

/// The data that the child needs, which the supervisor has prepared before the fork.
pub(super) struct ChildPlan {
    pub(super) order: Rc<RunOrder>,
    pub(super) supervisor: u32,
    pub(super) folder: OwnedFd,
    /// The program or the script as an open file, if the run's user cannot open it later.
    pub(super) opened: Option<OpenedFile>,
    /// The program as an open file whose number is beyond the limit of descriptors. If executions are not announced,
    /// the program is executed from it.
    pub(super) entry_file: Option<OwnedFd>,
    pub(super) rules: Option<RulesetCreated>,
    /// The compiled filters, if system calls are filtered.
    pub(super) filters: Option<Filters>,
    /// The signals that are ignored, and must be reset before the program starts.
    pub(super) ignored: Rc<[i32]>,
    /// The files by which the child enters the run's control group.
    pub(super) groups: Vec<File>,
    pub(super) user: Option<u32>,
    pub(super) input: OwnedFd,
    pub(super) output: OwnedFd,
    pub(super) error: OwnedFd,
    pub(super) status: UnixStream,
}

/// Sets up the layers, and executes the program in this process.
pub(super) fn become_program(mut plan: ChildPlan) -> ! {
    // The socket is written like a file, because the filter allows no socket calls.
    let mut status = match plan.status.as_fd().try_clone_to_owned() {
        Ok(status) => File::from(status),
        Err(_) => sys::exit_now(125),
    };
    let failure = match prepare(&mut plan) {
        Err(failure) => failure,
        Ok((arguments, environment)) => Failure::new(EXECUTE_STEP, &execute(&plan, &arguments, &environment)),
    };
    // The supervisor waits for this message, or for the end of the program. If nobody reads it, it is lost.
    let _ = serde_json::to_writer(&mut status, &failure).map(|()| status.flush());
    sys::exit_now(125)
}

type Strings = Vec<CString>;

/// Sets up all layers. Returns the arguments and the environment of the program.
fn prepare(plan: &mut ChildPlan) -> Result<(Strings, Strings), Failure> {
    sys::start_session().map_err(failure_at("start a session"))?;
    for group in &mut plan.groups {
        group.write_all(b"0").map_err(failure_at("enter the control group"))?;
    }
    sys::connect_standard_streams(&plan.input, &plan.output, &plan.error)
        .map_err(failure_at("connect the standard streams"))?;
    sys::default_signals(&plan.ignored);
    sys::set_file_mask(0o022);
    sys::enter_folder(plan.folder.as_fd()).map_err(failure_at("enter the working folder"))?;
    if plan.order.layers.namespaces && !plan.order.allows_tools {
        // This also changes the current folder.
        file_view::hide_other_processes(&plan.order)?;
    }
    // If memory runs out, the kernel should kill this process first. Some containers do not allow this setting.
    let _ = std::fs::write("/proc/self/oom_score_adj", "1000");
    set_limits(&plan.order, plan.user.is_some()).map_err(failure_at("set the resource limits"))?;
    if let Some(user) = plan.user {
        sys::switch_user(user).map_err(failure_at("become the sandbox's user"))?;
    }
    // A change of user resets the parent-death signal, so the signal is set afterwards. If the parent has ended before,
    // this is detected here.
    sys::die_with_parent().map_err(failure_at("make the program end with the supervisor"))?;
    if std::os::unix::process::parent_id() != plan.supervisor {
        sys::exit_now(125);
    }
    let strings = (build_arguments(plan), build_environment(&plan.order));
    let strings = match strings {
        (Ok(arguments), Ok(environment)) => (arguments, environment),
        _ => return Err(Failure { stage: "pass text with a NUL byte".into(), errno: libc::EINVAL }),
    };
    for raw in &plan.order.readable {
        if !c_string(raw).is_ok_and(|path| sys::is_accessible(&path, Access::READ_OK)) {
            let stage =
                format!("open {} for the program (every user must be able to read it)", wire::to_path(raw).display());
            return Err(Failure { stage, errno: libc::EACCES });
        }
    }
    sys::forbid_new_privileges().map_err(failure_at("give up privileges"))?;
    if let Some(rules) = plan.rules.take() {
        let rules = file_rules::add_own_entry(rules).map_err(failure_at("prepare Landlock"))?;
        file_rules::enforce(rules).map_err(failure_at("enforce Landlock"))?;
    }
    sys::close_on_execute().map_err(failure_at("close descriptors"))?;
    if let Some(script) = script_by_descriptor(plan) {
        sys::keep_on_execute(script.file.as_fd()).map_err(failure_at("keep the script open"))?;
    }
    if plan.order.layers.seccomp {
        filter_calls(plan).map_err(failure_at("install the system call filter"))?;
    }
    Ok(strings)
}

/// Sets the resource limits. Except for the file size limit, they are only a second line of defense behind the
/// supervisor's checks.
fn set_limits(order: &RunOrder, own_user: bool) -> io::Result<()> {
    // This is the default of Linux. With it, a deep recursion ends in the same way on every host.
    const STACK_BYTES: u64 = 8 << 20;
    const SPARE_MEMORY_BYTES: u64 = 512 << 20;
    const SPARE_SECONDS: u64 = 2;
    const SPARE_PROCESSES: u64 = 16;
    // The run's own user can have other processes only in another container that uses the same numbers.
    const SPARE_FOR_OTHERS: u64 = 128;
    const PENDING_SIGNALS: u64 = 1024;
    // The address sanitizer reserves 20 TiB in addition to the space that the program itself uses. Other sanitizers
    // reserve more.
    const SANITIZERS_SPACE: u64 = 64 << 40;
    // The limit is one byte and not zero. With zero, the kernel may pass core dumps to a handler.
    sys::set_limit(Resource::Core, 1)?;
    let limits = &order.limits;
    sys::set_limit(Resource::Fsize, order.file_bytes())?;
    sys::set_limit(Resource::Nofile, u64::from(limits.open_files))?;
    let partial_second = u64::from(limits.cpu.subsec_nanos() > 0);
    sys::set_limit(Resource::Cpu, limits.cpu.as_secs().saturating_add(partial_second + SPARE_SECONDS))?;
    sys::set_limit(Resource::Stack, STACK_BYTES)?;
    sys::set_limit(Resource::Memlock, 64 << 10)?;
    sys::set_limit(Resource::Msgqueue, 0)?;
    sys::set_limit(Resource::Rtprio, 0)?;
    // The kernel counts pending signals per user, in the same way as processes.
    sys::set_limit(Resource::Sigpending, PENDING_SIGNALS)?;
    // Address space is not memory in use: libraries reserve more than they use. The memory in use is checked
    // separately.
    let space = limits.memory.saturating_mul(2).saturating_add(SPARE_MEMORY_BYTES);
    sys::set_limit(Resource::As, if order.sanitizers { space.max(SANITIZERS_SPACE) } else { space })?;
    // The kernel counts per user or per user namespace. If other runs share it, this limit only stops fork bombs, and
    // the supervisor counts the processes of the run itself.
    let processes = u64::from(limits.processes) + SPARE_PROCESSES;
    // The processes of a fork bomb use memory and time until the supervisor has counted them; threads use little.
    let most_runs = if order.allows_tools { 8 } else { 64 };
    let processes = match own_user || order.layers.namespaces {
        true => processes + SPARE_FOR_OTHERS,
        false => most_runs * processes + processes::threads_of_user(sys::user_id()),
    };
    sys::set_limit(Resource::Nproc, processes)
}

/// Filters that were compiled before the child existed, and the purpose for which they were compiled.
pub(super) type Filters = Rc<(Purpose, Vec<BpfProgram>)>;

/// Returns the purpose of the filters for a child with the process ID `number`.
pub(super) fn find_purpose(order: &RunOrder, own_user: bool, entry_file: Option<u64>, number: i32) -> Purpose {
    let layers = order.layers;
    Purpose {
        tools: order.allows_tools,
        announce: layers.notify,
        // Tools send signals to their own children. Landlock's scope or a separate user distinguishes these from other
        // processes.
        own_process: (!order.allows_tools || !(layers.scopes || layers.own_user)).then_some(number),
        entry_file,
        own_user,
    }
}

/// Installs the filters, and sends the listener to the supervisor.
fn filter_calls(plan: &ChildPlan) -> io::Result<()> {
    let layers = plan.order.layers;
    let entry_file = plan.entry_file.as_ref().map(|file| file.as_raw_fd() as u64);
    let purpose = find_purpose(&plan.order, plan.user.is_some(), entry_file, std::process::id() as i32);
    let compiled = match plan.filters.as_ref().filter(|filters| filters.0 == purpose) {
        Some(filters) => filters.clone(),
        None => Rc::new((purpose, filter::compile_filters(purpose)?)),
    };
    for (index, program) in compiled.1.iter().enumerate() {
        let listener = sys::install_filter(program, layers.notify && index == 0)?;
        if let Some(listener) = listener {
            sys::send_descriptors(&plan.status, LISTENER_BYTE, [listener.as_fd()])?;
        }
    }
    Ok(())
}

/// Executes the program. This returns only if there is an error.
///
/// A file that has just been written can be busy for a moment. Another thread of the grader may have forked while the
/// file was open for writing, and that child has a copy of the descriptor until it executes. Therefore the execution is
/// tried again.
fn execute(plan: &ChildPlan, arguments: &[CString], environment: &[CString]) -> io::Error {
    const MAX_TRIES: u32 = 25;
    const PAUSE: Duration = Duration::from_millis(20);
    for _ in 1..MAX_TRIES {
        let error = execute_once(plan, arguments, environment);
        if error.raw_os_error() != Some(libc::ETXTBSY) {
            return error;
        }
        std::thread::sleep(PAUSE);
    }
    execute_once(plan, arguments, environment)
}

/// Executes the program by its path. If the sandbox's user cannot reach the path, the program is executed from the open
/// file.
fn execute_once(plan: &ChildPlan, arguments: &[CString], environment: &[CString]) -> io::Error {
    let path = plan.order.interpreter.as_ref().unwrap_or(&plan.order.program);
    let Ok(path) = c_string(path) else { return io::Error::from_raw_os_error(libc::EINVAL) };
    let open = |opened: &OpenedFile| sys::execute_open(opened.file.as_fd(), arguments, environment);
    if let Some(entry_file) = &plan.entry_file {
        return sys::execute_open(entry_file.as_fd(), arguments, environment);
    }
    match &plan.opened {
        _ if plan.order.interpreter.is_some() => sys::execute(&path, arguments, environment),
        Some(opened) if opened.is_copy => open(opened),
        opened => {
            let error = sys::execute(&path, arguments, environment);
            match opened {
                Some(opened) if error.raw_os_error() == Some(libc::EACCES) => open(opened),
                _ => error,
            }
        }
    }
}

fn build_arguments(plan: &ChildPlan) -> io::Result<Strings> {
    let order = &plan.order;
    let script = script_by_descriptor(plan).map(|script| format!("/proc/self/fd/{}", script.file.as_raw_fd()).into());
    let program = script.unwrap_or_else(|| order.program.clone());
    order.interpreter_arguments.iter().chain([&program]).chain(&order.arguments).map(c_string).collect()
}

/// Returns the open script if its interpreter must read it by a descriptor, because the run's user cannot reach the
/// script's path.
fn script_by_descriptor(plan: &ChildPlan) -> Option<&OpenedFile> {
    let opened = plan.opened.as_ref().filter(|_| plan.order.interpreter.is_some())?;
    let readable = c_string(&plan.order.program).is_ok_and(|path| sys::is_accessible(&path, Access::READ_OK));
    (!readable).then_some(opened)
}

/// Returns the environment variables that every program gets, followed by those of the job.
fn build_environment(order: &RunOrder) -> io::Result<Strings> {
    let folder = c_string(&order.folder)?;
    // If the sandbox's user cannot enter a parent of the folder, the folder is used as the current folder.
    let home = if sys::is_accessible(&folder, Access::WRITE_OK | Access::EXEC_OK) {
        order.folder.clone()
    } else {
        b".".to_vec()
    };
    let mut variables: Vec<(RawBytes, RawBytes)> = vec![
        (b"PATH".to_vec(), b"/usr/local/bin:/usr/bin:/bin".to_vec()),
        (b"LC_ALL".to_vec(), b"C".to_vec()),
        (b"HOME".to_vec(), home.clone()),
        (b"TMPDIR".to_vec(), home),
    ];
    if order.sanitizers {
        // The leak check would start a process that traces its parent, which no filter allows.
        variables.push((b"ASAN_OPTIONS".to_vec(), b"detect_leaks=0".to_vec()));
    }
    for (name, value) in &order.environment {
        variables.retain(|(known, _)| known != name);
        variables.push((name.clone(), value.clone()));
    }
    variables.into_iter().map(|(name, value)| c_string(&[name, value].join(&b'='))).collect()
}

fn c_string(raw: &RawBytes) -> io::Result<CString> {
    CString::new(raw.as_slice()).map_err(io::Error::other)
}

/// A program as an open file that every user may execute.
pub(super) struct OpenedFile {
    file: OwnedFd,
    is_copy: bool,
}

impl OpenedFile {
    /// Opens the program. If only its owner may use it, or if nothing can be executed in its folder, it is copied into
    /// memory, and the copy is opened. If the user of the run could not read the program, the supervisor's checks would
    /// not work either. A copy of more than `max_bytes` bytes fails as if the kernel had no memory left.
    pub(super) fn new(path: &Path, for_another: bool, max_bytes: u64) -> Result<Self, Failure> {
        let open = || -> io::Result<Self> {
            const READ_AND_EXECUTE: u32 = 0o005;
            let program = File::open(path)?;
            let mode = program.metadata()?.permissions().mode();
            let has_permissions = !for_another || mode & READ_AND_EXECUTE == READ_AND_EXECUTE;
            match has_permissions && !mounts::forbids_execution(program.as_fd()) {
                true => Ok(Self { file: program.into(), is_copy: false }),
                false => Self::copy_into_memory(&program, max_bytes),
            }
        };
        open().map_err(|error| match error.kind() {
            io::ErrorKind::OutOfMemory => Failure::new(EXECUTE_STEP, &error),
            _ => Failure::new("open the program", &error),
        })
    }

    /// Copies the program into memory. Holes in the file remain holes.
    fn copy_into_memory(program: &File, max_bytes: u64) -> io::Result<Self> {
        let mut copy = File::from(sys::memory_file()?);
        memory_folder::copy_blocks(program, &mut copy, max_bytes)?;
        copy.set_permissions(Permissions::from_mode(0o555))?;
        // A file that is open for writing cannot be executed, so it is opened again only for reading.
        let again = File::open(format!("/proc/self/fd/{}", copy.as_raw_fd()))?;
        Ok(Self { file: again.into(), is_copy: true })
    }

    /// Returns the file under a descriptor number that is at least `min`.
    pub(super) fn with_min_number(&self, min: u32) -> io::Result<OwnedFd> {
        sys::duplicate_from(self.file.as_fd(), min)
    }
}
