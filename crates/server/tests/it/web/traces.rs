//! Traces for a collector.
use std::{
    io::{BufRead, BufReader, Read, Write},
    net::TcpListener,
    process::{Command, Stdio},
};

#[test]
fn a_collector_hears_of_requests_by_their_route() {
    let folder = tempfile::tempdir().expect("a folder");
    let collector = TcpListener::bind("127.0.0.1:0").expect("a port");
    let mut server = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
        .args(["serve", "--workers", "0", "--listen", "127.0.0.1:0", "--data"])
        .arg(folder.path().join("data"))
        .env_remove("FOSSSIM_DATABASE")
        .env("OTEL_EXPORTER_OTLP_ENDPOINT", format!("http://{}", collector.local_addr().expect("an address")))
        .env("OTEL_BSP_SCHEDULE_DELAY", "50")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("a server");
    let mut line = String::new();
    BufReader::new(server.stdout.as_mut().expect("its output")).read_line(&mut line).expect("a line");
    let url = line.trim().strip_prefix("Listening on ").expect("an address").to_owned();
    let client = crate::support::server::Client { url, headers: Vec::new() };
    client.get("/api/v1/courses/a-secret-course/members").expect(401);
    // One message of the exporter: its head, and as many bytes as that says.
    let (stream, _) = collector.accept().expect("a message");
    let mut stream = BufReader::new(stream);
    let mut head = String::new();
    while !head.ends_with("\r\n\r\n") {
        assert!(stream.read_line(&mut head).expect("a line") > 0, "{head}");
    }
    assert!(head.starts_with("POST /v1/traces "), "{head}");
    let lower = head.to_lowercase();
    let length = lower.lines().find_map(|line| line.strip_prefix("content-length: ")).expect("a length");
    let mut body = vec![0; length.parse().expect("a number")];
    stream.read_exact(&mut body).expect("a body");
    stream.get_mut().write_all(b"HTTP/1.1 200 OK\r\ncontent-length: 0\r\n\r\n").expect("an answer");
    let said = String::from_utf8_lossy(&body);
    for word in ["fosssim-server", "GET /api/v1/courses/{course}/members", "http.response.status_code"] {
        assert!(said.contains(word), "no {word} in {said}");
    }
    assert!(!said.contains("a-secret-course"), "{said}");
    server.kill().expect("an end");
    server.wait().expect("an end");
}
