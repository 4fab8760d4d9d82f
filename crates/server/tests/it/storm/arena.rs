//! The environment of a storm: a database, a data folder, workers, and the list of submissions.
use super::grader;
use crate::support::cluster::Cluster;
use fosssim_server::{
    db::{self, Address, Database, DbError},
    queue::{self, JobKind, JobOwner, NewJob},
    store::{Digest, Store},
    task::{Form, Input, Suite, Task},
    values,
};
use std::{
    collections::BTreeMap,
    fs,
    path::PathBuf,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

/// The number of seconds without a report after which a worker counts as lost.
pub(super) const LEASE: u64 = 2;

/// The number of failures after which a job is given up. It is larger than the default, because workers die often here.
pub(super) const TRIES: u32 = 8;

/// The result of a submission without disturbances.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Expected {
    pub(super) code: String,
    pub(super) points: Option<String>,
}

impl Expected {
    pub(super) fn is_judge_error(&self) -> bool {
        self.code == "JE"
    }
}

pub(super) struct Arena {
    pub(super) database: Database,
    pub(super) cluster: Option<Cluster>,
    pub(super) workers: Vec<Child>,
    folder: tempfile::TempDir,
    address: Address,
    grader: PathBuf,
    assignment: i64,
    /// The accepted submissions, by name.
    accepted: BTreeMap<String, Expected>,
}

/// The state after the storm.
pub(super) struct Found {
    pub(super) accepted: usize,
    pub(super) lost: Vec<String>,
    pub(super) graded_twice: Vec<String>,
    pub(super) wrong: Vec<String>,
    pub(super) buried: usize,
    pub(super) late: i64,
    pub(super) left_behind: Vec<String>,
    /// The number of submissions for each number of claims.
    pub(super) tries: BTreeMap<i64, usize>,
}

impl Arena {
    pub(super) async fn sqlite() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let address = Address::Sqlite(folder.path().join("fosssim.db"));
        Self::new(folder, address, None).await
    }

    pub(super) async fn postgres() -> Option<Self> {
        let cluster = Cluster::start()?;
        let address = cluster.new_database();
        Some(Self::new(tempfile::tempdir().expect("a folder"), address, Some(cluster)).await)
    }

    async fn new(folder: tempfile::TempDir, address: Address, cluster: Option<Cluster>) -> Self {
        let database = Database::open(&address).await.expect("a database");
        db::migrate(&database).await.expect("tables");
        let mut transaction = database.begin().await.expect("a transaction");
        let statements = [
            "INSERT INTO account (login, name, created_at) VALUES ('s', 'S', {now}) RETURNING id",
            "INSERT INTO course (slug, title, created_at) VALUES ('c', 'C', {now}) RETURNING id",
        ];
        for statement in statements {
            transaction.one(statement, values![]).await.expect("a row");
        }
        let assignment = transaction
            .one(
                "INSERT INTO assignment (course, slug, title, settings, created_at)
                 SELECT max(id), 'a', 'A', '{}', {now} FROM course RETURNING id",
                values![],
            )
            .await
            .expect("a row")
            .int("id")
            .expect("a number");
        transaction.commit().await.expect("commit");
        let grader = grader::write(folder.path());
        std::thread::spawn(wake_the_frozen);
        Self { database, cluster, workers: Vec::new(), folder, address, grader, assignment, accepted: BTreeMap::new() }
    }

    /// Starts a worker. All workers have the same name.
    pub(super) fn start_worker(&mut self) {
        let log = fs::File::options().create(true).append(true).open(self.folder.path().join("log")).expect("a log");
        let worker = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
            .args(["worker", "--name", "same", "--slots", "2"])
            .arg("--lease")
            .arg(LEASE.to_string())
            .arg("--tries")
            .arg(TRIES.to_string())
            .arg("--grader")
            .arg(&self.grader)
            .arg("--data")
            .arg(self.folder.path())
            .env("FOSSSIM_DATABASE", self.secret_address())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(log)
            .spawn()
            .expect("a worker");
        self.workers.push(worker);
    }

    fn secret_address(&self) -> String {
        match &self.address {
            Address::Sqlite(file) => format!("sqlite:{}", file.display()),
            Address::Postgres(url) => url.clone(),
        }
    }

    /// Submits a file. It is stored first, and then the submission and its job are written in one transaction. This is
    /// repeated until the commit is confirmed.
    pub(super) async fn hand_in(&mut self, name: &str, line: &str, expected: Expected) {
        let store = Store::folder(&self.folder.path().join("store")).expect("a store");
        let artifact = crate::support::put(&store, format!("{line}\n").as_bytes()).await;
        let task = Task {
            submission: Input { form: Form::Program, name: name.to_owned(), artifact },
            suite: Suite::Named("storm".to_owned()),
            rules: None,
            hints: None,
            smallest: false,
            program: "FOSSSim".to_owned(),
            seconds: 600,
        };
        // It is unknown whether a failed commit was written. If so, the same number is rejected.
        let number = i64::try_from(self.accepted.len()).expect("few");
        let start = Instant::now();
        while let Err(error) = self.try_to_hand_in(number, &task).await {
            if matches!(error, DbError::Conflict(_)) {
                break;
            }
            assert!(error.is_transient() && start.elapsed() < Duration::from_secs(120), "{error}");
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
        self.accepted.insert(name.to_owned(), expected);
    }

    async fn try_to_hand_in(&self, number: i64, task: &Task) -> Result<(), DbError> {
        let mut transaction = self.database.begin().await?;
        let submission = transaction
            .one(
                "INSERT INTO submission (assignment, account, number, form, file_name, digest, size, created_at)
                 SELECT ?, max(id), ?, 'program', ?, ?, 0, {now} FROM account RETURNING id",
                values![self.assignment, number, &task.submission.name, task.submission.artifact.digest.as_str()],
            )
            .await?
            .int("id")?;
        let payload = serde_json::to_string(task).expect("JSON");
        let job = NewJob {
            kind: JobKind::Grading,
            submission: Some(submission),
            regrade_id: None,
            owner: JobOwner::Student(number),
            payload: &payload,
        };
        queue::enqueue(&mut transaction, &job).await?;
        transaction.commit().await
    }

    /// Returns the number of accepted submissions that satisfy a condition.
    pub(super) fn count(&self, which: impl Fn(&Expected) -> bool) -> usize {
        self.accepted.values().filter(|expected| which(expected)).count()
    }

    /// Waits for the last job. Workers are no longer killed from outside, but poison still kills them.
    pub(super) async fn wait_until_all_is_done(&mut self) {
        let start = Instant::now();
        loop {
            self.replace_the_dead(3);
            if self.open_jobs().await.is_ok_and(|open| open == 0) {
                return;
            }
            let log = || fs::read_to_string(self.folder.path().join("log")).unwrap_or_default();
            assert!(start.elapsed() < Duration::from_secs(600), "jobs do not end; the log:\n{}", log());
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
    }

    async fn open_jobs(&self) -> Result<i64, DbError> {
        let mut transaction = self.database.read().await?;
        transaction
            .one("SELECT count(*) AS n FROM job WHERE state IN ('waiting', 'running')", values![])
            .await?
            .int("n")
    }

    /// Starts workers until `count` are running.
    pub(super) fn replace_the_dead(&mut self, count: usize) {
        self.workers.retain_mut(|worker| worker.try_wait().expect("a status").is_none());
        while self.workers.len() < count {
            self.start_worker();
        }
    }

    /// Stops all workers regularly.
    pub(super) fn calm_down(&mut self) {
        self.stop_workers();
    }

    fn stop_workers(&mut self) {
        for worker in &self.workers {
            signal(worker, libc::SIGCONT);
            signal(worker, libc::SIGTERM);
        }
        for mut worker in self.workers.drain(..) {
            worker.wait().expect("an end");
        }
    }

    pub(super) async fn inspect(&self) -> Found {
        let mut transaction = self.database.read().await.expect("a transaction");
        let rows = transaction
            .rows(
                "SELECT submission.file_name, job.state, job.attempt, job.failures, result.code, result.points,
                    (SELECT count(*) FROM job AS j WHERE j.submission = submission.id) AS jobs,
                    (SELECT count(*) FROM result AS r WHERE r.submission = submission.id) AS results,
                    (SELECT count(*) FROM grade_change AS c WHERE c.submission = submission.id) AS changes,
                    (SELECT digest FROM result_file WHERE result = result.id AND name = 'report.txt') AS report
                 FROM submission
                 LEFT JOIN job ON job.submission = submission.id
                 LEFT JOIN grade ON grade.submission = submission.id
                 LEFT JOIN result ON result.id = grade.result",
                values![],
            )
            .await
            .expect("rows");
        let mut found = Found {
            accepted: rows.len(),
            lost: Vec::new(),
            graded_twice: Vec::new(),
            wrong: Vec::new(),
            buried: 0,
            late: transaction
                .one("SELECT count(*) AS n FROM event WHERE kind = 'late answer'", values![])
                .await
                .expect("a row")
                .int("n")
                .expect("a number"),
            left_behind: self.running_graders(),
            tries: BTreeMap::new(),
        };
        let store = Store::folder(&self.folder.path().join("store")).expect("a store");
        let mut graded = BTreeMap::new();
        for row in &rows {
            let name = row.text("file_name").expect("a name");
            let number = |column| row.int(column).expect("a number");
            if [number("jobs"), number("results"), number("changes")] != [1, 1, 1] {
                found.graded_twice.push(format!(
                    "{name}: {} jobs, {} results, {} changes of its grade",
                    number("jobs"),
                    number("results"),
                    number("changes")
                ));
            }
            let Some(code) = row.maybe_text("code").expect("text") else { continue };
            if row.text("state").expect("a state") == "buried" {
                found.buried += 1;
                assert_eq!(number("failures"), i64::from(TRIES), "{name}");
            } else {
                *found.tries.entry(number("attempt")).or_default() += 1;
            }
            if let Some(digest) = row.maybe_text("report").expect("text") {
                let digest: Digest = digest.parse().expect("a digest");
                let report = crate::support::bytes(&store, &digest).await;
                assert_eq!(String::from_utf8_lossy(&report), format!("report on {name}: {code}\n"));
            }
            graded.insert(name, Expected { code, points: row.maybe_text("points").expect("text") });
        }
        for (name, expected) in &self.accepted {
            match graded.get(name) {
                None => found.lost.push(name.clone()),
                Some(grade) if grade != expected => found.wrong.push(format!("{name}: {grade:?}, not {expected:?}")),
                Some(_) => {}
            }
        }
        found
    }

    /// Returns the running graders for whose end no process waits.
    fn running_graders(&self) -> Vec<String> {
        let name = self.grader.to_str().expect("a plain path");
        let processes = fs::read_dir("/proc").expect("/proc").flatten();
        processes
            .filter_map(|process| fs::read_to_string(process.path().join("cmdline")).ok())
            .filter(|words| words.contains(&format!("{name}\0grade")))
            .collect()
    }
}

impl Drop for Arena {
    fn drop(&mut self) {
        for worker in &mut self.workers {
            drop(worker.kill());
            drop(worker.wait());
        }
    }
}

/// Sends a signal to a worker that is not yet reaped.
pub(super) fn signal(worker: &Child, signal: i32) {
    // SAFETY: the process is this test's own child, and not reaped.
    unsafe { libc::kill(worker.id().cast_signed(), signal) };
}

/// Runs forever. Continues each worker of this test that has been stopped for twice its lease.
fn wake_the_frozen() {
    let own = std::process::id().to_string();
    let mut frozen: BTreeMap<i32, Instant> = BTreeMap::new();
    loop {
        let processes = fs::read_dir("/proc").expect("/proc").flatten();
        let stopped: Vec<i32> = processes
            .filter_map(|process| {
                let number = process.file_name().to_str()?.parse().ok()?;
                let stat = fs::read_to_string(process.path().join("stat")).ok()?;
                let (_, state) = stat.rsplit_once(") ")?;
                let mut words = state.split(' ');
                (words.next() == Some("T") && words.next() == Some(&own)).then_some(number)
            })
            .collect();
        frozen.retain(|number, _| stopped.contains(number));
        for number in stopped {
            if frozen.entry(number).or_insert_with(Instant::now).elapsed() > Duration::from_secs(LEASE) * 2 {
                // SAFETY: a child of this process, or none if it was reaped a moment ago; waking harms nobody.
                unsafe { libc::kill(number, libc::SIGCONT) };
            }
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}
