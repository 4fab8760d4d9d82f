//! The messages between the grader and its supervisor process.
//!
//! The grader writes one length-prefixed [`RunOrder`] to the supervisor's standard input, a socket, and then, if
//! needed, a command byte. An open working folder in memory is returned on the same socket. The supervisor answers on
//! its standard output with length-prefixed [`Event`]s; the last one is followed by the captured bytes. Paths are sent
//! as bytes, because they may not be UTF-8.

use std::{
    io::{self, Read, Write},
    os::unix::ffi::{OsStrExt, OsStringExt},
    path::{Path, PathBuf},
    time::Duration,
};

use fosssim_ended::RunEnd;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::job::Limits;

/// The hidden first argument that turns the binary into the supervisor.
pub(super) const SUPERVISOR_ARGUMENT: &str = "__sandbox-supervisor";
/// The command byte that stops the program.
pub(super) const COMMAND_CANCEL: u8 = b'c';
/// The size that few messages exceed, in bytes.
const USUAL_MESSAGE_BYTES: u64 = 4 << 10;
/// The maximum size of a message, in bytes. A larger size means that the stream is corrupt.
const MAX_MESSAGE_BYTES: u64 = 64 << 20;

/// The byte that starts a run in a supervisor of several runs. It is sent with three descriptors: the channel of
/// commands, the channel of answers, and the working folder on disk.
pub(super) const RUN_BYTE: u8 = b'r';
/// The byte that announces a working folder in memory to the grader. It is sent with the folder.
pub(super) const FOLDER_BYTE: u8 = b'f';

/// The bytes of a path or an argument.
pub(super) type RawBytes = Vec<u8>;

/// Converts a path into bytes.
pub(super) fn to_raw_bytes(path: &Path) -> RawBytes {
    path.as_os_str().as_bytes().to_vec()
}

/// Converts bytes into a path.
pub(super) fn path(raw: &RawBytes) -> PathBuf {
    PathBuf::from(std::ffi::OsString::from_vec(raw.clone()))
}

/// Returns the bytes as the name of a folder's entry, if the name does not leave the folder.
pub(super) fn plain_name(raw: &[u8]) -> Option<&Path> {
    let leads_on = raw.is_empty() || raw == b"." || raw == b".." || raw.iter().any(|byte| matches!(byte, b'/' | 0));
    (!leads_on).then(|| Path::new(std::ffi::OsStr::from_bytes(raw)))
}

/// The layers that the supervisor must set up. A requested layer that fails is an error, never skipped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Walls {
    pub(super) landlock: bool,
    /// The version of the Landlock rules, if they are those of an older kernel; 0 for the newest.
    pub(super) landlock_version: u8,
    pub(super) scopes: bool,
    pub(super) seccomp: bool,
    pub(super) notify: bool,
    pub(super) own_user: bool,
    pub(super) namespaces: bool,
    pub(super) group: bool,
}

/// The order for one run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct RunOrder {
    pub(super) program: RawBytes,
    pub(super) folder: RawBytes,
    pub(super) arguments: Vec<RawBytes>,
    pub(super) environment: Vec<(RawBytes, RawBytes)>,
    pub(super) readable: Vec<RawBytes>,
    /// The interpreters that the kernel executes to start the program.
    pub(super) executable: Vec<RawBytes>,
    /// The names that the program and the kernel use for the files, which may be links.
    pub(super) named: Vec<RawBytes>,
    /// The grader's own files, which no run may see. The grader finds them once for all runs.
    pub(super) own: Vec<RawBytes>,
    /// The name of the trace in the working folder.
    pub(super) trace: Option<RawBytes>,
    /// The files that are written into the working folder, by name, with their length; their bytes follow the order.
    /// Used only if the folder is in memory.
    pub(super) files: Vec<(RawBytes, u64)>,
    /// Whether the working folder is in memory. The supervisor then sends it to the grader.
    pub(super) volatile: bool,
    pub(super) tools: bool,
    /// The interpreter of a script, which is executed instead of it.
    pub(super) interpreter: Option<RawBytes>,
    /// The interpreter's own name, followed by its arguments before the script.
    pub(super) words: Vec<RawBytes>,
    /// Whether the program may use a sanitizer, which reserves terabytes of address space.
    pub(super) sanitizers: bool,
    pub(super) walls: Walls,
    pub(super) limits: Limits,
}

impl RunOrder {
    /// Returns the maximum size of the working folder in bytes, including the trace.
    pub(super) fn folder_bytes(&self) -> u64 {
        let trace = if self.trace.is_some() { self.limits.trace_bytes } else { 0 };
        self.limits.folder_bytes.saturating_add(trace)
    }

    /// Returns the maximum size of a file. One byte beyond the limit of the trace shows that it is too long.
    pub(super) fn file_bytes(&self) -> u64 {
        let trace = if self.trace.is_some() { self.limits.trace_bytes.saturating_add(1) } else { 0 };
        self.limits.folder_bytes.max(trace)
    }
}

/// A message of the supervisor.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Event {
    /// The child was forked. Holds its session, unless its process namespace has separate numbers, and its own user, if
    /// it has one.
    Ready { session: Option<i32>, user: Option<u32> },
    /// The sandbox could not be set up, which is an error of the grader or host.
    Failed(Failure),
    /// All processes have ended; the captured bytes of both streams follow.
    Done(Report),
}

/// The setup step whose failure is the program's and not the grader's.
pub(super) const EXECUTE_STEP: &str = "execute the program";

/// A failed setup step.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Failure {
    pub(super) stage: String,
    pub(super) errno: i32,
}

impl Failure {
    /// Creates a failure of `stage` with the error's number (0 if it has none).
    pub(super) fn new(stage: impl Into<String>, error: &io::Error) -> Self {
        Self { stage: stage.into(), errno: error.raw_os_error().unwrap_or(0) }
    }
}

/// Converts an error of the system into a failure of the stage `name`.
pub(super) fn failure_at(name: &'static str) -> impl FnOnce(io::Error) -> Failure {
    move |error| Failure::new(name, &error)
}

/// The facts of a finished run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Report {
    /// The first reason to kill the program, if there was one.
    pub(super) cause: Option<RunEnd>,
    /// The raw wait status of the main process.
    pub(super) status: i32,
    /// The error number of `execve`, if the program never ran.
    pub(super) exec_errno: Option<i32>,
    pub(super) cpu: Duration,
    pub(super) wall: Duration,
    pub(super) peak_memory: u64,
    /// Whether the trace is longer than its limit.
    pub(super) trace_over: bool,
    /// Whether the folder exceeds a limit at the end.
    pub(super) folder_over: bool,
    pub(super) stdout_bytes: u64,
    pub(super) stderr_bytes: u64,
    pub(super) stdout_truncated: bool,
    pub(super) stderr_truncated: bool,
    /// The number of processes that could not be killed.
    pub(super) survivors: u32,
}

/// The results of the probe; a text is the reason why a layer does not work.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Probe {
    pub(super) root: bool,
    /// Whether the grader is in root's group without being root.
    pub(super) roots_group: bool,
    pub(super) landlock_abi: i32,
    pub(super) no_new_privileges: Option<String>,
    pub(super) limits: Option<String>,
    pub(super) landlock: Option<String>,
    pub(super) seccomp: Option<String>,
    pub(super) notify: Option<String>,
    pub(super) own_user: Option<String>,
    pub(super) reaper: Option<String>,
    /// The reason why copies of programs cannot be executed.
    pub(super) execution: Option<String>,
    /// Whether copies are executed in memory, because the temporary folder forbids execution.
    pub(super) from_memory: bool,
    pub(super) namespaces: Option<String>,
    pub(super) group: Option<String>,
    /// The quantities that the kernel limits for a control group.
    pub(super) group_controls: Vec<String>,
    /// Whether a control group can be ended as a whole.
    pub(super) group_ends: bool,
}

/// Writes one message.
pub(super) fn send<T: Serialize>(mut to: impl Write, message: &T) -> io::Result<()> {
    to.write_all(&encode_packet(message)?)?;
    to.flush()
}

/// Returns the encoded form of one message.
pub(super) fn encode_packet<T: Serialize>(message: &T) -> io::Result<Vec<u8>> {
    let body = serde_json::to_vec(message)?;
    let mut packet = (body.len() as u64).to_le_bytes().to_vec();
    packet.extend_from_slice(&body);
    Ok(packet)
}

/// Reads `length` bytes. Memory grows as they arrive.
pub(super) fn receive_bytes(from: impl Read, length: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(usize::try_from(length.min(USUAL_MESSAGE_BYTES)).unwrap_or_default() + 1);
    if from.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(bytes)
}

/// Reads exactly one message.
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
    // Do not trust the length in the message.
    Ok(serde_json::from_slice(&receive_bytes(from, length)?)?)
}

/// Reads as many messages of each kind as the bytes contain, and requires that each is the same after sending; for the
/// fuzz target. Returns the number of messages.
#[doc(hidden)]
#[must_use]
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
