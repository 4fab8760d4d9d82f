//! The original program's lenient scene reader, rule for rule.
//!
//! The drop-in command must accept what the original accepts, read the same values from it and reject the rest with the
//! same words, so this reader keeps its habits (scene-format.md 1 to 6): lines are joined without a separator, a number
//! is whatever prefix looks like one, unknown names are ignored, the first problem ends everything. Authors of scenes
//! are better served by the strict reader, [`crate::scene::read`].
//!
//! The original's XML parser accepts closing tags of any name, several roots and attributes without white space between
//! them, and dies of some things that XML allows. No well-kept XML library behaves like that, hence the small parser
//! in `markup`. It is iterative and borrows from the text, so that neither depth nor size can hurt it.
//!
//! A scene that the original goes on to simulate from memory that is not its own (an index out of range) has no defined
//! outcome; it is rejected as [`RefusalKind::Undefined`] in our own words.

mod item;
mod markup;
mod reader;
mod single;
#[cfg(test)]
mod tests;
mod values;

pub use reader::read;

use super::model::Scene;

/// A scene as the original understands it.
#[derive(Debug, Clone, PartialEq)]
pub struct OriginalScene {
    /// The scene. Text that is not UTF-8 is replaced there; trails of particles that do not exist are left out, since
    /// they have no effect.
    pub scene: Scene,
    /// The description in the banner, byte for byte; the original's default when the scene has none.
    pub description: Vec<u8>,
}

/// The reason why the original does not run a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{explanation}")]
pub struct Refusal {
    /// Which way it ends.
    pub kind: RefusalKind,
    /// The bytes on standard error, escape sequences and final newline included. For [`RefusalKind::Undefined`] these
    /// are our own.
    pub stderr: Vec<u8>,
    /// The exit code as a shell shows it: 1, 0 for half-planes, 134 for broken XML.
    pub exit_code: u8,
    /// The message in plain words, without escape sequences.
    pub explanation: String,
}

/// The ways in which the original rejects a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RefusalKind {
    /// The original prints a message and exits.
    Message,
    /// The original dies of an uncaught exception (broken XML).
    Crash,
    /// The original would read memory that is not its own; this program rejects the scene.
    Undefined,
}

impl Refusal {
    /// Returns the original's message about a scene file that cannot be opened (scene-format.md 1). The name may hold
    /// any bytes.
    #[must_use]
    pub fn unreadable(name: &[u8]) -> Self {
        let stderr =
            [&b"\x1b[31;1mERROR IN TWODSCENEXMLPARSER:\x1b[m XML scene file "[..], name, b". Failed to read file.\n"]
                .concat();
        let explanation = format!("XML scene file {}. Failed to read file.", String::from_utf8_lossy(name));
        Self { kind: RefusalKind::Message, stderr, exit_code: 1, explanation }
    }

    /// Returns a message of the scene parser. `text` may hold bytes of the scene that are not UTF-8.
    fn message(text: &[u8], exit_code: u8) -> Self {
        let mut stderr = b"\x1b[31;1mERROR IN XMLSCENEPARSER:\x1b[m ".to_vec();
        stderr.extend_from_slice(text);
        stderr.push(b'\n');
        let explanation = String::from_utf8_lossy(text).into_owned();
        Self { kind: RefusalKind::Message, stderr, exit_code, explanation }
    }

    /// Returns the end by an uncaught exception of the XML parser.
    fn crash(what: &str) -> Self {
        let stderr =
            format!("terminate called after throwing an instance of 'rapidxml::parse_error'\n  what():  {what}\n");
        let explanation = format!("the scene is not well-formed XML: {what}");
        Self { kind: RefusalKind::Crash, stderr: stderr.into_bytes(), exit_code: 134, explanation }
    }

    /// Returns an input without a defined outcome in the original.
    fn undefined(explanation: String) -> Self {
        let stderr = format!("{explanation}\n").into_bytes();
        Self { kind: RefusalKind::Undefined, stderr, exit_code: 1, explanation }
    }
}
