//! Decides with which layers programs run on this host, and starts runs on the grader's side.

use std::{
    ffi::OsString,
    fs::File,
    io,
    os::{
        fd::OwnedFd,
        unix::{ffi::OsStrExt, net::UnixStream},
    },
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::Arc,
};

use super::{
    collect::OpenFolder,
    fake::FakeRun,
    job::{Job, Policy, ProgramIdentity},
    job_files::{folder_fault, plain_name, write_files},
    keepers::{Keeper, KeeperPool, RunKind as Keeping, RunSupervisor},
    layers::{self, Layer, LayerReport},
    memory_budget,
    outcome::{RunEnd, StartProblem},
    own_files, program,
    running_program::{RunningProgram, SupervisedRun},
    sandbox_error::{SandboxError, from_setup_failure},
    supervisor::{MODE_KEEP, MODE_PROBE, MODE_RUN},
    sys,
    wire::{self, ActiveLayers, Event, Probe, RunOrder, SUPERVISOR_ARGUMENT},
};

/// The program that is started as the supervisor. Its `main` must call [`supervisor_main`](super::supervisor_main).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Supervisor {
    program: PathBuf,
}

impl Supervisor {
    /// Returns the current program, even if its file has been replaced or removed since it was started.
    pub fn this_program() -> Self {
        Self { program: "/proc/self/exe".into() }
    }

    /// Returns another program instead of the current one, for tests.
    pub fn from_path(program: impl Into<PathBuf>) -> Self {
        Self { program: program.into() }
    }

    /// Returns the grader's files that no submission may run: the file of this process and that of the supervisor.
    fn own_files(&self) -> [PathBuf; 2] {
        ["/proc/self/exe".into(), self.program.clone()]
    }

    /// Returns the command that starts the supervisor in `mode`, without the grader's environment.
    fn build_command(&self, mode: &str) -> Command {
        let mut command = Command::new(&self.program);
        command.arg(SUPERVISOR_ARGUMENT).arg(mode).env_clear().current_dir("/");
        // Copies of programs are in this folder, so the probe tests whether programs can be executed there.
        command.env("TMPDIR", std::env::temp_dir());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Starts the supervisor of a run, and passes it the descriptors that the run's layers need.
    fn spawn_for(&self, order: &RunOrder) -> Result<SpawnedSupervisor, SandboxError> {
        let begin = || -> io::Result<_> {
            let (mut child, control) = spawn_connected(self.build_command(MODE_RUN))?;
            let answers = child.stdout.take().ok_or(io::ErrorKind::BrokenPipe)?;
            Ok(SpawnedSupervisor { host: RunSupervisor::Own(child), control, answers: OwnedFd::from(answers).into() })
        };
        let spawned = begin().map_err(|source| self.start_error(source))?;
        // If the supervisor does not read the order, its answer or its exit status shows the reason.
        let _ = wire::send(&spawned.control, order);
        Ok(spawned)
    }

    /// Sends a request to a keeper of runs of this kind. If there is none, a keeper is started. Also returns whether
    /// the keeper existed before.
    fn request_from_keeper(
        &self,
        order: &RunOrder,
        files: &[(String, Vec<u8>)],
        kind: Keeping,
        pool: &Arc<KeeperPool>,
    ) -> Result<(SpawnedSupervisor, bool), SandboxError> {
        if let Some(keeper) = pool.take_keeper(&kind)
            && let Ok((control, answers)) = keeper.request_run(order, files)
        {
            return Ok((
                SpawnedSupervisor { host: RunSupervisor::Shared(Box::new(keeper), pool.clone()), control, answers },
                true,
            ));
        }
        let begin = || -> io::Result<_> {
            let mut command = self.build_command(MODE_KEEP);
            command.stdout(Stdio::null());
            let (child, socket) = spawn_connected(command)?;
            let keeper = Keeper::new(kind, child, socket);
            let (control, answers) = keeper.request_run(order, files)?;
            Ok((
                SpawnedSupervisor { host: RunSupervisor::Shared(Box::new(keeper), pool.clone()), control, answers },
                false,
            ))
        };
        begin().map_err(|source| self.start_error(source))
    }

    fn start_error(&self, source: io::Error) -> SandboxError {
        SandboxError::Supervisor { program: self.program.display().to_string(), source }
    }

    /// Tests each layer once on this host.
    pub(super) fn probe(&self) -> Result<Probe, SandboxError> {
        let child = self.build_command(MODE_PROBE).spawn().map_err(|source| self.start_error(source))?;
        let output = child.wait_with_output();
        let error_from = |how: String| SandboxError::Lost { how };
        let output = output.map_err(|error| error_from(error.to_string()))?;
        wire::receive(&output.stdout[..]).map_err(|_| {
            let text = String::from_utf8_lossy(&output.stderr).trim().to_string();
            error_from(format!("the probe ended with {}: {text}", output.status))
        })
    }
}

/// Starts a supervisor. Also returns the other end of its standard input.
fn spawn_connected(mut command: Command) -> io::Result<(Child, UnixStream)> {
    let (ours, theirs) = UnixStream::pair()?;
    Ok((command.stdin(OwnedFd::from(theirs)).spawn()?, ours))
}

/// A supervisor that was started and has received its order.
struct SpawnedSupervisor {
    host: RunSupervisor,
    control: UnixStream,
    answers: File,
}

impl SpawnedSupervisor {
    /// Reads the supervisor's first message.
    fn receive_first(&mut self) -> io::Result<Event> {
        wire::receive(&mut self.answers)
    }

    fn loss_error(self) -> SandboxError {
        drop(self.control);
        self.host.loss_error()
    }
}

/// A way to run programs, with certain layers. Clones are cheap, and runs in several threads are independent.
#[derive(Clone)]
pub struct Backend {
    kind: BackendKind,
    layers: Arc<[LayerReport]>,
}

#[derive(Clone)]
enum BackendKind {
    Launcher { supervisor: Supervisor, layers: ActiveLayers, keepers: Arc<KeeperPool> },
    Fake(Arc<dyn Fn(&Job) -> FakeRun + Send + Sync>),
}

impl BackendKind {
    fn with_launcher(supervisor: Supervisor, layers: ActiveLayers) -> Self {
        Self::Launcher { supervisor, layers, keepers: Arc::default() }
    }
}

impl std::fmt::Debug for Backend {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kind = match &self.kind {
            BackendKind::Launcher { layers, .. } => format!("{layers:?}"),
            BackendKind::Fake(_) => "Fake".into(),
        };
        formatter.debug_struct("Backend").field("kind", &kind).finish_non_exhaustive()
    }
}

impl Backend {
    /// Returns the backend with every layer that works on this host. Each layer is tested once.
    ///
    /// # Errors
    ///
    /// Fails with [`SandboxError::MissingLayers`] if a required layer is missing. Required are: no new privileges,
    /// resource limits, the reaper, the system call filter, and file rules (for root, a user per program is enough).
    /// Without them only [`Backend::without_sandbox`] can run programs.
    pub fn with_all_layers(supervisor: Supervisor) -> Result<Self, SandboxError> {
        let reports = layers::reports(&supervisor.probe()?);
        let layers = layers::select_layers(&reports).map_err(missing_layers)?;
        Ok(Self { kind: BackendKind::with_launcher(supervisor, layers), layers: reports.into() })
    }

    /// Returns this backend with the layers in `reports`, and with the file rules of a kernel that has this Landlock
    /// version.
    fn with_layers(&self, reports: Vec<LayerReport>, landlock_version: u8) -> Result<Self, SandboxError> {
        let kind = match &self.kind {
            BackendKind::Launcher { supervisor, .. } => {
                let layers = layers::select_layers(&reports).map_err(missing_layers)?;
                BackendKind::with_launcher(supervisor.clone(), ActiveLayers { landlock_version, ..layers })
            }
            BackendKind::Fake(script) => BackendKind::Fake(script.clone()),
        };
        Ok(Self { kind, layers: reports.into() })
    }

    /// Returns the backend without one of its layers, to test the others without it. Reports name the missing layer.
    ///
    /// # Errors
    ///
    /// Fails with [`SandboxError::MissingLayers`] if the layer is required on this host.
    pub fn without_layer(&self, layer: Layer) -> Result<Self, SandboxError> {
        self.with_layers(layers::without_layer(&self.layers, layer), 0)
    }

    /// Returns the backend with the file rules of an older kernel, to test that these work as well. `version` is the
    /// version of Landlock, from 1.
    ///
    /// # Errors
    ///
    /// Fails like [`Backend::without_layer`].
    pub fn with_landlock(&self, version: u8) -> Result<Self, SandboxError> {
        self.with_layers(layers::with_landlock(&self.layers, version), version)
    }

    /// Returns the backend with every layer that works on this host, even if required layers are missing. This is used
    /// for `--unsafe-no-sandbox`. [`Backend::weaknesses`] names the missing layers.
    ///
    /// # Errors
    ///
    /// Fails with [`SandboxError::MissingLayers`] if the grader is root and cannot become another user, because
    /// programs are never run as root. Also fails if the supervisor does not start.
    pub fn without_sandbox(supervisor: Supervisor) -> Result<Self, SandboxError> {
        let reports = layers::reports(&supervisor.probe()?);
        let layers = layers::available_layers(&reports).map_err(missing_layers)?;
        Ok(Self { kind: BackendKind::with_launcher(supervisor, layers), layers: reports.into() })
    }

    /// Returns whether all layers that are required on this host work.
    pub fn is_complete(&self) -> bool {
        self.layers.iter().all(|report| report.active || !report.required)
    }

    /// Returns one line for each required layer that does not work. There are no lines if the sandbox is complete.
    pub fn weaknesses(&self) -> Vec<String> {
        layers::describe_missing(&self.layers)
    }

    /// Returns a backend that runs nothing. Its results come from a script, for tests of code that uses the sandbox.
    pub fn fake(script: impl Fn(&Job) -> FakeRun + Send + Sync + 'static) -> Self {
        Self { kind: BackendKind::Fake(Arc::new(script)), layers: layers::no_layers() }
    }

    /// Returns reports on all layers, active or not.
    pub fn layers(&self) -> &[LayerReport] {
        &self.layers
    }

    /// Returns the reason why a file cannot be started at all, according to its first bytes; `None` if starting it may
    /// work.
    pub fn start_problem(&self, program: &Path) -> Option<StartProblem> {
        match &self.kind {
            BackendKind::Launcher { supervisor, .. } => program::examine(program, &supervisor.own_files()).err(),
            BackendKind::Fake(_) => None,
        }
    }

    /// Starts the program. It may have ended when this function returns. If a program cannot be started, that is a
    /// [`RunOutcome`](super::RunOutcome) and not an error.
    ///
    /// # Errors
    ///
    /// Fails if the grader or the host fails.
    pub fn start(&self, job: &Job) -> Result<RunningProgram, SandboxError> {
        let (supervisor, layers, keepers) = match &self.kind {
            BackendKind::Launcher { supervisor, layers, keepers } => (supervisor, *layers, keepers),
            BackendKind::Fake(script) => {
                write_files(job)?;
                return script(job).into_running(job, self.layers.clone());
            }
        };
        if let Some(staged) = &job.identity
            && ProgramIdentity::from_path(&job.program).as_ref() != Some(staged)
        {
            return Err(SandboxError::ChangedProgram { program: job.program.display().to_string() });
        }
        let examined = match program::examine(&job.program, &supervisor.own_files()) {
            Ok(examined) => examined,
            Err(problem) => return FakeRun::with_start_problem(problem).into_running(job, self.layers.clone()),
        };
        let mut order = build_order(job, layers, examined, &supervisor.program)?;
        if Keeping::is_possible_for(&order) {
            order.files =
                job.files.iter().map(|(name, bytes)| (name.clone().into_bytes(), bytes.len() as u64)).collect();
        } else {
            write_files(job)?;
        }
        let (mut spawned, first) = loop {
            let (mut spawned, is_from_keeper) = match Keeping::from_order(&order) {
                Some(kind) => supervisor.request_from_keeper(&order, &job.files, kind, keepers)?,
                None => (supervisor.spawn_for(&order)?, false),
            };
            match spawned.receive_first() {
                // The keeper ended, because it received no order for a while.
                Err(_) if is_from_keeper => spawned.host.kill(),
                first => break (spawned, first),
            }
        };
        match first {
            Ok(Event::Ready { session, user }) => {
                let folder = match order.is_in_memory.then(|| receive_folder(&spawned.control)).transpose() {
                    Ok(folder) => folder.map(OpenFolder::from),
                    Err(_) => return Err(spawned.loss_error()),
                };
                let (SpawnedSupervisor { host, control, answers }, layers) = (spawned, self.layers.clone());
                let supervised = SupervisedRun { supervisor: host, answers, session, user, order, layers };
                Ok(RunningProgram::new(supervised, control, folder))
            }
            Ok(Event::Failed(failure)) => {
                spawned.host.keep_for_reuse(None);
                match failure.errno {
                    // The program's file itself is larger than the memory limit.
                    libc::ENOMEM if failure.stage == wire::EXECUTE_STEP => {
                        FakeRun::with_end(RunEnd::MemoryLimit).into_running(job, self.layers.clone())
                    }
                    _ => Err(from_setup_failure(failure)),
                }
            }
            Ok(Event::Done(_)) | Err(_) => {
                spawned.host.kill();
                Err(spawned.loss_error())
            }
        }
    }
}

/// Returns the error for layers that are missing on this host.
const fn missing_layers(missing: String) -> SandboxError {
    SandboxError::MissingLayers { missing }
}

/// Receives the descriptor of a working folder in memory.
fn receive_folder(control: &UnixStream) -> io::Result<OwnedFd> {
    let mut byte = [0];
    let (_, descriptors) = sys::receive_descriptors(control, &mut byte)?;
    match (byte[0], descriptors.into_iter().next()) {
        (wire::FOLDER_BYTE, Some(folder)) => Ok(folder),
        _ => Err(io::ErrorKind::InvalidData.into()),
    }
}

/// Returns the order for a job, which a supervisor of the current program receives. All paths in it are absolute.
fn build_order(
    job: &Job,
    layers: ActiveLayers,
    examined: program::ProgramFacts,
    supervisor: &Path,
) -> Result<RunOrder, SandboxError> {
    let folder = job.folder.canonicalize().and_then(|folder| match folder.is_dir() {
        true => Ok(folder),
        false => Err(io::ErrorKind::NotADirectory.into()),
    });
    let folder = folder.map_err(|source| folder_fault(job, source))?;
    let trace = job.trace.as_ref().map(|name| plain_name(job, name)).transpose()?;
    let mut readable = Vec::new();
    for path in &job.readable {
        let found = std::path::absolute(path).and_then(|path| path.metadata().map(|_| path));
        let path = found.map_err(|source| SandboxError::ReadablePath { path: path.display().to_string(), source })?;
        readable.push(wire::to_raw_bytes(&path));
    }
    let bytes = |text: &OsString| text.as_bytes().to_vec();
    let given = job.environment.iter().map(|(name, value)| (bytes(name), bytes(value)));
    let set = examined.script.iter().flat_map(|script| &script.environment);
    let set = set.map(|(name, value)| (name.as_bytes().to_vec(), value.as_bytes().to_vec()));
    let environment = given.chain(set).collect();
    let program = std::path::absolute(&job.program).unwrap_or_else(|_| job.program.clone());
    let mut order = RunOrder {
        program: wire::to_raw_bytes(&program),
        folder: wire::to_raw_bytes(&folder),
        arguments: job.arguments.iter().map(bytes).collect(),
        environment,
        readable,
        executable: examined.executable.iter().map(|path| wire::to_raw_bytes(path)).collect(),
        named_paths: examined.named_paths.iter().map(|path| wire::to_raw_bytes(path)).collect(),
        own_files: own_files::known_files(supervisor).iter().map(|path| wire::to_raw_bytes(path)).collect(),
        trace: trace.map(wire::to_raw_bytes),
        files: Vec::new(),
        is_in_memory: false,
        allows_tools: job.policy == Policy::Tools,
        interpreter: examined.script.as_ref().map(|script| wire::to_raw_bytes(&script.interpreter)),
        interpreter_arguments: examined
            .script
            .iter()
            .flat_map(|script| &script.interpreter_arguments)
            .map(|argument| argument.as_bytes().to_vec())
            .collect(),
        sanitizers: job.sanitizers,
        layers,
        limits: job.limits.clone(),
    };
    order.is_in_memory =
        job.has_folder_in_memory && layers.namespaces && memory_budget::has_memory_for(order.folder_bytes());
    Ok(order)
}
