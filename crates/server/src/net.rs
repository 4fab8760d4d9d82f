//! Serves connections until the server stops, and completes the requests that have arrived. The proxy in front, which
//! docs/server/operation.md requires, limits the number of connections, and ends connections that send or read too
//! slowly.
use axum::Router;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::{io, net::SocketAddr, time::Duration};
use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;
use ureq::Agent;

/// The time that open connections have to finish after the server was requested to stop.
const GRACE_PERIOD: Duration = Duration::from_secs(20);

/// Serves connections until `stop` is canceled, and answers the requests that have arrived by then.
///
/// # Errors
///
/// Fails if connections can no longer be accepted.
pub async fn serve(listener: TcpListener, router: Router, stop: CancellationToken) -> io::Result<()> {
    // Each connection may also need a file, so raise the limit of open files to the kernel's maximum.
    let maximum = getrlimit(Resource::Nofile).maximum;
    if let Err(error) = setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum }) {
        tracing::debug!(%error, "cannot raise the limit of open files");
    }
    let service = router.into_make_service_with_connect_info::<SocketAddr>();
    let serving = axum::serve(listener, service).with_graceful_shutdown(stop.clone().cancelled_owned());
    tokio::select! {
        served = serving => served,
        () = async { stop.cancelled().await; tokio::time::sleep(GRACE_PERIOD).await } => {
            tracing::warn!("some connections did not end in time");
            Ok(())
        }
    }
}

/// Returns a client for requests to services that an administrator configured. It follows no redirections.
pub(crate) fn new_agent(allows_http: bool, timeout: Duration) -> Agent {
    Agent::config_builder()
        .http_status_as_error(false)
        .max_redirects(0)
        .https_only(!allows_http)
        .timeout_global(Some(timeout))
        .user_agent(concat!("fosssim-server/", env!("CARGO_PKG_VERSION")))
        .build()
        .new_agent()
}
