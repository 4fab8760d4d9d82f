//! Reports as one HTML file: the essentials as text and SVG, the motion viewer on top.
//!
//! The file loads nothing else, from no network and no second file. Its policy allows the one script and the one style
//! sheet by their digests, and no evaluated code. All words of a submission, a scene or a path are text (`markup`).
//! Without script only the viewer is missing, and the page can be printed.

mod call;
mod card;
mod case;
mod class;
mod data;
mod examined;
mod explained;
mod graded;
mod heat;
mod histogram;
mod markup;
mod packed;
mod room;
mod smallest;
mod strip;
#[cfg(test)]
mod tests;

pub use card::Card;
pub use class::ClassPage;
pub use examined::examined_page;
pub use explained::ExplainedPage;
pub use graded::{Audience, GradePage};

use super::check::Check;
use askama::Template;
use fosssim_evidence::{Evidence, Track};
use fosssim_findings::Hints;
use fosssim_model::scene::Scene;
use sha2::{Digest, Sha256};
use std::sync::LazyLock;

/// The part of the script that makes elements, for a page around reports, too.
pub const ELEMENTS: &str = include_str!("viewer/elements.js");

/// The viewer's script. The server's pages have it, too.
const VIEWER: &str = include!("viewer/viewer.in");
const STYLE: &str = include_str!("style.css");

/// The reference's run with a named mistake switched on.
#[derive(Debug, Clone, PartialEq)]
pub struct WhatIf {
    /// The mistake's key in the catalogue.
    pub id: String,
    /// The mistake in a sentence.
    pub sentence: String,
    /// The motion, in the window of the evidence.
    pub track: Track,
    /// Whether it writes the same bytes as the submission.
    pub equal: bool,
}

/// One judged trace.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// Verdict, findings, explanations.
    pub check: Check<'a>,
    /// The scene.
    pub scene: &'a Scene,
    /// The data of the viewer; `None` leaves viewer and plots out.
    pub evidence: Option<&'a Evidence>,
    /// The proof of the first explanation.
    pub what_if: Option<&'a WhatIf>,
    /// The hints of the page. Hidden parts are not in the file at all.
    pub hints: Hints,
    /// Whether the reader of the page has the trace, so that commands may name it.
    pub has_trace: bool,
}

/// Returns the viewer's script without what only its authors need: indentation and lines that are comments. No text in
/// it spans several lines.
fn script() -> &'static str {
    static SCRIPT: LazyLock<String> = LazyLock::new(|| {
        let lines = VIEWER.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//"));
        lines.flat_map(|line| [line, "\n"]).collect()
    });
    &SCRIPT
}

/// Returns the style sheet of all pages, for a page of the same design.
#[must_use]
pub fn style() -> String {
    format!("{}{STYLE}", fosssim_render::plot::STYLE)
}

/// Returns the sources of script and style by which the policy of a page that shows a report in a frame allows the
/// report's: a frame inherits the policy of the page around it.
#[must_use]
pub fn framed_digests() -> [String; 2] {
    [script(), &style()].map(|text| format!("'{}'", digest(text)))
}

/// Renders a file around a body: one style sheet, at most one script, and a policy that allows these and nothing else.
fn document(title: &str, body: &str, script: &str) -> String {
    let style = style();
    let allowed = if script.is_empty() { "'none'".to_owned() } else { format!("'{}'", digest(script)) };
    let policy = format!(
        "default-src 'none'; script-src {allowed}; style-src '{}'; img-src blob: data:; media-src blob:; base-uri \
         'none'; form-action 'none'",
        digest(&style)
    );
    let title = markup::text(title);
    let script = if script.is_empty() { String::new() } else { format!("<script>{script}</script>\n") };
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"robots\" content=\"noindex\">\n<title>{title}</title>\n<style>{style}</style>\n</head>\n<body>\n\
         <a class=\"skip\" href=\"#content\">To the content</a>\n<main id=\"content\">\n{body}</main>\n\
         <footer><p>Written by fosssim-oracle {}. Lengths, times and velocities are in the scene's units.</p></footer>\n\
         {script}</body>\n</html>\n",
        env!("CARGO_PKG_VERSION"),
    )
}

/// Renders a template, which can't fail: it is written to memory.
fn render_template(template: &impl Template) -> String {
    template.render().unwrap_or_default()
}

/// Returns the digest by which a policy allows a script or a style sheet.
#[must_use]
pub fn digest(text: &str) -> String {
    use base64::Engine;
    format!("sha256-{}", base64::engine::general_purpose::STANDARD.encode(Sha256::digest(text)))
}
