//! For whoever runs the server.
use crate::{
    access::{Metrics, Visitor},
    problem::Problem,
};
use axum::{
    http::header,
    response::{IntoResponse, Response},
};

/// Whether the process is alive.
#[utoipa::path(get, path = "/health", tag = "operations", responses((status = 200, body = String, content_type = "text/plain", description = "It is")))]
pub(super) async fn health() -> &'static str {
    "alive\n"
}

/// Whether requests can be served: the database answers, and its tables are of this version.
#[utoipa::path(get, path = "/ready", tag = "operations",
    responses((status = 200, body = String, content_type = "text/plain", description = "They can")))]
pub(super) async fn ready(visitor: Visitor) -> Result<&'static str, Problem> {
    visitor.ready().await?;
    Ok("ready\n")
}

/// This description.
#[utoipa::path(get, path = "/api/openapi.json", tag = "operations",
    responses((status = 200, body = Object, description = "OpenAPI 3.1")))]
pub(super) async fn openapi() -> Response {
    ([(header::CONTENT_TYPE, "application/json")], crate::web::openapi()).into_response()
}

fn line(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

/// Numbers for Prometheus. They tell of nobody. Without a database that answers they are those of the process alone.
#[utoipa::path(get, path = "/metrics", tag = "operations",
    responses((status = 200, body = String, content_type = "text/plain", description = "Prometheus' text format")))]
pub(super) async fn metrics(visitor: Visitor) -> Result<Response, Problem> {
    let mut text = visitor.instruments()?;
    let asked = visitor.metrics().await;
    head(&mut text, "database_up", "gauge", "Whether the database answers.");
    line(&mut text, &format!("fosssim_database_up {}", i32::from(asked.is_ok())));
    if let Ok(metrics) = asked {
        of_queue(&mut text, &metrics);
    }
    Ok(([(header::CONTENT_TYPE, "text/plain; version=0.0.4; charset=utf-8")], text).into_response())
}

fn head(text: &mut String, name: &str, kind: &str, help: &str) {
    line(text, &format!("# HELP fosssim_{name} {help}\n# TYPE fosssim_{name} {kind}"));
}

/// What the database knows of the queue.
fn of_queue(text: &mut String, metrics: &Metrics) {
    for (name, help, counts) in [
        ("jobs", "Gradings by state.", &metrics.jobs),
        ("scores", "Scores for learning platforms by state.", &metrics.scores),
    ] {
        head(text, name, "gauge", help);
        for state in ["waiting", "running", "done", "buried", "cancelled"] {
            let count = counts.iter().find(|(name, _)| name == state).map_or(0, |(_, count)| *count);
            line(text, &format!("fosssim_{name}{{state=\"{state}\"}} {count}"));
        }
    }
    head(text, "oldest_waiting_seconds", "gauge", "How long the oldest waiting upload has waited.");
    // Milliseconds, written as seconds to the digit.
    let oldest = metrics.oldest.max(0);
    line(text, &format!("fosssim_oldest_waiting_seconds {}.{:03}", oldest / 1000, oldest % 1000));
    for (name, help, value) in [
        ("workers", "Workers that were seen lately.", metrics.workers),
        ("slots", "Their slots.", metrics.slots),
        ("workers_aside", "Workers that take no jobs, because they can't grade.", metrics.aside),
        ("jobs_paused", "Jobs that wait for staff: nothing can be graded by their suite.", metrics.paused),
        ("suspicions", "Scenes in which the reference may be wrong, undecided.", metrics.suspicions),
    ] {
        head(text, name, "gauge", help);
        line(text, &format!("fosssim_{name} {value}"));
    }
    head(
        text,
        "workers_by_state",
        "gauge",
        "Workers that were seen lately: they grade, wait for a job, or can't grade.",
    );
    let idle = metrics.workers - metrics.working - metrics.aside;
    for (state, value) in [("working", metrics.working), ("idle", idle), ("aside", metrics.aside)] {
        line(text, &format!("fosssim_workers_by_state{{state=\"{state}\"}} {value}"));
    }
    head(text, "submissions_total", "counter", "Submissions.");
    line(text, &format!("fosssim_submissions_total {}", metrics.submissions));
    head(text, "events_total", "counter", "Results, and what went wrong with jobs.");
    for (kind, label) in
        [("graded", "graded"), ("failed try", "failed_try"), ("late answer", "late_answer"), ("buried", "buried")]
    {
        let count = metrics.events.iter().find(|(name, _)| name == kind).map_or(0, |(_, count)| *count);
        line(text, &format!("fosssim_events_total{{kind=\"{label}\"}} {count}"));
    }
}
