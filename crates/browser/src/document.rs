//! The page. It is a single HTML file with the module embedded, and loads nothing else.
//!
//! The policy of the page allows its script and its style, and those of reports in it, by their digests. It also allows
//! the module, and a worker that the page creates. It does not allow any connection.
use crate::CourseSuite;
use base64::{Engine, engine::general_purpose::STANDARD};
use fosssim_report::page::{ELEMENTS, digest, framed_digests, style};
use miniz_oxide::deflate::compress_to_vec;

/// The parts of the page's script. A part uses only the parts before it.
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

/// Returns the page. `module` is the WebAssembly module, not compressed. If a course is given, the page contains its
/// suite.
pub fn page(module: &[u8], course: Option<&CourseSuite>) -> String {
    let script = format!("\"use strict\";\n(() => {{\n{}}})();\n", strip_lines(&SCRIPT_PARTS));
    let worker = strip_lines(&WORKER_PARTS);
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
        format!("<script type=\"application/json\" id=\"course\">{}</script>\n", course.to_json())
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

/// Returns a script without indentation and without comment lines. Except in scenes, no text in a script spans several
/// lines.
fn strip_lines(parts: &[&str]) -> String {
    let lines = parts.iter().flat_map(|part| part.lines());
    lines
        .filter(|line| !line.trim().is_empty() && !line.trim_start().starts_with("//"))
        .flat_map(|line| [line, "\n"])
        .collect()
}
