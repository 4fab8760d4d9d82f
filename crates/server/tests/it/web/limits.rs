//! Tests the limits for an account, for an address, and for the whole server.
use crate::support::{
    disk::stored,
    engines::{Fresh, on_both_engines},
    server::{Answer, Client, JSON, Server, program},
};
use fosssim_server::values;
use std::{
    io::{Read, Write},
    net::TcpStream,
    time::{Duration, Instant},
};

on_both_engines!(
    files_are_sent_in_pieces,
    quotas_count_what_is_kept,
    equal_uploads_are_kept_once,
    refused_at_the_same_time_leaves_nothing
);

const SUBMISSIONS: &str = "/api/v1/courses/physics/assignments/m1/submissions";

/// Returns a program of the given size in MiB, which differs for each number.
fn large(mebibytes: usize, number: u8) -> Vec<u8> {
    let mut bytes = program("AC", u32::from(number));
    bytes.resize(mebibytes << 20, number);
    bytes
}

/// Sends a request without reading the answer.
fn ask(client: &Client, path: &str) -> TcpStream {
    let host = client.url.strip_prefix("http://").expect("an address");
    let mut stream = TcpStream::connect(host).expect("a connection");
    let (name, value) = client.headers.first().expect("a secret");
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n{name}: {value}\r\n\r\n").expect("sent");
    stream
}

async fn files_are_sent_in_pieces(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--transfers", "12"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let bytes = large(64, 1);
    let id = ada.submit("physics", &bytes);
    let path = format!("/api/v1/courses/physics/submissions/{id}/upload");
    let whole = ada.get(&path).expect(200);
    assert!(whole.body == bytes);
    assert_eq!(whole.header("content-length"), Some("67108864"));
    let tag = whole.header("etag").expect("a tag").to_owned();
    // A client that already has the file.
    ada.send("GET", &path, &[("If-None-Match", &tag)], b"").expect(304);
    // Readers that receive nothing: each uses little memory, their number per account is limited, and other requests
    // are not disturbed.
    let before = server.peak_memory();
    let mut readers: Vec<TcpStream> = (0..12).map(|_| ask(&ada, &path)).collect();
    for reader in &mut readers {
        reader.read_exact(&mut [0; 15]).expect("the status");
    }
    let refused = ada.get(&path).expect(429).json();
    assert!(refused["detail"].as_str().is_some_and(|detail| detail.contains("12 simultaneous transfers")), "{refused}");
    ada.get(&format!("/c/physics/s/{id}")).expect(200);
    assert!(admin.get(&path).expect(200).body == bytes, "another account has its own");
    let held = server.peak_memory() - before;
    assert!(held < 32 << 20, "{held} bytes for readers of {} each", bytes.len());
    // After its readers have ended, the account can download again.
    drop(readers);
    let start = Instant::now();
    while ada.send("GET", &path, &[("If-None-Match", &tag)], b"").status != 304 {
        assert!(start.elapsed() < Duration::from_secs(100), "readers that are gone are never given up");
        std::thread::sleep(Duration::from_millis(50));
    }
    // The download of a changed file is broken off, so that it does not look complete.
    let digest = ada.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json()["digest"].clone();
    let digest = digest.as_str().expect("a digest").to_owned();
    let file = server.folder.join("store/sha256").join(&digest[..2]).join(&digest[2..]);
    let mut damaged = bytes.clone();
    damaged[1 << 20] ^= 1;
    std::fs::write(file, damaged).expect("written");
    assert!(ada.get(&path).body.len() < bytes.len());
}

/// Returns the counted bytes, after checking that they equal the stored bytes.
async fn kept_bytes(fresh: &Fresh) -> i64 {
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let counted = "SELECT CAST(coalesce(sum(bytes), 0) AS {int}) AS n FROM kept_bytes";
    let there = "SELECT CAST((SELECT coalesce(sum(size), 0) FROM
            (SELECT DISTINCT account, digest, size FROM submission WHERE removed_at IS NULL) AS kept)
        + (SELECT coalesce(sum(result_file.size), 0) FROM result_file
            JOIN result ON result.id = result_file.result
            JOIN submission ON submission.id = result.submission WHERE removed_at IS NULL) AS {int}) AS n";
    let counted = transaction.one(counted, values![]).await.expect("a row").int("n").expect("a number");
    let there = transaction.one(there, values![]).await.expect("a row").int("n").expect("a number");
    assert_eq!(counted, there, "what is counted is what is there");
    counted
}

async fn quotas_count_what_is_kept(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1", "--keep-of-person", "5", "--keep-of-course", "8"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let eve = server.member(&admin, "physics", "eve", "student");
    let first = ada.submit("physics", &large(2, 1));
    ada.wait_for_grade("physics", first);
    assert!(kept_bytes(&fresh).await > 2 << 20, "reports count, too");
    let second = ada.submit("physics", &large(2, 2));
    ada.wait_for_grade("physics", second);
    let before = stored(&server);
    // The page always shows the used space to staff, and to others when four fifths are used.
    let words = |by: &Client| by.get("/c/physics").expect(200).text();
    assert!(words(&ada).contains("reports of you: 4 MiB of 5 MiB. When the space is used up"), "{}", words(&ada));
    assert!(!words(&eve).contains("Stored uploads"), "{}", words(&eve));
    assert!(words(&admin).contains("reports of this course: 4 MiB of 8 MiB."), "{}", words(&admin));
    let metrics = server.visitor().get("/metrics").expect(200).text();
    assert!(metrics.contains("fosssim_kept_bytes{of=\"largest course\"} 4"), "{metrics}");
    let answer = ada.send("POST", SUBMISSIONS, &[], &large(2, 3)).expect(507).json();
    assert_eq!(answer["type"], "urn:fosssim:quota", "{answer}");
    assert!(answer["detail"].as_str().is_some_and(|detail| detail.contains("4 MiB of 5 MiB")), "{answer}");
    // The upload is sent in a form, so its size is unknown until it has arrived.
    let form = [
        b"--x\r\nContent-Disposition: form-data; name=\"file\"; filename=\"F\"\r\n\r\n",
        &large(2, 3)[..],
        b"\r\n--x--\r\n",
    ]
    .concat();
    ada.send("POST", SUBMISSIONS, &[("Content-Type", "multipart/form-data; boundary=x")], &form).expect(507);
    assert_eq!(stored(&server), before);
    let of_eve = eve.submit("physics", &large(2, 4));
    eve.wait_for_grade("physics", of_eve);
    let answer = eve.send("POST", SUBMISSIONS, &[], &large(2, 5)).expect(507).json();
    assert!(answer["detail"].as_str().is_some_and(|detail| detail.contains("of this course")), "{answer}");
    // An expired upload frees space.
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    let given_up = "UPDATE submission SET removed_at = {now} WHERE id IN (?, ?)";
    transaction.execute(given_up, values![first, of_eve]).await.expect("a statement");
    transaction.commit().await.expect("commit");
    assert!(kept_bytes(&fresh).await < 3 << 20);
    let third = ada.submit("physics", &large(2, 3));
    ada.wait_for_grade("physics", third);
    // A removed upload, too.
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    for deleted in [
        "DELETE FROM grade_change WHERE submission = ?",
        "DELETE FROM grade WHERE submission = ?",
        "DELETE FROM result_file WHERE result IN (SELECT id FROM result WHERE submission = ?)",
        "DELETE FROM job_file WHERE job IN (SELECT id FROM job WHERE submission = ?)",
        "DELETE FROM result WHERE submission = ?",
        "DELETE FROM job WHERE submission = ?",
        "DELETE FROM submission WHERE id = ?",
    ] {
        transaction.execute(deleted, values![second]).await.expect("a statement");
    }
    transaction.commit().await.expect("commit");
    assert!(kept_bytes(&fresh).await < 3 << 20);
    eve.submit("physics", &large(2, 5));
    kept_bytes(&fresh).await;
}

async fn equal_uploads_are_kept_once(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let eve = server.member(&admin, "physics", "eve", "student");
    let first = eve.submit("physics", &large(2, 5));
    let before = kept_bytes(&fresh).await;
    let again = eve.submit("physics", &large(2, 5));
    assert!(again != first && kept_bytes(&fresh).await == before);
    for one in [first, again] {
        let mut transaction = fresh.database.begin().await.expect("a transaction");
        let given_up = "UPDATE submission SET removed_at = {now} WHERE id = ?";
        transaction.execute(given_up, values![one]).await.expect("a statement");
        transaction.commit().await.expect("commit");
        let left = if one == again { 0 } else { before };
        assert_eq!(kept_bytes(&fresh).await, left, "it is kept as long as one of them is");
    }
}

async fn refused_at_the_same_time_leaves_nothing(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let wish = r#"{"title": "M1", "visible": true, "settings": {"attempts": 1}}"#;
    admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes()).expect(200);
    let ada = server.member(&admin, "physics", "ada", "student");
    let answers: Vec<Answer> = std::thread::scope(|scope| {
        let sending: Vec<_> = (0..8)
            .map(|number| {
                let ada = &ada;
                scope.spawn(move || ada.send("POST", SUBMISSIONS, &[], &large(1, number)))
            })
            .collect();
        sending.into_iter().map(|sending| sending.join().expect("an answer")).collect()
    });
    let accepted = answers.iter().filter(|answer| answer.status == 201).count();
    assert_eq!((accepted, answers.iter().filter(|answer| answer.status == 409).count()), (1, 7));
    assert_eq!(stored(&server), 1);
}

/// Thousands of visitors may send forms that need no sign-in, as slowly as the server allows.
#[test]
fn who_is_not_signed_in_sends_little() {
    crate::support::engines::run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite").with_tables().await;
        let server = Server::start(&fresh, &["--workers", "0"]);
        let long = format!("token={}", "x".repeat(100_000));
        server.visitor().post_form("/sign-in", &long).expect(413);
    });
}
