//! The original program's lenient scene reader, reproduced rule by rule.
//!
//! The drop-in command must accept what the original accepts, read the same values from it and reject the rest with the
//! same messages. This reader therefore follows its rules (scene-format.md 1 to 6): lines are joined without a
//! separator, the longest prefix that looks like a number counts, unknown names are ignored, and the first problem ends
//! the reading. Authors of scenes are better served by the strict reader, [`crate::scene::read`].
//!
//! The original's XML parser accepts closing tags of any name, several roots and attributes without white space between
//! them, and crashes on some valid XML. No maintained XML library behaves like that, so `markup` is a small parser. It
//! is iterative and borrows from the text, so deep nesting and large files are safe.
//!
//! A scene for which the original would read out of bounds (an index out of range) has no defined outcome. It is
//! rejected as [`RejectionKind::Undefined`] with a message of this program.

mod item;
mod markup;
mod reader;
mod single;
#[cfg(test)]
mod tests;
mod values;

pub use reader::read;

use super::model::Scene;

/// A scene as read by the original.
#[derive(Debug, Clone, PartialEq)]
pub struct OriginalScene {
    /// The scene. Text that is not UTF-8 is replaced; trails of particles that do not exist are left out, because they
    /// have no effect.
    pub scene: Scene,
    /// The description in the banner, byte for byte; the original's default if the scene has none.
    pub description: Vec<u8>,
}

/// The reason why the original does not run a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{explanation}")]
pub struct Rejection {
    /// The effect on the original: an error message, a crash or undefined behavior.
    pub kind: RejectionKind,
    /// The bytes on standard error, including escape sequences and the final newline. For [`RejectionKind::Undefined`]
    /// the message is this program's.
    pub stderr: Vec<u8>,
    /// The exit code as a shell shows it: 1 for most messages, 0 for messages about half-planes, 134 for broken XML.
    pub exit_code: u8,
    /// The message without escape sequences.
    pub explanation: String,
}

/// The kinds of rejections of a scene by the original.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RejectionKind {
    /// The original prints a message and exits.
    Message,
    /// The original crashes with an uncaught exception (broken XML).
    Crash,
    /// The original would read out of bounds; this program rejects the scene.
    Undefined,
}

impl Rejection {
    /// Returns the original's message about a scene file that cannot be opened (scene-format.md 1). The name may
    /// contain any bytes.
    pub fn from_unreadable_file(name: &[u8]) -> Self {
        let stderr =
            [&b"\x1b[31;1mERROR IN TWODSCENEXMLPARSER:\x1b[m XML scene file "[..], name, b". Failed to read file.\n"]
                .concat();
        let explanation = format!("XML scene file {}. Failed to read file.", String::from_utf8_lossy(name));
        Self { kind: RejectionKind::Message, stderr, exit_code: 1, explanation }
    }

    /// Returns a message of the scene parser. `text` may contain bytes of the scene that are not UTF-8.
    fn from_message(text: &[u8], exit_code: u8) -> Self {
        let mut stderr = b"\x1b[31;1mERROR IN XMLSCENEPARSER:\x1b[m ".to_vec();
        stderr.extend_from_slice(text);
        stderr.push(b'\n');
        let explanation = String::from_utf8_lossy(text).into_owned();
        Self { kind: RejectionKind::Message, stderr, exit_code, explanation }
    }

    /// Returns the crash by an uncaught exception of the XML parser.
    fn from_crash(what: &str) -> Self {
        let stderr =
            format!("terminate called after throwing an instance of 'rapidxml::parse_error'\n  what():  {what}\n");
        let explanation = format!("the scene is not well-formed XML: {what}");
        Self { kind: RejectionKind::Crash, stderr: stderr.into_bytes(), exit_code: 134, explanation }
    }

    /// Returns the rejection of an input without a defined outcome in the original.
    fn from_undefined_input(explanation: String) -> Self {
        let stderr = format!("{explanation}\n").into_bytes();
        Self { kind: RejectionKind::Undefined, stderr, exit_code: 1, explanation }
    }
}
