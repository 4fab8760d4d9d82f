//! The grader as a child process: `fosssim-oracle grade`. A panic, an endless loop or a lack of memory there never takes
//! the worker down, and whatever the child leaves behind dies with the job.
use super::{
    Graded, Grader, GraderFault, NewFile,
    child::{Child, End},
};
use crate::{
    archive::{self, Limits},
    task::{Form, Suite, Task},
};
use serde::Deserialize;
use std::{
    fs, io,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::Command,
    time::Duration,
};
use tokio_util::sync::CancellationToken;

/// How long the grader may take to write its reports after it was asked to stop.
const GRACE: Duration = Duration::from_secs(20);

/// How much of the grader's messages is kept for the administrator.
const MESSAGE: usize = 2000;

/// The schema of `grade.json` that is read here.
const SCHEMA: u32 = 3;

/// The reports that a grading writes: format, file, media type.
pub const REPORTS: [(&str, &str, &str); 8] = [
    ("json", "grade.json", "application/json"),
    ("text", "report.txt", "text/plain; charset=utf-8"),
    ("html", "report.html", "text/html; charset=utf-8"),
    ("junit", "junit.xml", "application/xml"),
    ("csv", "scenes.csv", "text/csv; charset=utf-8"),
    ("markdown", "report.md", "text/markdown; charset=utf-8"),
    ("gradescope", "gradescope.json", "application/json"),
    ("prairielearn", "prairielearn.json", "application/json"),
];

/// The program `fosssim-oracle`, or one that does as it does.
#[derive(Debug, Clone)]
pub struct Program {
    path: PathBuf,
    threads: usize,
}

impl Program {
    /// The grader at this path, with so many scenes of a job at one time.
    #[must_use]
    pub fn new(path: PathBuf, threads: usize) -> Self {
        Self { path, threads }
    }

    fn command(&self, task: &Task, submission: &Path, folder: &Path) -> Command {
        let mut command = Command::new(&self.path);
        command.arg("grade").arg(submission).arg("--jobs").arg(self.threads.to_string());
        if task.submission.form == Form::Sources {
            command.arg("--single").arg("--program").arg(&task.program);
        }
        match &task.suite {
            Suite::Named(name) => command.arg("--suite").arg(name),
            Suite::Archive(_) => command.arg("--suite").arg(folder.join("suite/suite.toml")),
        };
        if let Some(rules) = &task.rules {
            command.arg("--rules").arg(rules);
        }
        if let Some(hints) = &task.hints {
            command.arg("--hints").arg(hints);
        }
        for (format, file, _) in REPORTS {
            command.arg("--format").arg(format!("{format}={}", folder.join(file).display()));
        }
        // Nothing of the server's surroundings, which may hold secrets.
        command.env_clear().current_dir(folder);
        for name in ["PATH", "HOME", "LANG", "TMPDIR"] {
            if let Some(value) = std::env::var_os(name) {
                command.env(name, value);
            }
        }
        command
    }
}

impl Grader for Program {
    async fn grade(
        &self,
        task: &Task,
        submission: &Path,
        suite: Option<&Path>,
        folder: &Path,
        stop: CancellationToken,
    ) -> Result<Graded, GraderFault> {
        let program = match task.submission.form {
            Form::Program => {
                place_program(submission, folder, &task.submission.name).map_err(cannot("place the program"))?
            }
            Form::Sources => unpack(submission, folder.join("submission")).await?,
            Form::Traces => return Err(GraderFault::Failed("traces can't be graded yet".to_owned())),
        };
        if let Some(suite) = suite {
            unpack(suite, folder.join("suite")).await?;
        }
        let messages = folder.join("messages.txt");
        let mut command = self.command(task, &program, folder);
        command.stderr(fs::File::create(&messages).map_err(cannot("write the messages"))?);
        let child = Child::start(command).map_err(cannot("start the grader"))?;
        let mut stopped = false;
        let end = tokio::select! {
            end = child.ended() => end,
            () = stop.cancelled() => {
                child.kill();
                child.ended().await;
                return Err(GraderFault::Stopped);
            }
            () = tokio::time::sleep(Duration::from_secs(task.seconds)) => {
                stopped = true;
                child.interrupt();
                tokio::select! {
                    end = child.ended() => end,
                    () = stop.cancelled() => {
                        child.kill();
                        child.ended().await;
                        return Err(GraderFault::Stopped);
                    }
                    () = tokio::time::sleep(GRACE) => {
                        child.kill();
                        child.ended().await
                    }
                }
            }
        };
        let said = || last_words(&messages);
        match end {
            // 0 accepted, 1 not accepted, 130 stopped with partial results.
            End::Code(0 | 1) => {}
            End::Code(130) if stopped => {}
            End::Code(code) => {
                return Err(GraderFault::Failed(format!("the grader ended with exit code {code}: {}", said())));
            }
            End::Signal(signal) => {
                return Err(GraderFault::Failed(format!("the grader was ended by signal {signal}: {}", said())));
            }
        }
        let mut graded = read_grade(&folder.join("grade.json")).map_err(GraderFault::Failed)?;
        if stopped {
            graded.summary = format!("stopped after {} seconds; {}", task.seconds, graded.summary);
        }
        graded.files = REPORTS
            .iter()
            .map(|(_, file, media_type)| NewFile {
                name: (*file).to_owned(),
                media_type: (*media_type).to_owned(),
                path: folder.join(file),
            })
            .filter(|file| file.path.exists())
            .collect();
        Ok(graded)
    }
}

fn cannot(what: &'static str) -> impl Fn(io::Error) -> GraderFault {
    move |error| GraderFault::Failed(format!("cannot {what}: {error}"))
}

/// Unpacks an archive into a new folder. It was looked through when it came, so that it can be.
async fn unpack(archive: &Path, folder: PathBuf) -> Result<PathBuf, GraderFault> {
    let archive = archive.to_owned();
    let unpacking = tokio::task::spawn_blocking(move || {
        fs::create_dir(&folder).map_err(|error| error.to_string())?;
        archive::unpack(&archive, &folder, Limits::USUAL).map_err(|error| error.to_string())?;
        Ok::<_, String>(only_folder(folder))
    });
    let unpacked = unpacking.await.map_err(|error| GraderFault::Failed(error.to_string()))?;
    unpacked.map_err(|error| GraderFault::Failed(format!("cannot unpack an archive: {error}")))
}

/// The folder that holds everything: many archives have one at their top, and nothing else.
fn only_folder(folder: PathBuf) -> PathBuf {
    let Ok(entries) = fs::read_dir(&folder) else { return folder };
    let mut entries = entries.flatten();
    match (entries.next(), entries.next()) {
        (Some(only), None) if only.path().is_dir() => only.path(),
        _ => folder,
    }
}

/// The submission under its own name, executable: reports and messages speak of it so.
fn place_program(submission: &Path, folder: &Path, name: &str) -> io::Result<PathBuf> {
    if name.is_empty() || name.starts_with('.') || name.contains(['/', '\0']) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "the submission's name is no plain file name"));
    }
    let place = folder.join("submission");
    fs::create_dir(&place)?;
    let program = place.join(name);
    fs::rename(submission, &program)?;
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755))?;
    Ok(program)
}

/// The end of what the grader said, on one line.
fn last_words(file: &Path) -> String {
    let bytes = fs::read(file).unwrap_or_default();
    let from = bytes.len().saturating_sub(MESSAGE);
    let text = String::from_utf8_lossy(&bytes[from..]);
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let words = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    if words.is_empty() { "it said nothing".to_owned() } else { words }
}

/// The part of `schemas/grade.schema.json` that the service understands; the rest goes to people.
#[derive(Debug, Deserialize)]
struct Report {
    schema: u32,
    version: String,
    grades: Vec<ReportedGrade>,
}

#[derive(Debug, Deserialize)]
struct ReportedGrade {
    verdict: String,
    code: String,
    points: Option<serde_json::Number>,
    max_points: Option<serde_json::Number>,
    #[serde(default)]
    likely_mistake: Option<serde_json::Value>,
    #[serde(default)]
    groups: Vec<Group>,
}

#[derive(Debug, Deserialize)]
struct Group {
    scenes: Vec<Scene>,
}

#[derive(Debug, Deserialize)]
struct Scene {
    code: String,
}

/// Numbers keep their digits: the text that the grader wrote is what counts.
fn read_grade(file: &Path) -> Result<Graded, String> {
    let bytes = fs::read(file).map_err(|error| format!("the grader wrote no grade.json: {error}"))?;
    let report: Report =
        serde_json::from_slice(&bytes).map_err(|error| format!("grade.json can't be read: {error}"))?;
    if report.schema != SCHEMA {
        return Err(format!("grade.json has schema {}, this server reads {SCHEMA}", report.schema));
    }
    let [grade] = report.grades.as_slice() else {
        return Err(format!("grade.json holds {} grades instead of one", report.grades.len()));
    };
    if grade.code == crate::task::JUDGE_ERROR {
        return Err("the grade is a judge error".to_owned());
    }
    let scenes: Vec<&Scene> = grade.groups.iter().flat_map(|group| &group.scenes).collect();
    let accepted = scenes.iter().filter(|scene| scene.code == "AC").count();
    let mut summary = format!("{accepted} of {} scenes accepted", scenes.len());
    if let Some(serde_json::Value::String(mistake)) = &grade.likely_mistake {
        summary = format!("{summary}; {mistake}");
    }
    Ok(Graded {
        verdict: grade.verdict.clone(),
        code: grade.code.clone(),
        points: grade.points.as_ref().map(ToString::to_string),
        max_points: grade.max_points.as_ref().map(ToString::to_string),
        summary,
        version: report.version,
        files: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    /// A grader of another schema would make every grading a judge error.
    #[test]
    fn grades_are_read_as_the_grader_writes_them() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../schemas/grade.schema.json");
        let schema: serde_json::Value =
            serde_json::from_slice(&std::fs::read(file).expect("the schema")).expect("JSON");
        assert_eq!(schema["properties"]["schema"]["const"], super::SCHEMA);
    }
}
