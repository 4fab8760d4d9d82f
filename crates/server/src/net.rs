//! Serving: connections are taken until the server is to end, and what was asked is answered then. The proxy that
//! docs/server/operation.md asks for limits their number, slow heads and slow readers.
use axum::Router;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::{io, net::SocketAddr, time::Duration};
use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;

/// How long connections may go on when the server is to end.
const GRACE: Duration = Duration::from_secs(20);

/// Serves until `stop` is cancelled and what was asked is answered.
///
/// # Errors
/// When connections can no longer be taken.
pub async fn serve(listener: TcpListener, router: Router, stop: CancellationToken) -> io::Result<()> {
    // Each connection may need a file besides: as many as the kernel lets this process have.
    let maximum = getrlimit(Resource::Nofile).maximum;
    if let Err(error) = setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum }) {
        tracing::debug!(%error, "the limit of open files stays");
    }
    let service = router.into_make_service_with_connect_info::<SocketAddr>();
    let serving = axum::serve(listener, service).with_graceful_shutdown(stop.clone().cancelled_owned());
    tokio::select! {
        served = serving => served,
        () = async { stop.cancelled().await; tokio::time::sleep(GRACE).await } => {
            tracing::warn!("some connections did not end in time");
            Ok(())
        }
    }
}
