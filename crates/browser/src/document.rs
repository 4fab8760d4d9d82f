//! The page, one HTML file with the embedded module, which loads nothing else.
//!
//! Its policy allows its script, its style and those of the embedded reports by their digests. It also allows the
//! module, and a worker created by the page; no address is among the sources.
use crate::CourseSuite;
use base64::{Engine, engine::general_purpose::STANDARD};
use fosssim_report::page::{ELEMENTS, digest, framed_digests, style};
use miniz_oxide::deflate::compress_to_vec;

/// The parts of the page's script, in the order of their dependencies.
const SCRIPT_PARTS: [&str; 6] = [
    ELEMENTS,
    include_str!("../page/shell.js"),
    include_str!("../page/check.js"),
    include_str!("../page/submission.js"),
    include_str!("../page/try.js"),
    include_str!("../page/pair.js"),
];

/// The parts of the worker's script.
const WORKER_PARTS: [&str; 2] = [include_str!("../page/engine.js"), include_str!("../page/worker.js")];

const BODY: &str = include_str!("../page/body.html");
const STYLE: &str = include_str!("../page/page.css");

/// Returns the page with the module (WebAssembly, not compressed), and with the suite of a course if one is given.
#[must_use]
pub fn page(module: &[u8], course: Option<&CourseSuite>) -> String {
    let script = format!("\"use strict\";\n(() => {{\n{}}})();\n", lines(&SCRIPT_PARTS));
    let worker = lines(&WORKER_PARTS);
    let style = style() + STYLE;
    let [framed_script, framed_style] = framed_digests();
    let policy = format!(
        "default-src 'none'; script-src '{}' {framed_script} 'wasm-unsafe-eval'; worker-src blob:; \
         style-src '{}' {framed_style}; img-src blob: data:; media-src blob:; base-uri 'none'; form-action 'none'",
        digest(&script),
        digest(&style)
    );
    let module = STANDARD.encode(compress_to_vec(module, 10));
    let course = course.map_or_else(String::new, |course| {
        format!("<script type=\"application/json\" id=\"course\">{}</script>\n", course.data())
    });
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>fosssim-oracle in the browser</title>\n<style>{style}</style>\n</head>\n<body>\n{BODY}\
         <script type=\"application/octet-stream\" id=\"module\">{module}</script>\n\
         {course}<script type=\"text/plain\" id=\"worker\">{worker}</script>\n\
         <script>{script}</script>\n</body>\n</html>\n"
    )
}

/// Returns a script without indentation and comment lines, which only its authors need. Except in scenes, no text in it
/// spans several lines.
fn lines(parts: &[&str]) -> String {
    let lines = parts.iter().flat_map(|part| part.lines());
    lines
        .filter(|line| !line.trim().is_empty() && !line.trim_start().starts_with("//"))
        .flat_map(|line| [line, "\n"])
        .collect()
}
