//! The log, on standard error. Messages can be read alone; what varies is in fields. Secrets are in neither: types that
//! hold one do not show it. A program built with the feature `otel` also sends traces of requests.
use super::arguments::LogFormat;
#[cfg(feature = "otel")]
use super::traces::{self, Traces};
use tracing_subscriber::{
    Layer,
    filter::{FilterExt, LevelFilter, filter_fn},
    fmt,
    layer::SubscriberExt,
    util::SubscriberInitExt,
};

/// Traces can't be sent.
#[cfg(not(feature = "otel"))]
pub(super) enum Traces {}

/// Begins to log. The last traces are sent when the answer is dropped.
#[must_use]
pub(super) fn begin(format: LogFormat) -> Option<Traces> {
    let level = match std::env::var("FOSSSIM_LOG").as_deref() {
        Ok("debug") => LevelFilter::DEBUG,
        Ok("warn") => LevelFilter::WARN,
        Ok("error") => LevelFilter::ERROR,
        _ => LevelFilter::INFO,
    };
    // A log that can't be written, as on a full disk, is no reason to answer nobody: a report of it would go the same
    // way, and panic.
    let log = fmt::layer().with_writer(std::io::stderr).with_target(false).log_internal_errors(false);
    let log = match format {
        LogFormat::Text => log.with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr())).boxed(),
        LogFormat::Json => log.json().flatten_event(true).boxed(),
    };
    // Spans are for traces: a line of the log says all by itself.
    let log = tracing_subscriber::registry().with(log.with_filter(level.and(filter_fn(|what| what.is_event()))));
    #[cfg(feature = "otel")]
    {
        let (traces, layer) = traces::begin();
        log.with(layer).init();
        traces
    }
    #[cfg(not(feature = "otel"))]
    {
        log.init();
        None
    }
}
