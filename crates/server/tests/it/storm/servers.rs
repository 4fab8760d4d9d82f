//! Tests two servers with their workers on one database and one store, and workers over HTTP. One of these reports that
//! it is healthy although it is not, and one has no space. Servers and workers are killed and frozen while students
//! submit, and the grader fails on some submissions. The store's disk is full for a while, and the pooler is killed if
//! there is one. Meanwhile staff regrade, publish and remove, and archive bombs arrive.
use crate::support::{
    disk::SmallDisk,
    engines::{Fresh, on_all_engines},
    server::{Client, Server, program},
};
use fosssim_server::db::Dialect;
use std::{
    fs,
    io::Write,
    os::unix::fs::PermissionsExt,
    path::Path,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use super::{deeds::Noise, weather::Size};

on_all_engines!(two_servers_lose_nothing);

const PATH: &str = "/api/v1/courses/physics/assignments/m1/submissions";

/// A worker over HTTP. It is killed when this value is dropped.
struct Worker(Child);

impl Worker {
    fn start(server: &Server, token: &str, folder: &Path, grader: &Path) -> Self {
        let file = server.folder.with_file_name("worker-token");
        fs::write(&file, token).expect("a token");
        let log = fs::File::options().create(true).append(true).open(server.folder.with_file_name("worker.log"));
        let child = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
            .args(["worker", "--server", &server.url, "--slots", "2", "--token-file"])
            .arg(&file)
            .arg("--data")
            .arg(folder)
            .arg("--grader")
            .arg(grader)
            .env_remove("FOSSSIM_DATABASE")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(log.expect("a log"))
            .spawn()
            .expect("a worker");
        Self(child)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn script(path: &Path, text: &str) {
    fs::write(path, text).expect("a script");
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("permissions");
}

/// The size of the store's disk.
const DISK: u64 = 128 << 20;

/// Fills a disk for a moment.
fn fill(disk: &Path) -> std::thread::JoinHandle<()> {
    let filler = disk.join("filler");
    std::thread::spawn(move || {
        let mut file = fs::File::create(&filler).expect("a file");
        while file.write_all(&[1; 4096]).is_ok() {}
        std::thread::sleep(Duration::from_millis(1500));
        fs::remove_file(&filler).expect("room");
    })
}

/// A random generator (xorshift). Any order of events is sufficient.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, below: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 33).expect("31 bits") % below
    }
}

/// The results of all uploads.
struct Grades {
    wrong: Vec<String>,
    buried: usize,
    doubled: Vec<String>,
    all: usize,
}

/// Waits for the grades of all uploads. `expected` has each upload's number, and whether the grader fails on it.
fn grades(server: &Server, students: &[Client], expected: &[(i64, bool)]) -> Grades {
    let mut found = Grades { wrong: Vec::new(), buried: 0, doubled: Vec::new(), all: 0 };
    let at = |student: &Client| Client { url: server.url.clone(), headers: student.headers.clone() };
    for (number, (id, poison)) in expected.iter().enumerate() {
        let client = at(&students[number % students.len()]);
        let submission = client.wait_for_grade("physics", *id);
        let right = if *poison { "JE".to_owned() } else { number.to_string() };
        let got = if *poison { &submission["grade"]["code"] } else { &submission["grade"]["points"] };
        found.buried += usize::from(submission["state"] == "buried" && !poison);
        if *got != *right {
            found.wrong.push(format!("{number}: {submission}"));
        }
        let history = client.get(&format!("/api/v1/courses/physics/submissions/{id}/history")).expect(200).json();
        if history.as_array().map(Vec::len) != Some(1) {
            found.doubled.push(format!("{number}: {history}"));
        }
    }
    for student in students {
        found.all += at(student).get(PATH).expect(200).json().as_array().expect("a list").len();
    }
    found
}

/// Uploads a program that earns its number, or one on which the grader fails. A client that gets no answer repeats the
/// request at one of the servers until it gets one.
fn upload(servers: &[Server; 2], dice: &mut Dice, student: &Client, number: usize) -> (i64, bool) {
    let poison = number % 24 == 5;
    let text = if poison { program("POISON", 0) } else { program("WA", u32::try_from(number).expect("few")) };
    let key = format!("upload {number}");
    let id = loop {
        let client = Client { url: servers[dice.roll(2)].url.clone(), headers: student.headers.clone() };
        match client.try_send("POST", PATH, &[("Idempotency-Key", &key)], &text) {
            Ok(answer) if matches!(answer.status, 200 | 201) => break answer.json()["id"].as_i64(),
            _ => std::thread::sleep(Duration::from_millis(50)),
        }
    };
    (id.expect("a number"), poison)
}

fn engine(fresh: &Fresh) -> &'static str {
    match (fresh.database.dialect(), &fresh.pooler) {
        (Dialect::Sqlite, _) => "SQLite",
        (Dialect::Postgres, None) => "PostgreSQL",
        (Dialect::Postgres, Some(_)) => "PostgreSQL behind PgBouncer",
    }
}

/// Returns the size of the storm. It is small by default, because a server starts more slowly than a worker.
fn size() -> Size {
    let is_asked = std::env::var_os("FOSSSIM_STORM").is_some();
    if is_asked { Size::from_environment() } else { Size { submissions: 24, kills: 6 } }
}

async fn two_servers_lose_nothing(mut fresh: Fresh) {
    let size = size();
    let folder = tempfile::tempdir().expect("a folder");
    let options = ["--workers", "2", "--lease", "2", "--requests-per-minute", "1000000"];
    let data = folder.path().join("data");
    let store = SmallDisk::mount_at(&data.join("store"), DISK);
    let mut first = Server::start_in(&fresh, &options, data.clone());
    let admin = first.admin();
    first.course(&admin, "physics");
    let students: Vec<Client> =
        (0..4).map(|number| first.member(&admin, "physics", &format!("s{number}"), "student")).collect();
    let mut servers = [first, Server::start_in(&fresh, &options, data.clone())];
    let token = admin.post_json("/api/v1/worker-tokens", r#"{"name": "lab"}"#).expect(201).json();
    let token = token["token"].as_str().expect("a token");
    let liar = folder.path().join("liar");
    script(&liar, "#!/bin/sh\n[ \"$1\" = grade ] || exit 2\nexit 3\n");
    let good = servers[1].grader();
    let disk = SmallDisk::mount(4 << 20);
    let mut machines = vec![
        Worker::start(&servers[0], token, &folder.path().join("machine-1"), &liar),
        Worker::start(&servers[1], token, &folder.path().join("machine-2"), &good),
    ];
    machines.extend(disk.as_ref().map(|disk| Worker::start(&servers[1], token, &disk.path().join("data"), &good)));
    let mut noise = Noise::begin(&servers[0], &admin);
    let seed = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).expect("a clock").as_nanos();
    let mut dice = Dice(u64::try_from(seed).expect("a date") | 1);
    let (start, mut kills, mut freezes, mut full, mut poolers) = (Instant::now(), 0, 0, Vec::new(), 0);
    let mut expected = Vec::new();
    while expected.len() < size.submissions || kills < size.kills {
        let due = (kills + 1) * size.submissions / size.kills.max(1);
        while expected.len() < due.min(size.submissions) {
            let number = expected.len();
            expected.push(upload(&servers, &mut dice, &students[number % students.len()], number));
        }
        std::thread::sleep(Duration::from_millis(u64::try_from(50 + dice.roll(300)).expect("short")));
        if let Some(store) = store.as_ref().filter(|_| kills > 20 * full.len()) {
            full.push(fill(store.path()));
        }
        if let Some(pooler) = fresh.pooler.as_mut().filter(|_| kills >= 3 + 20 * poolers) {
            pooler.kill_for(Duration::from_millis(u64::try_from(dice.roll(1500)).expect("short")));
            poolers += 1;
        }
        noise.act(&servers[dice.roll(2)]);
        let victim = dice.roll(2);
        if dice.roll(8) == 0 && freezes * 8 <= kills {
            freezes += 1;
            servers[victim].signal(libc::SIGSTOP);
            std::thread::sleep(Duration::from_secs(4));
            servers[victim].signal(libc::SIGCONT);
            continue;
        }
        kills += 1;
        if dice.roll(7) == 0 {
            let machine = folder.path().join(format!("machine-{kills}"));
            machines[1] = Worker::start(&servers[victim], token, &machine, &good);
        } else {
            servers[victim].kill();
            servers[victim].resume();
        }
    }
    let full = full.into_iter().map(|filling| filling.join().expect("room again")).count();
    let Grades { wrong, buried, doubled, all } = grades(&servers[0], &students, &expected);
    println!(
        "| {} | {} | {kills} | {freezes} | {full} | {poolers} | {} | {} | {} | {} | {buried} | {:.0} s |",
        engine(&fresh),
        expected.len(),
        noise.deeds(),
        expected.len() - all.min(expected.len()),
        doubled.len() + all.saturating_sub(expected.len()),
        wrong.len(),
        start.elapsed().as_secs_f64()
    );
    assert_eq!(wrong, Vec::<String>::new(), "another grade than in calm weather");
    assert_eq!(doubled, Vec::<String>::new(), "more than one grade");
    assert_eq!((buried, all), (0, expected.len()), "buried, uploads");
}
