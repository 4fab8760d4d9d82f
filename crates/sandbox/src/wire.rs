//! The messages between the grader and its supervisor process.
//!
//! The supervisor's standard input is a socket. The grader writes a length-prefixed [`RunOrder`] to it, and later a
//! command byte if needed. If the working folder is in memory, its descriptor is returned on the same socket. The
//! supervisor answers on its standard output with length-prefixed [`Event`]s. The captured bytes follow the last event.
//! Paths are sent as bytes, because they may not be UTF-8.

use std::{
    io::{self, Read, Write},
    os::unix::ffi::{OsStrExt, OsStringExt},
    path::{Path, PathBuf},
    time::Duration,
};

use fosssim_ended::RunEnd;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::job::Limits;

/// The hidden first argument that makes the program start as a supervisor.
pub(super) const SUPERVISOR_ARGUMENT: &str = "__sandbox-supervisor";
/// The command byte that stops the program.
pub(super) const COMMAND_CANCEL: u8 = b'c';
/// A size in bytes that few messages exceed.
const USUAL_MESSAGE_BYTES: u64 = 4 << 10;
/// The maximum size of a message, in bytes. A larger size means that the stream is corrupt.
const MAX_MESSAGE_BYTES: u64 = 64 << 20;

/// The byte that requests a run from a keeper. It is sent with three descriptors: the channel for commands, the channel
/// for answers, and the working folder on disk.
pub(super) const RUN_BYTE: u8 = b'r';
/// The byte that announces a working folder in memory to the grader. It is sent with the folder's descriptor.
pub(super) const FOLDER_BYTE: u8 = b'f';

/// A path or an argument, as bytes.
pub(super) type RawBytes = Vec<u8>;

/// Converts a path into bytes.
pub(super) fn to_raw_bytes(path: &Path) -> RawBytes {
    path.as_os_str().as_bytes().to_vec()
}

/// Converts bytes into a path.
pub(super) fn to_path(raw: &RawBytes) -> PathBuf {
    PathBuf::from(std::ffi::OsString::from_vec(raw.clone()))
}

/// Returns the bytes as the name of an entry of a folder; `None` if the name would leave the folder.
pub(super) fn entry_name(raw: &[u8]) -> Option<&Path> {
    let leads_on = raw.is_empty() || raw == b"." || raw == b".." || raw.iter().any(|byte| matches!(byte, b'/' | 0));
    (!leads_on).then(|| Path::new(std::ffi::OsStr::from_bytes(raw)))
}

/// The layers that the supervisor must set up. If one of them fails, that is an error.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ActiveLayers {
    pub(super) landlock: bool,
    /// The version of Landlock whose rules are used; 0 for the newest.
    pub(super) landlock_version: u8,
    pub(super) scopes: bool,
    pub(super) seccomp: bool,
    pub(super) notify: bool,
    pub(super) own_user: bool,
    pub(super) namespaces: bool,
    pub(super) group: bool,
}

/// The order for a run, with all that the supervisor must know about the run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct RunOrder {
    pub(super) program: RawBytes,
    pub(super) folder: RawBytes,
    pub(super) arguments: Vec<RawBytes>,
    pub(super) environment: Vec<(RawBytes, RawBytes)>,
    pub(super) readable: Vec<RawBytes>,
    /// The interpreters that the kernel executes to start the program.
    pub(super) executable: Vec<RawBytes>,
    /// The names by which the program and the kernel request these files. They may be links.
    pub(super) named_paths: Vec<RawBytes>,
    /// The grader's own files, which no run may see. The grader finds them only once for all runs.
    pub(super) own_files: Vec<RawBytes>,
    /// The name of the trace in the working folder.
    pub(super) trace: Option<RawBytes>,
    /// The files that are written into the working folder. Each has its name and its length, and the bytes follow the
    /// order. They are used only if the folder is in memory.
    pub(super) files: Vec<(RawBytes, u64)>,
    /// Whether the working folder is in memory. The supervisor then sends its descriptor to the grader.
    pub(super) is_in_memory: bool,
    pub(super) allows_tools: bool,
    /// The interpreter, if the program is a script. It is executed instead of the script.
    pub(super) interpreter: Option<RawBytes>,
    /// The name of the interpreter, followed by those of its arguments that precede the script.
    pub(super) interpreter_arguments: Vec<RawBytes>,
    /// Whether the program may have been built with a sanitizer, which reserves terabytes of address space.
    pub(super) sanitizers: bool,
    pub(super) layers: ActiveLayers,
    pub(super) limits: Limits,
}

impl RunOrder {
    /// Returns the maximum size of the working folder in bytes, including the trace.
    pub(super) fn folder_bytes(&self) -> u64 {
        let trace = if self.trace.is_some() { self.limits.trace_bytes } else { 0 };
        self.limits.folder_bytes.saturating_add(trace)
    }

    /// Returns the maximum size of a file in bytes. A trace may have one byte more than its limit, which shows that it
    /// is too long.
    pub(super) fn file_bytes(&self) -> u64 {
        let trace = if self.trace.is_some() { self.limits.trace_bytes.saturating_add(1) } else { 0 };
        self.limits.folder_bytes.max(trace)
    }
}

/// A message from the supervisor to the grader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Event {
    /// The child process exists. The message contains its session, unless its process namespace has other process IDs,
    /// and its own user ID, if it has one.
    Ready { session: Option<i32>, user: Option<u32> },
    /// The sandbox could not be set up. This is an error of the grader or the host.
    Failed(Failure),
    /// All processes have ended. The captured bytes of both streams follow.
    Done(Report),
}

/// The step of the set-up whose failure is the program's fault, and not the grader's.
pub(super) const EXECUTE_STEP: &str = "execute the program";

/// A step of the set-up that failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Failure {
    pub(super) stage: String,
    pub(super) errno: i32,
}

impl Failure {
    /// Creates a failure of the step `stage` from an error. It contains the error's number, or 0 if there is none.
    pub(super) fn new(stage: impl Into<String>, error: &io::Error) -> Self {
        Self { stage: stage.into(), errno: error.raw_os_error().unwrap_or(0) }
    }
}

/// Returns a function that turns a system error into a failure of the step `name`.
pub(super) fn failure_at(name: &'static str) -> impl FnOnce(io::Error) -> Failure {
    move |error| Failure::new(name, &error)
}

/// The supervisor's report on a finished run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Report {
    /// The reason why the supervisor killed the program; `None` if the program ended by itself.
    pub(super) cause: Option<RunEnd>,
    /// The raw wait status of the run's main process.
    pub(super) status: i32,
    /// The error number of `execve`, if the program could not be started.
    pub(super) exec_errno: Option<i32>,
    pub(super) cpu: Duration,
    pub(super) wall: Duration,
    pub(super) peak_memory: u64,
    /// Whether the trace is longer than its limit.
    pub(super) exceeds_trace_limit: bool,
    /// Whether the working folder exceeds a limit at the end of the run.
    pub(super) exceeds_folder_limit: bool,
    pub(super) stdout_bytes: u64,
    pub(super) stderr_bytes: u64,
    pub(super) stdout_truncated: bool,
    pub(super) stderr_truncated: bool,
    /// The number of processes that could not be killed.
    pub(super) survivors: u32,
}

/// The results of testing the layers. A string is the reason why a layer does not work.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Probe {
    pub(super) root: bool,
    /// Whether the grader belongs to root's group without being root.
    pub(super) roots_group: bool,
    pub(super) landlock_abi: i32,
    pub(super) no_new_privileges: Option<String>,
    pub(super) limits: Option<String>,
    pub(super) landlock: Option<String>,
    pub(super) seccomp: Option<String>,
    pub(super) notify: Option<String>,
    pub(super) own_user: Option<String>,
    pub(super) reaper: Option<String>,
    /// The reason why copies of programs cannot be executed, if there is one.
    pub(super) execution: Option<String>,
    /// Whether copies must be executed in memory, because nothing can be executed in the temporary folder.
    pub(super) executes_from_memory: bool,
    pub(super) namespaces: Option<String>,
    pub(super) group: Option<String>,
    /// The names of the quantities that the kernel can limit for a control group.
    pub(super) group_controls: Vec<String>,
    /// Whether all processes in a control group can be killed together.
    pub(super) group_can_kill: bool,
}

/// Writes a message, after its length.
pub(super) fn send<T: Serialize>(mut to: impl Write, message: &T) -> io::Result<()> {
    to.write_all(&encode_packet(message)?)?;
    to.flush()
}

/// Returns the bytes of a message, after its length.
pub(super) fn encode_packet<T: Serialize>(message: &T) -> io::Result<Vec<u8>> {
    let body = serde_json::to_vec(message)?;
    let mut packet = (body.len() as u64).to_le_bytes().to_vec();
    packet.extend_from_slice(&body);
    Ok(packet)
}

/// Reads `length` bytes. The buffer grows while they arrive.
pub(super) fn receive_bytes(from: impl Read, length: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(usize::try_from(length.min(USUAL_MESSAGE_BYTES)).unwrap_or_default() + 1);
    if from.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(bytes)
}

/// Reads exactly one message, after its length.
pub(super) fn receive<T: DeserializeOwned>(mut from: impl Read) -> io::Result<T> {
    let mut length = [0; 8];
    from.read_exact(&mut length)?;
    let length = u64::from_le_bytes(length);
    if length > MAX_MESSAGE_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            "the supervisor sent an unexpected message; please report this",
        ));
    }
    // The length in the message is not trusted.
    Ok(serde_json::from_slice(&receive_bytes(from, length)?)?)
}

/// Reads as many messages of each kind as the bytes contain, for the fuzz target. Panics if a message differs after it
/// was sent again. Returns the number of messages.
#[doc(hidden)]
pub fn read_messages(bytes: &[u8]) -> usize {
    fn all<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(mut bytes: &[u8]) -> usize {
        let mut count = 0;
        while let Ok(message) = receive::<T>(&mut bytes) {
            let mut sent = Vec::new();
            send(&mut sent, &message).expect("memory");
            assert_eq!(receive::<T>(&sent[..]).ok().as_ref(), Some(&message));
            count += 1;
        }
        count
    }
    all::<RunOrder>(bytes) + all::<Event>(bytes) + all::<Probe>(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_follow_each_other_without_reading_ahead() {
        let mut stream = Vec::new();
        send(&mut stream, &Event::Ready { session: Some(7), user: None }).unwrap();
        send(&mut stream, &Event::Failed(Failure { stage: "limits".into(), errno: 1 })).unwrap();
        stream.extend_from_slice(b"rest");
        let mut reader = &stream[..];
        assert_eq!(receive::<Event>(&mut reader).unwrap(), Event::Ready { session: Some(7), user: None });
        assert!(matches!(receive::<Event>(&mut reader).unwrap(), Event::Failed(_)));
        assert_eq!(reader, b"rest");
    }

    #[test]
    fn a_length_out_of_step_is_an_error_and_not_an_allocation() {
        assert!(receive::<Event>(&u64::MAX.to_le_bytes()[..]).is_err());
    }
}
