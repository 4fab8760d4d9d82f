//! The grader as a child process: `fosssim-oracle grade`. A panic, an endless loop or a lack of memory in the grader
//! does not stop the worker, and everything that the child leaves behind is removed with the job.
use super::{
    Grader, GraderFault, GradingOutput, NewFile, PROGRESS_FILE,
    child::{Child, End},
    grade_reader,
};
use crate::{
    store::digest_of_file,
    task::{Form, Suite, Task},
};
use fosssim_intake::ArchiveLimits;
use std::{
    fs, io,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::Command,
    time::Duration,
};
use tokio_util::sync::CancellationToken;

/// The maximum time for the grader to write its reports after it was stopped.
pub(super) const GRACE_PERIOD: Duration = Duration::from_secs(20);

/// The maximum length of a message of the grader that administrators see.
const MAX_MESSAGE_LENGTH: usize = 2000;

/// The file name of the page for staff, which includes everything.
pub const STAFF_PAGE: &str = "staff.html";

/// The file name of the page that students see after hidden groups are published. It is written only if there are
/// hidden groups.
pub const PUBLISHED_PAGE: &str = "published.html";

/// The reports of a grading: the option that requests the report, the file name, and the media type. Two pages are
/// written without an option.
pub const REPORTS: [(&str, &str, &str); 5] = [
    ("json", "grade.json", "application/json"),
    ("text", "report.txt", "text/plain; charset=utf-8"),
    ("html", "report.html", "text/html; charset=utf-8"),
    ("", STAFF_PAGE, "text/html; charset=utf-8"),
    ("", PUBLISHED_PAGE, "text/html; charset=utf-8"),
];

/// The grader as a program: `fosssim-oracle`, or one with the same interface.
#[derive(Debug, Clone)]
pub struct Program {
    path: PathBuf,
    threads: usize,
}

impl Program {
    /// Creates the grader from the path of its program. `threads` is the number of scenes that run in parallel.
    pub fn new(path: PathBuf, threads: usize) -> Self {
        Self { path, threads }
    }

    /// Returns the SHA-256 digest of the grader's file; empty if the file can't be read.
    async fn digest(&self) -> String {
        digest_of_file(&self.path).await.map_or_else(|_| String::new(), |grader| grader.digest.to_string())
    }

    fn command(&self, task: &Task, submission: &Path, folder: &Path) -> Command {
        let mut command = Command::new(&self.path);
        command.arg("grade").arg(submission).arg("--jobs").arg(self.threads.to_string());
        match task.submission.form {
            Form::Program => {}
            Form::Sources => drop(command.arg("--single").arg("--program").arg(&task.program)),
            Form::Traces => drop(command.arg("--traces")),
        }
        match &task.suite {
            // Without a name, the grader uses its default suite.
            Suite::Named(name) if name.is_empty() => {}
            Suite::Named(name) => drop(command.arg("--suite").arg(name)),
            Suite::Archive(_) => drop(command.arg("--suite").arg(folder.join("suite/suite.toml"))),
        }
        if let Some(rules) = &task.rules {
            command.arg("--rules").arg(rules);
        }
        if let Some(hints) = &task.hints {
            command.arg("--hints").arg(hints);
        }
        if task.smallest {
            command.arg("--smallest");
        }
        // Reports contain only what students may see, except for hidden groups. Only the page leaves hidden groups out,
        // so the server shows the other reports to staff only.
        command.args(["--for", "student"]);
        for (format, file, _) in REPORTS.into_iter().filter(|(format, _, _)| !format.is_empty()) {
            command.arg("--format").arg(format!("{format}={}", folder.join(file).display()));
        }
        isolate(&mut command, folder);
        // A grader other than fosssim-oracle may not have these options.
        command.env("FOSSSIM_PLATFORM_HIDES", "true");
        command.env("FOSSSIM_PROGRESS", folder.join(PROGRESS_FILE));
        command.env("FOSSSIM_STAFF_PAGE", folder.join(STAFF_PAGE));
        command.env("FOSSSIM_PUBLISHED_PAGE", folder.join(PUBLISHED_PAGE));
        command
    }
}

/// The scene with which the grader is checked. It is a small scene that the grader contains.
const CHECK_SCENE: &str = "ContinuousTimeTests/diagonal-bullets-both-ways";

/// The number of bytes that the folder for jobs must have space for.
const REQUIRED_BYTES: usize = 8 << 20;

/// The maximum duration of one step of a check.
const CHECK_TIMEOUT: Duration = Duration::from_secs(60);

impl Program {
    /// Runs the grader as a step of a check, and returns its exit code.
    async fn run_step(&self, folder: &Path, arguments: &[&str], stop: &CancellationToken) -> Result<i32, String> {
        let messages = folder.join("messages.txt");
        let mut command = Command::new(&self.path);
        command.args(arguments);
        isolate(&mut command, folder);
        command.stderr(fs::File::create(&messages).map_err(|error| format!("cannot write messages: {error}"))?);
        let child = Child::start(command).map_err(|error| format!("cannot start the grader: {error}"))?;
        let end = tokio::select! {
            end = child.wait() => Some(end),
            () = stop.cancelled() => None,
            () = tokio::time::sleep(CHECK_TIMEOUT) => None,
        };
        let step = arguments[0];
        match end {
            Some(End::Code(code @ (0..=2))) => Ok(code),
            Some(End::Code(code)) => Err(format!("`{step}` ended with exit code {code}: {}", last_output(&messages))),
            Some(End::Signal(signal)) => Err(format!("`{step}` was killed by signal {signal}")),
            None => {
                child.kill();
                child.wait().await;
                Err(format!("`{step}` did not end"))
            }
        }
    }

    /// Grades an example submission, and checks that the verdict is the expected one.
    async fn check_example(
        &self,
        folder: &Path,
        submission: &[&str],
        code: i32,
        stop: &CancellationToken,
    ) -> Result<(), String> {
        let grade_file = folder.join("proof.json");
        let format = format!("json={}", grade_file.display());
        let arguments = [&["grade"], submission, &["--scene", CHECK_SCENE, "--format", &format]].concat();
        let exit_code = self.run_step(folder, &arguments, stop).await?;
        if exit_code != code {
            let message = last_output(&folder.join("messages.txt"));
            return Err(format!("grading an example ended with exit code {exit_code}, not {code}: {message}"));
        }
        let graded = grade_reader::read_grade(&grade_file)?;
        crate::problem::ensure((graded.code == "AC") == (code == 0), format!("an example was graded {}", graded.code))
    }
}

/// Makes a command run in a folder, without the server's environment variables, which may contain secrets.
pub(super) fn isolate(command: &mut Command, folder: &Path) {
    command.env_clear().current_dir(folder);
    for name in ["PATH", "HOME", "LANG", "TMPDIR"] {
        if let Some(value) = std::env::var_os(name) {
            command.env(name, value);
        }
    }
}

impl Grader for Program {
    /// Checks that the grader works. The disk must have enough free space, and the grader must accept the reference's
    /// own trace of a scene. It must also run a program that does nothing in the sandbox, and not accept it. A grader
    /// that records no traces, as in tests, is only started.
    async fn check_ability(&self, folder: &Path, stop: CancellationToken) -> Result<(), String> {
        let reserve = folder.join("room");
        fs::write(&reserve, vec![1; REQUIRED_BYTES])
            .map_err(|error| format!("the disk has too little free space for grading: {error}"))?;
        fs::remove_file(&reserve).map_err(|error| error.to_string())?;
        let trace = folder.join("right").join(CHECK_SCENE).with_extension("bin");
        let idle = folder.join("idle");
        let group_folder = trace.parent().unwrap_or(folder);
        fs::create_dir_all(group_folder).and_then(|()| fs::create_dir(&idle)).map_err(|error| error.to_string())?;
        let simulate = ["simulate", &format!("asset:{CHECK_SCENE}"), "--output", &trace.display().to_string()];
        if self.run_step(folder, &simulate, &stop).await? != 0 {
            return Ok(());
        }
        self.check_example(folder, &[&folder.join("right").display().to_string(), "--traces"], 0, &stop).await?;
        let program = idle.join("FOSSSim");
        fs::write(&program, "#!/bin/sh\nexit 0\n").map_err(|error| error.to_string())?;
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).map_err(|error| error.to_string())?;
        self.check_example(folder, &[&program.display().to_string()], 1, &stop).await
    }

    async fn grade(
        &self,
        task: &Task,
        submission: &Path,
        suite: Option<&Path>,
        folder: &Path,
        stop: CancellationToken,
    ) -> Result<GradingOutput, GraderFault> {
        let program = match task.submission.form {
            Form::Program => {
                place_program(submission, folder, &task.submission.name).map_err(fault_about("place the program"))?
            }
            Form::Sources => unpack(submission, folder.join("submission")).await?.0,
            // The archive's top folder is kept, because it may be the group of all scenes.
            Form::Traces => unpack(submission, folder.join("submission")).await?.1,
        };
        if let Some(suite) = suite {
            unpack(suite, folder.join("suite")).await?;
        }
        // The digest is computed before the grader runs, because another version may be installed during the run.
        let grader = self.digest().await;
        let messages = folder.join("messages.txt");
        let mut command = self.command(task, &program, folder);
        command.stderr(fs::File::create(&messages).map_err(fault_about("write the messages"))?);
        let child = Child::start(command).map_err(fault_about("start the grader"))?;
        let (end, stopped) = wait_for_end(&child, Duration::from_secs(task.seconds), &stop).await?;
        let message = || last_output(&messages);
        match end {
            // The exit codes mean: 0 accepted, 1 not accepted, 130 stopped with partial results.
            End::Code(0 | 1) => {}
            End::Code(130) if stopped => {}
            End::Code(code) => {
                return Err(GraderFault::Failed(format!("the grader ended with exit code {code}: {}", message())));
            }
            End::Signal(signal) => {
                return Err(GraderFault::Failed(format!("the grader was killed by signal {signal}: {}", message())));
            }
        }
        let mut outcome = grade_reader::read_grade(&folder.join("grade.json")).map_err(GraderFault::Failed)?;
        outcome.grader = grader;
        if stopped {
            outcome.summary = format!("stopped after {} seconds; {}", task.seconds, outcome.summary);
        }
        let new = |(_, name, media_type): &(_, &str, &str)| NewFile {
            name: (*name).to_owned(),
            media_type: (*media_type).to_owned(),
            path: folder.join(name),
        };
        let files = REPORTS.iter().map(new).filter(|file| file.path.exists()).collect();
        Ok(GradingOutput { outcome, files })
    }
}

/// Waits until the grader ends. Returns how it ended, and whether it exceeded the time limit.
async fn wait_for_end(child: &Child, limit: Duration, stop: &CancellationToken) -> Result<(End, bool), GraderFault> {
    let (mut remaining, mut is_late) = (limit, false);
    loop {
        tokio::select! {
            end = child.wait() => return Ok((end, is_late)),
            () = stop.cancelled() => {
                child.kill();
                child.wait().await;
                return Err(GraderFault::Stopped);
            }
            () = tokio::time::sleep(remaining) => match is_late {
                false => child.interrupt(),
                true => {
                    child.kill();
                    return Ok((child.wait().await, true));
                }
            },
        }
        (remaining, is_late) = (GRACE_PERIOD, true);
    }
}

fn fault_about(what: &'static str) -> impl Fn(io::Error) -> GraderFault {
    move |error| GraderFault::Failed(format!("cannot {what}: {error}"))
}

/// Unpacks an archive into a new folder. Returns that folder, and the folder at the archive's top. The archive was
/// already checked when it was uploaded.
async fn unpack(archive: &Path, folder: PathBuf) -> Result<(PathBuf, PathBuf), GraderFault> {
    let archive = archive.to_owned();
    let unpacking = tokio::task::spawn_blocking(move || {
        let archive = fs::File::open(archive).map_err(|error| error.to_string())?;
        fs::create_dir(&folder).map_err(|error| error.to_string())?;
        let files =
            fosssim_intake::unpack(archive, &folder, ArchiveLimits::DEFAULT).map_err(|error| error.to_string())?;
        Ok::<_, String>((fosssim_intake::top_folder(&folder, &files), folder))
    });
    let unpacked = unpacking.await.map_err(|error| GraderFault::Failed(error.to_string()))?;
    unpacked.map_err(|error| GraderFault::Failed(format!("cannot unpack an archive: {error}")))
}

/// Creates a link to the submission under its own name, and makes it executable. Reports and messages then contain that
/// name.
fn place_program(submission: &Path, folder: &Path, name: &str) -> io::Result<PathBuf> {
    if name.is_empty() || name.starts_with('.') || name.contains(['/', '\0']) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "the submission's name must be a plain file name"));
    }
    let link_folder = folder.join("submission");
    fs::create_dir(&link_folder)?;
    let program = link_folder.join(name);
    fs::rename(submission, &program)?;
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755))?;
    Ok(program)
}

/// Returns the last part of the grader's output, on one line.
fn last_output(file: &Path) -> String {
    let bytes = fs::read(file).unwrap_or_default();
    let from = bytes.len().saturating_sub(MAX_MESSAGE_LENGTH);
    let text = String::from_utf8_lossy(&bytes[from..]);
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let text = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    if text.is_empty() { "the grader printed nothing".to_owned() } else { text }
}
