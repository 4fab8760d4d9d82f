//! Checks untrusted uploads. A program is checked by its first bytes. An archive is checked in a separate process with
//! limits of time and memory, when it is the sender's turn.
use super::upload::is_program;
use crate::{
    domain::{Member, Settings},
    problem::{Problem, ensure},
    task::Form,
    worker,
};
use std::{
    io::Read,
    path::Path,
    process::{Command, Stdio},
    time::Duration,
};

/// The limit of wall time and processor time for checking an archive, in seconds.
const MAX_SECONDS: u64 = 30;
const MAX_MEMORY: u64 = 1 << 30;

/// The description of a program in messages.
const PROGRAM_DESCRIPTION: &str = "a program for Linux (ELF, or a script that begins with #!)";

/// Returns the form of a file, if the file is valid. If it is not, the error names the forms that the assignment
/// accepts.
pub(super) async fn examine(
    member: &Member,
    file: &Path,
    declared_form: Option<&str>,
    settings: &Settings,
) -> Result<Form, Problem> {
    let invalid = || Problem::invalid("form must be program, sources or traces");
    let form = declared_form.map(|name| Form::from_name(name).ok_or_else(invalid)).transpose()?;
    let mut start = Vec::new();
    std::fs::File::open(file)?.take(fosssim_intake::START_BYTES as u64).read_to_end(&mut start)?;
    ensure(!start.is_empty(), settings.reject_file("the file is empty"))?;
    match (form, is_program(&start)) {
        (None | Some(Form::Program), true) => return Ok(Form::Program),
        (Some(Form::Program), false) => {
            let found = fosssim_intake::describe(&start);
            return Err(settings.reject_file(format!("expected {PROGRAM_DESCRIPTION}, but found {found}")));
        }
        _ => {}
    }
    let archives = [Form::Sources, Form::Traces].into_iter().filter(|form| settings.accepts_form(*form));
    let archives: Vec<&str> = archives.map(Form::name).collect();
    let archives = (!archives.is_empty())
        .then(|| format!("an archive of {} ({})", archives.join(" or "), fosssim_intake::KNOWN_EXTENSIONS));
    let program = settings.accepts_form(Form::Program).then(|| PROGRAM_DESCRIPTION.to_owned());
    let accepted = program.into_iter().chain(archives).collect::<Vec<_>>().join(", or ");
    let mut flags = vec!["--wanted", &accepted];
    flags.extend(declared_form.iter().flat_map(|form| ["--form", form]));
    // The grader's own suites build no sources. With such a suite, the archive must therefore contain the program
    // itself.
    if settings.suite_archive.is_none() && settings.accepts_form(Form::Sources) {
        flags.extend(["--program", &settings.program]);
    }
    let answer = check_in_turn(member, file, &flags).await?;
    answer.map_err(|detail| settings.reject_file(detail))?.ok_or_else(Problem::fault)
}

/// Unpacks an archive into an empty folder.
pub(super) async fn unpack(member: &Member, archive: &Path, folder: &Path) -> Result<(), Problem> {
    let folder = folder.to_str().ok_or_else(Problem::fault)?;
    check_in_turn(member, archive, &["--into", folder]).await?.map(drop).map_err(Problem::no_suite)
}

/// Checks a file in another process of this program, when it is the sender's turn. Rejected files are counted, so that
/// an account that sends many has to wait.
async fn check_in_turn(member: &Member, file: &Path, flags: &[&str]) -> Result<Result<Option<Form>, String>, Problem> {
    let _turn = member.archive_turn().await?;
    // Start this same program, even if an update has replaced its file.
    let mut command = Command::new("/proc/self/exe");
    command.arg("look-through").args(flags).arg("--").arg(file);
    command.env_clear().stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
    worker::set_limits(&mut command, MAX_MEMORY, MAX_SECONDS);
    let output = tokio::process::Command::from(command).kill_on_drop(true).output();
    let answer = match tokio::time::timeout(Duration::from_secs(MAX_SECONDS), output).await {
        Ok(output) => serde_json::from_slice(&output?.stdout).ok(),
        Err(_) => None,
    };
    let answer = answer.unwrap_or_else(|| Err("checking the file takes too long, or needs too much memory".to_owned()));
    if answer.is_ok() {
        member.accept_archive();
    }
    Ok(answer)
}
