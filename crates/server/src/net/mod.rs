//! Taking connections: each has to say what it wants in time, and to take what it asked for; none is cut off in the
//! middle when the server ends.
//!
//! A connection that has sent no whole request waits, and anybody who comes takes the place of one that waits when all
//! places are taken (`seats`). So requests that never end keep nobody out, from whatever address they come.
mod address;
mod limit;
mod paced;
mod seats;

pub use address::{ClientAddress, Networks};
pub use limit::{KeyLimit, Permit};

use crate::problem::Problem;
use axum::{
    Router,
    body::Body,
    extract::Request,
    response::{IntoResponse, Response},
};
use hyper::{
    body::{Frame, Incoming, SizeHint},
    server::conn::http1,
    service::{Service, service_fn},
};
use hyper_util::{
    rt::{TokioIo, TokioTimer},
    server::graceful::GracefulShutdown,
    service::TowerToHyperService,
};
use paced::Paced;
use rustix::process::{Resource, getrlimit, setrlimit};
use seats::{Seat, Seats};
use std::{
    convert::Infallible,
    net::IpAddr,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
    time::Duration,
};
use tokio::{
    io::AsyncWriteExt,
    net::{TcpListener, TcpStream},
};
use tokio_util::sync::CancellationToken;

/// How long connections may go on when the server is to end, and how long those that have asked for nothing.
const GRACE: Duration = Duration::from_secs(20);
const GRACE_OF_WAITING: Duration = Duration::from_secs(1);

/// Files that the server opens for itself: database, store, pipes of graders.
const OWN_FILES: u64 = 200;

/// The largest head of a request, and how much of an answer lies in memory.
const BUFFER: usize = 16 * 1024;

/// How connections are taken.
#[derive(Debug, Clone)]
pub struct Manners {
    /// How long a head may take, and a client that reads nothing is waited for.
    pub patience: Duration,
    /// Connections at one time.
    pub connections: usize,
    /// Proxies whose word on a client's address counts.
    pub proxies: Networks,
}

/// Serves until `stop` is cancelled and what was asked is answered.
pub async fn serve(listener: TcpListener, router: Router, manners: Manners, stop: CancellationToken) {
    let graceful = GracefulShutdown::new();
    let seats = Seats::new(places(manners.connections));
    let door = Arc::new(Door { manners, router, proxied: KeyLimit::default(), share: seats.share() });
    loop {
        let accepted = tokio::select! {
            () = stop.cancelled() => break,
            accepted = listener.accept() => accepted,
        };
        let (stream, peer) = match accepted {
            Ok((stream, peer)) => (stream, peer.ip().to_canonical()),
            Err(error) => {
                // Out of file descriptors, or the other side is gone already.
                tracing::warn!(%error, "a connection could not be taken");
                seats.cut_one();
                tokio::time::sleep(Duration::from_millis(50)).await;
                continue;
            }
        };
        let Some(seat) = seats.take(peer, door.manners.proxies.contains(peer)) else {
            tracing::debug!("a connection was refused: all places are taken");
            tokio::spawn(refuse(stream));
            continue;
        };
        drop(stream.set_nodelay(true));
        let seat = Arc::new(seat);
        let (cut, guest) = (seat.cut(), Guest { door: door.clone(), seat, peer });
        let service = TowerToHyperService::new(door.router.clone());
        let connection = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(door.manners.patience)
            .max_buf_size(BUFFER)
            .serve_connection(
                TokioIo::new(Paced::new(stream, door.manners.patience)),
                service_fn(move |request| answer(guest.clone(), service.clone(), request)),
            );
        let connection = graceful.watch(connection);
        tokio::spawn(async move {
            tokio::select! {
                ended = connection => if let Err(error) = ended {
                    tracing::debug!(%error, "a connection broke off");
                },
                () = cut.cancelled() => tracing::debug!("a connection that asked for nothing gave its place away"),
            }
        });
    }
    drop(listener);
    let ended = async {
        let shutdown = graceful.shutdown();
        tokio::pin!(shutdown);
        if tokio::time::timeout(GRACE_OF_WAITING, &mut shutdown).await.is_err() {
            seats.cut_waiting();
            shutdown.await;
        }
    };
    if tokio::time::timeout(GRACE, ended).await.is_err() {
        tracing::warn!("some connections did not end in time");
    }
}

/// How many connections there is room for: each may need a file besides.
fn places(wanted: usize) -> usize {
    let limit = getrlimit(Resource::Nofile);
    // As many as the kernel lets this process have.
    let most = rustix::process::Rlimit { current: limit.maximum, maximum: limit.maximum };
    if let Err(error) = setrlimit(Resource::Nofile, most) {
        tracing::debug!(%error, "the limit of open files stays");
    }
    let files = getrlimit(Resource::Nofile).current.unwrap_or(u64::MAX);
    let room = usize::try_from(files.saturating_sub(OWN_FILES) / 2).unwrap_or(usize::MAX);
    if room < wanted {
        tracing::warn!(room, wanted, "fewer connections than wanted: raise the limit of open files (ulimit -n)");
    }
    room.min(wanted).max(8)
}

/// The common parts of all connections.
struct Door {
    manners: Manners,
    router: Router,
    /// Requests that proxies bring, by client.
    proxied: KeyLimit<IpAddr>,
    /// How many of these a client may have at one time.
    share: usize,
}

/// Whom a connection belongs to.
#[derive(Clone)]
struct Guest {
    door: Arc<Door>,
    seat: Arc<Seat>,
    peer: IpAddr,
}

/// Answers one request; its connection is not cut meanwhile.
async fn answer(
    guest: Guest,
    service: TowerToHyperService<Router>,
    request: hyper::Request<Incoming>,
) -> Result<Response, Infallible> {
    guest.seat.asked();
    let mut request: Request = request.map(Body::new);
    let client = guest.door.manners.proxies.client(guest.peer, request.headers());
    let pass = if client == guest.peer { None } else { Some(guest.door.proxied.pass(client, guest.door.share)) };
    let response = match pass {
        Some(None) => Problem::too_many("too many requests at one time come from this address").into_response(),
        _ => {
            request.extensions_mut().insert(ClientAddress(client));
            service.call(request).await?
        }
    };
    let (seat, pass) = (guest.seat, pass.flatten());
    Ok(response.map(|body| Body::new(Answered { body, seat, _pass: pass })))
}

/// A body that says when it is over.
struct Answered {
    body: Body,
    seat: Arc<Seat>,
    _pass: Option<Permit<IpAddr>>,
}

impl hyper::body::Body for Answered {
    type Data = axum::body::Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Self::Data>, Self::Error>>> {
        Pin::new(&mut self.body).poll_frame(context)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for Answered {
    fn drop(&mut self) {
        self.seat.answered();
    }
}

/// Says that there is no place, without reading anything.
async fn refuse(mut stream: TcpStream) {
    let problem = Problem::unavailable("too many connections at one time come from this address, or from all");
    let body = serde_json::to_string(&problem).unwrap_or_default();
    let text = format!(
        "HTTP/1.1 503 Service Unavailable\r\nContent-Type: application/problem+json\r\nContent-Length: {}\r\n\
         Retry-After: 5\r\nConnection: close\r\n\r\n{body}",
        body.len()
    );
    // Fits into the kernel's buffer; if not, nobody waits.
    drop(tokio::time::timeout(Duration::from_secs(1), stream.write_all(text.as_bytes())).await);
}
