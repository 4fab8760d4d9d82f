//! A client that keeps one connection, as a browser does.
use anyhow::{Context, Result, bail};
use axum::{
    body::{Body, Bytes},
    http::{Method, Request, Response, StatusCode, header},
};
use futures_util::StreamExt;
use hyper::{
    body::Incoming,
    client::conn::http1::{self, SendRequest},
};
use hyper_util::rt::TokioIo;
use std::{
    net::{IpAddr, SocketAddr},
    time::Duration,
};
use tokio::net::{TcpSocket, TcpStream};

/// The time without an answer after which a request counts as an error.
const PATIENCE: Duration = Duration::from_secs(300);

/// A person with a browser.
pub(super) struct Client {
    server: SocketAddr,
    /// The student's own address. All addresses in 127.0.0.0/8 belong to this machine.
    address: IpAddr,
    connection: Option<SendRequest<Body>>,
    session: Option<String>,
}

/// The server's answer.
pub(super) struct Answer {
    pub(super) status: StatusCode,
    pub(super) body: Bytes,
}

/// Connects to the server from this address of this machine.
pub(super) async fn connect(server: SocketAddr, address: IpAddr) -> Result<TcpStream> {
    let socket = TcpSocket::new_v4()?;
    socket.bind((address, 0).into())?;
    Ok(socket.connect(server).await?)
}

impl Client {
    pub(super) fn new(server: SocketAddr, number: usize) -> Self {
        let [_, high, middle, low] = u32::try_from(number.saturating_add(1)).unwrap_or(1).to_be_bytes();
        Self { server, address: IpAddr::from([127, high, middle, low]), connection: None, session: None }
    }

    /// Signs in with the secret of a link.
    pub(super) async fn welcome(&mut self, secret: &str) -> Result<()> {
        let answer = self.request(Method::POST, &format!("/welcome/{secret}"), Bytes::new()).await?;
        if answer.status != StatusCode::SEE_OTHER || self.session.is_none() {
            bail!("signing in: {}", answer.status);
        }
        Ok(())
    }

    /// Returns the cookie of the session.
    pub(super) fn cookie(&self) -> String {
        self.session.clone().unwrap_or_default()
    }

    /// Continues with another client's session.
    pub(super) fn take(&mut self, cookie: String) {
        self.session = Some(cookie);
    }

    pub(super) async fn get(&mut self, path: &str) -> Result<Answer> {
        self.request(Method::GET, path, Bytes::new()).await
    }

    /// Reads an answer to its end, and returns its number of bytes.
    pub(super) async fn pull(&mut self, path: &str) -> Result<usize> {
        let response = self.ask(Method::GET, path, Bytes::new()).await?.1;
        let mut pieces = Body::new(response.into_body()).into_data_stream();
        let mut bytes = 0;
        while let Some(piece) = pieces.next().await {
            bytes += piece?.len();
        }
        Ok(bytes)
    }

    /// Sends a request, and reads the answer to its end.
    pub(super) async fn request(&mut self, method: Method, path: &str, body: Bytes) -> Result<Answer> {
        tokio::time::timeout(PATIENCE, self.exchange(method, path, body)).await.context("no answer in five minutes")?
    }

    async fn exchange(&mut self, method: Method, path: &str, body: Bytes) -> Result<Answer> {
        let (connection, response) = self.ask(method, path, body).await?;
        let status = response.status();
        let body = axum::body::to_bytes(Body::new(response.into_body()), usize::MAX).await?;
        self.connection = Some(connection);
        Ok(Answer { status, body })
    }

    /// Sends a request, by a new connection if the old one is closed.
    async fn ask(
        &mut self,
        method: Method,
        path: &str,
        body: Bytes,
    ) -> Result<(SendRequest<Body>, Response<Incoming>)> {
        let mut kept = self.connection.take();
        let is_open = match &mut kept {
            Some(connection) => connection.ready().await.is_ok(),
            None => false,
        };
        let mut connection = match kept.filter(|_| is_open) {
            Some(connection) => connection,
            None => {
                let stream = connect(self.server, self.address).await?;
                let (connection, driver) = http1::handshake(TokioIo::new(stream)).await?;
                tokio::spawn(driver);
                connection
            }
        };
        let kind = if path.contains("submissions?") { "application/octet-stream" } else { "application/json" };
        let request = Request::builder()
            .method(method)
            .uri(path)
            .header(header::HOST, self.server.to_string())
            .header("Sec-Fetch-Site", "same-origin")
            .header(header::CONTENT_TYPE, kind)
            .header(header::COOKIE, self.cookie())
            .body(Body::from(body))?;
        let response = connection.send_request(request).await?;
        if let Some(cookie) = response.headers().get(header::SET_COOKIE) {
            self.session = cookie.to_str()?.split(';').next().map(str::to_owned);
        }
        Ok((connection, response))
    }
}
