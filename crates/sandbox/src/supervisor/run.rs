//! Supervises a single run: starts it, watches it, stops it, and reports.

use std::{
    ffi::CString,
    fs::File,
    io::{self, Read, Write},
    os::{
        fd::{AsFd, BorrowedFd, OwnedFd},
        unix::{fs::MetadataExt, net::UnixStream},
    },
    process::ExitCode,
    rc::Rc,
    time::{Duration, Instant},
};

use super::{
    answers::SharedWaits,
    calls,
    child::{self, ChildPlan, OpenedFile},
    filter,
    folder::{self, FolderUsage},
    group::Group,
    hidden_usage, locks, modes,
    namespaces::{self, NamespaceSide},
    prepared_run::{ExclusiveResources, PreparedRun},
    processes,
    streams::CapturedStream,
    user_slot,
};
use crate::{
    outcome::RunEnd,
    sys::{self, CallAnswer, Fork, OFlags, Readiness},
    wire::{self, Event, Failure, Report, RunOrder, failure_at},
};

/// The time between two checks of clocks and counters. A check takes about ten microseconds.
const TICK_INTERVAL: Duration = Duration::from_millis(10);
/// The reciprocal of the share of the total time that checks of the folder may take.
const FOLDER_SHARE: u32 = 20;

/// Reads an order from standard input, supervises its run, and answers on standard output.
pub(super) fn main() -> ExitCode {
    let streams = || -> io::Result<(File, File)> {
        Ok((io::stdin().as_fd().try_clone_to_owned()?.into(), io::stdout().as_fd().try_clone_to_owned()?.into()))
    };
    let Ok((mut control, mut answers)) = streams() else { return ExitCode::from(2) };
    let settled = wire::receive::<RunOrder>(&mut control)
        .map_err(failure_at("read the order"))
        .and_then(|order| prepare_run(order, control));
    ExitCode::from(match settled {
        Ok(StartedRun::Here(run)) => report_end(run.finish(&mut answers), &mut answers),
        // The process inside the namespaces has already reported everything.
        Ok(StartedRun::Elsewhere(code)) => code,
        Err(failure) => report_end(Err(failure), &mut answers),
    })
}

/// Reports how the run ended. Returns the exit code of the supervisor, which is 0 if the grader has received the
/// report.
pub(super) fn report_end(finished: Result<Option<FinishedRun>, Failure>, answers: &mut File) -> u8 {
    let sent = match finished {
        Ok(Some((report, stdout, stderr))) => wire::send(&mut *answers, &Event::Done(report))
            .and_then(|()| answers.write_all(&stdout))
            .and_then(|()| answers.write_all(&stderr)),
        Ok(None) => return 1,
        Err(failure) => wire::send(answers, &Event::Failed(failure)),
    };
    u8::from(sent.is_err())
}

/// A run that this process supervises, or the end of a run that another process supervised.
enum StartedRun {
    Here(Box<Run>),
    /// Another process has supervised the run, and has ended with this exit code.
    Elsewhere(u8),
}

/// Claims the user and the control group that a run needs, enters its namespaces, and starts it. If another process
/// supervised the run inside the namespaces, returns that process's exit code.
fn prepare_run(order: RunOrder, control: File) -> Result<StartedRun, Failure> {
    // In a session of its own, the supervisor does not receive Ctrl-C from the terminal. The grader tells it to stop.
    sys::start_session().map_err(failure_at("start the supervisor's session"))?;
    let resources = ExclusiveResources::claim(&order)?;
    if order.layers.namespaces
        && let NamespaceSide::Outside(code) = namespaces::enter(&order)?
    {
        return Ok(StartedRun::Elsewhere(code));
    }
    Run::start(order, control, resources, &PreparedRun::default()).map(|run| StartedRun::Here(Box::new(run)))
}

/// The report on a run, with its standard output and its standard error.
pub(super) type FinishedRun = (Report, Vec<u8>, Vec<u8>);

/// A running program, as its supervisor controls it.
pub(super) struct Run {
    order: Rc<RunOrder>,
    control: File,
    folder: OwnedFd,
    /// The name of the trace in the working folder.
    trace: Option<CString>,
    /// The program's own user, if it has one, and the user and group that owned the folder before.
    slot: Option<(user_slot::UserSlot, (u32, u32))>,
    /// The run's control group, if it has one.
    group: Option<Group>,
    child: i32,
    process: Option<OwnedFd>,
    status: Option<UnixStream>,
    received_bytes: Vec<u8>,
    listener: Option<OwnedFd>,
    shared_waits: SharedWaits,
    stdout: CapturedStream,
    stderr: CapturedStream,
    start_time: Instant,
    main_status: Option<i32>,
    /// The reason why the program was killed; `None` if it ended by itself.
    kill_reason: Option<RunEnd>,
    peak_memory: u64,
    /// The number of bytes of memory that are not resident for any process, at the last check of mappings.
    hidden_memory: u64,
    is_orphaned: bool,
}

impl Run {
    /// Prepares the run, forks, and starts the program in the child.
    pub(super) fn start(
        order: RunOrder,
        control: File,
        resources: ExclusiveResources,
        prepared: &PreparedRun,
    ) -> Result<Self, Failure> {
        let (order, ExclusiveResources { slot, group }) = (Rc::new(order), resources);
        sys::become_reaper().map_err(failure_at("become the reaper"))?;
        let folder: OwnedFd =
            File::open(wire::to_path(&order.folder)).map_err(failure_at("open the working folder"))?.into();
        let trace = order.trace.clone().map(CString::new).transpose();
        let trace = trace.map_err(|error| Failure::new("name the trace", &error.into()))?;
        let slot = slot.map(|slot| take_ownership(folder.as_fd(), slot.user).map(|owner| (slot, owner))).transpose();
        let slot = slot.map_err(failure_at("change the owner of the working folder"))?;
        if order.is_in_memory {
            send_folder(&control, folder.as_fd()).map_err(failure_at("send the working folder to the grader"))?;
        }
        let (stdout, output) = io::pipe().map_err(failure_at("make a pipe"))?;
        let (stderr, error) = io::pipe().map_err(failure_at("make a pipe"))?;
        let (status, child_status) = UnixStream::pair().map_err(failure_at("make a socket"))?;
        status.set_nonblocking(true).map_err(failure_at("make a socket"))?;
        let opened = OpenedFile::new(&wire::to_path(&order.program), slot.is_some(), order.limits.memory)?;
        let entry_file = open_entry_file(&order, &opened)?;
        let rules = prepared.build_file_rules(&order, folder.as_fd()).map_err(failure_at("prepare Landlock"))?;
        let plan = ChildPlan {
            supervisor: std::process::id(),
            folder: folder.try_clone().map_err(failure_at("open the working folder"))?,
            opened: Some(opened),
            entry_file,
            rules,
            filters: prepared.filters.clone(),
            ignored: prepared.ignored_signals(),
            groups: group
                .as_ref()
                .map_or(Ok(Vec::new()), Group::open_entry_files)
                .map_err(failure_at("open the control group"))?,
            user: slot.as_ref().map(|(slot, _)| slot.user),
            input: File::open("/dev/null").map_err(failure_at("open /dev/null"))?.into(),
            output: output.into(),
            error: error.into(),
            status: child_status,
            order: order.clone(),
        };
        let began = Instant::now();
        let child = match prepared.fork().map_err(failure_at("fork"))? {
            Fork::Child => child::become_program(plan),
            Fork::Parent(pid) => pid,
        };
        // The descriptors of the child are closed here, so that the supervisor notices when the child closes its ends
        // of pipes and sockets.
        drop(plan);
        Ok(Self {
            stdout: CapturedStream::new(stdout, order.limits.output_bytes)
                .map_err(failure_at("read standard output"))?,
            stderr: CapturedStream::new(stderr, order.limits.output_bytes)
                .map_err(failure_at("read standard error"))?,
            order,
            control,
            folder,
            trace,
            slot,
            child,
            process: sys::process_descriptor(child),
            group,
            status: Some(status),
            received_bytes: Vec::new(),
            listener: None,
            shared_waits: SharedWaits::default(),
            start_time: began,
            main_status: None,
            kill_reason: None,
            peak_memory: 0,
            hidden_memory: 0,
            is_orphaned: false,
        })
    }

    /// Watches the run until the program has ended or must end, kills all processes, and reports. Returns `None` if the
    /// grader has ended.
    pub(super) fn finish(mut self, answers: &mut File) -> Result<Option<FinishedRun>, Failure> {
        let user = self.user();
        // The end of this pipe also shows that the grader has ended.
        let session = (!self.order.layers.namespaces).then_some(self.child);
        let _ = wire::send(answers, &Event::Ready { session, user });
        let watched = self.watch();
        let (child, mut main_status) = (self.child, self.main_status);
        if let Some(group) = &self.group {
            // If processes remain, they are killed one by one.
            let _ = group.kill();
        }
        if main_status.is_none() {
            // The process ID is valid until the process is reaped.
            let _ = sys::kill(child, libc::SIGKILL);
        }
        let left = processes::kill_all(user, self.order.layers.namespaces, |process| {
            if process.pid == child {
                main_status = Some(process.status);
            }
        });
        self.stdout.read_rest();
        self.stderr.read_rest();
        self.read_messages();
        let mut after = measure_folder(&self.order, self.folder.as_fd());
        // Most programs do not create folders.
        let shallow = match after.exceeds_limit || after.folders > 0 {
            true => {
                let shallow = folder::open_closed_folders(self.folder.as_fd());
                after = measure_folder(&self.order, self.folder.as_fd());
                shallow
            }
            false => true,
        };
        // Only root reads the files that a submission leaves in memory, so the owner of such files is not changed.
        let slot = self.slot.as_ref().filter(|_| !self.order.is_in_memory || self.order.allows_tools);
        if let Some((_, (owner, group))) = slot {
            folder::change_owner(self.folder.as_fd(), *owner, *group)
                .map_err(failure_at("restore the folder's owner"))?;
        }
        // The time for cleaning up counts toward the run's time.
        let wall = self.start_time.elapsed();
        watched.map_err(failure_at("watch the program"))?;
        if self.is_orphaned {
            return Ok(None);
        }
        // Most programs print nothing. Searching for a message is slow, because it queries the processor's features
        // several times.
        let received = Some(&self.received_bytes[..]).filter(|received| !received.is_empty());
        let failure: Option<Failure> = received.and_then(|received| serde_json::from_slice(received).ok());
        let exec_errno = match failure {
            Some(failure) if failure.stage == wire::EXECUTE_STEP => Some(failure.errno),
            Some(failure) => return Err(failure),
            None => None,
        };
        // If the kernel itself blocks a process, the host is at fault. Otherwise the program is at fault for a process
        // that did not end.
        self.record_kill_reason(
            left.count > 0 && !left.blocked,
            RunEnd::Violation { call: "none, but the program left processes that did not end".into() },
        );
        let out_of_memory = self.group.as_ref().is_some_and(Group::was_out_of_memory);
        self.record_kill_reason(out_of_memory, RunEnd::MemoryLimit);
        let (cpu, largest) = sys::children_usage().map_err(failure_at("read the resource usage"))?;
        let report = Report {
            cause: self.kill_reason.take(),
            status: main_status.unwrap_or(0),
            exec_errno,
            cpu: cpu.max(self.uncounted_processor_time()),
            wall,
            peak_memory: largest.max(self.peak_memory),
            exceeds_trace_limit: self.exceeds_trace_limit(),
            exceeds_folder_limit: self.exceeds_folder_limits(&after) || !shallow,
            stdout_bytes: self.stdout.bytes.len() as u64,
            stderr_bytes: self.stderr.bytes.len() as u64,
            stdout_truncated: self.stdout.truncated,
            stderr_truncated: self.stderr.truncated,
            survivors: if left.blocked { left.count } else { 0 },
        };
        Ok(Some((report, self.stdout.bytes, self.stderr.bytes)))
    }

    /// Watches the run until the main process has ended, or there is a reason to end it.
    fn watch(&mut self) -> io::Result<()> {
        let (mut next_look, mut next_folder) = (Instant::now() + TICK_INTERVAL, Instant::now() + TICK_INTERVAL);
        while self.main_status.is_none() && self.kill_reason.is_none() && !self.is_orphaned {
            let found = sys::poll(
                [
                    Some(self.control.as_fd()),
                    self.stdout.descriptor(),
                    self.stderr.descriptor(),
                    self.status.as_ref().map(AsFd::as_fd),
                    self.listener.as_ref().map(AsFd::as_fd),
                    self.process.as_ref().map(AsFd::as_fd),
                ],
                self.shared_waits
                    .next()
                    .map_or(next_look, |next| next.min(next_look))
                    .saturating_duration_since(Instant::now()),
            )?;
            let ready = found.map(|readiness| readiness != Readiness::Idle);
            if ready[0] {
                self.run_commands();
            }
            if ready[1] {
                self.stdout.read_available();
            }
            if ready[2] {
                self.stderr.read_available();
            }
            if ready[3] {
                self.read_messages();
            }
            match found[4] {
                Readiness::Idle => {}
                Readiness::Ready => self.decide_announcement()?,
                // No process is left to which the filter applies. The kernel would report this again and again, until
                // the process is reaped.
                Readiness::Closed => self.listener = None,
            }
            let now = Instant::now();
            if let Some(listener) = &self.listener {
                self.shared_waits.answer(listener.as_fd(), now);
            }
            if now >= next_look || ready[5] {
                self.reap();
                self.check_limits();
                next_look = Instant::now() + TICK_INTERVAL;
            }
            if now >= next_folder {
                self.check_folder();
                next_folder = Instant::now() + TICK_INTERVAL.max(now.elapsed() * FOLDER_SHARE);
            }
        }
        Ok(())
    }

    /// Returns the program's own user, if it has one.
    fn user(&self) -> Option<u32> {
        self.slot.as_ref().map(|(slot, _)| slot.user)
    }

    /// Records why the run must end, if the condition holds and nothing was recorded before.
    fn record_kill_reason(&mut self, condition: bool, reason: RunEnd) {
        if condition && self.kill_reason.is_none() {
            self.kill_reason = Some(reason);
        }
    }

    /// Carries out the grader's commands. If the pipe has ended, the grader has ended.
    fn run_commands(&mut self) {
        let mut command = [0];
        match self.control.read(&mut command) {
            Ok(1) => self.record_kill_reason(true, RunEnd::Canceled),
            _ => self.is_orphaned = true,
        }
    }

    /// Reads the child's messages. If the socket has ended, the program has started.
    fn read_messages(&mut self) {
        let mut buffer = [0; 4096];
        while let Some(status) = &self.status {
            let Ok((length, mut descriptors)) = sys::receive_descriptors(status, &mut buffer) else { return };
            match descriptors.pop() {
                _ if length == 0 => self.status = None,
                Some(listener) => self.listener = Some(listener),
                None => self.received_bytes.extend_from_slice(&buffer[..length]),
            }
        }
    }

    /// Decides about a forbidden call that waits: either it starts the program itself, or the run ends.
    fn decide_announcement(&mut self) -> io::Result<()> {
        let Some(listener) = self.listener.as_ref().map(|listener| listener.try_clone()).transpose()? else {
            return Ok(());
        };
        let announced = match sys::next_announcement(listener.as_fd()) {
            Ok(Some(announced)) => announced,
            Ok(None) => return Ok(()),
            Err(_) => {
                // No process is left to which the filter applies.
                self.listener = None;
                return Ok(());
            }
        };
        // The socket closes when the program starts, before it executes its first instruction.
        self.read_messages();
        let executes = announced.call == libc::SYS_execve || announced.call == libc::SYS_execveat;
        let (user, root) = (self.user(), wire::to_path(&self.order.folder));
        let unless = |allowed| if allowed { CallAnswer::Continue } else { CallAnswer::Error(libc::EPERM) };
        let answer = match announced.call {
            _ if executes && self.status.is_some() => Some(CallAnswer::Continue),
            libc::SYS_futex => match self.shared_waits.add(&announced, user, Instant::now()) {
                None => return Ok(()),
                answer => answer,
            },
            call if locks::is_lock_call(call) => {
                Some(unless(sys::with_file_permissions_of(user, || locks::is_inside(&announced, &root))))
            }
            call if modes::is_mode_call(call) => {
                Some(match modes::change_mode(&announced, self.folder.as_fd(), &root) {
                    Ok(()) => CallAnswer::Done,
                    Err(errno) => CallAnswer::Error(errno),
                })
            }
            _ => None,
        };
        if let Some(answer) = answer {
            // This fails if the caller was killed, which does not matter.
            let _ = sys::answer(listener.as_fd(), announced.id, answer);
            return Ok(());
        }
        let mut call = calls::call_name(announced.call);
        if announced.call == libc::SYS_clone {
            let flags = announced.arguments[0];
            let namespace = filter::NAMESPACE_FLAGS.iter().any(|flag| flags & flag != 0);
            call.push_str(match flags & libc::CLONE_THREAD as u64 {
                _ if namespace => " (it made a namespace)",
                0 => " (it started another process)",
                _ => " (it created a thread with separate descriptors)",
            });
        } else if call.ends_with("fork") {
            call.push_str(" (it started another process)");
        } else if executes {
            call.push_str(" (it started another program)");
        }
        self.record_kill_reason(true, RunEnd::Violation { call });
        Ok(())
    }

    /// Reaps the children that have ended.
    fn reap(&mut self) {
        while let Ok(Some(process)) = sys::reap() {
            if process.pid == self.child {
                self.main_status = Some(process.status);
            }
        }
    }

    /// Checks the clocks and the counters, and ends the run if a limit is exceeded.
    fn check_limits(&mut self) {
        if self.main_status.is_some() {
            return;
        }
        let usage = processes::measure_usage(self.child, self.has_children());
        let reaped = sys::children_usage().map_or(Duration::ZERO, |(cpu, _)| cpu);
        let memory = usage.memory + self.hidden_memory;
        self.peak_memory = self.peak_memory.max(memory);
        // A fork bomb exceeds both of these limits.
        self.record_kill_reason(usage.threads > u64::from(self.order.limits.processes), RunEnd::ProcessLimit);
        self.record_kill_reason(memory > self.order.limits.memory, RunEnd::MemoryLimit);
        let cpu = (usage.cpu + reaped).max(self.uncounted_processor_time());
        self.record_kill_reason(cpu > self.order.limits.cpu, RunEnd::CpuLimit);
        self.record_kill_reason(self.exceeds_trace_limit(), RunEnd::TraceLimit);
        self.record_kill_reason(self.start_time.elapsed() > self.order.limits.wall, RunEnd::WallLimit);
    }

    /// Returns whether the trace's file is longer than a trace may be.
    fn exceeds_trace_limit(&self) -> bool {
        let opened = self.trace.as_ref().map(|name| sys::open_beneath(self.folder.as_fd(), name, OFlags::PATH));
        let metadata = opened.and_then(|opened| File::from(opened.ok()?).metadata().ok());
        metadata.is_some_and(|metadata| metadata.is_file() && metadata.len() > self.order.limits.trace_bytes)
    }

    /// Returns the control group's processor time if there may be processes that were not reaped, otherwise zero. The
    /// count of a single process is complete, but the count of the group may include earlier runs.
    fn uncounted_processor_time(&self) -> Duration {
        self.group.as_ref().filter(|_| self.has_children()).map_or(Duration::ZERO, Group::cpu)
    }

    /// Checks the working folder, removed files that are still in use, and memory that is not resident for any process.
    fn check_folder(&mut self) {
        let mut contents =
            folder::measure(self.folder.as_fd(), self.order.folder_bytes(), self.order.limits.folder_files);
        if self.order.is_in_memory {
            contents = contents.field_maximum(folder::file_system_usage(self.folder.as_fd()));
        }
        let over = self.exceeds_folder_limits(&contents);
        self.record_kill_reason(over, RunEnd::FolderLimit);
        if self.order.is_in_memory && !self.can_hide_memory() {
            return;
        }
        let user = self.user();
        let members = processes::group_members(self.child, self.has_children());
        let root = wire::to_path(&self.order.folder);
        let page_tables = self.order.sanitizers;
        let held = sys::with_file_permissions_of(user, || {
            hidden_usage::measure(&members, &root, self.order.allows_tools, page_tables)
        });
        if !self.order.is_in_memory {
            contents.bytes += held.nameless_bytes;
        }
        self.hidden_memory = held.memory;
        let over = self.exceeds_folder_limits(&contents);
        self.record_kill_reason(over, RunEnd::FolderLimit);
    }

    /// Returns whether the program may have memory that is not resident for any process. This requires files outside of
    /// the folder that no rules deny.
    fn can_hide_memory(&self) -> bool {
        self.order.allows_tools || self.order.sanitizers || !self.order.layers.landlock || !self.order.layers.seccomp
    }

    /// Returns whether there may be processes besides the main one. Without the filter, every program can start
    /// processes.
    fn has_children(&self) -> bool {
        self.order.allows_tools || !self.order.layers.seccomp
    }

    fn exceeds_folder_limits(&self, contents: &FolderUsage) -> bool {
        contents.exceeds_limit
            || contents.bytes > self.order.folder_bytes()
            || contents.files > self.order.limits.folder_files
    }
}

/// Measures the working folder of an order.
fn measure_folder(order: &RunOrder, folder: BorrowedFd<'_>) -> FolderUsage {
    let contents = folder::measure(folder, u64::MAX, u64::MAX);
    if order.is_in_memory { contents.field_maximum(folder::file_system_usage(folder)) } else { contents }
}

/// Makes the run's own user the owner of the working folder. Returns the previous owner and group.
fn take_ownership(folder: BorrowedFd<'_>, user: u32) -> io::Result<(u32, u32)> {
    let owner = File::from(folder.try_clone_to_owned()?).metadata()?;
    folder::change_owner(folder, user, user)?;
    Ok((owner.uid(), owner.gid()))
}

/// Opens the program under the only descriptor number from which the filter allows its execution. Returns `None` if the
/// supervisor decides about executions, or if they are not restricted.
fn open_entry_file(order: &RunOrder, opened: &OpenedFile) -> Result<Option<OwnedFd>, Failure> {
    if !order.layers.seccomp || order.layers.notify || order.allows_tools {
        return Ok(None);
    }
    let open = |path| OpenedFile::new(&wire::to_path(path), false, order.limits.memory);
    let interpreter = order.interpreter.as_ref().map(open).transpose()?;
    let entry_file = interpreter.as_ref().unwrap_or(opened).with_min_number(order.limits.open_files);
    entry_file.map(Some).map_err(failure_at("open the program once more"))
}

/// Sends the descriptor of a working folder in memory to the grader.
fn send_folder(control: &File, folder: BorrowedFd<'_>) -> io::Result<()> {
    let socket = UnixStream::from(control.as_fd().try_clone_to_owned()?);
    sys::send_descriptors(&socket, wire::FOLDER_BYTE, [folder])
}
