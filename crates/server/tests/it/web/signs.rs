//! Tests heartbeats for systemd and for probes.
use crate::support::{
    engines::{Fresh, run},
    server::Server,
};
use std::{
    io::ErrorKind,
    os::unix::net::UnixDatagram,
    process::{Command, Stdio},
    time::Duration,
};

/// Returns the next message to systemd. Signals to this process, for example from children of other tests, may
/// interrupt the wait.
fn told(socket: &UnixDatagram) -> String {
    let mut text = [0; 4096];
    let length = loop {
        match socket.recv(&mut text) {
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            received => break received.expect("a word"),
        }
    };
    String::from_utf8_lossy(&text[..length]).trim().to_owned()
}

#[test]
fn systemd_hears_that_the_server_listens_lives_and_ends() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("notify");
    let socket = UnixDatagram::bind(&path).expect("a socket");
    socket.set_read_timeout(Some(Duration::from_secs(60))).expect("a timeout");
    let mut server = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
        .args(["serve", "--workers", "0", "--listen", "127.0.0.1:0", "--data"])
        .arg(folder.path().join("data"))
        .env_remove("FOSSSIM_DATABASE")
        .env("NOTIFY_SOCKET", &path)
        .env("WATCHDOG_USEC", "300000")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a server");
    assert_eq!(told(&socket), "READY=1");
    for _ in 0..3 {
        assert_eq!(told(&socket), "WATCHDOG=1");
    }
    // SAFETY: the process is this test's own child, and not reaped.
    unsafe { libc::kill(server.id().cast_signed(), libc::SIGTERM) };
    let end = std::iter::repeat_with(|| told(&socket)).find(|word| word != "WATCHDOG=1");
    assert_eq!(end.as_deref(), Some("STOPPING=1"));
    assert!(server.wait().expect("an end").success());
}

#[test]
fn probes_tell_who_is_well() {
    let health = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fosssim-server"));
        command.arg("health").args(words).stdout(Stdio::null()).status().expect("an answer").code()
    };
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let mut server = Server::start(&fresh, &["--workers", "0"]);
        let admin = server.admin();
        assert_eq!(health(&["--server", &server.url]), Some(0));
        let answer = admin.post_json("/api/v1/worker-tokens", r#"{"name": "node"}"#).expect(201).json();
        let folder = tempfile::tempdir().expect("a folder");
        let (file, data) = (folder.path().join("token"), folder.path().join("data"));
        std::fs::write(&file, answer["token"].as_str().expect("a token")).expect("written");
        let data = data.to_str().expect("UTF-8");
        assert_eq!(health(&["--data", data]), Some(1), "nobody has worked there");
        let mut worker = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
            .args(["worker", "--server", &server.url, "--data", data, "--grader"])
            .arg(server.grader())
            .arg("--token-file")
            .arg(&file)
            .stderr(Stdio::null())
            .spawn()
            .expect("a worker");
        let start = std::time::Instant::now();
        while health(&["--data", data]) != Some(0) {
            assert!(start.elapsed() < Duration::from_secs(60), "no sign of life");
            std::thread::sleep(Duration::from_millis(50));
        }
        worker.kill().expect("an end");
        worker.wait().expect("an end");
        // The last heartbeat becomes old.
        let long_ago = std::time::SystemTime::now() - Duration::from_secs(600);
        let sign = std::fs::File::options().write(true).open(format!("{data}/alive")).expect("its sign");
        sign.set_modified(long_ago).expect("a time");
        assert_eq!(health(&["--data", data]), Some(1));
        server.kill();
        assert_eq!(health(&["--server", &server.url]), Some(1));
    });
}
