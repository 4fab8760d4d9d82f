//! Runs the attack suite on this machine. For each promise of the sandbox, there is a hostile program.
//!
//! The programs are the C files of `tests/attacks`, which are part of the binary. Each runs in the sandbox next to
//! decoys: secrets, a scene, another submission and a process. A promise is kept if the program ends as expected, the
//! decoys are unchanged, no secret is printed, and no process is left. Outside the sandbox the programs do nothing.

mod attack;
mod decoy;

use std::{
    path::{Path, PathBuf},
    process::Command,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    time::Duration,
};

use include_dir::{Dir, include_dir};

use self::{attack::Attack, decoy::Decoy};
use super::{
    backend::Backend,
    collect::CollectError,
    job::{Job, Limits},
    layers::{Layer, is_active},
    outcome::{RunEnd, RunOutcome},
    running_program::RemainingFolder,
    sandbox_error::SandboxError,
    supervisor::processes,
    sys,
};

static ATTACK_SOURCES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../tests/attacks");

/// The environment variable without which the hostile programs do nothing.
const PERMIT_VARIABLE: &str = "FOSSSIM_ATTACK";
/// The environment variables that give a hostile program the path of the grader's program, and the ID of the grader's
/// process group.
const GRADER_VARIABLE: &str = "FOSSSIM_GRADER";
const GROUP_VARIABLE: &str = "FOSSSIM_GRADER_GROUP";
/// The end of an attack whose forbidden call was denied, but not by the sandbox, which would have killed the attack.
const DENIED_END: RunEnd = RunEnd::Exited(77);
/// Attacks are built without optimization, because it would remove stores and loops that seem to have no effect.
const COMPILER_FLAGS: [&str; 3] = ["-O0", "-w", "-pthread"];
/// The file name of the trace that attacks write.
const TRACE_NAME: &str = "trace.bin";
/// The maximum size of an attack's trace, in bytes.
const MAX_TRACE_BYTES: u64 = 1 << 20;

/// Whether the sandbox keeps a promise on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PromiseState {
    /// The promise is kept: the attack failed, and left nothing behind.
    Kept,
    /// The promise is broken. The value describes how.
    Broken(String),
    /// The promise could not be tested on this machine. The value is the reason.
    NotTested(String),
}

/// A promise of the sandbox, and whether it is kept on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Promise {
    /// The name of the attack, which is also the name of its file.
    pub attack: String,
    /// The promise, as one sentence.
    pub promise: String,
    /// Whether the promise is kept.
    pub state: PromiseState,
}

/// All promises of the sandbox, and whether they are kept on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PromiseTable {
    /// The promises, in the order of the names of their attacks.
    pub promises: Vec<Promise>,
}

impl PromiseTable {
    /// Returns the promises that are broken on this machine.
    pub fn broken_promises(&self) -> impl Iterator<Item = &Promise> {
        self.promises.iter().filter(|promise| matches!(promise.state, PromiseState::Broken(_)))
    }

    /// Returns the number of promises that are kept.
    pub fn count_kept(&self) -> usize {
        self.promises.iter().filter(|promise| promise.state == PromiseState::Kept).count()
    }
}

/// Builds every attack with the C compiler `compiler` and runs it with `backend`. Several attacks run at the same time.
/// `report` is called after each attack. All files are written below `folder`, which must exist. The built programs are
/// kept there for the next self-test.
///
/// # Errors
///
/// Fails with [`SandboxError::MissingLayers`] if the backend does not filter system calls, because attacks are never
/// run without layers. Also fails if `folder` cannot be used. A broken promise is not an error.
pub fn run(
    backend: &Backend,
    compiler: &Path,
    folder: &Path,
    report: impl FnMut(&Promise) + Send,
) -> Result<PromiseTable, SandboxError> {
    run_selected(backend, compiler, folder, |_| true, report)
}

/// Runs the self-test like [`run`], but only for the attacks that `is_chosen` selects.
///
/// # Errors
///
/// Fails like [`run`].
pub fn run_selected(
    backend: &Backend,
    compiler: &Path,
    folder: &Path,
    is_chosen: impl Fn(&str) -> bool,
    mut report: impl FnMut(&Promise) + Send,
) -> Result<PromiseTable, SandboxError> {
    if !is_active(backend.layers(), Layer::CallFilter) {
        return Err(SandboxError::MissingLayers { missing: "the attacks run only inside the sandbox".into() });
    }
    let folder_error = |source: std::io::Error| SandboxError::Folder { folder: folder.display().to_string(), source };
    let folder = folder.canonicalize().map_err(folder_error)?;
    let sources = folder.join("sources");
    let programs = folder.join("programs");
    for made in [&sources, &programs] {
        std::fs::create_dir_all(made).map_err(folder_error)?;
    }
    let mut attacks = attacks();
    attacks.retain(|attack| is_chosen(&attack.name));
    let header = ATTACK_SOURCES.get_file("attack.h").map(|file| file.contents()).unwrap_or_default();
    write_file(&sources.join("attack.h"), header).map_err(folder_error)?;

    let next = AtomicUsize::new(0);
    let collected = Mutex::new((Vec::new(), &mut report));
    let workers = std::thread::available_parallelism().map_or(2, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(attack) = attacks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let setup =
                        TestSetup { backend, compiler, sources: &sources, programs: &programs, folder: &folder };
                    let state = setup.try_attack(attack).unwrap_or_else(|state| state);
                    let promise = Promise { attack: attack.name.clone(), promise: attack.promise.clone(), state };
                    let mut collected = collected.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    (collected.1)(&promise);
                    collected.0.push(promise);
                }
            });
        }
    });
    let (mut promises, _) = collected.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    promises.sort_by(|left, right| left.attack.cmp(&right.attack));
    Ok(PromiseTable { promises })
}

/// Returns the attacks that the binary contains, in the order of their names.
fn attacks() -> Vec<Attack> {
    let sources =
        ATTACK_SOURCES.files().filter(|file| file.path().extension().is_some_and(|extension| extension == "c"));
    let mut attacks: Vec<Attack> = sources
        .filter_map(|file| Attack::parse(file.path().file_stem()?.to_str()?, file.contents_utf8()?).ok())
        .collect();
    attacks.sort_by(|left, right| left.name.cmp(&right.name));
    attacks
}

/// The folders and the tools that a self-test uses.
struct TestSetup<'a> {
    backend: &'a Backend,
    compiler: &'a Path,
    sources: &'a Path,
    programs: &'a Path,
    folder: &'a Path,
}

impl TestSetup<'_> {
    /// Tries one attack, and returns the state of its promise, as `Ok` or as `Err`.
    fn try_attack(&self, attack: &Attack) -> Result<PromiseState, PromiseState> {
        if let Some(need) = attack.requirements.iter().find(|need| !need.is_met(self.backend.layers())) {
            return Ok(PromiseState::NotTested(format!("this machine lacks: {}", need.name)));
        }
        let built = self.build(attack).map_err(PromiseState::NotTested)?;
        let broken = |text: String| PromiseState::Broken(text);
        let fault = |error: &dyn std::fmt::Display| PromiseState::NotTested(format!("the test itself failed: {error}"));
        let mut decoy = Decoy::set_up(&self.folder.join(format!("run-{}-{}", attack.name, unique_name())))
            .map_err(|e| fault(&e))?;
        // Each run gets its own copy of the program, by which processes that survive the run can be recognized.
        let program = decoy.copy_program(&built).map_err(|e| fault(&e))?;
        let before = decoy.read_state().map_err(|e| fault(&e))?;
        let job = Job::new(&program, &decoy.work)
            .arguments(decoy.arguments())
            .readable([&decoy.scene])
            .policy(attack.policy)
            .folder_in_memory()
            .trace(TRACE_NAME)
            .environment(environment())
            .limits(attack_limits(attack));
        let mut running = self.backend.start(&job).map_err(|e| fault(&e))?;
        if attack.expects_exit() && running.is_in_memory() {
            // These runs share a supervisor, so anything that a run leaves in it would affect the next run.
            let outcome = running.wait().map_err(|error| broken(error.to_string()))?;
            if !attack.expected_ends.iter().any(|expected| expected.matches(&outcome.ended)) {
                return Err(broken(format!("in a first run the attack {}{}", outcome.ended, last_output(&outcome))));
            }
            if decoy.contains_secret(&outcome.stdout.bytes) || decoy.contains_secret(&outcome.stderr.bytes) {
                return Err(broken("the attack printed a secret in a first run".into()));
            }
            running = self.backend.start(&job).map_err(|e| fault(&e))?;
        }
        let (outcome, folder) = running.wait_with_folder().map_err(|error| broken(error.to_string()))?;

        if let Some(left) = find_survivor(&program) {
            return Err(broken(format!("process {left} outlived the run")));
        }
        // In a container, the filter of the container engine may be the first to deny a forbidden call. Such a call is
        // not reported.
        let refused = outcome.ended == DENIED_END && attack.expects_violation() && is_filtered();
        if !refused && !attack.expected_ends.iter().any(|expected| expected.matches(&outcome.ended)) {
            return Err(broken(format!("it {}{}", outcome.ended, last_output(&outcome))));
        }
        if decoy.contains_secret(&outcome.stdout.bytes) || decoy.contains_secret(&outcome.stderr.bytes) {
            return Err(broken("the attack printed a secret".into()));
        }
        if !decoy.is_alive() {
            return Err(broken("the attack killed another process".into()));
        }
        let after = decoy.read_state().map_err(|e| broken(format!("the decoys cannot be read: {e}")))?;
        if let Some(difference) = before.find_difference(&after) {
            return Err(broken(format!("the attack changed the host: {difference}")));
        }
        check_left_trace(attack, &folder).map_err(broken)?;
        decoy.clear().map_err(|error| broken(format!("the attack's folder cannot be removed: {error}")))?;
        Ok(PromiseState::Kept)
    }

    /// Returns the built attack. It is built again only if a source file or the name of the compiler has changed.
    fn build(&self, attack: &Attack) -> Result<PathBuf, String> {
        let source = ATTACK_SOURCES.get_file(format!("{}.c", attack.name)).ok_or("the attack's source is missing")?;
        let header = ATTACK_SOURCES.get_file("attack.h").ok_or("attack.h is missing")?;
        let mut digest = blake3::Hasher::new();
        digest
            .update(source.contents())
            .update(header.contents())
            .update(self.compiler.as_os_str().as_encoded_bytes())
            .update(COMPILER_FLAGS.join(" ").as_bytes());
        let digest = digest.finalize().to_hex();
        let program = self.programs.join(format!("{}-{}", attack.name, &digest[..16]));
        if program.is_file() {
            return Ok(program);
        }
        let describe = |error: std::io::Error| format!("{}: {error}", self.compiler.display());
        let path = self.sources.join(format!("{}.c", attack.name));
        write_file(&path, source.contents()).map_err(describe)?;
        // The program gets its name after it is complete, so that an incomplete one is never used.
        let fresh = self.programs.join(format!("{}-{}", attack.name, unique_name()));
        let output = Command::new(self.compiler)
            .args(COMPILER_FLAGS)
            .arg("-o")
            .args([&fresh, &path])
            .output()
            .map_err(describe)?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr);
            let lines = text.lines().take(3).collect::<Vec<_>>();
            return Err(format!("the attack does not compile here: {}", lines.join(" ")));
        }
        std::fs::rename(&fresh, &program).map_err(describe)?;
        Ok(program)
    }
}

/// Returns a suffix that no other self-test uses. Others may use the same folder at the same time.
fn unique_name() -> String {
    static NAME_COUNT: AtomicUsize = AtomicUsize::new(0);
    format!("{}.{}", std::process::id(), NAME_COUNT.fetch_add(1, Ordering::Relaxed))
}

/// Writes a file so that others, who may be reading it, see either the old or the new contents.
fn write_file(path: &Path, contents: &[u8]) -> std::io::Result<()> {
    let fresh = path.with_extension(unique_name());
    std::fs::write(&fresh, contents)?;
    std::fs::rename(&fresh, path)
}

/// Returns small limits. With them, the suite is fast, and harmless even if a layer is missing.
fn attack_limits(attack: &Attack) -> Limits {
    Limits {
        cpu: Duration::from_millis(300),
        wall: attack.wall.unwrap_or(Duration::from_secs(20)),
        memory: 64 << 20,
        output_bytes: 64 << 10,
        trace_bytes: MAX_TRACE_BYTES,
        folder_bytes: 4 << 20,
        folder_files: 100,
        processes: 16,
        open_files: 32,
    }
}

/// Returns the environment variables of a hostile program.
fn environment() -> [(&'static str, String); 3] {
    let grader = std::fs::read_link("/proc/self/exe").unwrap_or_default();
    [
        (PERMIT_VARIABLE, "1".into()),
        (GRADER_VARIABLE, grader.display().to_string()),
        (GROUP_VARIABLE, sys::group_id().to_string()),
    ]
}

/// Returns whether this process already has a system call filter, such as that of a container.
fn is_filtered() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().any(|line| line.strip_prefix("Seccomp:").is_some_and(|mode| mode.trim() == "2"))
}

/// Returns a process in which the program still runs, in any thread; `None` if there is none.
fn find_survivor(program: &Path) -> Option<i32> {
    processes::list_all().find(|pid| {
        processes::list_threads(*pid)
            .any(|thread| std::fs::read_link(format!("/proc/{pid}/task/{thread}/exe")).is_ok_and(|exe| exe == program))
    })
}

/// Returns the last part of the program's output, for the report on a broken promise.
fn last_output(outcome: &RunOutcome) -> String {
    let last = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes);
        text.lines().last().map(|line| line.chars().take(200).collect::<String>().escape_debug().to_string())
    };
    match last(&outcome.stdout.bytes).or_else(|| last(&outcome.stderr.bytes)) {
        Some(line) => format!(" and said: {line}"),
        None => String::new(),
    }
}

/// Checks that the folder contains the trace that the attack should leave.
fn check_left_trace(attack: &Attack, work: &RemainingFolder) -> Result<(), String> {
    let collected = work.regular_file(TRACE_NAME, MAX_TRACE_BYTES).and_then(|(mut file, _)| {
        let mut bytes = Vec::new();
        let read = std::io::Read::read_to_end(&mut file, &mut bytes);
        read.map(|_| bytes).map_err(|source| CollectError::System { name: TRACE_NAME.into(), source })
    });
    match (attack.left_trace.as_deref(), collected) {
        (None, _)
        | (Some("nothing"), Err(CollectError::Missing { .. }))
        | (
            Some("refused"),
            Err(CollectError::NotRegular { .. } | CollectError::Linked { .. } | CollectError::TooLong { .. }),
        ) => Ok(()),
        (Some(text), Ok(bytes)) if bytes == text.as_bytes() => Ok(()),
        (Some(expected), Ok(bytes)) => {
            Err(format!("a trace of {} bytes was collected instead of: {expected}", bytes.len()))
        }
        (Some(expected), Err(error)) => Err(format!("{error}, instead of: {expected}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_attack_makes_a_promise_and_an_expectation() {
        let sources = ATTACK_SOURCES.files().filter(|file| file.path().extension().is_some_and(|e| e == "c"));
        let mut count = 0;
        for file in sources {
            let name = file.path().file_stem().unwrap().to_str().unwrap();
            let text = file.contents_utf8().unwrap();
            if let Err(problem) = Attack::parse(name, text) {
                panic!("{name}: {problem}");
            }
            assert!(text.contains("begin(argc);"), "{name} would run outside the sandbox");
            count += 1;
        }
        assert!(count >= 160);
        assert_eq!(attacks().len(), count);
    }
}
