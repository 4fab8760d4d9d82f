//! Receives uploads. They are written to a file while they arrive, and are never completely in memory.
use crate::{
    domain::{App, is_file_name},
    problem::{Problem, ensure},
    task::Form,
};
use axum::{
    body::{Body, Bytes},
    extract::{FromRequest, Multipart, Request},
    http::header,
};
use fosssim_intake::{ArchiveError, ArchiveLimits, FileKind};
use futures_util::{Stream, StreamExt};
use std::{
    fmt::Display,
    fs::File,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};
use tempfile::TempPath;
use tokio::io::AsyncWriteExt;

/// The maximum sum of all pauses in an upload, in multiples of the longest single pause.
const MAX_PAUSES: u32 = 20;

/// Returns the time within which an upload of `size` bytes must arrive, so that the time at which it began counts as
/// its arrival. The limit is half a minute, and one more second for each 32 KiB. Without this limit, a student could
/// begin an upload before the due date and write its content afterwards.
pub(super) fn allowed_time(size: u64) -> Duration {
    Duration::from_secs(30 + size / (32 << 10))
}

/// The maximum number of bytes in a form in addition to its file: boundaries, names, short fields, and the read buffer
/// of the connection.
const FORM_OVERHEAD: u64 = 1024 * 1024;

/// Counts the bytes of a form that have arrived but are not processed yet. They are in memory, so there is a limit.
#[derive(Clone, Default)]
struct BufferedBytes(Arc<AtomicU64>);

impl BufferedBytes {
    fn add(&self, bytes: usize) -> Result<(), &'static str> {
        let buffered = self.0.fetch_add(bytes as u64, Ordering::Relaxed) + bytes as u64;
        if buffered > FORM_OVERHEAD { Err("the form has too many fields") } else { Ok(()) }
    }

    fn take(&self, bytes: usize) {
        self.0.fetch_sub(bytes as u64, Ordering::Relaxed);
    }
}

/// A file that a request contained, with the other fields of the upload.
pub(super) struct ReceivedFile {
    /// The temporary file that contains the received bytes.
    pub(super) file: TempPath,
    /// The name that the sender gave the file.
    pub(super) name: Option<String>,
    /// The name of the submission's form (`program`, `sources` or `traces`), if the request contains it.
    pub(super) form: Option<String>,
    /// The sender's key for the upload.
    pub(super) key: Option<String>,
}

/// The folder in which uploads are received, and the longest pause that is allowed.
struct Inbox<'a> {
    incoming: &'a Path,
    max_pause: Duration,
}

/// Receives the body of a request. The body is the file itself, or a form with a field `file`.
pub(super) async fn receive(app: &App, request: Request, max_bytes: u64) -> Result<ReceivedFile, Problem> {
    if let Err(problem) = app.ensure_disk_space() {
        return Err(reject(app, request, max_bytes, problem).await);
    }
    receive_into(&Inbox { incoming: &app.incoming, max_pause: app.max_pause }, request, max_bytes).await
}

/// Rejects an upload before anything is stored. The body is still read, because many programs read the answer only
/// after they have sent everything. Otherwise such a program would see only a broken connection.
pub(super) async fn reject(app: &App, request: Request, max_bytes: u64, problem: Problem) -> Problem {
    if request.headers().contains_key(header::EXPECT) {
        return problem;
    }
    let until = tokio::time::Instant::now() + app.max_pause * MAX_PAUSES;
    let mut body = request.into_body().into_data_stream();
    let mut size = 0;
    while size <= max_bytes {
        let pause = tokio::time::Instant::now() + app.max_pause;
        match tokio::time::timeout_at(until.min(pause), body.next()).await {
            Ok(Some(Ok(chunk))) => size += chunk.len() as u64,
            _ => break,
        }
    }
    problem
}

/// Receives a form that arrives in pieces of `size` bytes. Files are written into a folder that is empty again
/// afterwards. Only tests and the fuzzer of uploads call this. Returns the size of the file, and the form's name, kind
/// and key.
///
/// # Errors
///
/// Fails if the form is invalid.
pub async fn receive_form(
    incoming: &Path,
    body: &[u8],
    pieces: usize,
    max_bytes: u64,
) -> Result<(u64, [Option<String>; 3]), Problem> {
    let pieces: Vec<Result<Bytes, std::io::Error>> =
        body.chunks(pieces.max(1)).map(|piece| Ok(Bytes::copy_from_slice(piece))).collect();
    let request = Request::builder()
        .header(header::CONTENT_TYPE, "multipart/form-data; boundary=x")
        .body(Body::from_stream(futures_util::stream::iter(pieces)))
        .map_err(|_| Problem::fault())?;
    let received = receive_into(&Inbox { incoming, max_pause: Duration::from_secs(60) }, request, max_bytes).await?;
    let size = std::fs::metadata(&received.file)?.len();
    Ok((size, [received.name, received.form, received.key]))
}

/// Returns whether the body of a request is a form.
pub(super) fn is_form(request: &Request) -> bool {
    let kind = request.headers().get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok());
    kind.is_some_and(|value| value.trim_start().to_ascii_lowercase().starts_with("multipart/form-data"))
}

/// Returns the size of the body, as the request's head announces it; `None` if the head does not.
pub(super) fn announced_size(request: &Request) -> Option<u64> {
    request.headers().get(header::CONTENT_LENGTH).and_then(|value| value.to_str().ok()?.parse().ok())
}

async fn receive_into(inbox: &Inbox<'_>, request: Request, max_bytes: u64) -> Result<ReceivedFile, Problem> {
    let deadline = Instant::now() + inbox.max_pause * MAX_PAUSES + allowed_time(max_bytes);
    if !is_form(&request) {
        ensure(announced_size(&request).is_none_or(|announced| announced <= max_bytes), Problem::too_large(max_bytes))?;
        let body: Body = request.into_body();
        let file = write_file(inbox, body.into_data_stream(), max_bytes, deadline, None).await?;
        return Ok(ReceivedFile { file, name: None, form: None, key: None });
    }
    let buffered = BufferedBytes::default();
    let (parts, body) = request.into_parts();
    let counter = buffered.clone();
    let counted = body.into_data_stream().map(move |chunk| {
        let chunk = chunk.map_err(|error| error.to_string())?;
        counter.add(chunk.len()).map(|()| chunk).map_err(str::to_owned)
    });
    let request = Request::from_parts(parts, Body::from_stream(counted));
    let mut multipart =
        Multipart::from_request(request, &()).await.map_err(|error| Problem::invalid(error.body_text()))?;
    let (mut file, mut name, mut form, mut key) = (None, None, None, None);
    loop {
        let next = tokio::time::timeout(inbox.max_pause, multipart.next_field()).await;
        let field = next.map_err(|_| Problem::too_slow())?.map_err(|error| Problem::invalid(error.body_text()))?;
        let Some(field) = field else { break };
        match field.name() {
            Some("file") if file.is_none() => {
                name = field.file_name().map(str::to_owned);
                file = Some(write_file(inbox, field, max_bytes, deadline, Some(&buffered)).await?);
            }
            Some("form") => form = Some(short_text(inbox, field).await?),
            Some("key") => key = Some(short_text(inbox, field).await?),
            _ => return Err(Problem::invalid("the form must have the field `file`, and may have `form` and `key`")),
        }
    }
    let file = file.ok_or_else(|| Problem::invalid("the form has no file"))?;
    // If no file was chosen, browsers send an empty file without a name.
    if name.as_deref() == Some("") && std::fs::metadata(&file)?.len() == 0 {
        return Err(Problem::invalid("no file was chosen"));
    }
    Ok(ReceivedFile { file, name, form: form.filter(|form| !form.is_empty()), key: key.filter(|key| !key.is_empty()) })
}

/// Reads a short text field of a form.
async fn short_text(inbox: &Inbox<'_>, mut field: axum::extract::multipart::Field<'_>) -> Result<String, Problem> {
    let mut bytes = Vec::new();
    loop {
        let chunk = tokio::time::timeout(inbox.max_pause, field.chunk()).await.map_err(|_| Problem::too_slow())?;
        match chunk.map_err(|error| Problem::invalid(error.body_text()))? {
            Some(chunk) if bytes.len() + chunk.len() <= 200 => bytes.extend_from_slice(&chunk),
            Some(_) => return Err(Problem::invalid("a field is longer than 200 bytes")),
            None => return String::from_utf8(bytes).map_err(|_| Problem::invalid("a field is not UTF-8")),
        }
    }
}

/// Writes a stream into a new file in the folder for uploads.
async fn write_file<E: Display>(
    inbox: &Inbox<'_>,
    mut stream: impl Stream<Item = Result<Bytes, E>> + Unpin,
    max_bytes: u64,
    deadline: Instant,
    buffered: Option<&BufferedBytes>,
) -> Result<TempPath, Problem> {
    let (file, path) = tempfile::NamedTempFile::new_in(inbox.incoming)?.into_parts();
    let mut file = tokio::fs::File::from_std(file);
    let mut size = 0;
    loop {
        let remaining = deadline.saturating_duration_since(Instant::now());
        ensure(remaining != Duration::ZERO, Problem::too_slow())?;
        let next = tokio::time::timeout(remaining.min(inbox.max_pause), stream.next()).await;
        match next.map_err(|_| Problem::too_slow())? {
            None => break,
            Some(Err(error)) => {
                tracing::debug!(%error, "an upload was interrupted");
                return Err(Problem::invalid("the upload was interrupted"));
            }
            Some(Ok(chunk)) => {
                if let Some(untaken) = buffered {
                    untaken.take(chunk.len());
                }
                size += chunk.len() as u64;
                ensure(size <= max_bytes, Problem::too_large(max_bytes))?;
                file.write_all(&chunk).await?;
            }
        }
    }
    file.flush().await?;
    Ok(path)
}

/// Returns the name that a browser gave a file, without characters that are unsafe in reports and messages.
pub(super) fn plain_name(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let safe = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    let plain: String = last.chars().map(safe).take(100).collect();
    let plain = plain.trim_start_matches(['.', '-']);
    if is_file_name(plain) { plain.to_owned() } else { "submission".to_owned() }
}

/// Returns whether a file that begins with these bytes is a program.
pub(super) fn is_program(start: &[u8]) -> bool {
    FileKind::from_start(start) == FileKind::Program
}

/// Returns the form of an archive, if the archive is valid. Sources must contain the file `program`, unless the suite
/// builds it. This function runs in a separate process (`web::archive_check`).
///
/// # Errors
///
/// Fails if the archive is rejected. The error is the reason.
pub fn check_archive(file: &Path, form: Option<&str>, accepted: &str, program: Option<&str>) -> Result<Form, String> {
    let form = form.and_then(Form::from_name);
    let opened = File::open(file).map_err(|error| error.to_string())?;
    match fosssim_intake::list_archive(opened, ArchiveLimits::DEFAULT) {
        Ok(files) if files.is_empty() => {
            Err("the archive contains no files, or only those that a file manager adds automatically".to_owned())
        }
        Ok(files) => {
            let are_traces = files.iter().all(|file| file.extension().is_some_and(|extension| extension == "bin"));
            match (form, are_traces) {
                (Some(Form::Traces), false) => {
                    Err("an archive of traces may contain only files NAME.bin, one for a scene".to_owned())
                }
                (None, true) => Ok(Form::Traces),
                (Some(Form::Traces), true) => Ok(Form::Traces),
                (declared, _) => check_program(&files, program).map(|()| declared.unwrap_or(Form::Sources)),
            }
        }
        Err(ArchiveError::Unknown(found)) if form.is_none() => Err(format!("expected {accepted}, but found {found}")),
        Err(error) => Err(error.to_string()),
    }
}

/// Checks that the program is among an archive's files.
fn check_program(files: &[PathBuf], program: Option<&str>) -> Result<(), String> {
    /// The maximum number of files that a message names.
    const MAX_NAMED: usize = 6;
    let Some(program) = program else { return Ok(()) };
    if files.contains(&fosssim_intake::top_folder(Path::new(""), files).join(program)) {
        return Ok(());
    }
    let names = files.iter().take(MAX_NAMED).map(|file| file.to_string_lossy().escape_debug().to_string());
    let more = (files.len() > MAX_NAMED).then(|| format!("{} more", files.len() - MAX_NAMED));
    let found = names.chain(more).collect::<Vec<_>>().join(", ");
    Err(format!("expected the program {program} in the archive, because the suite builds nothing, but found {found}"))
}

#[cfg(test)]
mod tests {
    use super::plain_name;

    #[test]
    fn names_are_made_harmless() {
        for (name, plain) in [
            ("FOSSSim", "FOSSSim"),
            ("../../etc/passwd", "passwd"),
            ("C:\\Users\\me\\my program.exe", "my_program.exe"),
            ("..", "submission"),
            (".bashrc", "bashrc"),
            ("--help", "help"),
            ("a\r\nSet-Cookie: x=1", "a__Set-Cookie__x_1"),
            ("\u{202e}gpj.exe", "_gpj.exe"),
            ("", "submission"),
        ] {
            assert_eq!(super::plain_name(name), plain, "{name:?}");
        }
        assert_eq!(plain_name(&"x".repeat(500)).len(), 100);
    }
}
