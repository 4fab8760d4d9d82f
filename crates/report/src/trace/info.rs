//! The summary of a trace as JSON. The report for people is the text of the summary itself.
use super::super::view::SCHEMA;
use fosssim_model::trace::{Summary, TraceError};
use serde_json::{Value, json};

/// Renders the summary as one JSON object, indented, with a line feed at its end.
pub fn info_json(scene: &str, trace: &str, summary: &Summary) -> String {
    let layout = summary.layout;
    let collision =
        |(step, impulse): &(u32, fosssim_model::trace::LoggedImpulse)| json!({ "step": step, "collision": impulse });
    let value = json!({
        "schema": SCHEMA,
        "scene": scene,
        "trace": trace,
        "collision": summary.collision,
        "particles": layout.particles,
        "edges": summary.edges,
        "half_planes": summary.half_planes,
        "steps": layout.steps,
        "records": summary.trace.records,
        "records_expected": layout.records(),
        "bytes": summary.trace.bytes,
        "all_bytes_read": !summary.trace.has_more_bytes,
        "sha256": (!summary.trace.has_more_bytes).then(|| summary.trace.sha256.to_string()),
        "trailing_bytes": summary.trace.trailing_bytes,
        "damage": summary.trace.stop_error.as_ref().map(describe_place),
        "oddities": { "count": summary.notes.0, "first": summary.notes.1.as_ref().map(describe_place) },
        "polynomials_per_pass": summary.polynomials_per_pass,
        "first_collisions": summary.collisions.iter().map(collision).collect::<Vec<_>>(),
    });
    format!("{value:#}\n")
}

/// Describes the damage of a trace and its place.
pub(super) fn describe_place(error: &TraceError) -> Value {
    json!({ "offset": error.offset, "frame": error.frame, "step": error.step, "message": error.what.to_string() })
}
