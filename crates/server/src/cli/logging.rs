//! The log, on standard error. Messages are constant, and variable parts are in fields. The log contains no secrets,
//! because types that contain a secret do not show it.
use super::arguments::LogFormat;
use tracing_subscriber::{Layer, filter::LevelFilter, fmt, layer::SubscriberExt, util::SubscriberInitExt};

/// Starts the log in the given format.
pub(super) fn start_log(format: LogFormat) {
    let level = match std::env::var("FOSSSIM_LOG").as_deref() {
        Ok("debug") => LevelFilter::DEBUG,
        Ok("warn") => LevelFilter::WARN,
        Ok("error") => LevelFilter::ERROR,
        _ => LevelFilter::INFO,
    };
    // If the log can't be written, for example on a full disk, the service must go on. A report of the error would go
    // to the same log, and panic.
    let log = fmt::layer().with_writer(std::io::stderr).with_target(false).log_internal_errors(false);
    let log = match format {
        LogFormat::Text => log.with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr())).boxed(),
        LogFormat::Json => log.json().flatten_event(true).boxed(),
    };
    tracing_subscriber::registry().with(log.with_filter(level)).init();
}
