//! Brings a submission to where it can be run: a copy that nobody changes, digested while it is copied.
//!
//! Sources are built in a copy of their folder, in the sandbox, so that a build changes nothing of the submission.
use super::{config::BuildStep, execute::Cancellation, grade::Build};
use crate::sandbox::{
    Backend, Ended, Job, Limits, Policy, SandboxError,
    collect::{self, CollectError},
};
use std::{
    fs::{self, File, Permissions},
    io::{self, Read, Write},
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};

/// A submission's folder may hold so many bytes and files; more is no homework.
const LARGEST_FOLDER: u64 = 1 << 30;
const MOST_FILES: u64 = 20_000;
/// What a report keeps of the compiler's output.
const KEPT_OUTPUT: usize = 64 << 10;

/// A program to run, with its digest. The copy goes away with it.
#[derive(Debug)]
pub struct Staged {
    /// Where it is.
    pub program: PathBuf,
    /// The digest of its bytes; of its path when it is no file that can be read.
    pub digest: blake3::Hash,
    /// How it was built.
    pub build: Option<Build>,
    /// Why the submission itself can't be run: its own fault.
    pub refused: Option<String>,
    _folder: Option<tempfile::TempDir>,
}

/// Why a submission can't be staged: our fault or the machine's.
#[derive(Debug, thiserror::Error)]
pub enum StagingError {
    /// The operating system refuses.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// The folder is larger than a submission can be.
    #[error("{folder} holds more than {MOST_FILES} files or {LARGEST_FOLDER} bytes: that is no submission")]
    TooLarge {
        /// The folder.
        folder: PathBuf,
    },
    /// The build command can't be found.
    #[error("build command {command} is not on this machine; install it, or change [build] in the suite")]
    NoCommand {
        /// Its name.
        command: String,
    },
    /// The sandbox failed.
    #[error(transparent)]
    Sandbox(#[from] SandboxError),
}

fn at(path: &Path) -> impl FnOnce(io::Error) -> StagingError {
    let path = path.to_owned();
    move |source| StagingError::Io { path, source }
}

/// Copies a program, keeping its permission bits, to a place that every user may read. What is not a regular file is
/// left where it is: the sandbox says what is wrong with it.
///
/// # Errors
/// When the file can't be read or the copy can't be written.
pub fn program(path: &Path) -> Result<Staged, StagingError> {
    if !fs::metadata(path).is_ok_and(|data| data.is_file()) {
        return Ok(Staged::in_place(path));
    }
    copied(File::open(path).map_err(at(path))?, path)
}

/// As [`program`], for a program at `name` in a folder that somebody else filled: a link that leads elsewhere, to
/// another's submission perhaps, is refused.
///
/// # Errors
/// When the copy can't be written.
pub fn program_in(folder: &Path, name: &str) -> Result<Staged, StagingError> {
    let path = folder.join(name);
    match collect::open_regular_file(folder, name, LARGEST_FOLDER) {
        Ok((file, _)) => copied(file, &path),
        Err(CollectError::Missing { .. }) => Ok(Staged::in_place(&path)),
        Err(error) => {
            Ok(Staged { refused: Some(format!("the program can't be used: {error}")), ..Staged::in_place(&path) })
        }
    }
}

/// The digest of a program as it lies there, without a copy; `None` for what [`program`] leaves in place.
#[must_use]
pub fn digest(path: &Path) -> Option<blake3::Hash> {
    let data = fs::symlink_metadata(path).ok()?;
    let mut hasher = blake3::Hasher::new();
    (data.is_file() && hasher.update_reader(File::open(path).ok()?).is_ok()).then(|| hasher.finalize())
}

impl Staged {
    fn in_place(path: &Path) -> Self {
        let digest = blake3::hash(path.as_os_str().as_encoded_bytes());
        Self { program: path.to_owned(), digest, build: None, refused: None, _folder: None }
    }
}

fn copied(file: File, path: &Path) -> Result<Staged, StagingError> {
    let folder = public_folder("program")?;
    let copy = folder.path().join(path.file_name().unwrap_or_else(|| "program".as_ref()));
    let digest = copy_file(file, path, &copy)?;
    Ok(Staged { program: copy, digest, build: None, refused: None, _folder: Some(folder) })
}

/// Builds the sources in `folder`, in a copy, and stages the program that comes out of it. A build that fails is no
/// error: [`Staged::build`] tells of it.
///
/// # Errors
/// Faults of ours or of the machine.
pub fn build(
    sources: &Path,
    step: &BuildStep,
    backend: &Backend,
    cancellation: &Cancellation,
) -> Result<Staged, StagingError> {
    let folder = public_folder("build")?;
    let copy = folder.path().join("submission");
    let mut budget = Budget { bytes: LARGEST_FOLDER, files: MOST_FILES };
    let failed = |end: String, output: String| {
        let build = Some(Build { succeeded: false, end, output });
        Staged { build, ..Staged::in_place(&sources.join(&step.program)) }
    };
    match copy_folder(sources, &copy, &mut budget) {
        Err(error @ StagingError::TooLarge { .. }) => return Ok(failed(error.to_string(), String::new())),
        copied => copied?,
    }
    let Some((command, arguments)) = step.command.split_first() else {
        return Err(StagingError::NoCommand { command: String::new() });
    };
    let tool = match find_tool(command, &copy) {
        Some(tool) => tool,
        // A script of the submission's own that is missing is the submission's fault.
        None if command.contains('/') => {
            return Ok(failed(format!("the submission holds no {command}, which builds it"), String::new()));
        }
        None => return Err(StagingError::NoCommand { command: command.clone() }),
    };
    let limits = Limits {
        cpu: step.wall,
        wall: step.wall,
        memory: step.memory,
        output_bytes: 4 << 20,
        folder_bytes: 4 << 30,
        folder_files: 100_000,
        processes: 128,
        open_files: 1024,
        ..Limits::default()
    };
    let job = Job::new(tool, &copy).arguments(arguments.iter().cloned()).policy(Policy::Tools).limits(limits);
    let running = backend.start(&job)?;
    let _registered = cancellation.register(running.canceller());
    let outcome = running.wait()?;
    let mut output = outcome.stdout.bytes.clone();
    output.extend_from_slice(&outcome.stderr.bytes);
    let cut = output.len() > KEPT_OUTPUT || outcome.stdout.truncated || outcome.stderr.truncated;
    output.truncate(KEPT_OUTPUT);
    let mut output = String::from_utf8_lossy(&output).into_owned();
    if cut {
        output.push_str("\n[cut short]");
    }
    if outcome.ended != Ended::Exited(0) {
        return Ok(failed(format!("the build {}", outcome.ended), output));
    }
    // The build could have left a link to anything where the program should be.
    match collect::open_regular_file(&copy, &step.program, LARGEST_FOLDER) {
        Ok((file, _)) => {
            let build = Some(Build { succeeded: true, end: "the build succeeded".to_owned(), output });
            Ok(Staged { build, ..copied(file, &copy.join(&step.program))? })
        }
        Err(CollectError::Missing { .. }) => Ok(failed(format!("the build made no {}", step.program), output)),
        Err(error) => Ok(failed(format!("what the build made can't be used: {error}"), output)),
    }
}

/// A temporary folder that other users may enter: as root the program runs as one of them.
fn public_folder(purpose: &str) -> Result<tempfile::TempDir, StagingError> {
    let temporary = std::env::temp_dir();
    let folder = tempfile::Builder::new().prefix(&prefix(purpose)).tempdir().map_err(at(&temporary))?;
    fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).map_err(at(folder.path()))?;
    Ok(folder)
}

/// How the names of this process's temporary folders begin.
pub(super) fn prefix(purpose: &str) -> String {
    format!("fosssim-{}-{purpose}-", std::process::id())
}

/// Removes the temporary folders of graders that were killed.
pub fn sweep() {
    for entry in fs::read_dir(std::env::temp_dir()).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let owner =
            name.to_str().and_then(|name| name.strip_prefix("fosssim-")?.split_once('-')?.0.parse::<u32>().ok());
        if owner.is_some_and(|owner| !Path::new("/proc").join(owner.to_string()).exists()) {
            // Somebody else's is left to them.
            drop(fs::remove_dir_all(entry.path()));
        }
    }
}

/// Copies an open regular file with its permission bits and digests it on the way.
fn copy_file(mut source: File, from: &Path, to: &Path) -> Result<blake3::Hash, StagingError> {
    let mode = source.metadata().map_err(at(from))?.permissions().mode();
    let mut target = File::create(to).map_err(at(to))?;
    let mut hasher = blake3::Hasher::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        let length = source.read(&mut buffer).map_err(at(from))?;
        if length == 0 {
            break;
        }
        hasher.update(&buffer[..length]);
        target.write_all(&buffer[..length]).map_err(at(to))?;
    }
    // No set-user-id, and readable by the user that runs it.
    fs::set_permissions(to, Permissions::from_mode(mode & 0o111 | 0o644)).map_err(at(to))?;
    Ok(hasher.finalize())
}

/// What of a submission may still be copied.
struct Budget {
    bytes: u64,
    files: u64,
}

/// Copies a folder: files and folders only, links and everything else stay behind.
fn copy_folder(from: &Path, to: &Path, budget: &mut Budget) -> Result<(), StagingError> {
    fs::create_dir(to).map_err(at(to))?;
    for entry in fs::read_dir(from).map_err(at(from))? {
        let entry = entry.map_err(at(from))?;
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        let data = fs::symlink_metadata(&source).map_err(at(&source))?;
        let too_large = || StagingError::TooLarge { folder: from.to_owned() };
        budget.files = budget.files.checked_sub(1).ok_or_else(too_large)?;
        if data.is_dir() {
            copy_folder(&source, &target, budget)?;
        } else if data.is_file() {
            budget.bytes = budget.bytes.checked_sub(data.len()).ok_or_else(too_large)?;
            copy_file(File::open(&source).map_err(at(&source))?, &source, &target)?;
        }
    }
    Ok(())
}

/// A command by its path, relative to the sources, or by its name in the system's folders.
fn find_tool(command: &str, sources: &Path) -> Option<PathBuf> {
    let candidates: Vec<PathBuf> = if command.contains('/') {
        vec![sources.join(command)]
    } else {
        ["/usr/local/bin", "/usr/bin", "/bin"].map(|folder| Path::new(folder).join(command)).into()
    };
    candidates.into_iter().find(|path| path.is_file())
}
