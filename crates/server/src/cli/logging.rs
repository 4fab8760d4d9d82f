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
    let log = tracing_subscriber::fmt().with_max_level(level).with_writer(std::io::stderr).with_target(false);
    match format {
        LogFormat::Text => log.with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr())).init(),
        LogFormat::Json => log.json().flatten_event(true).init(),
    }
}
