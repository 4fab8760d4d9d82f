//! Tests workers on other machines: processes that know only an address and a token.
use crate::support::{
    engines::{Fresh, on_sqlite, run},
    server::{Client, JSON, Server, program},
};
use fosssim_server::values;
use std::{
    fs,
    process::{Child, Command, Stdio},
};

on_sqlite!(
    a_worker_of_another_machine_grades,
    kills_of_workers_and_server_lose_nothing,
    a_worker_reaches_the_jobs_that_it_holds_and_nothing_else,
    a_worker_whose_token_is_revoked_says_so_and_ends,
    units_of_systemd_need_no_further_step,
);

/// A worker as a process with its own data folder. It is killed at the end.
struct Machine {
    child: Child,
    _folder: tempfile::TempDir,
}

impl Machine {
    fn start(server: &Server, token: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("token");
        fs::write(&file, format!("{token}\n")).expect("a token");
        let log = fs::File::options().create(true).append(true).open(server.folder.with_file_name("worker.log"));
        let child = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
            .args(["worker", "--server", &server.url, "--slots", "2", "--name", "same", "--token-file"])
            .arg(&file)
            .arg("--data")
            .arg(folder.path().join("data"))
            .arg("--grader")
            .arg(server.grader())
            .env_remove("FOSSSIM_DATABASE")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(log.expect("a log"))
            .spawn()
            .expect("a worker");
        Self { child, _folder: folder }
    }

    fn kill(&mut self) {
        self.child.kill().expect("kill");
        self.child.wait().expect("wait");
    }

    /// Stops the worker, which gives its jobs back first.
    fn stop(&mut self) {
        // SAFETY: the process is this test's own child, and not reaped.
        unsafe { libc::kill(self.child.id().cast_signed(), libc::SIGTERM) };
        assert!(self.child.wait().expect("wait").success());
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

fn worker_token(admin: &Client) -> String {
    let token = admin.post_json("/api/v1/worker-tokens", r#"{"name": "lab"}"#).expect(201).json();
    token["token"].as_str().expect("a token").to_owned()
}

/// Returns a tar archive as students create it: one folder that contains all files.
fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut archive = tar::Builder::new(Vec::new());
    for (name, bytes) in files {
        let mut header = tar::Header::new_ustar();
        header.set_size(bytes.len() as u64);
        header.set_mode(0o755);
        archive.append_data(&mut header, name, *bytes).expect("an entry");
    }
    archive.into_inner().expect("an archive")
}

async fn a_worker_of_another_machine_grades(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("WA", 70));
    let mut machine = Machine::start(&server, &worker_token(&admin));
    assert_eq!(ada.wait_for_grade("physics", id)["grade"]["points"], "70");
    let report = ada.get(&format!("/api/v1/courses/physics/submissions/{id}/files/report.txt")).expect(200);
    assert!(report.text().contains("FOSSSim by t2m2"), "{}", report.text());
    // Sources and an uploaded suite arrive as archives, and the worker unpacks them.
    let suite = archive(&[("suite.toml", b"title = 'x'")]);
    admin.send("PUT", "/api/v1/courses/physics/assignments/m1/suite", &[], &suite).expect(200);
    let sources = archive(&[("mine/FOSSSim", b"#!grade AC 90\n"), ("mine/main.cpp", b"int main() {}")]);
    let path = "/api/v1/courses/physics/assignments/m1/submissions?name=mine.tar";
    let id = ada.send("POST", path, &[], &sources).expect(201).json();
    assert_eq!(id["form"], "sources");
    let id = id["id"].as_i64().expect("a number");
    assert_eq!(ada.wait_for_grade("physics", id)["grade"]["points"], "90");
    let report = ada.get(&format!("/api/v1/courses/physics/submissions/{id}/files/report.txt")).expect(200);
    assert!(report.text().contains("FOSSSim by suite.toml"), "{}", report.text());
    // Traces do, too. They are distinguished from sources by their names.
    let traces = archive(&[("Group/one.bin", b"#!grade WA 30\n"), ("Group/two.bin", b"x")]);
    let path = "/api/v1/courses/physics/assignments/m1/submissions?name=traces.tar";
    let id = ada.send("POST", path, &[], &traces).expect(201).json();
    assert_eq!(id["form"], "traces");
    let id = id["id"].as_i64().expect("a number");
    assert_eq!(ada.wait_for_grade("physics", id)["grade"]["points"], "30");
    let refused = ada.send("POST", &format!("{path}&form=traces"), &[], &sources).expect(422);
    assert!(refused.text().contains("an archive of traces may contain only files NAME.bin"), "{}", refused.text());
    let queue = admin.get("/api/v1/queue").expect(200).json();
    assert!(queue["workers"][0]["name"].as_str().expect("a name").starts_with("lab/same."), "{queue}");
    // A worker that must stop gives its jobs back, and no failure is counted.
    let id = ada.submit("physics", b"#!grade HANG 0\n");
    while admin.get("/api/v1/queue").expect(200).json()["running"] != 1 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    machine.stop();
    let submission = ada.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
    assert_eq!(submission["state"], "waiting", "{submission}");
    let metrics = server.visitor().get("/metrics").expect(200).text();
    assert!(metrics.contains("fosssim_events_total{kind=\"failed_try\"} 0"), "{metrics}");
}

async fn kills_of_workers_and_server_lose_nothing(fresh: Fresh) {
    let options = ["--workers", "0", "--lease", "2", "--tries", "50", "--requests-per-minute", "100000"];
    let mut server = Server::start(&fresh, &options);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let token = worker_token(&admin);
    let mut machines: Vec<Machine> = (0..2).map(|_| Machine::start(&server, &token)).collect();
    let path = "/api/v1/courses/physics/assignments/m1/submissions";
    // `FOSSSIM_STORM=SUBMISSIONS,KILLS` sets a larger size, as for the other storms.
    let size = std::env::var("FOSSSIM_STORM").ok().and_then(|words| words.split(',').next()?.parse().ok());
    let size: u32 = size.unwrap_or(24);
    let (start, mut worker_kills, mut server_kills) = (std::time::Instant::now(), 0, 0);
    let mut ids = Vec::new();
    for number in 0..size {
        // A client without an answer repeats the request with the same key until it gets one.
        let key = format!("upload {number}");
        let id = loop {
            let sent = ada.try_send("POST", path, &[("Idempotency-Key", &key)], &program("WA", number));
            match sent {
                Ok(answer) if matches!(answer.status, 200 | 201) => break answer.json()["id"].as_i64(),
                _ => std::thread::sleep(std::time::Duration::from_millis(50)),
            }
        };
        ids.push(id.expect("a number"));
        match number % 6 {
            1 | 4 => {
                worker_kills += 1;
                machines[0].kill();
                machines.remove(0);
                machines.push(Machine::start(&server, &token));
            }
            3 => {
                server_kills += 1;
                server.kill();
                server.resume();
            }
            _ => {}
        }
    }
    for (number, id) in ids.iter().enumerate() {
        let submission = ada.wait_for_grade("physics", *id);
        assert_eq!(submission["grade"]["points"], number.to_string(), "{submission}");
        let history = ada.get(&format!("/api/v1/courses/physics/submissions/{id}/history")).expect(200).json();
        assert_eq!(history.as_array().expect("a list").len(), 1, "graded once: {history}");
    }
    let all = ada.get(path).expect(200).json();
    assert_eq!(all.as_array().expect("a list").len(), size as usize, "each upload is one submission");
    println!(
        "over HTTP: {size} submissions, {worker_kills} kills of workers, {server_kills} of the server; lost 0, graded \
        twice 0, {:.0} s",
        start.elapsed().as_secs_f64()
    );
}

async fn a_worker_reaches_the_jobs_that_it_holds_and_nothing_else(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let (ada, bob) =
        (server.member(&admin, "physics", "ada", "student"), server.member(&admin, "physics", "bob", "student"));
    let mine = ada.submit("physics", &program("WA", 1));
    let others = bob.submit("physics", &program("WA", 2));
    let digest = |client: &Client, id: i64| {
        let submission = client.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
        submission["digest"].as_str().expect("a digest").to_owned()
    };
    let (held, not_held) = (digest(&ada, mine), digest(&bob, others));
    let token = worker_token(&admin);
    let worker = server.with_token(&token);
    let job = worker.post_json("/api/v1/worker/claim", "{}").expect(200).json();
    let lease = &job["lease"];
    let shown = format!("{}:{}:{}", lease["job"], lease["attempt"], lease["key"].as_str().expect("a key"));
    let file = |digest: &str, lease: &str| {
        worker.send("GET", &format!("/api/v1/worker/files/{digest}"), &[("Fosssim-Lease", lease)], b"")
    };
    assert_eq!(file(&held, &shown).expect(200).body, program("WA", 1));
    file(&not_held, &shown).expect(404);
    file(&held, &format!("{}:{}:{}", lease["job"], lease["attempt"], "0".repeat(32))).expect(404);
    file(&held, "").expect(400);
    file("../../fosssim.db", &shown).expect(404);
    file("..%2F..%2Ffosssim.db", &shown).expect(400);
    // A result may name only files that were stored for this job. Otherwise it could reveal other files.
    let finish = |code: &str, points: &str, name: &str, digest: &str| {
        let outcome = format!(
            r#"{{"lease": {lease}, "outcome": {{"verdict": "w", "code": "{code}", "points": "{points}",
                "max_points": "100", "summary": "s", "version": "1",
                "files": [{{"name": "{name}", "media_type": "text/html", "digest": "{digest}", "size": 1}}]}}}}"#
        );
        worker.send("POST", "/api/v1/worker/finish", JSON, outcome.as_bytes())
    };
    // A newer worker may send fields that this server does not know.
    let alive = br#"{"slots": 1, "version": "99.0", "color": "blue"}"#;
    assert!(worker.send("POST", "/api/v1/worker/tick", JSON, alive).expect(200).json()["version"].is_string());
    let workers = admin.get("/api/v1/queue").expect(200).json()["workers"].take();
    assert!(workers.as_array().expect("a list").iter().any(|worker| worker["version"] == "99.0"), "{workers}");
    finish("WA", "1", "report.txt", &not_held).expect(409);
    let report = "6c1e671f9af5b46d9c1a52067bdf0e53685674f7";
    let put = |digest: &str, bytes: &[u8]| {
        worker.send("PUT", &format!("/api/v1/worker/files/{digest}"), &[("Fosssim-Lease", &shown)], bytes)
    };
    put(report, b"a report").expect(400);
    let report = fosssim_server::store::Digest::from_bytes(b"a report").to_string();
    put(&report, b"another report").expect(400);
    put(&report, b"a report").expect(200);
    finish("WA", "1", "../../index.html", &report).expect(400);
    finish("JE", "1", "report.txt", &report).expect(400);
    finish("WA", "NaN", "report.txt", &report).expect(400);
    finish("<b>", "1", "report.txt", &report).expect(400);
    finish("WA", "1", "report.txt", &report).expect(200);
    assert_eq!(finish("AC", "100", "report.txt", &report).expect(200).json()["held"], true, "the same lease again");
    let submission = ada.wait_for_grade("physics", mine);
    assert_eq!([&submission["grade"]["code"], &submission["grade"]["points"]], ["WA", "1"], "the first answer counts");
    // The server, not the worker, chooses a report's media type.
    let told = ada.get(&format!("/api/v1/courses/physics/submissions/{mine}/files/report.txt")).expect(200);
    assert_eq!(told.header("content-type"), Some("text/plain; charset=utf-8"));
    // The lease has ended. After it is revoked, the token is invalid, too.
    file(&held, &shown).expect(404);
    let tokens = admin.get("/api/v1/worker-tokens").expect(200).json();
    let id = &tokens[0]["id"];
    // A page that is loaded again makes no second token.
    admin.post_form("/admin/workers", "name=lab").expect(409);
    admin.send("DELETE", &format!("/api/v1/worker-tokens/{id}"), &[], b"").expect(204);
    let log = admin.get("/admin/log").expect(200).text();
    assert!(log.contains("created lab") && log.contains("revoked lab"), "{log}");
    worker.post_json("/api/v1/worker/claim", "{}").expect(401);
}

async fn a_worker_whose_token_is_revoked_says_so_and_ends(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--lease", "4"]);
    let admin = server.admin();
    let token = admin.post_json("/api/v1/worker-tokens", r#"{"name": "lab"}"#).expect(201).json();
    let (id, token) = (&token["id"], token["token"].as_str().expect("a token"));
    let mut machine = Machine::start(&server, token);
    let working = || admin.get("/api/v1/queue").expect(200).json()["workers"].as_array().is_some_and(|w| !w.is_empty());
    while !working() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    admin.send("DELETE", &format!("/api/v1/worker-tokens/{id}"), &[], b"").expect(204);
    assert_eq!(machine.child.wait().expect("an end").code(), Some(2));
    // The same happens when the worker starts.
    assert_eq!(Machine::start(&server, token).child.wait().expect("an end").code(), Some(2));
    let log = fs::read_to_string(server.folder.with_file_name("worker.log")).expect("a log");
    let said = log
        .lines()
        .filter(|line| line.starts_with("error: ") && line.contains("the worker's token is unknown or revoked"));
    assert_eq!(said.count(), 2, "{log}");
}

/// A report that is stored while the job is removed would prevent the removal of the job's row.
#[test]
fn a_report_waits_for_whoever_takes_the_job_away() {
    run(async {
        let Some(fresh) = Fresh::postgres().await else { return };
        let mut server = Server::start(&fresh, &["--workers", "0"]);
        let admin = server.admin();
        server.course(&admin, "physics");
        server.member(&admin, "physics", "ada", "student").submit("physics", &program("WA", 1));
        let worker = server.with_token(&worker_token(&admin));
        let lease = worker.post_json("/api/v1/worker/claim", "{}").expect(200).json()["lease"].take();
        let shown = format!("{}:{}:{}", lease["job"], lease["attempt"], lease["key"].as_str().expect("a key"));
        let path = format!("/api/v1/worker/files/{}", fosssim_server::store::Digest::from_bytes(b"a report"));
        let mut taking = fresh.database.begin().await.expect("a transaction");
        let statement = "UPDATE job SET state = 'cancelled', lease_key = NULL, lease_until = NULL";
        taking.execute(statement, values![]).await.expect("a statement");
        let storing = std::thread::spawn(move || worker.send("PUT", &path, &[("Fosssim-Lease", &shown)], b"a report"));
        let is_waiting = async || {
            let mut transaction = fresh.database.read().await.expect("a transaction");
            let statement = "SELECT count(*) AS n FROM pg_stat_activity
                WHERE datname = current_database() AND wait_event_type = 'Lock'";
            transaction.one(statement, values![]).await.expect("a row").int("n").expect("a number") > 0
        };
        while !storing.is_finished() && !is_waiting().await {
            std::thread::yield_now();
        }
        taking.commit().await.expect("commit");
        storing.join().expect("an answer").expect(404);
        admin.send("DELETE", "/api/v1/courses/physics/assignments/m1", &[], b"").expect(204);
    });
}

/// Runs the command of the server's unit that creates a token for the worker on the same machine, with other paths.
async fn units_of_systemd_need_no_further_step(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let unit = include_str!("../../../../../examples/deploy/systemd/fosssim-server.service");
    let line = unit.lines().find_map(|line| line.strip_prefix("ExecStartPost=-+/bin/sh -c ")).expect("a command");
    let file = server.folder.with_file_name("worker.token");
    let script = line
        .trim_matches('\'')
        .replace("/opt/fosssim/fosssim-server", env!("CARGO_BIN_EXE_fosssim-server"))
        .replace("/var/lib/fosssim", server.folder.to_str().expect("UTF-8"))
        .replace("/etc/fosssim-worker.token", file.to_str().expect("UTF-8"));
    let make = || {
        let mut command = Command::new("/bin/sh");
        command.args(["-c", &script]).env("FOSSSIM_DATABASE", server.database());
        assert!(command.status().expect("a shell").success());
        fs::read_to_string(&file).expect("a token")
    };
    let token = make();
    assert_eq!(make(), token, "a second start keeps the token");
    let admin = server.admin();
    let mut command = Command::new(env!("CARGO_BIN_EXE_fosssim-server"));
    command.args(["admin-link", "--data"]).arg(&server.folder).env("FOSSSIM_DATABASE", server.database());
    let link = String::from_utf8(command.output().expect("a link").stdout).expect("text");
    assert!(link.starts_with(&format!("{}/welcome/", server.url)), "{link}");
    server.course(&admin, "physics");
    let (ada, prof) =
        (server.member(&admin, "physics", "ada", "student"), server.member(&admin, "physics", "prof", "staff"));
    let id = ada.submit("physics", &program("WA", 70));
    // Until the worker runs, waiting people read the reason.
    let page = format!("/c/physics/s/{id}");
    let says = |client: &Client, page: &str| client.get(page).expect(200).text().contains("No worker is connected");
    assert!(says(&ada, &page) && says(&prof, "/") && !says(&ada, "/"));
    let _machine = Machine::start(&server, token.trim());
    assert_eq!(ada.wait_for_grade("physics", id)["grade"]["points"], "70");
    assert!(!says(&ada, &page) && !says(&prof, "/"));
}
