//! The strict reader. It returns a whole scene or all its problems together.
//!
//! A scene that the original accepts silently and then simulates differently from its text, or that crashes it, is an
//! error here (scene-format.md 6). A scene without errors has the same meaning for both readers, which is checked at
//! the end.
use std::borrow::Cow;

use super::model::Scene;
use super::problem::{Problem, Problems, Report};
use super::{checks, document, original, xml};

/// The maximum size of a scene file, in bytes.
pub const MAX_SCENE_BYTES: usize = 8 << 20;

/// A scene without errors.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedScene {
    /// The scene; all indices are valid, all numbers finite.
    pub scene: Scene,
    /// Warnings for the author to review, in the order of their positions.
    pub warnings: Vec<Problem>,
}

/// Reads a scene. `name` is its name in messages.
///
/// # Errors
///
/// Fails if at least one problem is an error, with all problems found, up to [`super::MAX_PROBLEMS`] of each severity.
/// The spans refer to `text` as given.
pub fn read(name: &str, text: &[u8]) -> Result<LoadedScene, Problems> {
    if text.len() > MAX_SCENE_BYTES {
        let message = format!("the file has {} bytes", text.len());
        return Err(Problems::from_whole_text(name, message, "a scene has at most 8 MiB"));
    }
    if text.starts_with(b"\xff\xfe") || text.starts_with(b"\xfe\xff") {
        return Err(Problems::from_whole_text(name, "the file is in UTF-16".into(), "save it as UTF-8"));
    }
    let mut report = Report::default();
    let readable = decode(text, &mut report);
    let document = document::read(&readable, &mut report);
    let mut scene = None;
    if document.scene.is_none() {
        if !document.is_broken && !document.has_other_root {
            report.add_error(|| {
                Problem::new(0..0, "the file has no `scene`")
                    .with_help("put everything between `<scene>` and `</scene>`")
            });
        }
    } else if let Some(parts) = xml::read(&document, &mut report) {
        checks::check(&document, &parts, &mut report);
        scene = parts.into_scene().filter(|_| !report.has_errors());
    }
    if let Some(found) = &scene {
        compare(found, text, &mut report);
    } else if !report.has_errors() {
        report.add_error(|| Problem::new(0..0, "the scene is incomplete"));
    }
    let refused = report.has_errors();
    let (list, omitted_count) = report.finish(text);
    match scene {
        Some(scene) if !refused => Ok(LoadedScene { scene, warnings: list }),
        _ => Err(Problems { source: name.to_owned(), list, omitted_count }),
    }
}

/// Returns the text with every byte that is not UTF-8 replaced by `?`, which keeps the offsets.
fn decode<'t>(text: &'t [u8], report: &mut Report) -> Cow<'t, str> {
    if let Some(at) = text.iter().position(|&byte| byte == 0) {
        report.add_error(|| Problem::new(at..at + 1, "a NUL byte").with_help("the original stops reading there"));
    }
    let Err(error) = std::str::from_utf8(text) else { return String::from_utf8_lossy(text) };
    let at = error.valid_up_to();
    report.add_error(|| Problem::new(at..at + 1, "a byte that is not UTF-8").with_help("save the file as UTF-8"));
    let mut readable = String::with_capacity(text.len());
    for chunk in text.utf8_chunks() {
        readable.push_str(chunk.valid());
        readable.extend(chunk.invalid().iter().map(|_| '?'));
    }
    Cow::Owned(readable)
}

/// Reports an error unless the original reads the same scene.
fn compare(scene: &Scene, text: &[u8], report: &mut Report) {
    let difference = match original::read(text) {
        Ok(original) if original.scene == *scene => return,
        Ok(_) => "it joins lines without a space and may see other markup".to_owned(),
        Err(rejection) => rejection.explanation,
    };
    report.add_error(|| Problem::new(0..0, "the original reads this file differently").with_help(difference));
}
