//! The log, on standard error. Messages can be read alone; what varies is in fields. Secrets are in neither: types that
//! hold one do not show it.
use super::arguments::LogFormat;

/// Begins to log.
pub(super) fn begin(format: LogFormat) {
    let level = match std::env::var("FOSSSIM_LOG").as_deref() {
        Ok("debug") => tracing::Level::DEBUG,
        Ok("warn") => tracing::Level::WARN,
        Ok("error") => tracing::Level::ERROR,
        _ => tracing::Level::INFO,
    };
    // A log that can't be written, as on a full disk, is no reason to answer nobody: a report of it would go the same
    // way, and panic.
    let log = tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_target(false)
        .log_internal_errors(false);
    match format {
        LogFormat::Text => log.with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr())).init(),
        LogFormat::Json => log.json().flatten_event(true).init(),
    }
}
