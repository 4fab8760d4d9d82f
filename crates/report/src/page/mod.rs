//! Renders reports as a single HTML file. The essentials are text and SVG, and a viewer shows the motion.
//!
//! The file loads nothing from the network or from other files. Its policy allows one script and one style sheet by
//! their digests, and no evaluated code. All text from a submission, a scene or a path is escaped (`markup`). Without
//! script, only the viewer is missing, and the page can be printed.

mod call;
mod card;
mod card_details;
mod case;
mod class;
mod data;
mod examined_page;
mod explained_page;
mod grade_page;
mod heat;
mod histogram;
mod markup;
mod packed_motions;
mod smallest;
mod strip;
#[cfg(test)]
mod tests;

pub use card::Card;
pub use class::ClassPage;
pub use examined_page::examined_page;
pub use explained_page::ExplainedPage;
pub use grade_page::{Audience, GradePage};

use super::check::Check;
use askama::Template;
use fosssim_evidence::{Evidence, Track};
use fosssim_findings::Hints;
use fosssim_model::scene::Scene;
use sha2::{Digest, Sha256};
use std::sync::LazyLock;

/// The part of the viewer's script that creates elements. The page around reports uses it as well.
pub const ELEMENTS: &str = include_str!("viewer/elements.js");

/// The viewer's script. Pages of the server contain it as well.
const VIEWER: &str = include!("viewer/viewer.in");
const STYLE: &str = include_str!("style.css");

/// A run of the reference with one mistake of the catalog built in.
#[derive(Debug, Clone, PartialEq)]
pub struct MistakeRun {
    /// The mistake's key in the catalog.
    pub id: String,
    /// The mistake as a sentence.
    pub sentence: String,
    /// The motion of this run, for the same steps as in the evidence.
    pub track: Track,
    /// Whether this run writes the same bytes as the submission.
    pub equal: bool,
}

/// One judged trace, and everything that a page shows about it.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The verdict, the findings and the explanations.
    pub check: Check<'a>,
    /// The scene that the trace belongs to.
    pub scene: &'a Scene,
    /// The data for the motion viewer. With `None`, the page has no viewer and no plots.
    pub evidence: Option<&'a Evidence>,
    /// A run of the reference with the mistake of the first explanation built in, as a proof.
    pub mistake_run: Option<&'a MistakeRun>,
    /// The amount of detail on the page. The file does not contain what the hints hide.
    pub hints: Hints,
    /// Whether the reader of the page has the trace. Commands on the page can then name its file.
    pub has_trace: bool,
}

/// Returns the viewer's script without indentation and comments. No string in the script spans several lines.
fn script() -> &'static str {
    static SCRIPT: LazyLock<String> = LazyLock::new(|| {
        let lines = VIEWER.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//"));
        lines.flat_map(|line| [line, "\n"]).collect()
    });
    &SCRIPT
}

/// Returns the style sheet of all pages. Other pages use it to have the same design.
pub fn style() -> String {
    format!("{}{STYLE}", fosssim_render::plot::STYLE)
}

/// Returns the policy sources that allow the script and the style of a report. A page that shows a report in a frame
/// must allow them as well, because a frame inherits the policy of the surrounding page.
pub fn framed_digests() -> [String; 2] {
    [script(), &style()].map(|text| format!("'{}'", digest(text)))
}

/// Renders an HTML file around a body. It has one style sheet, at most one script, and a policy that allows nothing
/// else.
fn render_document(title: &str, body: &str, script: &str) -> String {
    let style = style();
    let allowed = if script.is_empty() { "'none'".to_owned() } else { format!("'{}'", digest(script)) };
    let policy = format!(
        "default-src 'none'; script-src {allowed}; style-src '{}'; img-src blob: data:; media-src blob:; base-uri \
         'none'; form-action 'none'",
        digest(&style)
    );
    let title = markup::escape(title);
    let script = if script.is_empty() { String::new() } else { format!("<script>{script}</script>\n") };
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"robots\" content=\"noindex\">\n<title>{title}</title>\n<style>{style}</style>\n</head>\n<body>\n\
         <a class=\"skip\" href=\"#content\">To the content</a>\n<main id=\"content\">\n{body}</main>\n\
         <footer><p>Written by fosssim-oracle {}. Lengths, times and velocities are in the scene's \
         units.</p></footer>\n\
         {script}</body>\n</html>\n",
        env!("CARGO_PKG_VERSION"),
    )
}

/// Renders a template. This can't fail, because the text is written to memory.
fn render_template(template: &impl Template) -> String {
    template.render().unwrap_or_default()
}

/// Returns the digest by which a content security policy allows a script or a style sheet.
pub fn digest(text: &str) -> String {
    use base64::Engine;
    format!("sha256-{}", base64::engine::general_purpose::STANDARD.encode(Sha256::digest(text)))
}
