//! Copies a submission into a folder in which it can run. No other process can read or change the copy. The copy's
//! digest is computed while it is written.
//!
//! Each file is opened once, below the submission's folder, without following links or blocking, and all checks use the
//! open file. A user who may write into that folder can replace a name, but not the open file. If a file can't be
//! copied because of its kind or its permissions, the submission is at fault, not the grader. Sources are built in a
//! copy of their folder, in the sandbox, so that a build changes nothing of the submission.
use super::{
    cancellation::Cancellation,
    conclusion::truncate,
    config::BuildStep,
    grade::Build,
    program_file::{ProgramFile, belongs_to_another},
    result::{BuildEnd, UnusableReason},
    temporary_folders::TemporaryFolder,
};
use fosssim_intake::FileKind;
use fosssim_sandbox::{
    Backend, Job, Limits, Policy, ProgramIdentity, RunEnd, StartProblem,
    collect::{self, CollectError, FolderEntry, OpenFolder},
    is_own_file,
};
use std::{
    ffi::OsStr,
    fs::{self, File, Permissions},
    io::{self, Read, Seek, SeekFrom, Write},
    os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt, PermissionsExt},
    path::{Path, PathBuf},
};

/// The maximum size of a submission's folder, in bytes.
pub(super) const MAX_FOLDER_BYTES: u64 = 1 << 30;
const MAX_FILES: u64 = 20_000;
/// The maximum size of the folder in which a build runs, including the sources, in bytes.
const MAX_BUILD_BYTES: u64 = 2 << 30;
const MAX_DEPTH: u32 = 64;
/// The maximum number of bytes of the compiler's output that are kept for reports.
const MAX_OUTPUT_BYTES: usize = 64 << 10;
/// The number of bytes that are copied at a time.
const BLOCK_BYTES: usize = 1 << 16;

/// A copy of a program that can be run, and its digest. When the value is dropped, the copy is removed.
#[derive(Debug)]
pub struct StagedProgram {
    /// The path of the copied program.
    pub program: PathBuf,
    /// The digest of the program's bytes. If there is no program that can be run, the digest of the submission's path.
    pub digest: blake3::Hash,
    /// The result of the build, if the program was built.
    pub build: Option<Build>,
    /// The reason why the submission cannot be run, if there is one. The submission itself is at fault.
    pub unusable_reason: Option<UnusableReason>,
    /// The identity of the file that was copied.
    pub(super) identity: Option<ProgramIdentity>,
    _folder: Option<TemporaryFolder>,
}

/// Returns a function that makes a message from an error of the operating system, with the path that it is about.
pub(super) fn describe_error_at(path: &Path) -> impl FnOnce(io::Error) -> String {
    move |error| format!("{}: {error}", path.display())
}

/// The reason why a submission's files were not copied.
#[derive(Debug)]
pub(super) enum CopyError {
    /// The submission is at fault; the value is the reason.
    Submission(String),
    /// The grader or the machine is at fault; the value is the reason.
    Grader(String),
}

impl From<String> for CopyError {
    fn from(message: String) -> Self {
        Self::Grader(message)
    }
}

/// Decides who is at fault if a file of a submission cannot be opened or read. If the file is missing or not
/// accessible, the submission is at fault.
pub(super) fn classify_error(name: &Path, error: io::Error) -> CopyError {
    // If a path is too long, the submission is at fault. If a disk fails, the machine is at fault.
    let closed = matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::NotFound);
    match closed || error.kind() == io::ErrorKind::InvalidFilename {
        true => CopyError::Submission(format!("{} can't be read: {error}", name.to_string_lossy().escape_debug())),
        false => CopyError::Grader(describe_error_at(name)(error)),
    }
}

/// Copies the program with whose speed submissions are compared. The copy has the name of the course's original, which
/// makes it run in that role.
///
/// # Errors
///
/// Fails if the program can't be read or copied.
pub fn stage_reference(path: &Path) -> Result<StagedProgram, String> {
    let (file, _) = collect::open_file(path, true).map_err(|error| describe_error_at(path)(io::Error::other(error)))?;
    copy_as(OsStr::new("FOSSSimOracle"), file, path, &mut { MAX_FOLDER_BYTES }).map_err(|error| match error {
        CopyError::Submission(why) => describe_error_at(path)(io::Error::other(why)),
        CopyError::Grader(why) => why,
    })
}

pub(super) fn open_in_folder(folder: &Path, name: &str) -> Result<File, CollectError> {
    let opened = OpenFolder::open(folder).map_err(|source| CollectError::System { name: name.to_owned(), source })?;
    opened.open_file(OsStr::new(name), MAX_FOLDER_BYTES).map(|(file, _)| file)
}

/// Returns the digest of a file without copying it. For links, and for files that [`collect::open_file`] rejects,
/// returns `None`.
pub fn digest_file(path: &Path) -> Option<blake3::Hash> {
    let (file, length) = collect::open_file(path, false).ok()?;
    if length <= MAX_FOLDER_BYTES { digest_open_file(file) } else { None }
}

/// Returns the digest of the file that `Recipe::stage_file_in` would copy, without copying it. Returns `None` if the
/// file can't be read, or if it belongs to another submission.
pub fn digest_in(folder: &Path, name: &str, noted: Option<&ProgramFile>) -> Option<blake3::Hash> {
    let file = open_in_folder(folder, name).ok()?;
    if belongs_to_another(&file, noted).ok()? { None } else { digest_open_file(file) }
}

fn digest_open_file(file: File) -> Option<blake3::Hash> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(file.take(MAX_FOLDER_BYTES)).is_ok().then(|| hasher.finalize())
}

impl StagedProgram {
    /// Creates the value for a submission that has no program that can be run.
    fn without_program(path: &Path) -> Self {
        let digest = blake3::hash(path.as_os_str().as_encoded_bytes());
        Self { program: path.to_owned(), digest, build: None, unusable_reason: None, identity: None, _folder: None }
    }

    pub(super) fn from_unusable(path: &Path, reason: UnusableReason) -> Self {
        Self { unusable_reason: Some(reason), ..Self::without_program(path) }
    }

    /// Returns the digest of the program's bytes; `None` if there is no program that can be run.
    pub(super) fn program_digest(&self) -> Option<blake3::Hash> {
        let is_built = self.build.as_ref().is_none_or(|build| build.end.is_success());
        (is_built && self.unusable_reason.is_none()).then_some(self.digest)
    }
}

/// Copies an open program, unless it is the grader itself or cannot be started.
pub(super) fn copy_program(file: File, path: &Path, backend: &Backend) -> Result<StagedProgram, String> {
    let metadata = file.metadata().map_err(describe_error_at(path))?;
    let name = path.file_name().unwrap_or_else(|| "program".as_ref());
    // A modified copy of the grader with this name would also write correct traces, so the name is checked as well.
    let is_oracle = name.as_encoded_bytes().starts_with(b"FOSSSimOracle");
    let reason = match copy_as(name, file, path, &mut { MAX_FOLDER_BYTES }) {
        Ok(staged) => {
            let is_own =
                is_own_file(&staged.program, (metadata.dev(), metadata.ino())).map_err(describe_error_at(path))?;
            let own = (is_oracle || is_own).then_some(StartProblem::GradersOwn);
            match own.or_else(|| backend.start_problem(&staged.program)) {
                None => return Ok(staged),
                Some(problem) => UnusableReason::CouldNotStart(problem),
            }
        }
        Err(CopyError::Submission(reason)) => UnusableReason::Unreadable(reason),
        Err(CopyError::Grader(reason)) => return Err(reason),
    };
    Ok(StagedProgram::from_unusable(path, reason))
}

/// Copies an open program into a new folder, where it is called `name`.
fn copy_as(name: &OsStr, file: File, path: &Path, room: &mut u64) -> Result<StagedProgram, CopyError> {
    let folder = TemporaryFolder::create("program").map_err(describe_error_at(&std::env::temp_dir()))?;
    let copy = folder.path().join(name);
    // The copy is executable, even if the upload has lost this permission.
    let digest = copy_file(file, path, &copy, room, true)?;
    let identity = ProgramIdentity::from_path(&copy);
    Ok(StagedProgram { program: copy, digest, build: None, unusable_reason: None, identity, _folder: Some(folder) })
}

/// Builds a copy of the sources in `folder`, and copies the resulting program. If the build fails, this is not an
/// error, but described in [`StagedProgram::build`].
pub(super) fn build(
    sources: &Path,
    step: &BuildStep,
    backend: &Backend,
    cancellation: &Cancellation,
) -> Result<StagedProgram, String> {
    let folder = TemporaryFolder::create("build").map_err(describe_error_at(&std::env::temp_dir()))?;
    let copy = folder.path().join("submission");
    let failed = |end: BuildEnd, output: String| {
        let build = Some(Build { end, output });
        StagedProgram { build, ..StagedProgram::without_program(&sources.join(&step.program)) }
    };
    match copy_sources(sources, &copy) {
        Err(CopyError::Submission(why)) => return Ok(failed(BuildEnd::UnusableSources(why), String::new())),
        Err(CopyError::Grader(why)) => return Err(why),
        Ok(()) => {}
    }
    let command = step.command.first().map_or("", String::as_str);
    let tool = match find_tool(command, &copy) {
        Some(tool) => tool,
        // If a script of the submission is missing, the submission is at fault.
        None if command.contains('/') => return Ok(failed(BuildEnd::MissingScript(command.to_owned()), String::new())),
        None => {
            return Err(format!(
                "build command {command} is not installed on this machine; install it, or change [build] in the suite"
            ));
        }
    };
    let limits = Limits {
        cpu: step.wall,
        wall: step.wall,
        memory: step.memory,
        output_bytes: 4 << 20,
        folder_bytes: MAX_BUILD_BYTES,
        folder_files: 100_000,
        processes: 128,
        open_files: 1024,
        ..Limits::default()
    };
    let job = Job::new(tool, &copy)
        .arguments(step.command.iter().skip(1).cloned())
        .policy(Policy::Tools)
        .limits(limits)
        .folder_in_memory();
    let running = backend.start(&job).map_err(|error| error.to_string())?;
    let _registered = cancellation.register(running.canceler());
    let (outcome, made) = running.wait_with_folder().map_err(|error| error.to_string())?;
    let printed = [&outcome.stdout.bytes[..], &outcome.stderr.bytes].concat();
    let output = truncate(&printed, MAX_OUTPUT_BYTES);
    if outcome.ended != RunEnd::Exited(0) {
        return Ok(failed(BuildEnd::Failure(outcome.ended), output));
    }
    // The build may have put a link where the program should be.
    match made.regular_file(&step.program, MAX_FOLDER_BYTES) {
        Ok((file, _)) => {
            let build = Some(Build { end: BuildEnd::Success, output });
            Ok(StagedProgram { build, ..copy_program(file, &copy.join(&step.program), backend)? })
        }
        Err(CollectError::Missing { .. }) => Ok(failed(BuildEnd::MissingProgram(step.program.clone()), output)),
        Err(error) => Ok(failed(BuildEnd::UnusableProgram(error.to_string()), output)),
    }
}

/// Copies an open regular file, and returns the digest of its bytes. Holes in the file remain holes. `room` is the
/// number of bytes that may still be copied; it is reduced by the file's size. The copy is executable if the file is
/// executable, if it begins like a program, or if `is_program` is set.
fn copy_file(
    mut source: File,
    from: &Path,
    to: &Path,
    room: &mut u64,
    is_program: bool,
) -> Result<blake3::Hash, CopyError> {
    const EXECUTE_BITS: u32 = 0o111;
    let mode = source.metadata().map_err(describe_error_at(from))?.permissions().mode();
    let mut executable = is_program || mode & EXECUTE_BITS != 0;
    let mut target =
        File::options().write(true).create_new(true).mode(0o600).open(to).map_err(describe_error_at(to))?;
    let mut hasher = blake3::Hasher::new();
    let mut buffer = vec![0; BLOCK_BYTES];
    let mut length = 0;
    loop {
        let read = match source.read(&mut buffer) {
            Ok(0) => break,
            Ok(read) => &buffer[..read],
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(classify_error(from, error)),
        };
        // The file may have become longer after its length was read.
        *room = room.checked_sub(read.len() as u64).ok_or_else(too_large_error)?;
        hasher.update(read);
        executable |= length == 0 && FileKind::from_start(read) == FileKind::Program;
        length += read.len() as u64;
        if read.iter().all(|byte| *byte == 0) {
            target.seek(SeekFrom::Start(length)).map_err(describe_error_at(to))?;
        } else {
            target.write_all(read).map_err(describe_error_at(to))?;
        }
    }
    target.set_len(length).map_err(describe_error_at(to))?;
    let mode = if executable { 0o755 } else { 0o644 };
    target.set_permissions(Permissions::from_mode(mode)).map_err(describe_error_at(to))?;
    Ok(hasher.finalize())
}

fn too_large_error() -> CopyError {
    CopyError::Submission(format!(
        "the submission contains more than {MAX_FILES} files or {MAX_FOLDER_BYTES} bytes, which is too much"
    ))
}

/// The numbers of bytes and files of a submission that may still be copied.
struct CopyBudget {
    bytes: u64,
    files: u64,
}

/// Copies a submission's folder to a new folder, which only the grader can enter.
fn copy_sources(from: &Path, to: &Path) -> Result<(), CopyError> {
    let mut budget = CopyBudget { bytes: MAX_FOLDER_BYTES, files: MAX_FILES };
    let source = OpenFolder::open(from).map_err(|error| classify_error(from, error))?;
    fs::DirBuilder::new().mode(0o700).create(to).map_err(describe_error_at(to))?;
    let target = OpenFolder::open(to).map_err(describe_error_at(to))?;
    copy_folder(&source, Path::new(""), &target, 1, &mut budget)
}

/// Copies the files and folders in a folder. Links and other entries are skipped. `name` is the folder's name in
/// messages.
fn copy_folder(
    from: &OpenFolder,
    name: &Path,
    to: &OpenFolder,
    depth: u32,
    budget: &mut CopyBudget,
) -> Result<(), CopyError> {
    if depth > MAX_DEPTH {
        let top = name.components().next().map(|part| part.as_os_str().to_string_lossy().escape_debug().to_string());
        return Err(CopyError::Submission(format!(
            "the submission's folders are nested more than {MAX_DEPTH} deep, in {}",
            top.unwrap_or_default()
        )));
    }
    for entry in from.list_names().map_err(|error| classify_error(name, error))? {
        if fosssim_intake::is_generated_name(&entry) {
            continue;
        }
        budget.files = budget.files.checked_sub(1).ok_or_else(too_large_error)?;
        let (inner, target) = (name.join(&entry), to.path().join(&entry));
        match from.entry(OsStr::new(&entry)) {
            Ok(FolderEntry::File(file)) => {
                let length = file.metadata().map_err(describe_error_at(&inner))?.len();
                if length > budget.bytes {
                    return Err(too_large_error());
                }
                copy_file(file, &inner, &target, &mut budget.bytes, false)?;
            }
            Ok(FolderEntry::Folder(folder)) => {
                fs::create_dir(&target).map_err(describe_error_at(&inner))?;
                let target = OpenFolder::open(&target).map_err(describe_error_at(&inner))?;
                copy_folder(&folder, &inner, &target, depth + 1, budget)?;
            }
            Ok(FolderEntry::Other) => {}
            Err(error) => return Err(classify_error(&inner, error)),
        }
    }
    Ok(())
}

/// Finds the command that builds sources. It is given by its path relative to the sources, or by its name in the
/// system's folders.
fn find_tool(command: &str, sources: &Path) -> Option<PathBuf> {
    let candidates: Vec<PathBuf> = if command.contains('/') {
        vec![sources.join(command)]
    } else {
        ["/usr/local/bin", "/usr/bin", "/bin"].map(|folder| Path::new(folder).join(command)).into()
    };
    candidates.into_iter().find(|path| path.is_file())
}

/// Creates a folder that contains a pipe, a socket and a link. The socket exists as long as the returned listener.
#[cfg(test)]
pub(crate) fn make_odd_entries(folder: &Path) -> std::os::unix::net::UnixListener {
    std::fs::create_dir(folder).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(folder.join("pipe")).status().unwrap().success());
    std::os::unix::fs::symlink("/etc/passwd", folder.join("link")).unwrap();
    std::os::unix::net::UnixListener::bind(folder.join("socket")).unwrap()
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    fn program(path: &Path) -> StagedProgram {
        let (file, _) = collect::open_file(path, true).unwrap();
        copy_program(file, path, &Backend::fake(|_| unreachable!("nothing is run"))).unwrap()
    }

    fn why(copied: Result<(), CopyError>) -> String {
        match copied {
            Err(CopyError::Submission(why)) => why,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn folders_that_are_nested_too_deep_are_the_submissions_own_fault() {
        let folder = tempfile::tempdir().unwrap();
        let sources = folder.path().join("sources");
        std::fs::create_dir_all(sources.join("deep/".repeat(60))).unwrap();
        copy_sources(&sources, &folder.path().join("copy")).unwrap();
        assert!(folder.path().join("copy").join("deep/".repeat(60)).is_dir());
        std::fs::create_dir_all(sources.join("deeper/".repeat(500))).unwrap();
        let why = why(copy_sources(&sources, &folder.path().join("other")));
        assert!(why.contains("nested more than 64 deep") && why.contains("deeper"), "{why}");
        collect::remove_folder(&sources).unwrap();
    }

    #[test]
    fn only_files_and_folders_are_copied_and_nothing_is_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let sources = folder.path().join("sources");
        let _socket = make_odd_entries(&sources);
        symlink("/etc", sources.join("way")).unwrap();
        std::fs::write(sources.join("file"), "text").unwrap();
        let copy = folder.path().join("copy");
        copy_sources(&sources, &copy).unwrap();
        let names: Vec<_> = std::fs::read_dir(&copy).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(names, ["file"]);
        assert_eq!(copy.metadata().unwrap().permissions().mode() & 0o777, 0o700, "closed to others");
    }

    #[test]
    fn whoever_exchanges_a_file_for_a_link_meanwhile_gains_nothing() {
        const ROUNDS: u32 = 300;
        let folder = tempfile::tempdir().unwrap();
        let sources = folder.path().join("sources");
        std::fs::create_dir(&sources).unwrap();
        let (secret, file, link, honest) = (folder.path().join("secret"), "main.cpp", "spare", "int main() {}");
        std::fs::write(&secret, "the secret").unwrap();
        std::fs::write(sources.join("honest"), honest).unwrap();
        std::fs::write(sources.join(file), honest).unwrap();
        let done = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(std::sync::atomic::Ordering::Relaxed) {
                    symlink(&secret, sources.join(link)).unwrap();
                    std::fs::rename(sources.join(link), sources.join(file)).unwrap();
                    std::fs::copy(sources.join("honest"), sources.join(link)).unwrap();
                    std::fs::rename(sources.join(link), sources.join(file)).unwrap();
                }
            });
            for round in 0..ROUNDS {
                let copy = folder.path().join(format!("copy{round}"));
                // The first copy may fail because an entry was removed. Any other failure is the submission's fault.
                if !matches!(copy_sources(&sources, &copy), Err(CopyError::Grader(_))) {
                    let text = std::fs::read_to_string(copy.join(file)).unwrap_or_default();
                    assert!(!text.contains("secret"), "a link was followed");
                }
                std::fs::remove_dir_all(&copy).unwrap();
            }
            done.store(true, std::sync::atomic::Ordering::Relaxed);
        });
    }

    #[test]
    fn holes_are_digested_and_not_written_out() {
        let folder = tempfile::tempdir().unwrap();
        let sparse = folder.path().join("sparse");
        let file = File::create(&sparse).unwrap();
        file.set_len(200 << 20).unwrap();
        std::fs::set_permissions(&sparse, Permissions::from_mode(0o755)).unwrap();
        let staged = program(&sparse);
        let copy = staged.program.metadata().unwrap();
        assert_eq!(copy.len(), 200 << 20);
        assert!(copy.blocks() * 512 < 1 << 20, "{} blocks", copy.blocks());
        let mut hasher = blake3::Hasher::new();
        hasher.update_reader(File::open(&sparse).unwrap()).unwrap();
        assert_eq!(staged.digest, hasher.finalize());
    }

    #[test]
    fn a_submission_that_is_too_large_is_unusable() {
        let folder = tempfile::tempdir().unwrap();
        let sources = folder.path().join("sources");
        std::fs::create_dir(&sources).unwrap();
        File::create(sources.join("huge")).unwrap().set_len(100 << 30).unwrap();
        assert!(why(copy_sources(&sources, &folder.path().join("copy"))).contains("which is too much"));
    }

    #[test]
    fn a_grader_of_any_build_is_no_submission_under_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let copy = folder.path().join("FOSSSim");
        let mut bytes = std::fs::read("/bin/sh").unwrap();
        bytes.extend(fosssim_sandbox::MARK_BACKWARDS.iter().rev());
        bytes.push(0);
        std::fs::write(&copy, bytes).unwrap();
        assert_eq!(program(&copy).unusable_reason, Some(UnusableReason::CouldNotStart(StartProblem::GradersOwn)));
    }
}
