//! Tests that the time at which an upload's head arrives counts for its due date, regardless of the duration of the
//! rest.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Answer, Client, JSON, Server, program},
};
use fosssim_server::values;
use std::{
    io::Write,
    net::TcpStream,
    time::{Duration, Instant},
};

on_both_engines!(work_that_came_in_time_is_in_time);

const SUBMISSIONS: &str = "/api/v1/courses/physics/assignments/m1/submissions";

/// Begins an upload: sends its head and the first byte.
fn begin(client: &Client, body: &[u8]) -> TcpStream {
    let host = client.url.strip_prefix("http://").expect("an address");
    let mut stream = TcpStream::connect(host).expect("a connection");
    let (name, value) = client.headers.first().expect("a secret");
    let length = body.len();
    write!(stream, "POST {SUBMISSIONS} HTTP/1.0\r\nHost: x\r\n{name}: {value}\r\nContent-Length: {length}\r\n\r\n")
        .expect("a head");
    stream.write_all(&body[..1]).expect("a byte");
    stream
}

async fn work_that_came_in_time_is_in_time(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let students: Vec<Client> =
        ["ada", "bob", "eve"].iter().map(|login| server.member(&admin, "physics", login, "student")).collect();
    let [ada, bob, eve] = students.as_slice() else { panic!("three") };
    let now = async || {
        let mut transaction = fresh.database.read().await.expect("a transaction");
        transaction.one("SELECT {now} AS now", values![]).await.expect("a row").int("now").expect("a number")
    };
    let due_at = now().await + 3000;
    let wish = format!(r#"{{"title": "M", "settings": {{"due_at": {due_at}, "late_percent": 50, "per_hour": 0}}}}"#);
    admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes()).expect(200);
    let body = program("AC", 7);
    let mut begun: Vec<TcpStream> = [ada, bob].map(|student| begin(student, &body)).into();
    // The server has read these heads when it answers a later one.
    eve.get("/api/v1/me").expect(200);
    while now().await <= due_at {
        std::thread::yield_now();
    }
    // The clocks of two processes differ by the time of a query, in favor of the sender.
    let start = Instant::now();
    while eve.send("POST", SUBMISSIONS, &[], &body).status != 409 {
        assert!(start.elapsed() < Duration::from_secs(60), "the assignment is never due");
    }
    for stream in &mut begun {
        stream.write_all(&body[1..]).expect("the rest");
        let submission = Answer::read(stream).expect("an answer").expect(201).json();
        assert!(submission["late"].is_null(), "{submission}");
        assert!(submission["created_at"].as_i64().is_some_and(|at| at <= due_at), "{submission}");
    }
}
